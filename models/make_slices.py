#!/usr/bin/env python3
"""Makes the cages, channels and poses that the cross-sections in models/README.md are drawn of.

Only the standard library is needed. Every file is the same on every run.
"""

import itertools
import math
from pathlib import Path

FOLDER = Path(__file__).resolve().parent / "slices"


def write_mesh(name, points, tetrahedra):
    """Writes a Gmsh 2.2 file; cells are turned positive."""
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$Nodes", str(len(points))]
    lines += [f"{i + 1} {x!r} {y!r} {z!r}" for i, (x, y, z) in enumerate(points)]
    lines += ["$EndNodes", "$Elements", str(len(tetrahedra))]
    for i, cell in enumerate(tetrahedra):
        if volume(*(points[v] for v in cell)) < 0:
            cell = (cell[1], cell[0], cell[2], cell[3])
        lines.append(f"{i + 1} 4 2 1 1 " + " ".join(str(v + 1) for v in cell))
    lines += ["$EndElements", ""]
    (FOLDER / name).write_text("\n".join(lines))


def write_mixed_mesh(name, points, cells):
    """Writes a Gmsh 2.2 file of cells as (Gmsh's number of the shape, corners)."""
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$Nodes", str(len(points))]
    lines += [f"{i + 1} {x!r} {y!r} {z!r}" for i, (x, y, z) in enumerate(points)]
    lines += ["$EndNodes", "$Elements", str(len(cells))]
    for i, (shape, cell) in enumerate(cells):
        lines.append(f"{i + 1} {shape} 2 1 1 " + " ".join(str(v + 1) for v in cell))
    lines += ["$EndElements", ""]
    (FOLDER / name).write_text("\n".join(lines))


def write_channel(name, values):
    (FOLDER / name).write_text("\n".join(repr(float(v)) for v in values) + "\n")


def volume(a, b, c, d):
    u, v, w = ([q[k] - a[k] for k in range(3)] for q in (b, c, d))
    return (
        u[0] * (v[1] * w[2] - v[2] * w[1])
        - u[1] * (v[0] * w[2] - v[2] * w[0])
        + u[2] * (v[0] * w[1] - v[1] * w[0])
    )


def split_prism(prism):
    """Three tetrahedra of a triangular prism; sides are cut from their least vertex."""
    below, above = prism
    turn = below.index(min(below)) if min(below) < min(above) else above.index(min(above))
    below, above = below[turn:] + below[:turn], above[turn:] + above[:turn]
    if min(above) < min(below):
        below, above = above, below
    a, b, c = below
    d, e, f = above
    # Cut from a; the side without a is cut from its least vertex.
    if min(b, f) < min(c, e):
        return [(a, b, c, f), (a, b, f, e), (a, e, f, d)]
    return [(a, b, c, e), (a, e, c, f), (a, e, f, d)]


def stack(points_below, triangles, heights):
    """Layers of prisms over a triangulated base, as tetrahedra."""
    size = len(points_below)
    points = [(x, y, z) for z in heights for (x, y) in points_below]
    tetrahedra = []
    for layer in range(len(heights) - 1):
        for t in triangles:
            below = [v + layer * size for v in t]
            above = [v + (layer + 1) * size for v in t]
            tetrahedra += split_prism((below, above))
    return points, tetrahedra


def lattice_tetrahedron():
    """A cell of the regular lattice, sixteen times its size, with the axes of paper 2's figure 15:
    the edges of its sixteenths are (1,0,0), (0,1,0), (0,0,1), (1,1,1) and two more directions, and
    one diagonal of the octahedra runs along y = x."""
    corners = [(0, 0, 0), (0, 1, 1), (1, 0, 1), (1, 1, 0)]
    columns = [(0.5, 0.5, 0.0), (0.5, -0.5, 0.0), (-0.5, -0.5, -1.0)]
    points = [
        tuple(16.0 * sum(p[j] * columns[j][k] for j in range(3)) for k in range(3)) for p in corners
    ]
    write_mesh("lattice.msh", points, [(0, 1, 2, 3)])


