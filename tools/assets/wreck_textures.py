"""Textures of the wreck: hull side strip, casing deck, corroded steel."""
import numpy as np

import noise as N

PAINT, RUST, DARK, ORANGE = (0.38, 0.40, 0.40), (0.44, 0.25, 0.15), (0.27, 0.17, 0.12), (0.60, 0.35, 0.17)
CRUST, ALGAE, SILT = (0.60, 0.58, 0.50), (0.33, 0.38, 0.22), (0.70, 0.64, 0.52)
OYSTER, SPONGE, MUSSEL = (0.76, 0.72, 0.64), (0.66, 0.30, 0.14), (0.19, 0.17, 0.14)


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


def twice(image):
    """An image of twice the size, smooth, as tiles repeat."""
    big = image.repeat(2, 0).repeat(2, 1)
    return sum(np.roll(big, (i, j), (0, 1)) for i in (-1, 0, 1) for j in (-1, 0, 1)) / 9


def growth(n, metres, col, height, where):
    """What has settled on the plates, in clumps: oysters and barnacles, mussels and hydroids, sponges."""
    darker = lambda cover, px: 1 - 0.85 * np.clip(N.blur(cover, px) - cover, 0, 1)  # between clumps little light comes
    mottle = 0.16 * N.spectral(n, 85, 1.0, 60) + 0.14 * twice(N.spectral(n // 2, 86, 1.8, 12, 120))
    for count, seed, least, most, low, high, field in (
        (7000, 81, 0.010, 0.055, MUSSEL, (0.36, 0.32, 0.23), where - 0.15),
        (12000, 82, 0.006, 0.036, (0.48, 0.44, 0.37), OYSTER, where - 0.05),
        (420, 83, 0.03, 0.11, (0.40, 0.15, 0.09), SPONGE, where - 0.1),
        (900, 84, 0.03, 0.12, (0.30, 0.31, 0.17), (0.56, 0.52, 0.34), where - 0.05),
    ):
        cover, dome, tone = N.bumps(n, metres, count, seed, least, most, field, 1.3 * mottle)
        col = col * darker(cover, 4.0)[..., None]
        clump = N.mix(N.flat(n, low), high, tone) * ((0.62 + 0.38 * np.clip(dome / 0.015, 0, 1)) * (1 + mottle))[..., None]
        col = N.mix(col, clump, 0.85 * cover)
        height = height + (1.1 * dome + 0.004 * mottle) * cover
    return col, height


def hull(n=2048, length=8.0, girth=7.0):
    """U runs 8 m along the boat and tiles; V runs from deck edge (0) to keel (1). The colour has n columns and n / 2 rows, normals n / 2,
    roughness n / 4."""
    v = (np.arange(n) + 0.5)[:, None] / n * np.ones((1, n))
    u = (np.arange(n) + 0.5)[None, :] / n * length * np.ones((n, 1))
    noise = lambda *what, **more: twice(N.spectral(n // 2, *what, **more))
    grain = N.spectral(n, 33, 0.5, 150)
    col, rough, h = (twice(image) for image in corroded(n // 2, 11, 0.55))
    col = N.mix(col, col * col * 1.5, 0.3)  # bare plates are darker than what grows on them
    col *= (1 + 0.10 * grain)[..., None]
    height = h * 0.010 + 0.0006 * grain
    # streaks: noise stretched down the side
    streak = noise(31, 1.5, 3, stretch=(7, 1)) + 0.3 * noise(32, 1, 30)
    col = N.mix(col, (0.50, 0.28, 0.14), 0.62 * N.smooth(0.4, 1.7, streak) * N.smooth(0.02, 0.2, v))
    col = N.mix(col, (0.14, 0.11, 0.09), 0.7 * N.smooth(0.4, 1.7, -streak) * N.smooth(0.02, 0.2, v))
    # plates: seams along, butts across (staggered), rivets beside them
    rows = [0.0, 0.105, 0.26, 0.42, 0.58, 0.74, 0.89, 1.0]
    seam = np.zeros((n, n))
    rivet = np.zeros((n, n))
    for k in range(len(rows) - 1):
        band = (v >= rows[k]) & (v < rows[k + 1])
        off = 1.0 * (k % 2)
        du = np.abs((u - off + 1) % 2 - 1)
        dv = np.minimum(np.abs(v - rows[k]), np.abs(v - rows[k + 1])) * girth
        seam = np.maximum(seam, band * np.maximum(N.smooth(0.012, 0.004, du), N.smooth(0.012, 0.004, dv)))
        ru = np.abs((u % 0.10) - 0.05)
        rv = np.abs((v * girth % 0.10) - 0.05)
        rivet = np.maximum(rivet, band * N.smooth(0.019, 0.012, np.hypot(ru, dv - 0.045)))
        rivet = np.maximum(rivet, band * N.smooth(0.019, 0.012, np.hypot(rv, du - 0.045)))
        dent = np.random.default_rng(k).normal(0, 0.5, 8)
        col = col * (1 + 0.10 * band * dent[((u - off) // 2).astype(int) % 4])[..., None]
    height += rivet * 0.008 - seam * 0.010
    col = N.mix(col, (0.13, 0.08, 0.05), seam * 0.75)
    col = N.mix(col, (0.36, 0.20, 0.11), rivet * 0.45)
    # weed hangs at the deck edge, silt lies on the shoulder and at the foot
    patch = noise(41, 2.3, 2) + 0.25 * noise(42, 0.8, 20)
    weed = N.smooth(0.2, 1.2, patch) * N.smooth(0.5, 0.1, v)
    col = N.mix(col, (0.30, 0.36, 0.19), weed * 0.45)
    silt = N.smooth(
        -0.7,
        2.2,
        noise(43, 2.2, 2)
        + 0.25 * noise(44, 0.9, 30)
        + 0.25 * grain
        + 1.2 * N.smooth(0.30, 0.13, v) * N.smooth(0.095, 0.12, v)
        + 1.9 * N.smooth(0.56, 0.80, v)
        - 0.9,
    )
    col = N.mix(col, SILT, silt * 0.75)
    height = height * (1 - 0.5 * silt)
    rough = np.clip(rough + 0.12 * silt, 0, 1)
    settled = N.smooth(-0.4, 1.3, noise(45, 2.0, 3, 60) + 0.3 * N.smooth(0.75, 0.25, v))
    col, height = growth(n, length, col, height, settled)
    # limber holes of the casing: openings into the dark, behind a lip of plate, with edges that growth narrows
    ragged = 0.007 * noise(46, 2.4, 16, 300)
    for vc, hh, step, w in ((0.034, 0.085, 0.8, 0.52), (0.078, 0.060, 0.8, 0.40)):
        uu = np.abs((u + (0 if vc < 0.05 else 0.4)) % step - step / 2)
        down = (v - vc) * girth
        q = np.hypot(np.maximum(uu - (w / 2 - hh), 0), down) + ragged
        hole = N.smooth(hh + 0.005, hh - 0.005, q)
        rim = N.smooth(hh + 0.040, hh + 0.012, q) - hole
        col = N.mix(col, (0.34, 0.24, 0.16), np.clip(rim, 0, 1) * 0.5)
        run = N.smooth(w / 2, w / 2 - 0.15, uu) * N.smooth(hh, hh + 0.05, down) * N.smooth(hh + 0.5, hh + 0.1, down)
        col = N.mix(col, (0.20, 0.13, 0.08), run * 0.45 * N.smooth(-0.5, 1.0, streak))
        inside = N.smooth(-hh * 0.2, -hh, down)  # 0 at the foot, where light still falls
        foot = N.smooth(hh - 0.035, hh - 0.008, np.hypot(np.maximum(uu - (w / 2 - hh), 0), down + 0.016) + ragged) * (down > 0)
        dark = N.mix(N.flat(n, (0.035, 0.035, 0.03)), (0.004, 0.004, 0.004), inside)
        dark = N.mix(dark, (0.30, 0.26, 0.21), foot * 0.8)  # the plate's thickness, lit from above
        col = N.mix(col, dark, hole)
        rough = rough * (1 - hole) + 0.95 * hole
        height = height * (1 - hole) - hole * 0.03 + rim * 0.006
    half = lambda image: 0.25 * sum(image[i::2, j::2] for i in (0, 1) for j in (0, 1))
    mr = N.rough_metal(rough, 0.15 * (1 - silt))
    return np.clip(0.5 * (col[::2] + col[1::2]), 0, 1), half(half(mr)), N.normal_map(half(height), length, girth)


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
