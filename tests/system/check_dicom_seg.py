#!/usr/bin/python3
"""DICOM segmentations as pydicom sees them: those that are written, read by it alone; and those that
it makes, read by the product.

usage: check_dicom_seg.py DICOM_SEG

Prints a line for each comparison. Exit 0: everything equal; 1: a difference, which is named.
"""

import json
import os
import subprocess
import sys
import tempfile

import numpy as np
import pydicom
from pydicom.dataset import Dataset, FileMetaDataset
from pydicom.sequence import Sequence

SEG = "1.2.840.10008.5.1.4.1.1.66.4"
NO_DATES = {"", "19000101", "000000"}
NOBODY = {"", "TREPHINE^CASE", "CASE"}
CHINESE = "\u809d\u810f"


class Difference(Exception):
    pass


def expect(what, found, expected):
    if found != expected:
        raise Difference(f"{what} is {found}, expected {expected}")


def expect_near(what, found, expected, tolerance=1e-6):
    if not np.allclose(np.array(found, float), np.array(expected, float), rtol=0, atol=tolerance):
        raise Difference(f"{what} is {found}, expected {expected}")


def run(program, *arguments):
    process = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True)
    if process.returncode != 0:
        raise Difference(f"{arguments[0]} exits {process.returncode}: {process.stderr[-300:]}")
    return json.loads(process.stdout)


# --- what is written ---

def place_of(frame):
    return np.array(frame.PlanePositionSequence[0].ImagePositionPatient, float)


def masks_of(seg, size, origin, axes, spacing):
    """{segment number: mask [k, j, i]} on the grid, from the frames' own bits and places."""
    pixels = seg.Rows * seg.Columns
    bits = np.unpackbits(np.frombuffer(seg.PixelData, np.uint8), bitorder="little")
    masks = {s.SegmentNumber: np.zeros(size[::-1], np.uint8) for s in seg.SegmentSequence}
    shared = seg.SharedFunctionalGroupsSequence[0]
    expect_near("pixel spacing", shared.PixelMeasuresSequence[0].PixelSpacing, spacing[1::-1])
    expect_near("orientation", shared.PlaneOrientationSequence[0].ImageOrientationPatient,
                [*axes[0], *axes[1]])
    expect("the number of frames", len(seg.PerFrameFunctionalGroupsSequence), seg.NumberOfFrames)
    for n, frame in enumerate(seg.PerFrameFunctionalGroupsSequence):
        offset = [np.dot(place_of(frame) - origin, axis) for axis in axes]
        expect_near("a frame's place beside the stack", offset[:2], [0, 0])
        k = offset[2] / spacing[2]
        expect_near("a frame's slice", k, round(k))
        number = frame.SegmentIdentificationSequence[0].ReferencedSegmentNumber
        mask = bits[n * pixels:(n + 1) * pixels].reshape(seg.Rows, seg.Columns)
        if not mask.any():
            raise Difference(f"frame {n + 1} is empty")
        masks[number][round(k)] |= mask
    return masks


def check_nobody(data, name):
    """No patient and no day in any element, of any depth."""
    for element in data.iterall():
        values = element.value if element.VM > 1 else [element.value]
        if element.VR == "PN" or element.keyword.startswith("Patient"):
            if any(str(value) not in NOBODY for value in values if value is not None):
                raise Difference(f"{name} has {element.keyword} {element.value}")
        if element.VR in ("DA", "TM", "DT"):
            if any(str(value) not in NO_DATES for value in values if value is not None):
                raise Difference(f"{name} has {element.keyword} {element.value}")


