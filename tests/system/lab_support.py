"""Running the programs from tests: what they print, and what it must look like."""

import csv
import gzip
import json
import os
import shutil
import struct
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

LAB = os.environ["TREPHINE_LAB"]
WINDOW = os.environ["TREPHINE"]
SOURCE = Path(os.environ["TREPHINE_SOURCE"])
SCENES = SOURCE / "resources" / "scenes"
TRAINEE = 65534  # "nobody": owns nothing that these tests need
PATIENCE_S = 120  # with a busy machine; alone nothing that waits for it takes more than seconds


def wait_until(condition, what, seconds=60):
    """Returns what the condition gives once that is true. The one sleep of the tests in Python."""
    end = time.monotonic() + seconds
    while not (answer := condition()):
        if time.monotonic() > end:
            raise AssertionError(f"{what}: it did not come within {seconds} s")
        time.sleep(0.02)  # nobody would wake us
    return answer


def has_grown(file, times):
    """A condition: a file that was not there, or was as it is now, has grown that often. What is
    recorded in real time goes to the disk every 0.25 s."""
    sizes = []

    def look():
        size = file.stat().st_size if file.exists() else 0
        if not sizes or size > sizes[-1]:
            sizes.append(size)
        return len(sizes) > times

    return look


def computed_s(process):
    """What it has had of the processors."""
    fields = Path(f"/proc/{process.pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def lab(*arguments, expect=0, environment=None, timeout=240):
    """Runs trephine-lab with --json and returns its one JSON object."""
    done = subprocess.run(
        [LAB, *map(str, arguments), "--json"], capture_output=True, text=True, timeout=timeout,
        env=environment)
    assert done.returncode == expect, (
        f"{arguments} ended with {done.returncode}: {done.stdout[-500:]} {done.stderr[-500:]}")
    answer = json.loads(done.stdout)
    assert answer["schema"].startswith("trephine.") and answer["build"], answer
    return answer


SHIPPED = ("burr-hole", "cranium", "cranium-one-arm", "liver", "liver-one-arm")


def first_ten_seconds(name, folder, *case):
    """Of each arm of a shipped scene: when its own script first lets it feel something, and the
    mm3 that it removed by the end."""
    table = folder / f"{name}.csv"
    run = lab("run", SCENES / f"{name}.json", *case, "--seconds", 10, "--csv", table, "--out",
              folder, environment=without_display())
    arms = {arm["name"]: {"touches_s": None, "mm3": arm["removed_mm3"]} for arm in run["arms"]}
    with open(table, newline="") as file:
        for row in csv.DictReader(file):
            arm = arms[row["arm"]]
            if arm["touches_s"] is None and any(float(row[f"f_e_{axis}_N"]) for axis in "xyz"):
                arm["touches_s"] = float(row["t_s"])
    for arm, did in arms.items():
        print(f"{name} {'real' if case else 'own'} {arm}: {did}")
    return arms


def small_head(file, size=(80, 80, 80), spacing_mm=(1.2, 1.2, 1.2)):
    """A ball of bone in scalp, at the middle of the box."""
    header = bytearray(352)
    struct.pack_into("<i", header, 0, 348)
    struct.pack_into("<8h", header, 40, 3, *size, 1, 1, 1, 1)
    struct.pack_into("<2h", header, 70, 4, 16)
    struct.pack_into("<4f", header, 76, 1, *spacing_mm)
    struct.pack_into("<f", header, 108, 352)
    struct.pack_into("<f", header, 112, 1)
    struct.pack_into("<h", header, 254, 1)
    places = [[step * (i - (n - 1) / 2) for i in range(n)] for n, step in zip(size, spacing_mm)]
    for row in range(3):
        line = [0.0, 0.0, 0.0, places[row][0]]
        line[row] = spacing_mm[row]
        struct.pack_into("<4f", header, 280 + 16 * row, *line)
    header[344:348] = b"n+1\0"
    voxels = []
    for z in places[2]:
        for y in places[1]:
            for x in places[0]:
                rr = x * x + y * y + z * z
                voxels.append(35 if rr < 32**2 else 1200 if rr < 39**2 else -20 if rr < 44**2 else -1024)
    file.write_bytes(gzip.compress(bytes(header) + struct.pack(f"<{len(voxels)}h", *voxels), 1))
    return file


def small_scene(folder, tool=None):
    """The shipped scene of one arm in a small head, in a file of its own, with a tool of its own."""
    scene = json.loads((SCENES / "cranium-one-arm.json").read_text())
    for part, where in (("tissues", "tissues"), ("operator", "operators")):
        scene[part] = str(SCENES.parent / where / Path(scene[part]).name)
    arm = scene["arms"][0]
    del arm["other_tools"]
    scene["tools"] = [{"id": arm["tool"], **(tool or {"file": str(SCENES.parent / "tools" / "blade.json")})}]
    scene["case"] = str(small_head(folder / "head.nii.gz"))
    (folder / "scene.json").write_text(json.dumps(scene))
    return folder / "scene.json"


def without_display():
    environment = dict(os.environ)
    environment.pop("DISPLAY", None)
    return environment


class LabTest(unittest.TestCase):
    def setUp(self):
        self._folder = tempfile.TemporaryDirectory(prefix="trephine-")
        self.folder = Path(self._folder.name)
        self.addCleanup(self._folder.cleanup)

    def assert_touches_and_removes(self, arms):
        for arm, did in arms.items():
            self.assertIsNotNone(did["touches_s"], arm)
            self.assertLess(did["touches_s"], 10.0, arm)
            self.assertGreaterEqual(did["mm3"], 50.0, arm)

    def assert_error(self, answer, code, *words):
        """One clear answer: a stable code, what, where and what to do next."""
        error = answer["error"]
        self.assertEqual(set(error), {"code", "what", "where", "next"})
        self.assertEqual(error["code"], code)
        self.assertTrue(error["what"])
        for word in words:
            self.assertIn(word, " ".join(error.values()))


class EndingTest(LabTest):
    """Programs that are started, waited for and ended."""

    def start(self, *command, shell=None):
        words = [str(word) for word in command]
        if shell:  # sets a limit, then becomes the program
            words = ["bash", "-c", f'{shell}; exec "$@"', "bash", *words]
        with open(self.folder / "stderr", "w") as error:
            process = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=error, text=True)
        self.addCleanup(process.kill)
        return process

    def wait_for(self, process, condition, what):
        """Of a program that goes on until then."""
        def came():
            answer = condition()
            if not answer:
                self.assertIsNone(process.poll(), (self.folder / "stderr").read_text())
            return answer

        return wait_until(came, what, PATIENCE_S)

    def end(self, process, by=None):
        """Sends the signal; the exit code and the answer."""
        if by:
            process.send_signal(by)
        out, _ = process.communicate(timeout=PATIENCE_S)
        return process.returncode, json.loads(out)

    def assert_whole(self, recording, case):
        """It has its end, and replays to it."""
        again = subprocess.run([LAB, "replay", recording, "--case", case, "--json"],
                               capture_output=True, text=True, timeout=PATIENCE_S)
        self.assertEqual(again.returncode, 0, again.stdout + again.stderr)
        self.assertNotIn("cut short", again.stderr)
        return json.loads(again.stdout)


