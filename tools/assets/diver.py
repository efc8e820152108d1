"""A scuba diver, 1.80 m, one skinned mesh on 16 body segments, clips swim and hover.

Conventions: see diver_body.py. A leg swings forward (flexes) with a positive
rotation about x; a knee bends with a negative one; a foot points (fin in line
with the shin) with a negative one.
"""
from pathlib import Path

import numpy as np

import diver_textures as T
import sdf as S
from diver_body import ANKLE, BOUND, GEAR, JOINTS, NAMES, WRIST, arm, body, chart_coords, chart_uv, fold, hand, rigid, skin, torso
from diver_gear import gear
from glb import Glb, qmul, quat
from mesh import join, Part

OUT = Path(__file__).resolve().parents[2] / "assets" / "models"


def suit():
    """Suit, hood and boots with atlas coordinates; triangles split where charts meet."""
    p = S.surface_nets(body, [-0.75, -1.0, -0.30], [0.75, 0.92, 0.26], 0.0275)
    j, w = skin(p.pos)
    # hidden under the fin pockets: drop the soles' inner part
    c = p.pos[p.tri].mean(1)
    q = fold(c)
    is_arm = (arm(c) < torso(c) - 0.01) & (q[:, 0] > 0.17)
    chart = np.where(
        is_arm,
        "arm",
        np.where(
            c[:, 1] > 0.62,
            "head",
            np.where(c[:, 1] < ANKLE[1] + 0.05, "boot", np.where(c[:, 1] < -0.10, "leg", "torso")),
        ),
    )
    parts = []
    for name in ("torso", "arm", "leg", "boot", "head"):
        ids = p.tri[chart == name]
        used, inv = np.unique(ids, return_inverse=True)
        pos = p.pos[used]
        coords = pos if name in ("torso", "head") else fold(pos)
        turn, v = chart_coords(name, coords)
        t = turn[inv].reshape(-1, 3)
        wrap = (np.ptp(t, axis=1) > 0.5)[:, None] & (t < 0)
        corner_turn = (t + wrap).ravel()
        key = np.column_stack([inv.ravel(), (wrap).ravel()])
        _, pick, tri = np.unique(key, axis=0, return_index=True, return_inverse=True)
        at = used[inv.ravel()[pick]]
        parts.append(
            Part(
                p.pos[at],
                tri.reshape(-1, 3),
                chart_uv(name, corner_turn[pick], v[inv.ravel()[pick]]),
                p.nrm[at],
                joints=j[at],
                weights=w[at],
            )
        )
    return parts


def gloves():
    out = []
    p = S.surface_nets(hand, [-0.06, -0.20, -0.10], [0.04, 0.06, 0.07], 0.0102)
    turn, v = chart_coords("hand", p.pos)
    t = turn[p.tri]
    wrap = (np.ptp(t, axis=1) > 0.5)[:, None] & (t < 0)
    ids = p.tri.ravel()
    p = Part(p.pos[ids], np.arange(len(ids)), chart_uv("hand", (t + wrap).ravel(), v[ids]), p.nrm[ids])
    p = p.rot("z", 45).at(*WRIST)
    for q, n in ((p, "hand_r"), (p.mirrored(), "hand_l")):
        out.append(rigid(q, n))
    return out