def check_written(program, scratch):
    folder, labels_file = os.path.join(scratch, "case"), os.path.join(scratch, "labels.raw")
    made = run(program, "write", folder, labels_file)
    if "error" in made:
        raise Difference(f"writing fails: {made}")
    expect("what was left out", len(made["notes"]), 1)
    size, origin, axes = made["size"], np.array(made["origin_mm"]), np.array(made["axes"])
    with open(labels_file, "rb") as file:
        labels = np.frombuffer(file.read(), np.uint8).reshape(size[::-1])

    ct = {}
    for name in sorted(os.listdir(os.path.join(folder, "CT"))):
        slice_ = pydicom.dcmread(os.path.join(folder, "CT", name))
        check_nobody(slice_, name)
        ct[slice_.SOPInstanceUID] = slice_
    expect("the number of CT slices", len(ct), size[2])
    seg = pydicom.dcmread(os.path.join(folder, "structures.dcm"))
    check_nobody(seg, "structures.dcm")
    expect("SOP class", seg.SOPClassUID, SEG)
    expect("modality", seg.Modality, "SEG")
    for slice_ in ct.values():
        for keyword in ("StudyInstanceUID", "FrameOfReferenceUID", "PatientName", "PatientID"):
            expect(keyword, seg[keyword].value, slice_[keyword].value)
        expect_near("CT orientation", slice_.ImageOrientationPatient, [*axes[0], *axes[1]])

    # References: every one to a slice that is there, of a frame to the slice at its place.
    series = {slice_.SeriesInstanceUID for slice_ in ct.values()}
    expect("the referenced series", {s.SeriesInstanceUID for s in seg.ReferencedSeriesSequence},
           series)
    if seg.SeriesInstanceUID in series:
        raise Difference("the segmentation lies in the CT's series")
    listed = {i.ReferencedSOPInstanceUID
              for s in seg.ReferencedSeriesSequence for i in s.ReferencedInstanceSequence}
    for frame in seg.PerFrameFunctionalGroupsSequence:
        sources = frame.DerivationImageSequence[0].SourceImageSequence
        expect("a frame's number of sources", len(sources), 1)
        uid = sources[0].ReferencedSOPInstanceUID
        if uid not in ct or uid not in listed:
            raise Difference(f"a frame refers to {uid}, which is not there")
        expect("SOP class of a source", sources[0].ReferencedSOPClassUID, ct[uid].SOPClassUID)
        expect_near("the place of a frame's source", ct[uid].ImagePositionPatient, place_of(frame))

    masks = masks_of(seg, size, origin, axes, made["spacing_mm"])
    structures = [s for s in made["structures"] if s["label"] in labels]
    expect("the names", [s.SegmentLabel for s in seg.SegmentSequence],
           [s["name"] for s in structures])
    voxels = 0
    for segment, structure in zip(seg.SegmentSequence, structures):
        expected = (labels == structure["label"]).astype(np.uint8)
        if masks[segment.SegmentNumber].tobytes() != expected.tobytes():
            raise Difference(f"the mask of {structure['name']} differs")
        voxels += int(expected.sum())
        code = segment.SegmentedPropertyTypeCodeSequence[0]
        expect("coding scheme", code.CodingSchemeDesignator, "SCT")
    expect("codes", [s.SegmentedPropertyTypeCodeSequence[0].CodeValue for s in seg.SegmentSequence],
           ["10200004", "59820001", "64033007"])
    print(f"written: {len(ct)} slices, {seg.NumberOfFrames} frames, {voxels} voxels equal")

    # And what was written is read back.
    read_back(program, os.path.join(folder, "structures.dcm"), scratch, 0.5,
              {s["name"]: labels == s["label"] for s in structures}, origin, axes,
              made["spacing_mm"],
              {s["name"]: s["colour"] for s in structures})


# --- what is read ---

