#!/usr/bin/env python3
"""Remakes the example of a palm in the wind: a cage, the skin that it deforms, and springs along its edges.

Needs Python 3.9 or newer, the standard library only. It writes beside itself, the same on every run:

    palm.msh      the cage of hexahedra and prisms, Gmsh MSH 4.1, ASCII
    palm.obj      the skin: groups `trunk`, `bud`, `coconuts`, `leaves`
    palm.springs  pins, masses and springs for `octruss bake --springs`

Unit: centimetre. The palm stands on z = 0 with its foot round the origin and grows along +z.

Control points, counted from 0: RINGS rings of 4 round the trunk from the foot up, the last of them the
bud's; 8 below and 8 above round the crown; then for each frond 4 sections of 4 from the crown outwards.
"""

import math
from pathlib import Path

from make_finger import number, write_whole

FOLDER = Path(__file__).resolve().parent
HEXAHEDRON, PRISM = 5, 6  # Gmsh's numbers of element types

# Small vectors ---------------------------------------------------------------------------------


def add(*vectors):
    """The sum of vectors."""
    return tuple(map(sum, zip(*vectors)))


def scale(vector, factor):
    """A multiple of a vector."""
    return tuple(factor * c for c in vector)


def subtract(a, b):
    """The difference of two vectors."""
    return tuple(p - q for p, q in zip(a, b))


def determinant(u, v, w):
    """The volume that three vectors span, with its sign."""
    return (u[0] * (v[1] * w[2] - v[2] * w[1]) - u[1] * (v[0] * w[2] - v[2] * w[0])
            + u[2] * (v[0] * w[1] - v[1] * w[0]))


def spline(values, place):
    """The uniform cubic B-spline of a list of vectors at `place` (0 at the first, 1 at the second and so on);
    both ends are continued straight on."""
    values = [add(scale(values[0], 2.0), scale(values[1], -1.0)), *values,
              add(scale(values[-1], 2.0), scale(values[-2], -1.0))]
    i = min(max(int(place), 0), len(values) - 4)
    t = place - i
    weights = ((1.0 - t) ** 3, 3.0 * t**3 - 6.0 * t**2 + 4.0, -3.0 * t**3 + 3.0 * t**2 + 3.0 * t + 1.0, t**3)
    return add(*(scale(value, weight / 6.0) for value, weight in zip(values[i:i + 4], weights)))


# The shape of the cage -------------------------------------------------------------------------
#
# A square ring of the trunk is (centre, half side). The trunk leans at its foot and stands upright at
# the crown. Eight hexahedra make the trunk, one the middle of the crown and one the bud.

TRUNK = 8  # hexahedra from the foot to the crown
CROWN_FOOT, CROWN_HEAD, BUD_HEAD = 50.0, 54.5, 59.5  # heights
LEAN = 5.5  # how far the crown stands from the foot's axis
FRONDS = 7
SECTIONS = 4  # of a frond beyond the crown
RINGS = TRUNK + 3
FIRST_CROWN = 4 * RINGS
OUTER = 8  # corners round the crown
FIRST_FROND = FIRST_CROWN + 2 * OUTER

# The cells round the crown's middle, from the east. Each bears a frond but the last, so that four cells
# meet at every edge inside.
CROWN = (HEXAHEDRON, PRISM, HEXAHEDRON, PRISM, HEXAHEDRON, PRISM, HEXAHEDRON, PRISM)
CROWN_STEP = 48.0  # degrees from one frond to the next
CROWN_START = -45.0 + 0.5 * (360.0 - FRONDS * CROWN_STEP)  # of the first frond's first corner

# Of every frond: length, pitch at its first and last section, how it turns aside (degrees).
FROND_SHAPES = ((27.0, 30.0, -66.0, 5.0), (25.0, 42.0, -52.0, -4.0), (28.0, 26.0, -70.0, 3.0),
                (25.5, 38.0, -58.0, -6.0), (27.5, 24.0, -68.0, -3.0), (25.0, 44.0, -50.0, 6.0),
                (26.5, 33.0, -62.0, -5.0))
FROND_WIDTHS = (None, 4.3, 5.5, 5.0, 3.1)  # half widths of a frond's sections; the first is the crown's
FROND_THICKNESS = (None, 1.35, 1.25, 1.15, 0.95)  # half thicknesses


