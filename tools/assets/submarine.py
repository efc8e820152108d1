"""A sunken diesel submarine, 48 m: hull, casing, sail, gun, screws, a torn side.

Origin on the keel amidships, bow along -z, y up, metres. Hull lines are a free
design after the diesel boats of the 1940s.
"""
from pathlib import Path

import numpy as np

import noise as N
import wreck_textures as T
from glb import Glb
from mesh import join, loft, shade
from submarine_hull import build_hull, deck_half_width, deck_height, inner_works
from shapes import box, curve, cylinder, foil, revolve, round_rect, sphere, torus, tube

OUT = Path(__file__).resolve().parents[2] / "assets" / "models"


def tint(part, seed, base=(1, 1, 1), silt=0.5):
    """Large-scale colour: rust and growth in patches, pale silt on what faces up."""
    part = part if part.nrm is not None else shade(part, 35)
    n1, n2 = N.fbm3(part.pos, seed, 0.35), N.fbm3(part.pos, seed + 7, 0.9, 3)
    c = np.tile(np.asarray(base, float), (len(part.pos), 1))
    c = N.mix(c, np.array([0.80, 0.68, 0.56]) * base, N.smooth(0.0, 0.8, n1))
    c = N.mix(c, np.array([0.72, 0.78, 0.62]) * base, N.smooth(0.1, 0.8, n2))
    up = N.smooth(0.55, 0.95, part.nrm[:, 1] + 0.25 * n2) * silt
    c = N.mix(c, np.array([1.0, 0.97, 0.88]), up)
    c *= (1 - 0.22 * N.smooth(0, 1.2, -n1))[:, None]
    part.col = np.column_stack([np.clip(c, 0, 1), np.ones(len(c))])
    return part


def plan(z0, z1, w, n=44, power=2.4, aft=0.72):
    """A sail's plan outline: blunt bow, finer stern, points (x, z)."""
    t = np.arange(n) / n * 2 * np.pi
    c, s = np.cos(t), np.sin(t)
    x = np.sign(s) * np.abs(s) ** (2 / power) * w
    z = np.sign(c) * np.abs(c) ** (2 / power)
    x = x * np.where(z > 0, 1 - (1 - aft) * np.abs(z) ** 1.5, 1)
    return np.stack([x, (z0 + z1) / 2 + z * (z1 - z0) / 2], 1)


def ring(outline, y):
    return np.column_stack([outline[:, 0], np.full(len(outline), y), outline[:, 1]])


