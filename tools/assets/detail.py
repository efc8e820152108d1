"""Detail tiles: what a surface shows at arm's length, repeated finely over its other textures.

Red and green add to the normal, blue is the relative change of the base colour; each is 0.5 on average, so that far
away nothing changes. Tiles have no large spots: those would show the repeat. Also writes assets/textures/sand_detail.jpg.
"""
from pathlib import Path

import numpy as np
from PIL import Image

import noise as N

OUT = Path(__file__).resolve().parents[2] / "assets" / "textures"
SAND_TILE = 0.31  # metres, not a part of the sand's own tiles


def packed(height, tile, tone, steepest=0.9):
    """Heights in metres over a tile of so many metres, and relative changes of colour, as one image."""
    image = N.normal_map(height, tile, steepest=steepest)
    tone = np.clip(tone - np.median(tone), -0.75, 0.75)
    image[..., 2] = 0.5 + 0.5 * tone
    return np.clip(image + 0.5 - image.mean((0, 1)), 0, 1)


def sand(n=256, tile=SAND_TILE):
    """Grains of 1 to 4 mm, light and dark, single chips of shell among them."""
    height, tone = np.zeros((n, n)), np.zeros((n, n))
    for count, seed, gain in ((2800, 5, 0.55), (900, 6, 1.0)):
        d1, d2, who = N.cells(n, count, seed)
        size = 0.5 / np.sqrt(count)
        of = np.random.default_rng(seed).normal(0, 1, count)[who]
        kept = np.random.default_rng(seed + 9).random(count)[who] < (1.0 if gain < 1 else 0.35)
        dome = np.sqrt(np.clip(1 - (d1 / (1.15 * size)) ** 2, 0, 1)) * kept
        height += gain * 0.55 * size * tile * dome
        tone += kept * (0.11 * of * N.smooth(0.0, 0.5, dome) - 0.16 * (1 - N.smooth(0.0, 0.55, dome)))
    soft, lumps = N.spectral(n, 7, 1.2, 6, 60), N.spectral(n, 9, 0.8, 16, 60)
    chips, chip, of = N.bumps(n, tile, 330, 8, 0.0022, 0.0085)
    height += 0.0007 * soft + 0.0006 * lumps + 0.6 * chip
    foot = np.clip(N.blur(chips, 1.5) - chips, 0, 1)  # sand beside a chip sees less of the sky
    return packed(height, tile, 1.35 * tone + 0.05 * soft + 0.10 * lumps - 0.5 * foot + chips * np.where(of > 0.5, 0.45, -0.42))


def rock(n=256, tile=0.30):
    """Grain, pits and hairs of turf on stone, in drifts."""
    drift = N.spectral(n, 11, 2.6, 4, 40)
    grain, fine = N.spectral(n, 12, 2.2, 10, 120), N.spectral(n, 13, 0.6, 40)
    pits, bowl, _ = N.bumps(n, tile, 420, 14, 0.0014, 0.007, where=N.smooth(-0.8, 1.2, drift))
    knobs, dome, of = N.bumps(n, tile, 260, 15, 0.0015, 0.008, where=N.smooth(-0.8, 1.2, -drift), ragged=0.2 * grain)
    turf = N.smooth(0.2, 1.4, drift) * N.spectral(n, 16, 0.8, 30, 120, stretch=(1, 2.5))
    height = 0.0011 * grain + 0.00022 * fine - 0.8 * bowl + 0.6 * dome + 0.0003 * turf
    hollow = N.blur(height, 5) - height
    tone = 0.12 * grain + 0.07 * fine - 0.26 * N.smooth(0.0002, 0.0026, hollow) - 0.10 * pits
    return packed(height, tile, tone + 0.10 * turf + 0.25 * knobs * (of - 0.4))


def main():
    image = Image.fromarray(np.round(sand() * 255).astype(np.uint8), "RGB")
    image.save(OUT / "sand_detail.jpg", quality=82, subsampling=0)


if __name__ == "__main__":
    main()
