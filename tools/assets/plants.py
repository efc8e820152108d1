"""Plants that sway: giant_kelp.glb (8.4 m, and some metres along the surface) and eelgrass.glb, each with a clip sway.

A chain of joints from root to top bends as a wave that runs up; all of a plant's blades follow the
joint at their height. Stand on y = 0.
"""
from pathlib import Path

import numpy as np

import noise as N
from glb import Glb, qmul, quat
from mesh import join, Part, shade
from sealife import leaf_texture, ribbon, tint
from shapes import sphere, tube
from swimmers import bound

OUT = Path(__file__).resolve().parents[2] / "assets" / "models"


def chain_weights(y, heights):
    """Each height between the two joints next to it."""
    k = np.clip(np.searchsorted(heights, y) - 1, 0, len(heights) - 2)
    s = np.clip((y - heights[k]) / (heights[k + 1] - heights[k]), 0, 1)
    w = np.zeros((len(y), len(heights)))
    w[np.arange(len(y)), k] = 1 - s
    w[np.arange(len(y)), k + 1] += s
    return w


def sway(g, name, parts, heights, seconds, degrees, level=False):
    """A swell of that period: the bend is a wave that lags behind with height, and two of it in a loop.

    parts: [(part, material)]. level: what the top joint bears, floating, stays level.
    """
    for part, _ in parts:
        bound(part, chain_weights(part.pos[:, 1], heights))
    nodes = []
    for k, y in enumerate(heights):
        nodes.append(g.node(f"stem_{k}", at=(0, y - (heights[k - 1] if k else 0), 0), parent=nodes[-1] if k else None))
    rest = np.column_stack([np.zeros(len(heights)), heights, np.zeros(len(heights))])
    g.node(name, g.mesh(name, parts), skin=g.skin(name, nodes, rest))
    t = np.linspace(0, 2 * seconds, 41)
    ph = t / seconds * 2 * np.pi
    tracks = []
    below = np.tile([0.0, 0.0, 0.0, 1.0], (len(t), 1))
    for k, node in enumerate(nodes):
        lag = 0.75 * k
        x = degrees * (np.sin(ph - lag) + 0.35 * np.sin(ph / 2 - 0.5 * lag + 1)) * (0.5 + 0.5 * k / len(nodes))
        z = degrees * 0.45 * (np.sin(ph - lag + 1.3) + 0.5 * np.cos(ph / 2 - lag))
        turn = qmul(quat("x", x), quat("z", z))
        if level and k == len(nodes) - 1:
            turn = below * np.array([-1.0, -1.0, -1.0, 1.0])
        below = qmul(below, turn)
        tracks.append((node, "rotation", turn))
    g.animation("sway", t, tracks)


# The kelp's stipes reach this height and trail along the surface from there, m.
CANOPY = 8.4


def stipe(rng, s):
    """A stipe's line and how far each point is along it: up to the surface, then some metres along it, downwind."""
    a0, ph = s * 2.1, rng.random() * 6
    h = np.linspace(0, CANOPY - 0.25, 32)
    up = np.column_stack([
        0.10 * np.cos(a0) * N.smooth(0, 1.5, h) + 0.10 * np.sin(h * 0.9 + ph) * N.smooth(0, 2, h),
        h,
        0.10 * np.sin(a0) * N.smooth(0, 1.5, h) + 0.10 * np.cos(h * 0.75 + ph) * N.smooth(0, 2, h),
    ])
    q = np.linspace(0, 1, 20)[1:]
    reach, wind = 2.3 + 1.4 * rng.random(), 0.5 * (s - 1) + rng.normal(0, 0.15)
    aside = 0.22 * np.sin(5.0 * q + ph) * q
    out = reach * (q - 0.10 * N.smooth(0.3, 0.0, q))
    trail = up[-1] + np.column_stack([
        out * np.cos(wind) - aside * np.sin(wind),
        0.25 * N.smooth(0, 0.14, q) - 0.10 * q**2 + 0.02 * np.sin(13 * q + ph),
        out * np.sin(wind) + aside * np.cos(wind),
    ])
    path = np.concatenate([up, trail])
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))])
    return path, way


