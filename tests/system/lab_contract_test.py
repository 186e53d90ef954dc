"""The command line's contract: keys, exit codes, errors; on the built-in cases alone."""

import csv
import hashlib
import json
import os
import shutil
import subprocess
import unittest
from pathlib import Path

from lab_support import (
    LAB, SCENES, SHIPPED, SOURCE, WINDOW, LabTest, first_ten_seconds, lab, main, small_head,
    small_scene, without_display)

IMPORT_KEYS = {
    "schema", "build", "path", "files_seen", "files_read", "skipped", "series", "chosen",
    "provenance", "seconds", "start_rss_mb", "peak_rss_mb"}
SERIES_KEYS = {
    "uid", "description", "modality", "source", "slices", "phases", "memory_mb", "choices",
    "verdict", "size", "spacing_mm", "origin_mm", "direction",
    "hu_min", "hu_max", "tilt_deg", "transfer_syntax", "lossy", "findings", "volume_sha256"}
RUN_KEYS = {
    "schema", "build", "controller", "controllers", "ticks", "rate_hz", "arms", "removed_mm3", "removed_unnamed_mm3", "removed_voxels", "undos", "rewinds",
    "brought_back_mm3",
    "structures_cut",
    "missed_deadlines", "faults", "warnings", "memory_locked", "nonfinite", "events_dropped",
    "recorder_behind_ms", "tick_ns", "volume_sha256_before", "volume_sha256", "recording",
    "picture", "volume", "table"}
ONE_ARM = ("cranium-one-arm", "burr-hole", "liver-one-arm")


class Phantom(LabTest):
    def test_a_phantom_survives_the_way_through_dicom(self):
        made = lab("phantom", "cranium", "--out", self.folder / "ct")
        self.assertEqual(made["size"], [256, 256, 180])
        self.assertEqual(made["files"], 180)
        read = lab("import", self.folder / "ct", "--write", self.folder / "v.mha")
        self.assertEqual(set(read), IMPORT_KEYS)
        self.assertEqual(set(read["seconds"]), {"scan", "read", "hash"})
        series = read["series"][0]
        self.assertEqual(set(series), SERIES_KEYS)
        self.assertEqual(series["verdict"], "pass")
        self.assertEqual(series["size"], [256, 256, 180])
        self.assertEqual(series["spacing_mm"], [0.8, 0.8, 1.0])
        self.assertEqual(series["uid"], read["chosen"])
        self.assertEqual(series["volume_sha256"], made["volume_sha256"])
        run = lab("run", SCENES / "cranium.json", "--case", self.folder / "v.mha", "--seconds", 0.1,
                  "--out", self.folder / "out", environment=without_display())
        self.assertEqual(run["volume_sha256_before"], made["volume_sha256"])

    def test_a_face_that_nobody_was_asked_about_is_warned_of_when_it_is_written(self):
        lab("phantom", "cranium", "--out", self.folder / "ct")

        def warnings(*choice):
            (self.folder / "v.nii").unlink(missing_ok=True)
            done = subprocess.run(
                [LAB, "import", self.folder / "ct", "--write", self.folder / "v.nii", *choice],
                capture_output=True, text=True, timeout=240, check=True)
            return done.stderr

        self.assertIn("--choice FACE=deface", warnings())
        for answer in ("keep", "deface"):
            self.assertNotIn("face", warnings("--choice", f"FACE={answer}"))

    def test_an_import_never_writes_over_what_it_reads(self):
        lab("phantom", "cranium", "--out", self.folder / "ct")
        slice_ = min((self.folder / "ct").iterdir())
        before = slice_.read_bytes()
        (self.folder / "own.mha").symlink_to(slice_)
        page = self.folder / "ct" / "own.html"
        page.write_text("precious")
        for arguments in (("--write", self.folder / "own.mha"), ("--report", page)):
            answer = lab("import", self.folder / "ct", *arguments, expect=2)
            self.assert_error(answer, "CANNOT_WRITE", "would be lost")
        self.assertEqual(slice_.read_bytes(), before)
        self.assertEqual(page.read_text(), "precious")
        page = page.rename(self.folder / "thesis.html")
        answer = lab("import", self.folder / "ct", "--report", page, expect=2)
        self.assert_error(answer, "CANNOT_WRITE", "would be lost", "--report")
        self.assertEqual(page.read_text(), "precious")

    def test_what_cannot_be_written_is_said_before_the_reading(self):
        missing = self.folder / "missing" / "v.mha"
        self.assert_error(lab("import", self.folder, "--write", missing, expect=2), "MISSING_FOLDER",
                          "no folder for this file")
        self.assert_error(lab("import", self.folder, "--report", self.folder / "x.pdf", expect=2),
                          "UNKNOWN_FORMAT", ".html")

    def test_a_question_that_nobody_answered_is_recorded_as_such(self):
        lab("phantom", "cranium", "--out", self.folder / "ct")
        made = lab("import", self.folder / "ct", "--phase", 2, expect=3)["provenance"]
        self.assertEqual(made["choices"], {"FACE": "keep"})
        self.assertEqual(made["unanswered"], ["FACE"])
        self.assertEqual(made["unused_answers"], ["PHASES"])

    def test_an_option_that_nobody_offers_is_named_wherever_it_is_asked(self):
        lab("phantom", "cranium", "--out", self.folder / "ct")
        answer = lab("import", self.folder / "ct", "--choice", "FACE=remove", expect=2)
        self.assert_error(answer, "BAD_CHOICE", "keep or deface")
        sorted((self.folder / "ct").iterdir())[40].unlink()  # a gap, so nothing can be read as it is
        answer = lab("import", self.folder / "ct", "--choice", "MISSING_SLICES=guess", expect=2)
        self.assert_error(answer, "BAD_CHOICE", "refuse, fill or part")
        answer = lab("import", self.folder / "ct", "--choice", "MISSING_SLICES=fill", "--choice",
                     "MISSING_SLICES=part", expect=2)
        self.assert_error(answer, "BAD_ARGUMENT", "answered twice")
        answer = lab("import", self.folder / "ct", "--choice", "NO_SUCH=1", expect=2)
        self.assert_error(answer, "BAD_CHOICE", "MISSING_SLICES")

    def test_an_unknown_phantom_is_named(self):
        answer = lab("phantom", "foot", "--out", self.folder, expect=1)
        self.assert_error(answer, "UNKNOWN_PHANTOM", "foot")


