#!/usr/bin/python3
"""Compares every grey image under TREPHINE_TEST_DATA, decoded by the importer, with what pydicom
and numpy make of it: HU voxel by voxel, before anything is resampled.

usage: compare_slices_with_pydicom.py DECODE_SLICES [FOLDER]

Reference HU = rint(stored * slope + intercept), clamped to int16; padding is -1000. Stored values
are masked to their bits and sign-extended here. pydicom decodes uncompressed, deflated and RLE
pixels by itself; for JPEG and JPEG-LS DCMTK's dcmdjpeg and dcmdjpls are asked, for JPEG 2000
opj_decompress. Where such a program is not installed, the files are listed as skipped.

Exit 0: all equal; 1: a difference, or a grey lossless image that the importer does not decode;
77: skipped, there are no data.
"""

import collections
import json
import os
import shutil
import subprocess
import sys
import tempfile
import warnings

SKIPPED = 77
AIR = -1000
JPEG = {"1.2.840.10008.1.2.4.57", "1.2.840.10008.1.2.4.70"}
JPEG_LS = {"1.2.840.10008.1.2.4.80"}
JPEG_2000 = {"1.2.840.10008.1.2.4.90", "1.2.840.10008.1.2.4.91"}
LOSSY = {"1.2.840.10008.1.2.4.50", "1.2.840.10008.1.2.4.51", "1.2.840.10008.1.2.4.81"}

# Grey images that the importer does not decode, and rightly so: the end of a file's path.
NOT_DECODED = {
    # A whole row more than rows and columns need: which of the numbers is wrong cannot be told.
    "pydicom/MR_small_padded.dcm",
}


class NoReference(Exception):
    """Why there is nothing to compare with."""


def whole_number(value, fallback):
    return fallback if value is None or value == "" else int(value)


def decimal(value, fallback):
    return fallback if value is None or value == "" else float(value)


def run(program, *arguments):
    if not shutil.which(program):
        raise NoReference(f"{program} is not installed")
    done = subprocess.run([program, *arguments], capture_output=True, text=True)
    if done.returncode != 0:
        raise NoReference(f"{program} cannot decode it")


def codestream(data):
    import pydicom.encaps

    return b"".join(pydicom.encaps.decode_data_sequence(data.PixelData))


def words_by_openjpeg(data, scratch):
    import numpy as np

    # The codestream starts at its own mark: a JP2 file's boxes are left out.
    bytes_ = codestream(data)
    source, target = os.path.join(scratch, "a.j2k"), os.path.join(scratch, "a.rawl")
    with open(source, "wb") as file:
        file.write(bytes_[bytes_.index(b"\xff\x4f\xff\x51"):])
    run("opj_decompress", "-i", source, "-o", target)
    precision_is_wide = bytes_[bytes_.index(b"\xff\x4f\xff\x51") + 42] & 0x7F > 7
    words = np.fromfile(target, dtype="<u2" if precision_is_wide else "u1")
    return words.astype(np.int64)


def stored_words(path, data, scratch):
    """The words of a single frame, unsigned, with whatever stands in their unused bits."""
    import numpy as np
    import pydicom

    syntax = str(data.file_meta.TransferSyntaxUID)
    if syntax in JPEG_2000:
        return words_by_openjpeg(data, scratch)
    if syntax in JPEG | JPEG_LS:
        target = os.path.join(scratch, "a.dcm")
        run("dcmdjpls" if syntax in JPEG_LS else "dcmdjpeg", path, target)
        data = pydicom.dcmread(target)
    try:
        words = data.pixel_array
    except Exception as error:  # pydicom raises whatever comes to hand
        raise NoReference(f"pydicom: {error}")
    bits = data.BitsAllocated
    return words.astype(np.int64).ravel() & ((1 << bits) - 1)