def trunk_ring(i):
    """Centre and half side of ring i of the trunk, the crown's middle and the bud."""
    if i < TRUNK:
        t = i / TRUNK
        height = CROWN_FOOT * (t - 0.12 * t * (1.0 - t))
    else:
        height = (CROWN_FOOT, CROWN_HEAD, BUD_HEAD)[i - TRUNK]
    t = min(1.0, height / CROWN_FOOT)
    side = 2.05 + 1.15 * (1.0 - t) ** 1.5 + 0.8 * max(0.0, 1.0 - 6.0 * t)
    side = {TRUNK: 2.1, TRUNK + 1: 2.1, TRUNK + 2: 1.2}.get(i, side)
    return (LEAN * t * (2.0 - t), 1.2 * math.sin(math.pi * t) * t, height), side


def crown_corner(j, above):
    """Outer corner j (0 to 7) of the crown."""
    angle = math.radians(CROWN_START + CROWN_STEP * j)
    radius, height = (5.0, CROWN_HEAD - 0.4) if above else (5.8, CROWN_FOOT + 0.7)
    middle, _ = trunk_ring(TRUNK)
    return middle[0] + radius * math.cos(angle), middle[1] + radius * math.sin(angle), height


def frond_sections(j):
    """Sections of frond j from the crown outwards: (centre, half an edge across, half an edge up)."""
    below = [crown_corner(k, False) for k in (j, j + 1)]
    above = [crown_corner(k, True) for k in (j, j + 1)]
    centre = scale(add(*below, *above), 0.25)
    across = scale(subtract(add(below[0], above[0]), add(below[1], above[1])), 0.25)
    up = scale(subtract(add(*above), add(*below)), 0.25)
    found = [(centre, across, up)]
    length, first, last, aside = FROND_SHAPES[j]
    azimuth = CROWN_START + CROWN_STEP * (j + 0.5)
    for k in range(1, SECTIONS + 1):
        part = (k - 0.5) / (SECTIONS - 0.5)
        centre = add(centre, scale(forward(azimuth + aside * part, pitch(first, last, part)), length / SECTIONS))
        part = k / SECTIONS
        turn, tilt = math.radians(azimuth + aside * part), pitch(first, last, part)
        across = scale((math.sin(turn), -math.cos(turn), 0.0), FROND_WIDTHS[k])
        up = scale(forward(azimuth + aside * part, tilt + 90.0), FROND_THICKNESS[k])
        found.append((centre, across, up))
    return found


def pitch(first, last, part):
    """The pitch of a frond at `part` of its length, degrees."""
    return first + (last - first) * part**1.15


def forward(azimuth, tilt):
    """The direction of an azimuth and a pitch, degrees."""
    azimuth, tilt = math.radians(azimuth), math.radians(tilt)
    return math.cos(azimuth) * math.cos(tilt), math.sin(azimuth) * math.cos(tilt), math.sin(tilt)


# The cage --------------------------------------------------------------------------------------


def make_cage():
    """Control points, and lists of corners (from 0) by Gmsh's type."""
    points = []
    for i in range(RINGS):
        (x, y, z), side = trunk_ring(i)
        # Corners south east, north east, north west, south west.
        points += [(x + side * u, y + side * v, z) for u, v in ((1, -1), (1, 1), (-1, 1), (-1, -1))]
    for above in (False, True):
        points += [crown_corner(j, above) for j in range(OUTER)]
    for j in range(FRONDS):
        for centre, across, up in frond_sections(j)[1:]:
            points += [add(centre, scale(across, u), scale(up, v)) for u, v in ((1, -1), (-1, -1), (-1, 1), (1, 1))]
    points = [tuple(round(c, 4) + 0.0 for c in point) for point in points]

    cells = {HEXAHEDRON: [], PRISM: []}
    for i in range(RINGS - 1):
        cells[HEXAHEDRON].append([4 * i + k for k in range(8)])
    corner = 0
    for j, shape in enumerate(CROWN):
        outer = [FIRST_CROWN + j, FIRST_CROWN + (j + 1) % OUTER]
        if shape == HEXAHEDRON:
            inner = [4 * TRUNK + (corner + 1) % 4, 4 * TRUNK + corner]
            corner += 1
        else:
            inner = [4 * TRUNK + corner % 4]
        cell = [*outer, *inner, *(k + OUTER for k in outer), *(k + 4 for k in inner)]
        cells[shape].append(cell)
        if j == FRONDS:
            continue
        # Sections as points go: left below, right below, right above, left above, seen from outside.
        section = [outer[0], outer[1], outer[1] + OUTER, outer[0] + OUTER]
        for k in range(SECTIONS):
            first = FIRST_FROND + 4 * (SECTIONS * j + k)
            following = list(range(first, first + 4))
            cells[HEXAHEDRON].append(section + following)
            section = following
    return points, cells


