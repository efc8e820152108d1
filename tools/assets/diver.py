"""Scuba divers, 1.80 m, each one skinned mesh on 16 body segments, with the clips of diver_clips.py and a look of
diver_looks.py.
"""
from pathlib import Path

import numpy as np

import diver_textures as T
import sdf as S
from diver_body import ANKLE, BOUND, GEAR, JOINTS, WRIST, arm, body, chart_coords, chart_uv, fold, hand, rigid, skin, torso
from diver_clips import clips
from diver_gear import gear
from diver_looks import LOOKS
from glb import Glb
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


def make(look):
    g = Glb(look.model, packed=True)
    c, mr, n = T.suit(look)
    m_suit = g.material(
        "wetsuit",
        base=g.texture("suit_color", c, 80),
        mr=g.texture("suit_mr", mr, 80),
        normal=g.texture("suit_normal", n, 78),
        detail=(g.texture("suit_detail", T.jersey(), 74), 17),
        metal=1.0,
        rough=1.0,
    )
    cc, cn = T.cloth()
    m_cloth = g.material(
        "cloth", base=g.texture("cloth_color", cc, 80), normal=g.texture("cloth_normal", cn, 70), rough=0.85
    )
    rc, rmr, rn = T.rubber()
    m_rub = g.material(
        "rubber",
        base=g.texture("rubber_color", rc, 70),
        mr=g.texture("rubber_mr", rmr, 66),
        normal=g.texture("rubber_normal", rn, 64),
        metal=1.0,
        rough=1.0,
    )
    m_met = g.material("metal", (0.80, 0.81, 0.83, 1), metal=1.0, rough=0.28)
    m_glass = g.material("glass", (0.10, 0.14, 0.16, 0.25), metal=0.0, rough=0.05, blend=True)
    # Dark where no program shows its picture on it.
    m_display = g.material("display", (0.012, 0.013, 0.014, 1), rough=0.12, picture="dive computer")
    parts = gear(look)
    for part in parts["rubber"]:
        part.col[:, :3] = np.minimum(part.col[:, :3] * T.RUBBER_GAIN, 1)
    mesh = g.mesh(
        "diver",
        [
            (join(suit() + gloves()), m_suit),
            (join(parts["cloth"]), m_cloth),
            (join(parts["rubber"]), m_rub),
            (join(parts["metal"]), m_met),
            (join(parts["glass"]), m_glass),
            (join(parts["display"]), m_display),
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
    g.save(OUT / f"{look.model}.glb")


def main():
    for look in LOOKS:
        make(look)


if __name__ == "__main__":
    main()