def seg_of(masks, names, origin, axes, spacing, fractional=None, order=None, syntax=None):
    """A segmentation of masks [k, j, i] (of values up to `fractional` where that is given)."""
    data = Dataset()
    data.file_meta = FileMetaDataset()
    data.file_meta.TransferSyntaxUID = syntax or pydicom.uid.ExplicitVRLittleEndian
    data.file_meta.MediaStorageSOPClassUID = data.SOPClassUID = SEG
    data.file_meta.MediaStorageSOPInstanceUID = data.SOPInstanceUID = "1.2.3.9"
    data.is_little_endian, data.is_implicit_VR = True, False
    data.SpecificCharacterSet = "ISO_IR 192"
    data.StudyInstanceUID, data.SeriesInstanceUID = "1.2.3", "1.2.3.8"
    data.FrameOfReferenceUID = "1.2.3.7"
    data.Modality, data.ImageType = "SEG", ["DERIVED", "PRIMARY"]
    data.Rows, data.Columns = masks[0].shape[1:]
    data.SamplesPerPixel, data.PhotometricInterpretation = 1, "MONOCHROME2"
    data.PixelRepresentation = 0
    bits = 8 if fractional else 1
    data.BitsAllocated, data.BitsStored, data.HighBit = bits, bits, bits - 1
    data.SegmentationType = "FRACTIONAL" if fractional else "BINARY"
    if fractional:
        data.SegmentationFractionalType = "PROBABILITY"
        data.MaximumFractionalValue = fractional
    data.SegmentSequence = Sequence()
    for number, name in enumerate(names, 1):
        segment = Dataset()
        segment.SegmentNumber, segment.SegmentLabel = number, name
        segment.SegmentAlgorithmType = "MANUAL"
        data.SegmentSequence.append(segment)
    measures, turned, shared = Dataset(), Dataset(), Dataset()
    measures.PixelSpacing = [spacing[1], spacing[0]]
    measures.SliceThickness = spacing[2]
    turned.ImageOrientationPatient = [float(f"{v:.12g}") for v in [*axes[0], *axes[1]]]
    shared.PixelMeasuresSequence, shared.PlaneOrientationSequence = [measures], [turned]
    data.SharedFunctionalGroupsSequence = [shared]
    frames = [(number, k) for number, mask in enumerate(masks, 1) for k in range(len(mask))
              if mask[k].any()]
    if order is not None:
        order.shuffle(frames)
    data.PerFrameFunctionalGroupsSequence = Sequence()
    for number, k in frames:
        frame, position, segment = Dataset(), Dataset(), Dataset()
        position.ImagePositionPatient = [float(f"{v:.10g}")
                                         for v in origin + axes[2] * spacing[2] * k]
        segment.ReferencedSegmentNumber = number
        frame.PlanePositionSequence = [position]
        frame.SegmentIdentificationSequence = [segment]
        data.PerFrameFunctionalGroupsSequence.append(frame)
    data.NumberOfFrames = len(frames)
    pixels = np.concatenate([masks[number - 1][k].ravel() for number, k in frames])
    packed = pixels.astype(np.uint8) if fractional else np.packbits(pixels > 0, bitorder="little")
    data.PixelData = packed.tobytes() + b"\0" * (packed.size % 2)
    data["PixelData"].VR = "OB"
    return data


def read_back(program, file, scratch, threshold, expected, origin, axes, spacing, colours=None):
    """Reads the file and compares each segment with its mask [k, j, i] of the whole grid."""
    layers_file = os.path.join(scratch, "layers.raw")
    made = run(program, "read", file, threshold, layers_file)
    if "error" in made:
        raise Difference(f"reading {os.path.basename(file)} fails: {made}")
    expect("whether it is a segmentation", made["is_segmentation"], True)
    size = made["size"]
    with open(layers_file, "rb") as layers:
        values = np.frombuffer(layers.read(), np.uint8).reshape(made["layers"], *size[::-1])
    expect_near("spacing", made["spacing_mm"], spacing)
    expect_near("axes", made["axes"], axes)
    offset = [np.dot(np.array(made["origin_mm"]) - origin, axis) for axis in axes]
    first = round(offset[2] / spacing[2])
    expect_near("the first voxel's place", offset, [0, 0, first * spacing[2]])
    expect("the names", [s["name"] for s in made["segments"]], list(expected))
    voxels = 0
    for segment in made["segments"]:
        mask = expected[segment["name"]]
        found = np.zeros(mask.shape, bool)
        found[first:first + size[2]] = values[segment["layer"]] == segment["value"]
        if found.tobytes() != mask.astype(bool).tobytes():
            raise Difference(f"{segment['name']} of {os.path.basename(file)} differs in "
                             f"{int(np.count_nonzero(found != mask))} voxels")
        voxels += int(mask.sum())
        if colours:
            expect_near("colour", segment["colour"], colours[segment["name"]], 1e-3)
    print(f"read: {os.path.basename(file)}, {len(expected)} segments in {made['layers']} layers, "
          f"{voxels} voxels equal")
    return made


