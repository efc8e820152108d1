"""Reef life for instancing: reef.glb, a node a kind, each on y = 0, laid out side by side. Those that stand on sand have
a second node NAME_bed, which adds sand piled up round their foot and broken coral in it (reef_beds.py).

Corals (staghorn, table, brain, fan, whip), sponges (barrel, tubes), an anemone, a starfish, an urchin,
shells and rubble. Sizes in metres as in life. Forms after field guides; all by chance with fixed seeds.
"""
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

import noise as N
import reef_beds as B
from coarse_sand import sand
from glb import Glb
from mesh import box_uv, join, loft, Part, shade
from shapes import circle, icosphere, revolve, tube

OUT = Path(__file__).resolve().parents[2] / "assets" / "models"


def paint(part, low, high, by, seed=1, mottle=0.18, crease=60):
    """Vertex colours from low to high along by (0..1, a function of positions), mottled."""
    p = part if part.nrm is not None else shade(part, crease)
    k = np.clip(by(p.pos), 0, 1)
    c = N.mix(np.tile(low, (len(k), 1)), np.asarray(high, float), k)
    c = c * (1 + mottle * N.fbm3(p.pos, seed, 14, 3))[:, None]
    under = N.smooth(0.1, -0.8, p.nrm[:, 1])  # less light below
    c = c * (1 - 0.35 * under)[:, None]
    p.col = np.column_stack([np.clip(c, 0, 1), np.ones(len(k))])
    return p


def footed(part, top):
    """Less light and a film of sand on what is lower than top (metres), where it meets the ground."""
    y = part.pos[:, 1] + 0.5 * top * N.fbm3(part.pos, 3, 25, 2)
    c = part.col[:, :3] * (1 - 0.5 * N.smooth(1.2 * top, 0.0, y))[:, None]
    part.col[:, :3] = N.mix(c, (0.36, 0.32, 0.25), 0.6 * N.smooth(0.7 * top, -0.2 * top, y))
    return part


def holdfast(radius, height, seed):
    """The lump of dead coral from which a colony grows."""
    v, f = icosphere(3)
    p = v * (1 + 0.34 * N.fbm3(v, seed, 1.6, 3))[:, None] * [radius, height, radius]
    p[:, 1] = np.where(p[:, 1] < 0, p[:, 1] * 0.8, p[:, 1]) - 0.02
    return Part(p, f)


def unit(v):
    v = np.asarray(v, float)
    return v / (np.linalg.norm(v) + 1e-12)


def staghorn():
    """A thicket of tapering branches that fork towards the light; growing tips are pale."""
    rng = np.random.default_rng(3)
    parts, tips = [], []

    def grow(at, way, r, left):
        n = 5
        length = (0.10 + 0.08 * rng.random()) * (0.75 + 0.1 * left)
        bend = rng.normal(0, 0.22, 3)
        path = [at]
        for k in range(n - 1):
            way = unit(way + bend * 0.3 + np.array([0, 0.07, 0]))
            path.append(path[-1] + way * length / (n - 1))
        last = left == 0
        rad = np.linspace(r, r * (0.35 if last else 0.82), n)
        parts.append((tube(np.array(path), rad, 6 if left > 1 else 5, (False, True)), len(tips)))
        tips.append(path[-1] if last else None)
        if last:
            return
        for _ in range(rng.integers(2, 4)):
            w = unit(way + rng.normal(0, 0.62, 3))
            w[1] = max(w[1], -0.1)
            grow(path[-1], unit(w), r * 0.80, left - 1)

    for k in range(11):
        a = k * 2.4 + rng.normal(0, 0.2)
        s = 0.03 + 0.012 * k
        grow(np.array([s * np.cos(a), -0.03, s * np.sin(a)]), unit([np.cos(a), 0.75 + 0.7 * rng.random(), np.sin(a)]), 0.019, 3 if k % 3 else 2)
    ends = np.array([t for t in tips if t is not None])
    p = shade(join([q for q, _ in parts]), 100)  # round, though of few sides
    d = np.min(np.linalg.norm(p.pos[:, None, :] - ends[None], axis=2), axis=1)
    branches = footed(paint(p, (0.46, 0.31, 0.17), (0.92, 0.80, 0.62), lambda _: N.smooth(0.075, 0.0, d) * 0.9, 11), 0.09)
    dead = footed(paint(holdfast(0.19, 0.085, 12), (0.20, 0.17, 0.11), (0.40, 0.36, 0.27), lambda q: N.smooth(-0.02, 0.05, q[:, 1]), 12, 0.3), 0.03)
    return box_uv(join([branches, dead]), 0.25)


