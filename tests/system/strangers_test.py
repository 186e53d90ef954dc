"""What a stranger's file can do to a terminal, to another file and to the memory of the programs."""

import array
import gzip
import hashlib
import json
import os
import re
import signal
import subprocess
import unittest
from pathlib import Path

from check_runpath import faults
from lab_support import (
    LAB, SCENES, TRAINEE, EndingTest, LabTest, lab, main, small_head, wait_until)

# What a terminal obeys, or nobody sees: all but newlines and tabs.
OBEYED = re.compile(r"[\x00-\x08\x0b-\x1f\x7f\x80-\x9f\u00ad\u200b-\u200f\u2028-\u202e\u2060-\u206f\ufeff]")
NAME = "x\x1b[2J\x07\x9b2J\u200by<b>z</b>"


def parts_of(folder):
    """Lists a folder as an exporter of a stranger would."""
    files = [file for file in folder.rglob("*") if file.is_file() and file.name != "exercise.json"]
    return {"format": "trephine.exercise", "version": 1, "scene": "scene.json", "parts": [
        {"file": str(file.relative_to(folder)), "bytes": file.stat().st_size,
         "sha256": hashlib.sha256(file.read_bytes()).hexdigest()} for file in sorted(files)]}


class Terminal(LabTest):
    def said(self, *command, code=0):
        done = subprocess.run([LAB, *map(str, command)], capture_output=True, timeout=240, check=False)
        said = (done.stdout + done.stderr).decode("utf-8")
        self.assertEqual(done.returncode, code, said)
        self.assertIsNone(OBEYED.search(said), repr(said))
        self.assertNotRegex(said, r"(?m)^OK: verified", "a line is forged")
        return said

    def test_names_of_an_exercise_command_nothing(self):
        stick = self.folder / "stick"
        lab("exercise", "export", SCENES / "liver-one-arm.json", "--out", stick)
        scene = json.loads((stick / "scene.json").read_text())
        scene["name"] = NAME
        (stick / "scene.json").write_text(json.dumps(scene))
        (stick / "exercise.json").write_text(json.dumps(parts_of(stick)))
        self.said("exercise", "import", stick, "--storage", self.folder / "store", code=1)
        scene["name"] = "x\u200by<b>z</b>"
        (stick / "scene.json").write_text(json.dumps(scene))
        (stick / "exercise.json").write_text(json.dumps(parts_of(stick)))
        self.said("exercise", "import", stick, "--storage", self.folder / "store")
        self.assertIn("y<b>z</b>", self.said("explain", stick / "scene.json"))
        # A line of its own would forge what the program says.
        for forged in ("x\nOK: verified", "x\u2028OK: verified"):
            (stick / "scene.json").write_text(json.dumps(dict(scene, name=forged)))
            self.assertIn("is no plain line", self.said("explain", stick / "scene.json", code=1))
        (stick / "scene.json").write_text(json.dumps(dict(scene, name="x", **{"k\nOK: verified": 1})))
        self.said("explain", stick / "scene.json", code=1)
        scene[NAME] = 3
        (stick / "scene.json").write_text(json.dumps(scene))
        self.said("explain", stick / "scene.json", code=1)

    def test_names_of_files_and_folders_command_nothing(self):
        odd = self.folder / NAME.replace("/", "")
        odd.mkdir()
        (odd / "letter.txt").write_text("Dear Sir")
        self.said("import", odd, code=2)
        self.said("import", odd / "none", code=2)
        (odd / "a.h5").write_text("x")
        self.said("recordings", odd / "a.h5", code=1)
        self.said("replay", odd / "a.h5", code=1)
        self.said("storage", "list", "--storage", odd)
        forging = self.folder / "x\nOK: verified"
        forging.mkdir()
        (forging / "a.h5").write_text("x")
        self.said("recordings", forging / "a.h5", code=1)
        self.said("import", forging, code=2)
        self.said("storage", "list", "--storage", forging)
        self.said("explain", forging / "scene.json", code=1)
        scene = SCENES / "liver-one-arm.json"
        self.said("exercise", "export", scene, "--out", forging / "stick")
        self.said("exercise", "import", forging / "stick", "--storage", forging)
        self.said("run", scene, "--case", forging / "none", "--seconds", 0.1, "--out",
                  forging / "out", code=1)
        self.said("run", scene, "--seconds", 0.1, "--out", forging / "out")
        # As a glob gives them.
        for words in (["explain", scene, "z\nOK: verified\x1b[32m.json"], ["z\nOK: verified"],
                      ["structures", "z\nOK: verified"],
                      ["run", scene, "--seconds", "1\nOK: verified"]):
            self.said(*words, code=1)

    def test_names_of_structures_command_nothing(self):
        ct = self.folder / "ct.nii.gz"
        small_head(ct)
        labels = self.folder / "labels.nii.gz"
        small_head(labels)
        voxels = gzip.decompress(labels.read_bytes())
        of_bone = array.array("h", voxels[352:])
        of_structure = array.array("h", [v > 200 for v in of_bone])
        labels.write_bytes(gzip.compress(voxels[:352] + of_structure.tobytes()))
        names = self.folder / "labels.structures.json"
        for name, code in ((NAME, 1), ("x\u200by<b>z</b>", 0)):
            names.write_text(json.dumps({
                "format": "trephine.structures", "version": 1,
                "structures": [{"label": 1, "name": name, "colour": [1, 0, 0]}]}))
            self.assertIn("y<b>z</b>", self.said("structures", "import", ct, labels, code=code))
        names.unlink()
        (self.folder / "labels.label").write_text(f'1 255 0 0 1 1 1 "{NAME}"\n')
        self.assertIn("y<b>z</b>", self.said("structures", "import", ct, labels))


