#!/usr/bin/env python3
"""A robot that follows a way and stops in time, from POSE and OBSTACLES alone, as follower.h does in C++.

Usage: follower.py LOG X Y [X Y...]: what it would have done with a recording; points of the way in map.
"""
import math
import sys

from voxlist import obstacles_t, pose_t
from voxlist.event_log import read_events

RADIUS_M, MARGIN_M, BESIDE_M, TOP_SPEED_MPS, SLOWEST_MPS = 0.3, 0.1, 0.05, 1.0, 0.02
BRAKES_MPS2, REACTION_S, THERE_M, ASIDE_RAD, FORESIGHT_S = 1.0, 0.2, 0.2, 0.5, 1.0
OLDEST_US = 300_000


class Follower:
    def __init__(self, way):
        self.way = list(way)
        self.pose, self.obstacles = pose_t(), obstacles_t()

    def command(self, now_us):
        """Speed (m/s), turn (rad/s), and why it does not drive."""
        if abs(now_us - self.pose.utime) > OLDEST_US:
            return 0.0, 0.0, "POSE is old"
        if abs(now_us - self.obstacles.utime) > OLDEST_US:
            return 0.0, 0.0, "OBSTACLES are old"
        if self.obstacles.blind:
            return 0.0, 0.0, "blind: " + self.obstacles.blind
        if not self.obstacles.ground_seen_to_m:
            return 0.0, 0.0, "nothing was seen"
        while self.way and math.hypot(*self.ahead()) < THERE_M:
            self.way.pop(0)
        if not self.way:
            return 0.0, 0.0, "it is there"
        x, y = self.ahead()
        aside = math.atan2(y, x)
        turn = max(-1.0, min(1.0, 2.0 * aside))
        if abs(aside) > ASIDE_RAD:
            return 0.0, turn, ""
        late_s = REACTION_S + 1e-6 * (now_us - self.obstacles.utime)
        speed = min(safe_speed_mps(self.gap_m(), late_s), TOP_SPEED_MPS * (1.0 - abs(aside) / ASIDE_RAD))
        return (speed, turn, "") if speed >= SLOWEST_MPS else (0.0, 0.0, "the way is not free")

    def ahead(self):
        """The next point of the way, as the robot sees it."""
        yaw = 2.0 * math.atan2(self.pose.orientation[3], self.pose.orientation[0])
        x, y = self.way[0][0] - self.pose.pos[0], self.way[0][1] - self.pose.pos[1]
        return math.cos(yaw) * x + math.sin(yaw) * y, math.cos(yaw) * y - math.sin(yaw) * x

    def gap_m(self):
        """How far it can go straight on: up to what stands, hangs or gapes, and no farther than the floor was seen."""
        o = self.obstacles
        blocks = []
        for i, reach_m in enumerate(map(min, o.ground_seen_to_m, *o.nearest_m)):
            bearing = o.rad0 + o.radstep * i
            # Infinity times a cosine of 0 would be no number.
            reach_m = min(reach_m, 1e9)
            blocks.append((reach_m * math.cos(bearing), reach_m * math.sin(bearing), 0.0))
        for m in o.moving:
            x, y = (p + FORESIGHT_S * v for p, v in zip(m.position, m.velocity))
            blocks.append((x, y, m.radius_m))
        gaps = [x - radius_m for x, y, radius_m in blocks if x > 0.0 and abs(y) < RADIUS_M + BESIDE_M + radius_m]
        return max(0.0, min(gaps, default=math.inf) - RADIUS_M - MARGIN_M)


def safe_speed_mps(gap_m, late_s):
    """From this speed it stands before the gap is used up, though it notices late."""
    lost_mps = BRAKES_MPS2 * late_s
    return math.sqrt(lost_mps * lost_mps + 2.0 * BRAKES_MPS2 * gap_m) - lost_mps


def main(log, *numbers):
    numbers = list(map(float, numbers))
    follower = Follower(zip(numbers[::2], numbers[1::2]))
    for event in read_events(log):
        if event.channel == "OBSTACLES":
            follower.obstacles = obstacles_t.decode(event.data)
        elif event.channel == "POSE":
            follower.pose = pose_t.decode(event.data)
            speed, turn, why_not = follower.command(follower.pose.utime)
            print(f"stop: {why_not}" if why_not else f"drive {speed:.2f} m/s, turn {turn:.2f} rad/s")


if __name__ == "__main__":
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    main(*sys.argv[1:])
