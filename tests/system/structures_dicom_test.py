"""`trephine-lab structures`: DICOM that refers to the CT it came from, shares of voxels with their
threshold, an order of structures that overlap. What is written is read by pydicom."""

import subprocess
import unittest

from lab_support import LAB, LabTest, lab, main

try:
    import numpy as np
    import pydicom
    from pydicom.uid import generate_uid
except ImportError:
    pydicom = None

PATIENT, PATIENT_ID = "DOE^JANE", "4711"


def patients_ct(folder):
    """The CT of a case as a scanner would have named it: a patient and UIDs of its own. By SOP
    instance UID."""
    study, series, frame = generate_uid(), generate_uid(), generate_uid()
    slices = {}
    for file in sorted(folder.iterdir()):
        data = pydicom.dcmread(file)
        data.PatientName, data.PatientID, data.PatientBirthDate = PATIENT, PATIENT_ID, "19700101"
        data.StudyInstanceUID, data.SeriesInstanceUID, data.FrameOfReferenceUID = study, series, frame
        data.SOPInstanceUID = data.file_meta.MediaStorageSOPInstanceUID = generate_uid()
        data.save_as(file)
        slices[data.SOPInstanceUID] = data
    return slices


@unittest.skipUnless(pydicom, "pydicom is not there: packaging/setup test installs it")
class SourceUids(LabTest):
    def setUp(self):
        super().setUp()
        lab("structures", "export", "phantom:abdomen", "--name", "liver", "--dicom", self.folder / "a")
        lab("structures", "export", "phantom:abdomen", "--name", "liver",
            "--write", self.folder / "liver.nii.gz")
        self.ct = self.folder / "a" / "CT"
        self.slices = patients_ct(self.ct)

    def export(self, *more, expect=0, case=None):
        return lab("structures", "export", case or self.ct, "--structures",
                   self.folder / "liver.nii.gz", "--dicom", self.folder / "out", *more,
                   expect=expect)

    def test_the_segmentation_names_the_slices_that_it_is_of_and_no_patient(self):
        written = self.export("--source-uids")
        self.assertTrue(written["names_source_uids"])
        self.assertEqual([f.name for f in (self.folder / "out").iterdir()], ["structures.dcm"])
        seg = pydicom.dcmread(self.folder / "out" / "structures.dcm")
        any_slice = next(iter(self.slices.values()))
        self.assertEqual(seg.StudyInstanceUID, any_slice.StudyInstanceUID)
        self.assertEqual(seg.FrameOfReferenceUID, any_slice.FrameOfReferenceUID)
        (series,) = seg.ReferencedSeriesSequence
        self.assertEqual(series.SeriesInstanceUID, any_slice.SeriesInstanceUID)
        self.assertNotEqual(seg.SeriesInstanceUID, any_slice.SeriesInstanceUID)
        self.assertEqual({i.ReferencedSOPInstanceUID for i in series.ReferencedInstanceSequence},
                         set(self.slices))
        for frame in seg.PerFrameFunctionalGroupsSequence:
            (source,) = frame.DerivationImageSequence[0].SourceImageSequence
            of = self.slices[source.ReferencedSOPInstanceUID]
            self.assertEqual(source.ReferencedSOPClassUID, of.SOPClassUID)
            place = frame.PlanePositionSequence[0].ImagePositionPatient
            for theirs, ours in zip(of.ImagePositionPatient, place):
                self.assertAlmostEqual(float(theirs), float(ours), delta=1e-4)
        raw = (self.folder / "out" / "structures.dcm").read_bytes()
        for word in (b"DOE", b"JANE", b"19700101"):
            self.assertNotIn(word, raw)
        self.assertEqual((str(seg.PatientName), seg.PatientID), ("TREPHINE^CASE", "CASE"))

    def test_that_it_does_is_said_and_without_the_wish_no_uid_of_the_source_is_there(self):
        done = subprocess.run(
            [LAB, "structures", "export", self.ct, "--structures", self.folder / "liver.nii.gz",
             "--dicom", self.folder / "said", "--source-uids"],
            capture_output=True, text=True, timeout=240, check=True)
        self.assertIn("UIDs of the patient's own CT", done.stderr)
        self.assertFalse(self.export()["names_source_uids"])
        of = next(iter(self.slices.values()))
        for file in (self.folder / "out").rglob("*.dcm"):
            self.assertNotIn(str(of.StudyInstanceUID).encode(), file.read_bytes())

    def test_a_case_of_no_dicom_has_none(self):
        answer = self.export("--source-uids", case="phantom:abdomen", expect=1)
        self.assert_error(answer, "BAD_SOURCE", "no DICOM series", "phantom:abdomen")
        self.assertFalse((self.folder / "out").exists())
        answer = lab("structures", "export", "phantom:abdomen", "--write", self.folder / "x.nii",
                     "--source-uids", expect=1)
        self.assert_error(answer, "BAD_ARGUMENT", "--dicom")


