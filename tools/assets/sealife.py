"""Small life for instancing: kelp.glb, seagrass.glb, corals.glb (coral_0..2), fish.glb (clip swim).

Plants stand on y = 0; a shader that sways them can take the weight from height.
The fish is 0.25 m long, nose along -z, origin at its middle.
"""
from pathlib import Path

import numpy as np

import fish_skin
import fish_swim
import noise as N
import sdf as S
from glb import Glb
from mesh import box_uv, join, loft, Part, shade
from shapes import sphere, tube

OUT = Path(__file__).resolve().parents[2] / "assets" / "models"


def ribbon(path, width, normal, u0=0.0, u1=1.0, curl=0.0):
    """A two-triangle-wide leaf along a path; v runs root (1) to tip (0)."""
    p = np.asarray(path, float)
    t = np.gradient(p, axis=0)
    side = np.cross(t, normal)
    side /= np.linalg.norm(side, axis=1, keepdims=True) + 1e-9
    up = np.cross(side, t / np.linalg.norm(t, axis=1, keepdims=True))
    w = np.asarray(width)[:, None]
    rows = np.stack([p - side * w / 2 + up * curl * w, p, p + side * w / 2 + up * curl * w], 1)
    k = len(p)
    v = np.linspace(0.98, 0.02, k)
    uv = np.stack([np.tile([u0, (u0 + u1) / 2, u1], (k, 1)), np.tile(v[:, None], (1, 3))], 2)
    i = np.arange(k - 1)[:, None] * 3 + np.arange(2)
    a = i.ravel()
    tri = np.concatenate([np.stack([a, a + 1, a + 4], 1), np.stack([a, a + 4, a + 3], 1)])
    return Part(rows.reshape(-1, 3), tri, uv.reshape(-1, 2))


def tint(part, rgb_low, rgb_high, top):
    part = shade(part, 80)
    k = np.clip(part.pos[:, 1] / top, 0, 1)
    c = N.mix(np.tile(rgb_low, (len(k), 1)), np.asarray(rgb_high, float), k)
    part.col = np.column_stack([c, np.ones(len(k))])
    return part


def leaf_texture(n=512):
    """Ruffled brown-green blade: midrib, veins, bitten pale edges; U across, V down to the root."""
    x = np.abs((np.arange(n) + 0.5) / n * 2 - 1)[None, :] * np.ones((n, 1))
    y = ((np.arange(n) + 0.5) / n)[:, None] * np.ones((1, n))
    a, f = N.spectral(n, 2, 1.8, 2), N.spectral(n, 3, 0.8, 30)
    ruff = N.spectral(n, 4, 1.6, 5, 60, stretch=(1, 1.8))
    col = N.mix(N.flat(n, (0.52, 0.50, 0.20)), (0.36, 0.32, 0.11), N.smooth(-1, 1.2, a + 0.5 * ruff))
    col = N.mix(col, (0.66, 0.62, 0.34), 0.6 * N.smooth(0.10, 0.02, x) + 0.35 * N.smooth(0.80, 1, x))
    col = N.mix(col, (0.30, 0.24, 0.10), 0.5 * N.smooth(1.2, 2.2, a + f * 0.5))
    col *= (1 + 0.05 * f)[..., None]
    return np.clip(col, 0, 1), N.normal_map(0.004 * ruff + 0.006 * N.smooth(0.12, 0.0, x), 0.25, 0.6)


