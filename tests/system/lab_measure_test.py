"""The laboratory's measurements: what each prints and writes, and what holds on any machine."""

import json
import os
import subprocess
import unittest
from pathlib import Path

from lab_support import LAB, LabTest, lab, main, without_display


class Stability(LabTest):
    CELL = {"mass_kg": 0.045, "period_s": 0.001, "delay_samples": 0, "encoder_mm": 0.055,
            "plant_damping": 0.05, "hand": {"k": 300, "b": 2}, "tissue": {"b": 100, "k": 0}}

    def grid(self, *changes):
        file = self.folder / "grid.json"
        file.write_text(json.dumps({"cells": [{**self.CELL, **change} for change in changes]}))
        return file

    def test_a_grid_of_ones_own_is_judged_under_every_controller(self):
        grid = self.grid({}, {"hand": None}, {"tissue": {"b": 1, "k": 0}})
        answer = lab("measure", "stability", "--grid", grid, "--out", self.folder / "out")
        self.assertEqual(set(answer["controllers"]), {"off", "seed", "bounded"})
        self.assertEqual(answer["controllers"]["bounded"]["unstable"], 0)
        self.assertGreater(answer["controllers"]["off"]["unstable"], 0)
        self.assertFalse(answer["zero_force"]["accepted"])
        self.assertEqual(len(answer["per_cell"]), 9)
        self.assertEqual(set(answer["per_cell"][0]),
                         {"cell", "controller", "oscillation_mm", "step_N", "energy_out_mJ",
                          "fidelity_error", "authority", "stable", "margin"})
        self.assertEqual(len((self.folder / "out" / "stability.csv").read_text().splitlines()), 10)

    def test_a_grid_that_cannot_be_is_named(self):
        out = self.folder / "out"
        answer = lab("measure", "stability", "--grid", self.folder / "none.json", "--out", out,
                     expect=1)
        self.assert_error(answer, "MISSING_FILE", "none.json")
        answer = lab("measure", "stability", "--grid", self.grid({"mass_kg": -1}), "--out", out,
                     expect=1)
        self.assert_error(answer, "BAD_FIELD", "mass_kg", "-1")


class WholeScenes(LabTest):
    def test_the_shipped_scenes_are_held_at_rest_and_swung(self):
        answer = lab("measure", "stability", "--sets", "rest", "--seconds", 1, "--out",
                     self.folder / "out")["rest"]
        self.assertLessEqual({"cells", "unstable", "also_ideal", "energy_out_mJ_max", "cycle_um_max",
                              "kinds", "rows"}, set(answer))
        self.assertEqual(answer["cells"], len(answer["rows"]))
        self.assertEqual(answer["unstable"], sum(row["unstable"] for row in answer["rows"]))
        scenes = {row["scene"] for row in answer["rows"]}
        self.assertLessEqual({"burr-hole", "cranium", "cranium-one-arm", "liver", "liver-one-arm",
                              "block of bone"}, scenes)
        self.assertEqual({row["kind"] for row in answer["rows"]}, {"rest", "swing", "creep", "edge"})
        self.assertEqual({row["tool"] for row in answer["rows"]},
                         {"burr", "small burr", "craniotome", "blade", "needle"})
        kinds = {kind["name"].split(",")[0]: kind for kind in answer["kinds"]}
        for name in ("scaled blocks", "edges"):
            self.assertLessEqual(kinds[name]["unstable"], 0.01 * kinds[name]["cells"], name)
            self.assertGreater(kinds[name]["cells"], 50, name)
        self.assertGreaterEqual(kinds["edges"]["least_shown"], 0.5)
        # A tool that a scene's hand holds in tissue feels it.
        self.assertEqual([row for row in answer["rows"] if "pressed" in row["place"]
                          and row["kind"] == "rest" and not row["felt"]
                          and "beside it" not in row["place"]], [])  # some slip off an edge


class Extremes(LabTest):
    def test_the_extremes_all_end_as_they_should(self):
        answer = lab("measure", "extremes", "--out", self.folder)
        self.assertGreater(len(answer["rows"]), 60)
        names = [row["name"] for row in answer["rows"]]
        for tool in ("needle", "blade", "burr"):
            for target in ("block", "phantom"):
                self.assertIn(f"barrier: {tool}, {target}", names)
        for row in answer["rows"]:
            if row["name"].startswith("barrier"):
                # How far the arm is beyond it is the arm's and the controller's, and printed.
                # A block is sharp; the phantom is blurred as by a scanner, and held to half a voxel.
                if "block" in row["name"]:
                    self.assertIn("inside by 0.000 mm", row["got"], row)
                self.assertTrue(row["pass"], row)
            else:
                self.assertTrue(row["pass"], row)


