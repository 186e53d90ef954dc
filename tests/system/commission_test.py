"""`trephine-lab commission` on machines that lack something: each lack is named, with the next step."""

import json
import os
import re
import resource
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

from lab_support import LAB, can_mount, main, without_display

SECONDS = "0.3"


class Commissioning:
    """Runs it, in folders of its own, on what the test takes from the machine."""

    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        self.temporary = self.folder / "tmp"
        self.temporary.mkdir()

    def run_it(self, environment=None, before=None, storage=None, more=(), around=()):
        environment = dict(environment or os.environ, XDG_STATE_HOME=str(self.folder / "state"),
                           XDG_CONFIG_HOME=str(self.folder / "config"),
                           XDG_DATA_HOME=str(self.folder / "data"), TMPDIR=str(self.temporary))
        done = subprocess.run(
            [*around, LAB, "commission", "--json", "--seconds", SECONDS,
             "--out", str(self.folder / "out"),
             "--storage", str(storage or self.folder / "storage"), *more],
            env=environment, preexec_fn=before, capture_output=True, text=True, timeout=240)
        self.assertEqual(done.returncode, 0, done.stderr[-500:])
        answer = json.loads(done.stdout)
        return {check["name"]: check for check in answer["checks"]}

    def mount(self, at, size):
        """A disk of this size there, until the test ends."""
        if not can_mount():
            self.skipTest("only root may mount a small disk")
        at.mkdir(exist_ok=True)
        subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", str(at)], check=True)
        self.addCleanup(subprocess.run, ["umount", str(at)], check=True)

    def run_without_rights(self):
        if os.geteuid() == 0 and not all(folder.stat().st_mode & 0o001
                                         for folder in Path(LAB).resolve().parents):
            self.skipTest("the programs lie where no other account comes")
        def lacks():
            resource.setrlimit(resource.RLIMIT_RTPRIO, (0, 0))
            resource.setrlimit(resource.RLIMIT_MEMLOCK, (65536, 65536))
            if os.geteuid() == 0:  # root's rights stand above limits
                os.setgroups([])
                os.setgid(65534)
                os.setuid(65534)
        for name in ("out", "storage", "state", "config", "data"):
            (self.folder / name).mkdir()
        for path in [self.folder, *self.folder.iterdir()]:
            path.chmod(0o777)
        return self.run_it(dict(without_display(), HOME=str(self.folder)), lacks)


