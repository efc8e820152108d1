"""The tiles of a pool: glazed, 20 cm square, of slightly different blues, with pale joints.

Writes assets/textures/tiles_color.jpg (a repeat every 2 m).
"""
from pathlib import Path

import numpy as np
from PIL import Image

import noise as N

TEXTURES = Path(__file__).resolve().parents[2] / "assets" / "textures"
GLAZE, JOINT = (0.60, 0.80, 0.85), (0.86, 0.90, 0.90)
REPEAT_M, TILE_M, PIXELS = 2.0, 0.2, 1024


def tiles():
    """Colour, sRGB, 0 to 1, tileable."""
    across = round(REPEAT_M / TILE_M)
    at = (np.arange(PIXELS) + 0.5) / PIXELS * across
    u, v = np.meshgrid(at % 1, at % 1)
    edge_m = np.minimum(np.minimum(u, 1 - u), np.minimum(v, 1 - v)) * TILE_M
    joint = N.smooth(0.005, 0.002, edge_m)
    rng = np.random.default_rng(4)
    cell = at.astype(int)
    tone = rng.normal(0, 0.022, (across, across))[cell][:, cell]
    hue = rng.normal(0, 0.008, (across, across, 3))[cell][:, cell]
    color = N.flat(PIXELS, GLAZE) * (1 + tone[..., None]) + hue
    color *= 1 + 0.012 * N.spectral(PIXELS, 5, 1.5, 12)[..., None]
    grime = N.smooth(-0.5, 2.0, N.spectral(PIXELS, 6, 2.0, 2))
    color = N.mix(color, N.flat(PIXELS, JOINT) * (1 - 0.15 * grime[..., None]), joint)
    return np.clip(color, 0, 1)


def main():
    TEXTURES.mkdir(exist_ok=True)
    picture = Image.fromarray(np.round(255 * tiles()).astype(np.uint8))
    picture.save(TEXTURES / "tiles_color.jpg", quality=85, subsampling=0)


if __name__ == "__main__":
    main()
