"""`trephine-lab structures`: what is grown, where it is written, what is refused."""

import gzip
import os
import shutil
import struct
import subprocess
import tempfile
import unittest
from pathlib import Path

from lab_support import LAB, SCENES, LabTest, data_folder, lab, main

GROWN = {"schema", "build", "name", "voxels", "ml", "seconds", "leaked", "hu", "steps"}
IN_LIVER = "-60,-20,20"  # of the built-in abdomen


def nifti(file):
    """Size, type, sform and qform as rows of matrices, voxels as stored."""
    raw = gzip.decompress(file.read_bytes()) if file.suffix == ".gz" else file.read_bytes()
    size = struct.unpack_from("<3h", raw, 42)
    kind = struct.unpack_from("<h", raw, 70)[0]
    pixdim = struct.unpack_from("<8f", raw, 76)
    rows = [struct.unpack_from("<4f", raw, 280 + 16 * row) for row in range(3)]
    b, c, d, x, y, z = struct.unpack_from("<6f", raw, 256)
    a = max(0.0, 1 - b * b - c * c - d * d) ** 0.5
    turn = [[a*a + b*b - c*c - d*d, 2*b*c - 2*a*d, 2*b*d + 2*a*c],
            [2*b*c + 2*a*d, a*a + c*c - b*b - d*d, 2*c*d - 2*a*b],
            [2*b*d - 2*a*c, 2*c*d + 2*a*b, a*a + d*d - b*b - c*c]]
    handed = -1 if pixdim[0] < 0 else 1
    steps = (pixdim[1], pixdim[2], handed * pixdim[3])
    qform = [[turn[row][axis] * steps[axis] for axis in range(3)] + [(x, y, z)[row]]
             for row in range(3)]
    begin = int(struct.unpack_from("<f", raw, 108)[0])
    return size, kind, rows, qform, raw[begin:]


