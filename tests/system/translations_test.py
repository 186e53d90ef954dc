"""Every sentence of the window and of the rooms can be translated, and the program says the
translation."""
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree as tree

ROOT = pathlib.Path(os.environ["TREPHINE_SOURCE"])
LRELEASE = "/usr/lib/qt6/bin/lrelease"


class Translations(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))

    def collected(self, name):
        file = self.folder / name
        subprocess.run([ROOT / "packaging" / "translations", file], check=True)
        return file, tree.parse(file)

    def test_the_programs_sentences_are_collected_by_context(self):
        _, found = self.collected("trephine_xx.ts")
        of = {c.find("name").text: {m.find("source").text for m in c.findall("message")}
              for c in found.getroot()}
        self.assertIn("The file is not valid JSON: {}", of["trephine"])
        self.assertIn("Another structure is called '{}'", of["trephine"])  # an error of the window
        self.assertIn("Size of te&xt", of["trephine"])  # a row of a table of the window
        self.assertIn("trephine::MainWindow", of)
        self.assertGreater(len(of["trephine"]), 1000)
        own = [name for name in of if name.startswith("trephine::")]
        self.assertGreater(len(own), 30)

    def test_the_program_says_them_in_the_language_of_the_account(self):
        file, found = self.collected("trephine_de.ts")
        for message in found.getroot().iter("message"):
            translation = message.find("translation")
            translation.attrib.pop("type", None)
            if message.get("numerus") != "yes":
                translation.text = "<<" + message.find("source").text + ">>"
        found.getroot().set("language", "de_DE")
        found.write(file, encoding="utf-8", xml_declaration=True)
        resources = self.folder / "resources"
        shutil.copytree(ROOT / "resources", resources)
        (resources / "translations").mkdir(exist_ok=True)
        subprocess.run([LRELEASE, "-silent", file, "-qm",
                        resources / "translations" / "trephine_de.qm"], check=True)
        environment = dict(os.environ, TREPHINE_RESOURCES=str(resources), LC_ALL="de_DE.UTF-8")
        missing = self.folder / "none.json"
        said = subprocess.run([os.environ["TREPHINE"], "--exercise", missing, "--out", self.folder / "out"],
                              env=environment, capture_output=True, text=True, timeout=120)
        self.assertNotEqual(said.returncode, 0)
        self.assertIn("<<The file cannot be read:", said.stderr + said.stdout)


if __name__ == "__main__":
    unittest.main()