def sail():
    """Conning tower with spray lip, open bridge, after platform and railings."""
    steps = [
        (4.55, 0, 0),
        (5.6, -0.02, 0),
        (6.30, -0.03, 0),
        (6.38, 0.05, 0),
        (6.46, -0.03, 0),
        (7.1, -0.05, 0),
        (7.55, -0.02, 0),
        (7.66, 0.08, 0),
        (7.70, 0.08, 0),
        (7.70, 0.0, 0),
        (7.5, -0.10, 0),
        (6.75, -0.12, 0),
    ]
    shell = loft([ring(plan(-4.3 - d, 1.9 + d, 1.02 + d), y) for y, d, _ in steps], (False, True))
    hull_uv = np.stack([shell.pos[:, 2] / 8.0, 0.13 + (7.7 - shell.pos[:, 1]) / 8.0], 1)
    shell.uv = hull_uv
    plat_line = round_rect(2.5, 3.2, 1.1, 6)
    plat = loft(
        [np.column_stack([plat_line[:, 0], np.full(len(plat_line), y), plat_line[:, 1] + 2.6]) for y in (6.62, 6.74)]
    )
    bits = [plat, cylinder(0.28, 2.1, 16).rot("x", 90).at(0, 5.7, 3.3)]
    bits += [box(0.06, 0.9, 0.9, 0.02).rot("x", 40).at(x, 6.3, 2.6) for x in (-0.6, 0.6)]
    edge = np.column_stack([plat_line[:, 0] * 0.96, plat_line[:, 1] * 0.96 + 2.6])
    edge = edge[edge[:, 1] > 1.5]
    order = np.argsort(np.arctan2(edge[:, 0], edge[:, 1] - 2.0))
    edge = edge[order]
    bend = lambda p: p + np.column_stack(
        [
            0.5 * N.smooth(0.2, 1.3, p[:, 0]) * (p[:, 1] - 6.7) * 0.9,
            -0.35 * N.smooth(0.2, 1.3, p[:, 0]) * (p[:, 1] - 6.7),
            0 * p[:, 0],
        ]
    )
    for y in (7.05, 7.4, 7.75):
        path = curve(np.column_stack([edge[:, 0], np.full(len(edge), y), edge[:, 1]]), 40)
        bits.append(tube(bend(path), 0.028, 6))
    for p in edge[::3]:
        q = np.array([[p[0], y, p[1]] for y in np.linspace(6.7, 7.75, 4)])
        bits.append(tube(bend(q), 0.030, 6))
    # anti-aircraft mount
    bits += [
        cylinder(0.16, 0.9, 12).rot("x", 90).at(0, 7.15, 3.0),
        box(0.34, 0.3, 0.5, 0.05).at(0, 7.7, 3.0),
        tube([[0.06, 7.75, 2.9], [0.06, 8.25, 1.2]], 0.04, 8),
        tube([[-0.06, 7.75, 2.9], [-0.06, 8.25, 1.2]], 0.04, 8),
    ]
    # bridge: fairing of the periscopes, the scopes (one bent), loop, compass, hatch
    bits += [box(0.5, 1.2, 1.9, 0.2).at(0, 7.2, -1.2)]
    bits += [
        tube(curve([[0, 7.6, -1.8], [0, 9.0, -1.8], [0, 10.6, -1.8]], 8), np.linspace(0.14, 0.09, 8), 14),
        cylinder(0.075, 0.5, 12).rot("x", 90).at(0, 10.8, -1.8),
        sphere(0.085, 12, 8).at(0, 11.02, -1.8),
    ]
    bits += [
        tube(
            curve([[0, 7.6, -0.6], [0, 8.8, -0.6], [0.10, 9.6, -0.5], [0.65, 10.2, -0.15], [1.15, 10.4, 0.1]], 18),
            np.linspace(0.15, 0.09, 18),
            14,
        )
    ]
    bits += [
        torus(0.34, 0.035, 24, 8).at(0.55, 8.15, -2.6),
        tube([[0.55, 7.2, -2.6], [0.55, 7.82, -2.6]], 0.04, 8),
        cylinder(0.14, 1.0, 12).rot("x", 90).at(-0.35, 7.2, -3.2),
        cylinder(0.35, 0.14, 20).rot("x", 90).at(0.2, 6.85, 0.4),
    ]
    # ladder on the port side
    for y in np.arange(4.9, 7.6, 0.3):
        bits.append(tube([[-1.12, y, 0.3], [-1.12, y, 0.75]], 0.018, 5))
    for z in (0.3, 0.75):
        bits.append(tube([[-1.12, 4.8, z], [-1.12, 7.6, z]], 0.022, 6))
    return shell, join(bits)


def gun():
    """Deck gun, trained off the bow as it was left."""
    parts = [
        revolve(
            [(0.62, 0), (0.55, 0.12), (0.34, 0.25), (0.30, 0.85), (0.42, 0.95), (0.42, 1.05)], 20, (True, True)
        ).rot("x", -90),
        box(0.5, 0.5, 0.8, 0.08).at(0, 1.3, 0),
        box(0.1, 0.7, 0.6, 0.03).at(0.33, 1.35, 0),
        box(0.1, 0.7, 0.6, 0.03).at(-0.33, 1.35, 0),
    ]
    barrel = (
        revolve(
            [
                (0.0, -3.55),
                (0.055, -3.55),
                (0.088, -3.5),
                (0.085, -3.3),
                (0.075, -3.25),
                (0.105, -1.6),
                (0.135, -1.55),
                (0.15, -0.2),
                (0.17, -0.15),
                (0.17, 0.45),
                (0.12, 0.5),
            ],
            16,
            (True, True),
        )
        .rot("x", 7)
        .at(0, 1.5, 0)
    )
    recoil = cylinder(0.07, 1.5, 10).rot("x", 7).at(0, 1.33, -0.7)
    shields = [
        torus(0.18, 0.02, 16, 6).rot("y", 90).at(0.48, 1.3, 0.15),
        torus(0.18, 0.02, 16, 6).rot("y", 90).at(-0.48, 1.3, 0.2),
        tube(curve([[0.3, 1.3, 0.4], [0.5, 1.5, 0.8], [0.45, 1.75, 1.0]], 8), 0.025, 6),
        tube(curve([[-0.3, 1.3, 0.4], [-0.5, 1.5, 0.8], [-0.45, 1.75, 1.0]], 8), 0.025, 6),
    ]
    return join(parts + [barrel, recoil] + shields).rot("y", -14).at(0, deck_height(-7.2) + 0.02, -7.2)


