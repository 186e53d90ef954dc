"""Volume files against other people's readers and writers: libnifti (nifti_tool) and Teem (unu)."""

import gzip
import math
import random
import shutil
import struct
import subprocess
import unittest
import zlib

from lab_support import LabTest, lab, main

NIFTI_TOOL = shutil.which("nifti_tool")
UNU = shutil.which("teem-unu") or shutil.which("unu")
SIZE = (13, 9, 7)
HU = [i * 7919 % 4096 - 1024 for i in range(math.prod(SIZE))]


class Placed:
    """Voxels, i fastest, and where they lie: columns are mm a voxel along i, j and k, LPS."""

    def __init__(self, size, columns, origin, values):
        self.size, self.columns, self.origin, self.values = size, columns, origin, values

    def place(self, i, j, k):
        return [self.origin[row] + i * self.columns[0][row] + j * self.columns[1][row]
                + k * self.columns[2][row] for row in range(3)]

    def index_of(self, place):
        """As a real number along each axis; the axes are at right angles."""
        off = [p - o for p, o in zip(place, self.origin)]
        return [sum(a * b for a, b in zip(off, column)) / sum(c * c for c in column)
                for column in self.columns]

    def voxels(self):
        ni, nj, nk = self.size
        values = iter(self.values)
        return (((i, j, k), next(values)) for k in range(nk) for j in range(nj) for i in range(ni))


def turned(angle, axis):
    """The columns of a rotation."""
    x, y, z = (v / math.hypot(*axis) for v in axis)
    c, s, t = math.cos(angle), math.sin(angle), 1 - math.cos(angle)
    return [[t * x * x + c, t * x * y + s * z, t * x * z - s * y],
            [t * x * y - s * z, t * y * y + c, t * y * z + s * x],
            [t * x * z + s * y, t * y * z - s * x, t * z * z + c]]


def lying(directions):
    spacing = (0.7, 1.1, 2.5)
    columns = [[s * d for d in direction] for s, direction in zip(spacing, directions)]
    return Placed(SIZE, columns, [-101.25, 33.5, 812.0625], HU)


WAYS = {"axial": lying([[1, 0, 0], [0, 1, 0], [0, 0, 1]]),
        "coronal": lying([[1, 0, 0], [0, 0, -1], [0, 1, 0]]),
        "upside_down": lying([[-1, 0, 0], [0, 1, 0], [0, 0, -1]]),
        "left_handed": lying([[1, 0, 0], [0, 1, 0], [0, 0, -1]]),
        "oblique": lying(turned(0.7, (1, -2, 0.5))),
        "far_oblique": lying(turned(2.9, (0.3, 2, 0.5)))}


def packed(values):
    return struct.pack(f"<{len(values)}h", *values)


def write_mha(volume, file):
    lengths = [math.hypot(*column) for column in volume.columns]
    matrix = [c / length for column, length in zip(volume.columns, lengths) for c in column]
    words = [("TransformMatrix", matrix), ("Offset", volume.origin), ("ElementSpacing", lengths),
             ("DimSize", volume.size)]
    header = "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
    header += "".join(f"{name} = {' '.join(map(repr, numbers))}\n" for name, numbers in words)
    header += "ElementType = MET_SHORT\nElementDataFile = LOCAL\n"
    file.write_bytes(header.encode() + packed(volume.values))
    return file


def read_mha(file):
    header, _, voxels = file.read_bytes().partition(b"ElementDataFile = LOCAL\n")
    fields = dict(line.split(" = ") for line in header.decode().splitlines())
    numbers = {name: [float(n) for n in fields[name].split()]
               for name in ("TransformMatrix", "Offset", "ElementSpacing")}
    columns = [[s * d for d in numbers["TransformMatrix"][3 * axis:3 * axis + 3]]
               for axis, s in enumerate(numbers["ElementSpacing"])]
    size = tuple(map(int, fields["DimSize"].split()))
    return Placed(size, columns, numbers["Offset"],
                  struct.unpack(f"<{len(voxels) // 2}h", voxels))