class Haptics(LabTest):
    def test_a_tick_is_timed_for_every_tool_grid_and_phase(self):
        answer = lab("measure", "haptics", "--out", self.folder / "out")
        self.assertEqual(set(answer), {"schema", "build", "rows", "direction_error_deg",
                                       "sliding_force_step_percent_p99", "depth_error_percent",
                                       "bars"})
        rows = answer["rows"]
        self.assertEqual({(row["tool"], row["arms"], row["grid"], row["box_mm"], row["phase"])
                          for row in rows},
                         {(tool, arms, grid, box, phase)
                          for tool in ("needle", "blade64", "burr6") for arms in (1, 2)
                          for grid in (256, 512) for box in (200, 49.2)
                          for phase in ("free", "contact", "removal")})
        self.assertEqual(len(rows), 72)
        for row in rows:
            self.assertEqual(set(row["ns"]), {"mean", "median", "p99", "p999", "max"})
            self.assertEqual(row["removed_mm3_per_s"] > 0, row["phase"] == "removal", row)
        strays = [bar for bar in answer["bars"] if bar["name"].startswith("rows that")]
        self.assertEqual([bar["value"] for bar in strays], [0])
        # Not of this machine's speed, so they hold anywhere. The bars of the last two are 8 and 3:
        # missed since the push comes from a proxy, and printed as FAIL.
        self.assertLess(answer["direction_error_deg"]["median"], 3)
        self.assertLess(answer["direction_error_deg"]["p99"], 8)
        self.assertLess(answer["sliding_force_step_percent_p99"], 3)
        self.assertEqual(len((self.folder / "out" / "haptics.csv").read_text().splitlines()), 73)


class Render(LabTest):
    """What it measures takes minutes: the measurement itself is a test of the lab's, in small."""

    def test_without_a_display_it_says_so_and_makes_no_folder(self):
        answer = lab("measure", "render", "--out", self.folder / "out", expect=1,
                     environment=without_display())
        self.assert_error(answer, "NO_DISPLAY")
        self.assertFalse((self.folder / "out").exists())

    def test_a_case_that_is_not_there_is_named_at_once(self):
        answer = lab("measure", "render", "--out", self.folder / "out", "--case",
                     self.folder / "none", expect=1)
        self.assert_error(answer, "MISSING_FOLDER", "none")


class Trades(LabTest):
    def test_every_knob_has_its_trade_and_one_recommended_setting(self):
        answer = lab("measure", "trades", "--out", self.folder / "out",
                     environment=without_display())
        self.assertEqual(set(answer), {"schema", "build", "rows", "table", "charts"})
        for chart in answer["charts"]:  # without a display
            self.assertTrue(Path(chart).read_bytes().startswith(b"\x89PNG"), chart)
        self.assertEqual(len(answer["charts"]), len({row["knob"] for row in answer["rows"]}))
        settings = {}
        for row in answer["rows"]:
            self.assertEqual(set(row), {"knob", "setting", "error", "error_unit", "cost",
                                        "cost_unit", "reference", "recommended", "extra"})
            settings.setdefault(row["knob"], []).append(row["setting"])
        self.assertEqual(settings, {
            "points_blade": ["2", "4", "8", "16", "32", "64", "128", "256"],
            "points_burr": ["8", "16", "32", "64", "128", "256", "512"],
            "force_at": ["tip", "distributed"],
            "rate_hz": ["250", "500", "1000", "2000", "4000", "10000", "20000"],
            "grid": ["full", "half", "quarter"]})
        chosen = [(row["knob"], row["setting"]) for row in answer["rows"] if row["recommended"]]
        self.assertEqual([knob for knob, _ in chosen], list(settings))
        written = json.loads((self.folder / "out" / "recommended.json").read_text())
        self.assertEqual(written["format"], "trephine.recommended")
        self.assertEqual([(k["knob"], k["setting"]) for k in written["knobs"]], chosen)
        self.assertEqual(len(Path(answer["table"]).read_text().splitlines()),
                         1 + len(answer["rows"]))


