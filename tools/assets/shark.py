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
# The body narrows to a blade's edge within the tail fin.
Z = [-1.5, -1.485, -1.45, -1.36, -1.22, -1.0, -0.72, -0.35, 0, 0.35, 0.65, 0.87, 1.0, 1.07, 1.12, 1.16]
WIDE = [0.0005, 0.035, 0.068, 0.112, 0.150, 0.188, 0.224, 0.240, 0.224, 0.165, 0.100, 0.058, 0.035, 0.022, 0.011, 0.002]
UP = [0.0005, 0.022, 0.042, 0.072, 0.108, 0.155, 0.205, 0.235, 0.218, 0.165, 0.108, 0.070, 0.054, 0.050, 0.046, 0.040]
DOWN = [0.0005, 0.020, 0.036, 0.055, 0.085, 0.135, 0.190, 0.222, 0.205, 0.155, 0.098, 0.062, 0.050, 0.046, 0.042, 0.036]
MID = [0.012, 0.012, 0.012, 0.012, 0.010, 0.004, 0, 0, 0, 0.006, 0.016, 0.024, 0.030, 0.036, 0.042, 0.046]
# Gill slits: z at mid height, and half their length as a share of the girth from back to belly.
GILLS = ((-0.985, 0.150), (-0.940, 0.155), (-0.896, 0.150), (-0.853, 0.135), (-0.812, 0.110))
GILL_SLANT, GILL_MID = 0.11, 0.49


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


def slant(z):
    """How much rings lean along the gill slits, so that the slits run along rings."""
    return GILL_SLANT * N.smooth(-1.16, -1.0, z) * N.smooth(-0.62, -0.80, z)


def body():
    edges = [g + d for g, _ in GILLS for d in (-0.026, -0.010, -0.002, 0.0035, 0.013)]
    zs = np.unique(
        np.round(
            np.concatenate(
                [
                    np.linspace(-1.5, -1.42, 8),
                    np.linspace(-1.42, -1.33, 5),
                    np.linspace(-1.33, -1.12, 32),
                    np.linspace(-1.12, -1.02, 4),
                    edges,
                    np.linspace(-0.79, -0.6, 6),
                    np.linspace(-0.6, 1.0, 34),
                    np.linspace(1.0, 1.16, 9),
                ]
            ),
            4,
        )
    )
    v = np.linspace(0, 1, 31)
    rows, uvs = [], []
    for ring in zs:
        z = ring + slant(ring) * (v - GILL_MID) * np.sin(np.pi * v)
        a = np.pi * v
        w, up, dn, c = W(z), U(z), D(z), C(z)
        flat = N.smooth(-1.0, -1.3, z)
        x = w * np.sin(a) ** (1 - 0.12 * flat)
        cy = np.cos(a)
        y = c + np.where(cy > 0, up * np.abs(cy) ** 0.95, -dn * np.abs(cy) ** (1 - 0.35 * flat))
        # A low keel on each side of the tail's root.
        keel = N.smooth(0.72, 1.0, z) * N.smooth(1.14, 1.00, z) * np.exp(-(((v - 0.5) / 0.16) ** 2)) * 0.007
        x = x + keel
        dm = z - mouth(x)
        under = N.smooth(0.62, 0.75, v) * (x < 0.125)
        y = y + under * (0.011 * np.exp(-((dm / 0.032) ** 2)) - 0.006 * np.exp(-(((dm - 0.075) / 0.045) ** 2)))
        # Each slit: a flap that rises towards its free edge, and behind it a fold.
        for g, half in GILLS:
            d = ring - g
            long = N.smooth(half, half * 0.7, np.abs(v - GILL_MID))
            flap = 0.0075 * N.smooth(-0.030, -0.003, d) * (d < 0)
            fold = -0.011 * N.smooth(0.014, 0.003, d) * (d > 0)
            x = x + long * (flap + fold)
        rows.append(np.column_stack([np.maximum(x, 0), y, z]))
        uvs.append(np.column_stack([(z + 1.5) / 3, 0.02 + 0.96 * v]))
    p = loft(np.array(rows), (False, False), wrap=False, orient=False)
    p.uv = np.concatenate(uvs)
    t = p.pos[p.tri]
    if np.cross(t[:, 1] - t[:, 0], t[:, 2] - t[:, 0])[:, 0].sum() < 0:
        p = p.flipped()
    both = shade(join([p, p.mirrored()]), 75)
    both.col = np.ones((len(both.pos), 4))
    return both


def finer(sections, n):
    """The same fin by n sections, along smooth edges."""
    table = np.array([np.concatenate([lead, trail, [thick]]) for lead, trail, thick, _ in sections], float)
    k = np.arange(len(sections))
    t = np.linspace(0, len(sections) - 1, n)
    smooth = np.column_stack([spline(k, table[:, i])(t) for i in range(7)])
    return [(row[:3], row[3:6], row[6], sections[0][3]) for row in smooth]


