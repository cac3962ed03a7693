#!/usr/bin/env python3
"""Makes glove.obj, a control mesh of quads, and glove-motion.csv, a motion of its control points.

The glove is the surface of a union of cubes: a palm, three fingers and a thumb. Every coordinate of
the mesh and of the motion is a multiple of 1/64 mm, so that it is exact in any format with six
fraction bits or more. Python, standard library only.
"""
import math
import pathlib

HERE = pathlib.Path(__file__).resolve().parent
# The length of a cube's edge, x across the fingers, y through the palm, z along the fingers.
SIZE = (9, 12, 15)
FRAMES = 16
PALM = [(x, 0, z) for x in range(5) for z in range(3)]
FINGERS = [(x, 0, z) for x in (0, 2, 4) for z in (3, 4)]
THUMB = [(5, 0, 1), (6, 0, 1)]
# The faces of a cube, corners counter-clockwise from outside, and where the neighbour beyond is.
FACES = [
    ((-1, 0, 0), [(0, 0, 0), (0, 0, 1), (0, 1, 1), (0, 1, 0)]),
    ((1, 0, 0), [(1, 0, 0), (1, 1, 0), (1, 1, 1), (1, 0, 1)]),
    ((0, -1, 0), [(0, 0, 0), (1, 0, 0), (1, 0, 1), (0, 0, 1)]),
    ((0, 1, 0), [(0, 1, 0), (0, 1, 1), (1, 1, 1), (1, 1, 0)]),
    ((0, 0, -1), [(0, 0, 0), (0, 1, 0), (1, 1, 0), (1, 0, 0)]),
    ((0, 0, 1), [(0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]),
]


def add(one, other):
    return tuple(a + b for a, b in zip(one, other))


def surface():
    """The corners of the cubes that faces use, and the faces."""
    cubes = set(PALM + FINGERS + THUMB)
    faces = [
        [add(cube, corner) for corner in corners]
        for cube in sorted(cubes)
        for beyond, corners in FACES
        if add(cube, beyond) not in cubes
    ]
    corners = sorted({corner for face in faces for corner in face})
    place = {corner: index for index, corner in enumerate(corners)}
    return corners, [[place[corner] for corner in face] for face in faces]


def rest(corner):
    return [size * part for size, part in zip(SIZE, corner)]


def snapped(point):
    return [math.floor(64 * value + 0.5) / 64 for value in point]


def posed(corner, phase):
    """Fingers curl one after the other by up to 60 degrees, the thumb by 30."""
    x, y, z = rest(corner)
    is_thumb = corner[0] > 5
    is_finger = corner[2] > 3
    if is_finger:
        delay = 0.15 * (corner[0] // 2)
        angle = math.radians(30) * (1 - math.cos(2 * math.pi * max(0, phase - delay))) / 2
        root = 3 * SIZE[2]
        turn = angle * (corner[2] - 3)
        y, z = (
            y * math.cos(turn) - (z - root) * math.sin(turn),
            root + y * math.sin(turn) + (z - root) * math.cos(turn),
        )
    if is_thumb:
        turn = math.radians(30) * (1 - math.cos(2 * math.pi * phase)) / 2
        root = 5 * SIZE[0]
        x, y = (
            root + (x - root) * math.cos(turn) + y * math.sin(turn),
            y * math.cos(turn) - (x - root) * math.sin(turn),
        )
    return snapped([x, y, z])


def main():
    corners, faces = surface()
    lines = ["# The control mesh of a three-fingered glove, in mm; made by make_glove.py."]
    lines += ["v " + " ".join(f"{value:g}" for value in rest(corner)) for corner in corners]
    lines += ["f " + " ".join(str(vertex + 1) for vertex in face) for face in faces]
    (HERE / "glove.obj").write_text("\n".join(lines) + "\n")
    rows = ["frame,point,x,y,z"]
    for frame in range(FRAMES):
        for index, corner in enumerate(corners):
            point = posed(corner, frame / FRAMES)
            rows.append(f"{frame},{index}," + ",".join(f"{value:.6f}" for value in point))
    (HERE / "glove-motion.csv").write_text("\n".join(rows) + "\n")
    print(f"{len(corners)} control points, {len(faces)} faces, {FRAMES} frames")


if __name__ == "__main__":
    main()
