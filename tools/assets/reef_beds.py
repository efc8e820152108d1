"""Where reef life meets the sand: a bed of sand piled up round a foot, with broken coral and stones half sunk in it.

A bed has the sand's own texture (coarse_sand.py), and its rim dips below the ground, so that its edge does not show.
"""
import numpy as np

import noise as N
from mesh import box_uv, Part, shade
from shapes import icosphere, tube

TILE_M = 1.0  # of the cut from the sand's picture
SAND = (0.95, 0.93, 0.88, 1)  # as reef.toml colours its floor
DIP_M = 0.09  # of the rim


def pile(x, z, reach, height, seed):
    """Height of the sand at x, z [n] from the foot in the middle: more of it on one side; below the ground at the rim."""
    p = np.column_stack([x, 0 * x, z])
    turn = np.arctan2(z, x)
    r = np.hypot(x, z) / (reach * (1 + 0.30 * N.fbm3(np.column_stack([np.cos(turn), 0 * x, np.sin(turn)]), seed, 1.3, 3)))
    lee = 0.72 + 0.28 * np.cos(turn - seed)
    return height * lee * np.exp(-((r / 0.50) ** 2)) * (1 + 0.35 * N.fbm3(p, seed + 1, 9, 2)) - DIP_M * N.smooth(0.42, 1.0, r)


def sand(reach, height, foot, seed):
    """The pile; darker within the foot's radius, where less light comes."""
    n, m = 24, 9
    turn, s = np.meshgrid(np.arange(n) / n * 2 * np.pi, np.linspace(0.03, 1.1, m) * reach, indexing="xy")
    x, z = (s * np.cos(turn)).ravel(), (s * np.sin(turn)).ravel()
    pos = np.column_stack([x, pile(x, z, reach, height, seed), z])
    i, j = np.meshgrid(np.arange(m - 1), np.arange(n), indexing="ij")
    a, b = (i * n + j).ravel(), (i * n + (j + 1) % n).ravel()
    tri = np.concatenate([np.stack([a, b, b + n], 1), np.stack([a, b + n, a + n], 1)])
    if np.cross(pos[tri[0, 1]] - pos[tri[0, 0]], pos[tri[0, 2]] - pos[tri[0, 0]])[1] < 0:
        tri = tri[:, ::-1]
    part = shade(Part(pos, tri, np.column_stack([x, z]) / TILE_M + 0.5), 80)
    r = np.hypot(part.pos[:, 0], part.pos[:, 2])
    rough = 1 + 0.35 * N.fbm3(part.pos, seed + 2, 9, 3)
    above = N.smooth(0.035, 0.075, part.pos[:, 1])  # where the ground may cut the pile off it looks like the ground
    shade_of = 1 - 0.55 * above * N.smooth(1.6 * foot, 0.80 * foot, r * rough)
    film = above * N.smooth(2.0 * foot, 0.9 * foot, r * (2 - rough))  # of algae and what fell from above
    c = shade_of[:, None] * N.mix(np.ones((len(r), 3)), (0.70, 0.72, 0.50), 0.7 * film)
    part.col = np.column_stack([np.clip(c, 0, 1), np.ones(len(c))])
    return part


def stone(size, seed, rng, fine=False):
    """A stone with its middle in the origin, pale where sand lies on it, dark where it sinks in."""
    v, f = icosphere(2 if fine else 1)
    s = v * (1 + 0.30 * N.fbm3(v, 80 + seed, 1.4, 2))[:, None] * size * np.array([1.25, 0.60, 0.9])
    part = shade(Part(s, f).rot("y", rng.random() * 360).rot("x", rng.normal(0, 18)), 80)
    tone = 0.24 + 0.36 * rng.random()
    return sunk(part, (tone * 1.16, tone, tone * (0.62 + 0.2 * rng.random())), size, seed)


def stick(length, radius, seed, rng):
    """A broken branch of coral with its middle in the origin."""
    a = rng.random() * 2 * np.pi
    d = np.array([np.cos(a), 0.14 * rng.normal(), np.sin(a)])
    q = np.linspace(-0.5, 0.5, 5)[:, None]
    path = d * length * q + 0.10 * length * np.sin(q * 5 + seed) * np.array([d[2], 0, -d[0]])
    part = shade(tube(path, radius * np.array([0.7, 1, 1.15, 0.95, 0.6]), 6), 80)
    tone = 0.50 + 0.24 * rng.random()
    return sunk(part, (tone * 1.06, tone * 0.95, tone * 0.76), 1.5 * radius, seed)


def sunk(part, rgb, size, seed):
    low = N.smooth(0.55, -0.35, part.pos[:, 1] / size)  # 1 where the ground is near
    dust = N.smooth(0.15, 0.6, part.nrm[:, 1] + 0.5 * N.fbm3(part.pos, 7 + seed, 0.8 / size, 2)) * N.smooth(1.0, 0.1, part.pos[:, 1] / size)
    c = np.asarray(rgb) * (1 + 0.22 * N.fbm3(part.pos, 5 + seed, 1.2 / size, 2))[:, None] * (1 - 0.45 * low)[:, None]
    c = N.mix(c, (0.44, 0.38, 0.29), 0.45 * dust)
    part.col = np.column_stack([np.clip(c, 0, 1), np.ones(len(c))])
    return box_uv(part, 0.25, 3)


def stones(count, foot, reach, height, seed):
    """Stones and sticks round the foot, most at its edge, a third to two thirds of each in the sand."""
    rng = np.random.default_rng(seed)
    out = []
    for k in range(count):
        a, r = rng.random() * 2 * np.pi, foot * (0.8 + 0.3 * rng.random()) + 0.7 * max(reach - foot, 0) * rng.random() ** 2.0
        x, z = r * np.cos(a), r * np.sin(a)
        y = float(pile(np.array([x]), np.array([z]), reach, height, seed)[0])
        if k % 3 == 2:
            part, sink = stick(0.05 + 0.08 * rng.random(), 0.0055 + 0.0045 * rng.random(), k, rng), 0.002
        else:
            size = 0.012 + 0.050 * rng.random() ** 2.0
            part, sink = stone(size, k, rng, size > 0.042), 0.22 * size * rng.random()
        out.append(part.at(x, y - sink, z))
    return out
