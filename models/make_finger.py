#!/usr/bin/env python3
"""Remakes the example of this folder: the cage, the skin and the motion of a soft gripper finger.

Needs Python 3.9 or newer and Gmsh 4 (`pip install gmsh`). It writes beside itself:

    finger.msh         the cage of tetrahedra from finger.geo, Gmsh MSH 4.1, ASCII
    finger-22.msh      the same cage, Gmsh MSH 2.2, ASCII
    finger-mixed.msh   the same control points with hexahedra, prisms and tetrahedra, Gmsh MSH 4.1, ASCII
    finger-mixed-22.msh  the same cage, Gmsh MSH 2.2, ASCII
    finger.obj         the skin, quadrilaterals with texture coordinates and groups
    finger-motion.csv  all control points for each frame of a motion

Unit: millimetre. The finger stands on its base and points along +z; +y is the gripping side, -y
the back with the bellows.
"""

import math
import os
from pathlib import Path

FOLDER = Path(__file__).resolve().parent


# The skin --------------------------------------------------------------------------------------
#
# The skin is a stack of closed rows of ROW vertices. Row by row the section is a rounded rectangle;
# at both ends concentric square loops of 8, 16, .. vertices fill the last row, so that every face
# is a quadrilateral.

SIDE = 12  # vertices along one side of a section, from corner to corner
ROW = 4 * SIDE  # vertices in a row
LOOPS = SIDE // 2  # loops that fill an end

FLANGE = (13.0, 11.0, 4.0)  # half width, half depth, corner radius of the mounting flange
FLANGE_TOP = 7.0  # height of the flange
BODY_FOOT = 9.0  # where the bellows begin
BODY_HEAD = 89.0  # where they end and the fingertip begins
TIP_TOP = 100.0  # height of the finger
FOLDS = 8  # slots of the bellows

# Rows of one fold, as parts of its length from its slot: dense in the slot and at its shoulders.
FOLD_ROWS = (-0.5, -0.4, -0.25, -0.16, -0.1, -0.05, 0.0, 0.05, 0.1, 0.16, 0.25, 0.4)

TIP_SCALES = (1.0, 0.995, 0.975, 0.94, 0.885, 0.81)  # of the fingertip's rows; loops fill the last


def smooth_step(low, high, value):
    """0 below `low`, 1 above `high`, and a curve without kinks between."""
    t = min(1.0, max(0.0, (value - low) / (high - low)))
    return t * t * t * (t * (6.0 * t - 15.0) + 10.0)


def rounded_rectangle(fraction, half_x, half_y, radius):
    """The point at `fraction` (0 to 1) round a rounded rectangle, counter-clockwise from the corner
    (-x, -y). A quarter of the way belongs to each side, half of that to its two half corners."""
    side, t = divmod(fraction * 4.0, 1.0)
    side = int(side) % 4
    along, across = (half_x, half_y) if side % 2 == 0 else (half_y, half_x)
    if t < 0.25:
        angle = math.radians(45.0 - 180.0 * t)
        u, v = -along + radius - radius * math.sin(angle), -across + radius - radius * math.cos(angle)
    elif t <= 0.75:
        u, v = (along - radius) * (4.0 * t - 2.0), -across
    else:
        angle = math.radians(180.0 * (t - 0.75))
        u, v = along - radius + radius * math.sin(angle), -across + radius - radius * math.cos(angle)
    return ((u, v), (-v, u), (-u, -v), (v, -u))[side]


def half_section(z):
    """Half width, half depth and corner radius of the body at height `z`."""
    t = z / TIP_TOP
    return 12.2 - 4.4 * t, 10.4 - 3.4 * t, 4.2 - 0.9 * t


def section_point(fraction, z, slot, groove):
    """A point of the body. `slot` (0 to 1) is how deep the bellows' slot cuts into back and sides
    here, `groove` (0 to 1) how deep the shallow groove of the gripping face is."""
    half_x, half_y, radius = half_section(z)
    x, y = rounded_rectangle(fraction, half_x, half_y, radius)
    hinge = 0.3 * half_y  # the gripping side of this line is not folded
    if y < hinge:
        x *= 1.0 - 0.17 * slot * smooth_step(0.0, 0.7 * half_y, hinge - y)
        y = hinge + (y - hinge) * (1.0 - 0.42 * slot)
    else:
        y -= 0.45 * groove * smooth_step(0.55 * half_y, 0.98 * half_y, y)
    return x, y, z


