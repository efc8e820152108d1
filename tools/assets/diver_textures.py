"""The diver's suit atlas, and tiling cloth and rubber for the gear; all have been dived in for years."""
import numpy as np

import noise as N
from detail import packed
from diver_body import CHARTS, MARGIN

GREY, SKIN = (0.22, 0.23, 0.24), (0.72, 0.50, 0.40)


def suit(look, n=1024):
    rng_fine = N.spectral(n, 3, 0.3, 90)
    soft = N.spectral(n, 4, 2.4, 3, 60)
    col = N.flat(n, look.suit)
    height = 0.00005 * rng_fine + 0.0003 * soft
    rough = np.full((n, n), 0.82)
    worn_through, muddy, skin_of = (np.zeros((n, n)) for _ in range(3))  # 0 to about 1
    for name, (x, y, w, h) in CHARTS.items():
        u = ((np.arange(w) + 0.5) / w - MARGIN) / (1 - 2 * MARGIN) - 0.5
        t = (u + 0.5) % 1 - 0.5
        turn = np.tile(t, (h, 1))
        v = np.tile(((np.arange(h) + 0.5) / h)[:, None], (1, w))
        box = (slice(y, y + h), slice(x, x + w))
        panel, pad, face, lines, rubbed, mud, dim = (np.zeros((h, w)) for _ in range(7))
        edge = lambda d, wd=0.006: np.exp(-((d / wd) ** 2))
        if name == "torso":
            d = np.abs(np.abs(turn) - 0.25) - (0.060 + 0.03 * np.abs(v - 0.62))
            panel = N.smooth(0.004, -0.004, d) * N.smooth(0.36, 0.37, v) * (v < 0.735)
            lines = edge(d) * (v > 0.36) * (v < 0.735)
            lines = np.maximum(lines, edge(np.abs(turn) - 0.018, 0.0035) * (v > 0.1) * (v < 0.62))  # the flap over the zip
            lines = np.maximum(lines, edge(v - (0.145 + 0.10 * np.abs(turn)), 0.0045))  # yoke
            lines = np.maximum(lines, edge(np.abs(turn) - 0.155, 0.0035) * (v > 0.16) * (v < 0.36))
            dim = N.smooth(0.004, -0.004, np.abs(turn) - 0.018) * (v > 0.1) * (v < 0.62)
            rubbed = 0.8 * N.smooth(0.10, 0.02, np.abs(v - 0.86)) + 0.6 * N.smooth(0.10, 0.02, np.abs(np.abs(turn) - 0.25)) * N.smooth(0.06, 0.0, np.abs(v - 0.22))
        elif name == "leg":
            d = np.abs(np.abs(turn) - 0.25) - (0.085 - 0.05 * v)
            panel = N.smooth(0.005, -0.005, d) * (v < 0.50) * (v > 0.25) * (turn > 0)
            dk = np.maximum(np.abs(turn) - 0.17, (np.abs(v - 0.545) - 0.085) * 0.9)
            pad = N.smooth(0.012, -0.012, dk)
            lines = np.maximum(edge(d) * (v < 0.5) * (v > 0.25) * (turn > 0), edge(dk, 0.009))
            lines = np.maximum(lines, edge(v - 0.96, 0.006))
            rubbed = 0.95 * N.smooth(0.20, 0.05, np.maximum(np.abs(turn), 1.6 * np.abs(v - 0.545))) + 0.5 * N.smooth(0.10, 0.0, v)
            mud = N.smooth(0.55, 1.0, v)
        elif name == "arm":
            d = np.abs(np.abs(turn) - 0.25) - (0.10 - 0.04 * v)
            panel = N.smooth(0.006, -0.006, d) * (turn > 0) * (v < 0.55) * (v > 0.14)
            dk = np.maximum(np.abs(np.abs(turn) - 0.45) - 0.12, np.abs(v - 0.52) - 0.09)
            pad = N.smooth(0.02, -0.02, dk) * 0 + N.smooth(0.02, -0.02, np.abs(v - 0.93) - 0.025)
            patch = np.maximum(np.abs((turn - 0.30 + 0.5) % 1 - 0.5) - 0.13, np.abs(v - 0.50) - 0.085)  # on the elbow
            dim = N.smooth(0.006, -0.006, patch)
            lines = np.maximum(edge(d) * (turn > 0) * (v < 0.55) * (v > 0.14), edge(v - 0.89, 0.005))
            lines = np.maximum(lines, edge(patch, 0.007))
            lines = np.maximum(lines, edge(np.abs(turn) - 0.47, 0.005) * (v > 0.1))  # along the inner side
            lines = np.maximum(lines, edge(v - (0.155 + 0.05 * np.cos(2 * np.pi * turn)), 0.0045))  # where the sleeve is set in
            rubbed = 0.7 * N.smooth(0.16, 0.04, np.abs(v - 0.48)) * N.smooth(0.10, 0.30, np.abs(turn)) + 0.6 * N.smooth(0.85, 1.0, v)
            mud = 0.5 * N.smooth(0.70, 1.0, v)
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
            rubbed, mud = 0.5 * N.smooth(0.6, 1.0, v), 0.35 + 0.65 * N.smooth(0.4, 1.0, v)
        c = col[box]
        c = N.mix(c, look.panel, panel)
        c = N.mix(c, 0.55 * np.asarray(look.suit) + 0.01, dim)
        c = N.mix(c, GREY, pad)
        c = N.mix(c, SKIN, face)
        # A flatlock seam: a groove where the sheets meet, and thread across it in stitches.
        stitch = N.smooth(-0.2, 0.5, np.sin((v * h * 1.1 + turn * w) * 2 * np.pi / 5))
        thread = N.smooth(0.12, 0.42, lines) * (1 - 0.65 * N.smooth(0.75, 1.0, lines))
        c = N.mix(c, (0.36, 0.37, 0.38), thread * (0.10 + 0.50 * stitch) * (1 - face))
        c = N.mix(c, 0.35 * c, 0.8 * N.smooth(0.78, 1.0, lines) * (1 - face))
        col[box] = c
        ribs = np.sin(v * h * 2 * np.pi / 9) * pad
        fold = N.spectral(n, 40 + len(name), 1.6, 5, 60, stretch=(1, 3.5))[:h, :w]
        # Creases: narrow valleys between broad rolls, across the limb, where it bends and under the load.
        crease = N.spectral(n, 50 + len(name), 1.0, 22, 70, stretch=(1, 4.5))[:h, :w]
        crease = -np.maximum(0.9 - np.abs(crease), 0) ** 1.5 + 0.25
        bend = {
            "leg": np.exp(-(((v - 0.545) / 0.13) ** 2)) * (np.abs(turn) > 0.2),
            "arm": np.exp(-(((v - 0.48) / 0.12) ** 2)) + 0.8 * np.exp(-(((v - 0.16) / 0.09) ** 2)) + 0.5 * np.exp(-(((v - 0.84) / 0.05) ** 2)),
            "torso": np.exp(-(((v - 0.72) / 0.12) ** 2)) + 0.7 * np.exp(-(((v - 0.22) / 0.10) ** 2)),
        }.get(name, 0 * v)
        height[box] += (
            (-0.0016 * N.smooth(0.5, 1.0, lines) + 0.0007 * thread * (0.4 + 0.6 * stitch)) * (1 - face)
            + 0.0004 * ribs
            + 0.0012 * fold * (0.25 + bend) * (1 - face)
            + 0.0030 * crease * (0.10 + np.clip(bend, 0, 1)) * (1 - face) * (1 - 0.6 * dim)
            + 0.0008 * panel
            + 0.0010 * dim
        )
        rough[box] = rough[box] - 0.12 * panel + 0.05 * pad - 0.25 * face
        worn_through[box], muddy[box], skin_of[box] = rubbed, mud, face
        # Creases hold less light.
        col[box] *= (1 + (0.06 * np.clip(fold, -1.5, 1.5) + 0.55 * np.minimum(crease, 0) * (0.1 + np.clip(bend, 0, 1))) * (1 - face))[..., None]
    # Sun and salt bleach in patches, knees and elbows rub thin, silt stays on shins, tide lines where salt dried.
    bleach, rub, tide = N.spectral(n, 61, 2.2, 2, 24), N.spectral(n, 62, 1.0, 10, 120), N.spectral(n, 63, 2.4, 3, 26)
    cover = 1 - skin_of
    col = N.mix(col, 0.55 * col + np.array([0.17, 0.175, 0.18]), cover * (0.14 + 0.07 * N.smooth(-1.2, 2.0, bleach)))
    col = N.mix(col, (0.40, 0.41, 0.41), cover * 0.24 * N.smooth(0.25, 1.3, worn_through + 0.20 * rub - 0.15))
    col = N.mix(col, (0.36, 0.33, 0.26), cover * 0.30 * N.smooth(0.2, 1.0, muddy + 0.30 * bleach + 0.12 * rub - 0.1))
    salt = np.exp(-((tide - 0.8) / 0.05) ** 2) * N.smooth(-0.3, 0.8, bleach) + 0.7 * N.smooth(2.1, 2.9, rub)
    col = N.mix(col, (0.60, 0.60, 0.57), cover * 0.08 * np.clip(salt, 0, 1))
    col *= (1 + 0.025 * soft + 0.05 * rng_fine)[..., None]
    images = np.clip(col, 0, 1), N.rough_metal(np.clip(rough + 0.03 * soft, 0.3, 1)), N.normal_map(height, 1.5)
    return [image_of_half_size(i) if look.texture_px < n else i for i in images]


