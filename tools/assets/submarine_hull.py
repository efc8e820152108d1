"""Hull lines of the wreck: sections, skin, the tear and what shows through it."""
import numpy as np

import noise as N
from clip import clip, rim
from mesh import join, loft, Part, shade
from shapes import box, cylinder, revolve, tube

HOLE = dict(z=-11.2, y=2.55, rz=2.1, ry=1.15)  # on the starboard side (+x)
SKIN = 0.10  # shown plate thickness, m
ROOM = (-15.0, -7.4)  # compartment behind the tear


def lerp(z, table):
    return np.interp(z, *zip(*table))


def deck_height(z):
    return lerp(z, [(-24, 5.55), (-20, 5.30), (-12, 5.0), (0, 4.9), (12, 4.8), (20, 4.45), (24, 4.15)])


def deck_half_width(z):
    return lerp(
        z,
        [
            (-24, 0.10),
            (-22.5, 0.34),
            (-19, 0.72),
            (-14, 1.12),
            (-6, 1.3),
            (0, 1.35),
            (8, 1.3),
            (14, 1.02),
            (19, 0.6),
            (22.5, 0.28),
            (24, 0.08),
        ],
    )


def section(z, t):
    """Half section at station z: t 0..0.1 casing side, 0.1..1 hull to the keel -> x, y."""
    t = np.asarray(t, float)
    f, a = np.clip((-z - 4) / 20, 0, 1), np.clip((z - 3) / 21, 0, 1)
    width = 2.05 * (1 - f**2.3) ** 0.85 * (1 - a**2.2) ** 1.0 + 0.07
    y_wide = 2.35 + 0.9 * f**2 + 0.6 * a**2
    keel = 1.7 * f**5 + 2.3 * a**3.2
    top = deck_height(z) - 0.35
    d = deck_half_width(z)
    join_x = min(d + 0.10, width * 0.93)
    join_a = np.arccos(np.clip(join_x / width, 0, 0.999))
    ang = join_a - (t - 0.1) / 0.9 * (join_a + np.pi / 2)
    c, s = np.cos(ang), np.sin(ang)
    x = width * np.sign(c) * np.abs(c) ** 0.92
    y = np.where(s > 0, y_wide + (top - y_wide) * s, y_wide + (y_wide - keel) * s)
    bulge = 0.42 * max(0.0, 1 - (z / 13.5) ** 2) ** 0.7 if abs(z) < 13.5 else 0.0
    x = x + bulge * np.exp(-(((y - 2.5) / 1.0) ** 2)) * (x > 0.02)
    jx, jy = width * np.cos(join_a) ** 0.92, y_wide + (top - y_wide) * np.sin(join_a)
    side = t < 0.1
    w = t / 0.1
    x = np.where(side, d + (jx - d) * w**1.5, x)
    y = np.where(side, deck_height(z) + (jy - deck_height(z)) * w, y)
    return np.maximum(x, 0), y


def rake(x, y, z):
    """Leans the stem forward at the top and the stern aft."""
    bow, stern = N.smooth(-19, -24, z), N.smooth(18, 24, z)
    return z - bow * (y - 4.6) * 0.55 + stern * (y - 3.5) * 0.25


def dent(p):
    """A crushed patch on the port bow and a slight sag aft of the tear."""
    d = np.exp(-(((p[:, 2] + 17.5) / 1.3) ** 2) - ((p[:, 1] - 3.2) / 0.9) ** 2) * (p[:, 0] < -0.1)
    ripple = 1 + 0.35 * np.sin(p[:, 2] * 5 + p[:, 1] * 3)
    q = p.copy()
    q[:, 0] += 0.38 * d * ripple
    return q


