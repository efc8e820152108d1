"""Three sea rocks for instancing: nodes rock_0 (boulder), rock_1 (slab), rock_2 (crag).

Each is about 1 m across, sits on y = 0 and reaches a little below it.
"""
from pathlib import Path

import numpy as np

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
        - 0.10 * np.abs(N.value3(v, 27 + kind, 3))
        + 0.045 * strata
    )
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
    return box_uv(part, 1.0)


def texture(n=1024):
    a, b, f = N.spectral(n, 61, 2.0, 2), N.spectral(n, 62, 1.6, 4), N.spectral(n, 63, 0.8, 40)
    d1, d2, _ = N.cells(n, 40, 64)
    crack = N.smooth(0.016, 0.0, d2 - d1 + 0.012 * b) * N.smooth(-0.3, 0.8, a)
    crust = N.smooth(0.35, 0.9, N.spectral(n, 65, 1.8, 3) + 0.35 * f)
    weed = N.smooth(0.3, 1.4, N.spectral(n, 66, 1.8, 3) + 0.4 * f)
    col = N.mix(N.flat(n, (0.50, 0.48, 0.44)), (0.64, 0.60, 0.53), N.smooth(-1, 1.2, a + 0.5 * b))
    col = N.mix(col, (0.42, 0.45, 0.27), 0.75 * weed)
    col = N.mix(col, (0.68, 0.52, 0.53), 0.55 * crust * (1 - weed))
    col = N.mix(col, (0.20, 0.19, 0.165), 0.7 * crack)
    e1, _, who = N.cells(n, 300, 67)
    size = np.random.default_rng(1).random(300)[who] ** 3
    shell = N.smooth(0.020, 0.006, e1 / (0.3 + size)) * (size > 0.25)
    col = N.mix(col, (0.80, 0.78, 0.71), 0.7 * shell)
    col *= (1 + 0.11 * f + 0.05 * b)[..., None]
    h = 0.012 * a + 0.008 * b + 0.0022 * f - 0.02 * crack + 0.004 * crust + 0.008 * shell
    return (
        np.clip(col, 0, 1),
        N.rough_metal(np.clip(0.86 + 0.05 * weed - 0.06 * crust, 0, 1)),
        N.normal_map(h * 0.55, 1.0),
    )


def material(g, n=512):
    c, mr, nm = texture(n)
    return g.material(
        "rock", base=g.texture("rock_color", c, 74), normal=g.texture("rock_normal", nm, 62), rough=0.88
    )


def main():
    g = Glb("rocks")
    m = material(g)
    for k in range(3):
        g.node(f"rock_{k}", g.mesh(f"rock_{k}", [(rock(k, 4), m)]), at=(2.2 * (k - 1), 0, 0))
    g.save(OUT / "rocks.glb")


if __name__ == "__main__":
    main()
