"""The skin of a fish's side, for fish seen from a hand's breadth: scales that overlap, gill cover, mouth, lateral line, eye.

Pictures run from nose to tail and from back to belly. Shapes after field guides.
"""
import numpy as np

import noise as N


def scales(x, y):
    """Scales that overlap towards the tail, one a unit, rows set off by a half: height 0..1, rear edge 0..1, tone 0..1."""
    first = np.full(x.shape, 1e9)
    height, edge, tone = np.zeros(x.shape), np.zeros(x.shape), np.zeros(x.shape)
    for dj in (-1, 0, 1):
        row = np.floor(y) + dj
        off = 0.5 * (row % 2)
        for di in (-1, 0, 1):
            cx, cy = np.floor(x - off) + di + off, row + 0.5
            d = np.hypot((x - cx) * 0.95, (y - cy) * 1.15)
            on = (d < 0.78) & (cx < first)  # the one before lies over the one behind
            first = np.where(on, cx, first)
            height = np.where(on, 0.5 + 0.5 * np.clip((x - cx) / 0.78, -1, 1), height)
            edge = np.where(on, N.smooth(0.58, 0.78, d), edge)
            tone = np.where(on, np.modf(np.abs(np.sin(cx * 12.9898 + cy * 78.233) * 43758.5453))[0], tone)
    return height, edge, tone


def dressed(col, length, girth, pitch, eye, eye_r, iris, seed=3, cheek=0.21, tail=0.86):
    """Colour and normals of a side, [n, m, 3], whose picture is length by girth metres.

    pitch: of the scales (m); eye: its place in the picture; cheek and tail: where scales begin and end, along the length.
    """
    n, m = col.shape[:2]
    v = ((np.arange(n) + 0.5) / n)[:, None] * np.ones((1, m))
    u = ((np.arange(m) + 0.5) / m)[None, :] * np.ones((n, 1))
    f, soft = N.spectral(n, seed, 0.6, 10, m=m), N.spectral(n, seed + 1, 2.2, 3, 40, m=m)
    x, y = u * length / pitch, v * girth / pitch * 1.25
    height, edge, tone = scales(x + 0.05 * soft, y + 0.5 * np.sin(3 * u))
    skull = cheek + 0.020 * np.cos(5 * (v - 0.5)) - 0.30 * (v - 0.55) ** 2  # behind the gill cover
    scaly = N.smooth(skull - 0.005, skull + 0.02, u) * N.smooth(tail, tail - 0.06, u)
    col = col * (1 + scaly * (0.22 * (height - 0.5) + 0.10 * (tone - 0.5) - 0.24 * edge) + 0.04 * f + 0.05 * soft)[..., None]
    col = col * (1 + 0.22 * scaly * N.smooth(0.25, 0.0, np.abs(height - 0.62)) * (1 - edge))[..., None]  # sheen of a scale's bulge
    h = pitch * (0.10 * scaly * height + 0.02 * soft) + 0.00008 * f
    # Gill cover: its rear edge and the seam of the cheek within.
    gill = (u - skull) * length
    line = np.exp(-((gill / 0.0016) ** 2)) * N.smooth(0.16, 0.26, v) * N.smooth(0.90, 0.80, v)
    seam = np.exp(-(((gill + 0.16 * cheek * length) / 0.0012) ** 2)) * N.smooth(0.30, 0.40, v) * N.smooth(0.80, 0.70, v)
    mouth = np.exp(-(((v - 0.56 - 1.2 * u) * girth / 0.0011) ** 2)) * N.smooth(0.075, 0.05, u)
    col = N.mix(col, 0.30 * col, np.clip(0.5 * line + 0.25 * seam + 0.8 * mouth, 0, 1))
    col = N.mix(col, 0.62 * col, 0.6 * N.smooth(-0.006, 0.0, gill) * N.smooth(0.012, 0.0, gill) * N.smooth(0.2, 0.3, v))
    h = h - 0.0006 * N.smooth(-0.001, 0.0015, gill) * N.smooth(0.014, 0.002, gill) - 0.0006 * seam - 0.0008 * mouth
    # The lateral line: a dot a scale.
    lateral = np.exp(-(((v - 0.36 + 0.10 * np.sin(np.pi * u)) * girth / 0.0011) ** 2)) * scaly
    col = N.mix(col, 0.45 * col, 0.55 * lateral * (0.5 + 0.5 * np.cos(2 * np.pi * x)))
    # The eye: a dark rim, an iris that shines around the pupil, the lens that bulges.
    r = np.hypot((u - eye[0]) * length, (v - eye[1]) * girth * 0.72) / eye_r
    way = np.arctan2(v - eye[1], u - eye[0])
    ring = N.smooth(1.30, 1.02, r)
    col = N.mix(col, 0.40 * col, 0.7 * ring)
    streaks = 0.82 + 0.12 * np.cos(23 * way + 2 * soft) + 0.25 * N.smooth(0.75, 0.52, r)
    shade = 0.62 + 0.38 * N.smooth(0.9, -0.9, (v - eye[1]) * girth * 0.72 / eye_r)  # the lid's shadow lies above
    col = N.mix(col, np.asarray(iris) * (streaks * (1.30 - 0.45 * shade))[..., None], N.smooth(1.02, 0.95, r))
    col = N.mix(col, (0.015, 0.017, 0.022), np.maximum(N.smooth(0.60, 0.53, r), 0.7 * np.exp(-(((r - 0.98) / 0.06) ** 2))))
    h = N.mix(h, np.full_like(h, h.mean()), N.smooth(1.2, 1.0, r)) + 0.45 * eye_r * np.sqrt(np.clip(1.05 - r * r, 0, 1)) - 0.12 * eye_r * np.exp(-(((r - 1.15) / 0.12) ** 2))
    return np.clip(col, 0, 1), N.normal_map(h, length, girth, steepest=0.9)
