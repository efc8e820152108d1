"""All that the diver wears on head, hips, feet and limbs: mask, belt, fins, computer, knife."""
import numpy as np

import noise as N
from diver_body import ANKLE, ARM, FORE, SHOULDER, UPPER, rigid, torso
from mesh import Part, join, loft, shade
from shapes import box, circle, curve, cylinder, revolve, ring_band, round_rect, sphere, tube

# linear colours of the gear
BLACK, DARK = (0.03, 0.03, 0.032), (0.06, 0.062, 0.066)
SKIN, ORANGE = (0.47, 0.21, 0.135), (0.85, 0.22, 0.03)


def mask(look):
    """Mask, strap, snorkel and second stage, all on the head."""
    y, rub, glass, metal = 0.782, [], [], []
    rings = []
    for z, w, h, drop in (
        (-0.062, 0.150, 0.098, 0),
        (-0.095, 0.154, 0.098, 0),
        (-0.118, 0.164, 0.092, 0),
        (-0.130, 0.170, 0.094, 0),
        (-0.137, 0.166, 0.090, 0),
        (-0.137, 0.150, 0.074, 0),
        (-0.131, 0.147, 0.071, 0),
        (-0.112, 0.146, 0.070, 0),  # the skirt within, back to the face
        (-0.078, 0.140, 0.074, 0),
    ):
        o = round_rect(w, h, h * 0.36, 5)
        bend = 0.055 * (np.abs(o[:, 0]) / 0.085) ** 2
        rings.append(np.column_stack([o[:, 0], o[:, 1] + y, z + bend]))
    frame = loft(rings, (False, False))
    rub.append(frame.colored(look.mask))
    pane = []
    for s in (-1, 1):
        o = round_rect(0.066, 0.066, 0.022, 5)
        o[:, 0] += s * 0.038
        bend = 0.055 * (np.abs(o[:, 0]) / 0.085) ** 2
        ringp = np.column_stack([o[:, 0], o[:, 1] + y + 0.001, -0.1335 + bend])
        pane.append(loft([ringp + [0, 0, 0.006], ringp, ringp * [1, 1, 1]], (True, True)))
    glass += pane
    for s in (-1, 1):  # eyes behind the panes, with lids and brows
        at = (s * 0.032, 0.789)
        rub.append(sphere(0.0125, 16, 10).at(*at, -0.087).colored((0.80, 0.76, 0.72)))
        rub.append(sphere(0.0062, 14, 8).at(at[0] - s * 0.0008, at[1] - 0.0006, -0.0948).colored((0.05, 0.028, 0.015)))
        lid = sphere(0.0142, 16, 10).scaled(1.15, 0.62, 1.0)
        rub.append(lid.at(at[0], at[1] + 0.0082, -0.0868).colored(SKIN))
        rub.append(lid.scaled(1.0, 0.7, 1.0).at(at[0], at[1] - 0.0092, -0.0862).colored(SKIN))
        brow = box(0.026, 0.0048, 0.006, 0.002, 1).rot("z", -8 * s)
        rub.append(brow.at(at[0] + s * 0.002, at[1] + 0.0205, -0.0915).colored((0.06, 0.04, 0.03)))
    nose = loft(
        [
            np.column_stack([circle(14, r, r * 1.15) + [0, y - 0.032], np.full(14, z)])
            for r, z in ((0.026, -0.10), (0.025, -0.132), (0.020, -0.148), (0.010, -0.154))
        ]
    )
    rub.append(nose.colored(BLACK))
    bridge = box(0.012, 0.07, 0.012, 0.004, 1).at(0, y, -0.136)
    rub.append(bridge.colored(BLACK))
    t = np.linspace(0, 2 * np.pi, 41)
    pts = np.column_stack([np.sin(t) * 0.093, y + 0.012 * np.cos(t) * -1 + 0 * t, 0.006 - np.cos(t) * 0.114])
    strap = []
    for dy in (-0.011, 0.011):
        strap.append(pts[7:34] + [0, dy, 0])
    outer = loft([np.array([a, b, b * [0.97, 1, 0.97], a * [0.97, 1, 0.97]]) for a, b in zip(*strap)])
    rub.append(outer.colored(BLACK))
    second = []
    reg = revolve(
        [
            (0.010, -0.030),
            (0.024, -0.028),
            (0.0355, -0.018),
            (0.038, -0.004),
            (0.036, 0.012),
            (0.024, 0.024),
            (0.017, 0.028),
            (0.015, 0.06),
        ],
        22,
    )
    second.append(reg.rot("x", -8).at(0, 0.695, -0.149).colored(DARK))
    second.append(
        loft(
            [
                np.column_stack([round_rect(w, 0.026, 0.010, 3) + [0, 0.656], np.full(16, z)])
                for w, z in ((0.05, -0.135), (0.094, -0.142), (0.098, -0.160), (0.05, -0.172))
            ]
        ).colored(BLACK)
    )
    metal.append(cylinder(0.019, 0.006, 20).rot("x", -8).at(0, 0.699, -0.180))
    snork = curve(
        [
            [-0.055, 0.690, -0.145],
            [-0.088, 0.700, -0.125],
            [-0.106, 0.76, -0.06],
            [-0.118, 0.86, 0.0],
            [-0.112, 0.985, 0.045],
            [-0.104, 1.06, 0.062],
        ],
        30,
    )
    if look.snorkel:
        rub.append(tube(snork[:22], 0.0125, 10).colored(BLACK))
        rub.append(tube(snork[21:], 0.0140, 10).colored(ORANGE))
    bound = lambda ps, name: [rigid(shade(p.tiled(0.3)), name) for p in ps]
    return bound(rub, "head") + bound(second, "regulator"), bound(glass, "head"), bound(metal, "regulator")


