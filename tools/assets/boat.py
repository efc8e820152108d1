"""A rigid inflatable dive boat of 6.4 m: a moulded V hull between two tubes, an outboard motor, a ladder.

Bow at z = -3.2, transom at z = +2.5, keel along z; the still waterline is y = 0, 0.35 m over the keel amidships.
Proportions are a free design after open boats of dive clubs.
"""
from pathlib import Path

import numpy as np

import noise as N
from glb import Glb
from mesh import join, loft, shade
from shapes import box, curve, cylinder, foil, round_rect, tube

OUT = Path(__file__).resolve().parents[2] / "assets" / "models"
BOW, STERN = -3.05, 2.5
DEADRISE_DEG = 22.0
TUBE_M = 0.24  # radius


def keel(t):
    """y of the keel, t from 0 at the transom to 1 at the bow."""
    return -0.36 + 0.78 * np.clip((t - 0.52) / 0.48, 0, 1) ** 2.4


def half_beam(t):
    """Half the width over the chines."""
    return 0.80 * (1 - np.clip((t - 0.45) / 0.55, 0, 1) ** 2.3) + 0.012


def section(t):
    """The hull's skin from the port deck edge under the keel to starboard, (x, y), with two spray rails a side."""
    w, low = half_beam(t), keel(t)
    rise = np.tan(np.radians(DEADRISE_DEG + 22 * t**2))
    chine = min(low + w * rise, 0.36)
    s = np.array([0.0, 0.33, 0.36, 0.365, 0.68, 0.71, 0.715, 1.0])
    rail = np.array([0.0, 0.0, -0.022, 0.0, 0.0, -0.022, 0.0, 0.0]) * (1 - t**4)
    x, y = w * s, low + (chine - low) * s + rail
    x, y = np.append(x, [w + 0.035, w + 0.02]), np.append(y, [chine + 0.01, max(chine + 0.05, 0.42)])
    return np.column_stack([np.concatenate([-x[:0:-1], x]), np.concatenate([y[:0:-1], y])])


def hull():
    rings = []
    for t in np.concatenate([np.linspace(0, 0.5, 14), np.linspace(0.53, 1, 24)]):
        xy = section(t)
        rings.append(np.column_stack([xy, np.full(len(xy), STERN + (BOW - STERN) * t)]))
    part = shade(loft(rings), 28)
    # Antifouling paint up to a hand's breadth over the water, with slime and scratches.
    noise = N.fbm3(part.pos, 5, 2.2, 4)
    paint = np.array([0.30, 0.055, 0.045]) * (1 + 0.35 * noise[:, None]) + np.array([0.02, 0.05, 0.015]) * np.clip(
        N.fbm3(part.pos, 6, 0.9, 3), 0, 1
    )[:, None]
    gel = np.array([0.72, 0.72, 0.69]) * (1 + 0.06 * noise[:, None])
    part.col = colour(np.where((part.pos[:, 1] > 0.07)[:, None], gel, paint))
    return part


def colour(rgb):
    return np.column_stack([np.clip(rgb, 0, 1), np.ones(len(rgb))])


def plain(part, rgb, crease=40.0):
    part = shade(part, crease)
    part.col = colour(np.asarray(rgb) * (1 + 0.10 * N.fbm3(part.pos, 8, 3.0, 3)[:, None]))
    return part


def tubes():
    """Both sponsons in one run round the bow, with cones behind the transom and lifelines."""
    side = [(0.93, 0.34, 2.95), (0.94, 0.34, 2.2), (0.95, 0.35, 0.6), (0.93, 0.38, -0.9), (0.72, 0.48, -2.25), (0.36, 0.57, -2.95)]
    path = np.array(side + [(0.0, 0.60, -3.16)] + [(-x, y, z) for x, y, z in side[::-1]])
    line = curve(path, 64)
    reach = np.minimum(np.arange(64), np.arange(64)[::-1])
    radius = TUBE_M * np.interp(reach, [0, 2, 4, 8], [0.25, 0.72, 0.95, 1.0])
    skin = plain(tube(line, radius, 20), (0.10, 0.11, 0.12), 60)
    band = np.clip(1 - np.abs(skin.pos[:, 2] % 1.6 - 0.8) / 0.06, 0, 1)[:, None]  # glued seams
    skin.col[:, :3] *= 1 - 0.35 * band
    rope = []
    for sign in (1, -1):
        eyes = [(sign * (0.955 + TUBE_M * 0.985), 0.36, z) for z in np.linspace(2.0, -1.0, 7)]
        points = []
        for a, b in zip(eyes[:-1], eyes[1:]):
            points += [a, tuple(0.5 * (np.array(a) + b) + [0, -0.10, 0])]
        rope.append(plain(tube(curve(points + [eyes[-1]], 49), 0.008, 6), (0.75, 0.72, 0.62)))
    return join([skin] + rope)