def table():
    """A plate on a stalk, uneven at its rim, with short branchlets on top."""
    rng = np.random.default_rng(5)
    n, m = 56, 16
    ang = np.linspace(0, 2 * np.pi, n, endpoint=False)
    cr = np.column_stack([np.cos(ang), np.zeros(n), np.sin(ang)])
    rim = 0.52 * (1 + 0.10 * N.fbm3(cr, 6, 1.6, 3) + 0.05 * N.fbm3(cr, 7, 6, 2))
    rings = []
    for s in np.concatenate([np.linspace(0.02, 1, m), np.linspace(1, 0.12, m - 5)[1:]]):
        top = len(rings) < m
        r = rim * s
        p = np.column_stack([r * np.cos(ang), np.zeros(n), r * np.sin(ang)])
        sag = 0.34 + 0.05 * s**2 + 0.016 * N.fbm3(p, 9, 5, 2)
        p[:, 1] = sag + (0.012 if top else -0.010 - 0.16 * (1 - s) ** 3)
        rings.append(p)
    plate = loft(rings, (True, True))
    stalk = revolve([(0.13, -0.04), (0.085, 0.05), (0.06, 0.18), (0.10, 0.30), (0.16, 0.345)], 18).rot("x", -90)
    parts = [plate, stalk]
    for _ in range(190):
        s, a = np.sqrt(rng.random()) * 0.97, rng.random() * 2 * np.pi
        r = s * np.interp(a, np.append(ang, 2 * np.pi), np.append(rim, rim[0]))
        y = 0.34 + 0.05 * s**2 + 0.01
        out = np.array([np.cos(a), 0, np.sin(a)])
        b = np.array([r * out[0], y, r * out[2]])
        h = 0.022 + 0.022 * rng.random()
        parts.append(tube(np.array([b - [0, 0.01, 0], b + np.array([0, h, 0]) + out * 0.3 * h * s]), [0.0095, 0.0055], 4, (False, True)))
    parts.append(holdfast(0.20, 0.10, 14))
    return box_uv(
        footed(paint(join(parts), (0.38, 0.30, 0.20), (0.74, 0.62, 0.42), lambda p: N.smooth(0.36, 0.42, p[:, 1]) * (0.55 + 0.45 * N.smooth(0.38, 0.52, np.hypot(p[:, 0], p[:, 2]))), 13), 0.08),
        0.25,
    )


def maze(n=256):
    """Ridges and valleys of a brain coral by reaction and diffusion (Gray and Scott), tileable."""
    rng = np.random.default_rng(2)
    u, v = np.ones((n, n)), np.zeros((n, n))
    v[rng.random((n, n)) < 0.03] = 0.9
    v = N.blur(v, 1.2) * 3
    lap = lambda a: np.roll(a, 1, 0) + np.roll(a, -1, 0) + np.roll(a, 1, 1) + np.roll(a, -1, 1) - 4 * a
    for _ in range(3600):
        r = u * v * v
        u = u + 0.21 * lap(u) - r + 0.029 * (1 - u)
        v = v + 0.105 * lap(v) + r - (0.029 + 0.057) * v
    h = N.blur(v, 0.8)
    return (h - h.min()) / (np.ptp(h) + 1e-9)


def brain():
    v, f = icosphere(4)
    r = 1 + 0.10 * N.fbm3(v, 3, 1.3, 2) + 0.02 * N.fbm3(v, 4, 5, 2)
    p = v * r[:, None] * np.array([0.34, 0.26, 0.32])
    p[:, 1] = np.where(p[:, 1] < 0, p[:, 1] * 0.5, p[:, 1]) + 0.07
    part = paint(Part(p, f), (0.50, 0.45, 0.28), (0.80, 0.72, 0.46), lambda q: N.smooth(-0.05, 0.25, q[:, 1]), 17)
    return box_uv(footed(part, 0.06), 0.22)