class ShippedScenes:
    def check(self, *names):
        for name in names:
            with self.subTest(scene=name):
                run = lab("run", SCENES / f"{name}.json", "--out", self.folder / name,
                          environment=without_display())
                self.assertEqual(set(run), RUN_KEYS)
                self.assertEqual(set(run["tick_ns"]), {"median", "p99", "p999", "max"})
                self.assertEqual(len(run["arms"]), 1 if name in ONE_ARM else 2)
                for arm in run["arms"]:
                    self.assertEqual(set(arm), {"name", "max_force_N", "contact_ticks",
                                                "energy_out_mJ", "removed_mm3"})
                    self.assertLessEqual(arm["max_force_N"], 3.3 + 1e-9)
                    self.assertGreater(arm["removed_mm3"], 50.0)
                target = "liver" if "liver" in name else "bone"
                self.assertGreater(run["removed_mm3"][target], 100.0)
                if target == "liver":
                    cut = {row["name"]: row for row in run["structures_cut"]}
                    self.assertGreater(cut["liver"]["cut_ml"], 0.0)
                    self.assertGreater(cut["liver"]["ml"], 500.0)
                    # In mm3 no more than went in all: what is no structure is not among them.
                    self.assertLessEqual(1000.0 * sum(row["cut_ml"] for row in cut.values()),
                                         sum(run["removed_mm3"].values()) +
                                         run["removed_unnamed_mm3"] + 1e-6)
                self.assertAlmostEqual(
                    sum(run["removed_mm3"].values()) + run["removed_unnamed_mm3"],
                    sum(arm["removed_mm3"] for arm in run["arms"]), delta=1e-6)
                self.assertEqual(run["nonfinite"], 0)
                self.assertEqual(run["events_dropped"], 0)
                self.assertIsNone(run["picture"], "without a display there is no picture")
                again = lab("replay", run["recording"])
                self.assertEqual(again["identical"], True)
                self.assertIsNone(again["first_difference"])
                self.assertEqual(again["ticks"], run["ticks"])
                self.assertEqual(again["volume_sha256"], run["volume_sha256"])
                self.assertEqual(again["structures_cut"], run["structures_cut"])


