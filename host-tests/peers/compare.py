#!/usr/bin/env python3
"""Compares `octruss refine --numeric f64` with CGAL, OpenMesh and OpenSubdiv on random meshes.

Usage: host-tests/peers/compare.py [path of the octruss binary]

The peers are built from the sources beside this file when their headers are installed (Debian:
libcgal-dev, libopenmesh-dev, libosd-dev and a C++ compiler); one that is missing is skipped with a
word. Positions are compared as sets: every vertex of each result must lie within the bound of one of
the other, since programs number vertices differently. All of them compute in double precision; the bound is 1e-12
of the mesh's size. Limit positions and normals of Loop's and Catmull-Clark surfaces are held against
OpenSubdiv's as well (normals, of length one, within 1e-12), but for rims and creases where its masks belong to
other rules. Exit status 0 only if all that ran agree. Needs no package but Python itself.
"""
import itertools
import math
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
PEERS = {
    # name: (probe header, libraries, {scheme: (levels, needs closed)}, bound)
    "cgal": (
        "CGAL/subdivision_method_3.h",
        ["-lgmp", "-lmpfr"],
        {"loop": False, "catmull-clark": False, "doo-sabin": False, "sqrt3": False},
        1e-12,
    ),
    "openmesh": (
        "OpenMesh/Tools/Subdivider/Uniform/Sqrt3T.hh",
        ["-lOpenMeshTools", "-lOpenMeshCore"],
        {"sqrt3": False, "loop": False},
        1e-12,
    ),
    "opensubdiv": (
        "opensubdiv/far/primvarRefiner.h",
        ["-losdCPU"],
        {"loop": False, "catmull-clark": False},
        1e-12,
    ),
}
TRIANGLES = {"loop", "sqrt3"}


def build(name, header, libraries, folder):
    """The peer's program, or None with a word on standard output."""
    compiler = shutil.which("c++") or shutil.which("g++")
    if compiler is None:
        print(f"{name}: skipped, there is no C++ compiler")
        return None
    probe = subprocess.run(
        [compiler, "-x", "c++", "-E", "-", "-o", "/dev/null"],
        input=f"#if !__has_include(<{header}>)\n#error missing\n#endif\n",
        text=True,
        capture_output=True,
    )
    if probe.returncode != 0:
        print(f"{name}: skipped, <{header}> is not installed")
        return None
    program = folder / name
    command = [compiler, "-std=c++20", "-O1", "-w", str(HERE / f"{name}_peer.cpp")]
    subprocess.run(command + ["-o", str(program)] + libraries, check=True)
    return program


def sphere(rng, rings, around, polygons):
    """A closed mesh: caps of triangles or one polygon, bands between; valences 3 to 9 by edge swaps."""
    points, faces = [], []
    for i in range(rings):
        height = -1 + 2 * (i + 1) / (rings + 1)
        for j in range(around):
            turn = 2 * math.pi * (j + 0.5 * (i % 2)) / around
            radius = math.sqrt(1 - height * height)
            points.append([radius * math.cos(turn), radius * math.sin(turn), height])
    at = lambda i, j: i * around + j % around
    for i in range(rings - 1):
        for j in range(around):
            a, b, c, d = at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)
            faces += [[a, b, c, d]] if polygons else [[a, b, c], [a, c, d]]
    if polygons:
        faces.append([at(0, j) for j in reversed(range(around))])
        faces.append([at(rings - 1, j) for j in range(around)])
    else:
        south, north = len(points), len(points) + 1
        points += [[0, 0, -1.1], [0, 0, 1.1]]
        for j in range(around):
            faces.append([at(0, j + 1), at(0, j), south])
            faces.append([at(rings - 1, j), at(rings - 1, j + 1), north])
        for _ in range(3 * len(points)):
            swap(rng, faces)
    points = [[x + rng.uniform(-0.1, 0.1) for x in point] for point in points]
    return points, faces


def swap(rng, faces):
    """Swaps the diagonal of two random triangles if valences stay from 3 to 9."""
    sides = {(f[k], f[(k + 1) % 3]): i for i, f in enumerate(faces) for k in range(3)}
    (a, b), one = rng.choice(sorted(sides.items()))
    other = sides[(b, a)]
    c = next(v for v in faces[one] if v not in (a, b))
    d = next(v for v in faces[other] if v not in (a, b))
    valence = lambda v: sum(v in f for f in faces)
    if (c, d) in sides or (d, c) in sides or min(valence(a), valence(b)) < 4:
        return
    if max(valence(c), valence(d)) < 9:
        faces[one], faces[other] = [c, a, d], [d, b, c]


def opened(rng, faces):
    """Takes out a face with a manifold rim left behind."""
    faces = [list(face) for face in faces]
    faces.pop(rng.randrange(len(faces)))
    return faces


def write_off(path, points, faces):
    lines = ["OFF", f"{len(points)} {len(faces)} 0"]
    lines += [" ".join(repr(float(x)) for x in point) for point in points]
    lines += [" ".join(map(str, [len(face)] + face)) for face in faces]
    path.write_text("\n".join(lines) + "\n")


def read_points(path, is_off=False):
    lines = path.read_text().split("\n")
    if is_off:
        lines = lines[2 : 2 + int(lines[1].split()[0])]
    return [tuple(map(float, line.split())) for line in lines if line.strip()]


def distance(ours, theirs):
    """The greatest distance from a point of either list to the nearest of the other."""
    cell = 1e-4
    grid = lambda p: tuple(math.floor(x / cell) for x in p)
    worst = 0.0
    for one, other in ((ours, theirs), (theirs, ours)):
        table = {}
        for point in other:
            table.setdefault(grid(point), []).append(point)
        for point in one:
            near = itertools.product(*[(x - 1, x, x + 1) for x in grid(point)])
            found = [math.dist(point, q) for key in near for q in table.get(key, [])]
            worst = max(worst, min(found, default=math.inf))
    return worst


