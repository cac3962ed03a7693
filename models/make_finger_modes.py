#!/usr/bin/env python3
"""Makes what a controller of the finger is baked from, out of finger-motion.csv and finger.obj.

    finger-modes.csv      sixteen actuation modes: the control points' positions at amplitude one
    finger-actuators.csv  bounds and rates of their amplitudes
    finger-effectors.csv  32 points of the skin with goals, eight heights by four sides
    finger-sensors.csv    32 other points of the skin that are measured

Needs Python 3.9 or newer. The points of the base never move.
"""

import csv
import math
from pathlib import Path

FOLDER = Path(__file__).resolve().parent
TOP = 103.0  # height of the cage
HEIGHTS = 8
SIDES = ((0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0))


def bump(s, middle, width):
    """1 at `middle`, 0 from `width` away, smooth."""
    t = abs(s - middle) / width
    return 0.0 if t >= 1.0 else (1.0 - t * t) ** 2


def bend(s, y, reach):
    """Displacement along y and z of a bar that curls by a parabola: at the tip by `reach`."""
    return reach * s * s, -2.0 * reach / TOP * s * y


def tip_bend(s, y, reach):
    """The same from the middle on."""
    t = max(0.0, 2.0 * s - 1.0)
    return reach * t * t, -4.0 * reach / TOP * t * y


def fields(x, y, z):
    """What each mode adds to a point."""
    s = max(0.0, z / TOP)
    to_y, down_y = bend(s, y, 25.0)
    to_x, down_x = bend(s, x, 20.0)
    tip_y, tip_down_y = tip_bend(s, y, 12.0)
    tip_x, tip_down_x = tip_bend(s, x, 10.0)
    wave = s * math.sin(2.0 * math.pi * s)
    late = max(0.0, 2.0 * s - 1.0) ** 2
    middle = bump(s, 0.5, 0.4)
    modes = [
        (0.0, to_y, down_y),  # curl toward the gripping side
        (to_x, 0.0, down_x),  # curl aside
        (-0.6 * s * y, 0.6 * s * x, 0.0),  # twist
        (-0.3 * middle * x, 0.0, 0.0),  # squeeze from the sides
        (0.0, -0.3 * middle * y, 0.0),  # squeeze from front and back
        (0.0, 0.0, 8.0 * s),  # lengthen
        (0.0, tip_y, tip_down_y),  # curl of the tip
        (tip_x, 0.0, tip_down_x),  # the same aside
        (0.0, 6.0 * wave, 0.0),  # an S
        (6.0 * wave, 0.0, 0.0),  # the same aside
        (-0.5 * late * y, 0.5 * late * x, 0.0),  # twist of the tip
        (0.0, 0.0, 5.0 * late),  # lengthen the tip
    ]
    for place in (0.25, 0.45, 0.65, 0.85):  # bellows
        swell = 0.25 * bump(s, place, 0.2)
        modes.append((swell * x, swell * y, 0.0))
    return modes


def rest():
    """The control points at rest: frame 0 of the motion."""
    with open(FOLDER / "finger-motion.csv", newline="", encoding="ascii") as file:
        rows = [row for row in csv.DictReader(file) if row["frame"] == "0"]
    return [tuple(float(row[axis]) for axis in "xyz") for row in sorted(rows, key=lambda row: int(row["point"]))]


def skin():
    """The points of the skin."""
    lines = (FOLDER / "finger.obj").read_text(encoding="ascii").splitlines()
    return [tuple(map(float, line.split()[1:4])) for line in lines if line.startswith("v ")]


def spread(points, low, high, turn):
    """The skin's points nearest to eight heights by four sides."""
    chosen = []
    for step in range(HEIGHTS):
        z = low + (high - low) * step / (HEIGHTS - 1)
        for side in SIDES:
            angle = math.atan2(side[1], side[0]) + turn
            place = (11.0 * math.cos(angle), 9.0 * math.sin(angle), z)
            others = [index for index in range(len(points)) if index not in chosen]
            chosen.append(min(others, key=lambda index: math.dist(points[index], place)))
    return chosen


def write(name, header, rows):
    """Writes a table."""
    with open(FOLDER / name, "w", newline="", encoding="ascii") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(header)
        writer.writerows(rows)


def main():
    """Writes all four files."""
    control_points = rest()
    count = len(fields(0.0, 0.0, 0.0))
    rows = []
    for mode in range(count):
        for index, point in enumerate(control_points):
            moved = [a + b for a, b in zip(point, fields(*point)[mode])]
            rows.append([mode, index] + [format(round(value, 6) + 0.0, ".10g") for value in moved])
    write("finger-modes.csv", ["frame", "point", "x", "y", "z"], rows)
    write("finger-actuators.csv", ["actuator", "lower", "upper", "rate"], [[mode, -1.9, 1.9, 0.25] for mode in range(count)])
    points = skin()
    effectors = spread(points, 15.0, 98.0, 0.0)
    write("finger-effectors.csv", ["point", "weight"], [[point, 1] for point in effectors])
    sensors = spread(points, 12.0, 95.0, math.pi / 4.0)
    write("finger-sensors.csv", ["point", "weight"], [[point, 1] for point in sensors])


if __name__ == "__main__":
    main()
