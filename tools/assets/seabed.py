"""An 80 x 80 m sand bed: dunes, sand waves, fine ripples in the textures, rocks.

Sand lies near y = 0 and is almost flat in the middle (|x| < 8, |z| < 28).
scatter.json lists where the rocks (already nodes of this file) stand and where
plants and corals may be placed, as [x, y, z], yaw in degrees and scale.
"""
import json
from pathlib import Path

import numpy as np

import noise as N
import rocks
from glb import Glb, qmul, quat
from mesh import Part

OUT = Path(__file__).resolve().parents[2] / "assets" / "models"
SIZE, CELLS, TILE = 80.0, 184, 2.5


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
    col = np.tile([0.90, 0.88, 0.85], (len(pos), 1))
    col = N.mix(col, np.array([0.66, 0.62, 0.55]), N.smooth(-0.1, 0.8, big))
    col = N.mix(col, np.array([0.62, 0.66, 0.50]), 0.65 * N.smooth(0.15, 0.75, mid + 0.3 * fine))
    col = N.mix(col, np.array([1.0, 0.98, 0.94]), 0.7 * N.smooth(0.0, 0.5, y - 0.05 - 0.3 * big))
    col = col * (1 + 0.06 * fine + 0.05 * mid)[:, None]
    return np.column_stack([np.clip(col, 0, 1), np.ones(len(col))])


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
    part = Part(pos, tri, pos[:, [0, 2]] / TILE, n)
    part.col = tint(pos, y)
    return part


def ripples(n, waves, seed, spread=0.20, angle=0.16):
    """Quasi-periodic crests across v, with the forks real ripples have: phase of band-passed noise."""
    rng = np.random.default_rng(seed)
    fy, fx = np.meshgrid(np.fft.fftfreq(n) * n, np.fft.fftfreq(n) * n, indexing="ij")
    r, th = np.hypot(fx, fy), np.arctan2(fx, fy)
    band = np.exp(-(((r - waves) / (waves * spread)) ** 2) - (th / angle) ** 2) * (fy > 0)
    return np.fft.ifft2(np.fft.fft2(rng.standard_normal((n, n))) * band)


def sand(n=1024):
    zf = ripples(n, 15, 5, 0.30, 0.42)  # they fork, turn and change their spacing
    amp = np.abs(zf) / np.abs(zf).mean()
    ph = np.angle(zf)
    crest = np.cos(ph + 0.45 * np.sin(ph))
    crest = np.where(crest > 0, np.maximum(crest, 0) ** 1.25, crest * 0.8)
    crest = N.blur(crest, 2.0) * N.smooth(0.15, 1.1, amp)
    crest = crest * (0.15 + 0.85 * N.smooth(-1.1, 0.7, N.spectral(n, 9, 3.0, 1, 5)))  # and die out in patches
    small = np.cos(np.angle(ripples(n, 43, 8, 0.25, 0.5)))
    soft, mid, f = N.spectral(n, 2, 2.2, 1.5, 30), N.spectral(n, 3, 1.0, 20, 200), N.spectral(n, 4, 0.0, 150)
    col = N.mix(N.flat(n, (0.62, 0.55, 0.45)), (0.77, 0.71, 0.60), N.smooth(-1.1, 1.1, crest + 0.30 * mid + 0.25 * soft))
    col *= (1 + 0.035 * soft + 0.04 * mid + 0.055 * f)[..., None]
    grain = N.smooth(2.3, 3.2, f)
    col = N.mix(col, (0.93, 0.90, 0.84), 0.7 * grain)
    col = N.mix(col, (0.25, 0.22, 0.19), 0.6 * N.smooth(2.3, 3.2, -f + 0.3 * (crest < -0.2)))
    d1, _, who = N.cells(n, 130, 6)
    size = np.random.default_rng(2).random(130)[who]
    shell = N.smooth(0.0052, 0.0035, d1 / (0.5 + size)) * (size > 0.35)
    col = N.mix(col, (0.88, 0.85, 0.78), 0.8 * shell)
    h = 0.0095 * crest + 0.0008 * small + 0.006 * soft + 0.0010 * mid + 0.00035 * f + 0.003 * shell
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


def main():
    g = Glb("seabed")
    c, mr, n = sand()
    m = g.material("sand", base=g.texture("sand_color", c, 72), normal=g.texture("sand_normal", n, 70), rough=0.92)
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
