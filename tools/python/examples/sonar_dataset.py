"""Writes sonar images with the true pose of each, while a vehicle flies its mission."""

import sys
from pathlib import Path

import numpy as np

import neritic

SCENE = str(Path(__file__).resolve().parents[3] / "assets/scenes/mission.toml")


def main(scene: str = SCENE, out: str = "out/sonar_dataset", images: int = 5) -> int:
    world = neritic.open(scene, seed=1)
    stream = next(s.name for s in world.streams if s.kind == "echoes")
    folder = Path(out)
    folder.mkdir(parents=True, exist_ok=True)
    taken = []

    def take(image: neritic.Image) -> None:
        np.savez_compressed(folder / f"{image.sequence:05d}.npz", echoes=image.pixels, stamp=image.stamp,
                            position=image.position, orientation=image.orientation,
                            range_limits=image.range_limits, azimuth_limits=image.azimuth_limits)
        taken.append(image.sequence)

    world.images(stream, rate=2.0, keep=True)
    world.on(stream, take)
    while len(taken) < int(images):
        world.tick(60)
    print(f"{len(taken)} images in {folder}")
    return len(taken)


if __name__ == "__main__":
    main(*sys.argv[1:])
