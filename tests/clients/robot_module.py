#!/usr/bin/env python3
"""A module of the robot, as its author would write it: LCM and the message types are all it needs.

robot_module.cpp is the same in C++.
Usage: robot_module.py [N [TIMEOUT_S]]: ends well once N poses and N times obstacles have come.
       robot_module.py --log LOG: what a recording holds; needs no LCM.
"""
import sys
import time

from voxlist import localisation_t, obstacles_t, pose_t
from voxlist.event_log import read_events

STATES = {
    localisation_t.STATE_LOST: "lost",
    localisation_t.STATE_AMBIGUOUS: "ambiguous",
    localisation_t.STATE_TRACKING: "tracking",
}


class RobotModule:
    def __init__(self):
        self.poses = 0
        self.obstacles = 0
        # By channel: what is called with each message's bytes.
        self.handlers = {
            "POSE": self.on_pose,
            "LOCALISATION": self.on_localisation,
            "OBSTACLES": self.on_obstacles,
        }

    def on_pose(self, data):
        pose = pose_t.decode(data)
        self.poses += 1
        print(f"pose: x {pose.pos[0]:.2f} m, y {pose.pos[1]:.2f} m")

    def on_localisation(self, data):
        found = localisation_t.decode(data)
        print(f"localisation: {STATES.get(found.state, 'lost')}, confidence {found.confidence:.3f}")
        for mode in found.modes:
            x, y, yaw = mode.pose
            print(f"  x {x:.2f} m, y {y:.2f} m, yaw {yaw:.2f} rad: {mode.probability:.3f}")

    def on_obstacles(self, data):
        obstacles = obstacles_t.decode(data)
        self.obstacles += 1
        if obstacles.n_bearings == 0:
            return
        ranges = obstacles.nearest_m[obstacles_t.OBSTACLE]
        nearest = min(ranges)
        bearing = obstacles.rad0 + ranges.index(nearest) * obstacles.radstep
        print(f"nearest obstacle: {nearest:.2f} m at {bearing:.2f} rad")


def read(log):
    module = RobotModule()
    for event in read_events(log):
        if event.channel in module.handlers:
            module.handlers[event.channel](event.data)


def listen(wanted=5, timeout_s=30):
    import lcm

    module = RobotModule()
    bus = lcm.LCM()
    for channel, handler in module.handlers.items():
        bus.subscribe(channel, lambda _, data, handler=handler: handler(data))
    end = time.monotonic() + timeout_s
    while min(module.poses, module.obstacles) < wanted and time.monotonic() < end:
        bus.handle_timeout(100)
    return min(module.poses, module.obstacles) >= wanted


if __name__ == "__main__":
    if sys.argv[1:2] == ["--log"]:
        read(sys.argv[2])
    elif not listen(*map(int, sys.argv[1:])):
        sys.exit(1)
