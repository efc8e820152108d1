"""Plants that sway: giant_kelp.glb (9 m, to the surface) and eelgrass.glb, each with a clip sway.

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


def sway(g, name, part, material, heights, seconds, degrees):
    """A swell of that period: the bend is a wave that lags behind with height, and two of it in a loop."""
    bound(part, chain_weights(part.pos[:, 1], heights))
    nodes = []
    for k, y in enumerate(heights):
        nodes.append(g.node(f"stem_{k}", at=(0, y - (heights[k - 1] if k else 0), 0), parent=nodes[-1] if k else None))
    rest = np.column_stack([np.zeros(len(heights)), heights, np.zeros(len(heights))])
    g.node(name, g.mesh(name, [(part, material)]), skin=g.skin(name, nodes, rest))
    t = np.linspace(0, 2 * seconds, 41)
    ph = t / seconds * 2 * np.pi
    tracks = []
    for k, node in enumerate(nodes):
        lag = 0.75 * k
        x = degrees * (np.sin(ph - lag) + 0.35 * np.sin(ph / 2 - 0.5 * lag + 1)) * (0.5 + 0.5 * k / len(nodes))
        z = degrees * 0.45 * (np.sin(ph - lag + 1.3) + 0.5 * np.cos(ph / 2 - lag))
        tracks.append((node, "rotation", qmul(quat("x", x), quat("z", z))))
    g.animation("sway", t, tracks)


def giant_kelp(top=9.0):
    """Macrocystis: stipes from one holdfast, a blade with a float every hand's breadth, a canopy."""
    rng = np.random.default_rng(21)
    stems, blades = [], []
    for s in range(3):
        a0, ph = s * 2.1, rng.random() * 6
        h = np.linspace(0, top * (0.86 + 0.14 * rng.random()), 40)
        path = np.column_stack([
            0.10 * np.cos(a0) * N.smooth(0, 1.5, h) + 0.10 * np.sin(h * 0.9 + ph) * N.smooth(0, 2, h),
            h,
            0.10 * np.sin(a0) * N.smooth(0, 1.5, h) + 0.10 * np.cos(h * 0.75 + ph) * N.smooth(0, 2, h),
        ])
        stems.append(tube(path, np.linspace(0.014, 0.008, 40), 5))
        for k, y in enumerate(np.arange(0.7, h[-1], 0.21)):
            at = np.array([np.interp(y, h, path[:, c]) for c in range(3)])
            a = k * 2.4 + s + rng.normal(0, 0.25)
            out = np.array([np.cos(a), 0, np.sin(a)])
            ln = (0.55 + 0.25 * rng.random()) * (1 - 0.4 * (y / top) ** 4)
            q = np.linspace(0, 1, 7)[:, None]
            droop = 0.30 + 0.5 * rng.random()
            p = at + out * (0.03 + ln * q * 0.8) + np.array([0, 1, 0]) * ln * (0.42 * q - droop * q**2) + 0.03 * np.sin(q * 8 + k) * np.array([out[2], 0.3, -out[0]])
            w = 0.105 * np.sin(np.pi * np.linspace(0.06, 0.985, 7) ** 0.75) + 0.003
            blades.append(ribbon(p, w, np.array([0, 1, 0]) + 0.8 * np.array([out[2], 0, -out[0]]) * rng.normal(0, 1), curl=0.14))
            f = sphere(0.020, 6, 5).scaled(0.85, 1.7, 0.85)
            stems.append(f.at(*(at + out * 0.035 + np.array([0, 0.03, 0]))))
    for k in range(14):  # holdfast
        a = k * 2.4
        q = np.linspace(0, 1, 5)[:, None]
        p = np.column_stack([(0.02 + 0.22 * q[:, 0]) * np.cos(a + 0.6 * q[:, 0]), 0.14 * (1 - q[:, 0]) ** 1.5 - 0.02, (0.02 + 0.22 * q[:, 0]) * np.sin(a + 0.6 * q[:, 0])])
        stems.append(tube(p, np.linspace(0.014, 0.005, 5), 5))
    return join([tint(join(blades), (0.80, 0.74, 0.58), (1.0, 0.97, 0.82), top), tint(join(stems), (0.50, 0.44, 0.30), (0.78, 0.72, 0.48), top)])


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
    for name, make, heights, seconds, degrees, tone, thin in (
        ("giant_kelp", giant_kelp, np.array([0.0, 1.2, 2.6, 4.0, 5.4, 6.8, 8.2]), 6.0, 3.4, GOLDEN, 0.68),
        ("eelgrass", eelgrass, np.array([0.0, 0.15, 0.32, 0.52]), 4.0, 7.0, (1.1, 1.15, 1.1), 0.55),
    ):
        g = Glb(name)
        leaf = np.clip(c[::2, ::2] * np.array(tone), 0, 1)
        m = g.material("leaf", base=g.texture("leaf_color", leaf, 80), normal=g.texture("leaf_normal", nm[::4, ::4], 76), rough=0.5, double=True, thin=thin)
        sway(g, name, make(), m, heights, seconds, degrees)
        g.save(OUT / f"{name}.glb")


if __name__ == "__main__":
    main()