def fold_profile(part):
    """Slot and groove at `part` (-0.5 to 0.5) of a fold: grooves lie at its slot and at its ends."""
    distance = abs(part)
    slot = 1.0 - smooth_step(0.02, 0.2, distance)
    groove = 1.0 - smooth_step(0.0, 0.09, min(distance, 0.5 - distance))
    return slot, groove


def flange_section(inset):
    """The flange's outline, made smaller by `inset` on all sides."""
    return tuple(measure - inset for measure in FLANGE)


FOOT_INSET = 0.7  # of the flange's lowest row


def base_rows():
    """The flange: a slab with rounded edges, wider than the body."""
    rows = []
    for z, inset in ((0.0, FOOT_INSET), (0.2, 0.25), (0.7, 0.0), (3.5, 0.0), (6.3, 0.0), (6.8, 0.25)):
        rows.append([(*rounded_rectangle(j / ROW, *flange_section(inset)), z) for j in range(ROW)])
    half_x, half_y, radius = half_section(FLANGE_TOP)
    for z, grow in ((FLANGE_TOP, 0.3), (FLANGE_TOP + 0.4, 0.0)):
        rows.append([(*rounded_rectangle(j / ROW, half_x + grow, half_y + grow, radius + grow), z)
                     for j in range(ROW)])
    return rows


def body_rows():
    """The bellows: ribs on the back, a lightly grooved gripping face."""
    rows = []
    pitch = (BODY_HEAD - BODY_FOOT) / FOLDS
    for fold in range(FOLDS):
        for part in FOLD_ROWS:
            slot, groove = fold_profile(part)
            z = BODY_FOOT + (fold + 0.5 + part) * pitch
            rows.append([section_point(j / ROW, z, slot, groove) for j in range(ROW)])
    return rows


def tip_point(fraction, scale):
    """A point of the fingertip: the section shrunk by `scale` (1 to 0), raised to a dome whose top
    lies nearer to the gripping side than the middle."""
    z = BODY_HEAD + (TIP_TOP - BODY_HEAD) * (1.0 - scale**2.6) ** (1.0 / 2.6)
    half_x, half_y, radius = half_section(z)
    x, y = rounded_rectangle(fraction, half_x, half_y, radius + (half_y - radius) * 0.6 * (1.0 - scale))
    return x * scale, y * scale + 0.3 * half_y * (1.0 - scale), z


def foot_point(fraction, part):
    """A point of the flat underside, `part` (0 to 1) of the way from its centre to its lowest row."""
    x, y = rounded_rectangle(fraction, *flange_section(FOOT_INSET))
    return x * part, y * part, 0.0


def end_loops(place):
    """Loops from the centre outwards: `place(fraction, part)` for loop k of 8 k vertices, with part
    k / LOOPS; the centre is a loop of one vertex. The outermost loop is a row and is left out."""
    loops = [[place(0.0, 0.0)]]
    for k in range(1, LOOPS):
        loops.append([place(j / (8 * k), k / LOOPS) for j in range(8 * k)])
    return loops


class Skin:
    """Vertices, texture coordinates and faces by group, as an OBJ file wants them."""

    def __init__(self):
        self.positions = []
        self.textures = []
        self.groups = {"base": [], "body": [], "tip": []}

    def add_row(self, row):
        """Adds the vertices of a row and returns their indices."""
        first = len(self.positions)
        self.positions.extend(row)
        return list(range(first, len(self.positions)))

    def add_texture(self, u, v):
        """Adds a texture coordinate and returns its index."""
        self.textures.append((u, v))
        return len(self.textures) - 1

    def join_rows(self, group, lower, upper):
        """Quadrilaterals between two rows, each a pair (vertex indices, texture indices); a row has
        one texture coordinate more than vertices, because the seam has two."""
        for j in range(ROW):
            k = (j + 1) % ROW
            corners = ((lower, j, j), (lower, k, j + 1), (upper, k, j + 1), (upper, j, j))
            self.groups[group].append([(row[0][v], row[1][t]) for row, v, t in corners])

    def fill_end(self, group, loops, rim, texture_middle, upward):
        """Quadrilaterals of a square grid whose loops round the centre are `loops` and, outermost, the
        row of vertex indices `rim`. The grid lies in texture space round u = `texture_middle`."""
        vertex = {}
        texture = {}
        for k in range(LOOPS + 1):
            indices = rim if k == LOOPS else self.add_row(loops[k])
            for cell, index in zip(loop_cells(k), indices):
                vertex[cell] = index
                u = texture_middle + 0.12 * cell[0] / LOOPS
                texture[cell] = self.add_texture(u, 0.87 + 0.1 * cell[1] / LOOPS)
        for y in range(-LOOPS, LOOPS):
            for x in range(-LOOPS, LOOPS):
                face = [(x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)]
                if not upward:
                    face.reverse()
                self.groups[group].append([(vertex[cell], texture[cell]) for cell in face])


