"""Coarse reef sand: assets/textures/coarse_sand_color.jpg and _normal.jpg, a repeat every 4 m.

Faint ripples that fork, turn and die out in patches; grains, bits of shell and coral, dark films of algae.
"""
from pathlib import Path

import numpy as np
from PIL import Image

import noise as N
from seabed import ripples

OUT = Path(__file__).resolve().parents[2] / "assets" / "textures"
TILE = 4.0


def sand(n=1024):
    zf = ripples(n, 19, 15, 0.34, 0.55)
    amp = np.abs(zf) / np.abs(zf).mean()
    crest = N.blur(np.cos(np.angle(zf)), 2.5) * N.smooth(0.25, 1.2, amp)
    patch = N.smooth(-0.9, 1.0, N.spectral(n, 21, 3.0, 1, 5))
    crest = crest * (0.12 + 0.88 * patch)
    soft, mid = N.spectral(n, 22, 2.6, 1, 30), N.spectral(n, 23, 1.2, 14, 160)
    f = N.spectral(n, 24, 0.2, 110)
    col = N.mix(N.flat(n, (0.66, 0.60, 0.50)), (0.76, 0.71, 0.61), N.smooth(-1.3, 1.3, 0.55 * crest + 0.5 * mid + 0.5 * soft))
    film = N.smooth(0.5, 1.8, N.spectral(n, 25, 2.2, 2) + 0.3 * mid - 0.3 * crest)
    col = N.mix(col, (0.50, 0.49, 0.36), 0.50 * film)
    col *= (1 + 0.05 * mid + 0.075 * f)[..., None]
    col = N.mix(col, (0.92, 0.90, 0.85), 0.8 * N.smooth(2.0, 3.0, f))
    col = N.mix(col, (0.22, 0.20, 0.18), 0.7 * N.smooth(2.1, 3.1, -f))
    h = 0.0045 * crest + 0.010 * soft + 0.0012 * mid + 0.0005 * f
    for count, seed, low, high in ((320, 26, 0.0028, 0.0022), (110, 27, 0.0050, 0.0042)):
        d1, _, who = N.cells(n, count, seed)
        size = np.random.default_rng(seed).random(count)[who]
        tone = np.random.default_rng(seed + 1).random(count)[who]
        bit = N.smooth(low, high, d1 / (0.35 + size) * (1 + 0.25 * mid)) * (size > 0.3)
        col = N.mix(col, np.stack([0.55 + 0.38 * tone, 0.52 + 0.37 * tone, 0.45 + 0.36 * tone], 2), 0.85 * bit)
        h = h + 0.0035 * bit
    return np.clip(col, 0, 1), N.normal_map(h, TILE)


def main():
    c, nm = sand()
    for name, image, quality in (("color", c, 76), ("normal", nm, 72)):
        Image.fromarray(np.round(image * 255).astype(np.uint8), "RGB").save(OUT / f"coarse_sand_{name}.jpg", quality=quality, subsampling=0)


if __name__ == "__main__":
    main()
