"""What a workstation locks, and that the command line is no way round it; the PIN."""

import hashlib
import json
import os
import pty
import shutil
import subprocess
import unittest
from pathlib import Path

from lab_support import LAB, SCENES, LabTest, small_scene, without_display

PRODUCT = SCENES / "cranium-one-arm.json"
TRAINEE = 65534  # "nobody": owns nothing that these tests need


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


def can_mount():
    return subprocess.run(["unshare", "-m", "true"], capture_output=True).returncode == 0


class Locked(LabTest):
    """With an /etc of its own, in a mount namespace of its own."""

    def setUp(self):
        super().setUp()
        if os.geteuid() != 0 or not can_mount():
            self.skipTest("Only root can put another /etc in the place of this one")
        self.etc = self.folder / "etc"
        self.etc.mkdir()
        for file in Path("/etc").iterdir():  # what programs need to start
            if file.name in ("alternatives", "ld.so.cache", "passwd", "group", "fonts"):
                subprocess.run(["cp", "-a", file, self.etc], check=True)
        self.folder.chmod(0o755)
        (self.etc / "trephine").mkdir()
        self.own = small_scene(self.folder)  # a scene of the user's
        self.head = self.folder / "head.nii.gz"

    def settings(self, locks, owner=0, mode=0o644):
        file = self.etc / "trephine" / "settings.json"
        file.write_text(json.dumps({"format": "trephine.settings", "version": 1, "locks": locks}))
        os.chown(file, owner, owner)
        file.chmod(mode)

    def run_as_trainee(self, scene, *arguments, environment=()):
        """The answer of `run` in 0.05 s of a scene."""
        out = self.folder / "out"
        shutil.rmtree(out, ignore_errors=True)
        out.mkdir()
        os.chown(out, TRAINEE, TRAINEE)
        command = ["unshare", "-m", "bash", "-c",
                   f'mount --make-rprivate / && mount --bind "{self.etc}" /etc && exec "$@"', "_",
                   "setpriv", f"--reuid={TRAINEE}", f"--regid={TRAINEE}", "--clear-groups",
                   LAB, "run", scene, "--out", out, "--seconds", "0.05", "--json", *arguments]
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

    def test_settings_that_a_trainee_could_have_written_lock_everything(self):
        for owner, mode in ((TRAINEE, 0o644), (0, 0o666)):
            with self.subTest(owner=owner, mode=mode):
                self.settings({}, owner, mode)
                answer = self.run_as_trainee(self.own)
                self.assert_locked(answer, "tissues, a controller, a rate", "Everything is locked")


if __name__ == "__main__":
    unittest.main()
