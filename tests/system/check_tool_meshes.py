"""The tools that ship: each mesh is what its script makes, closed, outward, and where the data says.

usage: check_tool_meshes.py SOURCE_DIR
"""

import collections
import json
import math
import pathlib
import struct
import subprocess
import sys
import tempfile

REQUIRED = {"format", "version", "name", "kind", "mesh", "tip_mm", "axis", "length_mm", "points"}
MOST_TRIANGLES = 8000


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def triangles_of(data):
    count = struct.unpack_from("<I", data, 80)[0]
    assert len(data) == 84 + 50 * count, "its length does not fit its count of triangles"
    for i in range(count):
        values = struct.unpack_from("<12f", data, 84 + 50 * i)
        assert all(math.isfinite(v) for v in values), "a number is not finite"
        yield values[3:6], values[6:9], values[9:12]


def solids_of(triangles):
    """The triangles of each solid: those that hang together by their edges."""
    parent = {}

    def root(edge):
        while parent.setdefault(edge, edge) != edge:
            parent[edge] = parent[parent[edge]]
            edge = parent[edge]
        return edge

    solids = collections.defaultdict(list)
    for a, b, c in triangles:
        first = root(frozenset((a, b)))
        parent[root(frozenset((b, c)))] = first
        parent[root(frozenset((c, a)))] = first
    for triangle in triangles:
        solids[root(frozenset(triangle[:2]))].append(triangle)
    return solids.values()


def problems_of(tool, data):
    missing = REQUIRED - set(tool)
    if missing:
        return [f"lacks {sorted(missing)}"]
    found = []
    triangles = list(triangles_of(data))
    if not 0 < len(triangles) <= MOST_TRIANGLES:
        found.append(f"{len(triangles)} triangles")
    edges = collections.Counter()
    for a, b, c in triangles:
        edges.update([(a, b), (b, c), (c, a)])
    if any(count != 1 or edges[(b, a)] != 1 for (a, b), count in list(edges.items())):
        found.append("it is not closed")
    for solid in solids_of(triangles):
        if sum(dot(a, cross(b, c)) for a, b, c in solid) <= 0.0:
            found.append("a solid of it is turned inside out")

    tip, axis = tool["tip_mm"], tool["axis"]
    corners = [corner for triangle in triangles for corner in triangle]
    if min(math.dist(corner, tip) for corner in corners) > 1e-3:
        found.append("no corner lies at tip_mm")
    along = [dot([c - t for c, t in zip(corner, tip)], axis) for corner in corners]
    if min(along) < -1e-3:
        found.append("it goes beyond its tip")
    if max(along) < tool["length_mm"] + 20.0:
        found.append("it has no handle behind length_mm")
    return found


def main(arguments):
    folder = pathlib.Path(arguments[0]) / "resources" / "tools"
    failures = []
    with tempfile.TemporaryDirectory(prefix="trephine-") as made:
        subprocess.run([sys.executable, "-B", folder / "make_meshes.py", made], check=True)
        meshes = {path.name for path in folder.glob("*.stl")}
        if meshes != {path.name for path in pathlib.Path(made).iterdir()}:
            failures.append("make_meshes.py makes other files than there are")
        for path in sorted(folder.glob("*.json")):
            tool = json.loads(path.read_text(encoding="utf-8"))
            mesh = tool.get("mesh", "")
            meshes.discard(mesh)
            data = (folder / mesh).read_bytes()
            if data != (pathlib.Path(made) / mesh).read_bytes():
                failures.append(f"{mesh} is not what make_meshes.py makes: run it")
            failures += [f"{path.name}: {problem}" for problem in problems_of(tool, data)]
        failures += [f"{mesh} belongs to no data file" for mesh in sorted(meshes)]
    for failure in failures:
        print(failure)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
