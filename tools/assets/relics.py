"""Things that people lost: relics.glb, a node a thing, laid out side by side, standing or lying on y = 0.

A tyre, an oil drum, an Admiralty anchor, a length of chain, a coil of rope, a piece of trawl net.
"""
from pathlib import Path

import numpy as np

import noise as N
from glb import Glb
from mesh import box_uv, join, loft, Part, shade
from reef import paint, unit
from shapes import circle, curve, cylinder, revolve, torus, tube
from wreck_textures import corroded

OUT = Path(__file__).resolve().parents[2] / "assets" / "models"
SILT = (0.74, 0.70, 0.60)


def settle(part, low, high, seed, silt=0.55):
    """Colour by chance, with silt on what faces up and growth in patches."""
    p = part if part.nrm is not None else shade(part, 45)
    k = np.clip(0.5 + 0.6 * N.fbm3(p.pos, seed, 5, 4), 0, 1)
    c = N.mix(np.tile(low, (len(k), 1)), np.asarray(high, float), k)
    grown = N.smooth(0.15, 0.6, N.fbm3(p.pos, seed + 3, 7, 3) + 0.25 * p.nrm[:, 1])
    c = N.mix(c, np.array([0.50, 0.52, 0.34]), 0.55 * grown)
    c = N.mix(c, np.array(SILT), silt * N.smooth(0.45, 0.95, p.nrm[:, 1] + 0.25 * N.fbm3(p.pos, seed + 5, 9, 2)))
    c = c * (1 - 0.35 * N.smooth(0.0, -0.9, p.nrm[:, 1]))[:, None]
    p.col = np.column_stack([np.clip(c, 0, 1), np.ones(len(k))])
    return p


def tyre():
    """A car tyre of 0.62 m, bulged where it lies, with tread blocks."""
    prof = []
    for a in np.radians(np.linspace(-128, 128, 15)):
        prof.append((0.225 + 0.082 * np.cos(a), 0.094 * np.sin(a)))
    inner = [(r * 0.965 - 0.002, z * 0.86) for r, z in prof[::-1]]
    body = revolve(prof + inner + prof[:1], 48, (False, False))
    parts = [body]
    for row, z in enumerate((-0.058, -0.020, 0.020, 0.058)):
        for k in range(44):
            a = (k + 0.5 * (row % 2)) * 2 * np.pi / 44
            block = loft(np.array([[(sx * w, -0.007, sz * w) for sx, sz in ((-1, -1), (1, -1), (1, 1), (-1, 1))] if low else [(sx * w, 0.007, sz * w) for sx, sz in ((-1, -1), (1, -1), (1, 1), (-1, 1))] for low, w in ((1, 0.016), (0, 0.0145))], float))
            r = 0.305 - 0.10 * z * z / 0.06
            parts.append(block.rot("z", 0).at(0, r, z).rot("z", np.degrees(a)))
    p = join(parts).rot("x", 90).at(0, 0.075, 0).rot("z", 7)
    return box_uv(settle(p, (0.060, 0.060, 0.062), (0.15, 0.145, 0.135), 71, 0.75), 0.5)


def drum():
    """An oil drum of 200 litres, on its side, dented, one lid rusted through."""
    prof = [(0.270, -0.435), (0.290, -0.440), (0.292, -0.425), (0.285, -0.415)]
    for z in np.linspace(-0.40, 0.40, 33):
        hoop = sum(np.exp(-(((z - h) / 0.012) ** 2)) for h in (-0.145, 0.145))
        prof.append((0.285 + 0.013 * hoop + 0.0012 * np.sin(z * 160) * (abs(z) > 0.2), z))
    prof += [(0.285, 0.415), (0.292, 0.425), (0.290, 0.440), (0.270, 0.435), (0.255, 0.30), (0.03, 0.28)]
    p = revolve(prof, 40, (True, True))

    def dent(q):
        d = np.array([0.27, 0.10, 0.05])
        w = np.exp(-(np.linalg.norm(q - d, axis=1) / 0.17) ** 2)
        e = np.exp(-(np.linalg.norm(q - [-0.05, 0.28, -0.25], axis=1) / 0.13) ** 2)
        return q * (1 - 0.28 * w - 0.18 * e)[:, None]

    p = p.map(dent).rot("y", 12).at(0, 0.235, 0).rot("z", 4)
    return box_uv(settle(p, (0.42, 0.22, 0.12), (0.70, 0.44, 0.26), 81), 0.6)


