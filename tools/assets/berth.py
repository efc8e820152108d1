"""The sand round the wreck: banked up against the hull, scoured into a moat beyond, with a low rim.

berth.glb lies on seabed.glb in its frame: its outer edge dives under that sand, its inner edge goes into the hull of
submarine.glb as assets/scenes/wreck.toml lays it down. Sand, tint and texture are seabed.py's.
"""
from pathlib import Path

import numpy as np

import noise as N
import seabed
from glb import Glb
from mesh import Part, rotation, shade
from submarine_hull import dent, rake, section

OUT = Path(__file__).resolve().parents[2] / "assets" / "models"
PLACE, YAW, PITCH, ROLL = np.array([-0.2, -0.35, 0.0]), -3.0, 0.6, -9.0  # of the wreck, over seabed.glb's zero
STEP = 0.36  # metres along the hull
ACROSS = np.concatenate([[-0.55, -0.2], np.linspace(0, 2.2, 10), [2.6, 3.0, 3.4, 3.9, 4.5, 5.2, 6.0]])


def hull_points():
    """Points of the hull's skin in the bed's frame, [stations, girth, 3], from the starboard deck edge round to port."""
    t = np.linspace(0.1, 1, 240)
    turn = rotation("y", YAW) @ rotation("x", PITCH) @ rotation("z", ROLL)
    rows = []
    for z in np.linspace(-23.9, 23.9, 240):
        x, y = section(z, t)
        half = np.column_stack([x, y, rake(x, y, np.full(len(t), z))])
        port = dent((half * [-1, 1, 1])[::-1])
        rows.append(np.concatenate([half, port]) @ turn.T + PLACE)
    return np.array(rows)


def waterline():
    """Where the hull meets the bed: a closed curve (x, z), counted from the bow along starboard and back along port."""
    sides = ([], [])
    for row in hull_points():
        under = row[:, 1] - seabed.height(row[:, 0], row[:, 2]) < 0
        if not under.any():
            continue
        first, last = np.flatnonzero(under)[[0, -1]]
        sides[0].append(row[first][[0, 2]])
        sides[1].append(row[last][[0, 2]])
    loop = np.concatenate([sides[0], sides[1][::-1]])
    loop = np.concatenate([loop, loop[:1]])
    along = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(loop, axis=0), axis=1))])
    at = np.linspace(0, along[-1], int(along[-1] / STEP) + 1)
    even = np.column_stack([np.interp(at, along, loop[:, k]) for k in (0, 1)])
    ring = even[:-1]
    for _ in range(4):  # no corners, which rows across would cross at
        ring = 0.5 * ring + 0.25 * (np.roll(ring, 1, 0) + np.roll(ring, -1, 0))
    return ring


def rise(d, x, z):
    """Metres of sand over the bed at d metres off the hull's old waterline."""
    p = np.column_stack([x, 0 * x, z])
    slow, mid, fine = N.fbm3(p, 61, 1 / 6, 3), N.fbm3(p, 62, 1 / 1.7, 3), N.fbm3(p, 63, 2.2, 2)
    bank = (0.42 + 0.30 * slow + 0.12 * mid + 0.05 * fine) * np.exp(-((np.maximum(d, 0) / (0.85 + 0.25 * slow)) ** 2))
    moat = -(0.17 + 0.05 * mid) * np.exp(-(((d - 1.75 - 0.35 * slow) / 0.55) ** 2))
    rim = 0.20 * N.smooth(5.4, 2.7 + 0.5 * slow, d)
    return bank + moat + rim + (0.035 * mid + 0.016 * fine) * N.smooth(5.2, 3.2, d) - 0.05 * N.smooth(3.6, 5.6, d)


def berth():
    ring = waterline()
    along = np.roll(ring, -1, 0) - np.roll(ring, 1, 0)
    out = np.column_stack([-along[:, 1], along[:, 0]])
    out /= np.linalg.norm(out, axis=1, keepdims=True)
    if (out * (ring - ring.mean(0))).sum() < 0:
        out = -out
    for _ in range(60):  # rows fan out round bow and stern instead of crossing
        out = 0.5 * out + 0.25 * (np.roll(out, 1, 0) + np.roll(out, -1, 0))
        out /= np.linalg.norm(out, axis=1, keepdims=True)
    n, m = len(ring), len(ACROSS)
    xz = ring[:, None] + out[:, None] * ACROSS[None, :, None]
    x, z = xz[..., 0].ravel(), xz[..., 1].ravel()
    d = np.tile(ACROSS, n)
    pos = np.column_stack([x, seabed.height(x, z) + rise(d, x, z), z])
    i, j = np.meshgrid(np.arange(n), np.arange(m - 1), indexing="ij")
    a, b = (i * m + j).ravel(), ((i + 1) % n * m + j).ravel()
    tri = np.concatenate([np.stack([a, b, a + 1], 1), np.stack([b, b + 1, a + 1], 1)])
    up = np.cross(pos[tri[:, 1]] - pos[tri[:, 0]], pos[tri[:, 2]] - pos[tri[:, 0]])[:, 1]
    tri = np.where((up > 0)[:, None], tri, tri[:, ::-1])
    part = shade(Part(pos, tri, seabed.texture_place(pos[:, 0], pos[:, 2])), 80)
    part.col = seabed.tint(part.pos, part.pos[:, 1])
    return part


def main():
    g = Glb("berth", packed=True)
    c, _, n = seabed.sand()
    m = g.material("sand", base=g.texture("sand_color", c, 72), normal=g.texture("sand_normal", n, 70), rough=0.92, detail=seabed.grains(g))
    g.node("berth", g.mesh("berth", [(berth(), m)]))
    g.save(OUT / "berth.glb")


if __name__ == "__main__":
    main()
