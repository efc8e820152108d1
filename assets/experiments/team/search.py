"""Baseline: the ROV takes the nearest cell that is not looked at, and prefers the east: the diver comes from the west."""
import math

import numpy as np

from square import DEPTH_M, SIDE_M


class Controller:
    def __init__(self, world, settings, seed):
        self.world, self.s, self.goal = world, settings, None
        rng = np.random.Generator(np.random.Philox(key=seed))
        n = int(SIDE_M)
        self.jitter = 0.3 * rng.random((n, n))  # another order of equally good cells a seed

    def act(self, obs, stage):
        if self.s["together"]:
            self._send(np.array(self.world.truth("rov").position)[:2])

    def _send(self, rov):
        square = self.player
        known = (square.by_diver | square.by_rov) if self.s["shares"] else square.by_rov
        cells = square.cells
        if self.goal is None or known[self.goal] or np.hypot(*(cells[self.goal] - rov)) < 0.5:
            cost = np.hypot(cells[..., 0] - rov[0], cells[..., 1] - rov[1]) + self.jitter
            cost = cost + 0.5 * (SIDE_M - cells[..., 0])
            cost[known] = math.inf
            if not math.isfinite(cost.min()):
                return
            self.goal = np.unravel_index(int(cost.argmin()), cost.shape)
        to = cells[self.goal]
        self.world["rov"].goto(to[0], to[1], -DEPTH_M, math.atan2(to[1] - rov[1], to[0] - rov[0]))
