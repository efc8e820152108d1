"""Baseline: goes to the diver, then keeps lead_m ahead on the way to the line, and never farther than the diver follows."""
import math

import numpy as np

LINE = np.array([0.0, 25.0, -12.0])


class Controller:
    def __init__(self, world, settings, seed):
        self.world, self.s = world, settings
        self.rov_start = np.array([settings["start_east_m"], 0.0, -12.0])

    def act(self, obs, stage):
        diver = self.player.diver  # by a transponder
        way = LINE - diver
        ahead = way / max(float(np.linalg.norm(way)), 1e-9)
        if stage == "find":
            # Fetches the diver from where the ROV was: first to the side it came from.
            goal = diver + 1.5 * ahead if self.world.time > 5 else self.rov_start
        else:
            goal = diver + min(self.s["lead_m"], 0.8 * self.s["visibility_m"], float(np.linalg.norm(way))) * ahead
        self.world["rov"].goto(*goal, math.atan2(ahead[1], ahead[0]))
