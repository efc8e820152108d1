"""Baseline: drives the gripper to the tool, closes it, comes slowly from the side of the diver's right hand, and backs off once the diver has it.
Near its goal it comes no faster than slow_m_s, so that the hand can take what it brings."""
import math

import numpy as np


class Controller:
    def __init__(self, world, settings, seed):
        self.world, self.s = world, settings
        self.rov, self.goal, self.yaw, self.asked, self.left = world["rov"], None, 0.0, None, None

    def act(self, obs, stage):
        diver, tool, rov = (np.array(self.world.truth(n).position) for n in ("diver", "tool", "rov"))
        grip = obs.get("rov/gripper")
        if grip is None:
            return {}
        ahead = np.array(grip.position) - rov
        if self.told.get("delivered"):
            self._grip("auto")
            away = rov - diver
            away[2] = 0.0
            self.left = rov + 1.5 * away / max(float(np.linalg.norm(away)), 1e-9) if self.left is None else self.left
            self.rov.goto(*self.left, self.yaw)
            return {}
        if self.told.get("held"):
            target, near = np.array([self.told[f"hand_{w}"] for w in ("east", "north", "up")]), self.s["slow_m_s"]
        else:
            target, near = tool, 0.2
        self._grip("close")
        side = self._right_of_diver()
        aside = rov - diver
        aside[2] = 0.0
        if self.told.get("held") and aside @ side < 0.6 * np.linalg.norm(aside):
            target = target + 1.6 * side  # first to the side where the hand is
        line = target - rov
        self.yaw = math.atan2(line[1], line[0])
        wanted = target - np.array([0.45 * math.cos(self.yaw), 0.45 * math.sin(self.yaw), ahead[2]])
        wanted = self._round(diver, self.goal, wanted)
        # The goal moves to where it is wanted, fast from afar, slowly near.
        self.goal = rov if self.goal is None else self.goal
        off = wanted - self.goal
        far = float(np.linalg.norm(off))
        speed = min(0.5, near + 0.5 * max(0.0, far - 0.5))
        step = min(far, speed / 20.0)
        moves = off / max(far, 1e-9) * step
        self.goal = self.goal + moves
        self.rov.goto(*self.goal, self.yaw, velocity=moves * 20.0)
        return {}

    def _right_of_diver(self):
        x, y, z, w = self.world.truth("diver").orientation
        right = -np.array([2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 0.0])
        return right / max(float(np.linalg.norm(right)), 1e-9)

    def _grip(self, choice):
        if choice != self.asked:
            self.rov.grip(choice)
            self.asked = choice

    def _round(self, diver, at, wanted, clear=1.8):
        """A point beside the diver while the straight way would pass him nearer than that."""
        if at is None or np.linalg.norm(wanted - at) < 1e-6:
            return wanted
        way = wanted - at
        along = float((diver - at) @ way / (way @ way))
        off = at + along * way - diver
        off[2] = 0.0
        if not 0 < along < 1 or np.linalg.norm(off) >= 0.7 * clear:
            return wanted
        off = off if np.linalg.norm(off) > 0.05 else np.array([-way[1], way[0], 0.0])
        return diver + 1.3 * clear * off / float(np.linalg.norm(off))
