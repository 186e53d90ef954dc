#!/usr/bin/python3
"""Compares the skull that is found in a real CT with what numpy makes of the same voxels.

usage: compare_skull_with_numpy.py FOLDER SKULL_OF

FOLDER is below TREPHINE_TEST_DATA. Reference: the largest piece, across corners, of what is over
226 HU once couch and holder are out; HU are pydicom's. At least 99 % of it is to be in the skull,
and in each eighth of the head at least 98 %, so that no part is missing; nothing of what went with
the couch may be in it, and next to nothing (1 %) that is not
of the reference.

Exit 0: as it is to be; 1: it is not; 77: skipped, there are no data.
"""

import json
import os
import pathlib
import struct
import subprocess
import sys
import tempfile

SKIPPED = 77
BONE_HU = 226


def nifti(file):
    """Voxels as stored, [k, j, i]."""
    import numpy
    raw = file.read_bytes()
    size = struct.unpack_from("<3h", raw, 42)
    kind = {2: "u1", 4: "<i2"}[struct.unpack_from("<h", raw, 70)[0]]
    begin = int(struct.unpack_from("<f", raw, 108)[0])
    return numpy.frombuffer(raw, kind, offset=begin).reshape(size[::-1])


def stored(folder):
    """HU of the files in the order of their places along the patient, [k, j, i]."""
    import numpy
    import pydicom
    slices = []
    for file in sorted(folder.rglob("*")):
        if not file.is_file():
            continue
        try:
            slice_ = pydicom.dcmread(file)
        except pydicom.errors.InvalidDicomError:
            continue
        if "PixelData" in slice_:
            slices.append(slice_)
    slices.sort(key=lambda s: float(s.ImagePositionPatient[2]))
    return numpy.stack([
        numpy.rint(s.pixel_array * float(s.RescaleSlope) + float(s.RescaleIntercept))
        for s in slices]).astype("i4")


def largest_piece(mask):
    """Of voxels that share a corner at least: runs along rows, joined where they meet."""
    import numpy
    edges = numpy.diff(numpy.pad(mask, ((0, 0), (0, 0), (1, 1))).astype("i1"), axis=2)
    begins, ends = numpy.argwhere(edges == 1), numpy.argwhere(edges == -1)
    rows, columns, deep = mask.shape[1], mask.shape[2], mask.shape[0]
    row_of = begins[:, 0] * rows + begins[:, 1]
    starts, stops = begins[:, 2], ends[:, 2]
    first = numpy.searchsorted(row_of, numpy.arange(deep * rows + 1))
    parent = list(range(len(starts)))

    def top(n):
        while parent[n] != n:
            parent[n] = parent[parent[n]]
            n = parent[n]
        return n

    for row in range(deep * rows):
        k, j = divmod(row, rows)
        for dk, dj in ((0, -1), (-1, -1), (-1, 0), (-1, 1)):
            if first[row] == first[row + 1] or not (0 <= j + dj < rows and k + dk >= 0):
                continue
            other = (k + dk) * rows + j + dj
            for b in range(first[other], first[other + 1]):
                for a in range(first[row], first[row + 1]):
                    if starts[a] <= stops[b] and starts[b] <= stops[a]:
                        parent[top(a)] = top(b)
    piece = numpy.array([top(n) for n in range(len(starts))])
    voxels = numpy.bincount(piece, weights=stops - starts, minlength=len(starts))
    out = numpy.zeros_like(mask)
    for n in numpy.flatnonzero(piece == voxels.argmax()):
        out[begins[n, 0], begins[n, 1], starts[n]:stops[n]] = True
    return out


def main(arguments):
    if len(arguments) != 3:
        print(__doc__, file=sys.stderr)
        return 1
    data = os.environ.get("TREPHINE_TEST_DATA")
    if not data:
        print("skipped: TREPHINE_TEST_DATA is not set: this test needs the real CT data")
        return SKIPPED
    folder = pathlib.Path(data) / arguments[1]
    with tempfile.TemporaryDirectory(prefix="trephine-") as name:
        out = pathlib.Path(name)
        done = subprocess.run([arguments[2], folder, out], capture_output=True, text=True)
        print(done.stdout.strip(), done.stderr.strip())
        if done.returncode != 0:
            return 1
        said = json.loads(done.stdout)
        whole, ct, skull = (nifti(out / f"{part}.nii") for part in ("whole", "ct", "skull"))
        skull = skull != 0

        failures = []

        def check(what, value, good):
            print(f"{'' if good else 'FAILED: '}{what}: {value}")
            if not good:
                failures.append(what)

        hu = stored(folder)
        if not (hu == whole).all():
            hu = hu[::-1]
        check("voxels that are not pydicom's", int((hu != whole).sum()), (hu == whole).all())
        couch = whole != ct
        check("voxels of couch and holder", int(couch.sum()), couch.sum() > 10000)
        bone = largest_piece(ct > BONE_HU)
        check("voxels of the reference", int(bone.sum()), bone.sum() > 1000000)
        check("HU that the skull is said to begin at", said["hu"], said["hu"] == BONE_HU)
        check("voxels that are said", said["voxels"], said["voxels"] == skull.sum())
        kept = (bone & skull).sum() / bone.sum()
        check("% of the reference in the skull", f"{100 * kept:.3f}", kept >= 0.99)
        middle = [size // 2 for size in bone.shape]
        least = 1.0
        for eighth in range(8):
            part = tuple(slice(half, None) if eighth >> axis & 1 else slice(None, half)
                         for axis, half in enumerate(middle))
            least = min(least, (bone[part] & skull[part]).sum() / max(1, bone[part].sum()))
        check("% of it in the eighth that has least", f"{100 * least:.3f}", least >= 0.98)
        check("voxels of couch and holder in the skull", int((couch & skull).sum()),
              not (couch & skull).any())
        beyond = (skull & ~bone).sum() / bone.sum()
        check("% beyond the reference", f"{100 * beyond:.3f}", beyond <= 0.01)
        return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