def two_tetrahedra():
    """Two tetrahedra whose common face lies in the plane z = 0."""
    ring = [(math.cos(2 * math.pi * k / 3), math.sin(2 * math.pi * k / 3), 0.0) for k in range(3)]
    points = ring + [(0.0, 0.0, 1.4), (0.0, 0.0, -1.4)]
    write_mesh("two.msh", points, [(0, 1, 2, 3), (0, 2, 1, 4)])


def cylinder():
    """Six layers of a disc; the density differs between top, middle and bottom."""
    sides = 10
    base = [(0.0, 0.0)]
    for radius, shift in ((0.5, 0.5), (1.0, 0.0)):
        for k in range(sides):
            angle = 2 * math.pi * (k + shift) / sides
            base.append((radius * math.cos(angle), radius * math.sin(angle)))
    inner = [1 + k for k in range(sides)]
    outer = [1 + sides + k for k in range(sides)]
    triangles = []
    for k in range(sides):
        n = (k + 1) % sides
        triangles.append((0, inner[k], inner[n]))
        triangles.append((inner[k], outer[n], inner[n]))
        triangles.append((outer[k], outer[n], inner[k]))
    heights = [0.5 * k for k in range(7)]
    points, cells = stack(base, triangles, heights)
    write_mesh("cylinder.msh", points, cells)
    by_layer = [1.0, 1.0, 0.2, 0.2, 0.2, 0.8, 0.0]
    write_channel("cylinder-density.txt", [by_layer[v // len(base)] for v in range(len(points))])


def panel():
    """A flat panel with a tension that spreads from a loaded corner, at four times."""
    cells_x, cells_y = 8, 5
    base = [(x * 0.5, y * 0.5) for y in range(cells_y + 1) for x in range(cells_x + 1)]
    at = lambda x, y: y * (cells_x + 1) + x
    triangles = []
    for y in range(cells_y):
        for x in range(cells_x):
            a, b, c, d = at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)
            triangles += [(a, b, c), (a, c, d)] if (x + y) % 2 else [(a, b, d), (b, c, d)]
    points, cells = stack(base, triangles, [0.0, 0.25])
    write_mesh("panel.msh", points, cells)
    neighbours = [set() for _ in points]
    for cell in cells:
        for v in cell:
            neighbours[v].update(w for w in cell if w != v)
    load = {v for v, p in enumerate(points) if p[0] <= 0.5 and p[1] <= 0.5}
    held = {v for v, p in enumerate(points) if p[0] >= 4.0}
    values = [1.0 if v in load else 0.0 for v in range(len(points))]
    for frame in range(4):
        write_channel(f"panel-tension-{frame}.txt", values)
        for _ in range(4):
            means = [sum(values[w] for w in near) / len(near) for near in neighbours]
            values = [
                1.0 if v in load else 0.0 if v in held else 0.5 * (values[v] + means[v])
                for v in range(len(points))
            ]


def skirt():
    """A drum of two layers with a skirt: a ring of triangles that hangs on its middle and that no
    cell has. The channel is the height."""
    sides = 10
    base = [(0.0, 0.0)]
    base += [
        (math.cos(2 * math.pi * k / sides), math.sin(2 * math.pi * k / sides)) for k in range(sides)
    ]
    triangles = [(0, 1 + k, 1 + (k + 1) % sides) for k in range(sides)]
    points, cells = stack(base, triangles, [0.0, 0.6, 1.2])
    middle = len(base) + 1
    sheets, inner = [], [middle + k for k in range(sides)]
    for radius, height in ((1.5, 0.6), (2.0, 1.1)):
        outer = [len(points) + k for k in range(sides)]
        points += [
            (radius * math.cos(2 * math.pi * k / sides), radius * math.sin(2 * math.pi * k / sides), height)
            for k in range(sides)
        ]
        for k in range(sides):
            n = (k + 1) % sides
            sheets += [(inner[k], outer[k], outer[n]), (inner[k], outer[n], inner[n])]
        inner = outer
    write_mesh("skirt.msh", points, cells)
    lines = ["sheet " + " ".join(map(str, sheet)) for sheet in sheets]
    (FOLDER / "skirt-features.txt").write_text("\n".join(lines) + "\n")
    write_channel("skirt-height.txt", [p[2] for p in points])


def block():
    """A block of hexahedra, prisms and tetrahedra, all pairs of which touch, with sharp edges; and a
    pose in which the middle is turned. The control points outside stay."""
    columns, layers = 4, 2
    # From above, row by row: hexahedron, prisms with triangles above and below, tetrahedra.
    pattern = ["HPTT", "PHTP", "TTHP", "PTPH"]
    at = lambda x, y, z: (z * (layers + 1) + y) * (columns + 1) + x
    grid = range(columns + 1)
    points = [(float(x), float(y), float(z)) for z in grid for y in range(layers + 1) for x in grid]
    hexahedra, prisms, tetrahedra = [], [], []
    for z in range(columns):
        for y in range(layers):
            for x in range(columns):
                corner = lambda i, j, k: at(x + i, y + j, z + k)
                shape = pattern[columns - 1 - z][x]
                if shape == "H":
                    ring = [(0, 0), (1, 0), (1, 1), (0, 1)]
                    hexahedra.append([corner(i, j, k) for k in (0, 1) for i, j in ring])
                elif shape == "P":
                    for ring in [[(0, 0), (1, 1), (1, 0)], [(0, 0), (0, 1), (1, 1)]]:
                        prisms.append([corner(i, j, k) for j in (0, 1) for i, k in ring])
                else:
                    # Six round the diagonal, one for each order of the axes.
                    for a, b in itertools.permutations(range(3), 2):
                        steps = [[0, 0, 0], [0, 0, 0], [0, 0, 0], [1, 1, 1]]
                        steps[1][a] = 1
                        steps[2][a] = steps[2][b] = 1
                        cell = [corner(*step) for step in steps]
                        if volume(*(points[v] for v in cell)) < 0:
                            cell[0], cell[1] = cell[1], cell[0]
                        tetrahedra.append(cell)
    cells = [(5, cell) for cell in hexahedra] + [(6, cell) for cell in prisms]
    cells += [(4, cell) for cell in tetrahedra]
    write_mixed_mesh("block.msh", points, cells)

    size = (columns, layers, columns)
    ends = lambda p: sum(p[k] in (0.0, float(size[k])) for k in range(3))
    lines = [f"corner {v}" for v, p in enumerate(points) if ends(p) == 3]
    for v, p in enumerate(points):
        for step in ((1, 0, 0), (0, 1, 0), (0, 0, 1)):
            q = tuple(p[k] + step[k] for k in range(3))
            middle = tuple(p[k] + step[k] / 2 for k in range(3))
            if q in points and ends(middle) == 2:
                lines.append(f"crease {v} {points.index(q)}")
    (FOLDER / "block-features.txt").write_text("\n".join(lines) + "\n")

    angle = math.radians(30.0)
    middle = columns / 2
    posed = []
    for x, y, z in points:
        if ends((x, y, z)) == 0:
            x, z = x - middle, z - middle
            x, z = x * math.cos(angle) - z * math.sin(angle), x * math.sin(angle) + z * math.cos(angle)
            x, z = middle + round(x, 6), middle + round(z, 6)
        posed.append((x, y, z))
    write_mixed_mesh("block-turned.msh", posed, cells)


if __name__ == "__main__":
    FOLDER.mkdir(exist_ok=True)
    skirt()
    lattice_tetrahedron()
    two_tetrahedra()
    cylinder()
    panel()
    block()