class Commission(Commissioning, unittest.TestCase):
    def test_each_check_has_value_limit_verdict_and_next_step(self):
        checks = self.run_it()
        for name in ("lateness_1000_normal", "priority", "locked_memory", "opengl", "volume_edge",
                     "frame_time", "removal_to_pixel", "hand_to_tool", "disk_write", "disk_room",
                     "memory", "clock", "arms", "headset", "screen", "touch_cost", "arm_encoders",
                     "arm_forces", "lateness_2000_normal", "lateness_4000_normal"):
            check = checks[name]
            self.assertIn(check["verdict"], ("pass", "warn", "fail"))
            self.assertIsNotNone(check["limit"], name)
            self.assertEqual(check["verdict"] == "pass", check["next"] == "", check)
            print(f"{name}: {check['value']} {check['unit']}, {check['verdict']}")
        # What is recommended stands for this person, and lies beside the page.
        kept = json.loads((self.folder / "config/trephine/recommended.json").read_text())
        self.assertEqual(kept, json.loads((self.folder / "out/recommended.json").read_text()))
        knobs = {knob["knob"]: knob["setting"] for knob in kept["knobs"]}
        self.assertEqual(set(knobs),
                         {"points_blade", "points_burr", "force_at", "rate_hz", "grid"})
        self.assertIn(f"rate_hz {knobs['rate_hz']}", checks["touch_cost"]["remark"])
        page = (self.folder / "out/commission.html").read_text()
        self.assertIn("Commissioning of this workstation", page)
        if "llvmpipe" in checks["opengl"]["remark"]:
            self.assertEqual(checks["opengl"]["verdict"], "warn")
        # The next time only what is otherwise is said. Without a display what is drawn fails.
        checks = self.run_it(without_display())
        self.assertRegex((self.folder / "out/commission.html").read_text(), r"before, .* now")
        for name in ("screen", "opengl", "volume_edge", "frame_time", "removal_to_pixel",
                     "hand_to_tool"):
            self.assertEqual(checks[name]["verdict"], "fail")
            self.assertTrue(checks[name]["next"])

    def test_without_priority_and_locked_memory_it_warns(self):
        checks = self.run_without_rights()
        self.assertEqual(checks["priority"]["verdict"], "warn")
        self.assertIn("adduser NAME trephine", checks["priority"]["next"])
        self.assertEqual(checks["locked_memory"]["verdict"], "warn")

    def test_a_small_disk_fails_and_no_folder_for_temporary_files_is_no_fault_of_devices(self):
        small = self.folder / "small"
        self.mount(small, "1g")
        self.temporary = self.folder / "gone"
        checks = self.run_it(without_display(), storage=small)
        self.assertEqual(checks["disk_room"]["verdict"], "fail")
        self.assertLess(checks["disk_room"]["value"], 1.1)
        self.assertEqual(list(small.iterdir()), [], "nothing is left on it")
        for name in ("arms", "arm_encoders", "arm_forces"):
            self.assertEqual(checks[name]["verdict"], "fail")
            self.assertIn("TMPDIR", checks[name]["next"])

    def test_a_full_disk_has_no_speed_and_a_full_temporary_folder_is_no_fault_of_devices(self):
        full = self.folder / "full"
        self.mount(full, "2m")
        self.mount(self.temporary, "40k")
        checks = self.run_it(without_display(), storage=full)
        self.assertEqual(list(full.iterdir()), [], "nothing is left on it")
        self.assertEqual(checks["disk_room"]["verdict"], "fail")
        self.assertEqual(checks["disk_write"]["verdict"], "fail")
        self.assertIsNone(checks["disk_write"]["value"], "on a full one no speed can be told")
        self.assertIn("space", checks["disk_write"]["next"])
        for name in ("arms", "arm_encoders", "arm_forces"):
            self.assertEqual(checks[name]["verdict"], "fail")
            self.assertIn("Free some space", checks[name]["next"])
            self.assertIn("TMPDIR", checks[name]["next"])

    def test_a_small_screen_little_memory_and_no_loader_are_said(self):
        if not can_mount():
            self.skipTest("only root may put another /proc/meminfo in the place of this one")
        (self.folder / "lib").mkdir()
        (self.folder / "lib" / "libopenxr_loader.so.1").write_text("")
        little = self.folder / "meminfo"
        little.write_text(re.sub(r"MemAvailable: *\d+", "MemAvailable: 1000000",
                                 Path("/proc/meminfo").read_text()))
        checks = self.run_it(
            dict(os.environ, LD_LIBRARY_PATH=str(self.folder / "lib")),
            around=("xvfb-run", "-a", "-s", "-screen 0 640x400x24", "unshare", "-m", "sh", "-c",
                    'mount --bind "$0" /proc/meminfo && exec "$@"', str(little)))
        for name, verdict in (("screen", "fail"), ("memory", "fail"), ("headset", "warn")):
            self.assertEqual(checks[name]["verdict"], verdict, checks[name])

    def test_a_full_folder_for_the_page_is_said_before_the_minutes_that_it_takes(self):
        full = self.folder / "full"
        self.mount(full, "8k")
        done = subprocess.run([LAB, "commission", "--json", "--out", str(full), "--storage",
                               str(self.folder)], capture_output=True, text=True, timeout=20)
        error = json.loads(done.stdout)["error"]
        self.assertEqual((done.returncode, error["code"]), (1, "CANNOT_WRITE"))
        self.assertIn("space", error["next"])
        self.assertEqual(list(full.iterdir()), [])

    def test_an_ill_driver_is_a_check_that_fails_and_all_else_is_measured(self):
        plugins = self.folder / "plugins"
        shutil.copytree(os.environ["PLUGINS"], plugins)
        shutil.copy(os.environ["ILL_PLUGIN_FILE"], plugins)
        for how, said in (("ends", "ended the program"), ("blocks", "does not answer")):
            checks = self.run_it(dict(without_display(), TREPHINE_PLUGINS=str(plugins),
                                      ILL_PLUGIN=how), more=("--wait", "0.1"))
            for name in ("arms", "arm_encoders", "arm_forces"):
                self.assertEqual(checks[name]["verdict"], "fail")
                self.assertIn(said, checks[name]["remark"])
                self.assertIn("driver", checks[name]["next"])
            self.assertEqual(checks["clock"]["verdict"], "pass")
        self.assertEqual(list(self.temporary.iterdir()), [])

    def test_a_slow_disk_and_late_ticks_are_said_and_a_driver_that_talks_is_none_of_it(self):
        plugins = self.folder / "plugins"
        shutil.copytree(os.environ["PLUGINS"], plugins)
        shutil.copy(os.environ["ILL_PLUGIN_FILE"], plugins)
        checks = self.run_it(dict(without_display(), TREPHINE_PLUGINS=str(plugins),
                                  ILL_PLUGIN="talks", LD_PRELOAD=os.environ["SLOW_MACHINE"],
                                  SLOW_SYNC_MS="100", LATE_US="700"), more=("--wait", "0.1"))
        self.assertEqual(checks["arms"]["verdict"], "warn")
        self.assertEqual(checks["arms"]["value"], 0)
        self.assertLess(checks["disk_write"]["value"], 40)  # 4 MB take 100 ms and more
        self.assertIn(checks["disk_write"]["verdict"], ("warn", "fail"))
        # Where priority is granted, what is without does not matter.
        granted = "lateness_1000_fifo" in checks
        late = checks["lateness_1000_fifo" if granted else "lateness_1000_normal"]
        self.assertGreater(late["value"], 700)
        self.assertEqual(late["verdict"], "fail" if granted else "warn")


