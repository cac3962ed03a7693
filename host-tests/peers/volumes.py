#!/usr/bin/env python3
"""Compares `octruss volume` with the volumes of the polyhedra that CGAL refines to.

Usage: host-tests/peers/volumes.py [path of the octruss binary] [MESH.obj ...]

The meshes are random closed ones, models/glove.obj, models/palm.obj and those that are named. The volume of a polyhedron of level k is
off by about c / 4^k, so the error against the exact volume must fall by 4 a level (3.8 to 4.2 between
the last two), and the extrapolation of the last two levels must meet the exact volume within what it
differs from the extrapolation before. For sqrt3 it falls by 3 a step and 9 in two (2.85 to 3.15 between
the last two, and 8.1 to 9.9 over both). Needs CGAL's headers (Debian: libcgal-dev) and a C++ compiler, and no package
but Python itself. Exit status 0 only if all were compared and agree.
"""
import json
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
import compare

SCHEMES = {"loop": True, "catmull-clark": False, "doo-sabin": False, "sqrt3": True}
LEVELS = 4
REAL = ["models/glove.obj", "models/palm.obj"]
# A mesh of many faces is refined less often.
FACES_AT_MOST = 400_000
# What the error falls by in a step, and the part of it that the last two may be off by.
FALL = {"sqrt3": 3}
SLACK = 0.05


def read_obj(path):
    points, faces = [], []
    for line in path.read_text().split("\n"):
        words = line.split()
        if words[:1] == ["v"]:
            points.append([float(word) for word in words[1:4]])
        elif words[:1] == ["f"]:
            faces.append([int(word.split("/")[0]) - 1 for word in words[1:]])
    return points, faces


def read_off(path):
    words = iter(path.read_text().split())
    assert next(words) == "OFF"
    vertices, count, _ = (int(next(words)) for _ in range(3))
    points = [[float(next(words)) for _ in range(3)] for _ in range(vertices)]
    faces = [[int(next(words)) for _ in range(int(next(words)))] for _ in range(count)]
    return points, faces


def polyhedron(points, faces):
    """The volume inside: each face is a fan of triangles round the mean of its corners."""
    total = 0.0
    for face in faces:
        corners = [points[vertex] for vertex in face]
        cx, cy, cz = (sum(axis) / len(corners) for axis in zip(*corners))
        for (ax, ay, az), (bx, by, bz) in zip(corners, corners[1:] + corners[:1]):
            total += cx * (ay * bz - az * by) + cy * (az * bx - ax * bz) + cz * (ax * by - ay * bx)
    return total / 6


def triangulated(faces):
    return [[face[0], a, b] for face in faces for a, b in zip(face[1:], face[2:])]


def meshes(files):
    rng = random.Random("volumes")
    for number in range(3):
        for polygons in (False, True):
            name = f"random {'polygons' if polygons else 'triangles'} {number}"
            yield name, *compare.sphere(rng, 3 + number, 5 + number, polygons)
    for file in [str(compare.ROOT / file) for file in REAL] + files:
        yield pathlib.Path(file).name, *read_obj(pathlib.Path(file))


def check(octruss, peer, scheme, name, points, faces, folder):
    mesh = folder / "in.off"
    compare.write_off(mesh, points, faces)
    obj = folder / "in.obj"
    lines = ["v " + " ".join(repr(float(x)) for x in point) for point in points]
    lines += ["f " + " ".join(str(vertex + 1) for vertex in face) for face in faces]
    obj.write_text("\n".join(lines) + "\n")
    command = [octruss, "volume", str(obj), "--scheme", scheme, "--json"]
    figures = json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout)
    exact, stated = figures["volume"], figures.get("error_estimate", 0.0)
    fall = FALL.get(scheme, 4)
    volumes = []
    each = 3 if scheme == "sqrt3" else 4
    levels = LEVELS
    while levels > 3 and len(faces) * each**levels > FACES_AT_MOST:
        levels -= 1
    for level in range(1, levels + 1):
        out = folder / "out.off"
        subprocess.run([str(peer), scheme, str(level), str(mesh), str(out)], check=True)
        volumes.append(polyhedron(*read_off(out)))
    errors = [volume - exact for volume in volumes]
    ratio = errors[-2] / errors[-1]
    before, last = ((fall * b - a) / (fall - 1) for a, b in zip(volumes[-3:], volumes[-2:]))
    agrees = abs(ratio / fall - 1) < SLACK and abs(last - exact) <= abs(last - before) + stated
    if scheme == "sqrt3":
        agrees &= abs(errors[-3] / errors[-1] / fall**2 - 1) < 2 * SLACK
    print(
        f"{scheme}, {name}: exact {exact:.12g}; CGAL's polyhedra off by "
        + ", ".join(f"{error / exact:.3e}" for error in errors)
        + f" (last ratio {ratio:.3f}), extrapolated by {last / exact - 1:.1e}: "
        + ("agree" if agrees else "DIFFER")
    )
    return agrees


def main():
    octruss = sys.argv[1] if len(sys.argv) > 1 else str(compare.ROOT / "target/release/octruss")
    if shutil.which(octruss) is None:
        sys.exit(f"there is no program {octruss}: build it with `cargo build --release -p octruss-bake`")
    agree = True
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        header, libraries, *_ = compare.PEERS["cgal"]
        peer = compare.build("cgal", header, libraries, folder)
        if peer is None:
            sys.exit("CGAL cannot be built against, so nothing was compared (Debian: libcgal-dev)")
        for scheme, needs_triangles in SCHEMES.items():
            for name, points, faces in meshes(sys.argv[2:]):
                if needs_triangles:
                    faces = triangulated(faces)
                agree &= check(octruss, peer, scheme, name, points, faces, folder)
    sys.exit(0 if agree else 1)


if __name__ == "__main__":
    main()