def kelp():
    rng = np.random.default_rng(7)
    stems, leaves = [], []
    for s in range(3):
        a0, top = s * 2.1 + 0.4, 3.4 + 0.8 * rng.random()
        ph = rng.random() * 6
        hgt = np.linspace(0, top, 26)
        lean = 0.20 * (hgt / top) ** 1.5
        path = np.column_stack(
            [
                0.06 * np.cos(a0) + lean * np.cos(a0) * 1.6 + 0.07 * np.sin(hgt * 1.9 + ph),
                hgt,
                0.06 * np.sin(a0) + lean * np.sin(a0) * 1.6 + 0.07 * np.cos(hgt * 1.6 + ph),
            ]
        )
        stems.append(tube(path, np.linspace(0.013, 0.006, 26), 6))
        for k, y in enumerate(np.arange(0.35, top, 0.13)):
            at = np.array([np.interp(y, hgt, path[:, c]) for c in range(3)])
            a = k * 2.4 + rng.normal(0, 0.3)
            out = np.array([np.cos(a), 0, np.sin(a)])
            ln = (0.42 + 0.16 * rng.random()) * (1 - 0.35 * (y / top) ** 3)
            q = np.linspace(0, 1, 7)[:, None]
            bend = (
                at
                + out * ln * (q * 0.85)
                + np.array([0, 1, 0]) * ln * (0.32 * q - 0.50 * q**2 + 0.05 * np.sin(q * 9 + k))
            )
            w = 0.11 * np.sin(np.pi * np.linspace(0.10, 0.99, 7) ** 0.7) + 0.002
            side = np.cross(out, [0, 1, 0])
            leaves.append(ribbon(bend, w, np.array([0, 1, 0]) + 0.7 * side * rng.normal(0, 1), curl=0.10))
            stems.append(sphere(0.014, 6, 4).scaled(1, 1.5, 1).at(*(at + out * 0.035)))
    return join(
        [
            tint(join(leaves), (0.75, 0.72, 0.60), (1, 1, 0.9), 4.2),
            tint(join(stems), (0.55, 0.5, 0.4), (0.8, 0.78, 0.6), 4.2),
        ]
    )


def seagrass():
    rng = np.random.default_rng(9)
    out = []
    for _ in range(46):
        r, a = 0.20 * np.sqrt(rng.random()), rng.random() * 2 * np.pi
        base = np.array([r * np.cos(a), -0.02, r * np.sin(a)])
        ln, d = 0.28 + 0.34 * rng.random(), rng.random() * 2 * np.pi
        lean = 0.10 + 0.30 * rng.random()
        q = np.linspace(0, 1, 6)[:, None]
        way = np.array([np.cos(d), 0, np.sin(d)])
        p = (
            base
            + np.array([0, 1, 0]) * ln * q * (1 - 0.25 * lean * q)
            + way * ln * lean * q**2
            + np.array([0.03, 0, 0.02]) * np.sin(q * 4 + d)
        )
        w = 0.011 * np.array([0.8, 1, 1, 0.95, 0.8, 0.15])
        out.append(ribbon(p, w, way + rng.normal(0, 0.3, 3), 0.25, 0.75, 0.12))
    return tint(join(out), (0.28, 0.42, 0.16), (0.62, 1.0, 0.40), 0.5)


