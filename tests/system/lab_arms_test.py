"""Which devices move a scene's arms: the file for it, and the open arm on two emulated boards."""

import json
import os
import shutil
import subprocess
import unittest

from lab_support import LAB, SCENES, SOURCE, LabTest, lab, main

DEVICES = SOURCE / "resources" / "devices"


class Arms(LabTest):
    def arms(self, *arms):
        file = self.folder / "arms.json"
        file.write_text(json.dumps({"format": "trephine.arms", "version": 1, "arms": arms}))
        return file

    def simulated(self, **trouble):
        file = self.folder / "device.json"
        file.write_text(json.dumps({**json.loads((DEVICES / "omni.json").read_text()), **trouble}))
        return str(file)

    def run_with(self, file, expect=0):
        return lab("run", SCENES / "cranium.json", "--seconds", 0.4, "--arms", file, "--out",
                   self.folder / "out", expect=expect)

    def test_the_file_says_which_device_an_arm_has(self):
        usual = self.run_with(self.arms())
        self.assertEqual(usual["faults"], [])
        config = self.simulated(vanish_after_s=0.1)
        gone = self.run_with(self.arms({"name": "left", "plugin": "simulated", "arm": 1, "config": config},
                                       {"name": "right", "plugin": "simulated", "arm": 0, "config": config}),
                             expect=4)
        self.assertEqual({fault["fault"] for fault in gone["faults"]}, {"lost"})

    def test_an_arm_that_the_scene_does_not_have_and_a_plugin_that_is_not_there_are_named(self):
        error = self.run_with(self.arms({"name": "third", "plugin": "simulated"}), expect=1)["error"]
        self.assertEqual(error["code"], "NO_SUCH_ARM")
        self.assertIn("left, right", error["next"])
        error = self.run_with(self.arms({"name": "left", "plugin": "nosuch"}), expect=1)["error"]
        self.assertEqual(error["code"], "NO_PLUGIN")
        error = self.run_with(self.arms({"name": "left", "plugin": "openhaptics"}), expect=1)["error"]
        self.assertEqual(error["code"], "NO_DEVICE")
        self.assertIn("install OpenHaptics", error["what"])


class WoodenArmsTest(LabTest):
    """`run` on two boards whose hands swing them into the vault, through the real hidapi."""

    def test_a_run_is_paced_by_the_boards_and_each_report_is_answered(self):
        arms = self.folder / "arms.json"
        arms.write_text(json.dumps({"format": "trephine.arms", "version": 1, "arms": [
            {"name": "left", "plugin": "woodenhaptics", "arm": 0},
            {"name": "right", "plugin": "woodenhaptics", "arm": 1}]}))
        report = self.folder / "boards.json"
        wrapper = shutil.which("umockdev-wrapper")
        self.assertTrue(wrapper, "umockdev is not installed")
        done = subprocess.run(
            [wrapper, os.environ["WITH_WOODEN_ARMS"], report, LAB, "run", SCENES / "cranium.json",
             "--seconds", "6", "--arms", arms, "--out", self.folder / "out", "--json"],
            capture_output=True, text=True, timeout=240)
        self.assertIn(done.returncode, (0, 4), done.stdout[-500:] + done.stderr[-500:])
        run = json.loads(done.stdout)
        self.assertEqual(run["ticks"], 6000)
        # Lateness is the machine's; what the plugin lost would be its own.
        self.assertLessEqual({fault["fault"] for fault in run["faults"]}, {"late", "stalled"})
        boards = json.loads(report.read_text())
        for side in ("left", "right"):
            board = boards[side]
            print(side, board)
            # Several reports that come at once have one answer: on a busy machine.
            self.assertGreater(board["answered"], 2000)
            self.assertGreater(board["most_N"], 0.1)
            self.assertLess(board["most_N"], 5.1)
            self.assertLess(board["answer_ms"]["median"], 5.0)


class MeasureDevices(LabTest):
    """`measure devices` on emulated arms: short, for what it says and not for how fast it is."""

    def measure(self, bench, *under, environment=None):
        out = self.folder / "devices"
        done = subprocess.run(
            [*under, LAB, "measure", "devices", "--bench", bench, "--seconds", "3", "--trials", "1", "--out", out,
             "--json"], capture_output=True, text=True, timeout=280, env={**os.environ, **(environment or {})})
        self.assertEqual(done.returncode, 0, done.stdout[-800:] + done.stderr[-800:])
        self.assertIn("plugin,arms,seconds", (out / "devices.csv").read_text())
        [row] = json.loads(done.stdout)["rows"]
        print(json.dumps(row, indent=1))
        self.assertEqual(row["arms"], 2)
        self.assertEqual(row["ticks"], 3000)
        self.assertEqual(row["trials"], 2)
        self.assertEqual(row["replayed"], 2)
        self.assertLess(row["stop_ms"]["max"], 1000.0)
        self.assertLess(row["unplug_to_zero_ms"]["median"], 40.0)
        self.assertLess(row["block_to_zero_ms"]["median"], 60.0)
        self.assertEqual([delay["order"] for delay in row["delays"]], ["send, then wait", "wait, then send"])
        first, before = row["delays"]
        self.assertGreater(first["b_max"], before["b_max"])
        self.assertGreaterEqual(first["k_max"], before["k_max"])
        self.assertTrue(row["at_the_arm"] and first["at_the_arm"] and before["at_the_arm"])
        # What the arms had is what was sent, in size and direction, but for what a busy machine delays.
        for told in (first["forces_missing"], first["forces_late"]):
            self.assertLess(told, 0.05 * first["delay_ms"]["count"])
        self.assertLess(row["force_mismatches"], 0.05 * row["ticks"])
        self.assertGreater(before["delay_ms"]["median"], first["delay_ms"]["median"])
        return row

    def test_two_boards(self):
        self.measure(os.environ["BENCH_WOODENHAPTICS"], shutil.which("umockdev-wrapper"))

    def test_two_arms_of_the_makers_library(self):
        self.measure(os.environ["BENCH_OPENHAPTICS"], environment={"LD_LIBRARY_PATH": os.environ["HD_TEST"]})

    def test_without_a_device_it_says_so(self):
        error = lab("measure", "devices", "--out", self.folder / "none", expect=1)["error"]
        self.assertEqual(error["code"], "NO_DEVICE")
        error = lab("measure", "devices", "--bench", self.folder / "no.so", "--out", self.folder / "none",
                    expect=1)["error"]
        self.assertEqual(error["code"], "NO_BENCH")


if __name__ == "__main__":
    main()
