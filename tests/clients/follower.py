#!/usr/bin/env python3
"""A robot that follows a way and stops in time, from POSE and OBSTACLES alone, as follower.h does in C++.
Usage: follower.py LOG X Y [X Y...]: what it would have done with a recording; points of the way in map."""
import math
import sys

from voxlist import obstacles_t, pose_t
from voxlist.event_log import read_events

# The robot, and its scanner's sweep; someone may step in as near as that. As in common/planning/stopping.
RADIUS_M, MARGIN_M, MARGIN_S, TOP_SPEED_MPS, BRAKES_MPS2, REACTION_S = 0.3, 0.03, 0.1, 1.0, 1.0, 0.15
SWEEP_S, STEPS_IN_M, WALKS_MPS, STEP_S, NEARER_M = 1.0, 1.75, 1.2, 0.05, 0.002
SLOWEST_MPS, THERE_M, ASIDE_RAD, OLDEST_US = 0.02, 0.2, 0.5, 300_000


class Follower:
    def __init__(self, way):
        self.way = list(way)
        self.pose, self.obstacles = pose_t(), obstacles_t()

    def command(self, now_us):
        """Speed (m/s), turn (rad/s), and why it does not drive."""
        o = self.obstacles
        if abs(now_us - self.pose.utime) > OLDEST_US:
            return 0.0, 0.0, "POSE is old"
        if abs(now_us - o.utime) > OLDEST_US:
            return 0.0, 0.0, "OBSTACLES are old"
        if o.blind:
            return 0.0, 0.0, "blind: " + o.blind
        if not o.ground_seen_to_m:
            return 0.0, 0.0, "nothing was seen"
        while self.way and math.hypot(*self.ahead()) < THERE_M:
            self.way.pop(0)
        if not self.way:
            return 0.0, 0.0, "it is there"
        aside = math.atan2(*reversed(self.ahead()))
        turn = max(-1.0, min(1.0, 2.0 * aside))
        if abs(aside) > ASIDE_RAD:
            return 0.0, turn, ""
        late_s = REACTION_S + 1e-6 * (now_us - o.utime)
        speed = min(safe_speed_mps(o, turn, late_s), TOP_SPEED_MPS * (1.0 - abs(aside) / ASIDE_RAD))
        return (speed, turn, "") if speed >= SLOWEST_MPS else (0.0, turn, "the way is not free")

    def ahead(self):
        """The next point of the way, as the robot sees it."""
        yaw = 2.0 * math.atan2(self.pose.orientation[3], self.pose.orientation[0])
        x, y = self.way[0][0] - self.pose.pos[0], self.way[0][1] - self.pose.pos[1]
        return math.cos(yaw) * x + math.sin(yaw) * y, math.cos(yaw) * y - math.sin(yaw) * x


def safe_speed_mps(o, turn, late_s):
    """The speed from which it stands before all that can be in its way by then, as safe_speed.h tells."""
    things = [(m * math.cos(o.radstep * i), m * math.sin(o.radstep * i), 0.0, 0.0, 0.0, 0.0)
              for row in o.nearest_m for i, m in enumerate(row) if m < 2.5]
    things += [(*m.position, *m.velocity, m.radius_m, WALKS_MPS) for m in o.moving]

    def is_free(speed):
        t_s, x, y, heading, at = STEP_S, 0.0, 0.0, 0.0, speed
        while at > 0.0:
            before, at = at, max(0.0, at - BRAKES_MPS2 * STEP_S) if t_s > late_s else at
            heading += turn * STEP_S
            step = (before + at) / 2.0 * STEP_S
            x, y = x + step * math.cos(heading), y + step * math.sin(heading)
            for aside in (-0.7, 0.0, 0.7):
                edge = x + RADIUS_M * math.cos(heading + aside), y + RADIUS_M * math.sin(heading + aside)
                sector = round(math.atan2(edge[1], edge[0]) / o.radstep) % o.n_bearings
                if math.hypot(*edge) > max(RADIUS_M + NEARER_M, o.ground_seen_to_m[sector]):
                    return False
            for px, py, vx, vy, radius, strays in things:
                away = math.hypot(px + t_s * vx - x, py + t_s * vy - y)
                keep = RADIUS_M + MARGIN_M + MARGIN_S * speed + radius + t_s * strays
                if away < keep and away < math.hypot(px, py) - NEARER_M:
                    return False
            t_s += STEP_S
        return True
    lost = BRAKES_MPS2 * (SWEEP_S + REACTION_S)
    most = min(TOP_SPEED_MPS, math.sqrt(lost * lost + 2.0 * BRAKES_MPS2 * (STEPS_IN_M - RADIUS_M - MARGIN_M)) - lost)
    if is_free(most):
        return most
    free = 0.0
    for _ in range(5):
        between = (free + most) / 2.0
        free, most = (between, most) if is_free(between) else (free, between)
    return free


def main(log, *numbers):
    follower = Follower(zip(map(float, numbers[::2]), map(float, numbers[1::2])))
    for event in read_events(log):
        if event.channel == "OBSTACLES":
            follower.obstacles = obstacles_t.decode(event.data)
        elif event.channel == "POSE":
            follower.pose = pose_t.decode(event.data)
            speed, turn, why_not = follower.command(follower.pose.utime)
            print(f"stop: {why_not}" if why_not else f"drive {speed:.2f} m/s, turn {turn:.2f} rad/s")


if __name__ == "__main__":
    sys.exit(__doc__ if len(sys.argv) < 4 else main(*sys.argv[1:]))