def anchor():
    """An Admiralty anchor, 1.9 m, as it has held: one fluke deep in the sand, the shank sloping down to stock and ring, which lie on it."""
    shank = tube(curve([(0, 0, 0), (0, 0.9, 0), (0, 1.75, 0)], 10), [0.075, 0.07, 0.068, 0.064, 0.06, 0.058, 0.056, 0.054, 0.052, 0.05], 10)
    parts = [shank]
    arc = [(0.78 * np.sin(a), 0.78 - 0.80 * np.cos(a), 0) for a in np.linspace(-1.08, 1.08, 19)]
    parts.append(tube(np.array(arc), 0.068 - 0.022 * np.abs(np.linspace(-1, 1, 19)) ** 2, 10))
    for side in (-1, 1):
        a = side * 0.98
        at = np.array([0.78 * np.sin(a), 0.78 - 0.80 * np.cos(a), 0])
        leaf = np.array([(0, -0.16, 0.02), (0.13, -0.02, 0), (0.10, 0.12, 0), (0, 0.22, -0.01), (-0.10, 0.12, 0), (-0.13, -0.02, 0)])
        rings = [leaf * s + np.array([0, 0, z]) for s, z in ((0.92, -0.012), (1, 0), (0.92, 0.012))]
        fluke = loft(np.array(rings), (True, True)).rot("y", 90).rot("z", np.degrees(-a) + 90 * 0).at(*(at + np.array([-side * 0.045, 0.05, 0])))
        parts.append(fluke)
    stock = tube(np.array([(0, 1.58, -0.86), (0, 1.58, -0.4), (0, 1.58, 0), (0, 1.58, 0.4), (0, 1.58, 0.86)]), [0.032, 0.042, 0.05, 0.042, 0.032], 10)
    parts += [stock, torus(0.15, 0.026, 22, 8).rot("y", 90).at(0, 1.90, 0)]
    p = join(parts).rot("z", 98.5).rot("x", 4).at(0.80, 0.27, 0)
    p = settle(p, (0.30, 0.18, 0.12), (0.56, 0.38, 0.26), 91)
    low = N.smooth(0.14, 0.02, p.pos[:, 1] + 0.05 * N.fbm3(p.pos, 93, 6, 2))  # sand sticks near the bed
    p.col[:, :3] = N.mix(p.col[:, :3], np.array(SILT) * 0.85, 0.7 * low)
    return box_uv(p, 0.6)


def chain():
    """Twenty-two links along a bent line, each turned a quarter against the last."""
    line = curve([(-1.25, 0.05, 0.2), (-0.6, 0.05, -0.12), (0.0, 0.05, 0.16), (0.55, 0.06, 0.0), (1.25, 0.05, 0.34)], 400)
    s = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
    parts, pitch = [], 0.115
    t = np.linspace(0, 2 * np.pi, 20, endpoint=False)
    straight = 0.038
    for k in range(int(s[-1] / pitch)):
        at = np.array([np.interp((k + 0.5) * pitch, s, line[:, c]) for c in range(3)])
        ahead = np.array([np.interp((k + 0.5) * pitch + 0.02, s, line[:, c]) for c in range(3)]) - at
        yaw = np.degrees(np.arctan2(ahead[0], ahead[2]))
        z = 0.036 * np.cos(t) + straight * np.sign(np.cos(t))
        ring = np.column_stack([0.036 * np.sin(t), np.zeros_like(t), z])
        c = circle(7, 0.0145)
        out = []
        for p, a in zip(ring, t):
            n = np.array([np.sin(a), 0, np.cos(a)])
            out.append(p + c[:, :1] * n + c[:, 1:] * np.array([0, 1, 0]))
        link = loft(np.array(out + out[:1]), (False, False))
        parts.append(link.rot("z", 42 if k % 2 else -48).rot("y", yaw).at(*(at + [0, -0.012, 0])))
    return box_uv(settle(join(parts), (0.28, 0.16, 0.10), (0.54, 0.34, 0.22), 95, 0.35), 0.4)


def rope():
    """Three strands laid right-handed, in a loose coil with an end that runs off; a lay of 3.5 diameters."""
    t = np.linspace(0, 1, 560)  # a dozen sections a lay
    turns = 2 * np.pi * 3.3
    r = 0.30 + 0.06 * np.sin(t * 9) + 0.10 * np.maximum(0, t - 0.86) * 10
    path = np.column_stack([r * np.cos(turns * t), 0.02 + 0.045 * t * 1.3 + 0.018 * np.sin(t * 31), r * np.sin(turns * t) * 0.86])
    path[:, 1] = np.where(t > 0.88, path[:, 1] * np.clip(1 - (t - 0.88) / 0.12, 0, 1) + 0.02, path[:, 1])
    s = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))])
    from shapes import frames

    _, u, v = frames(path)
    parts = []
    for strand in range(3):
        a = s / 0.155 * 2 * np.pi + strand * 2 * np.pi / 3
        q = path + 0.0105 * (np.cos(a)[:, None] * u + np.sin(a)[:, None] * v)
        parts.append(tube(q, 0.0115, 5))
    return box_uv(settle(join(parts), (0.42, 0.36, 0.24), (0.62, 0.55, 0.40), 99, 0.45), 0.3)