class CommissionLoaded(Commissioning, unittest.TestCase):
    """Slow: what a loaded machine does to it."""

    def test_loaded_cores_make_ticks_late(self):
        loads = [subprocess.Popen(["sh", "-c", "while :; do :; done"])
                 for _ in range(4 * (os.cpu_count() or 1))]
        try:
            checks = self.run_without_rights()
        finally:
            for load in loads:
                load.kill()
                load.wait()
        late = checks["lateness_1000_normal"]
        self.assertNotEqual(late["verdict"], "pass", late)


class CommissionArms(unittest.TestCase):
    """Two open arms on emulated boards, in hands that swing them, through the real hidapi."""

    def commission(self, left, *more):
        with tempfile.TemporaryDirectory() as folder:
            environment = dict(without_display(), LEFT_ARM=left, XDG_STATE_HOME=folder,
                               XDG_CONFIG_HOME=folder)
            done = subprocess.run(
                [shutil.which("umockdev-wrapper"), os.environ["WITH_WOODEN_ARMS"],
                 f"{folder}/boards.json", LAB, "commission", "--json", "--seconds", SECONDS,
                 "--storage", folder, "--out", f"{folder}/out", *more],
                env=environment, capture_output=True, text=True, timeout=240)
            self.assertEqual(done.returncode, 0, done.stdout[-500:] + done.stderr[-500:])
            boards = json.loads(Path(folder, "boards.json").read_text())
            checks = {check["name"]: check for check in json.loads(done.stdout)["checks"]}
            for name in ("arm_encoders", "arm_forces"):
                print(left, name, checks[name]["value"], checks[name]["verdict"],
                      checks[name]["remark"])
            self.assertEqual(checks["arms"]["verdict"], "pass")
            late_ms = boards.pop("hands_late_ms")
            self.assertLess(max(board["most_N"] for board in boards.values()), 1.0)
            return checks, boards, late_ms

    def commission_on_time(self, left):
        """Again where the host let the hands, or the program's ticks, come too late to say
        anything of the arms."""
        for _ in range(3):
            checks, boards, late_ms = self.commission(left)
            if late_ms < 10 and "ticks came late" not in checks["arm_encoders"]["remark"]:
                break
            print("the hands were late by", late_ms, "ms")
        return checks, boards

    def test_arms_that_are_well_pass(self):
        checks, boards = self.commission_on_time("well")
        self.assertEqual(checks["arm_encoders"]["verdict"], "pass")
        self.assertEqual(checks["arm_forces"]["verdict"], "pass")
        self.assertGreater(boards["left"]["most_N"], 0.5)

    def test_a_reversed_encoder_fails_and_is_named(self):
        forces = self.commission_on_time("reversed")[0]["arm_forces"]
        self.assertEqual(forces["verdict"], "fail")
        self.assertLess(forces["value"], -0.05)
        self.assertIn("do not practise", forces["next"])

    def test_an_encoder_that_scatters_fails_and_its_arm_is_not_pushed(self):
        checks, boards = self.commission_on_time("scatters")
        self.assertEqual(checks["arm_encoders"]["verdict"], "fail")
        self.assertEqual(checks["arm_forces"]["verdict"], "warn")
        self.assertEqual(boards["left"]["most_N"], 0.0)
        self.assertGreater(boards["right"]["most_N"], 0.5)

    def test_arms_that_shall_not_be_tried_are_not_opened(self):
        checks, boards, _ = self.commission("well", "--wait", "0")
        self.assertEqual(checks["arm_forces"]["verdict"], "warn")
        self.assertEqual([board["answered"] for board in boards.values()], [0, 0])


if __name__ == "__main__":
    main()
