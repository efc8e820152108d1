"""All that the diver carries, each part already bound to the skeleton: jacket, tank, hoses.

gear() returns lists of Parts by material: cloth, rubber, metal, glass, display.
"""
import numpy as np

import noise as N
import sdf as S
from diver_body import BOUND, NAMES, fold, rigid, skin, torso
from diver_looks import YELLOW
from diver_trim import BLACK, DARK, belt, display, extras, fins, mask
from mesh import box_uv, shade
from shapes import box, curve, cylinder, revolve, ring_band, tube


def worn(p):
    """Binds the jacket like the suit beneath it, without the arms and legs, to the jacket's own joints."""
    j, w = skin(p.pos, arm_gate=np.zeros(len(p.pos)))
    for name in {NAMES[k] for k in j[w > 0]}:
        j[(j == NAMES.index(name)) & (w > 0)] = BOUND.index(f"jacket_{name}")
    p.joints, p.weights = j, w
    return p


def bcd(look):
    """Jacket: a shell over the torso, open in front, with lobes, straps and pockets."""

    def field(p):
        q, y = fold(p), p[:, 1]
        puff = (
            0.022
            + 0.020 * N.smooth(0.40, 0.22, y) * N.smooth(0.06, 0.14, q[:, 0])
            + 0.012 * np.exp(-(((y - 0.42) / 0.06) ** 2)) * (p[:, 2] < 0)
        )
        shell = torso(p) - puff
        bodyband = np.maximum(y - 0.47, 0.125 - y)
        gap = np.where(p[:, 2] < 0.02, 0.052 + 0.35 * np.maximum(y - 0.36, 0) - q[:, 0], -1.0)
        hole = np.where(y > 0.38, 0.150 - np.linalg.norm((q - [0.235, 0.535, 0.0])[:, :2] * [1, 0.75], axis=1), -1.0)
        jacket = S.both(S.both(bodyband, gap, 0.02), hole, 0.02)
        strap = np.maximum(np.abs(q[:, 0] - 0.112) - 0.034, 0.40 - y)
        slim = torso(p) - 0.017
        yoke = S.capsule(fold(p), [0.112, 0.47, 0.10], [0.112, 0.615, 0.03], 0.030, 0.028)
        yoke = S.union(yoke, S.capsule(fold(p), [0.112, 0.615, 0.03], [0.112, 0.48, -0.108], 0.028, 0.026), 0.02)
        flat_yoke = np.maximum(yoke, np.abs(q[:, 0] - 0.112) - 0.030)
        d = S.both(shell, jacket, 0.018)
        d = S.union(d, S.both(slim, strap, 0.012), 0.012)
        d = S.union(d, flat_yoke, 0.015)
        band = np.maximum(torso(p) - 0.020, np.abs(y - 0.185) - 0.042)
        d = S.union(d, band, 0.010)
        pocket = S.rbox(q, [0.150, 0.235, -0.085], [0.045, 0.062, 0.040], 0.022)
        return S.union(d, pocket, 0.015)

    p = S.surface_nets(field, [-0.28, 0.09, -0.24], [0.28, 0.68, 0.22], 0.0175)
    c = p.pos[p.tri].mean(1)
    p.tri = p.tri[torso(c) > -0.004]
    used, inv = np.unique(p.tri, return_inverse=True)
    p.pos, p.nrm, p.uv, p.tri = p.pos[used], p.nrm[used], p.uv[used], inv.reshape(-1, 3)
    q, y = fold(p.pos), p.pos[:, 1]
    trim = np.maximum(
        np.exp(-(((y - 0.185) / 0.028) ** 2)) * (np.abs(p.pos[:, 0]) < 0.20) * (p.pos[:, 2] < 0.06),
        (np.abs(q[:, 0] - 0.112) < 0.020) * (y > 0.47) * 1.0,
    )
    lobe = N.smooth(0.075, 0.085, q[:, 0]) * (y < 0.40) * (y > 0.27) * (p.pos[:, 2] < 0.05)
    c = N.mix(N.mix(np.tile(DARK, (len(y), 1)), BLACK, trim), look.accent, lobe * 0.9)
    p.col = np.column_stack([c, np.ones(len(c))])
    return box_uv(worn(p), 0.16)


def plate():
    back = box(0.24, 0.44, 0.05, 0.02, 1).at(0, 0.33, 0.150)
    return rigid(box_uv(shade(back).colored(BLACK), 0.16), "tank")


