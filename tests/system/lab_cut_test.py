"""Exercises on cases that are not their own: what is cut, and what is said."""

import json
import struct
import unittest

from lab_structures_test import IN_LIVER, nifti
from lab_support import SCENES, LabTest, data_folder, lab

ALL = sorted(file.stem for file in SCENES.glob("*.json"))
CRANIAL = [name for name in ALL if json.loads((SCENES / f"{name}.json").read_text())["anatomy"] == "cranium"]
OTHER = "OTHER_ANATOMY"


class CutByStructure(LabTest):
    """The shipped liver exercise, in which the structure alone is tissue: nothing else may be cut."""
    CASE = "phantom:abdomen"

    def setUp(self):
        super().setUp()
        self.liver = self.folder / "liver.nii"
        lab("structures", "grow", self.CASE, "--seed", IN_LIVER, "--name", "liver", "--write", self.liver)
        begun = self.folder / "begun.nii"
        lab("run", SCENES / "liver.json", "--case", self.CASE, "--seconds", 0.01, "--save-volume", begun,
            "--out", self.folder / "begun")
        self.before = nifti(begun)[4]

    def scene(self, straight):
        """`straight`: along the landmark's own ray instead of 42 mm beside it."""
        scene = json.loads((SCENES / "liver.json").read_text())
        tissues = json.loads((SCENES / scene["tissues"]).read_text())
        tissues["tissues"] = [t for t in tissues["tissues"] if t["id"] in ("liver", "capsule")]
        tissues.pop("elsewhere")
        script = json.loads((SCENES / scene["operator"]).read_text())
        for arm in script["arms"] if straight else []:
            for point in arm["waypoints"]:
                x, _, z = point["at_mm"]
                point["at_mm"] = [0.2 * x, 0, z]
        (self.folder / "script.json").write_text(json.dumps(script))
        for arm in scene["arms"]:
            arm["device"]["config"] = str(SCENES / arm["device"]["config"])
        for tool in scene["tools"]:
            if "file" in tool:
                tool["file"] = str(SCENES / tool["file"])
        scene["landmarks"][0]["run_mm"] = 5
        scene.update(tissues=tissues, operator=str(self.folder / "script.json"))
        file = self.folder / "scene.json"
        file.write_text(json.dumps(scene))
        return file

    def assert_cut_inside_alone(self, labels, straight=False, given=True):
        carved = self.folder / "carved.nii"
        run = lab("run", self.scene(straight), "--case", self.CASE, *(("--labels", labels) if given else ()),
                  "--save-volume", carved, "--out", self.folder / "run")
        inside_of, after = nifti(labels)[4], nifti(carved)[4]
        self.assertEqual(len(after), 2 * len(inside_of))
        inside = outside = 0
        for row in range(0, len(after), 512):
            if after[row:row + 512] == self.before[row:row + 512]:
                continue
            for at in range(row, row + 512, 2):
                if after[at:at + 2] != self.before[at:at + 2]:
                    inside += inside_of[at // 2] != 0
                    outside += inside_of[at // 2] == 0
        print(labels.name, "inside", inside, "outside", outside)
        self.assertEqual(inside + outside, run["removed_voxels"])
        self.assertEqual(outside, 0)
        self.assertGreater(inside, 100)

    def changed(self, name, keep):
        """The grown liver where `keep(i, j, k)` holds, named liver too."""
        raw = bytearray(self.liver.read_bytes())
        (ni, nj, nk), begin = nifti(self.liver)[0], int(struct.unpack_from("<f", self.liver.read_bytes(), 108)[0])
        for k in range(nk):
            for j in range(nj):
                row = begin + (k * nj + j) * ni
                if any(raw[row:row + ni]):
                    raw[row:row + ni] = bytes(raw[row + i] and keep(i, j, k) for i in range(ni))
        file = self.folder / f"{name}.nii"
        file.write_bytes(raw)
        (self.folder / f"{name}.structures.json").write_text(
            (self.folder / "liver.structures.json").read_text())
        return file

    def test_of_the_built_in_liver_and_its_capsule(self):
        both = self.folder / "both.nii"
        lab("structures", "export", self.CASE, "--name", "liver", "--name", "capsule", "--write", both)
        self.assert_cut_inside_alone(both, given=False)

    def test_of_a_liver_that_was_grown(self):
        self.assert_cut_inside_alone(self.liver)

    def test_of_a_small_ball_and_of_blocks_that_are_called_liver(self):
        _, _, rows, _, _ = nifti(self.liver)
        seed = [float(x) for x in IN_LIVER.split(",")]
        seed = [-seed[0], -seed[1], seed[2]]  # the file's frame is RAS

        def in_ball(i, j, k):
            return sum((row[0] * i + row[1] * j + row[2] * k + row[3] - at)**2
                       for row, at in zip(rows, seed)) < 20**2
        self.assert_cut_inside_alone(self.changed("ball", in_ball), straight=True)

        def in_block(i, j, k):
            return (i // 16 + j // 16 + k // 16) % 2 == 0
        self.assert_cut_inside_alone(self.changed("blocks", in_block), straight=True)


class OtherCases(LabTest):
    def warnings(self, name, case):
        run = lab("run", SCENES / f"{name}.json", "--case", case, "--seconds", 0.2, "--out",
                  self.folder / "out")
        return {warning["code"] for warning in run["warnings"]}

    def test_every_exercise_runs_on_every_built_in_case_and_says_where_it_is_for_another(self):
        for case, anatomy in (("phantom:cranium", "cranium"), ("phantom:abdomen", "abdomen")):
            for name in ALL:
                said = self.warnings(name, case)
                self.assertEqual(OTHER in said, (name in CRANIAL) != (anatomy == "cranium"), name)
                if OTHER not in said:
                    self.assertEqual(said, set(), name)

    @unittest.skipUnless(data_folder(), "TREPHINE_TEST_DATA is not set")
    def test_every_exercise_runs_on_a_real_abdomen(self):
        for name in ALL:
            said = self.warnings(name, data_folder() / "abdomen-ct-totalsegmentator" / "example_ct.nii.gz")
            self.assertLessEqual(said, {OTHER, "NO_LANDMARK", "STARTS_IN_TISSUE", "LACKS_STRUCTURE"}, name)
            self.assertEqual(OTHER in said, name in CRANIAL, name)

    @unittest.skipUnless(data_folder(), "TREPHINE_TEST_DATA is not set")
    def test_every_exercise_runs_on_a_real_skull_and_those_for_it_without_a_word(self):
        for name in ALL:
            said = self.warnings(name, data_folder() / "head-ct-plastic-skull")
            if name in CRANIAL:
                self.assertEqual(said, set(), name)
            else:
                self.assertIn(OTHER, said, name)


if __name__ == "__main__":
    unittest.main()