def propeller(x, side, blades):
    bits = [revolve([(0.02, 0.42), (0.10, 0.36), (0.17, 0.15), (0.19, -0.12), (0.16, -0.25)], 18)]
    for k in blades:
        sec = []
        for r, chord, pitch in (
            (0.14, 0.30, 62),
            (0.32, 0.52, 48),
            (0.52, 0.62, 36),
            (0.68, 0.46, 30),
            (0.77, 0.16, 27),
        ):
            a = np.radians(pitch) * side
            d = np.array([np.cos(a), 0, np.sin(a)]) * chord / 2
            sec.append((np.array([0, r, 0]) - d, np.array([0, r, 0]) + d, 0.11 * (1 - r), [-np.sin(a), 0, np.cos(a)]))
        bits.append(foil(sec, 8).rot("z", k * 120 + 20))
    return join(bits).at(x, 1.35, 20.35)


def stern_gear():
    bits = [propeller(1.15, 1, (0, 1, 2)), propeller(-1.15, -1, (0, 2))]
    for s in (1, -1):
        bits.append(tube([[s * 0.85, 1.6, 14.0], [s * 1.15, 1.35, 20.2]], 0.13, 12))
        for top in ((s * 0.35, 2.3, 19.4), (s * 0.25, 1.25, 19.5)):
            bits.append(
                foil(
                    [
                        (np.array(top) + [0, 0, -0.25], np.array(top) + [0, 0, 0.25], 0.10, [0, 1, 0]),
                        ([s * 1.15, 1.37, 19.45], [s * 1.15, 1.37, 19.85], 0.10, [0, 1, 0]),
                    ],
                    6,
                )
            )
        # rudder behind each screw, stern plane below
        rx = s * 1.05
        bits.append(
            foil(
                [
                    ([rx, 0.35, 21.35], [rx + 0.12, 0.35, 22.3], 0.10, [1, 0, 0]),
                    ([rx, 1.4, 21.25], [rx + 0.14, 1.4, 22.55], 0.14, [1, 0, 0]),
                    ([rx, 2.45, 21.4], [rx + 0.12, 2.45, 22.3], 0.10, [1, 0, 0]),
                ],
                8,
            )
        )
        bits.append(tube([[rx, 2.4, 21.5], [s * 0.25, 3.0, 21.5]], 0.09, 8))
        bits.append(
            foil(
                [
                    ([s * 0.1, 1.05, 20.95], [s * 0.1, 0.95, 22.6], 0.16, [0, 1, 0]),
                    ([s * 1.9, 1.05, 21.1], [s * 1.9, 0.9, 22.3], 0.12, [0, 1, 0]),
                    ([s * 2.05, 1.05, 21.4], [s * 2.05, 0.95, 22.0], 0.05, [0, 1, 0]),
                ],
                8,
            )
        )
        # bow planes
        bits.append(
            foil(
                [
                    ([s * 0.55, 2.05, -20.9], [s * 0.7, 1.85, -19.2], 0.20, [0, 1, 0]),
                    ([s * 1.75, 2.1, -20.75], [s * 1.8, 1.8, -19.4], 0.16, [0, 1, 0]),
                    ([s * 2.25, 2.05, -20.35], [s * 2.2, 1.9, -19.65], 0.06, [0, 1, 0]),
                ],
                8,
            )
        )
        bits.append(
            tube(curve([[s * 0.08, 2.05, -21.75], [s * 0.9, 2.05, -21.5], [s * 1.7, 2.1, -20.9]], 10), 0.05, 6)
        )
    bits.append(
        foil(
            [
                ([0, 0.3, 19.0], [0, 0.9, 21.2], 0.2, [1, 0, 0]),
                ([0, 1.5, 18.5], [0, 1.6, 21.6], 0.3, [1, 0, 0]),
                ([0, 2.6, 18.0], [0, 2.6, 21.8], 0.3, [1, 0, 0]),
            ],
            8,
        )
    )
    return join(bits)


