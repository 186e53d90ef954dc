"""The pages of help: each is reached from the first, each link and picture is there, and each command
that they name is one."""

import re
import subprocess
import unittest

from lab_support import LAB, SOURCE, main

HELP = SOURCE / "resources" / "help"


class Help(unittest.TestCase):
    def pages(self):
        return {page.stem: page.read_text() for page in (HELP / "en").glob("*.md")}

    def test_every_page_is_reached_and_every_link_and_picture_is_there(self):
        pages = self.pages()
        reached, left = set(), ["index"]
        while left:
            page = left.pop()
            if page in reached:
                continue
            reached.add(page)
            for target in re.findall(r"(?<!!)\[[^\]]+\]\(([^)]+)\)", pages[page]):
                self.assertTrue((HELP / "en" / target).is_file(), f"{page}: {target}")
                left.append(target.removesuffix(".md"))
        self.assertEqual(reached, set(pages))
        pictures = {picture for text in pages.values()
                    for picture in re.findall(r"!\[[^\]]+\]\(\.\./pictures/([^)]+)\)", text)}
        self.assertEqual(pictures, {file.name for file in (HELP / "pictures").iterdir()})

    def test_every_command_it_names_is_one(self):
        named = set()
        for text in self.pages().values():
            named |= set(re.findall(r"trephine-lab ([a-z]+(?: [a-z]+)?)", text))
        self.assertTrue(named)
        for command in named:
            words = command.split()
            known = subprocess.run([LAB, *words, "--help"], capture_output=True).returncode == 0
            known = known or subprocess.run([LAB, words[0], "--help"],
                                            capture_output=True).returncode == 0
            self.assertTrue(known, command)

    def test_it_says_what_it_is_for(self):
        self.assertIn("For training, not for diagnosis or treatment planning",
                      self.pages()["index"])


if __name__ == "__main__":
    main()