class Recordings(LabTest):
    def test_each_is_a_line_of_json_as_soon_as_it_is_read(self):
        run = lab("run", SCENES / "cranium-one-arm.json", "--seconds", 0.2, "--out", self.folder)
        bad = self.folder / "bad.h5"
        bad.write_text("x")
        done = subprocess.run([LAB, "recordings", "--json", run["recording"], bad],
                              capture_output=True, text=True, timeout=240, check=False)
        self.assertEqual(done.returncode, 1)
        rows = [json.loads(line) for line in done.stdout.splitlines()]
        self.assertEqual([row["schema"] for row in rows], ["trephine.recordings.1"] * 2)
        self.assertEqual((rows[0]["case"], rows[0]["seconds"]), ("phantom:cranium", 0.2))
        self.assertEqual(rows[1]["problem"]["code"], "BAD_RECORDING")

    def test_one_that_names_a_case_of_its_own_opens_nothing_by_itself(self):
        head = self.folder / "head.nii.gz"
        small_head(head)
        run = lab("run", SCENES / "cranium-one-arm.json", "--case", head, "--seconds", 0.2, "--out",
                  self.folder)
        self.assert_error(lab("replay", run["recording"], expect=1), "NO_CASE", "--case")
        self.assertTrue(lab("replay", run["recording"], "--case", head)["identical"])


    def test_one_that_this_account_may_not_read_is_not_called_damaged(self):
        if os.getuid() != 0:
            self.skipTest("to be another account it has to be root")
        self.folder.chmod(0o755)
        kept = self.folder / "kept.h5"
        kept.write_text("x")
        kept.chmod(0)
        done = subprocess.run(["setpriv", f"--reuid={TRAINEE}", f"--regid={TRAINEE}",
                               "--clear-groups", LAB, "recordings", "--json", kept],
                              capture_output=True, text=True, timeout=240, check=False, cwd="/",
                              env=dict(os.environ, HOME="/nonexistent"))
        self.assertEqual(json.loads(done.stdout)["problem"]["code"], "CANNOT_READ", done.stdout)


class Memory(EndingTest):
    """A core would hold the voxels and names of a patient."""

    def as_nobody(self, *command):
        return subprocess.Popen(["setpriv", f"--reuid={TRAINEE}", f"--regid={TRAINEE}",
                                 "--clear-groups", *map(str, command)], stdout=subprocess.DEVNULL,
                                stderr=subprocess.DEVNULL, cwd="/",
                                env=dict(os.environ, HOME=str(self.folder),
                                         XDG_STATE_HOME=str(self.folder / "state")))

    def test_no_other_program_of_the_user_reads_it_and_no_core_is_written(self):
        if os.getuid() != 0:
            self.skipTest("to be another account it has to be root")
        self.folder.chmod(0o777)
        process = self.as_nobody(LAB, "measure", "jitter", "--seconds", 600, "--out",
                                 self.folder / "jitter")
        self.addCleanup(process.kill)
        wait_until(lambda: "jitter" in {task.read_text().strip() for task in
                                        Path(f"/proc/{process.pid}/task").glob("*/comm")}, "it measures")
        # What may be dumped belongs to its user there, as that of any other program does.
        other = self.as_nobody("sleep", "600")
        self.addCleanup(other.kill)
        wait_until(lambda: os.stat(f"/proc/{other.pid}/environ").st_uid == TRAINEE, "it runs")
        self.assertEqual(os.stat(f"/proc/{process.pid}/environ").st_uid, 0)
        limits = Path(f"/proc/{process.pid}/limits").read_text()
        self.assertRegex(limits, r"Max core file size\s+0\s+0")
        process.send_signal(signal.SIGSEGV)
        _, status = os.waitpid(process.pid, 0)
        process.returncode = -signal.SIGSEGV
        self.assertTrue(os.WIFSIGNALED(status))
        self.assertFalse(os.WCOREDUMP(status))
        # It is said all the same, in a report.
        reports = list((self.folder / "state").rglob("*"))
        self.assertTrue(any(file.is_file() for file in reports), reports)


class Runpath(LabTest):
    def test_a_folder_that_others_may_fill_is_found(self):
        program = self.folder / "program"
        source = self.folder / "program.c"
        source.write_text("int main(void) { return 0; }\n")
        for runpath, fault in (("", False), ("/usr/lib", False), (":/usr/lib", True),
                               ("lib", True), (str(self.folder / "lib"), True)):
            self.folder.chmod(0o777)
            flags = [f"-Wl,-rpath,{runpath}"] if runpath else []
            subprocess.run(["cc", "-o", program, source, *flags], check=True)
            found, count = faults([self.folder])
            self.assertEqual((bool(found), count), (fault, 1), (runpath, found))


if __name__ == "__main__":
    main()