def strip(zs, ts, inset=0.0):
    """Starboard half skin; u = z / 8, v = t."""
    rows = []
    for z in zs:
        x, y = section(z, ts)
        rows.append(np.column_stack([x, y, rake(x, y, np.full(len(ts), z))]))
    r = np.array(rows)
    p = loft(r, (False, False), wrap=False, orient=False)
    tt = np.tile(ts, len(zs))
    p.uv = np.stack([np.repeat(zs, len(ts)) / 8.0, tt], 1)
    a = p.pos[p.tri]
    if (np.cross(a[:, 1] - a[:, 0], a[:, 2] - a[:, 0])[:, 0]).sum() < 0:
        p = p.flipped()
    return p


def tear(p):
    """Signed field of the tear: below 0 inside."""
    dz, dy = (p[:, 2] - HOLE["z"]) / HOLE["rz"], (p[:, 1] - HOLE["y"]) / HOLE["ry"]
    r = np.hypot(dz, dy)
    a = np.arctan2(dy, dz)
    q = np.column_stack([np.cos(a) * 2.2, np.sin(a) * 2.2, np.zeros(len(a))])
    jag = 0.24 * N.fbm3(q, 77, 1.3, 2) + 0.16 * np.abs(N.value3(p, 78, 2.6)) + 0.10 * N.value3(p, 79, 5.0)
    return np.where(p[:, 0] > 0.3, r - 1 - jag, 5.0)


def stations():
    coarse = np.concatenate([np.linspace(-24, -14.2, 26), np.linspace(-14.2, -8.2, 61), np.linspace(-8.2, 24, 62)])
    return np.unique(np.round(coarse, 4))


def girth():
    return np.concatenate(
        [[0, 0.05, 0.1], np.linspace(0.1, 0.2, 4)[1:], np.linspace(0.2, 0.72, 34)[1:], np.linspace(0.72, 1, 9)[1:]]
    )


def curl(part, f):
    """Bends the plate near the tear: mostly inward, tongues outward."""
    w = np.exp(-np.maximum(f, 0) / 0.13)
    wave = N.value3(part.pos * [0, 1, 1], 90, 0.9) - 0.35
    q = part.copy()
    q.pos[:, 0] += 0.34 * wave * w
    return q


def build_hull():
    zs, ts = stations(), girth()
    star = strip(zs, ts)
    port = strip(zs, ts).mirrored().map(dent)
    torn, f = clip(star, tear(star.pos))
    inward = np.column_stack([np.full(len(torn.pos), -SKIN), np.zeros((len(torn.pos), 2))])
    bent = curl(torn, f)
    rims = rim(bent, f == 0, inward)
    hull = join([bent, port])
    # deck, stem and stern closures
    rows = []
    for z in zs:
        d, y = deck_half_width(z), deck_height(z)
        xs = np.linspace(-1, 1, 7)
        yy = y + 0.05 * (1 - xs**2)
        rows.append(np.column_stack([xs * d, yy, rake(xs * d, np.full(7, y), np.full(7, z))]))
    deck = loft(rows, (False, False), wrap=False, orient=False)
    a = deck.pos[deck.tri]
    if np.cross(a[:, 1] - a[:, 0], a[:, 2] - a[:, 0])[:, 1].sum() < 0:
        deck = deck.flipped()
    deck.uv = np.stack([deck.pos[:, 0], deck.pos[:, 2]], 1) / 3.2
    ends = []
    for z, back in ((zs[0], False), (zs[-1], True)):
        x, y = section(z, ts)
        loop = np.concatenate([np.column_stack([x, y]), np.column_stack([-x, y])[::-1]])
        p3 = np.column_stack([loop, rake(loop[:, 0], loop[:, 1], np.full(len(loop), z))])
        rr = np.arange(len(ts) - 1)
        m = 2 * len(ts) - 1
        tri = np.concatenate([np.stack([rr, rr + 1, m - rr - 1], 1), np.stack([rr, m - rr - 1, m - rr], 1)])
        cap = Part(p3, tri, np.column_stack([loop[:, 0] / 8, np.concatenate([ts, ts[::-1]])]))
        n = np.cross(p3[tri[:, 1]] - p3[tri[:, 0]], p3[tri[:, 2]] - p3[tri[:, 0]])[:, 2].sum()
        ends.append(cap if (n > 0) == back else cap.flipped())
    hull = join([hull] + ends)
    return shade(hull, 38), shade(deck, 30), shade(rims, 30)