def belt():
    """Weight belt with six leads and a buckle, over the hips."""
    t = np.arange(48) / 48 * 2 * np.pi
    y, parts = 0.075, []
    around = np.column_stack([np.sin(t), np.zeros(48), -np.cos(t)])
    rad = np.full(48, 0.25)
    for _ in range(30):
        rad = rad - torso(around * rad[:, None] + [0, y, 0])
    ringat = lambda off, dy: around * (rad + off)[:, None] + [0, y + dy, 0]
    parts.append(
        loft(
            [
                ringat(0.006, -0.026),
                ringat(0.013, -0.026),
                ringat(0.013, 0.026),
                ringat(0.006, 0.026),
                ringat(0.006, -0.026),
            ],
            (False, False),
        ).colored(BLACK)
    )
    for k in (7, 12, 17, 31, 36, 41):
        p = ringat(0.024, 0)[k]
        a = np.degrees(np.arctan2(around[k, 0], around[k, 2]))
        parts.append(box(0.075, 0.062, 0.030, 0.010, 1).rot("y", a).at(*p).colored((0.16, 0.16, 0.17)))
    buckle = box(0.065, 0.06, 0.014, 0.005, 1).at(*ringat(0.019, 0)[0]).colored((0.7, 0.7, 0.7))
    return [rigid(shade(p.tiled(0.3)), "pelvis") for p in parts + [buckle]]


