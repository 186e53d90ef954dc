"""How the programs end when they are told to, or when the disk is full: in order, with one answer,
and with everything that was written in a state that can be used."""

import json
import os
import shutil
import signal
import subprocess
import unittest
from pathlib import Path

from lab_support import (LAB, PATIENCE_S, SCENES, SOURCE, WINDOW, EndingTest, computed_s, has_grown,
                         lab, main, small_head, wait_until)

SIGNALS = (signal.SIGTERM, signal.SIGINT, signal.SIGHUP)


def has_signal(process, mask, number):
    """Whether the signal is in a mask of the process: SigCgt of those it answers, ShdPnd that wait."""
    status = Path(f"/proc/{process.pid}/status").read_text()
    line = next(line for line in status.splitlines() if line.startswith(mask))
    return bool(int(line.split()[1], 16) >> (number - 1) & 1)


def listens(process):
    """Whether the program has come to where it answers signals; before that it loads libraries."""
    return all(has_signal(process, "SigCgt", number) for number in SIGNALS)


def pending(process, number):
    return has_signal(process, "ShdPnd", number)


def has_thread(process, name):
    return any((task / "comm").read_text().strip() == name
               for task in Path(f"/proc/{process.pid}/task").iterdir())


class Signals(EndingTest):
    def wait_until_at_work(self, process, name):
        self.wait_for(process, lambda: listens(process), "it listens")
        if name == "measure jitter":  # which hardly computes
            self.wait_for(process, lambda: has_thread(process, "jitter"), "its thread ticks")
        elif name == "phantom":  # whose first slice comes once the case is open
            self.wait_for(process, lambda: any((self.folder / "out/ct").glob("*")), "it writes")
        elif name != "explain":  # which is short
            begun_s = computed_s(process)
            self.wait_for(process, lambda: computed_s(process) > begun_s + 0.2, "it computes")

    def test_every_command_ends_on_a_signal_with_an_answer_and_128_more(self):
        out = self.folder / "out"
        commands = {
            "phantom": ("phantom", "cranium", "--out", out / "ct"),
            "run": ("run", SCENES / "cranium.json", "--seconds", 3000, "--out", out / "run"),
            "explain": ("explain", SCENES / "liver.json"),
            "measure stability": ("measure", "stability", "--out", out / "stability"),
            "measure extremes": ("measure", "extremes", "--out", out / "extremes"),
            "measure haptics": ("measure", "haptics", "--out", out / "haptics"),
            "trades": ("trades", "--out", out / "trades"),
            "measure import": ("measure", "import", "--size", 64, "--repetitions", 100, "--out",
                               out / "import"),
            "measure jitter": ("measure", "jitter", "--seconds", 600, "--out", out / "jitter"),
        }
        for number, (name, command) in enumerate(commands.items()):
            by = SIGNALS[number % len(SIGNALS)]
            with self.subTest(command=name, signal=by.name):
                process = self.start(LAB, *command, "--json")
                self.wait_until_at_work(process, name)
                self.assertIsNone(process.poll())
                code, answer = self.end(process, by)
                self.assertEqual(code, 128 + by)
                self.assert_error(answer, "CANCELLED")
        self.assertEqual([f for f in out.rglob("*.part*")], [])

    def test_a_sigterm_that_comes_twice_is_one_and_any_other_second_signal_ends_at_once(self):
        for second in (signal.SIGTERM, signal.SIGHUP):
            out = self.folder / second.name  # where it saves when it ends, which takes a while
            process = self.start(LAB, "run", SCENES / "cranium.json", "--seconds", 3000, "--out",
                                 out, "--save-volume", out / "carved.nii.gz", "--json")
            self.wait_for(process, has_grown(out / "session.h5", 3), "it records")
            process.send_signal(signal.SIGTERM)
            wait_until(lambda: not pending(process, signal.SIGTERM),
                       "the first was taken")  # two that wait would be one
            process.send_signal(second)
            said, _ = process.communicate(timeout=PATIENCE_S)
            self.assertEqual(process.returncode, 128 + signal.SIGTERM)
            if second == signal.SIGTERM:
                self.assertEqual(json.loads(said)["error"]["code"], "CANCELLED")
            else:
                self.assertEqual(said, "")

    def test_an_answer_that_cannot_be_written_is_no_success(self):
        with open("/dev/full", "w") as full:
            done = subprocess.run([LAB, "storage", "list", "--storage", self.folder, "--json"],
                                  stdout=full, stderr=subprocess.PIPE, text=True)
        self.assertEqual(done.returncode, 1)
        self.assertIn("could not be written", done.stderr)

    def test_an_import_and_a_replay_end_on_a_signal(self):
        lab("phantom", "cranium", "--out", self.folder / "ct")
        run = lab("run", SCENES / "cranium.json", "--seconds", 3, "--out", self.folder)
        for by, *command in ((signal.SIGTERM, "replay", run["recording"]),
                             (signal.SIGINT, "import", self.folder / "ct")):
            with self.subTest(command=command[0]):
                process = self.start(LAB, *command, "--json")
                self.wait_for(process, lambda: listens(process), "it listens")
                code, answer = self.end(process, by)
                self.assertEqual(code, 128 + by)
                self.assert_error(answer, "CANCELLED")

    def test_a_run_that_is_ended_keeps_recording_volume_and_table(self):
        case = small_head(self.folder / "head.nii.gz")
        for by, pace in zip(SIGNALS, (("--realtime",), ())):
            with self.subTest(signal=by.name):
                out = self.folder / by.name
                process = self.start(LAB, "run", SCENES / "cranium.json", "--case", case, *pace,
                                     "--seconds", 3000, "--save-volume", out / "carved.nii.gz",
                                     "--csv", out / "ticks.csv", "--out", out, "--json")
                self.wait_for(process, has_grown(out / "session.h5", 5), "it records")
                code, answer = self.end(process, by)
                self.assertEqual(code, 128 + by)
                self.assert_error(answer, "CANCELLED")
                again = self.assert_whole(out / "session.h5", case)
                self.assertEqual(again["ticks"], answer["ticks"])
                self.assertGreater(answer["ticks"], 100)
                saved = lab("import", out / "carved.nii.gz")["series"][0]
                self.assertEqual(saved["volume_sha256"], answer["volume_sha256"])
                self.assertEqual(answer["table"], str(out / "ticks.csv"))
                with open(out / "ticks.csv") as table:
                    self.assertEqual(sum(1 for _ in table), 1 + 2 * answer["ticks"])

    @unittest.skipUnless(WINDOW and os.environ.get("DISPLAY"), "needs the window and a display")
    def test_an_exercise_in_the_window_that_is_ended_keeps_its_recording(self):
        process = self.start(WINDOW, "--exercise", SCENES / "cranium.json", "--out", self.folder,
                             "--json")
        recording = self.wait_for(process, lambda: next(self.folder.glob("session-*.h5"), None),
                                  "its recording is there")
        self.wait_for(process, has_grown(recording, 5), "its arms move")
        code, answer = self.end(process, signal.SIGTERM)
        self.assertEqual(code, 128 + signal.SIGTERM)
        self.assert_error(answer, "CANCELLED")
        self.assertGreater(answer["ticks"], 100)
        self.assert_whole(answer["recording"], "phantom:cranium")


