"""Baseline: beside the diver's line of sight, stand_m from the spot, turned to it: the lamp meets the spot from the side, so
that neither glare nor the ROV's own body is in the diver's eyes. It stays on the side of the line on which it is."""
import math

import numpy as np


class Controller:
    def __init__(self, world, settings, seed):
        self.world, self.s = world, settings
        self.rov = world["rov"]

    def act(self, obs, stage):
        truth = self.world.truth
        diver, spot, rov = (np.array(truth(n).position) for n in ("diver", "thing", "rov"))
        sight = spot - diver
        ahead = sight / max(float(np.linalg.norm(sight)), 1e-9)
        left = np.array([-ahead[1], ahead[0], 0.0]) / max(float(np.hypot(*ahead[:2])), 1e-9)
        side = 1.0 if (rov - diver) @ left >= 0 else -1.0
        aside = math.radians(self.s["aside_deg"])
        place = spot + self.s["stand_m"] * (side * math.sin(aside) * left - math.cos(aside) * ahead)
        place[2] = spot[2]
        # Round the diver, not through: a way point beside him while he is between.
        way = place - rov
        along = float((diver - rov) @ way) / max(float(way @ way), 1e-9)
        if 0 < along < 1 and np.linalg.norm(rov + along * way - diver) < self.s["clear_m"]:
            off = rov + along * way - diver
            off = off / max(float(np.linalg.norm(off)), 1e-9) if np.linalg.norm(off) > 0.05 else left * side
            place = diver + 1.5 * self.s["clear_m"] * off
        look = spot - rov
        self.rov.goto(*place, math.atan2(look[1], look[0]))