class CraniumScenes(ShippedScenes, LabTest):
    def test_they_remove_tissue_and_replay_identically(self):
        self.check("cranium", "cranium-one-arm")


class BurrHoleScene(ShippedScenes, LabTest):
    def test_it_removes_tissue_and_replays_identically(self):
        self.check("burr-hole")


class LiverScenes(ShippedScenes, LabTest):
    def test_they_remove_tissue_and_replay_identically(self):
        self.check("liver", "liver-one-arm")


class FirstTenSeconds(LabTest):
    def test_every_arm_of_a_shipped_scene_touches_and_removes_tissue(self):
        for name in SHIPPED:
            with self.subTest(scene=name):
                self.assert_touches_and_removes(first_ten_seconds(name, self.folder))


class OlderRecordings(LabTest):
    def test_a_recording_of_version_8_replays_identically(self):
        # Other tissues, a stroke and its undo; each event held its table of tissues then.
        recording = Path(__file__).parent / "data" / "version-8.h5"
        replayed = lab("replay", recording)
        self.assertTrue(replayed["identical"], replayed)
        self.assertEqual(replayed["ticks"], 250)


class SeedScenes(LabTest):
    """The paper's mode: every tick in a table beside the recording."""

    def test_they_run_without_a_barrier_and_write_every_tick(self):
        for name in ("research/seed-cranium", "research/seed-liver"):
            with self.subTest(name):
                self.assertIn("no barrier", lab("explain", SCENES / f"{name}.json")["barrier"])
                table = self.folder / f"{Path(name).name}.csv"
                run = lab("run", SCENES / f"{name}.json", "--csv", table, "--seconds", 6,
                          "--out", self.folder)
                self.assertEqual(run["controller"], "seed")
                self.assertEqual(run["warnings"], [])
                self.assertGreater(run["removed_voxels"], 0)
                with open(table, newline="") as file:
                    rows = list(csv.DictReader(file))
                self.assertEqual(len(rows), run["ticks"] * len(run["arms"]))
                self.assertEqual([r["arm"] for r in rows[:2]], ["left", "right"])
                # Eq. 9 and 12: what is sent is the compensated force, within the arm's limit.
                felt = [r for r in rows if float(r["f_e_x_N"]) != 0.0]
                self.assertTrue(felt)
                for row in felt:
                    f_e, f_c, v = ([float(row[f"{what}_{axis}{unit}"]) for axis in "xyz"]
                                   for what, unit in (("f_e", "_N"), ("f_c", "_N"), ("v", "_m_s")))
                    self.assertLessEqual(sum(a * b for a, b in zip(f_e, v)), 1e-12)
                    if float(row["alpha"]) == 0.0:
                        self.assertEqual(f_e, f_c)

    def test_a_table_needs_a_folder(self):
        error = lab("run", SCENES / "research/seed-liver.json", "--csv", self.folder / "none" / "t.csv",
                    "--out", self.folder, expect=1)
        self.assert_error(error, "MISSING_FOLDER", "--csv")