def fan_texture(n=512):
    """The net of a sea fan: branches fork in one plane, and a net of twigs joins them. RGBA."""
    rng = np.random.default_rng(8)
    big = Image.new("L", (2 * n, 2 * n), 0)
    d = ImageDraw.Draw(big)

    taken = np.zeros((2 * n // 22 + 2, 2 * n // 22 + 2), int)

    def grow(x, y, a, w, left, who):
        for _ in range(left):
            step = 20 + 8 * rng.random()
            nx, ny = x + step * np.sin(a), y - step * np.cos(a)
            if np.hypot((nx - n) / n, (ny - 1.02 * n) / n) > 0.97 + 0.05 * np.sin(9 * a) and ny < 1.5 * n:
                return
            if not (6 < nx < 2 * n - 6 and 6 < ny < 2 * n - 0.35 * abs(nx - n)):
                return
            d.line([x, y, nx, ny], fill=255, width=max(5, int(w)))
            cell = int(ny) // 22, int(nx) // 22
            if taken[cell] not in (0, who) and np.hypot(nx - n, ny - 2 * n) > 0.16 * n:  # it meets another branch and joins it
                return
            taken[cell] = who
            x, y = nx, ny
            a = a * 0.99 + rng.normal(0, 0.12)
            w *= 0.95
            if rng.random() < 0.66 and np.hypot(x - n, y - 2 * n) > 0.10 * n:
                ends.append((x, y, a + rng.choice([-1, 1]) * (0.5 + 0.4 * rng.random()), w * 0.72, left - 1))

    ends = [(n + 10 * a, 2 * n - 2, a, 22, 52) for a in np.linspace(-1.0, 1.0, 7)]
    who = 0
    while ends and who < 1600:
        who += 1
        grow(*ends.pop(0), who)
    branch = np.asarray(big.resize((n, n), Image.LANCZOS), float) / 255
    y = ((np.arange(n) + 0.5) / n)[:, None] * np.ones((1, n))
    alpha = branch
    col = N.mix(N.flat(n, (0.50, 0.15, 0.24)), (0.78, 0.34, 0.44), N.smooth(-1, 1.5, N.spectral(n, 12, 1, 8)))
    col = N.mix(col, (0.36, 0.10, 0.16), 0.5 * N.smooth(0.5, 1, y))
    return np.dstack([col, np.clip(alpha * 1.3, 0, 1)])


def fan():
    n, m = 13, 11
    u, v = np.meshgrid(np.linspace(0, 1, n), np.linspace(0, 1, m), indexing="xy")
    x = (u - 0.5) * 0.80
    y = (1 - v) * 0.78 - 0.01
    z = 0.22 * (x / 0.4) ** 2 * 0.6 + 0.05 * np.sin(5 * x + 1) * (1 - v) + 0.10 * (1 - v) ** 2
    pos = np.stack([x, y, z], 2).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(m - 1), np.arange(n - 1), indexing="ij")
    a = (i * n + j).ravel()
    tri = np.concatenate([np.stack([a, a + n, a + n + 1], 1), np.stack([a, a + n + 1, a + 1], 1)])
    part = Part(pos, tri, np.stack([u, v], 2).reshape(-1, 2))
    return shade(part, 80)


def whip():
    """A bunch of whip corals, thin and bent by the current."""
    rng = np.random.default_rng(14)
    parts = []
    for _ in range(16):
        a, h = rng.random() * 2 * np.pi, 0.35 + 0.55 * rng.random()
        q = np.linspace(0, 1, 9)[:, None]
        b = np.array([0.10 * np.cos(a) * rng.random(), -0.02, 0.10 * np.sin(a) * rng.random()])
        p = b + q * np.array([0.10 * np.cos(a), h, 0.10 * np.sin(a)]) + q**2 * np.array([0.10, -0.04, 0.03]) + 0.012 * np.sin(q * 7 + a)
        parts.append(tube(p, np.linspace(0.0085, 0.005, 9), 5, (False, True)))
    return box_uv(paint(join(parts), (0.62, 0.20, 0.08), (0.95, 0.48, 0.16), lambda p: N.smooth(0, 0.7, p[:, 1]), 19), 0.2)


def barrel_sponge():
    """A vase, hollow: ribs that run up, broken into knobs, and a ragged rim."""
    n = 84
    ang = np.arange(n) / n * 2 * np.pi
    round_ = np.column_stack([np.cos(ang), np.zeros(n), np.sin(ang)])
    notches = 0.045 * N.fbm3(round_, 41, 2.0, 3) - 0.055 * np.maximum(N.fbm3(round_, 45, 3.1, 2) - 0.15, 0)
    oval = 1 + 0.09 * np.cos(2 * ang + 0.6) + 0.05 * np.cos(ang)
    prof = np.array([(0.20, -0.05), (0.25, 0.06), (0.31, 0.22), (0.34, 0.40), (0.33, 0.54), (0.29, 0.63), (0.265, 0.645), (0.235, 0.62), (0.225, 0.5), (0.20, 0.34), (0.13, 0.24), (0.03, 0.22)])
    way = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(prof, axis=0), axis=1))])
    rings = []
    for w in np.concatenate([np.linspace(0, way[6], 34)[:-1], np.linspace(way[6], way[-1], 12)]):
        r, y = (np.interp(w, way, prof[:, k]) for k in range(2))
        out = N.smooth(way[7], way[5], w)  # 1 outside, 0 within
        c = np.column_stack([np.cos(ang), np.full(n, y * 3), np.sin(ang)])
        # Ribs fork, wander and break into knobs and spurs; no two sides are alike.
        sway = 1.5 * N.fbm3(c * [1, 0.6, 1], 25, 1.1, 3)
        rib = (1 - np.abs(np.sin(ang * 5.5 + sway))) ** 0.8 * (0.7 + 0.7 * N.fbm3(c * [1, 1.6, 1], 27, 2.0, 2))
        knob = np.maximum(N.fbm3(c * [1, 1.5, 1], 29, 4.2, 2), 0)
        rr = r * oval * (0.90 + out * (0.26 * rib + 0.16 * knob)) * (1 + 0.13 * N.fbm3(c * [1, 0.6, 1], 21, 1.3, 2))
        top = N.smooth(0.36, 0.64, y)
        high = y + top * (notches + 0.028 * rib + 0.02 * knob)
        lean = 0.16 * y * y
        rings.append(np.column_stack([rr * np.cos(ang) + lean, high, rr * np.sin(ang) - 0.4 * lean]))
    part = loft(np.array(rings), (True, True))
    dark = lambda p: np.where((np.hypot(p[:, 0] - 0.16 * p[:, 1] ** 2, p[:, 2]) < 0.215) & (p[:, 1] > 0.2), 0.0, N.smooth(-0.1, 0.5, p[:, 1]))
    part = paint(part, (0.10, 0.045, 0.036), (0.40, 0.20, 0.15), dark, 23, 0.40, 50)
    return box_uv(footed(part, 0.09), 0.3)