def faces_of(cell):
    """The faces of a hexahedron or a prism, counter-clockwise from outside."""
    half = len(cell) // 2
    sides = [[cell[k], cell[(k + 1) % half], cell[half + (k + 1) % half], cell[half + k]] for k in range(half)]
    return [cell[:half][::-1], cell[half:], *sides]


def check(points, cells):
    """Stops unless the cage is one solid of cells that are nowhere inside out at their corners, joined
    whole face to whole face, with a closed boundary that is a manifold."""
    if len(points) > 200:
        raise SystemExit("the cage has more than 200 control points")
    owners = {}
    every = [cell for kind in cells.values() for cell in kind]
    for number_of, cell in enumerate(every):
        half = len(cell) // 2
        for k in range(half):
            for a, b, c, d in ((cell[k], cell[(k + 1) % half], cell[k - 1], cell[half + k]),
                               (cell[half + k], cell[half + k - 1 if k else 2 * half - 1],
                                cell[half + (k + 1) % half], cell[k])):
                if determinant(*(subtract(points[q], points[a]) for q in (b, c, d))) <= 0.0:
                    raise SystemExit(f"cell {cell} is inside out at control point {a}")
        for face in faces_of(cell):
            owners.setdefault(frozenset(face), []).append((number_of, face))
    if max(map(len, owners.values())) > 2:
        raise SystemExit("a face has more than two cells")
    if set().union(*every) != set(range(len(points))):
        raise SystemExit("a control point has no cell")

    # Connected through faces.
    reached, front = {0}, [0]
    while front:
        here = front.pop()
        for pair in owners.values():
            names = [name for name, _ in pair]
            if here in names:
                front += [name for name in names if name not in reached]
                reached.update(names)
    if len(reached) != len(every):
        raise SystemExit("the cage falls into parts")

    # Every boundary edge once in each direction; the boundary faces round a vertex make one ring.
    boundary = [pair[0][1] for pair in owners.values() if len(pair) == 1]
    directed = [(face[k - 1], face[k]) for face in boundary for k in range(len(face))]
    if len(set(directed)) != len(directed) or {(b, a) for a, b in directed} != set(directed):
        raise SystemExit("an edge of the boundary has not two faces")
    after = {}
    for face in boundary:
        for k, vertex in enumerate(face):
            after.setdefault(vertex, {})[face[k - 1]] = face[(k + 1) % len(face)]
    for vertex, ring in after.items():
        start = here = next(iter(ring))
        for step in range(len(ring)):
            here = ring[here]
            if here == start and step + 1 < len(ring):
                raise SystemExit(f"the boundary touches itself at control point {vertex}")
    edges = {frozenset(edge) for edge in directed}
    characteristic = len(after) - len(edges) + len(boundary)
    if characteristic != 2:
        raise SystemExit("the boundary is not a sphere")


def write_cage(points, cells, path):
    """Writes Gmsh's format 4.1: the foot's rim is a crease with its corners, the volume is `palm`."""
    foot = [1, 2, 3, 4]
    low, high = ([number(pick(p[k] for p in points)) for k in range(3)] for pick in (min, max))
    foot_low, foot_high = ([number(pick(p[k] for p in points[:4])) for k in range(3)] for pick in (min, max))
    lines = ["$MeshFormat", "4.1 0 8", "$EndMeshFormat", "$PhysicalNames", "3", '0 3 "corner base"',
             '1 2 "crease base"', '3 1 "palm"', "$EndPhysicalNames", "$Entities", "1 1 0 1",
             f"1 {' '.join(number(c) for c in points[0])} 1 3",
             f"1 {' '.join(foot_low + foot_high)} 1 2 0", f"1 {' '.join(low + high)} 1 1 0", "$EndEntities",
             "$Nodes", f"1 {len(points)} 1 {len(points)}", f"3 1 0 {len(points)}"]
    lines += [str(k + 1) for k in range(len(points))]
    lines += [" ".join(number(c) for c in point) for point in points]
    blocks = [(0, 15, [[k] for k in foot]), (1, 1, [[k, k % 4 + 1] for k in foot])]
    blocks += [(3, kind, [[c + 1 for c in cell] for cell in found]) for kind, found in cells.items()]
    count = sum(len(block) for _, _, block in blocks)
    lines += ["$EndNodes", "$Elements", f"{len(blocks)} {count} 1 {count}"]
    tag = 0
    for dimension, kind, block in blocks:
        lines.append(f"{dimension} 1 {kind} {len(block)}")
        for corners in block:
            tag += 1
            lines.append(" ".join(map(str, [tag, *corners])))
    lines.append("$EndElements")
    write_whole(path, lines)