class StartsInTissue(LabTest):
    def test_it_is_a_warning_and_nothing_is_cut_or_felt(self):
        scene = json.loads((SCENES / "burr-hole.json").read_text())
        scene["arms"][0]["map"]["offset_mm"] = [0, 0, -3]
        for part, folder in (("tissues", "tissues"), ("operator", "operators")):
            scene[part] = str(SCENES.parent / folder / Path(scene[part]).name)
        for tool in scene["tools"]:
            tool["file"] = str((SCENES / tool["file"]).resolve())
        (self.folder / "scene.json").write_text(json.dumps(scene))
        rest = {"format": "trephine.operator", "version": 1, "name": "rest",
                "hand": {"stiffness_N_per_m": 800, "damping_Ns_per_m": 8},
                "arms": [{"arm": "right", "waypoints": [{"t": 0, "at_mm": [0, 0, -3]},
                                                        {"t": 1, "at_mm": [0, 0, -3]}]}]}
        (self.folder / "rest.json").write_text(json.dumps(rest))
        scene["operator"] = "rest.json"
        (self.folder / "scene.json").write_text(json.dumps(scene))
        table = self.folder / "ticks.csv"
        run = lab("run", self.folder / "scene.json", "--out", self.folder, "--csv", table)
        self.assertEqual([w["code"] for w in run["warnings"]], ["STARTS_IN_TISSUE"])
        with open(table, newline="") as file:
            self.assertEqual({row["tool_state"] for row in csv.DictReader(file)}, {"1"})
        explained = lab("explain", self.folder / "scene.json")
        self.assertEqual(explained["warnings"], run["warnings"])
        self.assertEqual(run["arms"][0]["max_force_N"], 0.0)
        self.assertEqual(run["removed_voxels"], 0)


class Run(LabTest):
    def test_no_shipped_scene_is_forgotten(self):
        self.assertEqual({str(file.relative_to(SCENES).with_suffix("")) for file in SCENES.rglob("*.json")},
                         {"cranium", "cranium-one-arm", "burr-hole", "liver", "liver-one-arm",
                          "research/seed-cranium", "research/seed-liver"})

    def test_options_reach_the_run(self):
        run = lab("run", SCENES / "cranium.json", "--seconds", 0.5, "--rate", 2000, "--controller",
                  "off", "--save-volume", self.folder / "carved.nii.gz", "--out", self.folder)
        self.assertEqual(run["ticks"], 1000)
        self.assertEqual(run["rate_hz"], 2000)
        self.assertEqual(run["controller"], "off")
        self.assertTrue((self.folder / "carved.nii.gz").stat().st_size > 1000)

    def test_a_second_run_leaves_the_first_ones_files(self):
        first = lab("run", SCENES / "cranium.json", "--seconds", 0.2, "--out", self.folder)
        digest = hashlib.sha256(Path(first["recording"]).read_bytes()).hexdigest()
        second = lab("run", SCENES / "cranium.json", "--seconds", 0.2, "--out", self.folder)
        self.assertNotEqual(first["recording"], second["recording"])
        self.assertEqual(hashlib.sha256(Path(first["recording"]).read_bytes()).hexdigest(), digest)


