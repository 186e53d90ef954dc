"""`measure headset`, short: through the real loader with the tests' own runtime."""

import os
import unittest

from lab_support import LabTest, lab, main


class MeasureHeadset(LabTest):
    def test_pictures_lie_where_theory_puts_them_and_nothing_stays_behind(self):
        out = self.folder / "out"
        found = lab("measure", "headset", "--seconds", 2, "--toggles", 3, "--losses", 1,
                    "--no-pictures", "--out", out)
        self.assertEqual([row["kind"] for row in found["rows"]][:2], ["openxr", "side-by-side"])
        for row in found["rows"]:
            self.assertGreater(row["eyes_ms"]["count"], 5)
        geometry = found["geometry"]
        self.assertLess(geometry["disparity_error_px"], 0.5)
        self.assertLess(geometry["vertical_error_px"], 0.2)
        self.assertGreaterEqual(geometry["psnr_to_crop_db"], 60.0)
        self.assertEqual(found["toggles"], 3)
        self.assertEqual(found["losses"], 5)
        self.assertEqual(found["failures"]["tried"], found["failures"]["ended"])
        self.assertGreater(found["failures"]["tried"], 40)
        for what in ("leaked_textures", "leaked_fds", "leaked_threads"):
            self.assertLessEqual(found[what], 0, what)
        self.assertEqual(found["violations"], [])
        self.assertTrue(found["recording_replays"])

    def test_bad_options_and_a_runtime_that_is_not_there_are_one_sentence(self):
        error = lab("measure", "headset", "--seconds", 1, "--out", self.folder / "out",
                    expect=1)["error"]
        self.assertEqual(error["code"], "BAD_OPTION")


class RealRuntime(LabTest):
    """The same walk through whatever runtime XR_RUNTIME_JSON names: with a headset, or Monado."""

    def test_the_same_walk_through_a_real_runtime(self):
        if not os.environ.get("XR_RUNTIME_JSON"):
            self.skipTest("XR_RUNTIME_JSON names no runtime")
        found = lab("measure", "headset", "--seconds", 2, "--toggles", 5, "--no-pictures",
                    "--out", self.folder / "out")
        self.assertTrue(found["real_runtime"])
        self.assertEqual(found["toggles"], 5)
        self.assertLessEqual(found["leaked_textures"], 0)
        self.assertTrue(found["recording_replays"])


if __name__ == "__main__":
    main()
