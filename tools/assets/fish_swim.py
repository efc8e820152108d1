"""How fish of a school swim: a spine of four joints and the clip swim, bursts of beats and glides on bent bodies.

One clip has beats of every size and bends to both sides, so that objects of the same school differ by clip_offset_s.
"""
import numpy as np

from glb import quat
from mesh import Part

# Places of the joints from the middle of the body, in lengths; the nose is at -0.5. The first turns the head.
JOINTS = (-0.12, 0.08, 0.25, 0.37)
# A wave that runs down the body and grows: amplitude (degrees) and lag (radians) of each part's heading.
WAVE_DEG, LAG = (2.5, 5.0, 12.0, 21.0), (0.0, 0.9, 1.9, 2.9)
# The share of a bend of the whole body by which each part's heading turns, about its middle.
BEND = (-0.45, -0.05, 0.45, 0.75)
SECONDS, BEATS, KEYS = 6.0, 10, 121


def headings(t):
    """Degrees by which each part turns about y at times t [n]: [joints, n]; it repeats after SECONDS."""
    turn = 2 * np.pi * t / SECONDS
    beat = 0.22 + 0.78 * np.sin(turn + 0.4) ** 2 * (0.75 + 0.25 * np.sin(turn))  # two bursts, of which one is weaker
    bend = 15 * np.sin(turn) + 9 * np.sin(2 * turn + 1.0)
    return np.array([a * beat * np.sin(BEATS * turn - lag) + b * bend for a, lag, b in zip(WAVE_DEG, LAG, BEND)])


def spined(part, length):
    """The part, bound to the joints by where its vertices lie along z; linear from joint to joint."""
    at = np.append(JOINTS, 0.52) * length
    middles = 0.5 * (at[:-1] + at[1:])
    w = np.zeros((len(part.pos), 4))
    along = np.clip((np.interp(part.pos[:, 2], middles, np.arange(4.0))), 0, 3)
    low = np.minimum(along.astype(int), 2)
    rows = np.arange(len(along))
    w[rows, low] = 1 - (along - low)
    w[rows, low + 1] = along - low
    joints = np.where(w > 0, np.arange(4), 0)
    return Part(part.pos, part.tri, part.uv, part.nrm, part.col, joints, w)


def swimmer(g, name, prims, length, at):
    """Adds a node with a skinned mesh of (part, material) and, below it, its spine. Its joints, from the head on."""
    rest = [(0.0, 0.0, z * length) for z in JOINTS]
    first = len(g.doc["nodes"]) + 1
    skin = g.skin(name, [first + k for k in range(len(JOINTS))], rest)
    parent = g.node(name, g.mesh(name, [(spined(part, length), m) for part, m in prims]), at=at, skin=skin)
    out = []
    for k, z in enumerate(JOINTS):
        before = JOINTS[k - 1] if k else 0.0
        parent = g.node(f"{name}_spine_{k}", at=(0.0, 0.0, (z - before) * length), parent=parent)
        out.append(parent)
    return out


def swim(g, spines):
    """The clip swim of all spines (lists of joints)."""
    t = np.linspace(0, SECONDS, KEYS)
    turns = headings(t)
    own = np.diff(turns, axis=0, prepend=0 * turns[:1])  # each beside the one before it
    g.animation("swim", t, [(joint, "rotation", quat("y", own[k])) for spine in spines for k, joint in enumerate(spine)])
