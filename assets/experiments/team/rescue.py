"""Baseline: watches the diver's gauge, comes near and warns while it is low; once it is empty comes to the diver's reach, waits
until he breathes, then rises with him at rise_m_min, stops for stop_s at 5 m and waits whenever he falls behind."""
import math

import numpy as np


class Controller:
    def __init__(self, world, settings, seed):
        self.world, self.s = world, settings
        self.rov, self.goal, self.last, self.stopped = world["rov"], None, 0.0, 0.0

    def act(self, obs, stage):
        told, time = self.told, self.world.time
        dt, self.last = time - self.last, time
        diver, rov = (np.array(self.world.truth(n).position) for n in ("diver", "rov"))
        line = diver - rov
        yaw = math.atan2(line[1], line[0])
        warn = told["gauge"] < self.s["warn_share"]
        if not told["on"]:
            self.goal = None
            off = rov - diver
            off = off / max(float(np.linalg.norm(off)), 1e-9)
            near = 0.6 if told["empty"] else 1.5
            if told["empty"] or warn:
                self.rov.goto(*(diver + near * off), yaw)
            return {"warn": float(warn)}
        # Ascends from where the diver took the regulator, and waits where he falls behind.
        self.goal = rov.copy() if self.goal is None else self.goal
        behind = float(np.linalg.norm(line)) > 1.0
        at_stop = -5.2 < self.goal[2] < -4.8 and self.stopped < self.s["stop_s"]
        rise = 0.0 if behind or at_stop else self.s["rise_m_min"] / 60.0
        self.stopped += dt if at_stop else 0.0
        self.goal[2] = min(self.goal[2] + rise * dt, -0.5)
        self.rov.goto(*self.goal, yaw, velocity=[0.0, 0.0, rise])
        return {"warn": 0.0}
