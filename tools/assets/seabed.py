"""An 80 x 80 m sand bed: dunes, sand waves, fine ripples in the textures, rocks.

Sand lies near y = 0 and is almost flat in the middle (|x| < 8, |z| < 28).
scatter.json lists where the rocks (already nodes of this file) stand and where
plants and corals may be placed, as [x, y, z], yaw in degrees and scale.
"""
import json
from pathlib import Path

import numpy as np

import noise as N
import detail
import rocks
from glb import Glb, qmul, quat
from mesh import Part

OUT = Path(__file__).resolve().parents[2] / "assets" / "models"
SIZE, CELLS, TILE, BEND = 80.0, 184, 2.5, 1.5  # metres, but for CELLS


def wave(phase, sharp=0.35):
    """A sand wave: gentle on one side, steep on the other, mean 0, about -1..1."""
    return np.sin(phase + sharp * np.sin(phase)) * 0.8 + 0.2 * np.sin(2 * phase + 0.8)


def height(x, z):
    """Sand level at x, z (m)."""
    p = np.column_stack([np.ravel(x), 0 * np.ravel(x), np.ravel(z)])
    warp, warp2 = N.fbm3(p, 3, 1 / 22, 3), N.fbm3(p, 4, 1 / 9, 2)
    x, z = p[:, 0], p[:, 2]
    edge = np.maximum(np.abs(x) - 8, np.maximum(np.abs(z) - 28, 0) * 1.0)
    open_sand = N.smooth(0, 16, edge)
    dune = wave((x * 0.94 + z * 0.34) / 15 * 2 * np.pi + 3.2 * warp) * 0.80 * (0.65 + 0.45 * warp)
    swell = 1.1 * N.fbm3(p, 9, 1 / 34, 2)
    sand_wave = (
        wave((x * 0.80 + z * 0.60) / 3.1 * 2 * np.pi + 2.5 * warp2) * 0.055 * (0.6 + 0.5 * N.smooth(-0.6, 0.6, warp2))
    )
    return (
        open_sand * (dune + swell + 0.25)
        + sand_wave * (0.55 + 0.45 * open_sand)
        + 0.05 * warp2
        + 0.02 * N.fbm3(p, 12, 0.9, 2)
    )


def tint(pos, y):
    """Colours of the sand at pos: coarse patches, a film of algae in hollows, pale crests."""
    big, mid, fine = (
        N.fbm3(pos * [1, 0, 1], 21, 1 / 17, 3),
        N.fbm3(pos * [1, 0, 1], 22, 1 / 5, 3),
        N.fbm3(pos * [1, 0, 1], 23, 1 / 1.6, 2),
    )
    col = np.tile([0.74, 0.72, 0.68], (len(pos), 1))
    col = N.mix(col, np.array([0.46, 0.43, 0.37]), N.smooth(-0.25, 0.6, big))
    col = N.mix(col, np.array([0.36, 0.38, 0.28]), 0.8 * N.smooth(0.10, 0.55, mid + 0.45 * fine))
    col = N.mix(col, np.array([0.92, 0.90, 0.86]), 0.7 * N.smooth(0.0, 0.5, y - 0.05 - 0.3 * big))
    col = col * (1 + 0.10 * fine + 0.08 * mid)[:, None]
    return np.column_stack([np.clip(col, 0, 1), np.ones(len(col))])


def texture_place(x, z):
    """Texture coordinates at x, z (m). Slow bends keep the tiles from lying in rows and turn their ripples."""
    p = np.column_stack([x, 0 * x, z])
    bend = np.column_stack([N.fbm3(p, 31, 1 / 13, 2), N.fbm3(p, 32, 1 / 13, 2)])
    return (p[:, [0, 2]] + BEND * bend) / TILE


def bed():
    t = np.linspace(-SIZE / 2, SIZE / 2, CELLS + 1)
    z, x = np.meshgrid(t, t, indexing="ij")
    y = height(x, z)
    pos = np.column_stack([x.ravel(), y, z.ravel()])
    i, j = np.meshgrid(np.arange(CELLS), np.arange(CELLS), indexing="ij")
    a = (i * (CELLS + 1) + j).ravel()
    b, c, d = a + 1, a + CELLS + 2, a + CELLS + 1
    odd = ((i + j) % 2).ravel()[:, None].astype(bool)
    tri = np.concatenate(
        [
            np.where(odd, np.stack([a, d, b], 1), np.stack([a, d, c], 1)),
            np.where(odd, np.stack([b, d, c], 1), np.stack([a, c, b], 1)),
        ]
    )
    e = 0.15
    hx = (height(x + e, z) - height(x - e, z)) / (2 * e)
    hz = (height(x, z + e) - height(x, z - e)) / (2 * e)
    n = np.column_stack([-hx, np.ones(len(hx)), -hz])
    n /= np.linalg.norm(n, axis=1, keepdims=True)
    part = Part(pos, tri, texture_place(pos[:, 0], pos[:, 2]), n)
    part.col = tint(pos, y)
    return part


