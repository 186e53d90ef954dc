"""Real CT: cut, recorded, replayed, killed; and nothing of its origin left in what is written."""

import json
import os
import signal
import subprocess
import sys
import time
import unittest
from pathlib import Path

from lab_support import LAB, SCENES, LabTest, data_folder, lab

SKIPPED = 77


class RealCranium(LabTest):
    case = (data_folder() or Path(".")) / "head-ct-plastic-skull"

    def test_both_arms_remove_bone_within_the_limit_and_it_replays_identically(self):
        run = lab("run", SCENES / "cranium.json", "--case", self.case, "--out", self.folder)
        for arm in run["arms"]:
            self.assertGreater(arm["removed_mm3"], 50.0)
            self.assertLessEqual(arm["max_force_N"], 3.3 + 1e-9)
        self.assertGreater(run["removed_mm3"]["bone"], 100.0)
        replay = lab("replay", run["recording"], "--case", self.case)
        self.assertTrue(replay["identical"])
        self.assertEqual(replay["volume_sha256"], run["volume_sha256"])
        print("run:", json.dumps({k: run[k] for k in ("arms", "removed_mm3", "tick_ns")}))

        recording = Path(run["recording"]).read_bytes()
        self.assertNotIn(b"head-ct-plastic-skull", recording, "a recording never holds a path")
        self.assertNotIn(str(data_folder()).encode(), recording)
        self.assert_error(lab("replay", run["recording"], expect=1), "NO_CASE", "--case")
        self.assert_error(lab("replay", run["recording"], "--case", "phantom:cranium", expect=1),
                          "WRONG_CASE")

    def test_a_killed_real_time_run_replays_to_within_a_second(self):
        process = subprocess.Popen(
            [LAB, "run", str(SCENES / "cranium.json"), "--case", str(self.case), "--realtime",
             "--out", str(self.folder), "--json"], stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL)
        recording = self.folder / "session.h5"
        deadline = time.monotonic() + 120
        while not recording.exists() and time.monotonic() < deadline:
            time.sleep(0.01)
        # What a reader beside the writer saw just before the kill.
        time.sleep(6.0)
        before = lab("replay", recording, "--case", self.case)["ticks"]
        seen_at = time.monotonic()
        time.sleep(1.0)
        process.send_signal(signal.SIGKILL)
        killed_at = time.monotonic()
        process.wait()
        replay = lab("replay", recording, "--case", self.case)
        self.assertTrue(replay["identical"])
        self.assertGreater(before, 1000)
        # At most the last second is lost: all ticks that ran between the two reads but one second's.
        self.assertGreaterEqual(replay["ticks"], before + 1000 * (killed_at - seen_at - 1.0) - 1000)
        print("killed run: ticks read while it ran", before, "and after the kill", replay["ticks"])


class RealAbdomen(LabTest):
    def test_the_liver_scene_fits_a_real_abdomen(self):
        case = data_folder() / "abdomen-ct-totalsegmentator" / "example_ct.nii.gz"
        run = lab("run", SCENES / "liver.json", "--case", case, "--out", self.folder)
        self.assertGreater(run["removed_mm3"]["liver"], 1000.0)
        self.assertTrue(lab("replay", run["recording"], "--case", case)["identical"])


if __name__ == "__main__":
    if data_folder() is None:
        print("skipped: TREPHINE_TEST_DATA is not set, and these tests need the real CT")
        sys.exit(SKIPPED)
    unittest.main()
