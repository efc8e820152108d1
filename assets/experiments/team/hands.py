"""The diver works at a place, swaying, and holds out a hand. The tool lies on a rack; the ROV's gripper, grip_ahead_m before its
middle, holds it once it has closed (the controller tells grip = 1) within reach_m of it, and lets go when it opens. The
diver takes the tool at a hand's reach if it comes slowly enough; a tool that nobody holds sinks.

Limit: the tool's weight does not pull at the ROV: some 5 N in water are within what its thrusters carry, and are left out."""
import math

import numpy as np


class Player:
    def __init__(self, world, settings, seed):
        self.world, self.s = world, settings
        rng = np.random.Generator(np.random.Philox(key=seed))
        way, far = rng.uniform(-math.pi, math.pi), rng.uniform(4.0, settings["rack_m"])
        self.rack = np.array([far * math.cos(way), far * math.sin(way), -12.5])
        self.tool, self.holder, self.last, self.moves = self.rack.copy(), "rack", 0.0, np.zeros(3)
        self.phase, self.drops = rng.uniform(0, 2 * math.pi, 3), 0

    def act(self, obs, stage, told):
        time = self.world.time
        dt, self.last = time - self.last, time
        sway = self.s["sway_m"] * np.sin(2 * math.pi * time / np.array([7.0, 9.0, 11.0]) + self.phase)
        diver = np.array([0.0, 0.0, -12.0]) + sway
        speed = self.s["sway_m"] * 2 * math.pi / np.array([7.0, 9.0, 11.0]) * np.cos(2 * math.pi * time / np.array([7.0, 9.0, 11.0]) + self.phase)
        rov = self.world.truth("rov")
        way = np.array(rov.position) - diver
        yaw = math.atan2(way[1], way[0])
        hand = diver + 0.6 * np.array([math.cos(yaw), math.sin(yaw), -0.2])
        grip, closed = gripper(rov, self.s["grip_ahead_m"]), told.get("grip", 0.0) > 0.5
        before = self.tool.copy()
        if self.holder in ("rack", "floor") and closed and np.linalg.norm(grip - self.tool) < self.s["reach_m"]:
            self.holder = "rov"
        elif self.holder == "rov" and np.linalg.norm(hand - grip) < self.s["reach_m"] and np.linalg.norm(self.moves - speed) < 0.15:
            self.holder = "diver"
        elif self.holder == "rov" and not closed:
            self.holder, self.drops = "sinking", self.drops + 1
        if self.holder == "rov":
            self.tool = grip
        elif self.holder == "diver":
            self.tool = hand
        elif self.holder == "sinking":
            self.tool = self.tool - np.array([0, 0, 0.5 * dt])
            if self.tool[2] < -16:
                self.holder = "floor"
        if dt > 0:
            self.moves = (self.tool - before) / dt
        self.world["diver"].pose(diver, [0, 0, math.sin(yaw / 2), math.cos(yaw / 2)], velocity=speed)
        self.world["thing"].pose(self.tool, velocity=[0, 0, 0])
        return {"held": float(self.holder == "rov"), "delivered": float(self.holder == "diver"), "drops": float(self.drops),
                "hand_east": hand[0], "hand_north": hand[1], "hand_up": hand[2]}


def gripper(truth, ahead_m):
    x, y, z, w = truth.orientation
    ahead = np.array([1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)])
    return np.array(truth.position) + ahead_m * ahead
