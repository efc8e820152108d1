"""Three sea rocks for instancing: nodes rock_0 (boulder), rock_1 (slab), rock_2 (crag).

Each is about 1 m across, sits on y = 0 and reaches a little below it.
"""
from pathlib import Path

import numpy as np

import detail
import noise as N
from glb import Glb
from mesh import box_uv, Part, shade
from shapes import icosphere

OUT = Path(__file__).resolve().parents[2] / "assets" / "models"
SHAPES = ((0.56, 0.46, 0.50), (0.80, 0.24, 0.58), (0.42, 0.62, 0.44))


def rock(kind, level):
    v, f = icosphere(level)
    rng = np.random.default_rng(100 + kind)
    r = np.ones(len(v))
    for _ in range(11 + 3 * kind):  # fracture planes
        d = rng.standard_normal(3)
        d /= np.linalg.norm(d)
        cut = 0.70 + 0.22 * rng.random()
        over = v @ d
        r = np.where(over > 1e-3, np.minimum(r, 0.25 * r + 0.75 * cut / np.maximum(over, 1e-3)), r)
    strata = N.smooth(
        0.25,
        0.75,
        np.abs(((v[:, 1] + 0.25 * v[:, 0] + 0.12 * N.fbm3(v, 40 + kind, 2, 2)) * (3 + kind)) % 1 - 0.5) * 2,
    )
    r *= (
        1
        + 0.16 * N.fbm3(v, 7 + kind, 1.6, 3)
        + 0.05 * N.fbm3(v, 17 + kind, 6, 3)
        - 0.10 * (np.sqrt(N.value3(v, 27 + kind, 3) ** 2 + 0.012) - 0.11)  # gullies with a round bottom
        + 0.045 * strata
    )
    if level > 4:  # what coarser ones cannot show
        r *= 1 + 0.010 * N.fbm3(v, 57 + kind, 14, 2) - 0.014 * np.maximum(N.value3(v, 67 + kind, 9), 0)
    p = v * r[:, None] * np.array(SHAPES[kind])
    p[:, 1] += SHAPES[kind][1] * 0.55
    part = shade(Part(p, f), 55)
    up = N.smooth(0.3, 0.9, part.nrm[:, 1] + 0.3 * N.fbm3(part.pos, 5, 5, 2))
    low = N.smooth(0.18, -0.02, part.pos[:, 1])
    g = N.fbm3(part.pos, 31, 3.0, 3)
    c = np.tile([0.86, 0.84, 0.80], (len(part.pos), 1))
    c = N.mix(c, np.array([0.68, 0.76, 0.55]), 0.8 * N.smooth(0.0, 0.6, g) * (1 - low))
    c = N.mix(c, np.array([1.0, 0.95, 0.82]), np.maximum(0.6 * up, low))
    part.col = np.column_stack([c * (1 - 0.35 * N.smooth(0.2, -0.8, part.nrm[:, 1]))[:, None], np.ones(len(c))])
    return box_uv(part, TILE, 5)


def fracture(n, count, seed, slope, step, warp):
    """Broken faces: height (tile units), distance to the next face, and a random tone of each.

    Every face is a plane of its own slope and step; warp (two fields, pixels) bends their outlines.
    """
    rng = np.random.default_rng(seed)
    pts, tilt = rng.random((count, 2)), rng.normal(0, slope, (count, 2))
    lift, tone = rng.normal(0, step, count), rng.random(count)
    y, x = np.meshgrid((np.arange(n) + 0.5) / n, (np.arange(n) + 0.5) / n, indexing="ij")
    y, x = y + warp[0] / n, x + warp[1] / n
    d1, d2 = np.full((n, n), 9.0), np.full((n, n), 9.0)
    h, t = np.zeros((n, n)), np.zeros((n, n))
    for k, (py, px) in enumerate(pts):
        dy, dx = (y - py + 0.5) % 1 - 0.5, (x - px + 0.5) % 1 - 0.5
        d = np.hypot(dy * (0.7 + 0.6 * tone[k]), dx)
        closer = d < d1
        d2 = np.where(closer, d1, np.minimum(d2, d))
        d1 = np.where(closer, d, d1)
        h = np.where(closer, lift[k] + tilt[k, 0] * dy + tilt[k, 1] * dx, h)
        t = np.where(closer, tone[k], t)
    return h, d2 - d1, t


TILE = 1.2  # metres that the texture covers on rocks
DETAIL_REPEATS = 10.7  # in it: every 11 cm, of a copy three times as large every 34 cm


