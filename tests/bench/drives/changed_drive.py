#!/usr/bin/env python3
"""Makes other recordings of one that is there, and scores how they are mapped.

    changed_drive.py make SCANS FOLDER [--table poses.csv] [--reverse] [--mirror] [--turn DEG]
                                       [--from K] [--to K] [--every K] [--without-odometry]
        Writes scans, odometry.csv (where there is one) and truth.csv as a robot would have taken
        them that drove the other way round, through the mirrored world, with its laser turned
        by so many degrees, or a part of the way only. What holds of a recording, and not of these,
        was tuned to it.
    changed_drive.py score TRAJECTORY FOLDER
        Compares a trajectory (TUM) with truth.csv: RMSE after the planar motion that fits best,
        and steps between scans that come one after the other.

Needs Python alone.
"""
import argparse
import array
import csv
import math
import os
import sys

sys.dont_write_bytecode = True  # no folder of byte code beside the sources
from tilted_scans import HEADER, read_ply

FIELDS = ['index', 'utime', 'x_m', 'y_m', 'yaw_rad']
WRONG_STEP_M = 0.3


def changed_pose(row, options):
    x, y, yaw = (float(row[name]) for name in FIELDS[2:])
    if options.mirror:
        y, yaw = -y, -yaw
    return x, y, yaw - math.radians(options.turn)


def changed_points(values, options):
    c, s = math.cos(math.radians(options.turn)), math.sin(math.radians(options.turn))
    out = array.array('f')
    for i in range(0, len(values), 3):
        x, y = values[i], -values[i + 1] if options.mirror else values[i + 1]
        out.extend((c * x - s * y, s * x + c * y, values[i + 2]))
    return out


def read_table(file):
    return {int(row['index']): row for row in csv.DictReader(open(file))}


def write_table(file, rows):
    with open(file, 'w', newline='') as out:
        table = csv.writer(out)
        table.writerow(FIELDS)
        table.writerows(rows)


def make(options):
    truth = read_table(os.path.join(options.scans, options.table))
    odometry_file = os.path.join(options.scans, 'odometry.csv')
    has_odometry = os.path.exists(odometry_file) and not options.without_odometry
    odometry = read_table(odometry_file) if has_odometry else {}
    scans = [i for i in sorted(truth) if options.first <= i < options.last][::options.every]
    times = [int(float(truth[i]['utime'])) for i in scans]
    if options.reverse:
        scans, times = scans[::-1], [times[0] + times[-1] - t for t in times[::-1]]
    os.makedirs(options.folder)
    tables = {'truth.csv': [], 'odometry.csv': []}
    for number, (scan, time) in enumerate(zip(scans, times)):
        points = changed_points(read_ply(os.path.join(options.scans, 'scan_%03d.ply' % scan)), options)
        with open(os.path.join(options.folder, 'scan_%03d.ply' % number), 'wb') as file:
            file.write((HEADER % (len(points) // 3)).encode() + points.tobytes())
        tables['truth.csv'].append((number, time, *changed_pose(truth[scan], options)))
        if scan in odometry:
            tables['odometry.csv'].append((number, time, *changed_pose(odometry[scan], options)))
    for name, rows in tables.items():
        if rows:
            write_table(os.path.join(options.folder, name), rows)
    # Scans without odometry still have times.
    if not odometry:
        write_table(os.path.join(options.folder, 'poses.csv'), tables['truth.csv'])


def between(p, q):
    dx, dy, c, s = q[0] - p[0], q[1] - p[1], math.cos(p[2]), math.sin(p[2])
    return c * dx + s * dy, c * dy - s * dx


def rmse_after_fit(pairs):
    n = len(pairs)
    mean = [[sum(pair[k][i] for pair in pairs) / n for i in (0, 1)] for k in (0, 1)]
    off = [(a[0] - mean[0][0], a[1] - mean[0][1], b[0] - mean[1][0], b[1] - mean[1][1]) for a, b in pairs]
    c, s = sum(u * x + v * y for u, v, x, y in off), sum(u * y - v * x for u, v, x, y in off)
    k = math.hypot(c, s) or 1
    return math.sqrt(sum(((c * u - s * v) / k - x) ** 2 + ((s * u + c * v) / k - y) ** 2 for u, v, x, y in off) / n)


def score(options):
    truth = {round(int(row['utime']) * 1e-6, 2): [float(row[name]) for name in FIELDS[2:]]
             for row in read_table(os.path.join(options.folder, 'truth.csv')).values()}
    pairs = []
    for line in open(options.trajectory):
        if not line.startswith('#'):
            v = [float(word) for word in line.split()]
            pairs.append(([v[1], v[2], 2 * math.atan2(v[6], v[7])], truth[round(v[0], 2)]))
    print('%d of %d placed' % (len(pairs), len(truth)), end='')
    if len(pairs) < 3:
        return print()
    ways = [(between(a, c), between(b, d)) for (a, b), (c, d) in zip(pairs, pairs[1:])]
    steps = [(math.dist(*way), math.hypot(*way[1])) for way in ways]
    print(', RMSE %.3f m; steps within 0.05 m + 1 %%: %.1f %%, off by more than %.1f m: %d, worst %.2f m' % (
        rmse_after_fit(pairs), 100 * sum(e <= 0.05 + 0.01 * way for e, way in steps) / len(steps), WRONG_STEP_M,
        sum(e > WRONG_STEP_M for e, _ in steps), max(e for e, _ in steps)))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True)
    command = commands.add_parser('make')
    command.add_argument('scans')
    command.add_argument('folder')
    command.add_argument('--table', default='poses.csv')
    command.add_argument('--reverse', action='store_true')
    command.add_argument('--mirror', action='store_true')
    command.add_argument('--turn', type=float, default=0.0)
    command.add_argument('--from', dest='first', type=int, default=0)
    command.add_argument('--to', dest='last', type=int, default=1 << 30)
    command.add_argument('--every', type=int, default=1)
    command.add_argument('--without-odometry', action='store_true')
    command.set_defaults(run=make)
    command = commands.add_parser('score')
    command.add_argument('trajectory')
    command.add_argument('folder')
    command.set_defaults(run=score)
    options = parser.parse_args()
    options.run(options)


if __name__ == '__main__':
    main()
