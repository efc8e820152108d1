"""A lost diver, who swims towards a lamp in sight, up to diver_speed_m_s, and waits where none is."""
import numpy as np


class Player:
    def __init__(self, world, settings, seed):
        self.world, self.s = world, settings
        self.diver, self.last = np.array([0.0, 0.0, -12.0]), 0.0
        world["diver"].pose(self.diver)

    def act(self, obs, stage, told):
        time, rov = self.world.time, self.world.truth("rov").position
        seen = float(np.linalg.norm(rov - self.diver)) <= self.s["visibility_m"]
        self._swim(rov, seen, time - self.last)
        self.last = time
        return {"seen": float(seen)}

    def _swim(self, rov, seen, dt):
        line = rov - self.diver
        far = float(np.linalg.norm(line))
        speed = np.zeros(3)
        if seen and far > 1.0:
            speed = self.s["diver_speed_m_s"] * line / far
        self.diver = self.diver + speed * dt
        self.world["diver"].pose(self.diver, velocity=speed)
