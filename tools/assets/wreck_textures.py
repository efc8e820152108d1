"""Textures of the wreck: hull side strip, casing deck, corroded steel."""
import numpy as np

import noise as N

PAINT, RUST, DARK, ORANGE = (0.38, 0.40, 0.40), (0.44, 0.25, 0.15), (0.27, 0.17, 0.12), (0.60, 0.35, 0.17)
CRUST, ALGAE, SILT = (0.60, 0.58, 0.50), (0.33, 0.38, 0.22), (0.70, 0.64, 0.52)


def corroded(n, seed, paint=0.5):
    """Colour, roughness and height (0..1) of corroded steel, n square, tileable."""
    a, b, c = (N.spectral(n, seed + k, 2.5, 1.5) for k in range(3))
    fine = N.spectral(n, seed + 9, 1.0, 24)
    col = N.mix(N.flat(n, DARK), RUST, N.smooth(-1.2, 1.0, a + 0.4 * fine))
    col = N.mix(col, ORANGE, 0.55 * N.smooth(0.6, 1.8, b + 0.3 * fine))
    film = N.smooth(-0.22, 0.22, c + 0.14 * fine + (paint - 0.5) * 3)
    col = N.mix(col, np.asarray(PAINT) * 1.0, film * 0.85)
    height = 0.35 * film + 0.12 * a + 0.10 * fine * (1 - film) * 0.6
    d1, _, who = N.cells(n, 260, seed + 20)
    size = np.random.default_rng(seed).random(260)[who] ** 3
    blob = N.smooth(0.035, 0.0, d1 / (0.25 + size)) * N.smooth(-0.2, 0.8, N.spectral(n, seed + 5, 2.0, 1.5))
    col = N.mix(col, np.asarray(CRUST) * (0.85 + 0.3 * size[..., None]), blob * 0.85)
    height = height + blob * 1.6
    grow = N.smooth(0.4, 1.5, N.spectral(n, seed + 6, 2.4, 2) + 0.25 * fine)
    col = N.mix(col, ALGAE, grow * 0.5)
    col = col * (1 + 0.10 * fine[..., None]) * (1 + 0.06 * a[..., None])
    col = N.mix(col, (0.37, 0.32, 0.26), 0.42)  # one skin of fouling over everything
    rough = 0.82 - 0.12 * film + 0.08 * grow + 0.05 * fine * 0.3
    return col, np.clip(rough, 0.5, 1), height + grow * 0.25