class Targets(LabTest):
    """Where `run` is told to save its table and its volume."""

    def refused(self, *options, code="CANNOT_WRITE", words=()):
        """Refused before the run: nothing is recorded."""
        before = sorted(self.folder.rglob("*"))
        answer = lab("run", SCENES / "cranium.json", "--seconds", 0.1, "--out", self.folder / "out",
                     *options, expect=1)
        self.assert_error(answer, code, *words)
        self.assertEqual(sorted(self.folder.rglob("*")), before)

    def test_nothing_that_is_there_is_written_over(self):
        run = lab("run", SCENES / "cranium.json", "--seconds", 0.1, "--out", self.folder / "out",
                  "--csv", self.folder / "ticks.csv", "--save-volume", self.folder / "cut.nii.gz",
                  environment=without_display())
        scene = self.folder / "scene.json"
        scene.write_text((SCENES / "cranium.json").read_text())
        (self.folder / "link.csv").symlink_to(scene)
        (self.folder / "broken.csv").symlink_to(self.folder / "none")
        os.mkfifo(self.folder / "fifo.csv")
        files = [Path(run[what]) for what in ("recording", "table", "volume")] + [scene]
        before = [file.read_bytes() for file in files]
        for target in [*files, *(self.folder / name for name in
                                 ("link.csv", "broken.csv", "fifo.csv")), Path("/dev/full")]:
            with self.subTest(target.name):
                self.refused("--csv", target, words=(str(target), "--csv"))
        self.refused("--csv", self.folder, words=("folder", "--csv"))
        self.refused("--save-volume", run["volume"], words=("--save-volume",))
        self.assertEqual([file.read_bytes() for file in files], before)
        self.assertTrue(Path("/dev/full").is_char_device())

    def test_the_case_of_the_run_is_spared(self):
        case = small_head(self.folder / "head.nii.gz")
        before = case.read_bytes()
        for option in ("--save-volume", "--csv"):
            self.refused("--case", case, option, case, words=("would be lost",))
        self.assertEqual(case.read_bytes(), before)

    def test_what_the_run_itself_will_write_is_spared(self):
        out = self.folder / "out"
        self.refused("--csv", out / ".." / "out" / "session.h5", words=("The run itself",))
        volume = self.folder / "v.nii"
        self.refused("--csv", volume, "--save-volume", volume, words=("The run itself",))

    def test_a_folder_that_cannot_be_written_to_is_said_before_the_run(self):
        self.refused("--csv", self.folder / "none" / "t.csv", code="MISSING_FOLDER", words=("--csv",))
        self.refused("--csv", "/proc/t.csv")

    def test_an_empty_name_is_no_choice(self):
        for option in ("--csv", "--save-volume"):
            self.refused(option, "", code="BAD_ARGUMENT", words=(option,))

    def test_a_folder_that_was_made_for_nothing_goes_again(self):
        out = self.folder / "a" / "b"
        answer = lab("run", SCENES / "cranium.json", "--case", self.folder / "none", "--out", out,
                     expect=1)
        self.assertIn("error", answer)
        self.assertEqual(list(self.folder.iterdir()), [])
        (self.folder / "own").mkdir()
        lab("run", SCENES / "cranium.json", "--case", self.folder / "none", "--out",
            self.folder / "own", expect=1)
        self.assertTrue((self.folder / "own").is_dir(), "it was there before")

    def test_the_answer_names_what_was_written(self):
        done = subprocess.run(
            [LAB, "run", SCENES / "cranium.json", "--seconds", "0.1", "--out", self.folder, "--csv",
             self.folder / "t.csv", "--save-volume", self.folder / "v.mha"],
            capture_output=True, text=True, check=True)
        self.assertIn(f"table: {self.folder}/t.csv", done.stdout)
        self.assertIn(f"volume: {self.folder}/v.mha", done.stdout)


class Controllers(LabTest):
    def test_a_script_that_changes_the_controller_is_told_with_both(self):
        script = {"format": "trephine.operator", "version": 1, "name": "change",
                  "hand": {"stiffness_N_per_m": 800, "damping_Ns_per_m": 8},
                  "arms": [{"arm": "right", "waypoints": [{"t": 0, "at_mm": [0, 0, 18]}]}],
                  "commands": [{"t": 0.1, "do": "controller", "controller": "off"}]}
        (self.folder / "change.json").write_text(json.dumps(script))
        arguments = ("run", SCENES / "cranium.json", "--operator", self.folder / "change.json",
                     "--seconds", 0.3, "--out", self.folder)
        run = lab(*arguments)
        self.assertEqual(run["controllers"], ["bounded", "off"])
        self.assertEqual(run["controller"], "off")
        text = subprocess.run([LAB, *map(str, arguments)], capture_output=True, text=True,
                              check=True).stdout
        self.assertIn("controller 'bounded', later 'off'\n", text)