def loop_cells(k):
    """Grid places (x, y) of loop k round the centre, counter-clockwise from (-k, -k)."""
    if k == 0:
        return [(0, 0)]
    bottom = [(-k + j, -k) for j in range(2 * k)]
    right = [(k, -k + j) for j in range(2 * k)]
    return bottom + right + [(-x, -y) for x, y in bottom] + [(-x, -y) for x, y in right]


def make_skin():
    """The whole skin: base loops, rows from base to tip, tip loops."""
    skin = Skin()
    base, body = base_rows(), body_rows()
    tip = [[tip_point(j / ROW, scale) for j in range(ROW)] for scale in TIP_SCALES]
    rows = base + body + tip
    indexed = []
    for row in rows:
        vertices = skin.add_row(row)
        height = 0.02 + 0.7 * row[0][2] / TIP_TOP
        indexed.append((vertices, [skin.add_texture(0.98 * j / ROW + 0.01, height) for j in range(ROW + 1)]))
    for i in range(len(rows) - 1):
        group = "base" if i < len(base) else "body" if i < len(base) + len(body) else "tip"
        skin.join_rows(group, indexed[i], indexed[i + 1])
    foot = end_loops(foot_point)
    dome = end_loops(lambda fraction, part: tip_point(fraction, TIP_SCALES[-1] * part))
    skin.fill_end("base", foot, indexed[0][0], 0.25, upward=False)
    skin.fill_end("tip", dome, indexed[-1][0], 0.75, upward=True)
    return skin


def write_skin(skin, path):
    """Writes an OBJ file: positions with at most four decimals, faces by group."""
    lines = ["# Skin of a soft gripper finger, unit millimetre. Written by make_finger.py.",
             "# Licence: MIT OR Apache-2.0", "o finger"]
    lines += ["v " + " ".join(number(c) for c in p) for p in skin.positions]
    lines += ["vt " + " ".join(number(c) for c in t) for t in skin.textures]
    for name, faces in skin.groups.items():
        lines += ["g " + name, "s 1"]
        lines += ["f " + " ".join(f"{v + 1}/{t + 1}" for v, t in face) for face in faces]
    write_whole(path, lines)


def write_whole(path, lines):
    """Writes a text file so that `path` never holds a part of it."""
    part = path.with_name(path.name + ".part")
    with open(part, "w", encoding="ascii", newline="\n") as file:
        file.write("\n".join(lines) + "\n")
    os.replace(part, path)


def number(value):
    """A number with at most four decimals, without trailing zeros or a negative zero."""
    text = f"{value:.4f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


# The cage --------------------------------------------------------------------------------------


def make_cage():
    """Meshes finger.geo and writes all four files; returns control points, tetrahedra and the mixed cage's
    cells by Gmsh's type (from 0)."""
    try:
        import gmsh
    except ImportError:
        raise SystemExit("the cage needs Gmsh's Python package: pip install gmsh") from None
    gmsh.initialize()
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.option.setNumber("General.NumThreads", 1)
        gmsh.option.setNumber("Mesh.RandomSeed", 1)
        gmsh.option.setNumber("Mesh.Algorithm3D", 10)  # HXT
        gmsh.option.setNumber("Mesh.Binary", 0)
        gmsh.open(str(FOLDER / "finger.geo"))
        gmsh.model.mesh.generate(3)
        points, cells = read_cage(gmsh.model.mesh)
        write_versions(gmsh, "finger")
        wedges = read_wedges(gmsh.model.mesh)
        mixed = mix(wedges)
        add_mixed_model(gmsh, points, mixed)
        write_versions(gmsh, "finger-mixed")
    finally:
        gmsh.finalize()
    return points, cells, mixed


def write_versions(gmsh, name):
    """Writes Gmsh's current model in both versions of its format."""
    for version, suffix in ((4.1, ""), (2.2, "-22")):
        gmsh.option.setNumber("Mesh.MshFileVersion", version)
        path = FOLDER / f"{name}{suffix}.msh"
        part = FOLDER / f"part-of-{path.name}"
        gmsh.write(str(part))
        os.replace(part, path)


