"""Baseline: drives the gripper to the tool, closes it, waits a moment, drives it slowly to the diver's hand. Near its goal it
comes no faster than slow_m_s, so that the hand can take what it brings."""
import math

import numpy as np


class Controller:
    def __init__(self, world, settings, seed):
        self.world, self.s = world, settings
        self.rov, self.goal = world["rov"], None

    def act(self, obs, stage):
        tool, rov = (np.array(self.world.truth(n).position) for n in ("thing", "rov"))
        if self.told.get("delivered"):
            away = rov - np.array([0.0, 0.0, -12.0])
            away[2] = 0.0
            self.rov.goto(*(np.array([0.0, 0.0, -12.0]) + 3.0 * away / max(float(np.linalg.norm(away)), 1e-9)), self.yaw)
            return {"grip": 0.0}
        if self.told.get("held"):
            target, near, close = np.array([self.told[f"hand_{w}"] for w in ("east", "north", "up")]), self.s["slow_m_s"], True
        else:
            target, near, close = tool, 0.3, np.linalg.norm(self._grip() - tool) < 0.8 * self.s["reach_m"]
        line = target - rov
        self.yaw = math.atan2(line[1], line[0])
        wanted = target - self.s["grip_ahead_m"] * np.array([math.cos(self.yaw), math.sin(self.yaw), 0.0])
        wanted = wanted if self.told.get("held") else self._round(np.array(self.world.truth("diver").position), self.goal, wanted)
        # The goal moves to where it is wanted, fast from afar, slowly near.
        self.goal = rov if self.goal is None else self.goal
        off = wanted - self.goal
        far = float(np.linalg.norm(off))
        speed = min(0.6, near + 0.6 * max(0.0, far - 0.4))
        step = min(far, speed / 20.0)
        moves = off / max(far, 1e-9) * step
        self.goal = self.goal + moves
        self.rov.goto(*self.goal, self.yaw, velocity=moves * 20.0)
        return {"grip": float(close)}

    def _round(self, diver, at, wanted, clear=1.6):
        """A point beside the diver while the straight way would pass him nearer than that."""
        if at is None or np.linalg.norm(wanted - at) < 1e-6:
            return wanted
        way = wanted - at
        along = float((diver - at) @ way / (way @ way))
        off = at + along * way - diver
        off[2] = 0.0
        if not 0 < along < 1 or np.linalg.norm(off) >= clear:
            return wanted
        off = off if np.linalg.norm(off) > 0.05 else np.array([-way[1], way[0], 0.0])
        return diver + 1.3 * clear * off / float(np.linalg.norm(off))

    def _grip(self):
        t = self.world.truth("rov")
        x, y, z, w = t.orientation
        return np.array(t.position) + self.s["grip_ahead_m"] * np.array(
            [1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)])