def ripples(n, waves, seed, spread=0.20, angle=0.16):
    """Quasi-periodic crests across v, with the forks real ripples have: phase of band-passed noise."""
    rng = np.random.default_rng(seed)
    fy, fx = np.meshgrid(np.fft.fftfreq(n) * n, np.fft.fftfreq(n) * n, indexing="ij")
    r, th = np.hypot(fx, fy), np.arctan2(fx, fy)
    band = np.exp(-(((r - waves) / (waves * spread)) ** 2) - (th / angle) ** 2) * (fy > 0)
    return np.fft.ifft2(np.fft.fft2(rng.standard_normal((n, n))) * band)


def tracks(n, count, seed):
    """Furrows that snails and urchins leave: how deep (-1: the furrow, to 0.5: its banks), [n, n]."""
    rng = np.random.default_rng(seed)
    out = np.zeros((n, n))
    for _ in range(count):
        at, way, r = rng.random(2) * n, rng.random() * 2 * np.pi, (0.006 + 0.008 * rng.random()) / TILE * n
        turn = 0.0
        line = np.full((n, n), 9.0)
        for _ in range(int(rng.uniform(0.5, 1.8) / TILE * n / 2)):
            turn = 0.92 * turn + rng.normal(0, 0.035)
            way += turn
            at = at + 2 * np.array([np.sin(way), np.cos(way)])
            w = int(3 * r) + 1
            y, x = np.mgrid[-w:w + 1, -w:w + 1]
            box = np.ix_((int(at[0]) + np.arange(-w, w + 1)) % n, (int(at[1]) + np.arange(-w, w + 1)) % n)
            line[box] = np.minimum(line[box], np.hypot(y - at[0] % 1, x - at[1] % 1) / r)
        out += -np.exp(-line**2) + 0.5 * np.exp(-((line - 1.6) / 0.5) ** 2)
    return np.clip(out, -1, 0.6)


def sand(n=1024):
    zf = ripples(n, 15, 5, 0.26, 0.30)  # they fork, turn and change their spacing
    amp = np.abs(zf) / np.abs(zf).mean()
    ph = np.angle(zf)
    crest = np.cos(ph + 0.45 * np.sin(ph))
    crest = np.where(crest > 0, np.maximum(crest, 0) ** 1.25, crest * 0.8)
    crest = N.blur(crest, 2.0) * N.smooth(0.15, 1.1, amp)
    crest = crest * (0.45 + 0.55 * N.smooth(-0.9, 0.9, N.spectral(n, 9, 3.0, 1, 5)))  # and die out in patches
    small = np.cos(np.angle(ripples(n, 43, 8, 0.25, 0.5)))
    soft, mid, f = N.spectral(n, 2, 2.2, 1.5, 30), N.spectral(n, 3, 1.0, 20, 200), N.spectral(n, 4, 0.0, 150)
    lumps = N.spectral(n, 7, 1.6, 5, 60)
    col = N.mix(N.flat(n, (0.56, 0.49, 0.39)), (0.76, 0.70, 0.59), N.smooth(-1.1, 1.1, 0.9 * crest + 0.30 * mid + 0.10 * soft))
    col *= (1 + 0.02 * soft + 0.04 * lumps + 0.05 * mid + 0.075 * f)[..., None]
    litter = N.smooth(0.7, 2.2, -1.3 * crest + 0.5 * N.spectral(n, 10, 1.6, 6, 60) + 0.35 * f)  # dark, in the troughs
    col = N.mix(col, (0.27, 0.23, 0.16), 0.5 * litter)
    col = N.mix(col, (0.93, 0.90, 0.84), 0.7 * N.smooth(2.1, 3.0, f))
    col = N.mix(col, (0.20, 0.17, 0.14), 0.7 * N.smooth(2.0, 2.9, -f + 0.3 * (crest < -0.2)))
    drift = N.smooth(-0.4, 1.6, N.spectral(n, 11, 2.4, 1, 12) - 0.5 * crest)
    shell, shell_dome, tone = N.bumps(n, TILE, 1300, 12, 0.004, 0.016, drift)
    stone, stone_dome, grey = N.bumps(n, TILE, 700, 13, 0.006, 0.030, drift)
    cast, cast_dome, _ = N.bumps(n, TILE, 46, 14, 0.03, 0.07)
    furrow = tracks(n, 7, 15)
    col *= (1 + 0.10 * furrow)[..., None]
    col = N.mix(col, N.mix(N.flat(n, (0.90, 0.87, 0.80)), (0.58, 0.50, 0.42), tone), 0.85 * shell)
    shade_of = lambda cover, px: np.clip(N.blur(cover, px) - cover, 0, 1)  # sand beside a stone sees less of the sky
    col *= (1 - 0.5 * shade_of(stone, 3.0) - 0.5 * shade_of(shell, 1.5))[..., None]
    col = N.mix(col, N.mix(N.flat(n, (0.27, 0.25, 0.22)), (0.66, 0.61, 0.54), grey**1.5) * (1 + 0.12 * f + 0.10 * mid)[..., None], 0.92 * stone)
    h = 0.0085 * crest + 0.0008 * small + 0.003 * soft + 0.0016 * lumps + 0.0010 * mid + 0.00035 * f
    h += N.blur(cast_dome, 2.0) * 0.45 * (1 + 0.3 * mid * cast) + 0.006 * furrow + stone_dome + 0.8 * shell_dome
    rough = np.clip(0.90 + 0.04 * mid - 0.15 * shell, 0, 1)
    return np.clip(col, 0, 1), N.rough_metal(rough), N.normal_map(h, TILE)