def run(*words):
    return subprocess.run([str(word) for word in words], check=True, capture_output=True,
                          text=True).stdout


class Places:
    def assert_same_places(self, found, expected):
        """Every voxel has its value where `expected` has it, to 1/500 voxel (libnifti keeps floats);
        axes may run any way."""
        self.assertEqual(math.prod(found.size), len(expected.values))
        by_index = {index: value for index, value in expected.voxels()}
        for index, value in found.voxels():
            real = expected.index_of(found.place(*index))
            nearest = tuple(map(round, real))
            self.assertLess(max(abs(a - b) for a, b in zip(real, nearest)), 2e-3)
            self.assertEqual(value, by_index.pop(nearest))

    def read(self, file):
        """What this program makes of a volume file."""
        target = self.folder / "read.mha"
        target.unlink(missing_ok=True)
        lab("import", file, "--write", target)
        return read_mha(target)


@unittest.skipUnless(NIFTI_TOOL, "nifti_tool is not installed (nifti-bin)")
class Nifti(Places, LabTest):
    def seen_by_libnifti(self, file, matrix):
        """The image, its place taken from sto_xyz (sform) or qto_xyz (qform); NIfTI is RAS."""
        shown = run(NIFTI_TOOL, "-disp_nim", "-quiet", "-field", matrix, "-infiles", file).split()
        m = [float(number) for number in shown[-16:]]
        columns = [[-m[axis], -m[4 + axis], m[8 + axis]] for axis in range(4)]
        dim = [int(n) for n in run(NIFTI_TOOL, "-disp_hdr", "-quiet", "-field", "dim", "-infiles",
                                   file).split()[-8:]]
        voxels = self.voxels_seen_by_libnifti(file)
        return Placed(tuple(dim[1:4]), columns[:3], columns[3],
                      struct.unpack(f"<{len(voxels) // 2}h", voxels))

    def test_what_is_written_is_read_with_its_voxels_in_their_places(self):
        for name, volume in WAYS.items():
            with self.subTest(name):
                source = write_mha(volume, self.folder / f"{name}.mha")
                for ending in (".nii", ".nii.gz"):
                    file = self.folder / (name + ending)
                    lab("import", source, "--write", file)
                    run(NIFTI_TOOL, "-check_hdr", "-infiles", file)
                    for matrix in ("sto_xyz", "qto_xyz"):
                        self.assert_same_places(self.seen_by_libnifti(file, matrix), volume)

    def voxels_seen_by_libnifti(self, file):
        for part in self.folder.glob("pair.*"):
            part.unlink()
        run(NIFTI_TOOL, "-copy_im", "-infiles", file, "-prefix", self.folder / "pair.img")
        return (self.folder / "pair.img").read_bytes()

    def test_one_that_is_packed_in_pieces_is_read_whole(self):
        """9 MB: three slabs of 4 MB, 18 pieces of 512 KB."""
        noise = random.Random(1).randbytes(256 * 256 * 72)
        values = [byte % 64 - 1000 for byte in noise]
        volume = Placed((256, 256, 72), WAYS["axial"].columns, WAYS["axial"].origin, values)
        file = self.folder / "large.nii.gz"
        lab("import", write_mha(volume, self.folder / "large.mha"), "--choice", "IMPLAUSIBLE_HU=accept",
            "--write", file)
        self.assertEqual(self.voxels_seen_by_libnifti(file), packed(values))
        with gzip.open(file) as unpacked:
            self.assertEqual(unpacked.read()[352:], packed(values))
        one = zlib.decompressobj(31)  # takes one member and leaves what follows it
        self.assertEqual(len(one.decompress(file.read_bytes())), 352 + 2 * len(values))
        self.assertTrue(one.eof)
        self.assertEqual(one.unused_data, b"")

    def test_one_of_several_gzip_members_is_read_as_libnifti_reads_it(self):
        volume = WAYS["oblique"]
        plain = self.folder / "plain.nii"
        lab("import", write_mha(volume, self.folder / "a.mha"), "--write", plain)
        plain = plain.read_bytes()
        file = self.folder / "members.nii.gz"
        members = [gzip.compress(plain[a:b]) for a, b in ((0, 352), (352, 901), (901, len(plain)))]
        file.write_bytes(b"".join(members))
        self.assertEqual(self.voxels_seen_by_libnifti(file), packed(volume.values))
        self.assert_same_places(self.read(file), volume)
        spoilt = bytearray(b"".join(members))
        spoilt[len(members[0]) + len(members[1]) - 5] ^= 1  # the second member's checksum
        file.write_bytes(spoilt)
        refused = lab("import", file, "--write", self.folder / "b.mha", expect=2)
        self.assertEqual(refused["error"]["code"], "UNREADABLE")
        self.assertFalse((self.folder / "b.mha").exists())

    def test_a_qform_is_read_with_either_hand(self):
        for name, volume in WAYS.items():
            with self.subTest(name):
                lab("import", write_mha(volume, self.folder / f"{name}.mha"), "--write",
                    self.folder / f"{name}.nii")
                for hand in (1, -1):
                    file = self.folder / f"{name}{hand}.nii"
                    run(NIFTI_TOOL, "-mod_hdr", "-infiles", self.folder / f"{name}.nii", "-prefix",
                        file, "-mod_field", "sform_code", 0, "-mod_field", "pixdim",
                        f"{hand} 0.7 1.1 2.5 1 1 1 1")
                    self.assert_same_places(self.read(file), self.seen_by_libnifti(file, "qto_xyz"))


