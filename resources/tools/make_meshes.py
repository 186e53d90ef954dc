"""Makes the meshes of the tools that ship: NAME.stl beside NAME.json, binary STL in millimetres.

usage: make_meshes.py [FOLDER]     (this folder unless named)

Each mesh lies along +x of a frame of its own, as a drawing of the maker would; the data file says
where its tip is. The same meshes come out on every machine: corners are rounded to 0.1 micrometres.
"""

import math
import pathlib
import struct
import sys

TURN = 2.0 * math.pi


def ring(x, radius, sides, y=0.0, z_radius=None, squareness=2.0):
    """A closed outline across x: a circle, an ellipse or (squareness > 2) a rounded rectangle.

    `radius` is a number, or a function of the angle.
    """
    points = []
    for side in range(sides):
        angle = TURN * side / sides
        r = radius(angle) if callable(radius) else radius
        r_z = r if z_radius is None else z_radius
        c, s = math.cos(angle), math.sin(angle)
        bulge = (abs(c) ** squareness + abs(s) ** squareness) ** (-1.0 / squareness)
        points.append((x, y + r * bulge * c, r_z * bulge * s))
    return points


def loft(start, rings, end):
    """A closed solid from the point `start` through outlines of equal length to the point `end`.

    The outlines run anticlockwise seen against x, and x grows; the triangles then face outwards.
    """
    triangles = []
    count = len(rings[0])
    for i in range(count):
        n = (i + 1) % count
        triangles.append((start, rings[0][n], rings[0][i]))
        for a, b in zip(rings, rings[1:]):
            triangles.append((a[i], a[n], b[n]))
            triangles.append((a[i], b[n], b[i]))
        triangles.append((end, rings[-1][i], rings[-1][n]))
    return triangles


def revolved(profile, sides):
    """The outlines through (x, radius)."""
    return [ring(x, radius, sides) for x, radius in profile]


def grooved(start, end, radius, depth, grooves):
    """(x, radius) of a grip with rounded grooves around it."""
    steps = 4 * grooves
    return [(start + (end - start) * i / steps,
             radius - depth * (0.5 - 0.5 * math.cos(TURN * i / 4)))
            for i in range(steps + 1)]


def needle():
    """60 mm, 1.2 mm across, ground to three facets, on a syringe; the origin is where the hub begins."""
    sides, radius, point, tip = 36, 0.6, 4.0, -60.0
    rings = []
    for part in (0.15, 0.35, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0):
        def ground(angle, inner=part * radius):
            third = angle % (TURN / 3) - TURN / 6  # from the middle of a facet
            return min(radius, inner / math.cos(third))
        rings.append(ring(tip + part * point, ground, sides))
    rings += revolved([(0.0, radius), (0.0, 1.5), (0.4, 1.8), (7.0, 2.1)], sides)
    # A barrel with rings as of a scale, two wings for the fingers, a plunger for the thumb.
    rings += revolved([(7.6, 3.4), (10.0, 6.2), (11.0, 6.6)], sides)
    rings += revolved(grooved(14.0, 44.0, 6.6, 0.25, 6) + [(52.0, 6.6)], sides)
    rings += [ring(x, wide, sides, z_radius=high) for x, wide, high in (
        (52.3, 11.5, 6.9), (54.7, 11.5, 6.9), (55.0, 6.4, 6.4))]
    rings += revolved([(55.2, 2.4), (78.0, 2.4), (78.3, 7.6), (80.6, 7.6), (81.0, 6.8)], sides)
    return loft((tip, 0.0, 0.0), rings, (81.0, 0.0, 0.0))