@unittest.skipUnless(pydicom, "pydicom is not there: packaging/setup test installs it")
class Shares(LabTest):
    def test_a_voxel_is_a_structures_from_the_threshold_on(self):
        lab("structures", "export", "phantom:abdomen", "--name", "liver", "--dicom", self.folder / "a")
        file = self.folder / "a" / "structures.dcm"
        seg = pydicom.dcmread(file)
        size = seg.NumberOfFrames, seg.Rows * seg.Columns
        bits = np.unpackbits(np.frombuffer(seg.PixelData, np.uint8), bitorder="little")
        shares = bits[:size[0] * size[1]].reshape(size) * np.uint8(100)
        shares[::2] //= 2  # every other slice is half the liver's
        seg.SegmentationType, seg.SegmentationFractionalType = "FRACTIONAL", "OCCUPANCY"
        seg.MaximumFractionalValue = 100
        seg.BitsAllocated = seg.BitsStored = 8
        seg.HighBit = 7
        seg.PixelData = shares.tobytes()
        seg["PixelData"].VR = "OB"
        seg.save_as(file)

        def voxels(*more):
            answer = lab("structures", "import", self.folder / "a" / "CT", file, *more)
            self.assertTrue(answer["fractional"])
            self.assertIn("FRACTIONAL", [f["code"] for f in answer["findings"]])
            return answer["structures"][0]["voxels"]

        whole, half = np.count_nonzero(shares), np.count_nonzero(shares > 60)
        self.assertEqual(voxels(), whole)  # a half is enough
        self.assertEqual(voxels("--threshold", 0.51), half)
        self.assertEqual(voxels("--threshold", 0.5), whole)
        for wrong in (1.5, -0.1):
            answer = lab("structures", "import", self.folder / "a" / "CT", file,
                         f"--threshold={wrong}", expect=1)
            self.assert_error(answer, "BAD_THRESHOLD", "share of 0 to 1")


class Order(LabTest):
    def test_the_first_of_an_order_has_what_structures_share(self):
        file = self.folder / "two.seg.nrrd"
        size = (40, 40, 40)  # in the middle of the built-in abdomen
        count = size[0] * size[1] * size[2]
        voxels = bytearray(2 * count)
        voxels[0::2] = b"\1" * count
        voxels[1:count:2] = b"\1" * (count // 2)  # the second is in the first
        segments = "".join(
            f"Segment{n}_ID:=S{n}\nSegment{n}_LabelValue:=1\nSegment{n}_Layer:={n}\n"
            f"Segment{n}_Name:={name}\n" for n, name in enumerate(("large", "small")))
        file.write_bytes(
            ("NRRD0004\ntype: unsigned char\ndimension: 4\nspace: left-posterior-superior\n"
             f"sizes: 2 {size[0]} {size[1]} {size[2]}\n"
             "space directions: none (1,0,0) (0,1,0) (0,0,1)\nkinds: list domain domain domain\n"
             "encoding: raw\nspace origin: (-80,-40,0)\n" + segments + "\n").encode() + voxels)

        def shared(*choice):
            answer = lab("structures", "import", "phantom:abdomen", file, *choice)
            self.assertEqual(set(answer["overlapping"]), {"large", "small"})
            return [row["ml"] for row in answer["structures"]]

        by_size = shared()
        self.assertGreater(by_size[1], 10)
        turned = shared("--choice", "OVERLAP=order:large,small")
        self.assertEqual(turned[1], 0)
        self.assertAlmostEqual(turned[0], sum(by_size), delta=1e-6)
        self.assertEqual(shared("--choice", "OVERLAP=order:small"), by_size)
        answer = lab("structures", "import", "phantom:abdomen", file,
                     "--choice", "OVERLAP=order:large,spleen", expect=1)
        self.assert_error(answer, "BAD_CHOICE", "'spleen'", "'small'")


if __name__ == "__main__":
    main()