@unittest.skipUnless(UNU, "unu is not installed (teem-apps)")
class Nrrd(Places, LabTest):
    def source(self, name, volume):
        """A plain NRRD, for Teem to rewrite."""
        def vector(numbers):
            return "(" + ",".join(map(repr, numbers)) + ")"
        header = ("NRRD0004\ntype: short\ndimension: 3\nspace: left-posterior-superior\n"
                  f"sizes: {' '.join(map(str, volume.size))}\nencoding: raw\nendian: little\n"
                  f"space directions: {' '.join(map(vector, volume.columns))}\n"
                  f"space origin: {vector(volume.origin)}\n\n")
        file = self.folder / f"{name}.nrrd"
        file.write_bytes(header.encode() + packed(volume.values))
        return file

    def test_what_teem_writes_is_read_with_its_voxels_in_their_places(self):
        forms = {"raw.nrrd": ("-e", "raw", "-en", "little"),
                 "big.nrrd": ("-e", "raw", "-en", "big"),
                 "gzip.nrrd": ("-e", "gzip", "-en", "big"),
                 "beside.nhdr": ("-e", "gzip", "-en", "little")}
        for name, volume in WAYS.items():
            with self.subTest(name):
                source = self.source(name, volume)
                for form, options in forms.items():
                    file = self.folder / f"{name}-{form}"
                    run(UNU, "save", "-f", "nrrd", "-i", source, *options, "-o", file)
                    self.assert_same_places(self.read(file), volume)

    def test_other_number_types_and_orders_of_axes_are_read(self):
        for name, volume in WAYS.items():
            with self.subTest(name):
                source = self.source(name, volume)
                for kind in ("int", "float", "double"):
                    file = self.folder / f"{name}-{kind}.nrrd"
                    run(UNU, "convert", "-t", kind, "-i", source, "-o", file)
                    self.assert_same_places(self.read(file), volume)
                file = self.folder / f"{name}-turned.nrrd"
                run(UNU, "permute", "-p", 2, 0, 1, "-i", source, "-o", file)
                self.assert_same_places(self.read(file), volume)


if __name__ == "__main__":
    main()
