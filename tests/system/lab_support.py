"""Running trephine-lab from tests: what it prints, and what it must look like."""

import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

LAB = os.environ["TREPHINE_LAB"]
SOURCE = Path(os.environ["TREPHINE_SOURCE"])
SCENES = SOURCE / "resources" / "scenes"


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


class LabTest(unittest.TestCase):
    def setUp(self):
        self._folder = tempfile.TemporaryDirectory(prefix="trephine-")
        self.folder = Path(self._folder.name)
        self.addCleanup(self._folder.cleanup)

    def assert_error(self, answer, code, *words):
        """One clear answer: a stable code, what, where and what to do next."""
        error = answer["error"]
        self.assertEqual(set(error), {"code", "what", "where", "next"})
        self.assertEqual(error["code"], code)
        self.assertTrue(error["what"])
        for word in words:
            self.assertIn(word, " ".join(error.values()))


def data_folder():
    """The real CT, or None where TREPHINE_TEST_DATA is not set."""
    folder = os.environ.get("TREPHINE_TEST_DATA")
    return Path(folder) if folder else None
