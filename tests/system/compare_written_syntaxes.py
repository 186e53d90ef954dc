#!/usr/bin/python3
"""Slices of every kind of stored value, written in every transfer syntax that Debian's tools write,
and decoded by the importer: HU voxel by voxel against the numbers that were written.

usage: compare_written_syntaxes.py DECODE_SLICES

Tools: DCMTK (dcmconv, dcmcjpeg, dcmcjpls, dcmcrle), GDCM (gdcmconv), OpenJPEG (opj_compress) and
OpenJPH (ojph_compress); for the last two pydicom puts the codestream into the file. A tool that
refuses a kind of value is listed.

Exit 0: all equal; 1: a difference, a file that is not decoded, or a tool that writes nothing.
"""

import collections
import os
import shutil
import subprocess
import sys
import tempfile

import numpy as np
import pydicom
import pydicom.encaps
from compare_slices_with_pydicom import decode

ROWS, COLUMNS, SLICES = 45, 70, 3
# Name: bits allocated and stored, signed, intercept.
KINDS = {
    "int16": (16, 16, True, 0),
    "uint16": (16, 16, False, -32768),
    "int12": (16, 12, True, 0),
    "uint12": (16, 12, False, -1024),
    "uint8": (8, 8, False, -100),
}
HTJ2K, HTJ2K_RPCL, HTJ2K_ANY = (f"1.2.840.10008.1.2.4.{n}" for n in (201, 202, 203))
for uid, name in ((HTJ2K, "Lossless Only"), (HTJ2K_RPCL, "Lossless RPCL"), (HTJ2K_ANY, "Any")):
    # Debian's pydicom is older than these.
    pydicom.uid.UID_dictionary.setdefault(
        uid, (f"High-Throughput JPEG 2000 ({name})", "Transfer Syntax", "", "", ""))
J2K, J2K_ANY = "1.2.840.10008.1.2.4.90", "1.2.840.10008.1.2.4.91"

# Tool and options.
CONVERTERS = [
    ("dcmconv", "+ti"), ("dcmconv", "+te"), ("dcmconv", "+tb"), ("dcmconv", "+td"),
    ("dcmcjpeg", "+e1"), ("dcmcjpeg", "+el"), ("dcmcjpls", "+el"), ("dcmcrle", ""),
    ("gdcmconv", "--raw"), ("gdcmconv", "--implicit"), ("gdcmconv", "--deflated"),
    ("gdcmconv", "--jpeg"), ("gdcmconv", "--j2k"), ("gdcmconv", "--jpegls"), ("gdcmconv", "--rle"),
    ("gdcmconv", "--j2k --tile 32,32"),
]
# Tool, options, transfer syntax.
ENCODERS = [
    ("opj_compress", "", J2K), ("opj_compress", "-n 1 -p RLCP", J2K_ANY),
    ("opj_compress", "-t 32,32 -b 16,16", J2K),
    ("ojph_compress", "-prog_order LRCP", HTJ2K), ("ojph_compress", "-prog_order RPCL", HTJ2K_RPCL),
    ("ojph_compress", "-num_decomps 2 -block_size {32,32}", HTJ2K_ANY),
    ("ojph_compress", "-tile_size {32,32} -num_decomps 3", HTJ2K_ANY),
]


def stored_values(kind, slice_number):
    """A ramp with noise and both ends of the range: no two slices are alike."""
    _, bits, signed, _ = KINDS[kind]
    low = -(1 << (bits - 1)) if signed else 0
    high = low + (1 << bits) - 1
    random = np.random.default_rng(slice_number)
    ramp = np.linspace(low, high, ROWS * COLUMNS).reshape(ROWS, COLUMNS)
    values = np.clip(np.rint(ramp + random.normal(0, 9, ramp.shape)), low, high)
    values[:4, :4] = random.integers(low, high, (4, 4), endpoint=True)
    values[5, :20], values[6, :20] = low, high
    return values.astype(np.int64)


def plain_slice(kind, slice_number):
    """The slice as an uncompressed data set."""
    allocated, bits, signed, intercept = KINDS[kind]
    data = pydicom.Dataset()
    data.file_meta = pydicom.dataset.FileMetaDataset()
    data.file_meta.TransferSyntaxUID = pydicom.uid.ExplicitVRLittleEndian
    data.file_meta.MediaStorageSOPClassUID = data.SOPClassUID = pydicom.uid.CTImageStorage
    data.file_meta.MediaStorageSOPInstanceUID = data.SOPInstanceUID = f"1.2.3.{slice_number + 1}"
    data.is_little_endian, data.is_implicit_VR = True, False
    data.StudyInstanceUID, data.SeriesInstanceUID, data.FrameOfReferenceUID = "1.1", "1.2", "1.3"
    data.Modality, data.PatientID, data.PatientName = "CT", "", ""
    data.ImageType = ["ORIGINAL", "PRIMARY", "AXIAL"]
    data.Rows, data.Columns, data.SamplesPerPixel = ROWS, COLUMNS, 1
    data.PhotometricInterpretation = "MONOCHROME2"
    data.BitsAllocated, data.BitsStored, data.HighBit = allocated, bits, bits - 1
    data.PixelRepresentation = int(signed)
    data.RescaleSlope, data.RescaleIntercept = "1", str(intercept)
    data.PixelSpacing = ["1", "1"]
    data.ImageOrientationPatient = ["1", "0", "0", "0", "1", "0"]
    data.ImagePositionPatient = ["0", "0", str(slice_number)]
    data.InstanceNumber = str(slice_number + 1)
    words = stored_values(kind, slice_number).astype("u1" if allocated == 8 else "<u2")
    if bits < allocated:
        words &= (1 << bits) - 1
    data.PixelData = words.tobytes() + b"\0" * (words.nbytes % 2)
    data["PixelData"].VR = "OW" if allocated == 16 else "OB"
    return data


