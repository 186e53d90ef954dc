"""`trephine-lab storage list` on folders that are odd."""

import json
import subprocess
import unittest

from lab_support import LAB, LabTest, TraineeTest, main


class StorageList(LabTest):
    def test_a_name_cannot_command_the_terminal(self):
        (self.folder / "store/cases/a\x1b[2Jb\x07").mkdir(parents=True)
        done = subprocess.run([LAB, "storage", "list", "--storage", self.folder / "store"],
                              capture_output=True, text=True)
        said = done.stdout + done.stderr
        self.assertIn("a [2Jb", said)
        self.assertNotRegex(said, r"[\x00-\x09\x0b-\x1f]")


class StorageOfSettings(TraineeTest):
    def test_settings_that_cannot_be_read_move_no_storage(self):
        (self.etc / "trephine/settings.json").write_text('{"storage": "/srv/trephine",}')
        done = subprocess.run(self.as_trainee(LAB, "storage", "list", "--json"),
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, 1)
        self.assertIn("settings.json", json.loads(done.stdout)["error"]["where"])


if __name__ == "__main__":
    main()
