"""Baseline: goes to the diver, then keeps lead_m ahead on the way to the line, and never farther than the diver follows.
It also plays the diver, who swims towards a lamp in sight."""
import math

import numpy as np

LINE = np.array([0.0, 25.0, -12.0])


class Controller:
    def __init__(self, world, settings, seed):
        self.world, self.s = world, settings
        self.diver = np.array([0.0, 0.0, -12.0])
        self.rov_start = np.array([settings["start_east_m"], 0.0, -12.0])
        self.last = 0.0
        world["diver"].pose(self.diver)

    def act(self, obs, stage):
        time, rov = self.world.time, self.world.truth("rov").position  # a lamp and a transponder: both know places
        seen = float(np.linalg.norm(rov - self.diver)) <= self.s["visibility_m"]
        self._swim(rov, seen, time - self.last)
        self.last = time
        way = LINE - self.diver
        ahead = way / max(float(np.linalg.norm(way)), 1e-9)
        if stage == "find":
            # Fetches the diver from where the ROV was: first to the side it came from.
            goal = self.diver + 1.5 * ahead if time > 5 else self.rov_start
        else:
            goal = self.diver + min(self.s["lead_m"], 0.8 * self.s["visibility_m"], float(np.linalg.norm(way))) * ahead
        self.world["rov"].goto(*goal, math.atan2(ahead[1], ahead[0]))
        return {"seen": float(seen)}

    def _swim(self, rov, seen, dt):
        line = rov - self.diver
        far = float(np.linalg.norm(line))
        speed = np.zeros(3)
        if seen and far > 1.0:
            speed = self.s["diver_speed_m_s"] * line / far
        self.diver = self.diver + speed * dt
        self.world["diver"].pose(self.diver, velocity=speed)
