"""A grey reef shark, 3 m, skinned on six spine joints, clip swim (1.5 s).

Nose at z = -1.5, tail tip at z = +1.5, y up. Joints spine_0 (head, root) to
spine_5 (tail) lie on the z axis; each swings about y. Proportions are a free
design after requiem sharks.
"""
from pathlib import Path

import numpy as np

import noise as N
from glb import Glb, quat
from mesh import join, loft, shade
from shapes import foil, sphere

OUT = Path(__file__).resolve().parents[2] / "assets" / "models"
JOINT_Z = np.array([-0.95, -0.50, -0.05, 0.38, 0.74, 1.04])
Z = [-1.5, -1.485, -1.45, -1.36, -1.22, -1.0, -0.72, -0.35, 0, 0.35, 0.65, 0.87, 1.0, 1.10]
WIDE = [0.0005, 0.035, 0.068, 0.112, 0.150, 0.188, 0.224, 0.240, 0.224, 0.165, 0.100, 0.060, 0.040, 0.020]
UP = [0.0005, 0.022, 0.042, 0.072, 0.108, 0.155, 0.205, 0.235, 0.218, 0.165, 0.108, 0.070, 0.052, 0.035]
DOWN = [0.0005, 0.020, 0.036, 0.055, 0.085, 0.135, 0.190, 0.222, 0.205, 0.155, 0.098, 0.060, 0.048, 0.035]
MID = [0.012, 0.012, 0.012, 0.012, 0.010, 0.004, 0, 0, 0, 0.006, 0.016, 0.024, 0.030, 0.034]


def spline(x, y):
    """Monotone-ish smooth table lookup: cubic through the points with limited slopes."""
    x, y = np.asarray(x, float), np.asarray(y, float)
    d = np.diff(y) / np.diff(x)
    m = np.concatenate(
        [[d[0]], np.where(d[:-1] * d[1:] > 0, 2 * d[:-1] * d[1:] / (d[:-1] + d[1:] + 1e-12), 0), [d[-1]]]
    )

    def f(t):
        k = np.clip(np.searchsorted(x, t) - 1, 0, len(x) - 2)
        h = x[k + 1] - x[k]
        s = (t - x[k]) / h
        return (
            (1 + 2 * s) * (1 - s) ** 2 * y[k]
            + s * (1 - s) ** 2 * h * m[k]
            + s * s * (3 - 2 * s) * y[k + 1]
            + s * s * (s - 1) * h * m[k + 1]
        )

    return f


W, U, D, C = (spline(Z, a) for a in (WIDE, UP, DOWN, MID))


def mouth(x):
    """z of the mouth's line under the head."""
    return -1.318 + 13.0 * x**2


def body():
    zs = np.unique(
        np.round(
            np.concatenate(
                [
                    np.linspace(-1.5, -1.42, 8),
                    np.linspace(-1.42, -1.33, 5),
                    np.linspace(-1.33, -1.12, 32),
                    np.linspace(-1.12, -0.6, 16),
                    np.linspace(-0.6, 1.10, 36),
                ]
            ),
            4,
        )
    )
    v = np.linspace(0, 1, 31)
    rows, uvs = [], []
    for z in zs:
        a = np.pi * v
        w, up, dn, c = W(z), U(z), D(z), C(z)
        flat = N.smooth(-1.0, -1.3, z)
        x = w * np.sin(a) ** (1 - 0.12 * flat)
        cy = np.cos(a)
        y = c + np.where(cy > 0, up * np.abs(cy) ** 0.95, -dn * np.abs(cy) ** (1 - 0.35 * flat))
        keel = N.smooth(0.80, 1.0, z) * np.exp(-(((v - 0.5) / 0.08) ** 2)) * 0.018
        x = x + keel
        dm = z - mouth(x)
        under = N.smooth(0.62, 0.75, v) * (x < 0.125)
        y = y + under * (0.020 * np.exp(-((dm / 0.014) ** 2)) - 0.010 * np.exp(-(((dm - 0.045) / 0.03) ** 2)))
        gill = (
            sum(np.exp(-(((z - (-0.985 + 0.042 * k) - 0.10 * (v - 0.5)) / 0.008) ** 2)) for k in range(5))
            * N.smooth(0.33, 0.38, v)
            * N.smooth(0.66, 0.60, v)
        )
        x = x - 0.006 * gill
        rows.append(np.column_stack([np.maximum(x, 0), y, np.full(len(v), z)]))
        uvs.append(np.column_stack([np.full(len(v), (z + 1.5) / 3), 0.02 + 0.96 * v]))
    p = loft(np.array(rows), (False, False), wrap=False, orient=False)
    p.uv = np.concatenate(uvs)
    t = p.pos[p.tri]
    if np.cross(t[:, 1] - t[:, 0], t[:, 2] - t[:, 0])[:, 0].sum() < 0:
        p = p.flipped()
    both = shade(join([p, p.mirrored()]), 75)
    both.col = np.ones((len(both.pos), 4))
    return both


