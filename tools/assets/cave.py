"""A sea cave to swim into: cave.glb, rock seen from inside and from the sea, mouth at z = +9.

The floor lies near y = 0; the tunnel winds from the mouth 22 m into the rock and rises to a chamber.
At the mouth the rock turns outwards into a cliff, and the floor goes on as a bed of sand. Stalactites hang
from the roof. Origin: on the floor, in the middle.
"""
from pathlib import Path

import numpy as np

import noise as N
from glb import Glb
from mesh import box_uv, join, loft, Part, shade
from rocks import texture
from shapes import tube

OUT = Path(__file__).resolve().parents[2] / "assets" / "models"
WALL_TILE = 3.0  # metres that the texture covers
MOUTH = -0.02  # line()'s s at the edge of the cliff
# Beds and joints dip: no block stands square to the tunnel.
DIP, STRIKE = np.radians(24), np.radians(33)
TILTED = np.array([[np.cos(STRIKE), 0, np.sin(STRIKE)], [0, 1, 0], [-np.sin(STRIKE), 0, np.cos(STRIKE)]]) @ np.array(
    [[np.cos(DIP), -np.sin(DIP), 0], [np.sin(DIP), np.cos(DIP), 0], [0, 0, 1]]
)


def line(s):
    """The middle of the tunnel and its half width and height at s from 0 (mouth) to 1."""
    z = 9.0 - 22.0 * s
    x = 1.1 * np.sin(s * 5.2) + 0.6 * np.sin(s * 11 + 1)
    y = 1.5 + 0.5 * s + 0.15 * np.sin(s * 9)
    wide = 2.5 + 1.0 * np.exp(-(((s - 0.55) / 0.16) ** 2)) - 0.7 * np.exp(-(((s - 0.25) / 0.10) ** 2)) - 1.2 * N.smooth(0.85, 1, s)
    high = 1.75 + 0.9 * np.exp(-(((s - 0.55) / 0.16) ** 2)) - 0.3 * np.exp(-(((s - 0.25) / 0.10) ** 2)) - 0.8 * N.smooth(0.85, 1, s)
    return np.array([x, y, z]), wide, high


def joints(p, seed, size, step, tilt, soft):
    """How far broken blocks stand out at points p (m): blocks of about this size, each a plane of its own step and tilt."""
    p = p @ TILTED + 0.30 * size * np.column_stack([N.fbm3(p, seed + k, 1.3 / size, 2) for k in range(3)])
    cell = np.floor(p / size).astype(int)
    weight, out = np.zeros(len(p)), np.zeros(len(p))
    for dx in (-1, 0, 1):
        for dy in (-1, 0, 1):
            for dz in (-1, 0, 1):
                c = cell + (dx, dy, dz)
                h = ((c[:, 0] * 73856093) ^ (c[:, 1] * 19349663) ^ (c[:, 2] * 83492791) ^ (seed * 2654435761)) & 0x7FFFFFFF
                r = []
                for _ in range(7):
                    h = (h ^ (h >> 13)) * 1274126177 & 0x7FFFFFFF
                    r.append(((h ^ (h >> 16)) & 0xFFFF) / 65535)
                off = p - (c + 0.15 + 0.7 * np.column_stack(r[:3])) * size
                d = (off**2 * (0.7, 1.6, 0.7)).sum(1)  # beds lie flat: blocks are wider than high
                height = step * (r[3] - 0.5) * 2 + tilt * ((r[4] - 0.5) * off[:, 0] + (r[5] - 0.5) * off[:, 1] + (r[6] - 0.5) * off[:, 2]) * 2
                near = np.exp(-soft * d / size**2)  # edges are worn round
                out, weight = out + near * height, weight + near
    return out / weight


def section(s, ang):
    """The tunnel's smooth outline at s."""
    at, wide, high = line(s)
    c, d = np.cos(ang), np.sin(ang)
    return np.column_stack([at[0] + wide * np.sign(c) * np.abs(c) ** 0.85, at[1] + high * d, np.full(len(ang), at[2])])


def outside(ang, steps):
    """Smooth rings from the mouth on: the lip bends round into the cliff, the floor runs out to sea. With the way out of the rock."""
    c, d = np.cos(ang), np.sin(ang)
    cliff = N.smooth(-0.80, -0.25, d)
    to_side = np.column_stack([c, d * cliff, np.zeros(len(ang))])
    p, gone, out = section(MOUTH, ang), 0.0, []
    for step in steps:
        gone += step
        lip = 0.9 + 0.5 * np.sin(2 * ang + 1) + 0.3 * np.sin(5 * ang)  # metres in which the lip bends
        turn = np.radians(40 + 52 * cliff) * (1 - np.exp(-gone / lip))
        p = p + step * (np.sin(turn)[:, None] * to_side + np.cos(turn)[:, None] * [0, 0, 1])
        way = -np.cos(turn)[:, None] * np.column_stack([c, d, 0 * c]) + (np.sin(turn) * cliff)[:, None] * [0, 0, 1]
        out.append((p, way / np.linalg.norm(way, axis=1)[:, None]))
    return out


