#!/usr/bin/env python3
"""Puts roll, pitch and height into levelled scans, and compares what was found with what was put in.

    tilted_scans.py make SCANS FOLDER [--tilt 6] [--lift 0.1] [--alone] [--every K] [--seed 1]
        Writes the scans of a folder with a poses.csv (x, y, yaw), each seen by a scanner that is
        tilted by up to --tilt degrees and lifted by up to --lift metres: smoothly over time, or,
        with --alone, each scan by itself. truth.csv has the six coordinates of each.
    tilted_scans.py score TRAJECTORY FOLDER
        Compares a trajectory (TUM) with truth.csv: RMSE after the rigid motion that fits best.

Needs Python alone.
"""
import argparse
import array
import csv
import math
import os
import random

HEADER = 'ply\nformat binary_little_endian 1.0\nelement vertex %d\n' + ''.join(
    'property float %s\n' % axis for axis in 'xyz') + 'end_header\n'
FIELDS = ['index', 'utime', 'x_m', 'y_m', 'z_m', 'roll_rad', 'pitch_rad', 'yaw_rad']
WAVES = 4


def product(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)] for i in range(3)]


def times(a, v):
    return [sum(a[i][k] * v[k] for k in range(3)) for i in range(3)]


def transposed(a):
    return [list(row) for row in zip(*a)]


def rotation(roll, pitch, yaw):
    cr, sr, cp, sp, cy, sy = (f(v) for v in (roll, pitch, yaw) for f in (math.cos, math.sin))
    return product([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]],
                   product([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]], [[1, 0, 0], [0, cr, -sr], [0, sr, cr]]))


def from_quaternion(x, y, z, w):
    return [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]


class Smooth:
    """A value that swings within -1..1 as a walker's hand does: over 6 to 20 scans."""

    def __init__(self, lots):
        self.waves = [(2 * math.pi / lots.uniform(6, 20), lots.uniform(0, 2 * math.pi)) for _ in range(WAVES)]

    def at(self, scan):
        return sum(math.sin(rate * scan + phase) for rate, phase in self.waves) / WAVES


def tilts(count, options):
    lots = random.Random(options.seed)
    if options.alone:
        for _ in range(count):
            lean, way = math.radians(options.tilt) * math.sqrt(lots.random()), lots.uniform(0, 2 * math.pi)
            yield lean * math.cos(way), lean * math.sin(way), options.lift * lots.random()
        return
    swings = [Smooth(lots) for _ in range(3)]
    for scan in range(count):
        roll, pitch, lift = (swing.at(scan) for swing in swings)
        yield math.radians(options.tilt) * roll, math.radians(options.tilt) * pitch, options.lift * lift


def read_ply(file):
    data = open(file, 'rb').read()
    start = data.index(b'end_header\n') + len(b'end_header\n')
    assert b'property float x\nproperty float y\nproperty float z\nend_header' in data[:start], file
    values = array.array('f')
    values.frombytes(data[start:])
    return values


def seen_tilted(points, roll, pitch, lift):
    """Points of a level frame in one that is rolled, pitched and lifted in it."""
    (a, b, c), (d, e, f), (g, h, i) = transposed(rotation(roll, pitch, 0))
    out = array.array('f')
    for k in range(0, len(points), 3):
        x, y, z = points[k], points[k + 1], points[k + 2] - lift
        out.extend((a * x + b * y + c * z, d * x + e * y + f * z, g * x + h * y + i * z))
    return out


