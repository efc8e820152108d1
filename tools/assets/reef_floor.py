"""Heights of a reef flat with spurs, grooves and sand: reef.npy, float32 [161, 161], cell 0.4 m, y up."""
from pathlib import Path

import numpy as np

import noise as N

OUT = Path(__file__).resolve().parents[2] / "assets" / "terrain"


def main(n=161, cell=0.4):
    z, x = np.meshgrid((np.arange(n) - n // 2) * cell, (np.arange(n) - n // 2) * cell, indexing="ij")
    p = np.column_stack([x.ravel(), 0 * x.ravel(), z.ravel()])
    f = lambda seed, freq, oct_: N.fbm3(p, seed, freq, oct_).reshape(n, n)
    spur = np.cos(2 * np.pi * (x + 2.6 * f(3, 0.07, 2)) / 9.5)
    mound = N.smooth(-0.05, 0.75, spur + 0.55 * f(5, 0.22, 3))
    rise = 4.2 * N.smooth(4.0, -30.0, z)
    clear = N.smooth(2.0, 7.0, np.hypot(x, z - 0.5))  # a basin of sand in front of the camera
    h = rise + clear * mound * (0.95 + 0.5 * f(9, 0.3, 2)) + 0.25 * clear * mound * f(11, 1.1, 3) + 0.07 * f(13, 0.35, 3)
    OUT.mkdir(parents=True, exist_ok=True)
    np.save(OUT / "reef.npy", h.astype("<f4"))


if __name__ == "__main__":
    main()