def read_cage(mesh):
    """Control points and tetrahedra (from 0) of Gmsh's mesh, after a check that it is the expected one:
    everything else here counts on the numbering that finger.geo describes."""
    tags, flat, _ = mesh.getNodes()
    place = {int(tag): tuple(float(c) for c in flat[3 * i:3 * i + 3]) for i, tag in enumerate(tags)}
    points = [place[tag] for tag in sorted(place)]
    _, corners = mesh.getElementsByType(4)
    cells = [tuple(int(tag) - 1 for tag in corners[i:i + 4]) for i in range(0, len(corners), 4)]
    if sorted(place) != list(range(1, 73)) or len(cells) != 168:
        raise SystemExit(f"finger.geo gave {len(points)} control points and {len(cells)} tetrahedra "
                         "instead of 72 and 168: this Gmsh meshes it in another way, use 4.15")
    if min(signed_volume(points, cell) for cell in cells) <= 0.0:
        raise SystemExit("finger.geo gave a tetrahedron of negative orientation")
    return points, cells


def read_wedges(mesh):
    """The tetrahedra (from 0) of the wedge j (1 to 8) above ring i, by (i, j)."""
    wedges = {}
    for i in range(RINGS - 1):
        for j in range(1, 9):
            _, _, corners = mesh.getElements(3, 10 * i + j)
            flat = [int(tag) - 1 for tag in corners[0]]
            wedges[i, j] = [tuple(flat[k:k + 4]) for k in range(0, len(flat), 4)]
    return wedges


# The mixed cage --------------------------------------------------------------------------------
#
# The same control points. A quarter of a layer between two rings is one hexahedron, or two prisms (its
# wedges), or the six tetrahedra that Gmsh makes of these. Row by row from the base, for the quarters
# (-x, -y), (+x, -y), (+x, +y), (-x, +y): the body is regular, the bellows' side is of prisms, the tip is
# filled with tetrahedra, and all pairs of shapes touch.

RINGS = 8
LAYERS = ("hhhh", "hhhh", "pphh", "pphh", "ppph", "pptt", "tttt")
HEXAHEDRON, PRISM, TETRAHEDRON = 5, 6, 4  # Gmsh's numbers of element types


def mix(wedges):
    """The cells of the mixed cage: lists of corners (from 0) by Gmsh's type."""
    cells = {HEXAHEDRON: [], PRISM: [], TETRAHEDRON: []}
    for i, layer in enumerate(LAYERS):
        below, above = 9 * i, 9 * i + 9
        for quarter, shape in enumerate(layer):
            corner = 2 * quarter
            before, after = (corner - 1) % 8, corner + 1
            if shape == "h":
                ring = (8, before, corner, after)
                cells[HEXAHEDRON].append([below + j for j in ring] + [above + j for j in ring])
            for j in (before, corner):
                triangle = (8, j, (j + 1) % 8)
                if shape == "p":
                    cells[PRISM].append([below + k for k in triangle] + [above + k for k in triangle])
                elif shape == "t":
                    cells[TETRAHEDRON] += wedges[i, j + 1]
    return cells


def add_mixed_model(gmsh, points, cells):
    """Makes a second model of Gmsh's, of discrete entities: node k + 1 is control point k again, and the
    groups have the names that finger.geo gives."""
    gmsh.model.add("finger-mixed")
    mesh = gmsh.model.mesh
    volume = gmsh.model.addDiscreteEntity(3)
    tags = list(range(1, len(points) + 1))
    mesh.addNodes(3, volume, tags, [coordinate for point in points for coordinate in point])
    for kind, corners in cells.items():
        mesh.addElementsByType(volume, kind, [], [c + 1 for cell in corners for c in cell])
    gmsh.model.addPhysicalGroup(3, [volume], 1, "finger")
    for number, name, first in ((2, "crease base", 1), (3, "crease tip", 9 * RINGS - 8)):
        curve = gmsh.model.addDiscreteEntity(1)
        sides = [first + (j + k) % 8 for j in range(8) for k in (0, 1)]
        mesh.addElementsByType(curve, 1, [], sides)
        gmsh.model.addPhysicalGroup(1, [curve], number, name)
    corners = gmsh.model.addDiscreteEntity(0)
    mesh.addElementsByType(corners, 15, [], [1, 3, 5, 7])
    gmsh.model.addPhysicalGroup(0, [corners], 4, "corner base")


def corner_volumes(points, kind, cell):
    """Six times the volumes of the tetrahedra at the corners of a cell, of either of both turns: all are
    positive if the cell is not inside out anywhere near a corner."""
    if kind == TETRAHEDRON:
        return [signed_volume(points, cell)]
    half = len(cell) // 2
    found = []
    for j in range(half):
        here, after, before = cell[j], cell[(j + 1) % half], cell[j - 1]
        found.append(signed_volume(points, (here, after, before, cell[half + j])))
        here, after, before = (cell[half + k] for k in (j, (j + 1) % half, (j - 1) % half))
        found.append(signed_volume(points, (here, before, after, cell[j])))
    return found


