"""The diver's suit atlas, and tiling cloth and rubber for the gear."""
import numpy as np

import noise as N
from diver_body import CHARTS, MARGIN

GREY, SKIN = (0.22, 0.23, 0.24), (0.72, 0.50, 0.40)


def suit(look, n=1024):
    rng_fine = N.spectral(n, 3, 0.3, 90)
    soft = N.spectral(n, 4, 2.4, 3, 60)
    col = N.flat(n, look.suit)
    height = 0.00005 * rng_fine + 0.0005 * soft
    rough = np.full((n, n), 0.82)
    for name, (x, y, w, h) in CHARTS.items():
        u = ((np.arange(w) + 0.5) / w - MARGIN) / (1 - 2 * MARGIN) - 0.5
        t = (u + 0.5) % 1 - 0.5
        turn = np.tile(t, (h, 1))
        v = np.tile(((np.arange(h) + 0.5) / h)[:, None], (1, w))
        box = (slice(y, y + h), slice(x, x + w))
        panel, pad, face, lines = (np.zeros((h, w)) for _ in range(4))
        edge = lambda d, wd=0.006: np.exp(-((d / wd) ** 2))
        if name == "torso":
            d = np.abs(np.abs(turn) - 0.25) - (0.060 + 0.03 * np.abs(v - 0.62))
            panel = N.smooth(0.004, -0.004, d) * N.smooth(0.36, 0.37, v) * (v < 0.735)
            lines = edge(d) * (v > 0.36) * (v < 0.735)
            lines = np.maximum(lines, edge(np.abs(turn), 0.004) * (v > 0.1) * (v < 0.62))
        elif name == "leg":
            d = np.abs(np.abs(turn) - 0.25) - (0.085 - 0.05 * v)
            panel = N.smooth(0.005, -0.005, d) * (v < 0.50) * (v > 0.25) * (turn > 0)
            dk = np.maximum(np.abs(turn) - 0.17, (np.abs(v - 0.545) - 0.085) * 0.9)
            pad = N.smooth(0.012, -0.012, dk)
            lines = np.maximum(edge(d) * (v < 0.5) * (v > 0.25) * (turn > 0), edge(dk, 0.009))
            lines = np.maximum(lines, edge(v - 0.96, 0.006))
        elif name == "arm":
            d = np.abs(np.abs(turn) - 0.25) - (0.10 - 0.04 * v)
            panel = N.smooth(0.006, -0.006, d) * (turn > 0) * (v < 0.55) * (v > 0.14)
            dk = np.maximum(np.abs(np.abs(turn) - 0.45) - 0.12, np.abs(v - 0.52) - 0.09)
            pad = N.smooth(0.02, -0.02, dk) * 0 + N.smooth(0.02, -0.02, np.abs(v - 0.93) - 0.025)
            lines = np.maximum(edge(d) * (turn > 0) * (v < 0.55) * (v > 0.14), edge(v - 0.89, 0.006))
        elif name == "head":
            r = np.hypot(turn / 0.135, (v - 0.445) / 0.27)
            face = N.smooth(1.03, 0.97, r)
            lines = np.maximum(edge(r - 1.06, 0.03), edge(np.abs(turn), 0.006) * (v < 0.15))
            panel = N.smooth(0.02, -0.02, np.abs(np.abs(turn) - 0.30) - 0.06) * (v > 0.2) * (v < 0.75)
        elif name == "hand":
            pad = N.smooth(0.02, -0.02, np.abs(np.abs(turn) - 0.25) - 0.12) * (turn < 0)
            lines = edge(v - 0.20, 0.02)
        else:
            pad = N.smooth(0.0, 0.03, v - 0.80)
            lines = np.maximum(edge(v - 0.80, 0.01), edge(v - 0.25, 0.01))
        c = col[box]
        c = N.mix(c, look.panel, panel)
        c = N.mix(c, GREY, pad)
        c = N.mix(c, SKIN, face)
        c = N.mix(c, (0.36, 0.38, 0.40), np.clip(lines, 0, 1) * 0.55 * (1 - face))
        col[box] = c
        ribs = np.sin(v * h * 2 * np.pi / 9) * pad
        fold = N.spectral(n, 40 + len(name), 1.6, 5, 60, stretch=(1, 3.5))[:h, :w]
        bend = {
            "leg": np.exp(-(((v - 0.545) / 0.13) ** 2)) * (np.abs(turn) > 0.2),
            "arm": np.exp(-(((v - 0.48) / 0.12) ** 2)),
            "torso": np.exp(-(((v - 0.72) / 0.12) ** 2)),
        }.get(name, 0 * v)
        height[box] += (
            -0.0012 * lines * (1 - face) + 0.0004 * ribs + 0.0012 * fold * (0.25 + bend) * (1 - face) + 0.0008 * panel
        )
        rough[box] = rough[box] - 0.12 * panel + 0.05 * pad - 0.25 * face
    col *= (1 + 0.05 * soft + 0.04 * rng_fine)[..., None]
    col = N.mix(col, (0.30, 0.30, 0.27), 0.05 * N.smooth(0.3, 2, N.spectral(n, 6, 1.5, 4)))
    images = np.clip(col, 0, 1), N.rough_metal(np.clip(rough + 0.03 * soft, 0.3, 1)), N.normal_map(height, 1.5)
    return [image_of_half_size(i) if look.texture_px < n else i for i in images]


def image_of_half_size(image):
    return 0.25 * sum(image[i::2, j::2] for i in (0, 1) for j in (0, 1))


def cloth(n=256, size=0.16):
    """Woven nylon; tinted by vertex colour."""
    y, x = np.meshgrid(np.arange(n), np.arange(n), indexing="ij")
    k = 2 * np.pi * 32 / n
    warp, weft = np.abs(np.sin(x * k / 2)), np.abs(np.sin(y * k / 2))
    over = ((x * 32 // n + y * 32 // n) % 2).astype(float)
    weave = np.where(over > 0, warp * (0.6 + 0.4 * weft), weft * (0.6 + 0.4 * warp))
    soft = N.spectral(n, 8, 1.8, 2)
    tone = 0.80 + 0.14 * weave + 0.05 * soft
    return np.clip(tone[..., None] * np.ones(3), 0, 1), N.normal_map(0.0006 * weave + 0.0008 * soft, size)


def rubber(n=512, size=0.3):
    """Moulded rubber and paint with slight wear; tinted by vertex colour."""
    a, f = N.spectral(n, 12, 2.2, 2, 24), N.spectral(n, 13, 0.4, 60)
    scratch = N.smooth(2.0, 3.0, N.spectral(n, 14, 1.0, 6, stretch=(1, 12)))
    tone = 0.90 + 0.015 * a + 0.02 * f - 0.15 * scratch
    rough = 0.52 + 0.05 * a + 0.2 * scratch
    return (
        np.clip(tone[..., None] * np.ones(3), 0, 1),
        N.rough_metal(np.clip(rough, 0.3, 0.9)),
        N.normal_map(0.00003 * f + 0.00004 * a, size),
    )