def cases(rng, peer, scheme):
    """Meshes with levels and features."""
    for number in range(6):
        polygons = scheme not in TRIANGLES
        points, faces = sphere(rng, 3 + number % 3, 5 + number % 4, polygons)
        is_open = number % 3 == 1
        if is_open:
            faces = opened(rng, faces)
        features = []
        if peer == "opensubdiv" and number % 3 == 2:
            ends = sorted({tuple(sorted((f[k - 1], f[k]))) for f in faces for k in range(len(f))})
            features = [f"crease {a} {b}" for a, b in rng.sample(ends, 6)]
            features.append(f"corner {rng.randrange(len(points))}")
        # Between its two boundary steps other programs keep other meshes.
        levels = 2 if scheme == "sqrt3" else 1 + number % 3
        yield points, faces, levels, features, is_open


def run(octruss, peer, program, schemes, bound, folder):
    agree = True
    for scheme in schemes:
        rng = random.Random(f"{peer} {scheme}")
        worst, count, open_count = 0.0, 0, 0
        for points, faces, levels, features, is_open in cases(rng, peer, scheme):
            mesh, ours, theirs = folder / "in.off", folder / "ours.off", folder / "theirs.txt"
            write_off(mesh, points, faces)
            extra, extra_peer = [], []
            if features:
                tags = folder / "features.txt"
                tags.write_text("\n".join(features) + "\n")
                extra, extra_peer = ["--features", str(tags)], [str(tags)]
            command = [octruss, "refine", str(mesh), "--scheme", scheme, "--levels", str(levels)]
            subprocess.run(
                command + ["--numeric", "f64", "-o", str(ours)] + extra,
                check=True,
                stdout=subprocess.DEVNULL,
            )
            command = [str(program), scheme, str(levels), str(mesh), str(theirs)]
            subprocess.run(command + extra_peer, check=True)
            size = max(math.dist(p, q) for p in points for q in points)
            got = distance(read_points(ours, True), read_points(theirs)) / size
            worst, count, open_count = max(worst, got), count + 1, open_count + is_open
        verdict = "agree" if worst <= bound else f"DIFFER, more than {bound:g}"
        print(f"{peer} {scheme}: {count} meshes ({open_count} open), greatest distance {worst:.3g} of the size: {verdict}")
        agree &= worst <= bound
    return agree


def compare_normals(ours, theirs):
    """The greatest distance between the normals of vertices at the same place, and how many were compared.

    `ours` is an ASCII .ply of octruss; `theirs` has x y z and a normal in each line, zeros for none."""
    lines = ours.read_text().split("\n")
    count = int(next(line for line in lines if line.startswith("element vertex")).split()[2])
    first = lines.index("end_header") + 1
    cell = 1e-3
    key = lambda p: tuple(math.floor(x / cell) for x in p)
    table = {}
    for line in lines[first : first + count]:
        numbers = list(map(float, line.split()))
        table.setdefault(key(numbers[:3]), []).append(numbers)
    worst, compared, place = 0.0, 0, 0.0
    for numbers in read_points(theirs):
        at, normal = numbers[:3], numbers[3:]
        near = itertools.product(*[(x - 1, x, x + 1) for x in key(at)])
        found = [vertex for near_key in near for vertex in table.get(near_key, [])]
        own = min(found, key=lambda vertex: math.dist(vertex[:3], at), default=None)
        if own is None:
            return math.inf, math.inf, compared
        place = max(place, math.dist(own[:3], at))
        if any(normal):
            worst, compared = max(worst, math.dist(own[3:], normal)), compared + 1
    return place, worst, compared


def run_limits(octruss, program, folder):
    """Limit positions and normals against OpenSubdiv."""
    agree = True
    for scheme in ("loop", "catmull-clark"):
        rng = random.Random(f"limit {scheme}")
        places, worst, compared = 0.0, 0.0, 0
        for points, faces, levels, features, _ in cases(rng, "opensubdiv", scheme):
            mesh, ours, theirs = folder / "in.off", folder / "ours.ply", folder / "theirs.txt"
            tags = folder / "features.txt"
            write_off(mesh, points, faces)
            tags.write_text("\n".join(features) + "\n")
            command = [octruss, "refine", str(mesh), "--scheme", scheme, "--levels", str(levels)]
            command += ["--limit", "--features", str(tags), "-o", str(ours)]
            subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
            command = [str(program), scheme, str(levels), str(mesh), str(theirs), str(tags), "limit"]
            subprocess.run(command, check=True)
            size = max(math.dist(p, q) for p in points for q in points)
            place, normal, count = compare_normals(ours, theirs)
            places, worst, compared = max(places, place / size), max(worst, normal), compared + count
        good = places <= 1e-12 and worst <= 1e-12
        verdict = "agree" if good else "DIFFER, more than 1e-12"
        print(f"opensubdiv {scheme} limit: positions {places:.3g} of the size, {compared} normals {worst:.3g}: {verdict}")
        agree &= good
    return agree


def main():
    octruss = sys.argv[1] if len(sys.argv) > 1 else str(ROOT / "target/release/octruss")
    if shutil.which(octruss) is None:
        sys.exit(f"there is no program {octruss}: build it with `cargo build --release -p octruss-bake`")
    agree = True
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        for peer, (header, libraries, schemes, bound) in PEERS.items():
            program = build(peer, header, libraries, folder)
            if program is not None:
                agree &= run(octruss, peer, program, schemes, bound, folder)
                if peer == "opensubdiv":
                    agree &= run_limits(octruss, program, folder)
    sys.exit(0 if agree else 1)


if __name__ == "__main__":
    main()
