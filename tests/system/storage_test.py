"""`trephine-lab storage list` on folders that are odd."""

import json
import os
import shutil
import subprocess
import unittest

from lab_support import LAB, LabTest, TraineeTest, lab, main, small_head


def stored_case(store):
    """A case as the window saves one, without structures and tissues. Returns its folder."""
    case = store / "cases/a-case"
    case.mkdir(parents=True)
    head = small_head(store / "head.nii.gz", (24, 24, 24), (4.0, 4.0, 4.0))
    series = lab("import", head, "--write", case / "volume.mha")["series"][0]
    axes = series["direction"]
    (case / "case.json").write_text(json.dumps({
        "format": "trephine.case", "version": 1, "name": "A case", "imported": "2026-01-01T00:00:00Z",
        "region": "head", "size": series["size"], "spacing_mm": series["spacing_mm"],
        "origin_mm": series["origin_mm"], "direction": [axes[0:3], axes[3:6], axes[6:9]],
        "volume_sha256": series["volume_sha256"], "verdict": "pass", "structures": []}))
    return case


class StorageList(LabTest):
    def test_a_name_cannot_command_the_terminal(self):
        (self.folder / "store/cases/a\x1b[2Jb\x07").mkdir(parents=True)
        done = subprocess.run([LAB, "storage", "list", "--storage", self.folder / "store"],
                              capture_output=True, text=True)
        said = done.stdout + done.stderr
        self.assertIn("a [2Jb", said)
        self.assertNotRegex(said, r"[\x00-\x09\x0b-\x1f]")


    def test_a_case_whose_structures_or_tissues_cannot_be_used_is_not_called_good(self):
        store = self.folder / "store"
        for broken, name in ((None, None), ("pipe", "structures.seg.nrrd"),
                             ("zeros", "structures.seg.nrrd"), ("pipe", "tissues.json"),
                             ("zeros", "tissues.json"), ("none", "tissues.json"),
                             ("empty", "tissues.json"), ("list", "tissues.json")):
            with self.subTest(broken=broken, name=name):
                case = stored_case(store)
                file = case / str(name)
                if broken == "pipe":
                    os.mkfifo(file)
                elif broken == "zeros":
                    file.touch()
                    os.truncate(file, 1 << 40)
                elif broken == "empty":
                    file.write_text("{}")
                elif broken == "list":
                    file.write_text("[]")
                elif broken == "none":
                    file.write_text('{"format": "trephine.tissues", "version": 1}')
                listed = lab("storage", "list", "--open", "--storage", store,
                             expect=1 if broken else 0)
                problem = listed["cases"][0]["problem"]
                self.assertEqual(problem and name in problem["where"], bool(broken) or None, problem)
                shutil.rmtree(store)


class StorageOfSettings(TraineeTest):
    def test_settings_that_cannot_be_read_move_no_storage(self):
        (self.etc / "trephine/settings.json").write_text('{"storage": "/srv/trephine",}')
        done = subprocess.run(self.as_trainee(LAB, "storage", "list", "--json"),
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, 1)
        self.assertIn("settings.json", json.loads(done.stdout)["error"]["where"])


if __name__ == "__main__":
    main()
