#!/usr/bin/python3
"""Compares `trephine-lab import` of a CT folder with pydicom's reading of it, voxel by voxel.

usage: compare_with_pydicom.py FOLDER TREPHINE_LAB [--verdict V] [--size I,J,K] [--hu MIN,MAX]

FOLDER is taken under TREPHINE_TEST_DATA when it is relative; exit 77 (skipped) where that is unset.
Prints one line. Exit 0: everything equal; 1: a difference, which is named.
"""

import argparse
import hashlib
import json
import os
import subprocess
import sys
import tempfile
import zlib

SKIPPED = 77
TOLERANCE = 1e-6


class Difference(Exception):
    pass


def read_mha(path):
    """(header, voxels as [k, j, i]) of a MetaImage with its data in the same file."""
    import numpy as np

    header = {}
    with open(path, "rb") as file:
        while "ElementDataFile" not in header:
            line = file.readline()
            if not line:
                raise Difference("the MetaImage has no ElementDataFile")
            key, _, value = line.decode("ascii").partition("=")
            header[key.strip()] = value.strip()
        data = file.read()
    if header["ElementDataFile"] != "LOCAL" or header["ElementType"] != "MET_SHORT":
        raise Difference("the MetaImage is not local MET_SHORT data")
    if header.get("CompressedData", "False").lower() == "true":
        data = zlib.decompress(data)
    order = ">" if header.get("BinaryDataByteOrderMSB", "False").lower() == "true" else "<"
    size = [int(n) for n in header["DimSize"].split()]
    voxels = np.frombuffer(data, dtype=order + "i2")
    if voxels.size != size[0] * size[1] * size[2]:
        raise Difference(f"the MetaImage holds {voxels.size} voxels, not {size}")
    return header, voxels.reshape(size[::-1])


def numbers(header, *names):
    for name in names:
        if name in header:
            return [float(n) for n in header[name].split()]
    raise Difference(f"the MetaImage has no {names[0]}")


def read_with_pydicom(folder):
    """The CT series with most slices, by nothing but pydicom and numpy."""
    import numpy as np
    import pydicom

    series = {}
    for root, _, names in os.walk(folder):
        for name in names:
            try:
                slice_ = pydicom.dcmread(os.path.join(root, name))
            except pydicom.errors.InvalidDicomError:
                continue
            if slice_.get("Modality") == "CT" and "ImagePositionPatient" in slice_:
                series.setdefault(slice_.SeriesInstanceUID, []).append(slice_)
    if not series:
        raise Difference("pydicom finds no CT in the folder")
    uid, slices = max(series.items(), key=lambda item: len(item[1]))

    cosines = np.array(slices[0].ImageOrientationPatient, dtype=float)
    i_axis = cosines[:3] / np.linalg.norm(cosines[:3])
    j_axis = cosines[3:] / np.linalg.norm(cosines[3:])
    k_axis = np.cross(i_axis, j_axis)
    place = lambda s: float(np.dot(np.array(s.ImagePositionPatient, dtype=float), k_axis))
    slices.sort(key=place)
    hu = np.stack(
        [
            np.rint(s.pixel_array * (float(s.get("RescaleSlope", 1)) or 1.0)
                    + float(s.get("RescaleIntercept", 0)))
            for s in slices
        ]
    )
    if hu.min() < -32768 or hu.max() > 32767:
        raise Difference("the reference does not fit int16")
    step = (place(slices[-1]) - place(slices[0])) / max(1, len(slices) - 1)
    rows, columns = (float(v) for v in slices[0].PixelSpacing)
    return {
        "uid": str(uid),
        "hu": hu.astype("<i2"),
        "size": [hu.shape[2], hu.shape[1], hu.shape[0]],
        "spacing": [columns, rows, step],
        "origin": [float(v) for v in slices[0].ImagePositionPatient],
        "axes": [i_axis, j_axis, k_axis],
    }