def cowl():
    """Rounded, longest at its middle, its top sloping down aft, with a light band around it."""
    levels = (  # height, width, length, middle along z
        (0.515, 0.28, 0.44, 2.85), (0.53, 0.31, 0.48, 2.85), (0.56, 0.35, 0.54, 2.86), (0.625, 0.385, 0.60, 2.87), (0.63, 0.39, 0.60, 2.87),
        (0.675, 0.395, 0.61, 2.87), (0.68, 0.39, 0.61, 2.87), (0.80, 0.385, 0.61, 2.87), (0.91, 0.36, 0.56, 2.855), (0.98, 0.32, 0.48, 2.835),
        (1.015, 0.27, 0.40, 2.82), (1.025, 0.20, 0.31, 2.81),
    )
    rings = []
    for y, width, length, middle in levels:
        xz = round_rect(width, length, 0.42 * width, 5)
        slope = np.clip((y - 0.70) / 0.30, 0, 1) * 0.16 * (xz[:, 1] + 0.25)
        rings.append(np.column_stack([xz[:, 0], y - slope, xz[:, 1] + middle]))
    part = shade(loft(rings), 40)
    band = (part.pos[:, 1] > 0.627) & (part.pos[:, 1] < 0.678)
    part.col = colour(np.where(band[:, None], (0.60, 0.61, 0.62), (0.035, 0.037, 0.042)))
    return part


def motor():
    """An outboard motor of some 90 kW: cowl, leg, gear case, skeg, propeller of three blades."""
    leg = foil(
        [
            ((0, 0.45, 2.66), (0, 0.45, 3.02), 0.42, (1, 0, 0)),
            ((0, -0.25, 2.72), (0, -0.25, 3.00), 0.34, (1, 0, 0)),
            ((0, -0.46, 2.74), (0, -0.46, 3.00), 0.34, (1, 0, 0)),
        ]
    )
    plate = box(0.24, 0.018, 0.46).at(0, -0.30, 2.90)
    case = tube([(0, -0.52, z) for z in np.linspace(2.60, 3.12, 12)], 0.075 * np.sqrt(np.clip(1 - np.linspace(-1, 0.55, 12) ** 4, 0.02, 1)), 16)
    skeg = foil([((0, -0.55, 2.72), (0, -0.56, 3.00), 0.10, (1, 0, 0)), ((0, -0.78, 2.88), (0, -0.78, 3.00), 0.10, (1, 0, 0))])
    parts = [cowl()] + [plain(p, (0.035, 0.037, 0.042)) for p in (leg, plate, case, skeg, box(0.30, 0.34, 0.16).at(0, 0.42, 2.58))]
    hub = tube([(0, -0.52, z) for z in (3.10, 3.16, 3.24, 3.27)], [0.062, 0.060, 0.048, 0.01], 14)
    blades = []
    for k in range(3):
        a = np.radians(120 * k)
        out, side = np.array([np.sin(a), np.cos(a), 0]), np.array([np.cos(a), -np.sin(a), 0])
        at = lambda r, w, twist: [np.array([0, -0.52, 3.18]) + r * out + s * w * (np.cos(twist) * side + [0, 0, np.sin(twist)]) for s in (-1, 1)]
        normal = lambda twist: -np.sin(twist) * side + [0, 0, np.cos(twist)]
        blades.append(
            foil([(*at(r, w, tw), 0.10, normal(tw)) for r, w, tw in ((0.05, 0.05, 0.95), (0.11, 0.085, 0.65), (0.16, 0.075, 0.48), (0.185, 0.02, 0.42))])
        )
    steel = [plain(p, (0.30, 0.30, 0.29)) for p in [hub] + blades]
    return join(parts), join(steel)


def ladder():
    """Hung over the starboard side of the transom, five rungs down into the water."""
    rails = [tube(curve([(x, 0.62, 2.35), (x, 0.66, 2.55), (x, 0.45, 2.68), (x, -1.05, 2.86)], 20), 0.016, 8) for x in (0.42, 0.78)]
    rungs = [tube([(0.42, y, z), (0.78, y, z)], 0.014, 8) for y, z in zip(np.linspace(-1.0, 0.2, 5), np.linspace(2.853, 2.712, 5))]
    return join([plain(p, (0.55, 0.56, 0.56)) for p in rails + rungs])


def deck():
    floor = box(1.40, 0.03, 4.3).at(0, 0.26, 0.3)
    console = box(0.62, 0.62, 0.5, 0.05).at(0, 0.58, 0.2)
    rack = [cylinder(0.09, 0.62, 18, 0.04).rot("x", 90).at(x, 0.58, z) for x in (-0.45, 0.45) for z in (1.0, 1.3, 1.6)]
    return join([plain(floor, (0.42, 0.42, 0.40)), plain(console, (0.62, 0.62, 0.60))] + [plain(c, (0.75, 0.62, 0.08)) for c in rack])


def main():
    g = Glb("boat")
    gel = g.material("gelcoat", rough=0.45)
    rubber = g.material("rubber", rough=0.8)
    steel = g.material("steel", metal=0.9, rough=0.35)
    black, propeller = motor()
    g.node("boat", g.mesh("boat", [(join([hull(), deck()]), gel), (join([tubes(), black]), rubber), (join([propeller, ladder()]), steel)]))
    g.save(OUT / "boat.glb")


if __name__ == "__main__":
    main()
