"""What an import promises of memory is what opening and practising take: under that limit and a
little more everything goes well, under less it is said in words and nothing is harmed."""

import array
import hashlib
import json
import os
import resource
import signal
import subprocess
import threading
import unittest
from pathlib import Path

from lab_support import (LAB, PATIENCE_S, SCENES, WINDOW, LabTest, lab, main, wait_until,
                         without_display)

MB = 2**20


def large_head(file, edge=480):
    """A ball of bone around brain in a box of 200 mm."""
    spacing = 200.0 / edge
    header = (f"ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
              f"TransformMatrix = 1 0 0 0 1 0 0 0 1\nOffset = 0 0 0\n"
              f"ElementSpacing = {spacing} {spacing} {spacing}\nDimSize = {edge} {edge} {edge}\n"
              f"ElementType = MET_SHORT\nElementDataFile = LOCAL\n")
    place = [(spacing * (i - (edge - 1) / 2)) ** 2 for i in range(edge)]

    def run(beyond, radius):
        """How many voxels of a row lie within the ball."""
        rest = radius**2 - beyond
        return 0 if rest <= 0 else 2 * min(edge // 2, round(rest**0.5 / spacing))

    def layer(hu, voxels):
        return array.array("h", [hu]) * voxels

    with open(file, "wb") as out:
        out.write(header.encode())
        for k in range(edge):
            for j in range(edge):
                skin, bone, brain = (run(place[j] + place[k], radius) for radius in (90, 80, 70))
                half = (layer(-1000, (edge - skin) // 2), layer(-20, (skin - bone) // 2),
                        layer(1200, (bone - brain) // 2))
                row = half[0] + half[1] + half[2] + layer(35, brain)
                out.write((row + half[2] + half[1] + half[0]).tobytes())
    return file


class Limit:
    """So much memory for a program: a control group's, or RLIMIT_DATA where none can be made."""

    def __init__(self, mb):
        self.bytes = int(mb * MB)
        self.group = self.file = None
        for line in Path("/proc/self/cgroup").read_text().splitlines():
            _, controllers, path = line.split(":", 2)
            if "memory" in controllers.split(","):
                root, self.file = Path("/sys/fs/cgroup/memory"), "memory.limit_in_bytes"
            elif not controllers and not self.file:
                root, self.file = Path("/sys/fs/cgroup"), "memory.max"
            else:
                continue
            own = root / path.lstrip("/")
            self.group = (own if own.is_dir() else root) / f"trephine-test-{os.getpid()}"
        try:
            self.group.mkdir()
            (self.group / self.file).write_text(str(self.bytes))
            (self.group / "cgroup.procs").stat()
            self.kind = f"control group ({self.file})"
        except (OSError, AttributeError):
            if self.group and self.group.is_dir():
                self.group.rmdir()
            self.group, self.kind = None, "RLIMIT_DATA"

    def enter(self):
        if self.group:
            (self.group / "cgroup.procs").write_text(str(os.getpid()))
        else:
            resource.setrlimit(resource.RLIMIT_DATA, (self.bytes, self.bytes))

    def taken_mb(self, process):
        """Of memory that is the program's own: not the pages of files."""
        try:
            status = Path(f"/proc/{process.pid}/status").read_text()
            return int(status.split("RssAnon:")[1].split()[0]) / 1024
        except (OSError, IndexError):
            return 0.0

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.group:
            wait_until(self.removed, "the control group is empty", 10)

    def removed(self):
        try:
            self.group.rmdir()
            return True
        except OSError:
            return False


class UnderALimit:
    """Of a LabTest."""

    def run_under(self, limit_mb, *command, environment=None):
        """The exit code, the answer and the most that it took [MB]."""
        with Limit(limit_mb) as limit:
            process = subprocess.Popen([str(word) for word in command], stdout=subprocess.PIPE,
                                       stderr=subprocess.PIPE, text=True, env=environment,
                                       preexec_fn=limit.enter)
            most, ended = [0.0], threading.Event()

            def watch():
                while not ended.wait(0.005):
                    most[0] = max(most[0], limit.taken_mb(process))

            watcher = threading.Thread(target=watch)
            watcher.start()
            try:
                out, err = process.communicate(timeout=2 * PATIENCE_S)
            finally:
                process.kill()
                ended.set()
                watcher.join()
            self.assertNotEqual(process.returncode, -signal.SIGKILL, "killed for its memory")
            try:
                return process.returncode, json.loads(out), most[0]
            except ValueError:
                self.fail(f"no answer: {process.returncode} {out[-500:]} {err[-500:]}")

    def setUp(self):
        super().setUp()
        self.case = large_head(self.folder / "head.mha")
        self.sha256 = hashlib.sha256(self.case.read_bytes()).hexdigest()
        series = lab("import", self.case)["series"][0]
        self.promised_mb = series["memory_mb"]
        self.out = self.folder / "out"

    def assert_nothing_harmed(self):
        self.assertEqual(hashlib.sha256(self.case.read_bytes()).hexdigest(), self.sha256)
        self.assertEqual([file for file in self.out.rglob("*") if file.is_file()], [])

    def scene(self):
        scene = json.loads((SCENES / "cranium.json").read_text())
        scene["case"] = str(self.case)
        for holder, key in [(scene, "tissues"), (scene, "operator"),
                            *((tool, "file") for tool in scene["tools"])]:
            holder[key] = str((SCENES / holder[key]).resolve())
        file = self.folder / "scene.json"
        file.write_text(json.dumps(scene))
        return file


class Headless(UnderALimit, LabTest):
    def command(self):
        return (LAB, "run", SCENES / "cranium.json", "--case", self.case, "--seconds", 2, "--out",
                self.out, "--json")

    def test_a_run_fits_into_what_was_promised_and_says_when_it_does_not_fit(self):
        code, answer, most_mb = self.run_under(1.15 * self.promised_mb, *self.command())
        self.assertEqual(code, 0, answer)
        print(f"promised {self.promised_mb:.0f} MB; a run took {most_mb:.0f} MB")
        self.assertLess(most_mb, self.promised_mb)
        # Without a display there is no picture, and its two copies are not needed.
        bare = without_display()
        self.out = self.folder / "bare"
        code, answer, most_mb = self.run_under(1.15 * self.promised_mb, *self.command(),
                                               environment=bare)
        self.assertEqual(code, 0, answer)
        self.out = self.folder / "little"
        code, answer, _ = self.run_under(0.9 * most_mb, *self.command(), environment=bare)
        self.assertEqual(code, 1, answer)
        self.assert_error(answer, "OUT_OF_MEMORY", "needs", "MB", "Close other programs")
        print(f"without a picture {most_mb:.0f} MB; with 10 % less: {answer['error']['what']}")
        self.assert_nothing_harmed()


@unittest.skipUnless(os.environ.get("DISPLAY"), "no display")
class Window(UnderALimit, LabTest):
    def command(self):
        return WINDOW, "--exercise", self.scene(), "--seconds", 2, "--out", self.out, "--json"

    def test_the_window_fits_into_what_was_promised_and_says_when_it_does_not_fit(self):
        code, answer, most_mb = self.run_under(1.15 * self.promised_mb, *self.command())
        self.assertEqual(code, 0, answer)
        print(f"promised {self.promised_mb:.0f} MB; the window took {most_mb:.0f} MB")
        self.assertGreater(most_mb, 0.8 * self.promised_mb, "no more is promised than is true")
        self.out = self.folder / "little"
        code, answer, _ = self.run_under(0.9 * self.promised_mb, *self.command())
        self.assertEqual(code, 1, answer)
        self.assert_error(answer, "OUT_OF_MEMORY", "needs", "MB", "Close other programs")
        print(f"with 10 % less: {answer['error']['what']}")
        self.assert_nothing_harmed()


if __name__ == "__main__":
    main()