def fin(sections, light_below=False, tip=None, n=11, rows=15):
    """Foil with the skin's colours; tip = (point, radius) darkens the end."""
    p = shade(foil(finer(sections, rows), n), 60)
    v = np.full(len(p.pos), 0.16)
    if light_below:
        v = np.where(p.nrm[:, 1] < -0.1, 0.86, 0.18)
    # As fine as on the body: 3 m along, 1.1 m from back to belly.
    out = np.hypot(p.pos[:, 0], p.pos[:, 1])
    p.uv = np.column_stack([(p.pos[:, 2] + 1.5) / 3, v + 0.18 * (out - out.mean())])
    dark = 0 * v if tip is None else N.smooth(tip[1], tip[1] * 0.3, np.linalg.norm(p.pos - np.array(tip[0]), axis=1) + 0.03 * N.fbm3(p.pos, 9, 9, 2))
    p.col = np.column_stack([np.ones((len(v), 3)) * (1 - 0.55 * dark)[:, None], np.ones(len(v))])
    return p


def fins():
    """Each swells where it leaves the body, and ends in a rounded tip over a hollow rear edge."""
    X, Y, V = [1, 0, 0], [0, 1, 0], [0.6, 0.8, 0]
    out = [
        fin(
            [
                ([0, 0.15, -0.50], [0, 0.14, 0.20], 0.20, X),
                ([0, 0.225, -0.44], [0, 0.222, 0.165], 0.10, X),
                ([0, 0.27, -0.385], [0, 0.245, 0.115], 0.060, X),
                ([0, 0.40, -0.235], [0, 0.36, 0.065], 0.036, X),
                ([0, 0.51, -0.095], [0, 0.48, 0.075], 0.022, X),
                ([0, 0.575, 0.005], [0, 0.558, 0.105], 0.013, X),
                ([0, 0.602, 0.070], [0, 0.597, 0.125], 0.006, X),
                ([0, 0.606, 0.098], [0, 0.605, 0.118], 0.002, X),
            ],
            tip=([0, 0.64, 0.14], 0.22),
        )
    ]
    out.append(
        fin(
            [
                ([0, 0.07, 0.53], [0, 0.065, 0.84], 0.075, X),
                ([0, 0.125, 0.585], [0, 0.108, 0.845], 0.032, X),
                ([0, 0.165, 0.64], [0, 0.145, 0.79], 0.018, X),
                ([0, 0.198, 0.70], [0, 0.185, 0.785], 0.009, X),
                ([0, 0.212, 0.75], [0, 0.209, 0.80], 0.003, X),
            ],
            tip=([0, 0.225, 0.82], 0.12),
            n=9,
            rows=9,
        )
    )
    out.append(
        fin(
            [
                ([0, -0.03, 0.58], [0, -0.02, 0.85], 0.070, X),
                ([0, -0.085, 0.635], [0, -0.065, 0.85], 0.030, X),
                ([0, -0.135, 0.69], [0, -0.115, 0.80], 0.014, X),
                ([0, -0.185, 0.765], [0, -0.178, 0.82], 0.004, X),
            ],
            tip=([0, -0.20, 0.84], 0.12),
            n=9,
            rows=9,
        )
    )
    # The tail in one piece, from the lower lobe's tip over the body's end to the upper one's.
    out.append(
        fin(
            [
                ([0, -0.252, 1.215], [0, -0.250, 1.245], 0.002, X),
                ([0, -0.225, 1.170], [0, -0.212, 1.240], 0.007, X),
                ([0, -0.16, 1.110], [0, -0.14, 1.215], 0.016, X),
                ([0, -0.07, 1.045], [0, -0.06, 1.200], 0.030, X),
                ([0, -0.01, 0.99], [0, -0.00, 1.205], 0.050, X),
                ([0, 0.04, 0.95], [0, 0.045, 1.215], 0.066, X),
                ([0, 0.09, 0.98], [0, 0.09, 1.235], 0.054, X),
                ([0, 0.16, 1.065], [0, 0.155, 1.270], 0.034, X),
                ([0, 0.28, 1.185], [0, 0.27, 1.345], 0.022, X),
                ([0, 0.40, 1.305], [0, 0.385, 1.420], 0.014, X),
                ([0, 0.465, 1.372], [0, 0.440, 1.452], 0.009, X),
                ([0, 0.50, 1.408], [0, 0.470, 1.492], 0.006, X),
                ([0, 0.535, 1.452], [0, 0.522, 1.500], 0.003, X),
                ([0, 0.545, 1.475], [0, 0.543, 1.490], 0.001, X),
            ],
            tip=([0, 0.53, 1.52], 0.42),
            rows=27,
        )
    )
    low = out[-1]
    dark = N.smooth(0.28, 0.08, np.linalg.norm(low.pos - np.array([0, -0.27, 1.26]), axis=1))
    low.col[:, :3] *= (1 - 0.55 * dark)[:, None]
    pect = [
        fin(
            [
                ([0.08, -0.075, -0.88], [0.08, -0.10, -0.40], 0.20, Y),
                ([0.165, -0.103, -0.815], [0.155, -0.117, -0.40], 0.105, Y),
                ([0.24, -0.128, -0.755], [0.215, -0.132, -0.425], 0.062, Y),
                ([0.42, -0.186, -0.610], [0.385, -0.185, -0.405], 0.034, Y),
                ([0.56, -0.234, -0.465], [0.535, -0.231, -0.335], 0.020, Y),
                ([0.65, -0.265, -0.350], [0.632, -0.262, -0.268], 0.011, Y),
                ([0.685, -0.278, -0.290], [0.676, -0.276, -0.247], 0.005, Y),
                ([0.690, -0.280, -0.268], [0.687, -0.279, -0.252], 0.001, Y),
            ],
            True,
            ([0.72, -0.29, -0.25], 0.26),
        ),
        fin(
            [
                ([0.03, -0.105, 0.25], [0.03, -0.09, 0.57], 0.075, V),
                ([0.075, -0.150, 0.31], [0.065, -0.135, 0.575], 0.034, V),
                ([0.125, -0.195, 0.385], [0.105, -0.178, 0.535], 0.018, V),
                ([0.165, -0.232, 0.465], [0.155, -0.222, 0.550], 0.007, V),
                ([0.176, -0.241, 0.510], [0.173, -0.239, 0.552], 0.002, V),
            ],
            True,
            ([0.18, -0.25, 0.57], 0.12),
            9,
            9,
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
    a, f = N.spectral(n, 3, 3.2, 2, m=m), N.spectral(n, 4, 1.0, 60, m=m)
    ragged = N.spectral(n, 6, 2.8, 8, 160, stretch=(1.6, 1), m=m)
    top, low = np.array((0.335, 0.350, 0.355)), np.array((0.88, 0.88, 0.85))
    line = 0.56 + 0.035 * np.sin(z * 2.1 + 0.8) + 0.05 * N.smooth(-1.1, -1.45, z) + 0.012 * a + 0.010 * ragged + 0.5 * N.smooth(0.80, 1.08, z)
    # Dark above, pale below, over a flank between the two: the border is soft and uneven.
    flank = N.smooth(-0.30, 0.02, v - line + 0.02 * a)
    belly = N.smooth(-0.05, 0.05, v - line)
    col = N.mix(N.flat(n, top, m) * (1 - 0.20 * N.smooth(0.35, 0.0, v))[..., None], np.array((0.47, 0.48, 0.47)), flank)
    col = N.mix(col, low, belly)
    band = N.smooth(0.03, 0.0, np.abs(v - line + 0.055 - 0.02 * z)) * N.smooth(-0.6, 0.0, z) * N.smooth(1.0, 0.6, z)
    col = N.mix(col, low * 0.86, band * 0.30)
    col *= (1 + 0.045 * a + 0.012 * f + 0.02 * ragged * (1 - belly))[..., None]
    spots = N.smooth(1.6, 2.6, N.spectral(n, 5, 1.6, 10, 80, m=m)) * (1 - belly)
    col *= (1 - 0.15 * spots)[..., None]
    scars = np.zeros((n, m))
    rng = np.random.default_rng(8)
    for _ in range(16):  # bites of courtship and scrapes, fine and pale
        at, turn, long = (0.1 + 0.5 * rng.random(), -0.9 + 1.7 * rng.random()), rng.normal(0, 0.5), 0.02 + 0.07 * rng.random()
        u, w = z - at[1], (v - at[0]) * 0.55
        along, across = u * np.cos(turn) + w * np.sin(turn), w * np.cos(turn) - u * np.sin(turn) + 2.0 * u**2
        scars = np.maximum(scars, N.smooth(0.0030, 0.0012, np.abs(across)) * N.smooth(long, long * 0.5, np.abs(along)))
    col = N.mix(col, low * 0.8, 0.16 * scars)
    gill = np.zeros((n, m))
    vb = (v - 0.02) / 0.96
    for g, half in GILLS:
        d = z - g - GILL_SLANT * (vb - GILL_MID) * np.sin(np.pi * np.clip(vb, 0, 1))
        long = N.smooth(half, half * 0.7, np.abs(vb - GILL_MID))
        gill = np.maximum(gill, N.smooth(-0.004, 0.001, d) * N.smooth(0.012, 0.003, d) * long)
    col = N.mix(col, (0.16, 0.15, 0.15), gill * 0.75)
    x = np.sin(np.pi * np.clip((v - 0.02) / 0.96, 0, 1)) * np.interp(z, Z, WIDE)
    dm = np.abs(z - mouth(x))
    lips = N.smooth(0.016, 0.004, dm) * N.smooth(0.64, 0.72, v) * (z < -1.13)
    col = N.mix(col, (0.22, 0.13, 0.12), lips * 0.75)
    nose = N.smooth(0.012, 0.006, np.hypot((z + 1.425), (v - 0.74) * 0.22))
    col = N.mix(col, (0.12, 0.11, 0.11), nose)
    h = 0.00012 * f + 0.0015 * a - 0.002 * gill - 0.003 * lips
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
