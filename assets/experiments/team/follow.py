"""Baseline: beside the diver, at a distance that falls with the rates of breath and heart, facing the diver."""
import math

import numpy as np


class Controller:
    def __init__(self, world, settings, seed):
        self.world, self.s = world, settings
        self.rov = world["rov"]
        self.way = math.radians(settings["side_deg"])  # of the ROV about the diver, from the diver's way to port
        self.course = None

    def act(self, obs, stage):
        if "diver/motion" not in obs:
            return
        diver = obs["diver/motion"]
        part = 0.5 * _share(diver.breath_bpm, 10.0, 25.0) + 0.5 * _share(diver.heart_bpm, 60.0, 140.0)
        wanted = self.s["rest_m"] + part * (self.s["near_m"] - self.s["rest_m"])
        at, speed = np.array(diver.position), self._world_speed(diver)
        if np.hypot(*speed[:2]) > 0.1:
            course = math.atan2(speed[1], speed[0])
            if self.course is None:
                self.course = course
            # Turns slowly, so that the diver's sway does not swing the ROV about.
            off = (course - self.course + math.pi) % (2 * math.pi) - math.pi
            self.course += 0.02 * off
        about = (self.course or -math.pi / 2) + self.way
        place = at + wanted * np.array([math.cos(about), math.sin(about), 0.0])
        velocity = speed if self.s["look_ahead"] else np.zeros(3)
        self.rov.goto(*place, math.atan2(at[1] - place[1], at[0] - place[0]), velocity=velocity)

    def _world_speed(self, diver):
        x, y, z, w = diver.orientation
        turn = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                         [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                         [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
        return turn @ np.array(diver.linear_velocity)


def _share(rate, rest, fast):
    """Where a rate lies from rest, 0, to fast, 1; 0 where it is not known."""
    return min(1.0, max(0.0, (rate - rest) / (fast - rest))) if math.isfinite(rate) else 0.0