def reference(path, scratch):
    """HU of the file's one grey frame."""
    import numpy as np
    import pydicom

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        data = pydicom.dcmread(path, force=True)
    if "Rows" not in data or "PixelData" not in data:
        raise NoReference("no pixels")
    if whole_number(data.get("SamplesPerPixel"), 1) != 1:
        raise NoReference("colour")
    if data.BitsAllocated not in (8, 16):
        raise NoReference(f"{data.BitsAllocated} bits allocated")
    if whole_number(str(data.get("NumberOfFrames") or "1").rstrip("A"), 1) != 1:
        raise NoReference("several frames")
    if not hasattr(data, "file_meta"):
        data.file_meta = pydicom.dataset.FileMetaDataset()
    if "TransferSyntaxUID" not in data.file_meta:
        data.file_meta.TransferSyntaxUID = (
            pydicom.uid.ImplicitVRLittleEndian if data.is_implicit_VR
            else pydicom.uid.ExplicitVRLittleEndian if data.is_little_endian
            else pydicom.uid.ExplicitVRBigEndian)
    if str(data.file_meta.TransferSyntaxUID) in LOSSY:
        raise NoReference("compressed with loss")

    words = stored_words(path, data, scratch)
    if words.size != data.Rows * data.Columns:
        raise NoReference(f"{words.size} pixels for {data.Columns}x{data.Rows}")
    bits = whole_number(data.get("BitsStored"), data.BitsAllocated)
    high = whole_number(data.get("HighBit"), bits - 1)
    stored = (words >> (high + 1 - bits)) & ((1 << bits) - 1)
    signed = whole_number(data.get("PixelRepresentation"), 0) == 1
    if signed:
        stored = np.where(stored >> (bits - 1) != 0, stored - (1 << bits), stored)
    hu = np.rint(stored * (decimal(data.get("RescaleSlope"), 1.0) or 1.0)
                 + decimal(data.get("RescaleIntercept"), 0.0))
    hu = np.clip(hu, -32768, 32767).astype(np.int64)
    padding = data.get("PixelPaddingValue")
    if padding is not None:
        limit = data.get("PixelPaddingRangeLimit", padding)
        as_signed = lambda v: v - 65536 if signed and v > 32767 else v
        low, high_end = sorted((as_signed(int(padding)), as_signed(int(limit))))
        hu[(stored >= low) & (stored <= high_end)] = AIR
    return hu.astype("<i2")


def decode(program, paths, scratch):
    """path -> its lines, each with its HU where there are any."""
    import numpy as np

    target = os.path.join(scratch, "decoded")
    done = subprocess.run([program, "--out", target, *paths], capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(f"decode_slices ends with {done.returncode}: {done.stderr[-300:]}")
    lines = collections.defaultdict(list)
    with open(target, "rb") as file:
        for text in done.stdout.splitlines():
            line = json.loads(text)
            if "columns" in line:
                count = line["columns"] * line["rows"]
                line["hu"] = np.frombuffer(file.read(2 * count), dtype="<i2")
            lines[line["file"]].append(line)
        assert not file.read(1), "decode_slices wrote more than it said"
    return lines


def main():
    if len(sys.argv) not in (2, 3):
        print(__doc__)
        return 2
    folder = sys.argv[2] if len(sys.argv) == 3 else os.environ.get("TREPHINE_TEST_DATA")
    if not folder:
        print("skipped: TREPHINE_TEST_DATA is not set, so there are no real images to compare")
        return SKIPPED
    try:
        import numpy as np
        import pydicom  # noqa: F401
    except ImportError as error:
        print(f"failed: {error}; install python3-pydicom and python3-numpy")
        return 1

    # Files under "reported" contradict themselves, and pydicom's reading is not the right one.
    paths = sorted(os.path.join(root, name) for root, _, names in os.walk(folder)
                   if "reported" not in os.path.relpath(root, folder).split(os.sep)
                   for name in names if not name.endswith((".gz", ".nii")))
    equal, voxels = collections.Counter(), 0
    reasons, failures = collections.Counter(), []
    with tempfile.TemporaryDirectory() as scratch:
        lines = decode(sys.argv[1], paths, scratch)
        for path in paths:
            name = os.path.relpath(path, folder)
            try:
                expected = reference(path, scratch)
            except NoReference as reason:
                reasons[str(reason)] += 1
                continue
            decoded = [line for line in lines[path] if "hu" in line]
            if not decoded:
                why = lines[path][0].get("error") or lines[path][0].get("skipped")
                if not any(name.endswith(end) for end in NOT_DECODED):
                    failures.append(f"{name} is not decoded: {why}")
                else:
                    reasons[why] += 1
                continue
            found = decoded[0]["hu"]
            if len(decoded) > 1 or found.size != expected.size:
                failures.append(f"{name} gives {len(decoded)} frames of {found.size} voxels")
                continue
            different = int(np.count_nonzero(found != expected))
            if different:
                failures.append(f"{name}: {different} of {found.size} voxels differ")
                continue
            equal["files"] += 1
            voxels += found.size
    for reason, count in sorted(reasons.items()):
        print(f"nothing to compare in {count}: {reason}")
    for failure in failures:
        print(f"different: {failure}")
    print(f"{equal['files']} files with {voxels} voxels are equal, {len(failures)} are not")
    return 1 if failures or not equal["files"] else 0


if __name__ == "__main__":
    sys.exit(main())
