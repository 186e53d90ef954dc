"""What a workstation locks, and that the command line is no way round it; the PIN."""

import hashlib
import json
import os
import pty
import shutil
import subprocess
import unittest

from lab_support import (
    LAB, PATIENCE_S, SCENES, TRAINEE, WINDOW, LabTest, TraineeTest, main, wait_until,
    without_display)

PRODUCT = SCENES / "cranium-one-arm.json"


class Pin(LabTest):
    def check(self, pin, text):
        self.assertEqual(pin["algorithm"], "pbkdf2-sha256")
        made = hashlib.pbkdf2_hmac("sha256", text.encode(), bytes.fromhex(pin["salt_hex"]),
                                   pin["iterations"])
        self.assertEqual(made.hex(), pin["hash_hex"])

    def test_a_pin_is_read_from_stdin_and_printed_as_a_hash(self):
        done = subprocess.run([LAB, "pin"], input="4711ab\n", capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.check(json.loads(done.stdout), "4711ab")
        self.assertNotIn("4711ab", done.stdout + done.stderr)
        self.assertIn("/etc/trephine/settings.json", done.stderr)
        done = subprocess.run([LAB, "pin", "--json"], input="4711ab", capture_output=True, text=True)
        answer = json.loads(done.stdout)
        self.assertEqual(answer["schema"], "trephine.pin.1")
        self.check(answer["pin"], "4711ab")

    def test_a_pin_that_cannot_be_is_refused(self):
        for text in ("", "123", "12 34", "1234567890123"):
            with self.subTest(text):
                done = subprocess.run([LAB, "pin", "--json"], input=text + "\n",
                                      capture_output=True, text=True)
                self.assertEqual(done.returncode, 1)
                self.assertEqual(json.loads(done.stdout)["error"]["code"], "BAD_PIN")

    def typed(self, *lines):
        """On a terminal: exit code, stdout, and what the terminal showed."""
        mine, theirs = pty.openpty()
        with subprocess.Popen([LAB, "pin"], stdin=theirs, stdout=subprocess.PIPE,
                              stderr=theirs) as process:
            os.close(theirs)
            shown = b""
            for line in lines:
                while not shown.rstrip(b" ").endswith(b":"):
                    shown += os.read(mine, 1024)
                os.write(mine, line.encode() + b"\n")
                shown += b"|"
            out = process.stdout.read()
            process.wait()
            while True:
                try:
                    more = os.read(mine, 1024)
                except OSError:
                    break
                shown += more
                if not more:
                    break
        os.close(mine)
        return process.returncode, out.decode(), shown.decode()

    def test_on_a_terminal_it_is_asked_twice_and_not_shown(self):
        code, out, shown = self.typed("geheim7", "geheim7")
        self.assertEqual(code, 0, shown)
        self.check(json.loads(out), "geheim7")
        self.assertNotIn("geheim7", shown)
        code, out, shown = self.typed("geheim7", "geheim8")
        self.assertEqual((code, out), (1, ""))
        self.assertIn("not the same", shown)


class Locked(TraineeTest):
    def run_as_trainee(self, scene, *arguments, environment=()):
        """The answer of `run` in 0.05 s of a scene."""
        command = self.as_trainee(LAB, "run", scene, "--out", self.trainees_folder("out"),
                                  "--seconds", "0.05", "--json", *arguments)
        done = subprocess.run(command, capture_output=True, text=True, timeout=240,
                              env={**without_display(), **dict(environment)})
        self.assertTrue(done.stdout, done.stderr)
        return json.loads(done.stdout)

    def assert_locked(self, answer, *words):
        self.assert_error(answer, "LOCKED", *words)

    def test_without_settings_a_scene_of_ones_own_runs(self):
        self.assertGreater(self.run_as_trainee(self.own)["ticks"], 0)

    def test_a_scene_of_ones_own_brings_nothing_that_is_locked(self):
        self.settings({"tissues": True})
        self.assert_locked(self.run_as_trainee(self.own), "tissues")
        self.assertGreater(self.run_as_trainee(PRODUCT, "--case", self.head)["ticks"], 0)
        self.settings({"controller": "bounded", "rate": 1000})
        self.assertGreater(self.run_as_trainee(self.own)["ticks"], 0)

    def test_an_argument_changes_nothing_that_is_locked(self):
        self.settings({"controller": True, "rate": True})
        self.assert_locked(self.run_as_trainee(PRODUCT, "--controller", "off"), "--controller")
        self.assert_locked(self.run_as_trainee(PRODUCT, "--rate", "2000"), "--rate")
        same = self.run_as_trainee(PRODUCT, "--case", self.head, "--rate", "1000", "--controller",
                                   "bounded")
        self.assertGreater(same["ticks"], 0)

    def test_the_environment_brings_no_scenes_of_ones_own(self):
        self.settings({"tissues": True})
        resources = self.folder / "resources"
        (resources / "scenes").mkdir(parents=True)
        own = resources / "scenes" / "own.json"
        shutil.copy(self.own, own)
        answer = self.run_as_trainee(own, environment={"TREPHINE_RESOURCES": str(resources)})
        self.assert_locked(answer, "tissues")

    def test_explain_says_what_is_locked_and_kept_out(self):
        def explained(scene):
            done = subprocess.run(self.as_trainee(LAB, "explain", scene, "--json"),
                                  capture_output=True, text=True, timeout=240)
            return json.loads(done.stdout), done.stderr

        answer, said = explained(PRODUCT)
        self.assertEqual((answer["locks"], answer["refused"], said), ([], None, ""))
        self.settings({"controller": "off", "tissues": True})
        answer, _ = explained(PRODUCT)
        self.assertEqual(answer["locks"], ["controller", "tissues"])
        self.assertIn("'off' alone", answer["refused"])
        self.settings({}, 0, 0o666)
        answer, said = explained(PRODUCT)
        self.assertEqual(answer["locks"], ["controller", "tissues", "rate"])
        self.assertIn("Everything is locked", said)

    def test_settings_that_a_trainee_could_have_written_lock_everything(self):
        for owner, mode in ((TRAINEE, 0o644), (0, 0o666)):
            with self.subTest(owner=owner, mode=mode):
                self.settings({}, owner, mode)
                answer = self.run_as_trainee(self.own)
                self.assert_locked(answer, "tissues, a controller, a rate", "Everything is locked")


@unittest.skipUnless(WINDOW and os.environ.get("DISPLAY"), "needs the window and a display")
class LockedWindow(TraineeTest):
    """The window's own program, as a trainee starts it."""

    LOCKS = {"controller": "bounded", "tissues": True, "rate": 1000}

    def setUp(self):
        super().setUp()
        self.settings(self.LOCKS)
        self.home = self.trainees_folder("home")
        self.config = self.trainees_folder("home/config")
        self.environment = {**os.environ, "HOME": str(self.home),
                            "XDG_CONFIG_HOME": str(self.config),
                            "XDG_DATA_HOME": str(self.trainees_folder("home/data")),
                            "XDG_STATE_HOME": str(self.trainees_folder("home/state")),
                            "XDG_RUNTIME_DIR": str(self.trainees_folder("home/run"))}
        if key := os.environ.get("XAUTHORITY"):
            mine = self.home / "xauthority"
            shutil.copy(key, mine)
            os.chown(mine, TRAINEE, TRAINEE)
            self.environment["XAUTHORITY"] = str(mine)

    def own_scenes(self, folder=None):
        """Scenes of the trainee's own: what of each is locked, and its file."""
        scene = json.loads(self.own.read_text())
        changes = {"controller": {"controller": "off"}, "rate": {"rate_hz": 2000}, "tissues": {}}
        for locked, change in changes.items():
            self.assertTrue(all(key in scene for key in change), change)
            file = (folder or self.folder) / f"{locked}.json"
            file.write_text(json.dumps(scene | change))
            yield locked, file

    def exercise(self, scene, environment=()):
        """The window's answer after 0.2 s of a scene, and its recordings."""
        out = self.trainees_folder("out")
        command = self.as_trainee(WINDOW, "--exercise", scene, "--seconds", "0.2", "--out", out,
                                  "--json")
        done = subprocess.run(command, capture_output=True, text=True, timeout=240,
                              env={**self.environment, **dict(environment)})
        self.assertTrue(done.stdout, done.stderr)
        return json.loads(done.stdout), list(out.rglob("*.h5"))

    def assert_refused(self, answer, recordings, locked):
        self.assert_error(answer, "LOCKED", locked)
        self.assertEqual(recordings, [])

    def assert_as_shipped(self, answer, recordings):
        self.assertEqual(answer["ticks"], 200, answer)
        run = recordings[0].read_bytes()
        begin = run.index(b'{\n "format": "trephine.scene"')
        scene = json.loads(run[begin:run.index(b"\0", begin)])
        shipped = json.loads(PRODUCT.read_text())
        tissues = json.loads((PRODUCT.parent / shipped["tissues"]).read_text())
        self.assertEqual((scene["controller"], scene["rate_hz"]), ("bounded", 1000))
        for mine, theirs in zip(scene["tissues"]["tissues"], tissues["tissues"], strict=True):
            self.assertEqual((mine["id"], mine["hu"], mine["mechanics"]["damping_Ns_per_m"]),
                             (theirs["id"], theirs["hu"], theirs["mechanics"]["damping_Ns_per_m"]))

    def test_an_exercise_of_ones_own_is_refused_in_a_sentence(self):
        for locked, scene in self.own_scenes():
            with self.subTest(locked):
                answer, recordings = self.exercise(scene)
                self.assert_refused(answer, recordings, locked)

    def test_the_products_own_runs_as_it_is_shipped_whatever_the_users_settings_say(self):
        (self.config / "trephine").mkdir()
        (self.config / "trephine" / "window.ini").write_text(
            "[locks]\ncontroller=false\ntissues=false\nrate=false\n"
            "[General]\ncontroller=off\nrate_hz=2000\nlanguage=en\n")
        (self.config / "trephine" / "settings.json").write_text(
            json.dumps({"format": "trephine.settings", "version": 1, "locks": {}}))
        self.assert_as_shipped(*self.exercise(PRODUCT))
        for locked, scene in self.own_scenes():
            answer, recordings = self.exercise(scene)
            self.assert_refused(answer, recordings, locked)

    def test_the_environment_brings_nothing_that_is_locked(self):
        resources = self.folder / "resources"
        shutil.copytree(SCENES.parent, resources)
        for file in (resources / "tissues").iterdir():
            file.write_text(file.read_text().replace('"value": 1', '"value": 2'))
        environment = {"TREPHINE_RESOURCES": str(resources), "TREPHINE_PLUGINS": str(resources),
                       "XDG_CONFIG_DIRS": str(self.config)}
        for locked, scene in self.own_scenes(resources / "scenes"):
            answer, recordings = self.exercise(scene, environment)
            self.assert_refused(answer, recordings, locked)
        self.assert_as_shipped(*self.exercise(PRODUCT, environment))

    def test_a_path_is_refused_in_the_open_window(self):
        for locked, scene in self.own_scenes():
            with self.subTest(locked):
                log = self.folder / "log"
                with open(log, "w") as said:
                    process = subprocess.Popen(self.as_trainee(WINDOW, scene), stderr=said,
                                               stdout=said, env=self.environment)
                self.addCleanup(process.kill)

                def refused():
                    self.assertIsNone(process.poll(), log.read_text())
                    return "LOCKED" in log.read_text()

                wait_until(refused, "it is refused", PATIENCE_S)
                self.assertNotIn(scene.name, log.read_text())
                process.terminate()
                process.wait(PATIENCE_S)
                self.assertEqual(list(self.home.rglob("*.h5")), [])


if __name__ == "__main__":
    main()
