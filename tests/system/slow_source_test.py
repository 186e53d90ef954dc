"""A stick of 5 MB/s, as trephine-lab sees it: how long it takes is told on a terminal, a signal ends
it at once, and what vanishes is refused as a whole."""

import json
import os
import pty
import signal
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

from lab_support import LAB, PATIENCE_S, main

SLOW_SOURCE = os.environ["SLOW_SOURCE"]
STICK = 5e6  # bytes a second
AT_ONCE_S = 0.5


class SlowSource(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = Path(temporary.name) / "stick"
        subprocess.run([LAB, "phantom", "cranium", "--out", cls.folder], check=True,
                       capture_output=True)

    def environment(self, **more):
        return {**os.environ, "LD_PRELOAD": SLOW_SOURCE, "SLOW_SOURCE_FOLDER": str(self.folder),
                "SLOW_SOURCE_RATE": str(STICK), **more}

    def start(self, *arguments):
        """The program with its stderr on a terminal, and that terminal's other end."""
        ours, its = pty.openpty()
        process = subprocess.Popen([LAB, *map(str, arguments)], stdout=subprocess.PIPE, stderr=its,
                                   env=self.environment())
        os.close(its)
        self.addCleanup(os.close, ours)
        return process, ours

    def wait_for(self, terminal, word):
        seen, end = b"", time.monotonic() + PATIENCE_S
        while word not in seen and time.monotonic() < end:
            seen += os.read(terminal, 4096)
        self.assertIn(word, seen)

    def test_the_time_left_is_told_and_a_signal_ends_it_at_once(self):
        process, terminal = self.start("import", self.folder, "--json")
        self.wait_for(terminal, b"Reading slices, about ")
        process.send_signal(signal.SIGINT)
        sent = time.monotonic()
        answer = json.loads(process.communicate(timeout=PATIENCE_S)[0])
        took = time.monotonic() - sent
        print(f"ended {1000 * took:.0f} ms after the signal")
        self.assertEqual(answer["error"]["code"], "CANCELLED")
        self.assertEqual(process.returncode, 128 + signal.SIGINT)
        self.assertLess(took, AT_ONCE_S)

    def test_what_vanishes_while_it_is_read_is_refused_as_a_whole(self):
        size = sum(f.stat().st_size for f in self.folder.iterdir())
        done = subprocess.run(
            [LAB, "import", self.folder, "--json"], capture_output=True, text=True,
            env=self.environment(SLOW_SOURCE_RATE="1e9", SLOW_SOURCE_LASTS=str(size * 0.6)))
        answer = json.loads(done.stdout)
        self.assertEqual(done.returncode, 2)
        self.assertEqual(answer["error"]["code"], "SOURCE_VANISHED")
        (series,) = answer["series"]
        self.assertEqual(series["verdict"], "refused")
        self.assertNotIn("MISSING_SLICES", [f["code"] for f in series["findings"]])


if __name__ == "__main__":
    main()