class Grow(LabTest):
    def test_a_liver_is_grown_compared_and_said(self):
        grown = lab("structures", "grow", "phantom:abdomen", "--seed", IN_LIVER, "--name", "liver",
                    "--write", self.folder / "a.nii.gz")
        self.assertEqual(set(grown), GROWN)
        self.assertEqual(grown["name"], "liver")
        self.assertFalse(grown["leaked"])
        self.assertGreater(grown["ml"], 1100)
        self.assertLess(grown["ml"], 1200)
        self.assertLess(grown["hu"][0], 50)
        self.assertGreater(grown["hu"][1], 50)
        size, kind, sform, qform, voxels = nifti(self.folder / "a.nii.gz")
        self.assertEqual((size, kind), ((256, 256, 160), 2))
        self.assertEqual(len(voxels), 256 * 256 * 160)
        self.assertEqual(set(voxels), {0, 1})
        self.assertEqual(voxels.count(1), grown["voxels"])
        for row in range(3):
            for s, q in zip(sform[row], qform[row]):
                self.assertAlmostEqual(s, q, delta=1e-4)

        again = lab("structures", "grow", "phantom:abdomen", f"--seed={IN_LIVER}", "--name", "liver",
                    "--hu", f"{grown['hu'][0]},{grown['hu'][1]}", "--open", 9,
                    "--box=-200,0,-200,200,-100,100", "--write", self.folder / "b.mha")
        self.assertEqual(again["hu"], grown["hu"])
        self.assertLess(again["voxels"], grown["voxels"])
        alike = lab("structures", "compare", self.folder / "a.nii.gz", self.folder / "b.mha")
        (row,) = alike["rows"]
        self.assertEqual(set(row), {"name", "dice", "hd95_mm", "ml"})
        self.assertAlmostEqual(row["ml"][0], grown["ml"], delta=1e-3)
        self.assertAlmostEqual(row["ml"][1], again["ml"], delta=1e-3)
        self.assertGreater(row["dice"], 0.5)
        self.assertLess(row["dice"], 0.99)

    def test_what_cannot_be_meant_is_refused_and_nothing_is_written(self):
        def refused(code, *words, **options):
            asked = {"seed": IN_LIVER, "name": "liver", "write": self.folder / "x.nii.gz", **options}
            answer = lab("structures", "grow", "phantom:abdomen",
                         *(f"--{key}={value}" for key, value in asked.items()), expect=1)
            self.assert_error(answer, code, *words)
            self.assertEqual(list(self.folder.iterdir()), [])

        refused("BAD_SEED", "outside of the scan", seed="9999,0,0")
        refused("NOTHING_GROWN", "300 to 900 HU", "14 mm", hu="300,900")
        refused("BAD_ARGUMENT", "--seed", seed="1,2")
        refused("BAD_ARGUMENT", "--seed", seed="1,2,nan")
        refused("BAD_ARGUMENT", "--hu", hu="40")
        refused("BAD_ARGUMENT", "ends below", hu="60,40")
        refused("BAD_ARGUMENT", "--box", box="1,2,3,4,5")
        refused("BAD_SEED", "outside of the box", box="0,10,0,10,0,10")
        refused("BAD_ARGUMENT", "0 to 50 mm", open=80)
        refused("MISSING_FOLDER", "no folder for this file", write=self.folder / "none" / "x.nii.gz")
        refused("UNKNOWN_FORMAT", "x.png", write=self.folder / "x.png")

    def test_the_case_is_never_written_over(self):
        for name in ("ct.nii", "ct/ct.nii"):
            (self.folder / "ct").mkdir(exist_ok=True)
            file = self.folder / name
            lab("structures", "grow", "phantom:abdomen", "--seed", IN_LIVER, "--name", "liver",
                "--write", file)
            before = file.read_bytes()
            answer = lab("structures", "grow", file if name == "ct.nii" else file.parent,
                         "--seed", IN_LIVER, "--name", "liver", "--write", file, expect=1)
            self.assert_error(answer, "CANNOT_WRITE", "would be lost")
            self.assertEqual(file.read_bytes(), before)

    def test_no_file_that_is_there_is_written_over(self):
        def refused(*arguments):
            answer = lab("structures", *arguments, expect=1)
            self.assert_error(answer, "CANNOT_WRITE", "would be lost", "--write")
        liver = self.folder / "own.nii.gz"
        lab("structures", "export", "phantom:abdomen", "--name", "liver", "--write", liver)
        names = self.folder / "own.structures.json"
        before = liver.read_bytes(), names.read_bytes()
        refused("import", "phantom:abdomen", liver, "--write", liver)
        refused("export", "phantom:abdomen", "--write", liver)
        refused("grow", "phantom:abdomen", "--seed", IN_LIVER, "--name", "x", "--write", liver)
        refused("export", "phantom:abdomen", "--write", self.folder / "own.mha")  # its names
        self.assertEqual((liver.read_bytes(), names.read_bytes()), before)
        answer = lab("structures", "export", self.folder / "no such case", "--write",
                     self.folder / "none" / "x.stl", expect=1)
        self.assert_error(answer, "MISSING_FOLDER", "--write")  # before the case is read
        surface = self.folder / "all-vessel.stl"
        surface.write_text("precious")
        refused("export", "phantom:abdomen", "--write", self.folder / "all.stl")
        self.assertEqual(surface.read_text(), "precious")
        self.assertEqual(list(self.folder.glob("all-*")), [surface])

    def test_no_file_of_the_case_is_written_over_be_it_beside_its_header(self):
        header, voxels = self.folder / "ct.nhdr", self.folder / "ct.nrrd"
        size = 40
        voxels.write_bytes(struct.pack("<h", 50) * size ** 3)
        header.write_text(f"NRRD0004\ntype: short\ndimension: 3\nsizes: {size} {size} {size}\n"
                          "space: left-posterior-superior\nspace directions: (2,0,0) (0,2,0) (0,0,2)\n"
                          "space origin: (0,0,0)\nendian: little\nencoding: raw\ndata file: ct.nrrd\n")
        before = voxels.read_bytes()
        answer = lab("structures", "grow", header, "--seed", "40,40,40", "--name", "liver",
                     "--write", voxels, expect=1)
        self.assert_error(answer, "CANNOT_WRITE", "would be lost")
        self.assertEqual(voxels.read_bytes(), before)
        # Nor is DICOM put into the patient's own folder.
        ct = self.folder / "ct"
        lab("phantom", "abdomen", "--out", ct)
        files = sorted(ct.rglob("*"))
        answer = lab("structures", "export", ct, "--structures", self.liver_of(ct), "--dicom", ct,
                     expect=1)
        self.assert_error(answer, "CANNOT_WRITE", "would be lost")
        self.assertEqual(sorted(ct.rglob("*")), files)

    def liver_of(self, case):
        file = self.folder / "liver.nrrd"
        lab("structures", "grow", case, "--seed", IN_LIVER, "--name", "liver", "--write", file)
        return file

    def test_a_name_is_one_line_of_letters_that_can_be_seen(self):
        def grown(name, expect=0):
            for file in self.folder.iterdir():
                file.unlink()
            return lab("structures", "grow", "phantom:abdomen", "--seed", IN_LIVER, "--name", name,
                       "--write", self.folder / "a.nii.gz", expect=expect)
        for name in ("", "   ", "\u00a0\u200b"):
            self.assert_error(grown(name, expect=1), "BAD_ARGUMENT", "--name")
        self.assertEqual(list(self.folder.iterdir()), [])
        self.assertEqual(grown("a\nb\x1b[31m")["name"], "a b [31m")
        self.assertEqual(len(grown("x" * 9000)["name"]), 200)
        # Bytes that are no UTF-8, as of a label in Latin-1.
        self.assertEqual(grown(os.fsdecode(b"foie \xe9t\xe9"))["name"], "foie \ufffdt\ufffd")
        (row,) = lab("structures", "import", "phantom:abdomen", self.folder / "a.nii.gz")["structures"]
        self.assertEqual(row["name"], "foie \ufffdt\ufffd")

    def test_words_say_what_was_grown(self):
        done = subprocess.run(
            [LAB, "structures", "grow", "phantom:abdomen", "--seed", IN_LIVER, "--name", "liver",
             "--write", self.folder / "a.nii"], capture_output=True, text=True, check=True)
        self.assertRegex(done.stdout, r"^liver: 11\d\d\.\d mL, \d+ voxels of about ")
        answer = lab("structures", "compare", self.folder / "a.nii", self.folder / "none.nii", expect=1)
        self.assert_error(answer, "MISSING_FILE", "none.nii")
        answer = lab("structures", "shrink", expect=1)
        self.assert_error(answer, "BAD_ARGUMENT", "shrink")