def jersey(n=256, rows=42):
    """The nylon over the neoprene, a detail tile (detail.py): knitted rows, worn into pills, with specks of silt."""
    y, x = np.meshgrid(np.arange(n) / n, np.arange(n) / n, indexing="ij")
    sway = 0.12 * N.spectral(n, 91, 2.4, 2, 12)
    rib = 0.5 + 0.5 * np.cos(2 * np.pi * (rows * x + sway))
    loop = 0.5 + 0.5 * np.cos(2 * np.pi * (1.5 * rows * y + 0.5 * np.round(rows * x + sway)))
    felt, fine = N.spectral(n, 92, 1.4, 6, 60), N.spectral(n, 93, 0.4, 30)
    specks, _, of = N.bumps(n, 0.1, 130, 94, 0.0004, 0.0016, ragged=0.2 * fine)
    knit = rib * (0.55 + 0.45 * loop)
    tone = 0.20 * (knit - 0.4) + 0.13 * felt + 0.10 * fine + specks * np.where(of > 0.4, 0.55, -0.3)
    return packed(0.00018 * knit + 0.00022 * felt + 0.0003 * specks, 0.1, tone)


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
    """Moulded rubber and paint, scuffed, scratched and filmed over; tinted by vertex colour times RUBBER_GAIN."""
    a, f, dirt = N.spectral(n, 12, 2.2, 2, 24), N.spectral(n, 13, 0.4, 60), N.spectral(n, 15, 2.0, 2, 40)
    scratch = N.smooth(2.2, 3.0, N.spectral(n, 14, 0.9, 8, stretch=(1, 14)))
    scratch = np.maximum(scratch, 0.8 * N.smooth(2.4, 3.1, N.spectral(n, 16, 0.9, 8, stretch=(12, 2))))
    chip = N.smooth(1.9, 2.15, N.spectral(n, 17, 1.5, 9, 90) + 0.4 * a)
    scuff = N.smooth(0.7, 2.2, N.spectral(n, 18, 1.2, 6, 90, stretch=(1, 2.5)) + 0.5 * a)
    tone = 0.76 + 0.02 * a + 0.025 * f + 0.14 * scuff + 0.20 * scratch
    col = tone[..., None] * np.ones(3)
    col = N.mix(col, (0.54, 0.52, 0.45), 0.60 * N.smooth(-0.1, 1.9, dirt))  # a film of silt and weed
    col = N.mix(col, (0.36, 0.33, 0.30), 0.8 * chip)
    rough = 0.55 + 0.05 * a + 0.15 * scratch + 0.15 * scuff + 0.12 * N.smooth(0, 2, dirt) + 0.1 * chip
    return (
        np.clip(col, 0, 1),
        N.rough_metal(np.clip(rough, 0.3, 0.95)),
        N.normal_map(0.00003 * f + 0.00004 * a - 0.0001 * chip - 0.00006 * scratch, size),
    )


# By which vertex colours make up for the picture's mean, about 0.76 in sRGB, below that of new rubber, 0.90.
RUBBER_GAIN = 1.45
