"""`trephine-lab commission` on machines that lack something: each lack is named, with the next step."""

import json
import os
import resource
import subprocess
import tempfile
import unittest
from pathlib import Path

from lab_support import LAB, without_display

SECONDS = "0.3"


class Commission(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)

    def run_it(self, environment=None, before=None, storage=None):
        environment = dict(environment or os.environ, XDG_STATE_HOME=str(self.folder / "state"))
        done = subprocess.run(
            [LAB, "commission", "--json", "--seconds", SECONDS, "--out", str(self.folder / "out"),
             "--storage", str(storage or self.folder / "storage")],
            env=environment, preexec_fn=before, capture_output=True, text=True, timeout=240)
        self.assertEqual(done.returncode, 0, done.stderr[-500:])
        answer = json.loads(done.stdout)
        return {check["name"]: check for check in answer["checks"]}

    def test_each_check_has_value_limit_verdict_and_next_step(self):
        checks = self.run_it()
        for name in ("lateness_1000_normal", "priority", "locked_memory", "opengl", "volume_edge",
                     "frame_time", "removal_to_pixel", "hand_to_tool", "disk_write", "disk_room",
                     "memory", "clock", "arms", "headset"):
            check = checks[name]
            self.assertIn(check["verdict"], ("pass", "warn", "fail"))
            self.assertIsNotNone(check["limit"], name)
            self.assertEqual(check["verdict"] == "pass", check["next"] == "", check)
            print(f"{name}: {check['value']} {check['unit']}, {check['verdict']}")
        page = (self.folder / "out/commission.html").read_text()
        self.assertIn("Commissioning of this workstation", page)
        if "llvmpipe" in checks["opengl"]["remark"]:
            self.assertEqual(checks["opengl"]["verdict"], "warn")
        # The next time only what is otherwise is said.
        self.run_it(without_display())
        self.assertRegex((self.folder / "out/commission.html").read_text(), r"before, .* now")

    def test_without_a_display_what_is_drawn_fails_and_says_so(self):
        checks = self.run_it(without_display())
        for name in ("opengl", "frame_time"):
            self.assertEqual(checks[name]["verdict"], "fail")
            self.assertTrue(checks[name]["next"])

    def test_without_priority_and_locked_memory_it_warns(self):
        def lacks():
            resource.setrlimit(resource.RLIMIT_RTPRIO, (0, 0))
            resource.setrlimit(resource.RLIMIT_MEMLOCK, (65536, 65536))
            if os.geteuid() == 0:  # root's rights stand above limits
                os.setgroups([])
                os.setgid(65534)
                os.setuid(65534)
        for name in ("out", "storage", "state"):
            (self.folder / name).mkdir()
        for path in [self.folder, *self.folder.iterdir()]:
            path.chmod(0o777)
        environment = dict(without_display(), HOME=str(self.folder))
        checks = self.run_it(environment, lacks)
        self.assertEqual(checks["priority"]["verdict"], "warn")
        self.assertIn("group trephine", checks["priority"]["next"])
        self.assertEqual(checks["locked_memory"]["verdict"], "warn")

    def test_a_small_disk_fails(self):
        if os.geteuid() != 0:
            self.skipTest("only root can mount a small disk")
        small = self.folder / "small"
        small.mkdir()
        subprocess.run(["mount", "-t", "tmpfs", "-o", "size=1g", "tmpfs", str(small)], check=True)
        self.addCleanup(subprocess.run, ["umount", str(small)], check=True)
        checks = self.run_it(without_display(), storage=small)
        self.assertEqual(checks["disk_room"]["verdict"], "fail")
        self.assertLess(checks["disk_room"]["value"], 1.1)
        self.assertEqual(list(small.iterdir()), [], "nothing is left on it")

    def test_loaded_cores_make_ticks_late(self):
        loads = [subprocess.Popen(["sh", "-c", "while :; do :; done"])
                 for _ in range(4 * (os.cpu_count() or 1))]
        try:
            checks = self.run_it(without_display())
        finally:
            for load in loads:
                load.kill()
                load.wait()
        late = checks["lateness_1000_normal"]
        self.assertNotEqual(late["verdict"], "pass", late)


if __name__ == "__main__":
    unittest.main()