def scatter():
    """Deterministic places for rocks, plants, corals, outside the wreck's berth."""
    rng = np.random.default_rng(42)
    out = {"rocks": [], "seagrass": [], "kelp": [], "corals": []}
    groups = [(11, -13), (-12, 4), (13, 18), (-15, -22), (22, -30), (-27, 16), (28, 6), (-24, -33), (6, 34), (-9, 31)]

    def place(kind, x, z, s, sink=0.0, **more):
        y = float(height(np.array([x]), np.array([z]))[0]) - sink
        out[kind].append(
            {
                **more,
                "position": [round(x, 3), round(y, 3), round(z, 3)],
                "yaw_deg": round(float(rng.random() * 360), 1),
                "scale": round(float(s), 3),
            }
        )

    berth = lambda x, z: abs(x) < 5.5 and abs(z) < 27
    for gx, gz in groups:
        for k in range(5):
            x, z = gx + rng.normal(0, 1.9), gz + rng.normal(0, 1.9)
            s = (0.35 + 1.5 * rng.random() ** 2) * (1.5 if k == 0 else 1)
            if not berth(x, z):
                place(
                    "rocks",
                    x,
                    z,
                    s,
                    0.10 * s,
                    mesh=f"rock_{rng.integers(3)}",
                    tilt_deg=round(float(rng.normal(0, 9)), 1),
                )
        for _ in range(4):
            x, z = gx + rng.normal(0, 2.6), gz + rng.normal(0, 2.6)
            if not berth(x, z):
                place("corals", x, z, 0.6 + 0.7 * rng.random(), 0.03, mesh=f"coral_{rng.integers(3)}")
        for _ in range(16):
            x, z = gx + rng.normal(0, 4.0), gz + rng.normal(0, 4.0)
            if not berth(x, z) and max(abs(x), abs(z)) < 39:
                place("seagrass", x, z, 0.7 + 0.8 * rng.random(), 0.02)
    for gx, gz in groups[4:]:
        for _ in range(5):
            x, z = gx + rng.normal(0, 2.5), gz + rng.normal(0, 2.5)
            place("kelp", x, z, 0.7 + 0.6 * rng.random(), 0.05)
    return out


def grains(g):
    """The sand's detail texture and how often it repeats in a tile."""
    return g.texture("sand_detail", detail.sand(), 82), TILE / detail.SAND_TILE


def main():
    g = Glb("seabed", packed=True)
    c, mr, n = sand()
    m = g.material("sand", base=g.texture("sand_color", c, 72), normal=g.texture("sand_normal", n, 70), rough=0.92, detail=grains(g))
    g.node("sand", g.mesh("sand", [(bed(), m)]))
    m_rock = rocks.material(g, 512)
    meshes = {f"rock_{k}": g.mesh(f"rock_{k}", [(rocks.rock(k, 3), m_rock)]) for k in range(3)}
    places = scatter()
    root = g.node("rocks")
    for k, r in enumerate(places["rocks"]):
        rot = qmul(quat("y", r["yaw_deg"]), quat("x", r["tilt_deg"]))
        g.node(f"rock_at_{k}", meshes[r["mesh"]], at=r["position"], rot=rot, scale=[r["scale"]] * 3, parent=root)
    g.save(OUT / "seabed.glb")
    (OUT / "scatter.json").write_text(json.dumps(places, indent=1) + "\n")


if __name__ == "__main__":
    main()
