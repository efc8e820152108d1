"""A synthetic reef ridge as a heightfield: ridge.npy, float32 [257, 257], metres.

Row r is z = (r - 128) * 0.5, column c is x = (c - 128) * 0.5; the value is the
height above the surrounding plain (y up). 128 x 128 m in all.
"""
from pathlib import Path

import numpy as np

import noise as N

OUT = Path(__file__).resolve().parents[2] / "assets" / "terrain"
CELL, COUNT = 0.5, 257


def main():
    t = (np.arange(COUNT) - COUNT // 2) * CELL
    z, x = np.meshgrid(t, t, indexing="ij")
    p = np.column_stack([x.ravel(), 0 * x.ravel(), z.ravel()])
    warp = 9 * N.fbm3(p, 1, 1 / 40, 3)
    across = p[:, 0] + 0.35 * p[:, 2] + warp
    crest = 9.0 + 3.5 * N.fbm3(p, 2, 1 / 35, 3)
    ridge = crest * np.exp(-((across / 15) ** 2)) + 1.6 * np.exp(-(((across - 34) / 8) ** 2))
    rough = N.smooth(0.8, 5, ridge)
    spur = 1 - np.abs(N.fbm3(p, 5, 1 / 11, 4))
    h = ridge + rough * (2.2 * (spur - 0.6) + 0.5 * N.fbm3(p, 6, 1 / 2.5, 3))
    dune = np.sin((p[:, 0] * 0.8 + p[:, 2] * 0.6) / 12 * 2 * np.pi + 2 * N.fbm3(p, 8, 1 / 20, 2))
    h += (1 - rough) * (0.35 * dune + 0.04 * N.fbm3(p, 9, 1 / 2, 2)) + 0.6 * N.fbm3(p, 10, 1 / 50, 2)
    OUT.mkdir(parents=True, exist_ok=True)
    a = h.reshape(COUNT, COUNT).astype("<f4")
    a -= a.min()
    np.save(OUT / "ridge.npy", a)
    print(f"ridge.npy: {a.shape} {a.min():.2f}..{a.max():.2f} m")


if __name__ == "__main__":
    main()
