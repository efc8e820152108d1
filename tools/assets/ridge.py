"""A reef ridge as heightfields: ridge.npy and seabed.npy, float32 [257, 257], metres.

Row r is z = (r - 128) * 0.5, column c is x = (c - 128) * 0.5; the value is the
height above the lowest place (y up). 128 x 128 m in all. ridge.npy stands on a
plain of its own, seabed.npy on the measured relief of jd211_crop.asc: a survey by
multibeam sonar in cells of 2 m, rows from north to south, elevations in metres.
"""
from pathlib import Path

import numpy as np

import noise as N

OUT = Path(__file__).resolve().parents[2] / "assets" / "terrain"
CELL, COUNT, SURVEY_CELL = 0.5, 257, 2.0


def finer(rows, at):
    """rows at the fractional indices at: cubics through the rows with even tangents (Catmull and Rom 1974)."""
    i = np.floor(at).astype(int)
    t = (at - i)[:, None]
    a, b, c, d = (rows[i + k] for k in (-1, 0, 1, 2))
    return b + t / 2 * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)))


def survey():
    """The survey's elevations over its mean, [COUNT, COUNT]."""
    path = OUT / "jd211_crop.asc"
    cells = np.loadtxt(path, skiprows=6)
    at = 1 + np.arange(COUNT) * CELL / SURVEY_CELL
    h = finer(finer(cells, at).T, at).T
    return h - h.mean()


def save(name, h):
    a = h.reshape(COUNT, COUNT).astype("<f4")
    a -= a.min()
    np.save(OUT / name, a)
    print(f"{name}: {a.shape} {a.min():.2f}..{a.max():.2f} m")


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
    ripple = 0.04 * N.fbm3(p, 9, 1 / 2, 2)  # finer than the survey's cells
    OUT.mkdir(parents=True, exist_ok=True)
    save("ridge.npy", h + (1 - rough) * (0.35 * dune + ripple) + 0.6 * N.fbm3(p, 10, 1 / 50, 2))
    save("seabed.npy", h + (1 - rough) * ripple + survey().ravel())


if __name__ == "__main__":
    main()
