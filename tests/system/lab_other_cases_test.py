"""Exercises on cases that are not their own: they run, and say so."""

import json
import unittest

from lab_support import SCENES, LabTest, data_folder, lab, main

ALL = sorted(file.stem for file in SCENES.glob("*.json"))
CRANIAL = [name for name in ALL if json.loads((SCENES / f"{name}.json").read_text())["anatomy"] == "cranium"]
# Those of the seed paper are placed as the others are: they differ in laws, tools and card.
PLACED = [name for name in ALL if not name.startswith("seed-")]
OTHER = "OTHER_ANATOMY"


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
        for name in PLACED:
            said = self.warnings(name, data_folder() / "abdomen-ct-totalsegmentator" / "example_ct.nii.gz")
            self.assertLessEqual(said, {OTHER, "NO_LANDMARK", "STARTS_IN_TISSUE", "LACKS_STRUCTURE"}, name)
            self.assertEqual(OTHER in said, name in CRANIAL, name)

    @unittest.skipUnless(data_folder(), "TREPHINE_TEST_DATA is not set")
    def test_every_exercise_runs_on_a_real_skull_and_those_for_it_without_a_word(self):
        for name in PLACED:
            said = self.warnings(name, data_folder() / "head-ct-plastic-skull")
            if name in CRANIAL:
                self.assertEqual(said, set(), name)
            else:
                self.assertIn(OTHER, said, name)

    # One exercise of each anatomy: the case decides here, and each reads it anew.
    @unittest.skipUnless(data_folder(), "TREPHINE_TEST_DATA is not set")
    def test_no_scan_is_a_dead_end_be_it_of_a_few_slices(self):
        for case in ("abdomen-ct-totalsegmentator/example_ct_dicom", "head-ct-gantry-tilt"):
            for name in ("cranium", "liver"):
                said = self.warnings(name, data_folder() / case)
                self.assertLessEqual(said, {OTHER, "NO_VAULT", "NO_LANDMARK", "STARTS_IN_TISSUE",
                                            "LACKS_STRUCTURE"}, f"{name} on {case}")


if __name__ == "__main__":
    main()