def fin(sections, light_below=False, tip=None, n=9):
    """Foil with the skin's texture; tip = (point, radius) darkens the end."""
    p = shade(foil(sections, n), 60)
    v = np.full(len(p.pos), 0.16)
    if light_below:
        v = np.where(p.nrm[:, 1] < -0.1, 0.88, 0.18)
    p.uv = np.column_stack(
        [
            (p.pos[:, 2] + 1.5) / 3 + 0.05 * p.pos[:, 1],
            v * 0.8 + 0.22 * np.abs(p.pos[:, 1]) + 0.25 * np.abs(p.pos[:, 0]) * (0 if light_below else 1),
        ]
    )
    dark = 0 * v if tip is None else N.smooth(tip[1], tip[1] * 0.35, np.linalg.norm(p.pos - np.array(tip[0]), axis=1))
    p.col = np.column_stack([np.ones((len(v), 3)) * (1 - 0.62 * dark)[:, None], np.ones(len(v))])
    return p


def fins():
    X, Y = [1, 0, 0], [0, 1, 0]
    out = [
        fin(
            [
                ([0, 0.12, -0.42], [0, 0.10, 0.10], 0.052, X),
                ([0, 0.24, -0.36], [0, 0.20, 0.10], 0.046, X),
                ([0, 0.40, -0.20], [0, 0.36, 0.11], 0.030, X),
                ([0, 0.53, -0.04], [0, 0.50, 0.125], 0.016, X),
                ([0, 0.585, 0.045], [0, 0.565, 0.140], 0.009, X),
                ([0, 0.607, 0.095], [0, 0.602, 0.140], 0.003, X),
            ],
            tip=([0, 0.62, 0.14], 0.22),
        )
    ]
    out.append(
        fin(
            [
                ([0, 0.06, 0.58], [0, 0.07, 0.78], 0.020, X),
                ([0, 0.155, 0.64], [0, 0.14, 0.78], 0.014, X),
                ([0, 0.198, 0.72], [0, 0.19, 0.82], 0.006, X),
                ([0, 0.215, 0.765], [0, 0.21, 0.83], 0.002, X),
            ],
            tip=([0, 0.21, 0.81], 0.10),
        )
    )
    out.append(
        fin(
            [
                ([0, -0.04, 0.62], [0, -0.03, 0.80], 0.020, X),
                ([0, -0.13, 0.69], [0, -0.11, 0.81], 0.012, X),
                ([0, -0.185, 0.77], [0, -0.175, 0.84], 0.005, X),
            ],
            tip=([0, -0.19, 0.84], 0.10),
        )
    )
    # tail: upper and lower lobes share the root
    out.append(
        fin(
            [
                ([0, 0.0, 0.96], [0, 0.03, 1.22], 0.040, X),
                ([0, 0.10, 1.02], [0, 0.10, 1.245], 0.030, X),
                ([0, 0.26, 1.17], [0, 0.25, 1.335], 0.018, X),
                ([0, 0.42, 1.33], [0, 0.41, 1.435], 0.010, X),
                ([0, 0.50, 1.415], [0, 0.495, 1.480], 0.006, X),
                ([0, 0.545, 1.475], [0, 0.543, 1.497], 0.002, X),
            ],
            tip=([0, 0.50, 1.50], 0.42),
        )
    )
    out.append(
        fin(
            [
                ([0, 0.06, 0.96], [0, 0.06, 1.23], 0.040, X),
                ([0, -0.04, 1.01], [0, -0.03, 1.215], 0.028, X),
                ([0, -0.15, 1.10], [0, -0.14, 1.225], 0.016, X),
                ([0, -0.255, 1.21], [0, -0.25, 1.265], 0.004, X),
            ],
            tip=([0, -0.26, 1.26], 0.30),
        )
    )
    pect = [
        fin(
            [
                ([0.12, -0.085, -0.80], [0.11, -0.10, -0.48], 0.052, Y),
                ([0.24, -0.125, -0.74], [0.23, -0.13, -0.46], 0.040, Y),
                ([0.42, -0.185, -0.60], [0.40, -0.185, -0.38], 0.024, Y),
                ([0.58, -0.24, -0.43], [0.56, -0.238, -0.30], 0.012, Y),
                ([0.65, -0.266, -0.335], [0.635, -0.262, -0.255], 0.007, Y),
                ([0.688, -0.280, -0.270], [0.682, -0.278, -0.245], 0.002, Y),
            ],
            True,
            ([0.69, -0.28, -0.26], 0.22),
        ),
        fin(
            [
                ([0.05, -0.13, 0.30], [0.04, -0.11, 0.52], 0.024, [0.6, 0.8, 0]),
                ([0.12, -0.185, 0.37], [0.10, -0.17, 0.53], 0.016, [0.6, 0.8, 0]),
                ([0.17, -0.235, 0.47], [0.16, -0.225, 0.565], 0.005, [0.6, 0.8, 0]),
            ],
            True,
            ([0.17, -0.235, 0.56], 0.10),
        ),
    ]
    return out + pect + [p.mirrored() for p in pect]