def tube_sponges():
    rng = np.random.default_rng(31)
    parts = []
    for k in range(9):
        a, s = k * 2.4, 0.035 + 0.013 * k
        h, r = 0.20 + 0.38 * rng.random(), 0.030 + 0.014 * rng.random()
        lean = np.array([np.cos(a) * 0.10, 0, np.sin(a) * 0.10]) * rng.random()
        prof = [(1.0, 0.0), (0.9, 0.25), (1.0, 0.6), (1.12, 0.9), (1.1, 0.98), (0.95, 1.0), (0.72, 0.98), (0.62, 0.8), (0.1, 0.72)]
        n = 12
        ang = np.arange(n) / n * 2 * np.pi
        rings = []
        for q, y in prof:
            c = np.column_stack([np.cos(ang) * 2 + k, np.full(n, y * 4), np.sin(ang) * 2])
            rr = r * q * (1 + 0.10 * N.fbm3(c, 33, 1.5, 2))
            rings.append(np.column_stack([rr * np.cos(ang), np.full(n, y * h), rr * np.sin(ang)]) + lean * y)
        parts.append(loft(rings, (True, True)).at(s * 1.6 * np.cos(a), -0.03, s * 1.6 * np.sin(a)))
    parts.append(holdfast(0.25, 0.09, 36))  # the mat from which the tubes rise
    return box_uv(footed(paint(join(parts), (0.52, 0.36, 0.06), (0.96, 0.78, 0.22), lambda p: N.smooth(-0.05, 0.4, p[:, 1]), 35), 0.06), 0.25)