class OwnScript(LabTest):
    def test_a_script_of_ones_own_takes_back_both_its_strokes(self):
        script = {
            "format": "trephine.operator", "version": 1, "name": "dip",
            "hand": {"stiffness_N_per_m": 800, "damping_Ns_per_m": 8},
            "arms": [{"arm": "right", "waypoints": [{"t": 0, "at_mm": [0, 0, 18]},
                                                    {"t": 1.2, "at_mm": [0, 0, -6]},
                                                    {"t": 2.0, "at_mm": [0, 0, 18]},
                                                    {"t": 2.6, "at_mm": [5, 0, 18]},
                                                    {"t": 3.8, "at_mm": [5, 0, -6]},
                                                    {"t": 4.6, "at_mm": [5, 0, 18]}]}],
            "commands": [{"t": 5.2, "do": "undo"}, {"t": 5.2, "do": "undo"}]}
        (self.folder / "dip.json").write_text(json.dumps(script))
        run = lab("run", SCENES / "cranium.json", "--operator", self.folder / "dip.json",
                  "--seconds", 5.6, "--out", self.folder)
        self.assertGreater(run["arms"][1]["max_force_N"], 0.3)
        self.assertEqual(run["removed_voxels"], 0)
        self.assertEqual(run["volume_sha256"], run["volume_sha256_before"])
        self.assertTrue(lab("replay", run["recording"])["identical"])


class Explain(LabTest):
    def test_explain_lists_what_is_instantiated_and_its_cost(self):
        answer = lab("explain", SCENES / "liver.json")
        self.assertEqual([arm["name"] for arm in answer["arms"]], ["left", "right"])
        self.assertEqual([arm["other_tools"] for arm in answer["arms"]], [["blade"], ["needle"]])
        parts = {cost["part"] for cost in answer["cost"]}
        self.assertEqual(parts, {"proxy", "contact", "law viscous", "law friction", "law elastic", "law membrane", "law cutting",
                                 "law relaxation",
                                 "controller bounded", "clamp and gate", "removal sweep",
                                 "removal of one voxel"})
        self.assertTrue(all(cost["ns_per_tick"] > 0 for cost in answer["cost"]))
        self.assertGreater(answer["tick_ns"], 0)
        self.assertEqual(answer["warnings"], [])

    def test_the_thickest_tools_are_explained_in_time(self):
        for tool in ({"kind": "blade", "length_mm": 60, "points": 16, "radius_mm": 20},
                     {"kind": "burr", "length_mm": 60, "points": 32, "radius_mm": 20}):
            with self.subTest(tool["kind"]):
                answer = lab("explain", small_scene(self.folder, tool), timeout=60)
                self.assertGreater(answer["tick_ns"], 0)

    def test_explain_sets_a_scenes_settings_beside_the_recommended_ones(self):
        scene = small_scene(self.folder)
        recommended = {
            knob["knob"]: knob["setting"]
            for knob in json.loads((SOURCE / "resources" / "recommended.json").read_text())["knobs"]}
        answer = lab("explain", scene)
        self.assertEqual(answer["settings"],
                         [{"knob": knob, "setting": setting, "recommended": recommended[knob]}
                          for knob, setting in (("points_blade", "16"), ("force_at", "distributed"),
                                                ("rate_hz", "1000"), ("ray_casting", "0.5 voxels"))
                          if knob in recommended])
        text = subprocess.run([LAB, "explain", scene], capture_output=True,
                              text=True, check=True).stdout
        self.assertEqual(text.splitlines()[1].strip(), answer["goal"])
        self.assertIn(f"points_blade: 16 (recommended: {recommended['points_blade']})", text)
        self.assertNotIn("{", text, "words, no JSON")
        for said in ("right arm", "'bounded'", "solid tissue stops a tool", "a tick"):
            self.assertIn(said, text)

        # Without the resource there is nothing to say; a broken one is an error.
        bare = {**os.environ, "TREPHINE_RESOURCES": str(self.folder)}
        shutil.copytree(SOURCE / "resources" / "devices", self.folder / "devices")
        self.assertNotIn("settings", lab("explain", scene, environment=bare))
        (self.folder / "recommended.json").write_text('{"format": "trephine.recommended"}')
        answer = lab("explain", scene, environment=bare, expect=1)
        self.assert_error(answer, "BAD_FIELD", "recommended.json")