def texture(n=1024, tile=TILE):
    """Colour, roughness and normals of broken rock: faces of two sizes, cracks, pits, crusts and grain, each where it belongs."""
    mm = 0.001 / 2.0  # of a tile of 2 m; a smaller one has all of it smaller
    bend = [N.spectral(n, 61 + k, 3.6, 3, 60) for k in range(2)]
    big, gap, tone = fracture(n, 22, 64, 0.16, 7 * mm, [0.030 * n * b for b in bend])
    small, gap2, tone2 = fracture(n, 150, 65, 0.16, 2.2 * mm, [0.008 * n * b + 0.004 * n * N.spectral(n, 71 + k, 3.4, 10, 90) for k, b in enumerate(bend)])
    swell, patch, drift = N.spectral(n, 66, 4.0, 2, 24), N.spectral(n, 67, 3.4, 3), N.spectral(n, 68, 3.4, 4)
    grain, fine = N.spectral(n, 69, 3.2, 14, 110), N.spectral(n, 70, 2.0, 90)
    # Cracks: wide ones on some joints between large faces, hairs between small ones.
    wide = (1.2 + 3.0 * N.smooth(-0.5, 1.5, drift)) * mm
    crack = N.smooth(1.0, 0.25, gap / wide) * N.smooth(-0.3, 0.5, patch)
    hair = N.smooth(1.0, 0.3, gap2 / (1.2 * mm)) * N.smooth(0.2, 0.9, drift - 0.3 * patch)
    pits, bowl, _ = N.bumps(n, 2.0, 420, 72, 0.004, 0.022, where=N.smooth(-0.2, 1.4, swell - patch))
    crust, dome, shade_of = N.bumps(n, 2.0, 150, 73, 0.02, 0.11, where=N.smooth(-0.6, 1.2, patch), ragged=0.10 * N.spectral(n, 74, 3.0, 8, 80))
    shell, cone, _ = N.bumps(n, 2.0, 260, 75, 0.003, 0.010, where=N.smooth(0.0, 1.6, drift))
    weed = N.smooth(0.2, 1.2, N.spectral(n, 76, 3.3, 3) + 0.15 * grain) * (1 - crust)
    rough = N.smooth(-0.8, 1.0, drift + 0.6 * (tone2 - 0.5))  # some faces are smooth, others coarse
    h = big + small * (0.4 + 0.6 * rough) + (10 * swell + (0.6 + 1.3 * rough) * grain + (0.08 + 0.22 * rough) * fine) * mm
    h = N.blur(h, 0.8) - (9 * crack + 2.5 * hair) * mm - 0.7 * bowl / 2.0 + 1.6 * mm * N.blur(crust, 2.0) + 0.5 * cone / 2.0
    h = h + 0.35 * mm * N.spectral(n, 77, 2.4, 50, 180) * weed
    # What stands back is dark: broad hollows and cracks.
    hollow = N.blur(h, n * 0.012) - h
    cavity = N.smooth(1 * mm, 14 * mm, hollow)
    col = N.mix(N.flat(n, (0.47, 0.45, 0.415)), (0.63, 0.59, 0.52), N.smooth(-1, 1.4, patch + 0.7 * (tone - 0.5) + 0.6 * (tone2 - 0.5)))
    col = N.mix(col, (0.50, 0.42, 0.33), 0.5 * N.smooth(0.3, 1.5, drift - swell))
    col = N.mix(col, (0.43, 0.44, 0.30), 0.6 * weed)
    pink = N.mix(N.flat(n, (0.62, 0.46, 0.48)), (0.66, 0.60, 0.50), N.smooth(0.4, 0.6, shade_of))
    col = N.mix(col, pink, 0.65 * crust * (0.75 + 0.25 * N.smooth(-1, 1, grain)))
    col = N.mix(col, (0.78, 0.76, 0.69), 0.6 * shell)
    col = N.mix(col, (0.20, 0.19, 0.165), np.clip(N.blur(1.0 * crack + 0.5 * hair, 1.2) + 0.45 * pits, 0, 0.85))
    col = col * (1 - 0.28 * cavity + 0.10 * N.smooth(0.0, 5 * mm, -hollow) + 0.07 * grain + 0.09 * fine)[..., None]
    return (
        np.clip(col, 0, 1),
        N.rough_metal(np.clip(0.86 + 0.05 * weed - 0.06 * crust, 0, 1)),
        N.normal_map(h * tile, tile, steepest=0.8),
    )


def material(g, n=1024):
    c, mr, nm = texture(n)
    return g.material(
        "rock",
        base=g.texture("rock_color", c, 74),
        normal=g.texture("rock_normal", nm, 62),
        rough=0.88,
        detail=(g.texture("rock_detail", detail.rock(), 78), DETAIL_REPEATS),
    )


def main():
    g = Glb("rocks", packed=True)
    m = material(g)
    for k in range(3):
        g.node(f"rock_{k}", g.mesh(f"rock_{k}", [(rock(k, 5 if k == 0 else 4), m)]), at=(2.2 * (k - 1), 0, 0))
    g.save(OUT / "rocks.glb")


if __name__ == "__main__":
    main()