def deck_gear():
    """Hatches, bollards, capstan, stanchions with their wires, jumping wires."""
    rng = np.random.default_rng(3)
    bits = []
    for z, r in ((-15.2, 0.42), (9.5, 0.42), (14.0, 0.36)):
        y = deck_height(z)
        bits += [
            cylinder(r, 0.22, 22).rot("x", 90).at(0, y + 0.08, z),
            torus(r * 0.8, 0.03, 20, 6).rot("x", 90).at(0, y + 0.2, z),
        ]
    bits += [
        revolve([(0.28, 0), (0.2, 0.08), (0.16, 0.3), (0.24, 0.42), (0.05, 0.46)], 18)
        .rot("x", -90)
        .at(0, deck_height(-18.4), -18.4)
    ]
    for z in (-17, -12.5, 6.5, 12, 17):
        for s in (1, -1):
            x = s * (deck_half_width(z) - 0.25)
            if abs(x) < 0.2:
                continue
            for dz in (-0.17, 0.17):
                bits.append(
                    revolve([(0.09, 0), (0.075, 0.05), (0.075, 0.25), (0.10, 0.30), (0.09, 0.34)], 10)
                    .rot("x", -90)
                    .at(x, deck_height(z), z + dz)
                )
    for s in (1, -1):
        tops = []
        for k, z in enumerate(np.arange(4.8, 17.5, 1.4)):
            lean = rng.normal(0, 0.10, 2) if s > 0 or k < 5 else rng.normal(0, 0.45, 2)
            b = np.array([s * (deck_half_width(z) - 0.06), deck_height(z), z])
            t = b + np.array([lean[0], 0.85 * np.sqrt(max(0.2, 1 - (lean**2).sum())), lean[1]])
            tops.append(t)
            bits.append(tube([b, t], 0.024, 6))
        for f in (0.55, 1.0):
            pts = []
            for a, c in zip(tops[:-1], tops[1:]):
                base = lambda q: np.array([q[0], deck_height(q[2]), q[2]])
                p, q = base(a) + (a - base(a)) * f, base(c) + (c - base(c)) * f
                pts += [p, (p + q) / 2 - [0, 0.07, 0]]
            pts = pts[:-1] if s > 0 else pts[:11]
            bits.append(tube(curve(pts, len(pts) * 2), 0.013, 5))
    fore = [[0, deck_height(-22.6) + 0.1, -22.6], [0, 6.2, -13.5], [0, 7.75, -4.2]]
    bits.append(tube(curve(fore, 20), 0.022, 5))
    fallen = [
        [0.75, 7.7, 1.2],
        [1.2, 6.6, 3.2],
        [1.35, deck_height(5) - 0.3, 4.6],
        [0.9, deck_height(6) + 0.03, 6.0],
        [-0.2, deck_height(8) + 0.03, 8.0],
        [0.35, deck_height(10.5) + 0.03, 10.5],
        [0, deck_height(13) + 0.03, 13.2],
    ]
    bits.append(tube(curve(fallen, 40), 0.022, 5))
    # saw-toothed net cutter on the stem
    bits.append(
        tube(
            curve([[0, deck_height(-24) - 0.1, -24.4], [0, 6.02, -23.6], [0, deck_height(-22) - 0.05, -22.2]], 12),
            0.05,
            6,
        )
    )
    for z in (-23.95, -23.65, -23.35, -23.05):
        bits.append(
            foil(
                [
                    ([0, 5.75, z - 0.12], [0, 5.75, z + 0.12], 0.03, [1, 0, 0]),
                    ([0, 6.1, z - 0.05], [0, 6.1, z - 0.03], 0.01, [1, 0, 0]),
                ],
                5,
            )
        )
    return join(bits)


def main():
    g = Glb("submarine")

    def mat(name, images, **k):
        c, mr, n = images
        return g.material(
            name,
            base=g.texture(name + "_color", c, 76),
            mr=g.texture(name + "_mr", mr, 72),
            normal=g.texture(name + "_normal", n, 70),
            metal=1.0,
            rough=1.0,
            **k
        )

    m_hull, m_deck, m_steel = mat("hull", T.hull()), mat("deck", T.deck()), mat("steel", T.steel())
    hull, deck, rims = build_hull()
    shell, tower = sail()
    wood = lambda p: tint(p, 5, (0.92, 0.92, 0.92), 0.25)
    outer = g.mesh(
        "hull", [(tint(hull, 1), m_hull), (wood(deck), m_deck), (tint(rims.tiled(2), 4, (0.9, 0.75, 0.6)), m_steel)]
    )
    g.node("hull", outer)
    g.node("sail", g.mesh("sail", [(tint(shade(shell, 50), 2), m_hull), (tint(tower.tiled(2), 3), m_steel)]))
    g.node("gun", g.mesh("gun", [(tint(gun().tiled(2), 6), m_steel)]))
    g.node("stern_gear", g.mesh("stern_gear", [(tint(stern_gear().tiled(2), 8), m_steel)]))
    g.node("deck_gear", g.mesh("deck_gear", [(tint(deck_gear().tiled(2), 9), m_steel)]))
    g.node("interior", g.mesh("interior", [(tint(inner_works().tiled(2), 10, (0.55, 0.5, 0.46), 0.3), m_steel)]))
    g.save(OUT / "submarine.glb")


if __name__ == "__main__":
    main()