class BadInput(LabTest):
    def run_scene(self, change, code, *words):
        scene = json.loads((SCENES / "cranium.json").read_text())
        for arm in scene["arms"]:
            del arm["other_tools"]
        scene["tissues"] = json.loads((SCENES.parent / "tissues" / "cranium.json").read_text())
        scene["tools"] = [{"id": "blade", "kind": "blade", "length_mm": 16, "points": 16}]
        scene.pop("operator")
        change(scene)
        file = self.folder / "scene.json"
        file.write_text(json.dumps(scene))
        answer = lab("run", file, "--seconds", 0.1, "--out", self.folder / "out", expect=1)
        self.assert_error(answer, code, *words)

    def test_scenes_that_cannot_be(self):
        def unknown_tissue(scene):
            scene["landmarks"][0]["tissue"] = "cheese"
        self.run_scene(unknown_tissue, "BAD_FIELD", "scene.json", "cheese")

        def missing_file(scene):
            scene["tissues"] = "gone.json"
        self.run_scene(missing_file, "MISSING_FILE", "gone.json")

        def newer(scene):
            scene["version"] = 99
        self.run_scene(newer, "BAD_FIELD", "99")

        def negative(scene):
            scene["tissues"]["tissues"][0]["mechanics"]["damping_Ns_per_m"]["value"] = -2
        self.run_scene(negative, "BAD_FIELD", "damping_Ns_per_m", "-2")

    def test_a_case_of_one_slice_is_said_and_one_of_slices_far_apart_is_drawn(self):
        run = ("run", SCENES / "cranium.json", "--seconds", 0.05, "--out", self.folder / "out", "--case")
        flat = small_head(self.folder / "flat.nii.gz", (80, 80, 1), (1.2, 1.2, 3.0))
        self.assert_error(lab(*run, flat, expect=1), "NO_SURFACE", "bone")
        far = small_head(self.folder / "far.nii.gz", (192, 192, 10), (0.5, 0.5, 10.0))
        picture = Path(lab(*run, far)["picture"])
        self.assertGreater(picture.stat().st_size, 60_000)  # tools alone have 23 kB

    def test_folders_that_are_missing_empty_or_without_ct(self):
        named = ("--with-identity",)
        answer = lab("import", self.folder / "nowhere", *named, expect=2)
        self.assert_error(answer, "MISSING_FOLDER", "nowhere")
        answer = lab("import", self.folder / "nowhere", expect=2)
        self.assertEqual(answer["error"]["where"], "")
        self.assertIsNone(answer["chosen"])
        self.assertEqual(set(answer), IMPORT_KEYS | {"error"})
        (self.folder / "empty").mkdir()
        self.assert_error(lab("import", self.folder / "empty", *named, expect=2), "EMPTY_FOLDER",
                          "empty")
        (self.folder / "texts").mkdir()
        (self.folder / "texts" / "a.txt").write_text("not an image")
        answer = lab("import", self.folder / "texts", *named, expect=2)
        self.assert_error(answer, "NO_CT", "texts")
        self.assertEqual(answer["files_seen"], 1)
        self.assertEqual(answer["skipped"][0]["count"], 1)

    def test_a_recording_cut_short_is_named_and_kept(self):
        run = lab("run", SCENES / "cranium.json", "--seconds", 1, "--out", self.folder)
        whole = Path(run["recording"]).read_bytes()
        cut = self.folder / "cut.h5"
        cut.write_bytes(whole[:300])
        self.assert_error(lab("replay", cut, expect=1), "BAD_RECORDING", "cut.h5")
        self.assertEqual(cut.read_bytes(), whole[:300])
        self.assert_error(lab("replay", self.folder / "none.h5", expect=1), "MISSING_FILE", "none.h5")

    def test_a_full_disk_stops_with_one_line_and_loses_nothing(self):
        shell = (f'ulimit -f 64; exec "{LAB}" run "{SCENES}/cranium.json" --seconds 2 '
                 f'--save-volume "{self.folder}/cut.mha" --out "{self.folder}/out" --json')
        done = subprocess.run(["bash", "-c", shell], capture_output=True, text=True, timeout=120)
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        self.assert_error(json.loads(done.stdout), "CANNOT_WRITE")
        self.assertEqual([f for f in self.folder.rglob("*") if f.is_file()], [])

    def test_a_missing_temporary_folder_is_named_where_one_is_needed(self):
        missing = {**os.environ, "TMPDIR": str(self.folder / "none")}
        run = lab("run", SCENES / "cranium.json", "--seconds", 0.1, "--out", self.folder,
                  environment=missing)
        answer = lab("replay", run["recording"], environment=missing, expect=1)
        self.assert_error(answer, "NO_TEMPORARY_FOLDER", f"TMPDIR={self.folder}/none")

    @unittest.skipUnless(os.environ.get("DISPLAY"), "the window needs a display")
    def test_so_does_the_window_where_no_folder_was_given(self):
        done = subprocess.run(
            [WINDOW, "--exercise", SCENES / "cranium.json", "--seconds", "0.1", "--json"],
            env={**os.environ, "TMPDIR": str(self.folder / "none")}, capture_output=True, text=True,
            timeout=120)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assert_error(json.loads(done.stdout), "NO_TEMPORARY_FOLDER", "TMPDIR")
        self.assertFalse((self.folder / "none").exists())

    def test_wrong_use_says_so(self):
        for arguments in (["dance"], ["run"], ["run", SCENES / "cranium.json", "--out"],
                          ["replay", "a", "b"]):
            done = subprocess.run([LAB, *map(str, arguments)], capture_output=True, text=True)
            self.assertEqual(done.returncode, 1)
            self.assertTrue(done.stderr.strip())
        for arguments in (["dance"], ["run", SCENES / "cranium.json", "--out", self.folder, "--seconds"]):
            self.assert_error(lab(*arguments, expect=1), "BAD_ARGUMENT")
        for arguments in (["dance"], ["measure", "dance"]):
            self.assert_error(lab(*arguments, expect=1), "BAD_ARGUMENT", "'dance'")
            done = subprocess.run([LAB, *arguments], capture_output=True, text=True)
            self.assertIn("'dance'", done.stderr)
        answer = lab("measure", "stability", "--sets", "", "--out", self.folder, expect=1)
        self.assert_error(answer, "BAD_ARGUMENT", "--sets")
        answer = lab("measure", "extremes", "--case", self.folder / "nothere", "--out",
                     self.folder / "out", expect=1, timeout=20)
        self.assert_error(answer, "MISSING_FOLDER", "nothere")
        answer = lab("run", SCENES / "cranium.json", "--save-volume", "x.foo", "--out", self.folder,
                     expect=1)
        self.assert_error(answer, "UNKNOWN_FORMAT", "x.foo")
        answer = lab("run", SCENES / "cranium.json", "--controller", "pid", "--out", self.folder,
                     expect=1)
        self.assert_error(answer, "BAD_ARGUMENT", "pid")
        answer = lab("run", SCENES / "cranium.json", "--seconds", "-1", "--out", self.folder, expect=1)
        self.assert_error(answer, "BAD_ARGUMENT")

    def test_measuring_says_where_its_program_is_to_be_had(self):
        alone = shutil.copy(LAB, self.folder / "trephine-lab")
        for arguments in (["measure"], ["measure", "jitter", "--help"]):
            done = subprocess.run([alone, *arguments, "--json"], capture_output=True, text=True)
            self.assertEqual(done.returncode, 1)
            self.assert_error(json.loads(done.stdout), "NOT_INSTALLED", "trephine-measure",
                              "trephine-researcher")
            done = subprocess.run([alone, *arguments], capture_output=True, text=True)
            self.assertEqual((done.returncode, done.stdout), (1, ""))
            self.assertEqual(len(done.stderr.splitlines()), 1)
            self.assertIn("trephine-researcher", done.stderr)

    def test_measuring_without_a_display_says_so(self):
        answer = lab("measure", "upload", expect=1, environment=without_display())
        self.assert_error(answer, "NO_DISPLAY")


if __name__ == "__main__":
    main()