def inner_works():
    """Liner, frames, bulkheads, floor, pipes and a racked torpedo behind the tear."""
    zs, ts = np.linspace(ROOM[0], ROOM[1], 46), np.linspace(0.1, 1, 28)
    s = strip(zs, ts)
    shrink = lambda p: np.column_stack([p[:, 0] - SKIN, 2.4 + (p[:, 1] - 2.4) * 0.97, p[:, 2]])
    wall, f = clip(s, tear(s.pos))
    bits = [
        curl(wall, f).map(shrink).flipped(),
        s.mirrored()
        .map(lambda p: np.column_stack([p[:, 0] + SKIN, 2.4 + (p[:, 1] - 2.4) * 0.97, p[:, 2]]))
        .flipped(),
    ]
    for z in (ROOM[0], ROOM[1]):
        x, y = section(z, ts)
        loop = np.concatenate([np.column_stack([x, y]), np.column_stack([-x, y])[::-1][:-1]])
        ringp = np.column_stack([loop, np.full(len(loop), z)])
        ringp[:, 0] -= np.sign(ringp[:, 0]) * 0.04
        bits.append(loft([ringp - [0, 0, 0.04], ringp + [0, 0, 0.04]]))
    rng = np.random.default_rng(4)
    for z in np.arange(ROOM[0] + 0.5, ROOM[1], 0.62):
        x, y = section(z, np.linspace(0.12, 0.97, 26))
        for side in (1, -1):
            p = np.column_stack([side * (x - 0.24), 2.4 + (y - 2.4) * 0.92, np.full(len(x), z)])
            if side > 0:
                g = tear(np.column_stack([x, y, np.full(len(x), z)]))
                lo = g > -0.45 + rng.normal(0, 0.2)
                p = p + np.column_stack(
                    [
                        -0.5 * rng.random() * np.exp(-np.maximum(g, -0.2) / 0.3),
                        0 * g,
                        0.3 * rng.normal() * np.exp(-np.maximum(g, -0.2) / 0.25),
                    ]
                )
                cuts = np.flatnonzero(np.diff(lo.astype(int)))
                for seg in np.split(np.arange(len(p)), cuts + 1):
                    if lo[seg[0]] and len(seg) > 2:
                        bits.append(tube(p[seg], 0.055, 4, flat=1.8))
            else:
                bits.append(tube(p, 0.055, 4, flat=1.8))
    mid, ln = (ROOM[0] + ROOM[1]) / 2, ROOM[1] - ROOM[0]
    bits.append(box(3.2, 0.06, ln, 0.02).at(-0.15, 1.25, mid))
    for k in range(7):
        y, x, r = 3.9 - 0.16 * (k // 2), -0.9 + 0.35 * k, 0.05 + 0.025 * (k % 3)
        bits.append(tube([[x, y, ROOM[0]], [x, y - 0.05 * (k == 5), mid], [x, y, ROOM[1]]], r, 8))
    body = revolve(
        [
            (0.01, -2.9),
            (0.15, -2.85),
            (0.25, -2.55),
            (0.265, -2.2),
            (0.265, 1.6),
            (0.20, 2.3),
            (0.08, 2.75),
            (0.01, 2.8),
        ],
        18,
    )
    bits += [body.at(-0.75, 1.75, mid), body.rot("y", 8).rot("x", -6).at(0.35, 1.62, mid + 0.7)]
    bits += [
        box(0.5, 0.8, 1.2, 0.05).at(-1.2, 2.9, mid + 1),
        box(0.4, 0.5, 0.7, 0.05).at(-1.25, 2.8, mid - 1.2),
        cylinder(0.22, 1.4, 14).at(-1.1, 3.4, mid - 0.6),
    ]
    return join(bits)