def eyes():
    out = []
    z = -1.285
    white = []
    for s in (1, -1):
        e = shade(sphere(0.0178, 12, 8).rot("y", 90), 80).at(s * (W(z) - 0.006), 0.030, z)
        out.append(e)
        ring = shade(sphere(0.0215, 12, 8).scaled(0.55, 1, 1), 80).at(s * (W(z) - 0.0045), 0.030, z)
        white.append(ring)
    return join(out), white


def bind(p):
    """Weights slide from joint to joint along z."""
    z = p.pos[:, 2]
    step = np.stack([np.ones(len(z))] + [N.smooth(b - 0.20, b + 0.20, z) for b in JOINT_Z[1:]], 1)
    w = step - np.concatenate([step[:, 1:], np.zeros((len(z), 1))], 1)
    w = np.maximum(w, 0)
    j = np.argsort(-w, 1, kind="stable")[:, :4]
    top = np.take_along_axis(w, j, 1)
    top /= top.sum(1, keepdims=True)
    p.joints, p.weights = np.where(top > 0, j, 0), top
    return p


def skin_texture(n=512, m=1024):
    """U nose to tail, V back (0) to belly (1)."""
    v = ((np.arange(n) + 0.5) / n)[:, None] * np.ones((1, m))
    z = (((np.arange(m) + 0.5) / m) * 3 - 1.5)[None, :] * np.ones((n, 1))
    a, f = N.spectral(n, 3, 1.8, 2, m=m), N.spectral(n, 4, 0.5, 50, m=m)
    top, low = np.array((0.40, 0.43, 0.44)), np.array((0.90, 0.90, 0.87))
    line = 0.56 + 0.035 * np.sin(z * 2.1 + 0.8) + 0.05 * N.smooth(-1.1, -1.45, z) + 0.012 * a
    belly = N.smooth(-0.035, 0.05, v - line)
    col = N.mix(N.flat(n, top, m) * (1 - 0.16 * N.smooth(0.35, 0.0, v))[..., None], low, belly)
    band = N.smooth(0.03, 0.0, np.abs(v - line + 0.055 - 0.02 * z)) * N.smooth(-0.6, 0.0, z) * N.smooth(1.0, 0.6, z)
    col = N.mix(col, low * 0.86, band * 0.35)
    col *= (1 + 0.035 * a + 0.015 * f)[..., None]
    spots = N.smooth(1.6, 2.6, N.spectral(n, 5, 1.0, 10, 80, m=m)) * (1 - belly)
    col *= (1 - 0.12 * spots)[..., None]
    gill = np.zeros((n, m))
    for k in range(5):
        d = np.abs(z - (-0.985 + 0.042 * k) - 0.10 * (v - 0.5))
        gill = np.maximum(gill, N.smooth(0.0065, 0.002, d) * N.smooth(0.33, 0.37, v) * N.smooth(0.66, 0.60, v))
    col = N.mix(col, (0.14, 0.13, 0.13), gill * 0.85)
    x = np.sin(np.pi * np.clip((v - 0.02) / 0.96, 0, 1)) * np.interp(z, Z, WIDE)
    dm = np.abs(z - mouth(x))
    lips = N.smooth(0.014, 0.006, dm) * N.smooth(0.64, 0.72, v) * (z < -1.13)
    col = N.mix(col, (0.22, 0.13, 0.12), lips * 0.9)
    nose = N.smooth(0.012, 0.006, np.hypot((z + 1.425), (v - 0.74) * 0.22))
    col = N.mix(col, (0.12, 0.11, 0.11), nose)
    h = 0.00025 * f + 0.001 * a - 0.006 * gill - 0.004 * lips
    rough = 0.50 + 0.04 * f + 0.08 * belly
    return np.clip(col, 0, 1), N.rough_metal(np.clip(rough, 0.3, 0.8)), N.normal_map(h, 3.0, 1.1)