# The skin --------------------------------------------------------------------------------------
#
# The smooth boundary of the cage follows about the cubic B-spline of its rings and sections, so the skin
# lies along the same splines, made narrower.

COLUMNS = 14  # vertices round the trunk
SCARS = 18  # rings that fallen leaves have left on the trunk
TEETH = 14  # of either edge of a leaf
NUTS = 4


class Skin:
    """Vertices, and faces by group, counter-clockwise from outside."""

    def __init__(self):
        self.positions = []
        self.groups = {"trunk": [], "bud": [], "coconuts": [], "leaves": []}

    def add_row(self, row):
        """Adds the vertices of a row and returns their indices."""
        self.positions.extend(row)
        return list(range(len(self.positions) - len(row), len(self.positions)))

    def join(self, group, lower, upper):
        """Faces between two rows, seen from outside counter-clockwise to the right; a row of one vertex
        is an end."""
        size = max(len(lower), len(upper))
        for j in range(size):
            k = (j + 1) % size
            face = [lower[j % len(lower)], lower[k % len(lower)], upper[k % len(upper)], upper[j % len(upper)]]
            self.groups[group].append(list(dict.fromkeys(face)))


def circle(centre, radius, size, turn=0.0):
    """A level circle of vertices."""
    angles = [2.0 * math.pi * (j + turn) / size for j in range(size)]
    return [(centre[0] + radius * math.cos(a), centre[1] + radius * math.sin(a), centre[2]) for a in angles]


def add_trunk(skin):
    """The trunk with its rings, the heart of the crown, and the bud."""
    rings = [(*centre, side) for centre, side in map(trunk_ring, range(RINGS))]
    (x, y, _), side = trunk_ring(0)
    bottom = 0.06
    rows = [("trunk", [(x, y, bottom)]), ("trunk", circle((x, y, bottom), 0.61 * side, COLUMNS))]
    for scar in range(SCARS):
        for part, share in ((0.12, 0.60), (0.86, 0.70)):
            place = TRUNK * (scar + part) / SCARS
            x, y, z, side = spline(rings, place)
            rows.append(("trunk", circle((x, y, max(z, 0.3)), share * side, COLUMNS)))
    for place, radius in ((8.05, 1.5), (8.3, 2.1), (8.65, 2.1), (8.9, 1.5), (9.1, 0.9), (9.4, 0.7), (9.65, 0.5),
                          (9.82, 0.25)):
        x, y, z, _ = spline(rings, place)
        rows.append(("bud", circle((x, y, z), radius, COLUMNS)))
    x, y, z, _ = spline(rings, 9.9)
    rows.append(("bud", [(x, y, z)]))
    indexed = [skin.add_row(row) for _, row in rows]
    for i in range(len(rows) - 1):
        skin.join(rows[i + 1][0], indexed[i], indexed[i + 1])


def add_nuts(skin):
    """Coconuts below the crown, between the leaves."""
    middle, _ = trunk_ring(TRUNK)
    for j in range(NUTS):
        angle = math.radians(CROWN_START + CROWN_STEP * (1.0, 2.9, 4.1, 6.0)[j])
        centre = add(middle, (2.75 * math.cos(angle), 2.75 * math.sin(angle), 1.35))
        radius = 1.1
        rows = [[add(centre, (0.0, 0.0, -radius))]]
        for latitude in (-50.0, -10.0, 30.0, 62.0):
            rise, reach = math.sin(math.radians(latitude)), math.cos(math.radians(latitude))
            rows.append(circle(add(centre, (0.0, 0.0, radius * rise)), radius * reach, 8))
        rows.append([add(centre, (0.0, 0.0, radius))])
        indexed = [skin.add_row(row) for row in rows]
        for lower, upper in zip(indexed, indexed[1:]):
            skin.join("coconuts", lower, upper)


def leaf_rows():
    """Rows along a leaf: (place in sections from the crown, half width as part of the cage's, where the edge
    lies ahead of the spine). A tooth is a notch and a tip that leans outwards."""
    rows = [(-0.45, 0.16, 0.0), (-0.05, 0.13, 0.0)]
    first, last = 0.2, 3.68
    for tooth in range(TEETH):
        t = tooth / (TEETH - 1)
        place = first + (last - first) * tooth / TEETH
        step = (last - first) / TEETH
        reach = 0.76 * min(1.0, 0.5 + 2.5 * t) * (1.0 - 0.36 * t**3)
        rows.append((place, 0.34 * reach, 0.0))
        rows.append((place + 0.5 * step, reach, 0.24))
    rows.append((last, 0.16, 0.0))
    return rows