def net_texture(n=256):
    """Diamond meshes of twisted twine, four across; RGBA, tileable."""
    y, x = np.meshgrid((np.arange(n) + 0.5) / n, (np.arange(n) + 0.5) / n, indexing="ij")
    wob = 0.008 * np.sin(2 * np.pi * (x + 2 * y)) + 0.006 * np.sin(2 * np.pi * (3 * x - y))
    u, v = (x + y) * 4 + wob * 4, (x - y) * 4 + wob * 4
    d = np.minimum(np.abs(u - np.round(u)), np.abs(v - np.round(v)))
    knot = np.hypot(u - np.round(u), v - np.round(v))
    line = N.smooth(0.085, 0.055, d) + N.smooth(0.19, 0.14, knot)
    col = N.mix(N.flat(n, (0.16, 0.34, 0.27)), (0.40, 0.45, 0.33), N.smooth(-0.6, 1.4, N.spectral(n, 5, 1.2, 3)))
    return np.dstack([col * (0.9 + 0.2 * N.spectral(n, 7, 0.3, 40) * 0.3)[..., None], np.clip(line, 0, 1)])


def net():
    """A torn piece of trawl, draped over what lies beneath, with its head rope and three floats."""
    n, m = 34, 22
    u, v = np.meshgrid(np.linspace(0, 1, n), np.linspace(0, 1, m), indexing="xy")
    flat = np.stack([u * 3 - 1.5, np.zeros_like(u), v * 1.9 - 0.95], 2).reshape(-1, 3)
    h = 0.55 * np.exp(-(((flat[:, 0] + 0.5) / 0.55) ** 2 + ((flat[:, 2] + 0.1) / 0.5) ** 2))
    h = h + 0.34 * np.exp(-(((flat[:, 0] - 0.75) / 0.4) ** 2 + ((flat[:, 2] - 0.2) / 0.45) ** 2))
    h = h + 0.08 * np.abs(N.fbm3(flat, 3, 2.4, 3)) + 0.05 * N.fbm3(flat, 4, 6, 2)
    head = N.smooth(0.12, 0.0, v.ravel())
    h = N.mix(h, 0.42 + 0.10 * np.sin(6 * flat[:, 0]), head)
    pos = np.column_stack([flat[:, 0] + 0.06 * N.fbm3(flat, 5, 2, 2), np.maximum(h, 0.01), flat[:, 2] + 0.08 * N.fbm3(flat, 6, 2, 2) + 0.25 * head])
    i, j = np.meshgrid(np.arange(m - 1), np.arange(n - 1), indexing="ij")
    a = (i * n + j).ravel()
    keep = ~((N.fbm3(flat[a], 8, 1.6, 2) > 0.62) & (v.ravel()[a] > 0.3))  # torn
    a = a[keep]
    tri = np.concatenate([np.stack([a, a + n, a + n + 1], 1), np.stack([a, a + n + 1, a + 1], 1)])
    cloth = shade(Part(pos, tri, np.stack([u * 7.5, v * 4.75], 2).reshape(-1, 2)), 80)
    top = pos[:n]
    line = box_uv(settle(tube(curve(top[::3], 40), 0.014, 6), (0.35, 0.32, 0.22), (0.5, 0.46, 0.32), 105, 0.2), 0.3)
    floats = []
    for k in (4, 16, 28):
        b = revolve([(0.02, -0.075), (0.055, -0.055), (0.07, 0.0), (0.055, 0.055), (0.02, 0.075)], 16).at(0, 0.075, 0).at(*top[k])
        floats.append(settle(b, (0.62, 0.30, 0.08), (0.85, 0.48, 0.14), 110 + k, 0.1))
    return cloth, join([line] + [box_uv(f, 0.3) for f in floats])


def main():
    g = Glb("relics")
    _, _, h = corroded(256, 5, 0.2)
    tone = np.clip(0.82 + 0.10 * N.spectral(256, 6, 1.6, 3) + 0.05 * N.spectral(256, 7, 0.6, 40), 0, 1)
    skin = g.material("relic", base=g.texture("relic_color", tone[..., None] * np.ones(3), 80), normal=g.texture("relic_normal", N.normal_map(0.006 * h, 0.6), 78), rough=0.85)
    twine = g.material("twine", base=g.texture("net_color", net_texture()), rough=0.9, double=True, mask=0.5)
    cloth, line = net()
    things = [("tyre", [(tyre(), skin)]), ("drum", [(drum(), skin)]), ("anchor", [(anchor(), skin)]), ("chain", [(chain(), skin)]), ("rope", [(rope(), skin)]), ("net", [(cloth, twine), (line, skin)])]
    for k, (name, prims) in enumerate(things):
        g.node(name, g.mesh(name, prims), at=(2.2 * (k % 3 - 1), 0, 2.2 * (k // 3 - 0.5)))
    g.save(OUT / "relics.glb")


if __name__ == "__main__":
    main()