def giant_kelp():
    """Macrocystis: stipes from one holdfast, a blade with a float every hand's breadth, a canopy. Blades and stems."""
    rng = np.random.default_rng(21)
    stems, blades = [], []
    for s in range(3):
        path, way = stipe(rng, s)
        stems.append(tube(path, np.linspace(0.014, 0.006, len(path)), 5))
        places = np.concatenate([np.arange(0.7, CANOPY - 0.6, 0.21), np.arange(CANOPY - 0.6, way[-1], 0.12)])
        for k, along in enumerate(places):
            at = np.array([np.interp(along, way, path[:, c]) for c in range(3)])
            floats = N.smooth(CANOPY - 0.8, CANOPY, along)
            a = k * 2.4 + s + rng.normal(0, 0.25)
            out = np.array([np.cos(a), 0, np.sin(a)])
            # At the surface blades lie along the stipe, to both sides and half under it.
            ahead = path[-1] - path[31]
            ahead = np.array([ahead[0], 0, ahead[2]]) / np.hypot(ahead[0], ahead[2])
            lie = 0.75 * ahead + (0.9 if k % 2 else -0.9) * np.array([-ahead[2], 0, ahead[0]]) + rng.normal(0, 0.22, 3) * [1, 0, 1]
            out = out * (1 - floats) + lie / np.linalg.norm(lie) * floats
            out /= np.linalg.norm(out)
            end = N.smooth(way[-1] + 0.1, way[-1] - 0.9, along)
            ln = (0.55 + 0.25 * rng.random()) * (0.45 + 0.55 * end)
            q = np.linspace(0, 1, 7)[:, None]
            droop = (0.30 + 0.5 * rng.random()) * (1 - floats) + (0.46 + 0.30 * rng.random()) * floats
            p = at + out * (0.03 + ln * q * 0.8) + np.array([0, 1, 0]) * ln * (0.42 * q - droop * q**2) + 0.03 * np.sin(q * 8 + k) * np.array([out[2], 0.3, -out[0]])
            p[:, 1] = np.minimum(p[:, 1], CANOPY + 0.03 - 0.02 * (k % 3))
            w = 0.105 * np.sin(np.pi * np.linspace(0.06, 0.985, 7) ** 0.75) + 0.003
            blades.append(ribbon(p, w, np.array([0, 1, 0]) + 0.8 * np.array([out[2], 0, -out[0]]) * rng.normal(0, 1), curl=0.14))
            if floats > 0.5 and k % 2:
                continue
            f = sphere(0.020, 5, 4).scaled(0.85, 1.7, 0.85)
            stems.append(f.at(*(at + out * 0.035 + np.array([0, 0.03 * (1 - floats), 0]))))
    for k in range(14):  # holdfast
        a = k * 2.4
        q = np.linspace(0, 1, 5)[:, None]
        p = np.column_stack([(0.02 + 0.22 * q[:, 0]) * np.cos(a + 0.6 * q[:, 0]), 0.14 * (1 - q[:, 0]) ** 1.5 - 0.02, (0.02 + 0.22 * q[:, 0]) * np.sin(a + 0.6 * q[:, 0])])
        stems.append(tube(p, np.linspace(0.014, 0.005, 5), 5))
    return tint(join(blades), (0.80, 0.74, 0.58), (1.0, 0.97, 0.82), CANOPY), tint(join(stems), (0.85, 0.80, 0.70), (1.0, 0.97, 0.85), CANOPY)


def stem_texture(n=128):
    """A stipe: olive brown, in faint streaks along it (v)."""
    streaks = N.spectral(n, 6, 1.4, 4, 40, stretch=(6, 1))
    tone = N.mix(N.flat(n, (0.66, 0.58, 0.26)), (0.52, 0.44, 0.19), N.smooth(-1.2, 1.5, streaks))
    return np.clip(tone * (1 + 0.05 * N.spectral(n, 7, 1.0, 8))[..., None], 0, 1)


def eelgrass():
    rng = np.random.default_rng(29)
    out = []
    for _ in range(64):
        r, a = 0.30 * np.sqrt(rng.random()), rng.random() * 2 * np.pi
        base = np.array([r * np.cos(a), -0.02, r * np.sin(a)])
        ln, d = 0.35 + 0.45 * rng.random(), rng.random() * 2 * np.pi
        q = np.linspace(0, 1, 7)[:, None]
        way = np.array([np.cos(d), 0, np.sin(d)])
        lean = 0.08 + 0.28 * rng.random()
        p = base + np.array([0, 1, 0]) * ln * q * (1 - 0.25 * lean * q) + way * ln * lean * q**2 + np.array([0.03, 0, 0.02]) * np.sin(q * 4 + d)
        out.append(ribbon(p, 0.0125 * np.array([0.8, 1, 1, 1, 0.9, 0.7, 0.15]), way + rng.normal(0, 0.3, 3), 0.25, 0.75, 0.12))
    return tint(join(out), (0.26, 0.36, 0.14), (0.66, 0.92, 0.38), 0.7)


# A blade of Macrocystis sends on some 0.4 of green and yellow light and 0.1 of blue, by reflection a third
# of that and the rest through it: against the sun it glows golden. Factors of the texture's colour.
GOLDEN = (1.50, 1.28, 1.22)


def main():
    c, nm = leaf_texture()

    def leaf(g, tone, thin):
        base = g.texture("leaf_color", np.clip(c[::2, ::2] * np.array(tone), 0, 1), 80)
        return g.material("leaf", base=base, normal=g.texture("leaf_normal", nm[::4, ::4], 76), rough=0.5, double=True, thin=thin)

    g = Glb("giant_kelp")
    blades, stems = giant_kelp()
    stem = g.material("stem", base=g.texture("stem_color", stem_texture(), 82), rough=0.6)
    parts = [(blades, leaf(g, GOLDEN, 0.68)), (stems, stem)]
    sway(g, "giant_kelp", parts, np.array([0.0, 1.2, 2.6, 4.0, 5.4, 6.8, CANOPY - 0.25]), 6.0, 3.4, level=True)
    g.save(OUT / "giant_kelp.glb")
    g = Glb("eelgrass")
    sway(g, "eelgrass", [(eelgrass(), leaf(g, (1.1, 1.15, 1.1), 0.55))], np.array([0.0, 0.15, 0.32, 0.52]), 4.0, 7.0)
    g.save(OUT / "eelgrass.glb")


if __name__ == "__main__":
    main()