def check_read(program, scratch):
    random = np.random.default_rng(11)
    shape = (9, 13, 19)  # k, j, i: frames that end within a byte
    origin = np.array([-12.5, 40.25, 7.0])
    i = np.array([0.98, 0.12, -0.1])
    i /= np.linalg.norm(i)
    k = np.cross(i, [0.05, 1.0, 0.2])
    k /= np.linalg.norm(k)
    axes, spacing = np.array([i, np.cross(k, i), k]), [0.9, 0.75, 2.0]
    masks = [random.random(shape) < share for share in (0.3, 0.1, 0.02)]
    masks[1][[0, 3, 4]] = False  # slices without frames
    masks[2][:6] = False
    names = ["liver", CHINESE, "vessel"]

    def saved(name, data):
        path = os.path.join(scratch, name)
        data.save_as(path, write_like_original=False)
        return path

    expected = dict(zip(names, masks))
    grid = (origin, axes, spacing)
    file = saved("binary.dcm", seg_of(masks, names, *grid))
    made = read_back(program, file, scratch, 0.5, expected, *grid)
    if made["layers"] < 2:
        raise Difference("segments that overlap came out in one layer")
    file = saved("shuffled.dcm", seg_of(masks, names, *grid, order=random))
    read_back(program, file, scratch, 0.5, expected, *grid)
    file = saved("deflated.dcm", seg_of(masks, names, *grid,
                                        syntax=pydicom.uid.DeflatedExplicitVRLittleEndian))
    read_back(program, file, scratch, 0.5, expected, *grid)

    most = 180
    shares = [random.integers(0, most + 1, shape) for _ in names]
    data = seg_of(shares, names, *grid, fractional=most, order=random)
    file = saved("fractional.dcm", data)
    for threshold in (0.25, 0.5, 1.0):
        above = {name: share >= threshold * most for name, share in zip(names, shares)}
        read_back(program, file, scratch, threshold, above, *grid)
    data.compress(pydicom.uid.RLELossless, encoding_plugin="pydicom")
    file = saved("rle.dcm", data)
    half = {name: share >= 0.5 * most for name, share in zip(names, shares)}
    read_back(program, file, scratch, 0.5, half, *grid)

    # What is wrong is said, not read.
    whole = open(os.path.join(scratch, "binary.dcm"), "rb").read()
    with open(os.path.join(scratch, "cut.dcm"), "wb") as file:
        file.write(whole[:len(whole) - 20])
    for name in ("cut.dcm", "layers.raw"):
        answer = run(program, "read", os.path.join(scratch, name), 0.5,
                     os.path.join(scratch, "none.raw"))
        if "error" not in answer:
            raise Difference(f"{name} was read")
    print("refused: a file that is cut, one that is no DICOM")


def main():
    if len(sys.argv) != 2:
        print(__doc__)
        return 2
    try:
        with tempfile.TemporaryDirectory() as scratch:
            check_written(sys.argv[1], scratch)
            check_read(sys.argv[1], scratch)
        return 0
    except Difference as difference:
        print(f"different: {difference}")
        return 1


if __name__ == "__main__":
    sys.exit(main())