def anemone():
    rng = np.random.default_rng(41)
    parts = [revolve([(0.13, -0.03), (0.12, 0.03), (0.15, 0.075), (0.10, 0.09), (0.02, 0.08)], 22).rot("x", -90)]
    for k in range(96):
        s, a = 0.03 + 0.115 * np.sqrt(k / 96), k * 2.39996
        way = unit([np.cos(a) * (0.25 + 4.2 * s), 0.9, np.sin(a) * (0.25 + 4.2 * s)])
        ln = 0.10 + 0.06 * rng.random()
        q = np.linspace(0, 1, 5)[:, None]
        sway = np.array([0.035, 0.0, 0.018])
        p = np.array([s * np.cos(a), 0.075, s * np.sin(a)]) + way * ln * q + sway * q**2 + 0.008 * np.sin(q * 5 + k) * rng.normal(0, 1, 3)
        parts.append(tube(p, [0.009, 0.0085, 0.0078, 0.008, 0.005], 4, (False, True)))
    tip = lambda p: N.smooth(0.09, 0.22, p[:, 1] + 0.25 * np.maximum(0, np.hypot(p[:, 0], p[:, 2]) - 0.12))
    return box_uv(paint(join(parts), (0.30, 0.34, 0.16), (0.72, 0.46, 0.62), tip, 43, 0.08, 70), 0.2)


def starfish():
    n, m = 60, 8
    ang = np.arange(n) / n * 2 * np.pi
    arm = 0.5 + 0.5 * np.cos(5 * ang)
    reach = 0.036 + 0.090 * arm**2.2
    rings = []
    for k, s in enumerate(np.concatenate([np.linspace(0.03, 1, m), np.linspace(0.97, 0.1, 3)])):
        top = k < m
        r = reach * s
        ridge = np.sqrt(np.maximum(0, 1 - s**2))
        y = (0.006 + 0.017 * ridge * (0.45 + 0.55 * arm * (1 - 0.4 * s))) if top else np.full(n, 0.0)
        y = y + (0.0022 * np.sin(s * 40) * np.sin(ang * 40) if top else 0)
        p = np.column_stack([r * np.cos(ang), np.broadcast_to(y, n), r * np.sin(ang)])
        p[:, 1] += 0.010 * np.sin(3 * ang + 1) * s * (reach / 0.126) * 0.4 + 0.004
        rings.append(p)
    part = loft(rings, (True, True))
    return box_uv(paint(part, (0.62, 0.16, 0.05), (0.95, 0.50, 0.20), lambda p: 0.5 + 0.9 * N.fbm3(p, 45, 60, 2), 47, 0.2, 60), 0.12)


def urchin():
    rng = np.random.default_rng(51)
    v, f = icosphere(2)
    body = Part(v * np.array([0.045, 0.034, 0.045]) + [0, 0.028, 0], f)
    parts = [body]
    dirs, _ = icosphere(2)
    for d in dirs:
        if d[1] < -0.45:
            continue
        d = unit(d + rng.normal(0, 0.10, 3))
        ln = 0.07 + 0.07 * rng.random()
        b = np.array([0, 0.028, 0]) + d * 0.030
        parts.append(tube(np.array([b, b + d * ln * 0.6, b + d * ln]), [0.0022, 0.0016, 0.0004], 4, (False, False)))
    return box_uv(paint(join(parts), (0.035, 0.025, 0.045), (0.12, 0.09, 0.14), lambda p: N.smooth(0.03, 0.14, np.linalg.norm(p - [0, 0.03, 0], axis=1)), 53, 0.1), 0.1)