def add_leaf(skin, j):
    """One leaf: a closed thin blade that is roofed along its spine."""
    sections = [(*centre, *across, *up) for centre, across, up in frond_sections(j)]

    def place_at(place, u, v):
        found = spline(sections, place)
        return add(found[:3], scale(found[3:6], u), scale(found[6:], v))

    indexed = []
    for place, reach, ahead in leaf_rows():
        stem = max(0.0, min(1.0, (0.5 - place) / 0.5))  # thicker at its root
        top, bottom = 0.20 + 0.10 * stem, 0.04 - 0.24 * stem
        edge = -0.16 * (1.0 - stem) * min(1.0, reach / 0.5)
        middle = 0.5 * (top + edge)
        # Counter-clockwise as seen from the tip toward the crown, where `across` points to the left.
        row = [place_at(place, 0.0, bottom), place_at(place + ahead, -reach, edge),
               place_at(place + 0.4 * ahead, -0.5 * reach, middle), place_at(place, 0.0, top),
               place_at(place + 0.4 * ahead, 0.5 * reach, middle), place_at(place + ahead, reach, edge)]
        indexed.append(skin.add_row(row))
    root = skin.add_row([place_at(-0.55, 0.0, 0.1)])
    tip = skin.add_row([place_at(3.82, 0.0, 0.06)])
    for lower, upper in zip([root, *indexed], [*indexed, tip]):
        skin.join("leaves", lower, upper)


def make_skin():
    """The whole skin."""
    skin = Skin()
    add_trunk(skin)
    add_nuts(skin)
    for j in range(FRONDS):
        add_leaf(skin, j)
    return skin


def enclosed(skin, group):
    """Six times the volume that a group's faces enclose; positive if they face outwards."""
    total = 0.0
    for face in skin.groups[group]:
        a, *rest = (skin.positions[v] for v in face)
        total += sum(determinant(a, b, c) for b, c in zip(rest, rest[1:]))
    return total


def write_skin(skin, path):
    """Writes an OBJ file: positions with at most four decimals, faces by group."""
    lines = ["# Skin of a palm, unit centimetre. Written by make_palm.py.", "# Licence: MIT OR Apache-2.0", "o palm"]
    lines += ["v " + " ".join(number(c) for c in p) for p in skin.positions]
    for name, faces in skin.groups.items():
        lines += ["g " + name, "s 1"]
        lines += ["f " + " ".join(str(v + 1) for v in face) for face in faces]
    write_whole(path, lines)


# The springs -----------------------------------------------------------------------------------

SECTION_MASSES = (1.0, 0.8, 0.6, 0.4)
FROND_MASSES = (1.0, 0.85, 1.15, 0.9, 1.1, 0.8, 1.05)  # so that they do not sway in step


def write_springs(path):
    """Writes pins, masses and stiffness."""
    lines = ["# Springs of a palm in the wind. Written by make_palm.py.",
             "# A push of the wind belongs on every control point; heavy ones take less of it.",
             "rate 50", "substeps 2", "drag 0.008", "damping 0.012", "edges 0.3 0.02",
             "# Springs between heavy points are stiff: trunk, crown and bud, then frond by frond, lighter outwards.",
             f"mass 0-{4 * TRUNK + 3} 50", f"mass {4 * TRUNK + 4}-{FIRST_FROND - 1} 8"]
    for j, factor in enumerate(FROND_MASSES):
        for k, mass in enumerate(SECTION_MASSES):
            first = FIRST_FROND + 4 * (SECTIONS * j + k)
            lines.append(f"mass {first}-{first + 3} {number(mass * factor)}")
    lines += ["# The foot.", "pin 0-3"]
    write_whole(path, lines)


# -----------------------------------------------------------------------------------------------


def main():
    """Writes all files and says what they hold."""
    points, cells = make_cage()
    check(points, cells)
    skin = make_skin()
    for group in skin.groups:
        # The trunk's and the bud's faces enclose a volume together.
        if group not in ("trunk", "bud") and enclosed(skin, group) <= 0.0:
            raise SystemExit(f"the faces of {group} face inwards")
    if enclosed(skin, "trunk") + enclosed(skin, "bud") <= 0.0:
        raise SystemExit("the faces of the trunk face inwards")
    write_cage(points, cells, FOLDER / "palm.msh")
    write_skin(skin, FOLDER / "palm.obj")
    write_springs(FOLDER / "palm.springs")
    faces = sum(map(len, skin.groups.values()))
    print(f"cage: {len(points)} control points, {len(cells[HEXAHEDRON])} hexahedra, {len(cells[PRISM])} prisms")
    print(f"skin: {len(skin.positions)} vertices, {faces} faces")


if __name__ == "__main__":
    main()
