"""The diver hovers and looks at one spot after the other, about himself and a little up and down; each for dwell_s."""
import math

import numpy as np


class Player:
    def __init__(self, world, settings, seed):
        self.world, self.s = world, settings
        self.rng = np.random.Generator(np.random.Philox(key=seed))
        self.spots, way = [], self.rng.uniform(-math.pi, math.pi)
        for _ in range(int(settings["spots"])):
            way += self.rng.choice([-1, 1]) * math.radians(self.rng.uniform(20, settings["turn_deg"]))
            far, up = self.rng.uniform(2.0, settings["farthest_m"]), self.rng.uniform(-0.8, 0.8)
            self.spots.append(np.array([far * math.cos(way), far * math.sin(way), -12.0 + up]))

    def act(self, obs, stage, told):
        k = min(int(self.world.time / self.s["dwell_s"]), len(self.spots) - 1)
        spot = self.spots[k]
        yaw = math.atan2(spot[1], spot[0])
        self.world["diver"].pose([0.0, 0.0, -12.0], [0, 0, math.sin(yaw / 2), math.cos(yaw / 2)], velocity=[0, 0, 0])
        self.world["thing"].pose(spot, velocity=[0, 0, 0])
        return {"look": float(k), "looked_s": self.world.time - k * self.s["dwell_s"]}
