"""Flies a square of 2 m and says how far off each corner it was."""

import sys
from pathlib import Path

import neritic

SCENE = str(Path(__file__).resolve().parents[3] / "assets/scenes/mission.toml")


def main(scene: str = SCENE) -> float:
    world = neritic.open(scene, seed=1)
    rov = world["rov"]
    x, y, z = world.truth("rov").position
    worst = 0.0
    for dx, dy in [(2, 0), (2, 2), (0, 2), (0, 0)]:
        rov.goto(x + dx, y + dy, z)
        world.tick(round(12 / world.step_s))
        there = world.truth("rov").position
        worst = max(worst, abs(there - (x + dx, y + dy, z)).max())
        print(f"{world.time:5.1f} s: {there.round(2)}")
    return worst


if __name__ == "__main__":
    main(*sys.argv[1:])