def signed_volume(points, cell):
    """Six times the volume of a tetrahedron, positive for positive orientation."""
    o, a, b, c = (points[i] for i in cell)
    u, v, w = ([q[k] - o[k] for k in range(3)] for q in (a, b, c))
    return (u[0] * (v[1] * w[2] - v[2] * w[1]) - u[1] * (v[0] * w[2] - v[2] * w[0])
            + u[2] * (v[0] * w[1] - v[1] * w[0]))


# The motion ------------------------------------------------------------------------------------
#
# A place on the axis turns by an angle that grows evenly from the first ring to the tip, so the
# gripping face, which keeps its length, becomes an arc of a circle. Before that, sections twist
# round the axis and are squeezed. All amounts vanish at the first and last frame.

FRAMES = 32
BEND_DEGREES = 70.0
TWIST_DEGREES = 16.0
SQUEEZE = 0.14
BEND_FOOT = 4.0  # nothing below this height moves
BEND_HEAD = 101.5  # the cage's last ring: here all amounts are reached
GRIPPING_FACE = 8.0  # distance of the arc's layer from the axis, the mean of the gripping face


def amounts(frame):
    """Bend, twist and squeeze (parts of 1, twist with a sign) at a frame."""
    t = frame / (FRAMES - 1)
    bend = smooth_step(0.0, 0.45, t) - smooth_step(0.62, 1.0, t)
    twist = (smooth_step(0.12, 0.4, t) - 2.0 * smooth_step(0.42, 0.72, t)
             + smooth_step(0.74, 1.0, t))
    squeeze = smooth_step(0.3, 0.52, t) - smooth_step(0.55, 0.8, t)
    return bend, twist, squeeze


def moved(point, bend, twist, squeeze):
    """Where a control point goes."""
    x, y, z = point
    part = min(1.0, max(0.0, (z - BEND_FOOT) / (BEND_HEAD - BEND_FOOT)))
    if part == 0.0:
        return point
    bulge = squeeze * SQUEEZE * math.sin(math.pi * part) ** 2
    x, y = x * (1.0 - bulge), y * (1.0 + 0.5 * bulge)
    turn = math.radians(TWIST_DEGREES) * twist * part * part
    x, y = x * math.cos(turn) - y * math.sin(turn), x * math.sin(turn) + y * math.cos(turn)
    angle = math.radians(BEND_DEGREES) * bend * part
    length = z - BEND_FOOT
    # sin(a)/a and (1 - cos(a))/a, good for any small angle.
    forward = math.sin(angle) / angle if angle > 1e-9 else 1.0
    sideways = (1.0 - math.cos(angle)) / angle if angle > 1e-9 else 0.0
    beyond = y - GRIPPING_FACE
    return (x,
            GRIPPING_FACE + length * sideways + beyond * math.cos(angle),
            BEND_FOOT + length * forward - beyond * math.sin(angle))


def write_motion(points, cells, mixed, path):
    """Writes all control points for each frame, after a check that no cell turns inside out."""
    lines = ["frame,point,x,y,z"]
    for frame in range(FRAMES):
        pose = [moved(point, *amounts(frame)) for point in points]
        if min(signed_volume(pose, cell) for cell in cells) <= 0.0:
            raise SystemExit(f"a tetrahedron of the cage turns inside out in frame {frame}")
        for kind, corners in mixed.items():
            if min(min(corner_volumes(pose, kind, cell)) for cell in corners) <= 0.0:
                raise SystemExit(f"a cell of the mixed cage turns inside out in frame {frame}")
        if frame in (0, FRAMES - 1):
            pose = points
        lines += [f"{frame},{i}," + ",".join(number(c) for c in p) for i, p in enumerate(pose)]
    write_whole(path, lines)


def main():
    """Writes all files and says what they hold."""
    points, cells, mixed = make_cage()
    skin = make_skin()
    write_skin(skin, FOLDER / "finger.obj")
    write_motion(points, cells, mixed, FOLDER / "finger-motion.csv")
    faces = sum(len(group) for group in skin.groups.values())
    print(f"cage: {len(points)} control points, {len(cells)} tetrahedra")
    print(f"mixed cage: {len(mixed[HEXAHEDRON])} hexahedra, {len(mixed[PRISM])} prisms, "
          f"{len(mixed[TETRAHEDRON])} tetrahedra")
    print(f"skin: {len(skin.positions)} vertices, {faces} quadrilaterals")
    print(f"motion: {FRAMES} frames")


if __name__ == "__main__":
    main()