def run(tool, *arguments):
    """Whether the tool is content."""
    if not shutil.which(tool):
        raise SystemExit(f"{tool} is not installed: packaging/packages.txt, [test]")
    return subprocess.run([tool, *arguments], capture_output=True).returncode == 0


def convert(tool, options, source, target):
    return run(tool, *options.split(), source, target) and os.path.exists(target)


def encode(tool, options, syntax, kind, slice_number, scratch, target):
    """The slice with a codestream of this tool."""
    _, bits, signed, _ = KINDS[kind]
    values = stored_values(kind, slice_number)
    if tool == "ojph_compress" and signed:
        return False  # version 0.9 takes them for unsigned: its streams hold values out of range
    words = values.astype("<i2" if bits > 8 else "u1")
    stream = os.path.join(scratch, "a.j2c")
    if tool == "opj_compress":
        raw = os.path.join(scratch, "a.rawl")
        words.tofile(raw)
        shape = f"{COLUMNS},{ROWS},1,{bits},{'s' if signed else 'u'}"
        done = run(tool, "-i", raw, "-o", stream, "-F", shape, *options.split())
    else:
        raw = os.path.join(scratch, "a.yuv")
        words.tofile(raw)
        done = run(tool, "-i", raw, "-o", stream, "-dims", f"{{{COLUMNS},{ROWS}}}",
                   "-num_comps", "1", "-signed", "false", "-bit_depth", str(bits),
                   "-downsamp", "{1,1}", "-reversible", "true", *options.split())
    if not done or not os.path.exists(stream):
        return False
    data = plain_slice(kind, slice_number)
    data.file_meta.TransferSyntaxUID = syntax
    with open(stream, "rb") as file:
        data.PixelData = pydicom.encaps.encapsulate([file.read()])
    os.remove(stream)
    data["PixelData"].VR = "OB"
    data["PixelData"].is_undefined_length = True
    data.save_as(target, write_like_original=False)
    return True


def main():
    if len(sys.argv) != 2:
        print(__doc__)
        return 2
    written, refused, failures = {}, [], []
    with tempfile.TemporaryDirectory() as scratch:
        plain = os.path.join(scratch, "plain.dcm")
        for kind in KINDS:
            for n in range(SLICES):
                plain_slice(kind, n).save_as(plain, write_like_original=False)
                for tool, *rest in CONVERTERS + ENCODERS:
                    target = os.path.join(scratch, f"{len(written)}.dcm")
                    done = (convert(tool, rest[0], plain, target) if len(rest) == 1
                            else encode(tool, *rest, kind, n, scratch, target))
                    if done:
                        written[target] = (f"{tool} {rest[0]}".strip(), kind, n)
                    else:
                        refused.append((f"{tool} {rest[0]}".strip(), kind))
        lines = decode(sys.argv[1], list(written), scratch)
        syntaxes, equal, voxels = collections.Counter(), 0, 0
        for target, (how, kind, n) in written.items():
            expected = np.clip(stored_values(kind, n) + KINDS[kind][3], -32768, 32767)
            decoded = [line for line in lines[target] if "hu" in line]
            if len(decoded) != 1 or decoded[0]["hu"].size != expected.size:
                why = lines[target][0].get("error") or lines[target][0].get("skipped")
                failures.append(f"{how} of {kind}: not decoded: {why}")
                continue
            different = int(np.count_nonzero(decoded[0]["hu"] != expected.ravel()))
            if different:
                failures.append(f"{how} of {kind}: {different} of {expected.size} voxels differ")
                continue
            equal += 1
            voxels += expected.size
            syntaxes[pydicom.filereader.read_file_meta_info(target).TransferSyntaxUID.name] += 1
    for name, count in sorted(syntaxes.items()):
        print(f"{count:4} slices equal in {name}")
    for (how, kind), count in sorted(collections.Counter(refused).items()):
        print(f"{how} does not write {kind}")
    silent = ({f"{tool} {rest[0]}".strip() for tool, *rest in CONVERTERS + ENCODERS}
              - {how for how, _, _ in written.values()})
    failures += [f"{how} wrote nothing" for how in sorted(silent)]
    for failure, count in sorted(collections.Counter(failures).items()):
        print(f"different: {failure} ({count} times)")
    print(f"{equal} slices with {voxels} voxels are equal, {len(failures)} are not")
    return 1 if failures or not equal else 0


if __name__ == "__main__":
    sys.exit(main())