def tank(look):
    """12 litre cylinder on the back with boot, bands, valve and first stage; or two of them."""
    r, z = 0.0925, 0.262
    body = (
        revolve(
            [
                (0.001, 0.655),
                (0.026, 0.652),
                (0.030, 0.63),
                (0.052, 0.618),
                (0.078, 0.592),
                (r - 0.003, 0.555),
                (r, 0.53),
                (r, 0.09),
                (r - 0.002, 0.06),
            ],
            22,
        )
        .rot("x", -90)
        .at(0, 0, z)
    )
    boot = (
        revolve(
            [
                (r + 0.006, 0.115),
                (r + 0.007, 0.10),
                (r + 0.007, 0.02),
                (r - 0.01, -0.005),
                (0.04, -0.01),
                (0.001, -0.01),
            ],
            22,
        )
        .rot("x", -90)
        .at(0, 0, z)
    )
    bands = [ring_band(r, r + 0.006, 0.045, 22).rot("x", 90).at(0, y, z) for y in (0.20, 0.44)]
    buckles = [box(0.07, 0.05, 0.02, 0.006, 1).at(0.0, y, z + r + 0.008) for y in (0.20, 0.44)]
    metal = [
        cylinder(0.022, 0.05, 14).rot("x", 90).at(0, 0.675, z),
        cylinder(0.018, 0.10, 12).rot("y", 90).at(0.035, 0.690, z),
        cylinder(0.030, 0.05, 16).at(0, 0.700, z - 0.055),
        cylinder(0.019, 0.06, 12).rot("y", 90).at(0, 0.700, z - 0.055),
    ]
    knob = (
        revolve([(0.012, -0.02), (0.023, -0.018), (0.026, 0), (0.023, 0.018), (0.012, 0.02)], 12)
        .rot("y", 90)
        .at(0.10, 0.690, z)
    )
    rub = [body.tiled(0.3).colored(look.tank), boot.tiled(0.3).colored(BLACK), knob.tiled(0.3).colored(BLACK)]
    rub += [b.tiled(0.3).colored(BLACK) for b in bands] + [b.tiled(0.3).colored(DARK) for b in buckles]
    if look.twin:
        manifold = cylinder(0.017, 0.21, 12).rot("y", 90).at(0, 0.676, z)
        rub, metal = ([p.at(s * 0.104, 0, 0) for p in of for s in (-1, 1)] for of in (rub, metal))
        metal.append(manifold)
    return [rigid(shade(p), "tank") for p in rub], [rigid(shade(p.tiled(0.3)), "tank") for p in metal]


def hose(points, r, color, follow=("tank", "tank"), n=22):
    """A hose whose weights slide from one joint to the other along its length."""
    path = curve(points, n)
    p = shade(tube(path, r, 6).tiled(0.3).colored(color))
    s = N.smooth(0.45, 0.95, np.argmin(((p.pos[:, None] - path[None]) ** 2).sum(2), 1) / (n - 1))
    a, b = (BOUND.index(f) for f in follow)
    p.joints = np.tile([a, b, 0, 0], (len(s), 1))
    if a == b:
        return rigid(p, follow[0])
    p.weights = np.column_stack([1 - s, s, 0 * s, 0 * s])
    p.joints = np.where(p.weights > 0, p.joints, 0)
    return p


def hoses():
    z0, y0 = 0.205, 0.70
    first = hose(
        [
            [0.03, y0, z0],
            [0.15, y0 + 0.02, z0 - 0.03],
            [0.215, 0.665, 0.08],
            [0.190, 0.640, -0.06],
            [0.10, 0.668, -0.145],
            [0.040, 0.700, -0.150],
        ],
        0.0068,
        BLACK,
        ("tank", "regulator"),
    )
    octo = hose(
        [
            [0.03, y0 - 0.015, z0],
            [0.16, y0 - 0.03, z0 + 0.01],
            [0.240, 0.58, 0.10],
            [0.250, 0.42, 0.04],
            [0.245, 0.31, -0.09],
            [0.195, 0.29, -0.165],
            [0.150, 0.345, -0.185],
        ],
        0.0068,
        YELLOW,
    )
    low = hose(
        [
            [-0.03, y0, z0],
            [-0.13, y0 + 0.01, z0 - 0.03],
            [-0.155, 0.665, 0.07],
            [-0.135, 0.645, -0.03],
            [-0.13, 0.52, -0.135],
            [-0.135, 0.40, -0.165],
        ],
        0.0062,
        BLACK,
    )
    gauge = hose(
        [
            [-0.03, y0 - 0.015, z0],
            [-0.17, y0 - 0.04, z0],
            [-0.235, 0.54, 0.11],
            [-0.235, 0.36, 0.05],
            [-0.225, 0.22, -0.07],
            [-0.17, 0.19, -0.17],
        ],
        0.0062,
        BLACK,
    )
    path = curve(
        [
            [-0.115, 0.645, 0.03],
            [-0.125, 0.60, -0.09],
            [-0.13, 0.50, -0.150],
            [-0.135, 0.40, -0.170],
            [-0.14, 0.33, -0.172],
        ],
        76,
    )
    fold_r = 0.0145 + 0.0028 * np.sin(np.arange(76) * np.pi / 2)
    corr = rigid(shade(tube(path, fold_r, 8).tiled(0.3).colored(BLACK), 70), "jacket_thorax")
    valve = rigid(shade(box(0.036, 0.085, 0.04, 0.012, 1).at(-0.14, 0.30, -0.172).tiled(0.3).colored(DARK)), "jacket_thorax")
    dial = rigid(
        shade(cylinder(0.034, 0.03, 18).rot("x", -15).at(-0.165, 0.19, -0.185).tiled(0.3).colored(DARK)), "tank"
    )
    second = (
        revolve([(0.012, 0.022), (0.030, 0.018), (0.036, 0.004), (0.034, -0.018), (0.020, -0.024)], 18)
        .rot("x", -12)
        .at(0.15, 0.36, -0.190)
    )
    return [first, octo, low, gauge, corr, valve, dial, rigid(shade(second.tiled(0.3).colored(YELLOW)), "tank")]


def gear(look):
    rub, met = tank(look)
    m_rub, m_glass, m_met = mask(look)
    return {
        "cloth": [bcd(look), plate()],
        "rubber": rub + m_rub + hoses() + belt() + fins(look) + extras(look),
        "metal": met + m_met,
        "glass": m_glass,
        "display": [display()],
    }