def scallop(size, rng):
    n, m = 17, 7
    a, s = np.meshgrid(np.linspace(-1.15, 1.15, n), np.linspace(0.05, 1, m))
    rib = 0.035 * np.cos(a * 26)
    r = s * (1 + 0.05 * np.cos(a * 26) * s)
    x, z = r * np.sin(a), -r * np.cos(a) + 0.45
    y = 0.30 * np.sin(np.pi * np.clip(s, 0, 1) * 0.62) * np.cos(a * 0.9) * (1.15 - s) * 1.5 + rib * s + 0.02
    pos = np.stack([x, y, z], 2).reshape(-1, 3) * size
    i, j = np.meshgrid(np.arange(m - 1), np.arange(n - 1), indexing="ij")
    b = (i * n + j).ravel()
    tri = np.concatenate([np.stack([b, b + 1, b + n + 1], 1), np.stack([b, b + n + 1, b + n], 1)])
    part = Part(pos, tri, np.stack([a, s], 2).reshape(-1, 2))
    if shade(part, 80).nrm[:, 1].sum() < 0:
        part = part.flipped()
    part = part.rot("x", rng.normal(0, 16)).rot("y", rng.random() * 360)
    tone = rng.choice([0, 1, 2])
    low, high = (((0.70, 0.50, 0.40), (0.95, 0.86, 0.76)), ((0.80, 0.78, 0.72), (0.96, 0.95, 0.90)), ((0.42, 0.36, 0.33), (0.72, 0.66, 0.60)))[tone]
    return paint(part, low, high, lambda p: 0.5 + 0.5 * np.cos(np.linalg.norm(p, axis=1) / size * 22), 61, 0.08, 80)


def turret(size, rng):
    t = np.linspace(0, 6 * 2 * np.pi, 56)
    k = t / t[-1]
    r = size * 0.30 * (1 - k) ** 1.05 + 0.0004
    path = np.column_stack([r * np.cos(t), size * (0.30 * (1 - k) + 1.7 * k), r * np.sin(t)])
    part = tube(path, np.maximum(size * 0.25 * (1 - k) ** 1.02, 0.0004), 7, (True, True))
    part = part.rot("z", 84).at(0, size * 0.25, 0).rot("y", rng.random() * 360)
    return paint(part, (0.52, 0.40, 0.30), (0.86, 0.78, 0.66), lambda p: 0.5 + 0.7 * N.fbm3(p, 63, 40, 2), 65, 0.12, 80)


def shells():
    """A handful of shells and halves of shells, within 0.3 m."""
    rng = np.random.default_rng(60)
    parts = []
    for k in range(11):
        r, a = 0.30 * np.sqrt(rng.random()), rng.random() * 2 * np.pi
        size = 0.018 + 0.020 * rng.random()
        one = scallop(size, rng) if k % 4 else turret(size * 1.3, rng)
        parts.append(one.at(r * np.cos(a), -0.10 * size, r * np.sin(a)))
    return box_uv(join(parts), 0.2)


def rubble():
    """Broken coral and stones as they lie: within 0.55 m, a third to two thirds of each sunk in."""
    rng = np.random.default_rng(70)
    parts = []
    for k in range(46):
        r, a = 0.55 * rng.random() ** 0.7, rng.random() * 2 * np.pi
        if k % 3:
            size = 0.012 + 0.055 * rng.random() ** 2.6
            parts.append(B.stone(size, k, rng, k % 9 == 1).at(r * np.cos(a), size * (0.12 - 0.30 * rng.random()), r * np.sin(a)))
        else:
            rad = 0.007 + 0.005 * rng.random()
            parts.append(B.stick(0.05 + 0.09 * rng.random(), rad, k, rng).at(r * np.cos(a), rad * (0.4 - 0.8 * rng.random()), r * np.sin(a)))
    return join(parts)


def scree():
    """Stones and sticks within 0.2 m, about half of each sunk in, for slopes: a small patch lies close to any ground."""
    rng = np.random.default_rng(71)
    parts = []
    for k in range(15):
        r, a = 0.20 * rng.random() ** 0.6, rng.random() * 2 * np.pi
        if k % 4:
            size = 0.012 + 0.060 * rng.random() ** 2.2
            parts.append(B.stone(size, 50 + k, rng, size > 0.04).at(r * np.cos(a), size * (0.19 - 0.36 * rng.random()), r * np.sin(a)))
        else:
            rad = 0.007 + 0.005 * rng.random()
            parts.append(B.stick(0.05 + 0.07 * rng.random(), rad, 50 + k, rng).at(r * np.cos(a), rad * (0.3 - 0.7 * rng.random()), r * np.sin(a)))
    return join(parts)


