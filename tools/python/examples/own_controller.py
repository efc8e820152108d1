"""Holds a depth with a controller of its own: pressure in, thruster forces out, 50 times a second."""

import sys
from pathlib import Path

import numpy as np

import neritic

WANTED_DEPTH_M = 15.0

SCENE = str(Path(__file__).resolve().parents[3] / "assets/scenes/mission_measured.toml")


def main(scene: str = SCENE, seconds: float = 25.0) -> float:
    world = neritic.open(scene, seed=1)
    rov = next(a for a in world.agents.values() if isinstance(a, neritic.Vehicle))
    steps = round(0.02 / world.step_s)
    slow = sum_m_s = 0.0
    last_m = None
    while world.time < seconds:
        depth_m = world.tick(steps)[f"{rov.name}/pressure"].depth_m
        rate = 0.0 if last_m is None else (depth_m - last_m) / (steps * world.step_s)
        last_m = depth_m
        slow += 0.1 * (rate - slow)  # the sensor's noise
        error_m = depth_m - WANTED_DEPTH_M
        sum_m_s = float(np.clip(sum_m_s + error_m * steps * world.step_s, -2.0, 2.0))
        up_n = np.clip(40.0 * error_m + 60.0 * slow + 8.0 * sum_m_s, -60.0, 60.0)
        forces = np.zeros(len(rov.thruster_n))
        forces[4:] = up_n / 4  # the vertical ones
        rov.thrusters(forces)
    off = -world.truth(rov.name).position[2] - WANTED_DEPTH_M
    print(f"{world.time:.1f} s: {off:+.3f} m from {WANTED_DEPTH_M} m")
    return float(off)


if __name__ == "__main__":
    main(*sys.argv[1:])