class FullDisk(EndingTest):
    """A disk that is full once a file has 4 MB; the carved volume is smaller. Hands that rest in a
    window record little: there it is 2 MB."""

    LIMIT = "ulimit -f 4096"

    def test_a_run_says_it_at_once_and_still_saves_what_was_cut(self):
        case = small_head(self.folder / "head.nii.gz")
        out = self.folder / "out"
        process = self.start(LAB, "run", SCENES / "cranium.json", "--case", case, "--realtime",
                             "--seconds", 3000, "--save-volume", out / "carved.nii.gz", "--out",
                             out, "--json", shell=self.LIMIT)
        said = lambda: "can no longer be written" in (self.folder / "stderr").read_text()
        self.wait_for(process, said, "it says that the disk is full")
        self.assertIsNone(process.poll(), "the exercise goes on")
        code, answer = self.end(process, signal.SIGINT)
        self.assertEqual(code, 128 + signal.SIGINT)
        self.assert_error(answer, "CANNOT_WRITE", "session.h5")
        saved = lab("import", out / "carved.nii.gz")["series"][0]
        self.assertEqual(saved["volume_sha256"], answer["volume_sha256"])
        self.assertNotEqual(answer["volume_sha256"], answer["volume_sha256_before"])
        again = lab("replay", out / "session.h5", "--case", case)
        self.assertTrue(again["identical"])
        self.assertGreater(again["ticks"], 0)

    def test_a_run_to_its_end_saves_what_was_cut_and_fails(self):
        case = small_head(self.folder / "head.nii.gz")
        process = self.start(LAB, "run", SCENES / "cranium.json", "--case", case, "--seconds", 60,
                             "--save-volume", self.folder / "carved.nii.gz", "--out", self.folder,
                             "--json", shell=self.LIMIT)
        code, answer = self.end(process)
        self.assertEqual(code, 1)
        self.assert_error(answer, "CANNOT_WRITE", "session.h5")
        self.assertGreater(answer["removed_voxels"], 100)
        saved = lab("import", self.folder / "carved.nii.gz")["series"][0]
        self.assertEqual(saved["volume_sha256"], answer["volume_sha256"])

    def test_a_disk_without_room_for_the_beginning_of_a_recording_is_said(self):
        case = small_head(self.folder / "head.nii.gz")
        for blocks in (1, 4, 8):
            process = self.start(LAB, "run", SCENES / "cranium.json", "--case", case, "--seconds", 1,
                                 "--out", self.folder / "out", "--json", shell=f"ulimit -f {blocks}")
            code, answer = self.end(process)
            self.assertEqual(code, 1)
            self.assert_error(answer, "CANNOT_WRITE", "cannot be started")

    @unittest.skipUnless(WINDOW and os.environ.get("DISPLAY"), "needs the window and a display")
    def test_an_exercise_in_the_window_goes_on_and_fails_at_its_end(self):
        process = self.start(WINDOW, "--exercise", SCENES / "cranium.json", "--seconds", 12, "--out",
                             self.folder, "--json", shell="ulimit -f 2048")
        code, answer = self.end(process)
        self.assertEqual(code, 1)
        self.assert_error(answer, "CANNOT_WRITE", "session-")
        self.assertEqual(answer["ticks"], 12000)
        self.assertTrue(lab("replay", answer["recording"])["identical"])


