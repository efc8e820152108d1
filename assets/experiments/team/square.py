"""Plays a diver who sweeps the rows of a square from the west, and keeps which cells the diver and the ROV have looked at."""
import numpy as np

SIDE_M, CELL_M, DEPTH_M = 24.0, 1.0, 12.0


class Player:
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
        world["diver"].pose([*self.diver, -DEPTH_M])

    def act(self, obs, stage, told):
        time = self.world.time
        self._swim(time - self.last)
        self.last = time
        self.by_diver |= self._sees(self.diver, self.s["diver_sees_m"])
        if self.s["together"]:
            self.by_rov |= self._sees(np.array(self.world.truth("rov").position)[:2], self.s["rov_sees_m"])
        return {"covered": float((self.by_diver | self.by_rov).mean()), "twice": float((self.by_diver & self.by_rov).mean())}

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