class PatientsScanTest(LabTest):
    """A scan whose folder and files are named after a patient."""
    FOLDER, FILE = "MUELLER^ANNA", "ANNAMUELLER"

    def setUp(self):
        super().setUp()
        self.scan = self.folder / self.FOLDER
        lab("phantom", "cranium", "--out", self.scan)
        for file in self.scan.iterdir():
            file.rename(self.scan / f"{self.FILE}-{file.name}")
        self.slices = sorted(self.scan.iterdir())

    def log(self, *arguments, before=""):
        """Runs trephine-lab, after shell words, and returns what it logged, which names nobody."""
        words = " ".join(f'"{word}"' for word in map(str, arguments))
        done = subprocess.run(["bash", "-c", f'{before} exec "{LAB}" {words} --json'],
                              capture_output=True, text=True, timeout=240)
        self.assertTrue(json.loads(done.stdout)["schema"])
        for name in (self.FOLDER, self.FILE):
            self.assertNotIn(name, done.stderr, arguments)
        return done.stderr


def can_mount():
    return os.geteuid() == 0 and subprocess.run(["unshare", "-m", "true"], capture_output=True).returncode == 0


class TraineeTest(LabTest):
    """As an account without rights, with an /etc of its own, in a mount namespace of its own."""

    def setUp(self):
        super().setUp()
        if not can_mount():
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

    def as_trainee(self, *command):
        """The same command, as a trainee runs it."""
        return ["unshare", "-m", "bash", "-c",
                f'mount --make-rprivate / && mount --bind "{self.etc}" /etc && exec "$@"', "_",
                "setpriv", f"--reuid={TRAINEE}", f"--regid={TRAINEE}", "--clear-groups",
                *map(str, command)]

    def trainees_folder(self, name):
        folder = self.folder / name
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        os.chown(folder, TRAINEE, TRAINEE)
        return folder


def data_folder():
    """The real CT, or None where TREPHINE_TEST_DATA is not set."""
    folder = os.environ.get("TREPHINE_TEST_DATA")
    return Path(folder) if folder else None


def main():
    """As unittest's; where every test was skipped it ends with 77, which ctest takes for skipped."""
    result = unittest.main(exit=False).result
    if result.wasSuccessful() and result.testsRun and len(result.skipped) == result.testsRun:
        sys.exit(77)
    sys.exit(0 if result.wasSuccessful() else 1)