def coral(kind):
    rng = np.random.default_rng(50 + kind)
    if kind == 0:  # tube sponges
        bits = [
            (
                ((0.05 + 0.022 * k) * np.cos(a), (0.05 + 0.022 * k) * np.sin(a)),
                0.25 + 0.42 * rng.random(),
                0.042 + 0.022 * rng.random(),
                rng.normal(0, 0.12, 2),
            )
            for k, a in enumerate(np.arange(8) * 2.4)
        ]

        def f(p):
            d = S.ellipsoid(p, [0, -0.02, 0], [0.26, 0.09, 0.26])
            inner = np.full(len(p), 9.0)
            for (x, z), h, r, ln in bits:
                a, b = np.array([x, 0, z]), np.array([x + ln[0], h, z + ln[1]])
                d = S.union(d, S.capsule(p, a, b, r * 0.8, r * 1.15), 0.025)
                inner = np.minimum(inner, S.capsule(p, (a + b) / 2, b * 1.0 + (b - a) * 0.4, r * 0.5, r * 0.72))
            return S.both(d, -inner, 0.012) + 0.005 * N.value3(p, 3, 30)

        part = S.surface_nets(f, [-0.55, -0.12, -0.55], [0.55, 0.82, 0.55], 0.034)
        lo, hi = (0.55, 0.30, 0.10), (0.92, 0.62, 0.20)
    elif kind == 1:  # brain coral lump

        def f(p):
            d = S.ellipsoid(p, [0, 0.10, 0], [0.34, 0.27, 0.31])
            d = S.union(d, S.ellipsoid(p, [0.22, 0.06, 0.14], [0.18, 0.16, 0.18]), 0.05)
            d = S.union(d, S.ellipsoid(p, [-0.20, 0.04, -0.16], [0.20, 0.13, 0.17]), 0.05)
            w = N.fbm3(p, 5, 9, 1)
            return d - 0.016 * np.cos(w * 11) * 0.8

        part = S.surface_nets(f, [-0.46, -0.10, -0.44], [0.46, 0.44, 0.42], 0.032)
        lo, hi = (0.40, 0.42, 0.28), (0.74, 0.68, 0.46)
    else:  # branching coral
        segs = []

        def grow(at, way, r, left):
            end = at + way * (0.11 + 0.06 * rng.random()) * (0.7 + 0.12 * left)
            segs.append((at, end, r, r * 0.82))
            if left:
                for _ in range(2 if left < 3 else 3):
                    w = way + rng.normal(0, 0.48, 3)
                    w[1] = abs(w[1]) * 0.7 + 0.25
                    grow(end, w / np.linalg.norm(w), r * 0.80, left - 1)

        grow(np.array([0, -0.03, 0.0]), np.array([0, 1.0, 0]), 0.044, 4)

        def f(p):
            d = S.ellipsoid(p, [0, -0.01, 0], [0.12, 0.05, 0.12])
            for a, b, ra, rb in segs:
                d = S.union(d, S.capsule(p, a, b, ra, rb), 0.015)
            return d

        part = S.surface_nets(f, [-0.55, -0.08, -0.55], [0.55, 0.75, 0.55], 0.026)
        lo, hi = (0.50, 0.20, 0.22), (0.95, 0.62, 0.58)
    ao = N.smooth(-0.05, 0.25, part.pos[:, 1]) * 0.5 + 0.5
    k = N.smooth(0.0, 0.55, part.pos[:, 1] + 0.06 * N.fbm3(part.pos, 8, 12, 2))
    c = N.mix(np.tile(lo, (len(k), 1)), np.asarray(hi), k) ** 1.6 * ao[:, None]
    part.col = np.column_stack([np.clip(c, 0, 1), np.ones(len(k))])
    part.nrm = None
    return box_uv(shade(part, 75), 0.35)


def polyps(n=256):
    d1, d2, who = N.cells(n, 300, 3)
    size = np.random.default_rng(4).random(420)[who]
    a, f = N.spectral(n, 5, 1.8, 2), N.spectral(n, 6, 0.6, 50)
    pit = N.smooth(0.022, 0.006, d1) * (0.4 + 0.6 * size)
    col = 0.84 + 0.06 * a + 0.04 * f - 0.35 * pit
    return np.clip(col[..., None] * np.ones(3), 0, 1), N.normal_map(-0.0022 * pit + 0.0015 * a + 0.0004 * f, 0.35)


