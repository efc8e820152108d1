"""Keeps a vehicle 2 m beside a diver, from what the diver's instruments send: 0.2 s late, a tenth lost."""

import sys
from pathlib import Path

import numpy as np

import neritic

SCENE = str(Path(__file__).resolve().parents[3] / "assets/scenes/dive.toml")


def main(scene: str = SCENE, seconds: float = 20.0) -> float:
    world = neritic.open(scene, seed=1)
    diver = next(a for a in world.agents.values() if isinstance(a, neritic.Diver))
    rov = next(a for a in world.agents.values() if isinstance(a, neritic.Vehicle))
    world.link(f"{diver.name}/motion", delay=0.2, jitter=0.05, loss=0.1)
    while world.time < seconds:
        obs = world.tick(24)
        if f"{diver.name}/motion" not in obs:
            continue
        seen = obs[f"{diver.name}/motion"]
        x, y, z = seen.position
        # To the left of where the diver is, facing the diver.
        ahead = rotate(seen.orientation, (1.0, 0.0, 0.0))
        yaw = np.arctan2(ahead[1], ahead[0])
        rov.goto(x - 2 * np.sin(yaw), y + 2 * np.cos(yaw), z, yaw - np.pi / 2,
                 rotate(seen.orientation, seen.linear_velocity))
    off = np.linalg.norm(world.truth(rov.name).position - world.truth(diver.name).position)
    print(f"{world.time:.1f} s: {off:.2f} m from the diver")
    return float(off)


def rotate(quaternion, vector):
    """The vector, turned by a quaternion x, y, z, w."""
    q, w = np.asarray(quaternion)[:3], quaternion[3]
    t = 2.0 * np.cross(q, vector)
    return vector + w * t + np.cross(q, t)


if __name__ == "__main__":
    main(*sys.argv[1:])