class Stuck(EndingTest):
    """Arms whose driver does not return, or that go away."""

    def scene_with(self, **device):
        resources = self.folder / "resources"
        shutil.copytree(SOURCE / "resources", resources)
        arms = resources / "devices" / "omni.json"
        arms.write_text(json.dumps(json.loads(arms.read_text()) | device))
        scene = resources / "scenes" / "cranium.json"
        head = small_head(scene.parent / "head.nii.gz")
        text = json.loads(scene.read_text()) | {"case": head.name}
        scene.write_text(json.dumps(text))
        moved = [{"name": arm["name"], "plugin": "simulated", "arm": place, "config": str(arms)}
                 for place, arm in enumerate(text["arms"])]
        self.arms = self.folder / "arms.json"
        self.arms.write_text(json.dumps({"format": "trephine.arms", "version": 1, "arms": moved}))
        return scene

    def test_a_run_lists_the_faults_and_exits_4(self):
        scene = self.scene_with(block_after_s=0.5, block_for_s=3600)
        process = self.start(LAB, "run", scene, "--arms", self.arms, "--realtime", "--seconds", 3000, "--out",
                             self.folder / "out", "--json")
        code, answer = self.end(process)
        self.assertEqual(code, 4)
        self.assertEqual([f["fault"] for f in answer["faults"][-2:]], ["stuck", "stuck"])
        self.assert_whole(self.folder / "out" / "session.h5", scene.parent / "head.nii.gz")

    @unittest.skipUnless(os.environ.get("DISPLAY"), "needs a display")
    def test_an_exercise_that_nobody_watches_ends_and_lists_them(self):
        scene = self.scene_with(block_after_s=0.5, block_for_s=3600)
        process = self.start(WINDOW, "--exercise", scene, "--arms", self.arms, "--seconds", 3000, "--out",
                             self.folder / "out", "--json")
        code, answer = self.end(process)
        self.assertEqual(code, 0)
        self.assertEqual(answer["faults"][-1]["fault"], "stuck")


class Damage(EndingTest):
    def test_a_replay_of_a_recording_with_a_changed_byte_ends_within_seconds(self):
        case = small_head(self.folder / "head.nii.gz")
        run = lab("run", SCENES / "cranium.json", "--case", case, "--seconds", 1, "--out", self.folder)
        whole = Path(run["recording"]).read_bytes()
        damaged = self.folder / "damaged.h5"
        places = [whole.index(mark) + 8 for mark in (b"OHDR", b"EAHD", b"EAIB", b"FRHP", b"EADB")
                  if mark in whole]
        self.assertGreater(len(places), 2)
        for place in places:
            with self.subTest(byte=place):
                changed = bytearray(whole)
                changed[place] ^= 0x55
                damaged.write_bytes(changed)
                done = subprocess.run([LAB, "replay", damaged, "--case", case, "--json"],
                                      capture_output=True, text=True, timeout=PATIENCE_S)
                self.assertIn(done.returncode, (1, 3))
                if done.returncode == 1:
                    self.assert_error(json.loads(done.stdout), "BAD_RECORDING", "damaged.h5")


if __name__ == "__main__":
    main()