class Import(LabTest):
    SMALL = ("--size", 64, "--slices", 10, "--repetitions", 1, "--scan-series", 2,
             "--scan-slices", 10)
    ROW = {"series", "loader", "threads", "seconds_median", "peak_rss_mb", "above_start_mb",
           "correct", "skipped_reason"}
    RATIOS = {"int16_to_floor", "int16_to_floor_kept", "u12_to_floor", "u12_to_floor_kept",
              "command_to_dcm2niix", "scan_to_gdcmscanner", "compressed"}
    COMPRESSED = {"deflated", "rle", "jpegls", "jpegll", "j2k"}

    def assert_measured(self, answer, series, peers=()):
        """Each series by our loaders and the absent peers; the rows by series and loader."""
        self.assertEqual(set(answer), {"schema", "build", "volume_mb", "rows", "scan", "ratios"})
        self.assertEqual(answer["schema"], "trephine.measure.import.1")
        self.assertEqual(set(answer["ratios"]), self.RATIOS)
        self.assertEqual(answer["ratios"]["compressed"], dict.fromkeys(self.COMPRESSED))
        self.assertIsNone(answer["ratios"]["command_to_dcm2niix"])
        self.assertGreater(answer["ratios"]["int16_to_floor"], 1)
        self.assertGreater(answer["scan"][0]["seconds_median"], 0)
        rows = {(row["series"], row["loader"]): row for row in answer["rows"]}
        self.assertEqual(set(rows), {
            (name, loader) for name in series
            for loader in ("trephine", "trephine command", "floor", "floor kept", *peers)})
        for (name, loader), row in rows.items():
            with self.subTest(series=name, loader=loader):
                self.assertEqual(set(row), self.ROW)
                if loader.startswith("floor"):
                    self.assertGreater(row["seconds_median"], 0)
                    self.assertIsNone(row["correct"])
                elif loader.startswith("trephine"):
                    self.assertIsNone(row["skipped_reason"])
                    self.assertEqual(row["correct"], True)
                    self.assertGreater(row["seconds_median"], 0)
                else:
                    self.assertEqual(row["skipped_reason"], "not installed")
                    self.assertIsNone(row["seconds_median"])
        ours = rows["int16", "trephine"]
        self.assertGreater(ours["above_start_mb"], 0)
        self.assertLess(ours["above_start_mb"], ours["peak_rss_mb"])
        self.assertLess(ours["seconds_median"], rows["int16", "trephine command"]["seconds_median"])
        self.assertEqual(sorted(f.name for f in (self.folder / "out").iterdir()), ["import.csv"])

    def test_the_import_is_measured_beside_a_plain_read(self):
        answer = lab("measure", "import", *self.SMALL, "--out", self.folder / "out")
        self.assert_measured(answer, ("int16", "u12"))
        self.assertEqual([(row["loader"], row["files"]) for row in answer["scan"]],
                         [("trephine", 20)])

    def test_the_bench_measures_all_syntaxes_and_absent_peers(self):
        # A PATH without programs: what is installed here does not matter.
        done = subprocess.run(
            [os.environ["BENCH_IMPORT"], "--peers", *map(str, self.SMALL), "--out",
             self.folder / "out", "--lab", LAB, "--json"], capture_output=True, text=True,
            timeout=240, env={**os.environ, "PATH": str(self.folder)})
        self.assertEqual(done.returncode, 0, done.stderr)
        answer = json.loads(done.stdout)
        self.assert_measured(
            answer, ("int16", "u12", "big-endian", "deflated", "rle", "jpegls", "jpegll", "j2k"),
            ("dcm2niix", "dicomtonifti"))
        self.assertEqual([(row["loader"], row["files"]) for row in answer["scan"]],
                         [("trephine", 20), ("gdcmscanner", 20)])

    def test_an_import_measurement_of_what_is_not_there_is_refused(self):
        out = self.folder / "out"
        answer = lab("measure", "import", "--series", "jpegls", "--out", out, expect=1)
        self.assert_error(answer, "BAD_ARGUMENT", "jpegls", "int16, u12", "bench_import")
        answer = lab("measure", "import", "--size", 1, "--out", out, expect=1)
        self.assert_error(answer, "BAD_ARGUMENT", "2048")
        answer = lab("measure", "import", "--peers", "--out", out, expect=1)
        self.assert_error(answer, "BAD_ARGUMENT", "--peers", "bench_import")
        self.assertFalse(out.exists())


class Machine(LabTest):
    def test_every_byte_of_a_folder_is_read(self):
        (self.folder / "a").write_bytes(b"x" * 1000)
        (self.folder / "b").write_bytes(b"y" * 24)
        answer = lab("measure", "read", self.folder)
        self.assertEqual(set(answer), {"schema", "build", "files", "bytes", "seconds",
                                       "kept_seconds"})
        self.assertEqual((answer["files"], answer["bytes"]), (2, 1024))
        answer = lab("measure", "read", self.folder / "none", expect=1)
        self.assert_error(answer, "MISSING_FOLDER", "none")

    def test_jitter_is_measured_at_three_rates(self):
        answer = lab("measure", "jitter", "--seconds", 0.2, "--out", self.folder)
        self.assertEqual({row["rate_hz"] for row in answer["rows"]}, {1000, 2000, 4000})
        for row in answer["rows"]:
            self.assertEqual(row["ticks"], round(0.2 * row["rate_hz"]))
            self.assertLessEqual(row["late_us"]["median"], row["late_us"]["max"])
        answer = lab("measure", "jitter", "--seconds", "-1", "--out", self.folder, expect=1)
        self.assert_error(answer, "BAD_ARGUMENT")


class BadInput(LabTest):
    def test_a_table_that_cannot_be_written_is_an_error(self):
        (self.folder / "file").write_text("in the way")
        for what in ("haptics", "trades"):
            answer = lab("measure", what, "--out", self.folder / "file", expect=1)
            self.assert_error(answer, "CANNOT_WRITE", "file")
        answer = lab("trades", "--out", self.folder / "file", expect=1)
        self.assert_error(answer, "CANNOT_WRITE", "file")


if __name__ == "__main__":
    main()