def make(options):
    rows = list(csv.DictReader(open(os.path.join(options.scans, 'poses.csv'))))
    os.makedirs(options.folder, exist_ok=True)
    truth = csv.DictWriter(open(os.path.join(options.folder, 'truth.csv'), 'w'), FIELDS)
    truth.writeheader()
    for row, (roll, pitch, lift) in list(zip(rows, tilts(len(rows), options)))[::options.every]:
        name = 'scan_%03d.ply' % int(row['index'])
        points = seen_tilted(read_ply(os.path.join(options.scans, name)), roll, pitch, lift)
        with open(os.path.join(options.folder, name), 'wb') as file:
            file.write((HEADER % (len(points) // 3)).encode() + points.tobytes())
        truth.writerow({'index': row['index'], 'utime': row['utime'], 'x_m': row['x_m'], 'y_m': row['y_m'],
                        'z_m': lift, 'roll_rad': roll, 'pitch_rad': pitch, 'yaw_rad': row['yaw_rad']})


def read_truth(folder):
    poses = []
    for row in csv.DictReader(open(os.path.join(folder, 'truth.csv'))):
        x, y, z, roll, pitch, yaw = (float(row[name]) for name in FIELDS[2:])
        poses.append(([x, y, z], rotation(roll, pitch, yaw)))
    return poses


def read_trajectory(file):
    """Poses by seconds since the first line."""
    lines = [[float(v) for v in line.split()] for line in open(file) if line[0] != '#']
    return {round(v[0] - lines[0][0]): (v[1:4], from_quaternion(*v[4:8])) for v in lines}


def turn_between(a, b):
    trace = sum(sum(x * y for x, y in zip(p, q)) for p, q in zip(a, b))
    return math.acos(max(-1.0, min(1.0, (trace - 1) / 2)))


def mean(vectors):
    return [sum(v[i] for v in vectors) / len(vectors) for i in range(3)]


def best_rotation(pairs):
    """Takes the first of each pair closest to the second: small turns, until none is left."""
    turn = rotation(0, 0, 0)
    for _ in range(100):
        moved = [(times(turn, a), b) for a, b in pairs]
        pull = [sum(a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3] for a, b in moved)
                for i in range(3)]
        spread = [[sum((sum(v * v for v in a) if i == j else 0) - a[i] * a[j] for a, _ in moved)
                   for j in range(3)] for i in range(3)]
        step = solve(spread, pull)
        turn = product(rotation(*step), turn)
        if sum(abs(s) for s in step) < 1e-12:
            break
    return turn


def solve(a, b):
    det = lambda m: sum(m[0][i] * (m[1][(i + 1) % 3] * m[2][(i + 2) % 3] - m[1][(i + 2) % 3] * m[2][(i + 1) % 3])
                        for i in range(3))
    whole = det(a)
    return [det([[b[i] if j == k else a[i][j] for j in range(3)] for i in range(3)]) / whole for k in range(3)]


def score(options):
    truth, found = read_truth(options.folder), read_trajectory(options.trajectory)
    pairs = [(found[i], pose) for i, pose in enumerate(truth) if i in found]
    from_mean, to_mean = (mean([pair[side][0] for pair in pairs]) for side in (0, 1))
    apart = lambda p, q: [a - b for a, b in zip(p, q)]
    turn = best_rotation([(apart(a[0], from_mean), apart(b[0], to_mean)) for a, b in pairs])
    off = [math.dist(times(turn, apart(a[0], from_mean)), apart(b[0], to_mean)) for a, b in pairs]
    # The first turn is not known: what remains between scans is.
    frame = product(pairs[0][1][1], transposed(pairs[0][0][1]))
    turned = [turn_between(product(frame, a[1]), b[1]) for a, b in pairs]
    rmse = lambda errors: math.sqrt(sum(e * e for e in errors) / len(errors))
    print('%d of %d placed, RMSE %.3f m, worst %.3f m; turns from the first %.2f deg RMSE, worst %.2f deg' % (
        len(pairs), len(truth), rmse(off), max(off), math.degrees(rmse(turned)), math.degrees(max(turned))))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True)
    making = commands.add_parser('make')
    making.add_argument('scans')
    making.add_argument('folder')
    making.add_argument('--tilt', type=float, default=6.0)
    making.add_argument('--lift', type=float, default=0.1)
    making.add_argument('--alone', action='store_true')
    making.add_argument('--every', type=int, default=1)
    making.add_argument('--seed', type=int, default=1)
    making.set_defaults(run=make)
    scoring = commands.add_parser('score')
    scoring.add_argument('trajectory')
    scoring.add_argument('folder')
    scoring.set_defaults(run=score)
    options = parser.parse_args()
    options.run(options)


if __name__ == '__main__':
    main()