def hull(n=1024, length=8.0, girth=7.0):
    """U runs 8 m along the boat and tiles; V runs from deck edge (0) to keel (1)."""
    v = (np.arange(n) + 0.5)[:, None] / n * np.ones((1, n))
    u = (np.arange(n) + 0.5)[None, :] / n * length * np.ones((n, 1))
    col, rough, h = corroded(n, 11, 0.55)
    height = h * 0.010
    # streaks: noise stretched down the side
    streak = N.spectral(n, 31, 1.5, 3, stretch=(7, 1)) + 0.3 * N.spectral(n, 32, 1, 30)
    col = N.mix(col, (0.50, 0.28, 0.14), 0.62 * N.smooth(0.4, 1.7, streak) * N.smooth(0.02, 0.2, v))
    col = N.mix(col, (0.20, 0.16, 0.13), 0.6 * N.smooth(0.5, 1.9, -streak) * N.smooth(0.02, 0.2, v))
    # plates: seams along, butts across (staggered), rivets beside them
    rows = [0.0, 0.105, 0.26, 0.42, 0.58, 0.74, 0.89, 1.0]
    seam = np.zeros((n, n))
    rivet = np.zeros((n, n))
    for k in range(len(rows) - 1):
        band = (v >= rows[k]) & (v < rows[k + 1])
        off = 1.0 * (k % 2)
        du = np.abs((u - off + 1) % 2 - 1)
        dv = np.minimum(np.abs(v - rows[k]), np.abs(v - rows[k + 1])) * girth
        seam = np.maximum(seam, band * np.maximum(N.smooth(0.016, 0.004, du), N.smooth(0.016, 0.004, dv)))
        ru = np.abs((u % 0.10) - 0.05)
        rv = np.abs((v * girth % 0.10) - 0.05)
        rivet = np.maximum(rivet, band * N.smooth(0.022, 0.012, np.hypot(ru, dv - 0.045)))
        rivet = np.maximum(rivet, band * N.smooth(0.022, 0.012, np.hypot(rv, du - 0.045)))
        dent = np.random.default_rng(k).normal(0, 0.5, 8)
        col = col * (1 + 0.07 * band * dent[((u - off) // 2).astype(int) % 4])[..., None]
    height += rivet * 0.008 - seam * 0.010
    col = N.mix(col, (0.17, 0.11, 0.07), seam * 0.75)
    col = N.mix(col, (0.36, 0.20, 0.11), rivet * 0.45)
    # limber holes of the casing
    for vc, hh, step, w in ((0.034, 0.085, 0.8, 0.52), (0.078, 0.060, 0.8, 0.40)):
        uu = np.abs((u + (0 if vc < 0.05 else 0.4)) % step - step / 2)
        dv = np.abs(v - vc) * girth
        q = np.hypot(np.maximum(uu - (w / 2 - hh), 0), dv)
        hole = N.smooth(hh + 0.012, hh - 0.012, q)
        lip = N.smooth(hh + 0.05, hh + 0.015, q) - hole
        col = N.mix(col, (0.018, 0.02, 0.02), hole)
        col = N.mix(col, ORANGE, np.clip(lip, 0, 1) * 0.4)
        rough = rough * (1 - hole) + 0.95 * hole
        height -= hole * 0.03
    # weed hangs at the deck edge, silt lies on the shoulder and at the foot
    patch = N.spectral(n, 41, 2.3, 2) + 0.25 * N.spectral(n, 42, 0.8, 20)
    weed = N.smooth(0.2, 1.2, patch) * N.smooth(0.5, 0.1, v)
    col = N.mix(col, (0.30, 0.36, 0.19), weed * 0.45)
    silt = N.smooth(
        -0.9,
        2.2,
        N.spectral(n, 43, 2.2, 2)
        + 0.25 * N.spectral(n, 44, 0.9, 30)
        + 1.3 * N.smooth(0.30, 0.13, v) * N.smooth(0.095, 0.12, v)
        + 1.9 * N.smooth(0.56, 0.80, v)
        - 1.0,
    )
    col = N.mix(col, SILT, silt * 0.75)
    height = height * (1 - 0.5 * silt)
    rough = np.clip(rough + 0.12 * silt, 0, 1)
    return np.clip(col, 0, 1), N.rough_metal(rough, 0.15 * (1 - silt))[::2, ::2], N.normal_map(height, length, girth)


def deck(n=512, size=3.2):
    """Casing planks run along V; silt fills the gaps, some planks are gone."""
    u = (np.arange(n) + 0.5)[None, :] / n * size * np.ones((n, 1))
    v = (np.arange(n) + 0.5)[:, None] / n * size * np.ones((1, n))
    w = size / 20
    k = (u // w).astype(int)
    edge = np.abs(u % w - w / 2) * 2 / w
    gap = N.smooth(0.72, 0.82, edge)
    grain = N.spectral(n, 51, 1.2, 6, stretch=(1, 9))
    tone = np.random.default_rng(5).normal(0, 1, 20)[k]
    col = N.flat(n, (0.33, 0.29, 0.23)) * (1 + 0.12 * grain + 0.10 * tone)[..., None]
    col = N.mix(col, ALGAE, 0.6 * N.smooth(0.2, 1.4, N.spectral(n, 52, 1.8, 2)))
    rng = np.random.default_rng(8)
    gone = np.zeros((n, n))
    for _ in range(9):
        kk, s, ln = rng.integers(20), rng.random() * size, 0.4 + rng.random() * 0.9
        gone = np.maximum(
            gone,
            (k == kk) * N.smooth(ln / 2, ln / 2 - 0.04, np.abs((v - s + size / 2) % size - size / 2) + 0.03 * grain),
        )
    hole = np.maximum(gap, gone)
    col = N.mix(col, (0.05, 0.045, 0.04), hole)
    height = -0.03 * hole + 0.002 * grain
    beam = N.smooth(0.07, 0.05, np.abs(v % 0.8 - 0.4))
    col = N.mix(col, RUST, beam * hole)
    height = np.maximum(height, -0.012 * np.ones_like(height) * 1.0) * beam * hole + height * (1 - beam * hole)
    s = N.spectral(n, 53, 2.0, 1.5)
    f = N.spectral(n, 54, 0.8, 30)
    silt = N.smooth(-1.1, 1.0, s + 0.2 * f)
    col = N.mix(col, np.asarray(SILT) * 0.95 * (1 + 0.05 * f[..., None]), silt * 0.88)
    height = height * (1 - 0.8 * silt) + 0.012 * silt + 0.0015 * f
    return np.clip(col, 0, 1), N.rough_metal(0.9 + 0.05 * silt), N.normal_map(height * 0.7, size)


def steel(n=512, size=2.0):
    """Corroded fittings."""
    col, rough, h = corroded(n, 71, 0.25)
    return np.clip(col, 0, 1), N.rough_metal(rough, 0.2), N.normal_map(h * 0.008, size)
