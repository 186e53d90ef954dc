"""An exercise on the command line: exported on one account, imported on another."""

import os
import subprocess
import unittest

from lab_support import LAB, SCENES, LabTest, lab, main

SCENE = SCENES / "liver-one-arm.json"


class Exercise(LabTest):
    def export(self, *arguments, **how):
        return lab("exercise", "export", SCENE, *arguments, "--out", self.folder / "stick", **how)

    def explained(self, scene):
        done = subprocess.run([LAB, "explain", scene], capture_output=True, text=True, check=True)
        # What a tick costs is another figure each time.
        return [line for line in done.stdout.splitlines() if " us" not in line]

    def test_elsewhere_it_explains_and_cuts_the_same(self):
        exported = self.export()
        self.assertEqual(exported["parts"][0]["file"], "scene.json")
        home = dict(os.environ, HOME=str(self.folder / "other"))
        home.pop("XDG_DATA_HOME", None)
        there = lab("exercise", "import", self.folder / "stick", environment=home)
        self.assertEqual((there["verified"], there["missing"], there["changed"]), (True, [], []))
        self.assertTrue(there["scene"].startswith(str(self.folder / "other")), there["scene"])
        self.assertEqual(self.explained(there["scene"]), self.explained(SCENE))
        first = lab("run", SCENE, "--seconds", 6, "--out", self.folder / "a")
        second = lab("run", there["scene"], "--seconds", 6, "--out", self.folder / "b")
        self.assertNotEqual(first["volume_sha256"], first["volume_sha256_before"])
        self.assertEqual(second["volume_sha256"], first["volume_sha256"])

    def test_what_is_not_whole_is_named_and_not_taken(self):
        self.export()
        (self.folder / "stick/operator.json").unlink()
        with open(self.folder / "stick/tools/needle.stl", "ab") as mesh:
            mesh.write(b" ")
        there = lab("exercise", "import", self.folder / "stick", "--storage",
                    self.folder / "store", expect=1)
        self.assertFalse(there["verified"])
        self.assertEqual(there["missing"], ["operator.json"])
        self.assertEqual(there["changed"], ["tools/needle.stl"])
        self.assertEqual(there["scene"], "")
        self.assertFalse((self.folder / "store").exists())

    def test_wrong_use_is_one_sentence(self):
        taken = self.folder / "stick"
        taken.mkdir()
        (taken / "mine").write_text("mine")
        self.assertEqual(self.export(expect=1)["error"]["code"], "CANNOT_WRITE")
        nothing = lab("exercise", "import", self.folder / "nowhere", expect=1)
        self.assertEqual(nothing["error"]["code"], "MISSING_FILE")
        self.assertIn("exercise export", nothing["error"]["next"])


if __name__ == "__main__":
    main()