def fish():
    """About 280 triangles: body strip, eye painted, forked tail, fins."""
    zs = np.array([-0.125, -0.118, -0.100, -0.070, -0.030, 0.015, 0.055, 0.085])
    h = np.array([0.002, 0.012, 0.024, 0.037, 0.043, 0.036, 0.021, 0.011])
    w = np.array([0.002, 0.008, 0.014, 0.019, 0.020, 0.016, 0.009, 0.004])
    v = np.linspace(0, 1, 7)
    rows, uv = [], []
    for z, hh, ww in zip(zs, h, w):
        a = np.pi * v
        rows.append(np.column_stack([ww * np.sin(a), hh * np.cos(a) - 0.003 * (z > 0), np.full(7, z)]))
        uv.append(np.column_stack([np.full(7, (z + 0.125) / 0.25), v]))
    p = loft(np.array(rows), (False, False), wrap=False, orient=False)
    p.uv = np.concatenate(uv)
    t = p.pos[p.tri]
    if np.cross(t[:, 1] - t[:, 0], t[:, 2] - t[:, 0])[:, 0].sum() < 0:
        p = p.flipped()

    def sheet(points, tri):
        q = np.array(points, float)
        return Part(q, tri, np.column_stack([(q[:, 2] + 0.125) / 0.25, np.clip(0.5 - q[:, 1] / 0.13, 0.03, 0.97)]))

    fan = lambda n: [(0, k, k + 1) for k in range(1, n - 1)]
    tail = sheet(
        [
            (0, 0, 0.080),
            (0, 0.009, 0.084),
            (0, 0.034, 0.118),
            (0, 0.040, 0.125),
            (0, 0.016, 0.112),
            (0, 0.0, 0.106),
            (0, -0.016, 0.112),
            (0, -0.040, 0.125),
            (0, -0.034, 0.118),
            (0, -0.009, 0.084),
        ],
        fan(10),
    )
    dorsal = sheet(
        [
            (0, 0.036, 0.0),
            (0, 0.036, -0.055),
            (0, 0.056, -0.040),
            (0, 0.054, -0.005),
            (0, 0.046, 0.030),
            (0, 0.026, 0.040),
        ],
        fan(6),
    )
    anal = sheet(
        [(0, -0.028, 0.025), (0, -0.020, 0.055), (0, -0.034, 0.052), (0, -0.048, 0.030), (0, -0.036, 0.005)], fan(5)
    )
    pect = sheet(
        [(0.018, -0.008, -0.055), (0.034, -0.012, -0.028), (0.030, -0.022, -0.022), (0.020, -0.022, -0.036)], fan(4)
    )
    thin = [tail, dorsal, anal, pect, pect.mirrored()]
    return shade(join([p, p.mirrored()]), 75), shade(join(thin), 60)


def fish_texture(n=256, m=512):
    """Colour and normals of a side, 0.25 by 0.11 m."""
    v = ((np.arange(n) + 0.5) / n)[:, None] * np.ones((1, m))
    u = ((np.arange(m) + 0.5) / m)[None, :] * np.ones((n, 1))
    col = N.mix(N.flat(n, (0.12, 0.24, 0.35), m), (0.74, 0.77, 0.76), N.smooth(0.26, 0.66, v))
    col = N.mix(col, (0.72, 0.58, 0.12), 0.8 * N.smooth(0.055, 0.03, np.abs(v - 0.40)))
    col = N.mix(col, (0.62, 0.50, 0.15), 0.8 * N.smooth(0.84, 0.92, u))
    col *= (1 - 0.35 * N.smooth(0.72, 0.98, v))[..., None]
    return fish_skin.dressed(col, length=0.25, girth=0.11, pitch=0.0052, eye=(0.115, 0.38), eye_r=0.0062, iris=(0.74, 0.72, 0.62), tail=0.84)


def main():
    c, nm = leaf_texture()
    for name, make in (("kelp", kelp), ("seagrass", seagrass)):
        g = Glb(name)
        m = g.material(
            "leaf",
            base=g.texture("leaf_color", c[::2, ::2], 82),
            normal=g.texture("leaf_normal", nm[::2, ::2], 80),
            rough=0.55,
            double=True,
        )
        g.node(name, g.mesh(name, [(make(), m)]))
        g.save(OUT / f"{name}.glb")
    g = Glb("corals")
    pc, pn = polyps()
    m = g.material(
        "coral", base=g.texture("coral_color", pc, 80), normal=g.texture("coral_normal", pn, 80), rough=0.8
    )
    for k in range(3):
        g.node(f"coral_{k}", g.mesh(f"coral_{k}", [(coral(k), m)]), at=(1.3 * (k - 1), 0, 0))
    g.save(OUT / "corals.glb")
    g = Glb("fish")
    color, bumps = fish_texture()
    b = g.texture("fish_color", color, 82)
    m_b = g.material("fish", base=b, rough=0.32, metal=0.3, normal=g.texture("fish_normal", bumps, 72))
    m_f = g.material("fin", (0.9, 0.9, 0.85, 1), base=b, rough=0.5, double=True, thin=0.5)
    body, thin = fish()
    fish_swim.swim(g, [fish_swim.swimmer(g, "fish", [(body, m_b), (thin, m_f)], 0.25, (0, 0, 0))])
    g.save(OUT / "fish.glb")


if __name__ == "__main__":
    main()