def clips(g, node):
    """swim: 2 s flutter kick, two cycles' worth of keys looped exactly; hover: 4 s."""
    rest = {n: np.zeros((1, 4)) + [0, 0, 0, 1] for n in NAMES}

    def clip(name, seconds, keys, make, root):
        t = np.linspace(0, seconds, keys)
        ph = t / seconds * 2 * np.pi
        rot = {n: np.tile(rest[n], (keys, 1)) for n in NAMES}
        rot.update(make(ph))
        tracks = [(node[n], "rotation", rot[n]) for n in NAMES]
        tracks.append((node["pelvis"], "translation", root(ph)))
        g.animation(name, t, tracks)

    x = lambda deg: quat("x", deg)
    z = lambda deg: quat("z", deg)

    def swim(ph):
        out = {
            "thorax": qmul(x(6 + 0 * ph), quat("y", 2.5 * np.sin(ph))),
            "abdomen": quat("y", 2 * np.sin(ph + 0.4)),
            "pelvis": quat("y", -3 * np.sin(ph)),
            "head": x(34 + 1.5 * np.sin(2 * ph)),
        }
        for s, sign in (("r", 1), ("l", -1)):
            k = ph if s == "r" else ph + np.pi
            out[f"upper_leg_{s}"] = qmul(z(sign * 2 + 0 * k), x(2 + 25 * np.sin(k)))
            out[f"lower_leg_{s}"] = x(-18 - 16 * np.sin(k - 1.0))
            out[f"foot_{s}"] = x(-62 + 20 * np.sin(k - 1.9))
            out[f"upper_arm_{s}"] = qmul(x(-14 + 2 * np.sin(k)), z(-sign * (31 + 1.5 * np.sin(2 * ph))))
            out[f"forearm_{s}"] = qmul(x(10 + 0 * k), z(-sign * (4 + 0 * k)))
            out[f"hand_{s}"] = z(-sign * (4 + 0 * k))
        return out

    def hover(ph):
        out = {"thorax": x(3 + 1.5 * np.sin(ph)), "head": x(8 + 2 * np.sin(ph + 0.8))}
        for s, sign in (("r", 1), ("l", -1)):
            k = ph if s == "r" else ph + np.pi
            out[f"upper_leg_{s}"] = qmul(z(sign * 5 + 0 * k), x(22 + 7 * np.sin(k)))
            out[f"lower_leg_{s}"] = x(-55 - 8 * np.sin(k - 0.9))
            out[f"foot_{s}"] = x(-38 + 9 * np.sin(k - 1.7))
            out[f"upper_arm_{s}"] = qmul(x(28 + 4 * np.sin(ph + 0.5)), z(-sign * (18 + 3 * np.sin(ph))))
            out[f"forearm_{s}"] = qmul(x(62 + 5 * np.sin(ph + 1.0)), z(-sign * (14 + 0 * k)))
            out[f"hand_{s}"] = x(6 * np.sin(ph + 1.6))
        return out

    still = lambda amp: (lambda ph: np.column_stack([0 * ph, amp * np.sin(2 * ph), 0 * ph]))
    clip("swim", 2.0, 41, swim, lambda ph: np.column_stack([0 * ph, 0 * ph, 0.012 * np.sin(2 * ph)]))
    clip("hover", 4.0, 41, hover, still(0.012))


def main():
    g = Glb("diver")
    c, mr, n = T.suit()
    m_suit = g.material(
        "wetsuit",
        base=g.texture("suit_color", c, 88),
        mr=g.texture("suit_mr", mr, 80),
        normal=g.texture("suit_normal", n, 78),
        metal=1.0,
        rough=1.0,
    )
    cc, cn = T.cloth()
    m_cloth = g.material(
        "cloth", base=g.texture("cloth_color", cc, 80), normal=g.texture("cloth_normal", cn, 78), rough=0.85
    )
    rc, rmr, rn = T.rubber()
    m_rub = g.material(
        "rubber",
        base=g.texture("rubber_color", rc, 85),
        mr=g.texture("rubber_mr", rmr, 80),
        normal=g.texture("rubber_normal", rn, 64),
        metal=1.0,
        rough=1.0,
    )
    m_met = g.material("metal", (0.80, 0.81, 0.83, 1), metal=1.0, rough=0.28)
    m_glass = g.material("glass", (0.10, 0.14, 0.16, 0.25), metal=0.0, rough=0.05, blend=True)
    parts = gear()
    mesh = g.mesh(
        "diver",
        [
            (join(suit() + gloves()), m_suit),
            (join(parts["cloth"]), m_cloth),
            (join(parts["rubber"]), m_rub),
            (join(parts["metal"]), m_met),
            (join(parts["glass"]), m_glass),
        ],
    )
    node = {}
    for name, (parent, at) in JOINTS.items():
        base = np.zeros(3) if parent is None else np.asarray(JOINTS[parent][1], float)
        node[name] = g.node(name, at=np.asarray(at, float) - base, parent=None if parent is None else node[parent])
    places = JOINTS | GEAR
    for name, (parent, at) in GEAR.items():
        node[name] = g.node(name, at=at - np.asarray(places[parent][1], float), parent=node[parent])
    skin_id = g.skin("diver", [node[n] for n in BOUND], [places[n][1] for n in BOUND])
    g.node("diver", mesh, skin=skin_id)
    clips(g, node)
    g.save(OUT / "diver.glb")


if __name__ == "__main__":
    main()
