"""Tileable textures from numpy: noise, cells, normal maps, colour ramps.

Every field wraps in both directions. Images are float arrays, row 0 on top.
"""
import numpy as np


def spectral(n, seed, beta=2.0, low=1.0, high=1e9, stretch=(1.0, 1.0), m=None):
    """Random field with power falling as frequency^-beta inside [low, high]; mean 0, sd 1."""
    m = n if m is None else m
    rng = np.random.default_rng(seed)
    fy, fx = np.meshgrid(np.fft.fftfreq(n) * n * stretch[0], np.fft.fftfreq(m) * m * stretch[1], indexing="ij")
    f = np.hypot(fx, fy)
    amp = np.where((f >= low) & (f <= high), np.maximum(f, 1e-9) ** (-beta / 2), 0)
    field = np.fft.ifft2(np.fft.fft2(rng.standard_normal((n, m))) * amp).real
    return (field - field.mean()) / (field.std() + 1e-12)


def cells(n, count, seed, m=None):
    """Distance to the nearest and second-nearest of count wrapped points, in tile units."""
    m = n if m is None else m
    rng = np.random.default_rng(seed)
    pts = rng.random((count, 2))
    y, x = np.meshgrid((np.arange(n) + 0.5) / n, (np.arange(m) + 0.5) / m, indexing="ij")
    d1, d2, who = np.full((n, m), 9.0), np.full((n, m), 9.0), np.zeros((n, m), int)
    for k, (py, px) in enumerate(pts):
        dy, dx = np.abs(y - py), np.abs(x - px)
        d = np.hypot(np.minimum(dy, 1 - dy), np.minimum(dx, 1 - dx))
        closer = d < d1
        d2 = np.where(closer, d1, np.minimum(d2, d))
        who = np.where(closer, k, who)
        d1 = np.minimum(d1, d)
    return d1, d2, who


def bumps(n, tile_m, count, seed, least_m, most_m, where=None, ragged=None):
    """Stones, shells or clumps on a tile: cover (0..1), height (m) and a random tone (0..1) of each, [n, n].

    Sizes fall off towards the largest; where (a field, about 0..1) keeps them in drifts, ragged (in radii) frays edges.
    """
    rng = np.random.default_rng(seed)
    cover, dome, tone = np.zeros((n, n)), np.zeros((n, n)), np.zeros((n, n))
    for _ in range(count):
        at, r = rng.random(2) * n, (least_m * (most_m / least_m) ** (rng.random() ** 2.2)) / tile_m * n
        squash, turn, shade = 0.55 + 0.4 * rng.random(), rng.random() * np.pi, rng.random()
        lumps, kept = rng.normal(0, 0.09, 3), rng.normal(0.5, 0.25)
        if where is not None and where[int(at[0]), int(at[1])] < kept:
            continue
        w = int(r * 1.6) + 2
        y, x = np.mgrid[-w:w + 1, -w:w + 1].astype(float)
        u, v = x * np.cos(turn) + y * np.sin(turn), (y * np.cos(turn) - x * np.sin(turn)) / squash
        angle = np.arctan2(v, u)
        d = np.hypot(u, v) / r * (1 + sum(lumps[k] * np.cos((k + 2) * angle + 6 * shade) for k in range(3)))
        box = np.ix_((int(at[0]) + np.arange(-w, w + 1)) % n, (int(at[1]) + np.arange(-w, w + 1)) % n)
        if ragged is not None:
            d = d + ragged[box]
        on = smooth(1.0 + 0.7 / r, 1.0 - 0.7 / r, d)
        more = on > cover[box]
        cover[box] = np.maximum(cover[box], on)
        dome[box] = np.where(more, np.sqrt(np.clip(1 - d * d, 0, 1)) * r / n * tile_m * 0.6, dome[box])
        tone[box] = np.where(more, shade, tone[box])
    return cover, dome, tone


def smooth(lo, hi, x):
    t = np.clip((np.asarray(x, float) - lo) / (hi - lo), 0, 1)
    return t * t * (3 - 2 * t)


def blur(a, sigma):
    """Wrapped Gaussian blur, sigma in pixels."""
    fy, fx = np.meshgrid(np.fft.fftfreq(a.shape[0]), np.fft.fftfreq(a.shape[1]), indexing="ij")
    return np.fft.ifft2(np.fft.fft2(a) * np.exp(-2 * (np.pi * sigma) ** 2 * (fx**2 + fy**2))).real


def mix(a, b, t):
    """Blend a to b by t; t may lack the colour axis."""
    a, b, t = np.asarray(a, float), np.asarray(b, float), np.asarray(t, float)
    t = t[..., None] if 0 < t.ndim < max(a.ndim, b.ndim) else t
    return a * (1 - t) + b * t


def flat(n, rgb, m=None):
    return np.tile(np.asarray(rgb, float), (n, n if m is None else m, 1))


def normal_map(height, metres_x, metres_y=None, steepest=None):
    """Tangent-space normals (+y up the image) of a height field in metres over one tile.

    steepest: slopes approach this, so that walls of cracks do not catch light from the side.
    """
    metres_y = metres_x if metres_y is None else metres_y
    n, m = height.shape
    dx = (np.roll(height, -1, 1) - np.roll(height, 1, 1)) / (2 * metres_x / m)
    dy = (np.roll(height, -1, 0) - np.roll(height, 1, 0)) / (2 * metres_y / n)
    if steepest:
        less = 1 / np.sqrt(1 + (dx**2 + dy**2) / steepest**2)
        dx, dy = dx * less, dy * less
    v = np.stack([-dx, dy, np.ones_like(dx)], 2)
    return v / np.linalg.norm(v, axis=2, keepdims=True) * 0.5 + 0.5


def rough_metal(rough, metal=0.0):
    """glTF packing: G roughness, B metal."""
    r = np.asarray(rough, float)
    return np.stack([np.ones_like(r), r, np.broadcast_to(metal, r.shape)], 2)


def value3(p, seed, freq=1.0):
    """Smooth value noise at points p [n, 3], range about -1..1."""
    p = np.asarray(p, float) * freq + 1000.0
    i = np.floor(p).astype(np.int64)
    f = p - i
    f = f * f * (3 - 2 * f)
    out = 0.0
    for dx in (0, 1):
        for dy in (0, 1):
            for dz in (0, 1):
                h = (
                    ((i[:, 0] + dx) * 73856093)
                    ^ ((i[:, 1] + dy) * 19349663)
                    ^ ((i[:, 2] + dz) * 83492791)
                    ^ (seed * 2654435761)
                )
                h = (h ^ (h >> 13)) * 1274126177 & 0x7FFFFFFF
                h = (h ^ (h >> 16)) & 0xFFFF
                w = (
                    (f[:, 0] if dx else 1 - f[:, 0])
                    * (f[:, 1] if dy else 1 - f[:, 1])
                    * (f[:, 2] if dz else 1 - f[:, 2])
                )
                out = out + w * (h / 32767.5 - 1)
    return out


def fbm3(p, seed, freq=1.0, octaves=4, gain=0.5):
    return sum(value3(p, seed + k, freq * 2**k) * gain**k for k in range(octaves))
