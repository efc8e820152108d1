"""The diver works at depth and runs out of gas; from then on the breath lasts breath_s at most. The ROV carries a bottle with a
second regulator on a hose. The diver sees its lamp up to the visibility, swims to it, takes the regulator at a hand's reach and
breathes; holds on to it (hose_m at most away) and follows up. Where the ROV rises faster than the diver may, the hose tears
out. Before the emergency the diver stays with his work: unless the ROV warns (warn = 1), which gives him the time to
come to meet it.

Rules, not physiology: nobody here becomes unconscious by degrees; a breath that has ended is a failure."""
import math

import numpy as np


class Player:
    def __init__(self, world, settings, seed):
        self.world, self.s = world, settings
        rng = np.random.Generator(np.random.Philox(key=seed))
        way = rng.uniform(-math.pi, math.pi)
        self.diver = np.array([settings["apart_m"] * math.cos(way), settings["apart_m"] * math.sin(way), -12.0])
        self.breath, self.on, self.last, self.used = settings["breath_s"], False, 0.0, 0.0
        self.breathing, self.rate, self.fastest = rng.uniform(0, 2 * math.pi), 0.0, 0.0

    def act(self, obs, stage, told):
        s, time = self.s, self.world.time
        dt, self.last = time - self.last, time
        rov = np.array(self.world.truth("rov").position)
        line = rov - self.diver
        far = float(np.linalg.norm(line))
        empty = time >= s["empty_at_s"]
        gauge = max(0.0, 1.0 - time / s["empty_at_s"])  # the share of gas left, which the diver's computer tells the ROV
        speed, seen = np.zeros(3), far <= s["visibility_m"]
        if self.on and far > s["hose_m"]:
            self.on = False
        if not self.on and empty and far <= 0.8:
            self.on = True
        if empty and not self.on:
            self.breath -= dt
            self.used += dt
        if self.on:
            self.breath = min(s["breath_s"], self.breath + dt)
            if far > 0.6:  # holds on, and rises no faster than 0.3 m/s
                speed = line / far * min(0.5, 1.0 * (far - 0.6))
                speed[2] = np.clip(speed[2], -0.3, 0.3)
        elif seen and far > 0.7 and (empty or told.get("warn", 0.0) > 0.5):
            speed = line / far * (0.4 if empty else 0.25)
        self.diver = self.diver + speed * dt
        self.diver[2] = min(self.diver[2], -0.3)
        self.rate += (speed[2] - self.rate) * min(1.0, dt / 5.0)  # over 5 s, as computers do
        self.fastest = max(self.fastest, self.rate)
        yaw = math.atan2(line[1], line[0])
        self.world["diver"].pose(self.diver, [0, 0, math.sin(yaw / 2), math.cos(yaw / 2)], velocity=speed)
        self.world["thing"].pose(rov + np.array([0, 0, -0.35]), velocity=[0, 0, 0])
        return {"gauge": gauge, "empty": float(empty), "on": float(self.on), "breath_left_s": self.breath, "no_gas_s": self.used,
                "fastest_m_min": 60.0 * self.fastest}