class Import(LabTest):
    @classmethod
    def setUpClass(cls):
        """The liver is grown once; each test has a copy."""
        super().setUpClass()
        folder = tempfile.TemporaryDirectory(prefix="trephine-")
        cls.addClassCleanup(folder.cleanup)
        cls.grown = Path(folder.name)
        lab("structures", "grow", "phantom:abdomen", "--seed", IN_LIVER, "--name", "Liver",
            "--write", cls.grown / "liver.nii.gz")

    def setUp(self):
        super().setUp()
        shutil.copytree(self.grown, self.folder, dirs_exist_ok=True)
        self.liver = self.folder / "liver.nii.gz"

    def test_a_name_goes_with_the_label_map_and_comes_back(self):
        answer = lab("structures", "import", "phantom:abdomen", self.liver)
        (row,) = answer["structures"]
        self.assertEqual(row["name"], "Liver")
        self.assertGreater(row["ml"], 1100)
        self.assertAlmostEqual(row["hu"][1], 50, delta=5)
        self.assertEqual(answer["covers_percent"], 100)
        self.assertEqual(answer["findings"], [])
        again = lab("structures", "import", "phantom:abdomen", self.liver, "--write",
                    self.folder / "b.seg.nrrd")
        self.assertEqual(again["structures"], answer["structures"])
        (row,) = lab("structures", "compare", self.liver, self.folder / "b.seg.nrrd")["rows"]
        self.assertEqual((row["name"], row["dice"]), ("Liver", 1.0))

    def test_a_liver_of_air_is_refused_unless_it_is_kept(self):
        names = self.folder / "liver.structures.json"
        names.write_text(names.read_text().replace("Liver", "left lung"))
        answer = lab("structures", "import", "phantom:abdomen", self.liver, expect=1)
        self.assert_error(answer, "HU_NOT_TISSUE", "left lung", "HU_NOT_TISSUE=keep")
        kept = lab("structures", "import", "phantom:abdomen", self.liver,
                   "--choice", "HU_NOT_TISSUE=keep")
        self.assertEqual([f["code"] for f in kept["findings"]], ["HU_NOT_TISSUE"])

    def test_another_patients_label_map_is_refused(self):
        answer = lab("structures", "import", "phantom:cranium", self.liver, expect=1)
        self.assertIn(answer["error"]["code"], ("HALF_OUTSIDE", "LABELS_ELSEWHERE", "HU_NOT_TISSUE"))

    def test_structures_go_out_as_label_maps_surfaces_and_dicom(self):
        out = lab("structures", "export", "phantom:abdomen", "--name", "liver", "--name", "vessel",
                  "--write", self.folder / "two.seg.nrrd")
        self.assertEqual([row["name"] for row in out["structures"]], ["liver", "vessel"])
        stl = lab("structures", "export", "phantom:abdomen", "--name", "liver",
                  "--write", self.folder / "liver.stl")
        (row,) = stl["structures"]
        self.assertAlmostEqual(row["surface_ml"] / row["ml"], 1, delta=0.05)
        self.assertEqual((self.folder / "liver.stl").stat().st_size, 84 + 50 * row["triangles"])
        lab("structures", "export", "phantom:abdomen", "--name", "liver",
            "--dicom", self.folder / "dicom")
        self.assertTrue((self.folder / "dicom" / "structures.dcm").is_file())
        back = lab("structures", "import", self.folder / "dicom" / "CT",
                   self.folder / "dicom" / "structures.dcm")
        (row,) = back["structures"]
        self.assertEqual(row["name"], "liver")
        self.assertAlmostEqual(row["ml"], stl["structures"][0]["ml"], delta=1e-3)
        answer = lab("structures", "export", "phantom:abdomen", "--name", "foot",
                     "--write", self.folder / "x.nii", expect=1)
        self.assert_error(answer, "NO_STRUCTURE", "'foot'", "liver")

    def test_an_exercise_runs_on_them_in_words_or_with_a_warning(self):
        ct = self.folder / "ct"
        lab("phantom", "abdomen", "--out", ct)
        scene = SCENES / "liver.json"
        with_liver = lab("run", scene, "--case", ct, "--labels", self.liver, "--seconds", 10,
                         "--out", self.folder / "a")
        self.assertEqual(with_liver["warnings"], [])
        self.assertGreater(with_liver["removed_mm3"]["liver"] + with_liver["removed_mm3"]["capsule"],
                           0)
        # The abdominal wall is held open: what is removed is of the structures, all of it.
        self.assertAlmostEqual(sum(with_liver["removed_mm3"].values()) / 1000,
                               sum(row["cut_ml"] for row in with_liver["structures_cut"]), delta=1e-6)
        without = lab("run", scene, "--case", ct, "--seconds", 1, "--out", self.folder / "b")
        self.assertEqual([w["code"] for w in without["warnings"]], ["LACKS_STRUCTURE"])
        again = lab("replay", self.folder / "a" / "session.h5", "--case", ct,
                    "--labels", self.liver)
        self.assertTrue(again["identical"])
        other = lab("run", SCENES / "cranium.json", "--case", ct, "--seconds", 1,
                    "--out", self.folder / "c")
        self.assertIn("OTHER_ANATOMY", [w["code"] for w in other["warnings"]])


