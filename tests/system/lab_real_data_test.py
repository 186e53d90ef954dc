"""Real CT: cut, recorded, replayed, killed; and nothing of its origin left in what is written."""

import gzip
import json
import os
import signal
import struct
import subprocess
import sys
import time
import unittest
from pathlib import Path

from lab_support import (LAB, PATIENCE_S, SCENES, SHIPPED, LabTest, data_folder, first_ten_seconds,
                         has_grown, lab, main, wait_until)

SKIPPED = 77


def nifti(file):
    """The voxels as stored, [k, j, i]."""
    import numpy as np

    raw = gzip.decompress(file.read_bytes())
    size = struct.unpack_from("<3h", raw, 42)
    kind = {2: "u1", 4: "<i2", 8: "<i4"}[struct.unpack_from("<h", raw, 70)[0]]
    begin = int(struct.unpack_from("<f", raw, 108)[0])
    return np.frombuffer(raw, kind, size[0] * size[1] * size[2], begin).reshape(size[::-1]).astype(int)


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
        wait_until(has_grown(recording, 8), "it has recorded for more than a second", PATIENCE_S)
        # What a reader beside the writer saw just before the kill.
        before = lab("replay", recording, "--case", self.case)["ticks"]
        seen_at = time.monotonic()
        wait_until(has_grown(recording, 5), "it has recorded for another second", PATIENCE_S)
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
    folder_of_data = (data_folder() or Path(".")) / "abdomen-ct-totalsegmentator"
    case = folder_of_data / "example_ct.nii.gz"
    LIVER = 5  # TotalSegmentator's label

    def label_map(self):
        """The segmentation where it belongs: its 30 slices are the CT's uppermost, but its header
        places them at the lowest (the offset in z of the whole CT)."""
        raw = bytearray(gzip.decompress((self.folder_of_data / "example_seg.nii.gz").read_bytes()))
        for offset in (276, 324):  # qoffset_z and the last of srow_z
            z_mm = struct.unpack_from("<f", raw, offset)[0]
            struct.pack_into("<f", raw, offset, z_mm + (112 - 30) * 3.0)
        file = self.folder / "labels.nii.gz"
        file.write_bytes(gzip.compress(bytes(raw)))
        return file

    def liver_scene(self, label):
        """One blade that goes into the liver from above and on to the patient's left, out of it;
        the liver alone is tissue, of a wide range of HU."""
        scene = json.loads((SCENES / "liver.json").read_text())
        del scene["view"]
        tissues = json.loads((SCENES.parent / "tissues" / "abdomen.json").read_text())
        tissues["tissues"] = [t for t in tissues["tissues"] if t["id"] == "liver"]
        tissues["tissues"][0]["hu"] = [-200, 400]
        if label is not None:
            tissues["tissues"][0]["label"] = label
        arm = scene["arms"][1]
        del arm["other_tools"]
        arm["map"] = {"centre_mm": [0, -185, 425], "rotation_wxyz": [1, 0, 0, 0],
                      "motion_scale": 1.5, "force_scale": 1.0}
        way = [[0, [-40, -185, 460]], [2, [-40, -185, 400]], [6, [60, -185, 400]],
               [7, [60, -185, 460]]]
        script = {"format": "trephine.operator", "version": 1, "name": "across the liver",
                  "hand": {"stiffness_N_per_m": 800, "damping_Ns_per_m": 8},
                  "arms": [{"arm": "right", "waypoints": [{"t": t, "at_mm": p} for t, p in way]}],
                  "commands": []}
        (self.folder / "across.json").write_text(json.dumps(script))
        scene.update(tissues=tissues, landmarks=[], arms=[arm],
                     tools=[t for t in scene["tools"] if t["id"] == "blade"],
                     operator=str(self.folder / "across.json"))
        file = self.folder / f"liver-{label}.json"
        file.write_text(json.dumps(scene))
        return file

    def removed_labels(self, carved, label_map):
        """The labels of the voxels that are not what they were."""
        before, after = nifti(self.case), nifti(carved)
        labels = 0 * before
        labels[-30:] = nifti(label_map)
        return labels[before != after]

    def test_a_tissue_of_a_label_is_removed_only_where_its_label_is(self):
        labels = self.label_map()
        carved = self.folder / "carved.nii.gz"
        run = lab("run", self.liver_scene(self.LIVER), "--case", self.case, "--labels", labels,
                  "--save-volume", carved, "--out", self.folder)
        removed = self.removed_labels(carved, labels)
        self.assertEqual(len(removed), run["removed_voxels"])
        self.assertGreater(len(removed), 100)
        self.assertEqual(set(removed), {self.LIVER})

        # The same stroke without the label map: what lies beyond the liver is cut as well.
        anything = self.folder / "anything.nii.gz"
        lab("run", self.liver_scene(None), "--case", self.case, "--save-volume", anything, "--out",
            self.folder)
        others = self.removed_labels(anything, labels)
        strangers = int((others != self.LIVER).sum())
        self.assertGreater(strangers, 50)
        print("removed: with the label map", len(removed), "voxels, all liver; without it",
              len(others), "of which", strangers, "are not")

        replay = lab("replay", run["recording"], "--case", self.case, "--labels", labels)
        self.assertTrue(replay["identical"])
        self.assertEqual(replay["volume_sha256"], run["volume_sha256"])
        self.assert_error(lab("replay", run["recording"], "--case", self.case, expect=1),
                          "WRONG_LABELS", "--labels")
        self.assert_error(
            lab("replay", run["recording"], "--case", self.case, "--labels",
                self.folder_of_data / "example_seg.nii.gz", expect=1), "WRONG_LABELS")
        recording = Path(run["recording"]).read_bytes()
        self.assertNotIn(b"labels.nii.gz", recording)
        self.assertNotIn(str(self.folder).encode(), recording)

    def test_a_label_map_that_is_missing_or_none_is_named(self):
        scene = self.liver_scene(self.LIVER)
        run = ("run", scene, "--case", self.case, "--out", self.folder / "out")
        self.assert_error(lab(*run, expect=1), "NO_LABELS", "'liver' is restricted to label 5")
        self.assert_error(lab(*run, "--labels", self.case, expect=1), "NOT_LABELS",
                          "example_ct.nii.gz")
        self.assert_error(lab(*run, "--labels", self.folder / "none.nii", expect=1),
                          "MISSING_FILE", "none.nii")
        self.assert_error(
            lab(*run, "--labels", self.folder_of_data / "example_seg_dicom.nii.gz", expect=1),
            "LABELS_ELSEWHERE")

    def test_the_liver_scene_fits_a_real_abdomen(self):
        run = lab("run", SCENES / "liver.json", "--case", self.case, "--out", self.folder)
        self.assertGreater(run["removed_mm3"]["liver"], 1000.0)
        self.assertTrue(lab("replay", run["recording"], "--case", self.case)["identical"])


class RealScenes(LabTest):
    def test_every_arm_of_a_shipped_scene_touches_and_removes_tissue_in_its_first_ten_seconds(self):
        for name in SHIPPED:
            case = RealAbdomen.case if name.startswith("liver") else RealCranium.case
            with self.subTest(scene=name):
                self.assert_touches_and_removes(
                    first_ten_seconds(name, self.folder, "--case", case))


if __name__ == "__main__":
    if data_folder() is None:
        print("skipped: TREPHINE_TEST_DATA is not set, and these tests need the real CT")
        sys.exit(SKIPPED)
    main()
