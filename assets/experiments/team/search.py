"""Baseline: the diver sweeps rows from the west; the ROV takes the nearest cell that is not looked at, and prefers the east."""
import math

import numpy as np

SIDE_M, CELL_M, DEPTH_M = 24.0, 1.0, 12.0


class Controller:
    def __init__(self, world, settings, seed):
        self.world, self.s = world, settings
        n = int(SIDE_M / CELL_M)
        middle = (np.arange(n) + 0.5) * CELL_M
        self.cells = np.stack(np.meshgrid(middle, middle, indexing="ij"), -1)  # east, north
        self.by_diver, self.by_rov = np.zeros((n, n), bool), np.zeros((n, n), bool)
        step = 2 * settings["diver_sees_m"] * 0.9
        rows = np.arange(step / 2, SIDE_M, step)
        self.way = [np.array([e, north]) for i, e in enumerate(rows) for north in ((0, SIDE_M) if i % 2 == 0 else (SIDE_M, 0))]
        self.diver, self.last = np.array([self.way[0][0], 0.0]), 0.0
        rng = np.random.Generator(np.random.Philox(key=seed))
        self.jitter = 0.3 * rng.random((n, n))  # another order of equally good cells a seed
        self.goal = None
        world["diver"].pose([*self.diver, -DEPTH_M])

    def act(self, obs, stage):
        time = self.world.time
        self._swim(time - self.last)
        self.last = time
        self.by_diver |= self._sees(self.diver, self.s["diver_sees_m"])
        if self.s["together"]:
            rov = np.array(self.world.truth("rov").position)[:2]
            self.by_rov |= self._sees(rov, self.s["rov_sees_m"])
            self._send(rov)
        seen = self.by_diver | self.by_rov
        return {"covered": float(seen.mean()), "twice": float((self.by_diver & self.by_rov).mean())}

    def _sees(self, at, far):
        return np.hypot(self.cells[..., 0] - at[0], self.cells[..., 1] - at[1]) <= far

    def _swim(self, dt):
        left = 0.3 * dt
        speed = np.zeros(2)
        while self.way and left > 0:
            line = self.way[0] - self.diver
            far = float(np.hypot(*line))
            if far <= left:
                self.diver, left = self.way.pop(0), left - far
            else:
                speed = 0.3 * line / far
                self.diver, left = self.diver + line / far * left, 0.0
        self.world["diver"].pose([*self.diver, -DEPTH_M], velocity=[*speed, 0.0])

    def _send(self, rov):
        known = (self.by_diver | self.by_rov) if self.s["shares"] else self.by_rov
        if self.goal is None or known[self.goal] or np.hypot(*(self.cells[self.goal] - rov)) < 0.5:
            cost = np.hypot(self.cells[..., 0] - rov[0], self.cells[..., 1] - rov[1]) + self.jitter
            cost = cost + 0.5 * (SIDE_M - self.cells[..., 0])  # the diver comes from the west
            cost[known] = math.inf
            if not math.isfinite(cost.min()):
                return
            self.goal = np.unravel_index(int(cost.argmin()), cost.shape)
        to = self.cells[self.goal]
        self.world["rov"].goto(to[0], to[1], -DEPTH_M, math.atan2(to[1] - rov[1], to[0] - rov[0]))