def stone_skin(n=256):
    """Weathered stone and dead coral, 25 cm: stains and hollows, little contrast. Vertex colours tint it."""
    stain, mid, fine = N.spectral(n, 81, 2.6, 2, 30), N.spectral(n, 82, 2.0, 8, 90), N.spectral(n, 83, 0.8, 30)
    pits, bowl, _ = N.bumps(n, 0.25, 90, 84, 0.0015, 0.006, where=N.smooth(-0.5, 1.5, stain))
    tone = 0.84 + 0.05 * stain + 0.045 * mid + 0.03 * fine - 0.10 * pits
    col = N.mix(tone[..., None] * np.ones(3), (0.70, 0.71, 0.58), 0.35 * N.smooth(0.2, 1.6, stain))
    return np.clip(col, 0, 1), N.normal_map(0.0011 * mid + 0.0002 * fine - 0.6 * bowl, 0.25, steepest=0.7)


def polyps(n=256):
    d1, d2, who = N.cells(n, 260, 3)
    size = np.random.default_rng(4).random(260)[who]
    a, f = N.spectral(n, 5, 1.8, 2), N.spectral(n, 6, 0.6, 40)
    pit = N.smooth(0.026, 0.008, d1) * (0.4 + 0.6 * size)
    col = 0.86 + 0.06 * a + 0.05 * f - 0.30 * pit
    return np.clip(col[..., None] * np.ones(3), 0, 1), N.normal_map(-0.0018 * pit + 0.0012 * a + 0.0004 * f, 0.25)


def main():
    g = Glb("reef", packed=True)
    pc, pn = polyps()
    coral = g.material("coral", base=g.texture("coral_color", pc, 80), normal=g.texture("coral_normal", pn, 78), rough=0.85)
    h = maze()
    ridge = np.clip((0.62 + 0.42 * h)[..., None] * np.ones(3), 0, 1)
    brain_m = g.material("brain", base=g.texture("brain_color", ridge, 80), normal=g.texture("brain_normal", N.normal_map(0.006 * h, 0.22), 80), rough=0.8)
    fan_m = g.material("fan", base=g.texture("fan_color", fan_texture()), rough=0.8, double=True, mask=0.3)
    shell_m = g.material("shell", base=g.doc["materials"][coral]["pbrMetallicRoughness"]["baseColorTexture"]["index"], rough=0.55, double=True)
    sc, sn = stone_skin()
    stone_m = g.material("stone", base=g.texture("stone_color", sc, 78), normal=g.texture("stone_normal", sn, 72), rough=0.9)
    kinds = [
        ("staghorn", staghorn, coral), ("table", table, coral), ("brain", brain, brain_m), ("fan", fan, fan_m),
        ("whip", whip, coral), ("barrel_sponge", barrel_sponge, coral), ("tube_sponges", tube_sponges, coral),
        ("anemone", anemone, coral), ("starfish", starfish, coral), ("urchin", urchin, coral),
        ("shells", shells, shell_m), ("rubble", rubble, stone_m), ("scree", scree, stone_m),
    ]
    color = sand()[0]
    sand_m = g.material("sand", B.SAND, base=g.texture("sand_color", color[: len(color) // 4, : len(color) // 4], 76), rough=0.95)
    # The foot's radius, how far the sand reaches, how high it lies, and how many stones are in it.
    beds = {"staghorn": (0.21, 0.46, 0.115, 16), "table": (0.19, 0.42, 0.11, 12), "brain": (0.33, 0.60, 0.105, 15),
            "anemone": (0.14, 0.30, 0.07, 9), "tube_sponges": (0.27, 0.56, 0.13, 17)}
    for k, (name, make, material) in enumerate(kinds):
        mesh, at = g.mesh(name, [(make(), material)]), (1.25 * (k % 6 - 2.5), 0, 1.4 * (k // 6 - 0.5))
        g.node(name, mesh, at=at)
        if name in beds:
            foot, reach, height, count = beds[name]
            bed = [(B.sand(reach, height, foot, 100 + k), sand_m), (join(B.stones(count, foot, reach, height, 100 + k)), stone_m)]
            both = g.node(f"{name}_bed", at=(at[0], 0, at[2] + 2.8))
            g.node(f"{name}_of_bed", mesh, parent=both)
            g.node(f"{name}_sand", g.mesh(f"{name}_sand", bed), parent=both)
    g.save(OUT / "reef.glb")


if __name__ == "__main__":
    main()