def main():
    g = Glb("shark")
    c, mr, n = skin_texture()
    m_skin = g.material(
        "skin",
        base=g.texture("skin_color", c, 90),
        mr=g.texture("skin_mr", mr, 80),
        normal=g.texture("skin_normal", n, 78),
        normal_scale=0.35,  # fins stand at grazing light, which makes noise of more
        metal=1.0,
        rough=1.0,
    )
    m_eye = g.material("eye", (0.012, 0.012, 0.014, 1), rough=0.08)
    eye, rims = eyes()
    for r in rims:
        r.uv = np.tile([0.07, 0.9], (len(r.pos), 1))
        r.col = np.tile([0.30, 0.31, 0.31, 1.0], (len(r.pos), 1))
    mesh = g.mesh("shark", [(bind(join([body()] + fins() + rims)), m_skin), (bind(eye), m_eye)])
    nodes, prev = [], None
    for k, z in enumerate(JOINT_Z):
        prev = g.node(f"spine_{k}", at=(0, 0, z - (JOINT_Z[k - 1] if k else 0)), parent=prev)
        nodes.append(prev)
    s = g.skin("shark", nodes, np.column_stack([0 * JOINT_Z, 0 * JOINT_Z, JOINT_Z]))
    g.node("shark", mesh, skin=s)
    t = np.linspace(0, 1.5, 31)
    ph = t / 1.5 * 2 * np.pi
    amp, lag = (3.0, 3.5, 6.0, 9.5, 13.0, 17.0), (2.6, 0.2, -0.6, -1.4, -2.2, -3.0)
    tracks = [(nodes[k], "rotation", quat("y", amp[k] * np.sin(ph + lag[k]))) for k in range(6)]
    tracks.append(
        (nodes[0], "translation", np.column_stack([0.025 * np.sin(ph + 2.0), 0 * ph, np.full(len(ph), JOINT_Z[0])]))
    )
    g.animation("swim", t, tracks)
    g.save(OUT / "shark.glb")


if __name__ == "__main__":
    main()