def blade():
    """A pointed scalpel: 16 mm of straight edge; the origin is in the middle of the handle."""
    tip, edge, half_thick, grind = -70.0, 16.0, 0.36, 0.5  # steep enough to look like an edge

    def section(along, low, high):
        bevel = low + min(grind, 0.6 * (high - low))
        x = tip + along
        return [(x, low, 0.0), (x, bevel, -half_thick), (x, high, -half_thick),
                (x, high, half_thick), (x, bevel, half_thick)]

    # The spine runs down to the tip; behind the edge the blade is a tang between the handle's cheeks.
    steel = [section(0.3, 0.0, 0.12), section(3.0, 0.0, 1.25), section(7.0, 0.0, 2.8),
             section(11.0, 0.0, 4.0), section(14.0, 0.0, 4.6), section(edge, 0.0, 4.8),
             section(edge + 0.6, 1.8, 3.8), section(edge + 9.0, 1.8, 3.8)]
    end = (tip + edge + 9.0, 2.8, 0.0)
    triangles = loft((tip, 0.0, 0.0), steel, end)

    sides, centre, rings = 40, 2.8, []

    def cheek(along, half_width, half_thickness):
        rings.append(ring(tip + along, half_width, sides, y=centre, z_radius=half_thickness,
                          squareness=4.0))

    # A flat handle, as wide as a thumb: its neck, ribs for the fingers, and a rounded end.
    cheek(edge, 1.3, 0.7)
    cheek(edge + 0.4, 1.8, 0.9)
    cheek(edge + 9.0, 2.2, 1.2)
    cheek(edge + 14.0, 3.0, 1.5)
    cheek(edge + 22.0, 5.2, 2.0)
    for x, half_width in grooved(26.0, 50.0, 5.6, 0.45, 8):
        cheek(edge + x, half_width, 2.3 - (5.6 - half_width))
    cheek(edge + 54.0, 5.4, 2.1)
    cheek(edge + 104.0, 4.4, 1.9)
    cheek(edge + 112.0, 4.2, 1.8)
    cheek(edge + 115.0, 3.2, 1.6)
    cheek(edge + 116.0, 1.6, 0.9)
    return triangles + loft((tip + edge, centre, 0.0), rings, (tip + edge + 116.0, centre, 0.0))


def burr(radius, shaft, straight=0.0):
    """A fluted ball on a shaft in a drill, each by its radius; the origin is the ball's centre.

    With a straight part the ball is drawn out to a rod with round ends, towards the shaft.
    """
    sides, flutes, turns = 64, 8, 0.11
    handle = 30.0 - radius  # 30 mm from the tip
    rings = []
    bands = 18
    for band in range(1, bands):
        polar = math.pi * band / bands
        across = radius * math.sin(polar)
        x = -radius * math.cos(polar)
        if x > 0 and across < shaft + 0.1:
            break
        x += straight if x > 0 else 0.0

        def fluted(angle, polar=polar, across=across):
            # A tooth rises slowly to the ball's own radius and falls off steeply.
            tooth = (flutes * (angle / TURN + turns * math.cos(polar))) % 1.0
            cut = 1.0 - tooth / 0.75 if tooth < 0.75 else (tooth - 0.75) / 0.25
            return across * (1.0 - 0.17 * math.sin(polar) ** 2 * cut)
        rings.append(ring(x, fluted, sides))
    rings += revolved([(radius + straight - 0.1, shaft), (handle - 3.0, shaft), (handle, shaft)], sides)
    rings += revolved([(handle, 2.1), (handle + 0.6, 2.5), (handle + 9.0, 3.0),
                       (handle + 9.6, 4.0)] + grooved(handle + 11.0, handle + 23.0, 4.4, 0.35, 4) +
                      [(handle + x, r) for x, r in (
                          (27.0, 5.0), (39.0, 7.6), (43.0, 8.0), (44.0, 7.7), (45.0, 8.0),
                          (91.0, 8.0), (94.0, 7.0), (95.0, 5.0))], sides)
    rings += revolved([(handle + 95.0, 3.2), (handle + 103.0, 2.8)], sides)
    return loft((-radius, 0.0, 0.0), rings, (handle + 103.0, 0.0, 0.0))


TOOLS = {"needle": needle, "blade": blade, "burr4": lambda: burr(2.0, 1.0),
         "burr6": lambda: burr(3.0, 1.2), "craniotome": lambda: burr(1.2, 0.6, straight=7.6)}


def stl(name, triangles):
    """Binary STL; triangles that rounding made flat stay, since they keep the solid closed."""
    out = [f"{name}, millimetres".encode().ljust(80, b"\0"), struct.pack("<I", len(triangles))]
    for triangle in triangles:
        a, b, c = [tuple(round(v, 4) + 0.0 for v in corner) for corner in triangle]
        u, v = [[q - p for p, q in zip(a, end)] for end in (b, c)]
        normal = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
        length = math.sqrt(sum(n * n for n in normal)) or 1.0
        normal = [round(n / length, 5) + 0.0 for n in normal]
        out.append(struct.pack("<12fH", *normal, *a, *b, *c, 0))
    return b"".join(out)


def main(arguments):
    folder = pathlib.Path(arguments[0]) if arguments else pathlib.Path(__file__).parent
    for name, make in TOOLS.items():
        triangles = make()
        (folder / f"{name}.stl").write_bytes(stl(name, triangles))
        print(f"{name}.stl: {len(triangles)} triangles")


if __name__ == "__main__":
    main(sys.argv[1:])