def expect(what, found, expected):
    if found != expected:
        raise Difference(f"{what} is {found}, expected {expected}")


def expect_near(what, found, expected):
    if len(found) != len(expected) or any(
        abs(a - b) > TOLERANCE for a, b in zip(found, expected)
    ):
        raise Difference(f"{what} is {list(found)}, expected {list(expected)}")


def run_import(lab, folder, target):
    process = subprocess.run(
        [lab, "import", folder, "--json", "--with-identity", "--write", target], capture_output=True, text=True
    )
    try:
        answer = json.loads(process.stdout)
    except ValueError:
        raise Difference(f"stdout is not JSON (exit {process.returncode}): {process.stderr[-300:]}")
    if process.returncode != 0:
        raise Difference(f"import exits {process.returncode}: {answer.get('error')}")
    return answer


def compare(arguments, folder):
    import numpy as np

    reference = read_with_pydicom(folder)
    with tempfile.TemporaryDirectory() as scratch:
        target = os.path.join(scratch, "volume.mha")
        answer = run_import(arguments.lab, folder, target)
        header, voxels = read_mha(target)

    chosen = [s for s in answer["series"] if s["uid"] == answer["chosen"]]
    expect("the number of chosen series", len(chosen), 1)
    series = chosen[0]
    axes = reference["axes"]
    expect("uid", series["uid"].split("#")[0], reference["uid"])
    if arguments.verdict:
        expect("verdict", series["verdict"], arguments.verdict)
    expect("size", series["size"], reference["size"])
    expect_near("spacing_mm", series["spacing_mm"], reference["spacing"])
    expect_near("origin_mm", series["origin_mm"], reference["origin"])
    expect_near("direction", series["direction"], [axes[c][r] for r in range(3) for c in range(3)])
    expect("hu_min", series["hu_min"], int(reference["hu"].min()))
    expect("hu_max", series["hu_max"], int(reference["hu"].max()))
    sha = hashlib.sha256(reference["hu"].tobytes()).hexdigest()
    expect("volume_sha256", series["volume_sha256"], sha)

    # The file: MetaImage lists the axes one after the other.
    expect("the file's size", [int(n) for n in header["DimSize"].split()], reference["size"])
    expect_near("the file's spacing", numbers(header, "ElementSpacing"), reference["spacing"])
    expect_near("the file's origin", numbers(header, "Offset", "Position", "Origin"),
                reference["origin"])
    expect_near("the file's direction", numbers(header, "TransformMatrix", "Rotation"),
                [v for axis in axes for v in axis])
    different = int(np.count_nonzero(voxels != reference["hu"]))
    expect("the number of voxels that differ", different, 0)

    if arguments.size:
        expect("size", series["size"], [int(n) for n in arguments.size.split(",")])
    if arguments.hu:
        expect("HU", [series["hu_min"], series["hu_max"]],
               [int(n) for n in arguments.hu.split(",")])
    return (f"{series['verdict']} {'x'.join(map(str, series['size']))} "
            f"HU {series['hu_min']}..{series['hu_max']}: {voxels.size} voxels equal to pydicom's")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("folder")
    parser.add_argument("lab")
    parser.add_argument("--verdict")
    parser.add_argument("--size")
    parser.add_argument("--hu", help="MIN,MAX; write --hu=-1024,3071")
    arguments = parser.parse_args()

    data = os.environ.get("TREPHINE_TEST_DATA")
    if not data:
        print("skipped: TREPHINE_TEST_DATA is not set, so there is no real CT to compare")
        return SKIPPED
    try:
        import numpy  # noqa: F401
        import pydicom  # noqa: F401
    except ImportError as error:
        print(f"failed: {error}; install python3-pydicom and python3-numpy")
        return 1
    try:
        print(compare(arguments, os.path.join(data, arguments.folder)))
        return 0
    except Difference as difference:
        print(f"different: {difference}")
        return 1


if __name__ == "__main__":
    sys.exit(main())