@unittest.skipUnless(data_folder(), "TREPHINE_TEST_DATA is not set: this test needs the real CT data")
class GrowReal(LabTest):
    def test_a_label_map_lies_on_the_files_own_grid_also_on_a_left_handed_one(self):
        case = data_folder() / "abdomen-ct-totalsegmentator" / "example_ct.nii.gz"
        seed = "-92,-161,406"
        lab("structures", "grow", case, f"--seed={seed}", "--name", "liver",
            "--write", self.folder / "a.nii.gz")
        size, _, sform, _, _ = nifti(case)
        own_size, kind, own, qform, own_voxels = nifti(self.folder / "a.nii.gz")
        self.assertEqual((own_size, kind), (size, 2))
        for row in range(3):
            for theirs, ours, q in zip(sform[row], own[row], qform[row]):
                self.assertAlmostEqual(theirs, ours, delta=1e-3)
                self.assertAlmostEqual(ours, q, delta=1e-3)

        # The same CT with its rows the other way round: left-handed.
        raw = bytearray(gzip.decompress(case.read_bytes()))
        begin = int(struct.unpack_from("<f", raw, 108)[0])
        bytes_each = struct.unpack_from("<h", raw, 72)[0] // 8
        wide = size[0] * bytes_each
        for at in range(begin, len(raw), wide):
            row = raw[at:at + wide]
            raw[at:at + wide] = b"".join(
                row[i:i + bytes_each] for i in range(wide - bytes_each, -1, -bytes_each))
        step, start = sform[0][0], sform[0][3]
        struct.pack_into("<4f", raw, 280, -step, 0, 0, start + step * (size[0] - 1))
        struct.pack_into("<h", raw, 252, 0)
        (self.folder / "left.nii").write_bytes(bytes(raw))
        lab("structures", "grow", self.folder / "left.nii", f"--seed={seed}", "--name", "liver",
            "--write", self.folder / "b.nii.gz")
        left_size, _, left, qform, left_voxels = nifti(self.folder / "b.nii.gz")
        self.assertEqual(left_size, size)
        self.assertAlmostEqual(left[0][0], -step, delta=1e-4)
        for row in range(3):
            for ours, q in zip(left[row], qform[row]):
                self.assertAlmostEqual(ours, q, delta=1e-3)
        turned = b"".join(left_voxels[at:at + size[0]][::-1]
                          for at in range(0, len(left_voxels), size[0]))
        self.assertEqual(turned, own_voxels)


if __name__ == "__main__":
    main()