def broken(p, way, d):
    """Points p moved along the way out of the rock: hollows and bulges, blocks, ledges; under all the floor."""
    sea = N.smooth(4.5, 8.5, p[:, 2])  # surge has worn the mouth
    rough = 0.42 * N.fbm3(p, 3, 0.55, 3) + 0.10 * np.abs(N.fbm3(p, 8, 1.3, 3)) + 0.04 * N.fbm3(p, 13, 4.0, 2)
    rough = rough + sea * (0.30 * N.fbm3(p, 51, 0.9, 3) + 0.07 * N.fbm3(p, 53, 2.6, 3))
    blocks = joints(p, 41, 1.3, 0.24, 0.34, 18) + joints(p, 47, 0.6, 0.07, 0.24, 10)
    rough = rough + N.smooth(-0.95, -0.4, d) * (1 - 0.55 * sea) * blocks
    ledge = 0.10 * N.smooth(0.2, 0.8, np.abs((p[:, 1] * 1.6 + 0.4 * N.fbm3(p, 17, 0.7, 2)) % 1 - 0.5) * 2)
    p = p + (rough + (1 - 0.6 * sea) * ledge)[:, None] * way
    out = N.smooth(8.0, 14.0, p[:, 2])
    floor = 0.06 * N.fbm3(p, 23, 1.1, 3) + out * (0.25 * N.fbm3(p, 25, 0.22, 2) - 0.25)
    p[:, 1] = np.maximum(p[:, 1], floor)
    return p


def worn(rings):
    """Rings of points [r, n, 3], round each: flakes and spikes that stand out from their neighbours are worn down."""
    p = np.array(rings)
    for _ in range(6):
        fore, aft = np.roll(p, 1, 1), np.roll(p, -1, 1)
        up, down = np.concatenate([p[:1], p[:-1]]), np.concatenate([p[1:], p[-1:]])
        near = np.stack([fore, aft, up, down])
        off = near.mean(0) - p
        size = np.linalg.norm(near - p, axis=3).mean(0) + 1e-6
        share = 0.6 * N.smooth(0.26, 0.60, np.linalg.norm(off, axis=2) / size)
        share[[0, -1]] = 0
        p = p + share[:, :, None] * off
    return p


def main():
    n, m = 100, 120
    ang = np.arange(n) / n * 2 * np.pi
    d = np.sin(ang)
    inwards = np.column_stack([-np.cos(ang), -d, np.zeros(n)])
    steps = 0.18 * 1.055 ** np.arange(32)
    rings = [broken(p, way, d) for p, way in outside(ang, steps)[::-1]]
    rings += [broken(section(s, ang), inwards, d) for s in np.linspace(MOUTH, 1, m)]
    wall = loft(worn(rings), (False, True), orient=False)
    t = shade(wall, 60)
    inside = t.pos[:, 2] < 8
    middle = np.array([line((9.0 - z) / 22.0)[0] for z in t.pos[inside, 2]])
    if ((middle - t.pos[inside]) * t.nrm[inside]).sum(1).mean() < 0:
        wall = wall.flipped()
    rng = np.random.default_rng(5)
    parts = [wall]
    for k in range(26):  # stalactites
        s = 0.25 + 0.65 * rng.random()
        at, wide, high = line(s)
        x = at[0] + (rng.random() - 0.5) * wide * 1.2
        top = at[1] + high * 0.82
        ln = 0.25 + 0.75 * rng.random() ** 2
        z = at[2] + rng.normal(0, 0.3)
        q = np.linspace(0, 1, 7)[:, None]
        p = np.array([x, top + 0.35, z]) - q * np.array([0.04 * rng.normal(), ln + 0.35, 0.04 * rng.normal()])
        parts.append(tube(p, np.linspace(0.13, 0.012, 7) * (0.6 + 0.6 * rng.random()), 8, (False, True)))
    part = shade(join(parts), 50)
    up = N.smooth(0.35, 0.9, part.nrm[:, 1])
    g = N.fbm3(part.pos, 31, 0.8, 4)
    light = N.smooth(1.0, 8.5, part.pos[:, 2])  # growth needs daylight
    c = np.tile([0.78, 0.72, 0.64], (len(part.pos), 1)) * (1 + 0.22 * g)[:, None]
    c = N.mix(c, np.array([0.72, 0.46, 0.36]), 0.5 * N.smooth(0.0, 0.5, N.fbm3(part.pos, 37, 1.7, 3)) * (0.3 + 0.7 * light))
    c = N.mix(c, np.array([0.52, 0.58, 0.36]), 0.6 * light * N.smooth(-0.2, 0.5, g))
    c = N.mix(c, np.array([1.0, 0.93, 0.80]), 0.85 * up)
    hollow = N.fbm3(part.pos, 3, 0.55, 3) * 0.42 + 0.20 * np.abs(N.fbm3(part.pos, 8, 1.3, 3))
    c = c * (1 - 0.55 * N.smooth(0.12, -0.28, hollow))[:, None]  # what stands back has dark films and no growth
    part.col = np.column_stack([np.clip(c, 0, 1), np.ones(len(c))])
    col, _, nm = texture(1024, WALL_TILE)
    col = N.mix(col, col.mean((0, 1)), 0.5)  # worn by surge: less crust than on rocks outside
    glb = Glb("cave")
    m_r = glb.material("rock", base=glb.texture("rock_color", col, 74), normal=glb.texture("rock_normal", nm, 64), rough=0.95, double=True)
    glb.node("cave", glb.mesh("cave", [(box_uv(part, WALL_TILE, 8), m_r)]))
    glb.save(OUT / "cave.glb")


if __name__ == "__main__":
    main()
