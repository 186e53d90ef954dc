"""The window crashes in the middle of an exercise: the recording is there as far as it came, a report
says what can be said without naming anybody, and the next start knows of both."""

import os
import re
import signal
import subprocess
import tempfile
import unittest
from datetime import datetime, timezone
from pathlib import Path

from lab_support import SCENES, WINDOW, has_grown, lab, main, wait_until


def start(state, out):
    environment = dict(os.environ, XDG_STATE_HOME=str(state))
    return subprocess.Popen(
        [WINDOW, "--exercise", str(SCENES / "cranium.json"), "--seconds", "60", "--out", str(out)],
        env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


class Crash(unittest.TestCase):
    def setUp(self):
        if not os.environ.get("DISPLAY"):
            self.skipTest("there is no display")
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.state, self.out = Path(temporary.name) / "state", Path(temporary.name) / "Jane Doe"

    def crashed(self, with_signal):
        process = start(self.state, self.out)
        running = self.state / "trephine" / f"running-{process.pid}"

        def named():
            self.assertIsNone(process.poll(), "it ended by itself")
            return running.exists() and running.read_text().strip()

        try:
            recording = Path(wait_until(named, "it names its recording"))
            wait_until(has_grown(recording, 5), "it records")
        finally:
            process.send_signal(with_signal)
            process.wait(timeout=60)
        self.assertEqual(process.returncode, -with_signal)
        self.assertEqual(recording.parent, self.out)
        replayed = lab("replay", recording)
        self.assertTrue(replayed["identical"], replayed)
        return self.state / "trephine" / f"crash-{process.pid}.txt"

    def test_leaves_a_report_without_a_name_and_a_recording_that_replays(self):
        report = self.crashed(signal.SIGSEGV)
        text = report.read_text()
        for part in ("SIGSEGV", "version    0", "recording  session-", "trephine +0x"):
            self.assertIn(part, text)
        ended = re.search(r"^ended +(\d+-\d\d-\d\d \d\d:\d\d:\d\d) UTC$", text, re.M)
        at = datetime.strptime(ended[1], "%Y-%m-%d %H:%M:%S").replace(tzinfo=timezone.utc)
        self.assertLess(abs((datetime.now(timezone.utc) - at).total_seconds()), 120)
        self.assertNotIn("Jane", text)
        self.assertNotIn(str(Path.home()), text.replace("recording", ""))

    def test_killed_it_leaves_the_recording_alone(self):
        self.assertFalse(self.crashed(signal.SIGKILL).exists())


if __name__ == "__main__":
    main()