def fins(look):
    """Right fin (about 0.62 m): foot pocket, ribbed blade with rails; then its mirror."""
    x0, parts = ANKLE[0] + 0.004, []
    rings = []
    for z, w, h, y in (
        (0.040, 0.060, 0.050, -0.900),
        (0.020, 0.092, 0.078, -0.897),
        (-0.05, 0.108, 0.100, -0.892),
        (-0.12, 0.116, 0.086, -0.900),
        (-0.175, 0.118, 0.054, -0.912),
        (-0.215, 0.112, 0.026, -0.920),
    ):
        o = round_rect(w, h, min(w, h) * 0.42, 4)
        rings.append(np.column_stack([o[:, 0] + x0, o[:, 1] + y, np.full(len(o), z)]))
    pocket = loft(rings).colored(BLACK)
    zs = np.linspace(-0.165, -0.575, 11)
    blade, rails = [], [[], []]
    for z in zs:
        k = (-0.165 - z) / 0.41
        half = 0.054 + 0.050 * N.smooth(0, 0.75, k)
        y = -0.912 - 0.055 * k - 0.05 * k * k
        xs = np.linspace(-1, 1, 9)
        thick = 0.0085 - 0.0055 * k
        notch = -0.035 * (1 - np.abs(xs)) * N.smooth(0.55, 1, k) * -1
        rib = 0.0035 * np.abs(np.sin(xs * np.pi * 2)) * (1 - 0.6 * k)
        top = np.column_stack([x0 + xs * half, y + thick / 2 + rib, z + notch])
        bot = np.column_stack([x0 + xs * half, y - thick / 2 - rib, z + notch])
        blade.append(np.concatenate([top, bot[::-1]]))
        for s, r in ((-1, rails[0]), (1, rails[1])):
            r.append([x0 + s * half, y, z])
    skin_blade = loft(blade)
    tipward = N.smooth(-0.25, -0.30, skin_blade.pos[:, 2])
    skin_blade.col = np.column_stack(
        [N.mix(np.tile(BLACK, (len(tipward), 1)), look.fins, tipward), np.ones(len(tipward))]
    )
    parts += [pocket, skin_blade] + [
        tube(r, np.linspace(0.0125, 0.0055, len(r)), 8, flat=0.8).colored(BLACK) for r in rails
    ]
    strap = curve(
        [
            [x0 + 0.052, -0.882, -0.03],
            [x0 + 0.050, -0.872, 0.03],
            [x0, -0.868, 0.068],
            [x0 - 0.050, -0.872, 0.03],
            [x0 - 0.052, -0.882, -0.03],
        ],
        20,
    )
    parts.append(tube(strap, 0.011, 6, flat=0.5).colored(DARK))
    out = []
    for p, name in zip(parts, ("fin", "blade", "blade", "blade", "fin")):
        p = shade(p.tiled(0.3), 45)
        out += [rigid(p, f"{name}_r"), rigid(p.mirrored(), f"{name}_l")]
    return out


# The dive computer's place on the right arm; on_left_wrist mirrors it.
COMPUTER_AT = SHOULDER + ARM * (UPPER + FORE - 0.07) + 0.042 * np.array([1, 1, 0]) / np.sqrt(2)
DISPLAY = (0.0528, 0.044)  # along the arm and across, as hud/display.hpp has it


def on_left_wrist(part):
    """x towards the fingers, y off the arm's back, z backwards while the arm hangs."""
    return rigid(part.rot("z", -45).at(*COMPUTER_AT).mirrored(), "forearm_l")


def display():
    """The computer's display, a flat sheet: its picture's right is towards the fingers, its top where +z is."""
    w, h = DISPLAY
    corner = np.array([[-1, 1], [1, 1], [1, -1], [-1, -1]]) / 2
    sheet = Part(
        np.column_stack([w * corner[:, 0], np.full(4, 0.0137), h * corner[:, 1]]),
        [[0, 1, 2], [0, 2, 3]],
        np.column_stack([0.5 + corner[:, 0], 0.5 - corner[:, 1]]),
        np.tile([0.0, 1, 0], (4, 1)),
    )
    return on_left_wrist(sheet)


def extras(look):
    """Dive computer without its display, knife on the right shin."""
    wrist = join(
        [
            box(0.066, 0.022, 0.058, 0.009, 1).colored(DARK),
            box(DISPLAY[0] + 0.004, 0.004, DISPLAY[1] + 0.004, 0.0015, 1).at(0, 0.0115, 0).colored(BLACK),
            ring_band(0.039, 0.044, 0.024, 24).rot("x", 90).rot("z", 90).at(0, -0.042, 0).colored(BLACK),
        ]
    )
    knife = join(
        [
            box(0.030, 0.20, 0.018, 0.007, 1).colored(BLACK),
            box(0.024, 0.10, 0.022, 0.008, 1).at(0, 0.14, 0).colored(look.accent),
            cylinder(0.014, 0.02, 12).rot("x", 90).at(0, 0.19, 0).colored(BLACK),
        ]
    ).rot("y", 0)
    straps = join(
        [ring_band(0.062, 0.066, 0.022, 26).rot("x", 90).at(0, dy, 0).colored(BLACK) for dy in (-0.04, 0.04)]
    )
    knife = knife.rot("y", 90).at(0.166, -0.60, 0.012)
    straps = straps.at(0.100, -0.585, 0.012)
    return [on_left_wrist(shade(wrist.tiled(0.3)))] + [
        rigid(shade(p.tiled(0.3)), "lower_leg_r") for p in (knife, straps)
    ]
