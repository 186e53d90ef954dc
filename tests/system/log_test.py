"""What reaches a log (stderr under --json) names neither folder nor file of what was read."""

import gzip
import json
import os
import re
import subprocess
import unittest

from lab_support import LAB, SCENES, PatientsScanTest, lab, main


class Import(PatientsScanTest):
    def setUp(self):
        super().setUp()
        for file in self.slices[40:]:
            file.unlink()
        del self.slices[40:]

    def test_a_warning_names_no_file(self):
        said = self.log("import", self.scan, "--write", self.scan / f"{self.FILE}.nii", "--report",
                        self.scan / f"{self.FILE}.html", "--phase", 2)
        self.assertIn("face can be reconstructed", said)
        self.assertIn("PHASES", said)

    def test_errors_and_findings_name_no_file(self):
        damage = {
            "cut short": lambda bytes_: bytes_[:300],
            "without its pixels": lambda bytes_: bytes_[:len(bytes_) // 2],
            "spoilt in its header": lambda bytes_: bytes_[:200] + b"\xff" * 400 + bytes_[600:],
            "empty": lambda bytes_: b"",
            "no DICOM": lambda bytes_: b"a letter about " + self.FOLDER.encode(),
        }
        for file, (what, spoil) in zip(self.slices[10::5], damage.items()):
            with self.subTest(what):
                file.write_bytes(spoil(file.read_bytes()))
                self.log("import", self.scan)
        self.slices[5].unlink()
        (self.scan / f"{self.FILE}-none.dcm").symlink_to(self.scan / "gone")
        self.log("import", self.scan, "--series", "1.2.3")
        self.log("import", self.scan, "--write", self.slices[0])
        self.log("import", self.scan, "--write", f"/dev/full/{self.FILE}.nii")

    def test_volume_files_whole_and_spoilt_name_no_file(self):
        whole = self.scan / f"{self.FILE}.nii.gz"
        self.log("import", self.scan, "--quarter", "--write", whole)
        self.log("import", whole, "--write", self.scan / f"{self.FILE}-2.nii")
        packed, plain = whole.read_bytes(), gzip.decompress(whole.read_bytes())
        for suffix, bytes_ in ((".nii.gz", packed[:5000]), (".nii", plain[:5000]),
                               (".nii", b"\xff" * 348 + plain[348:]), (".mha", plain[:5000]),
                               (".nrrd", b"NRRD0004\n" + plain[:500])):
            with self.subTest(suffix):
                spoilt = self.scan / f"{self.FILE}-spoilt{suffix}"
                spoilt.write_bytes(bytes_)
                self.log("import", spoilt)

    def answer(self, *arguments):
        """What an import prints as JSON, which must name nothing of the source."""
        done = subprocess.run([LAB, "import", *map(str, arguments), "--json"],
                              capture_output=True, text=True, timeout=240)
        for said in (done.stdout, done.stderr):
            for name in (self.FOLDER, self.FILE, *self.IDENTITY):
                self.assertNotIn(name, said)
        return json.loads(done.stdout)

    def test_the_answer_names_neither_path_nor_uid_nor_description(self):
        header = self.slices[0].read_bytes()
        # The writer's own UIDs: each begins with its root, and stands in every file.
        self.IDENTITY = {match.decode() for match in re.findall(rb"2\.25\.[0-9]{20,}", header)}
        self.assertGreater(len(self.IDENTITY), 2)
        shown = lab("import", self.scan, "--with-identity")
        uid, description = shown["chosen"], shown["series"][0]["description"]
        self.assertIn(uid, self.IDENTITY)
        self.assertEqual(shown["path"], str(self.scan))
        self.assertTrue(description)
        self.IDENTITY.add(description)
        read = self.answer(self.scan)
        chosen = read["chosen"]
        self.assertEqual(chosen, "1")
        self.assertEqual(read["series"][0]["uid"], chosen)
        self.assertEqual(self.answer(self.scan, "--series", chosen)["chosen"], chosen)
        self.assertEqual(self.answer(self.scan, "--series", uid)["chosen"], chosen)
        self.assertEqual(self.answer(self.scan, "--series", "1.2.3")["error"]["code"],
                         "NO_SUCH_SERIES")
        self.answer(self.scan, "--write", self.slices[0])
        self.answer(self.scan / "gone")
        volume = self.scan / f"{self.FILE}.nii.gz"
        self.answer(self.scan, "--quarter", "--write", volume)
        self.answer(volume)
        volume.write_bytes(b"")
        self.answer(volume)
        self.slices[7].write_bytes(header)
        self.slices[9].write_bytes(header[:300])
        self.answer(self.scan)

    def test_a_full_disk_names_no_file(self):
        for target in (".nii", ".nii.gz", ".mha"):
            with self.subTest(target):
                self.log("import", self.scan, "--write", self.scan / f"{self.FILE}{target}",
                         before="ulimit -f 64;")


class Exercise(PatientsScanTest):
    def scene(self):
        """A scene of its own beside the scan, with a mesh that cannot be drawn."""
        scene = json.loads((SCENES / "cranium.json").read_text())
        for arm in scene["arms"]:
            del arm["other_tools"]
        scene["tissues"] = str(SCENES / scene["tissues"])
        scene["operator"] = str(SCENES / scene["operator"])
        scene["tools"] = [{"id": "blade", "kind": "blade", "length_mm": 16, "points": 16,
                           "mesh": f"{self.FILE}.stl"}]
        (self.scan / f"{self.FILE}.stl").write_text("no mesh")
        file = self.scan / f"{self.FILE}.json"
        file.write_text(json.dumps(scene))
        return file

    def test_a_run_and_its_replay_name_no_file(self):
        out = self.scan / "out"
        case = ("--case", self.scan)
        said = self.log("run", self.scene(), *case, "--seconds", 0.1, "--save-volume",
                        self.scan / f"{self.FILE}.nii", "--out", out)
        if os.environ.get("DISPLAY"):
            self.assertIn("The built-in shape is drawn", said)
        self.log("replay", out / "session.h5", *case)
        self.log("replay", out / "session.h5", "--case", self.scan / f"{self.FILE}.nii")
        self.log("replay", self.slices[0], *case)

    def test_a_recording_on_a_full_disk_names_no_file(self):
        for realtime in ((), ("--realtime",)):
            with self.subTest(realtime=realtime):
                self.log("run", SCENES / "cranium.json", "--case", self.scan, *realtime, "--seconds",
                         1, "--out", self.scan / self.FILE, before="ulimit -f 64;")


if __name__ == "__main__":
    main()
