"""Animals that swim by their bodies: turtle.glb and ray.glb (clip swim), jellyfish.glb (clip pulse); and
school_fish.glb: sardine (for thousands, rigid), snapper and damsel (clip swim). Nose along -z, origin in the middle.
"""
from pathlib import Path

import numpy as np

import fish_skin
import fish_swim
import noise as N
from glb import Glb, qmul, quat
from mesh import box_uv, join, loft, Part, shade
from sealife import ribbon
from shapes import curve, foil, revolve, sphere, tube

OUT = Path(__file__).resolve().parents[2] / "assets" / "models"


def coloured(part, rgb, crease=60):
    p = part if part.nrm is not None else shade(part, crease)
    p.col = np.column_stack([np.clip(rgb(p), 0, 1), np.ones(len(p.pos))])
    return p


def bound(part, weights):
    """weights [n, joints]: the four largest count."""
    top = np.argsort(-weights, 1)[:, :4]
    w = np.take_along_axis(weights, top, 1)
    part.joints, part.weights = np.where(w > 0, top, 0), w / w.sum(1, keepdims=True)
    return part


def scutes(n=512):
    """A carapace from above (u across, v from head to tail): five scutes along the keel, four each side."""
    y, x = np.meshgrid((np.arange(n) + 0.5) / n, (np.arange(n) + 0.5) / n, indexing="ij")
    pts = [(0.5, v) for v in (0.13, 0.31, 0.50, 0.68, 0.85)]
    pts += [(0.5 + s * d, v) for s in (-1, 1) for d, v in ((0.20, 0.25), (0.235, 0.44), (0.22, 0.62), (0.165, 0.79))]
    rim = [(0.5 + 0.47 * np.sin(a), 0.5 - 0.49 * np.cos(a)) for a in np.linspace(0.25, 2 * np.pi - 0.25, 24)]
    dist = np.array([np.hypot((x - px) * 1.0, (y - py) * 1.15) + (0.075 if k >= 13 else 0) for k, (px, py) in enumerate(pts + rim)])
    order = np.sort(dist, 0)
    who = np.argmin(dist, 0)
    gap = order[1] - order[0]
    px = np.array([p[0] for p in pts + rim])[who]
    py = np.array([p[1] for p in pts + rim])[who]
    a = np.arctan2(x - px, y - py + 0.035)
    rays = 0.5 + 0.5 * np.cos(a * 17 + 3 * N.spectral(n, 4, 2, 3))
    f = N.spectral(n, 6, 1.0, 12)
    col = N.mix(N.flat(n, (0.36, 0.24, 0.11)), (0.62, 0.46, 0.22), N.smooth(0.25, 0.85, rays) * N.smooth(0.0, 0.09, gap))
    col = N.mix(col, (0.16, 0.11, 0.06), 0.7 * N.smooth(0.4, 1.6, N.spectral(n, 8, 1.6, 4)))
    col = N.mix(col, (0.70, 0.62, 0.42), N.smooth(0.011, 0.003, gap))
    col = N.mix(col, (0.42, 0.44, 0.26), 0.45 * N.smooth(0.3, 1.5, N.spectral(n, 9, 2, 2)))
    h = -0.004 * N.smooth(0.016, 0.0, gap) + 0.0008 * rays + 0.0006 * f
    return np.clip(col * (1 + 0.05 * f)[..., None], 0, 1), N.normal_map(h, 0.7, 0.9)


def skin_scales(n=256):
    d1, d2, who = N.cells(n, 420, 12)
    tone = np.random.default_rng(3).random(420)[who]
    edge = N.smooth(0.012, 0.003, d2 - d1)
    col = N.mix(N.flat(n, (0.66, 0.60, 0.46)) * (0.7 + 0.5 * tone[..., None]), (0.92, 0.88, 0.70), edge)
    return np.clip(col, 0, 1), N.normal_map(-0.0012 * edge + 0.0005 * tone, 0.25)


def turtle():
    """A green turtle: carapace 0.92 m. Joints: body, head, two flippers of two joints, two hind ones."""
    n, m = 44, 23
    u = np.linspace(0, 1, m)
    z = -0.45 + 0.92 * u
    half = 0.335 * np.sin(np.pi * np.clip(u * 0.94 + 0.035, 0, 1)) ** 0.62 * (1 - 0.22 * u)
    high = 0.165 * np.sin(np.pi * np.clip(u * 0.93 + 0.05, 0, 1)) ** 0.8
    rings, uv = [], []
    a = np.linspace(0, np.pi, n)
    for k in range(m):
        rings.append(np.column_stack([-half[k] * np.cos(a), high[k] * np.sin(a) ** 0.9 + 0.012 * np.exp(-((a - np.pi / 2) / 0.12) ** 2), np.full(n, z[k])]))
        uv.append(np.column_stack([0.5 - 0.485 * np.cos(a) * half[k] / 0.335 / max(1 - 0.22 * u[k], 0.1), np.full(n, 0.02 + 0.96 * u[k])]))
    shell = loft(np.array(rings), (False, False), wrap=False, orient=False)
    shell.uv = np.concatenate(uv)
    if shade(shell, 80).nrm[:, 1].mean() < 0:
        shell = shell.flipped()
    shell = shade(shell, 70)
    under = []
    for k in range(m):
        b = np.linspace(np.pi, 2 * np.pi, 15)
        under.append(np.column_stack([-half[k] * np.cos(b) * 0.985, 0.075 * np.sin(b) * np.clip(np.sin(np.pi * u[k]) * 1.3, 0, 1) ** 0.5 + 0.002, np.full(15, z[k])]))
    belly = loft(np.array(under), (False, False), wrap=False, orient=False)
    if shade(belly, 80).nrm[:, 1].mean() > 0:
        belly = belly.flipped()
    belly = coloured(belly, lambda p: np.tile([0.90, 0.84, 0.62], (len(p.pos), 1)))
    # head, and a neck that is thick at the shell, in folds
    prof = [(0.098, -0.330), (0.104, -0.385), (0.097, -0.415), (0.099, -0.428), (0.090, -0.446), (0.093, -0.458), (0.084, -0.475), (0.086, -0.487), (0.074, -0.507), (0.075, -0.530), (0.078, -0.560), (0.083, -0.605), (0.079, -0.655), (0.060, -0.700), (0.034, -0.728), (0.004, -0.738)]
    head = revolve([(r, zz) for r, zz in prof[::-1]], 22)
    low = lambda p: N.smooth(-0.61, -0.45, p[:, 2])  # flat and low, so that it comes out under the shell's rim
    head = head.map(lambda p: np.column_stack([p[:, 0] * (0.86 + 0.10 * low(p)), p[:, 1] * (0.92 - 0.37 * low(p)) + 0.03 - 0.04 * low(p), p[:, 2]]))
    tone = lambda p: N.mix(np.tile([0.40, 0.33, 0.20], (len(p.pos), 1)), np.array([0.86, 0.80, 0.58]), N.smooth(0.2, -0.5, p.nrm[:, 1]))
    skin = [coloured(head, tone)]
    eyes = [coloured(sphere(0.0135, 10, 8).at(s * 0.055, 0.052, -0.655), lambda p: np.tile([0.02, 0.02, 0.02], (len(p.pos), 1))) for s in (-1, 1)]
    up = np.array([0.0, 1.0, 0.0])
    front = foil([
        ((0.22, 0.005, -0.33), (0.24, 0.0, -0.13), 0.062, up), ((0.36, 0.0, -0.40), (0.37, -0.005, -0.19), 0.050, up),
        ((0.49, -0.01, -0.43), (0.50, -0.015, -0.235), 0.036, up), ((0.62, -0.02, -0.38), (0.60, -0.025, -0.22), 0.027, up),
        ((0.73, -0.03, -0.28), (0.69, -0.035, -0.16), 0.018, up), ((0.80, -0.04, -0.15), (0.775, -0.04, -0.09), 0.008, up),
        ((0.815, -0.045, -0.075), (0.81, -0.045, -0.06), 0.003, up)], 11)
    hind = foil([((0.14, 0.0, 0.30), (0.10, 0.0, 0.44), 0.045, up), ((0.21, -0.01, 0.37), (0.14, -0.01, 0.50), 0.032, up), ((0.27, -0.015, 0.46), (0.17, -0.015, 0.57), 0.018, up), ((0.26, -0.02, 0.56), (0.20, -0.02, 0.60), 0.005, up)], 9)
    for part in (front, front.mirrored(), hind, hind.mirrored()):
        skin.append(coloured(part, tone))
    tail = tube(np.array([(0, 0.0, 0.42), (0, -0.01, 0.49), (0, -0.02, 0.55)]), [0.035, 0.022, 0.004], 8)
    skin.append(coloured(tail, tone))
    skin = box_uv(join(skin + eyes), 0.25)
    joints = ["body", "head", "shoulder_l", "hand_l", "shoulder_r", "hand_r", "hind_l", "hind_r"]
    rest = np.array([(0, 0, 0), (0, 0.02, -0.40), (-0.25, 0, -0.24), (-0.50, -0.01, -0.32), (0.25, 0, -0.24), (0.50, -0.01, -0.32), (-0.13, 0, 0.33), (0.13, 0, 0.33)])
    w = np.zeros((len(skin.pos), 8))
    x, zz = np.abs(skin.pos[:, 0]), skin.pos[:, 2]
    left = skin.pos[:, 0] < 0
    fl = (zz < 0.15) & (x > 0.17) & (zz > -0.5)
    arm, hand = N.smooth(0.20, 0.32, x) * fl, N.smooth(0.42, 0.56, x) * fl
    for side, (i, j) in ((left, (2, 3)), (~left, (4, 5))):
        w[side, j] = (arm * hand)[side]
        w[side, i] = (arm * (1 - hand))[side]
    back = (zz > 0.26) & (x > 0.05)
    hw = N.smooth(0.28, 0.40, zz + 0.5 * x) * back
    w[left, 6], w[~left, 7] = hw[left], hw[~left]
    w[:, 1] = N.smooth(-0.38, -0.50, zz) * (x < 0.13)
    w[:, 0] = np.maximum(0, 1 - w[:, 1:].sum(1))
    one = lambda part: bound(part, np.eye(8)[np.zeros(len(part.pos), int)])
    g = Glb("turtle")
    sc, sn = scutes()
    kc, kn = skin_scales()
    m_s = g.material("shell", base=g.texture("shell_color", sc, 82), normal=g.texture("shell_normal", sn, 78), rough=0.55)
    m_k = g.material("skin", base=g.texture("skin_color", kc, 80), normal=g.texture("skin_normal", kn, 76), rough=0.7)
    nodes = []
    for k, name in enumerate(joints):
        parent = None if k == 0 else nodes[{3: 2, 5: 4}.get(k, 0)]
        base = rest[{3: 2, 5: 4}.get(k, 0)] if k else np.zeros(3)
        nodes.append(g.node(name, at=rest[k] - base, parent=parent))
    belly = box_uv(belly, 0.25)
    mesh = g.mesh("turtle", [(one(shell), m_s), (join([bound(skin, w), one(belly)]), m_k)])
    g.node("turtle", mesh, skin=g.skin("turtle", nodes, rest))
    t = np.linspace(0, 3.2, 33)
    ph = t / 3.2 * 2 * np.pi
    beat, lag = 34 * np.sin(ph) + 6, 24 * np.sin(ph - 1.0)
    sweep = 14 * np.cos(ph)
    tracks = []
    for i, j, s in ((nodes[2], nodes[3], -1), (nodes[4], nodes[5], 1)):
        tracks.append((i, "rotation", qmul(quat("y", -s * sweep), qmul(quat("z", s * beat), quat("x", -16 * np.cos(ph))))))
        tracks.append((j, "rotation", quat("z", s * lag)))
    for i, s in ((nodes[6], -1), (nodes[7], 1)):
        tracks.append((i, "rotation", qmul(quat("y", s * (10 + 6 * np.sin(ph))), quat("x", 5 * np.sin(ph + 1)))))
    tracks.append((nodes[1], "rotation", quat("x", 5 + 3 * np.sin(ph + 0.5))))
    tracks.append((nodes[0], "rotation", quat("x", 2.5 * np.sin(ph - 0.4))))
    tracks.append((nodes[0], "translation", np.column_stack([0 * t, 0.018 * np.sin(ph - 1.6), 0 * t])))
    g.animation("swim", t, tracks)
    g.save(OUT / "turtle.glb")


def ray_texture(n=512):
    y, x = np.meshgrid((np.arange(n) + 0.5) / n, (np.arange(n) + 0.5) / n, indexing="ij")
    f = N.spectral(n, 6, 1.0, 20)
    col = N.mix(N.flat(n, (0.13, 0.14, 0.16)), (0.24, 0.25, 0.27), N.smooth(-1, 1.4, N.spectral(n, 4, 2, 2)))
    rng = np.random.default_rng(6)
    for _ in range(130):  # white spots of an eagle ray
        a, r, s = rng.random() * 2 * np.pi, 0.46 * np.sqrt(rng.random()), 0.006 + 0.009 * rng.random()
        cx, cy = 0.5 + r * np.cos(a), 0.42 + 0.8 * r * np.sin(a)
        d = np.hypot(x - cx, (y - cy)) + 0.002 * f
        col = N.mix(col, (0.80, 0.82, 0.80), 0.85 * N.smooth(s, s * 0.55, d))
    return np.clip(col * (1 + 0.06 * f)[..., None], 0, 1)


def ray_belly(n=512):
    """White with a grey hem along the wings; mouth and nostrils, and five slits of gills on each side."""
    y, x = np.meshgrid((np.arange(n) + 0.5) / n, (np.arange(n) + 0.5) / n, indexing="ij")
    across, z = (x - 0.5) / 0.505 * 0.95, (y - 0.5) / 0.85  # metres, as the body's uv has them
    f, blotch = N.spectral(n, 6, 1.0, 20), N.spectral(n, 4, 2, 3)
    hem = N.smooth(0.45, 0.95, np.abs(across) + 0.03 * blotch)
    col = N.mix(N.flat(n, (0.84, 0.84, 0.81)), (0.34, 0.36, 0.38), 0.85 * hem)
    col = N.mix(col, (0.66, 0.64, 0.60), 0.5 * N.smooth(0.2, 1.6, blotch) * (1 - hem))
    h = 0.0006 * f
    slits = np.zeros_like(x)
    for side in (-1, 1):
        for k in range(5):
            cx, cz = side * (0.125 - 0.006 * k), -0.20 + 0.052 * k
            along, off = (across - cx) * side, z - cz - 0.25 * (across - cx) * side
            slits = np.maximum(slits, N.smooth(0.006, 0.002, np.abs(off)) * N.smooth(0.036, 0.024, np.abs(along)))
    mouth = N.smooth(0.011, 0.004, np.abs(z + 0.37 + 1.2 * across**2)) * N.smooth(0.085, 0.07, np.abs(across))
    nose = N.smooth(0.014, 0.008, np.hypot(np.abs(across) - 0.045, z + 0.425))
    dark = np.maximum(np.maximum(slits, mouth), nose)
    col = N.mix(col, (0.16, 0.14, 0.14), 0.9 * dark)
    col = N.mix(col, (0.62, 0.58, 0.54), 0.6 * N.smooth(0.16, 0.05, np.hypot(across, (z - 0.30) * 0.7)))
    return np.clip(col * (1 + 0.04 * f)[..., None], 0, 1), N.normal_map(h - 0.005 * dark, 0.95, 0.9)


def ray():
    """A spotted eagle ray, 1.9 m across. Joints: body, three along each wing, two of the tail."""
    m, n = 41, 13
    span = np.linspace(-1, 1, m)
    s = np.abs(span)
    rings, uv = [], []
    lead = -0.46 + 0.10 * N.smooth(0, 0.13, s) + 0.40 * N.smooth(0.10, 1, s) ** 1.25 - 0.16 * np.exp(-((s - 0.34) / 0.22) ** 2)
    trail = 0.50 - 0.02 * s - 0.34 * N.smooth(0.0, 0.55, s) + 0.26 * N.smooth(0.5, 1, s) ** 2
    lead += (trail - 0.012 - lead) * N.smooth(0.62, 1.0, s) ** 1.6  # tips come to a point
    thick = 0.30 * np.exp(-(s / 0.20) ** 2) + 0.075 * (1 - s) ** 1.1 + 0.003
    q = (1 - np.cos(np.linspace(0, np.pi, n))) / 2
    half = 2.6 * (0.2969 * np.sqrt(q) - 0.126 * q - 0.3516 * q**2 + 0.2843 * q**3 - 0.1036 * q**4) * 0.5
    for k in range(m):
        zz = lead[k] + (trail[k] - lead[k]) * q
        up, down = half * thick[k] * 2.1, -half * thick[k] * 1.2
        x = np.full(n, span[k] * 0.95)
        line = np.column_stack([x, up, zz])
        low = np.column_stack([x, down, zz])[-2:0:-1]
        rings.append(np.concatenate([line, low]))
        v = np.concatenate([zz, zz[-2:0:-1]])
        uv.append(np.column_stack([np.full(len(v), 0.5 + 0.48 * span[k]), 0.5 + v * 0.85]))
    body = loft(np.array(rings), (True, True))
    body.uv = np.column_stack([0.5 + 0.505 * body.pos[:, 0] / 0.95 * 0.95, 0.5 + body.pos[:, 2] * 0.85])
    snout = revolve([(0.01, -0.60), (0.055, -0.575), (0.085, -0.52), (0.105, -0.44), (0.11, -0.33)], 16)
    snout = snout.map(lambda p: np.column_stack([p[:, 0] * 1.05, p[:, 1] * 0.72 + 0.03, p[:, 2]]))
    snout.uv = np.column_stack([0.5 + 0.5 * snout.pos[:, 0], 0.5 + snout.pos[:, 2] * 0.85])
    tail = tube(np.column_stack([np.zeros(16), 0.02 - 0.06 * np.linspace(0, 1, 16), np.linspace(0.42, 1.75, 16)]), np.linspace(0.022, 0.003, 16), 7)
    tail.uv = np.column_stack([0.5 + tail.pos[:, 0], np.full(len(tail.pos), 0.97)])
    whole = shade(join([body, snout, tail]), 60)
    belly = N.smooth(0.05, -0.3, whole.nrm[:, 1])
    tint = N.mix(np.tile([1.0, 1.0, 1.0], (len(whole.pos), 1)), np.array([1.0, 1.0, 1.0]), belly)
    whole.col = np.column_stack([tint, np.ones(len(tint))])
    x = whole.pos[:, 0]
    w = np.zeros((len(x), 9))
    knots = np.array([0.0, 0.22, 0.48, 0.74])
    for side, first in ((x < 0, 1), (x >= 0, 4)):
        d = np.abs(x)
        for k in range(4):
            reach = 0.26
            v = np.clip(1 - np.abs(d - knots[k]) / reach, 0, 1) if k < 3 else N.smooth(0.48, 0.74, d)
            w[side, 0 if k == 0 else first + k - 1] += v[side]
    tz = whole.pos[:, 2]
    thin = (tz > 0.50) & (np.abs(x) < 0.05)
    w[thin] = 0
    w[thin, 7] = 1 - N.smooth(0.9, 1.3, tz[thin])
    w[thin, 8] = N.smooth(0.9, 1.3, tz[thin])
    w[:, 0] += 1e-6
    bound(whole, w)
    names = ["body", "wing_l_0", "wing_l_1", "wing_l_2", "wing_r_0", "wing_r_1", "wing_r_2", "tail_0", "tail_1"]
    rest = np.array([(0, 0, 0)] + [(-k, 0, 0) for k in (0.12, 0.36, 0.62)] + [(k, 0, 0) for k in (0.12, 0.36, 0.62)] + [(0, 0, 0.48), (0, -0.03, 1.05)], float)
    parent = [None, 0, 1, 2, 0, 4, 5, 0, 7]
    g = Glb("ray")
    top = g.texture("ray_color", ray_texture(), 84)
    grey = g.material("back", base=top, rough=0.45)
    below, bumps = ray_belly()
    white = g.material("belly", base=g.texture("belly_color", below, 84), normal=g.texture("belly_normal", bumps, 78), rough=0.5)
    tri_up = (whole.nrm[whole.tri].mean(1)[:, 1] > -0.15) | thin[whole.tri].all(1)
    upper, lower = whole.copy(), whole.copy()
    upper.tri, lower.tri = whole.tri[tri_up], whole.tri[~tri_up]
    nodes = []
    for k, name in enumerate(names):
        base = rest[parent[k]] if parent[k] is not None else np.zeros(3)
        nodes.append(g.node(name, at=rest[k] - base, parent=None if parent[k] is None else nodes[parent[k]]))
    mesh = g.mesh("ray", [(upper, grey), (lower, white)])
    g.node("ray", mesh, skin=g.skin("ray", nodes, rest))
    t = np.linspace(0, 2.6, 27)
    ph = t / 2.6 * 2 * np.pi
    tracks = []
    for s_, first in ((-1, 1), (1, 4)):
        for k, (amp, lag) in enumerate(((17, 0.0), (15, 0.75), (15, 1.5))):
            swing = s_ * (amp * np.sin(ph - lag) + (3 if k == 0 else 0))
            tracks.append((nodes[first + k], "rotation", qmul(quat("z", swing), quat("x", 5 * np.cos(ph - lag)))))
    tracks.append((nodes[7], "rotation", quat("y", 5 * np.sin(ph))))
    tracks.append((nodes[8], "rotation", quat("y", 9 * np.sin(ph - 1.1))))
    tracks.append((nodes[0], "translation", np.column_stack([0 * t, -0.035 * np.sin(ph - 0.3), 0 * t])))
    g.animation("swim", t, tracks)
    g.save(OUT / "ray.glb")


def frill(path, width, normal, ripples, phase):
    """A curtain along a path, smooth in the middle and ruffled towards both edges; v across it, -1 to 1, is in uv."""
    across = np.linspace(-1, 1, 7)
    t = np.gradient(path, axis=0)
    t /= np.linalg.norm(t, axis=1, keepdims=True)
    side = np.cross(t, normal)
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    up = np.cross(side, t)
    q = np.linspace(0, 1, len(path))[:, None]
    uneven = q + 0.030 * np.sin(19 * q + phase) + 0.018 * np.sin(43 * q + 2 * phase)
    wave = np.where(across < 0, np.sin(2 * np.pi * ripples * uneven + phase), np.sin(2 * np.pi * (ripples + 3) * uneven + 2 * phase))
    lift = np.abs(across) ** 1.6 * wave * 0.24 * (1 + 0.5 * np.sin(11 * q + phase))
    drift = 0.10 * np.abs(across) * np.cos(2 * np.pi * (0.5 * ripples) * q + phase)
    w = np.asarray(width)[:, None, None] / 2
    rows = path[:, None] + w * (across[None, :, None] * (1 + drift[:, :, None]) * side[:, None] + 2 * lift[:, :, None] * up[:, None])
    uv = np.stack([np.tile(across, (len(path), 1)), np.tile(q, (1, 7))], 2)
    i = (np.arange(len(path) - 1)[:, None] * 7 + np.arange(6)).ravel()
    tri = np.concatenate([np.stack([i, i + 1, i + 8], 1), np.stack([i, i + 8, i + 7], 1)])
    return Part(rows.reshape(-1, 3), tri, uv.reshape(-1, 2))


def soft(part, rgb, alpha):
    """Colours a frill or a ribbon of uv.x -1 to 1, clear at its edges."""
    part = coloured(part, lambda p: np.tile(rgb, (len(p.pos), 1)), 80)
    part.col[:, 3] = alpha(part.pos[:, 1]) * (1 - 0.94 * np.abs(part.uv[:, 0]) ** 1.5)
    return part


def jellyfish():
    """A compass jellyfish: bell of 0.24 m, mouth arms 0.8 m. It pulses by its rim. Nose (crown) is +y."""
    n = 48
    knots = [(0.004, 0.075), (0.035, 0.072), (0.066, 0.060), (0.092, 0.040), (0.110, 0.012), (0.118, -0.018), (0.116, -0.040), (0.108, -0.042), (0.098, -0.024), (0.086, 0.002), (0.060, 0.030), (0.03, 0.044), (0.004, 0.048)]
    prof = curve([(r, y, 0.0) for r, y in knots], 25)[:, :2]
    ang = np.arange(n) / n * 2 * np.pi
    lobes = N.smooth(0.098, 0.116, prof[:, 0]) * N.smooth(0.01, -0.035, prof[:, 1])  # 16 along the rim
    rings = [np.column_stack([r * np.cos(ang), y - 0.006 * k * (0.5 + 0.5 * np.cos(16 * ang)), r * np.sin(ang)]) for (r, y), k in zip(prof, lobes)]
    bell = shade(loft(np.array(rings), (True, True)), 80)
    a = np.arctan2(bell.pos[:, 2], bell.pos[:, 0])
    r = np.hypot(bell.pos[:, 0], bell.pos[:, 2])
    inside = N.smooth(0.05, -0.05, bell.nrm[:, 1] * np.sign(bell.pos[:, 1] + 0.03))
    ray_ = N.smooth(0.35, 0.75, np.cos(16 * a)) * N.smooth(0.045, 0.075, r) * (1 - inside)
    spot = N.smooth(0.026, 0.018, r) * (1 - inside)
    organ = N.smooth(0.5, 0.9, np.cos(4 * a)) * N.smooth(0.022, 0.034, r) * N.smooth(0.062, 0.048, r) * inside
    rim = N.smooth(0.106, 0.118, r)
    c = N.mix(np.tile([0.66, 0.58, 0.48], (len(r), 1)), np.array([0.52, 0.24, 0.10]), np.maximum(0.85 * ray_, 0.7 * spot))
    c = N.mix(c, np.array([0.72, 0.50, 0.36]), organ)
    # Clear jelly: what lies behind and inside shows through both walls; the rim, seen along itself, is the palest.
    alpha = 0.035 + 0.22 * np.maximum(ray_, spot) + 0.20 * rim + 0.22 * organ
    bell.col = np.column_stack([c, np.clip(alpha, 0, 1)])
    w = np.zeros((len(r), 6))
    rim = N.smooth(0.045, 0.112, r) * 0.9
    w[:, 1], w[:, 0] = rim, 1 - rim
    bound(bell, w)
    rng = np.random.default_rng(2)
    arms, threads = [], []
    for k in range(4):
        b = k * np.pi / 2 + 0.4
        q = np.linspace(0, 1, 72)
        out = 0.020 + 0.10 * q**1.3 * (1 + 0.3 * np.sin(1.9 * k))
        turn = b + 0.25 * np.sin(4.0 * q + k)
        p = np.column_stack([out * np.cos(turn), 0.036 - (0.62 + 0.05 * k) * q, out * np.sin(turn)])
        width = 0.050 * N.smooth(-0.10, 0.12, q) * (1 - q) ** 0.6 + 0.003
        arms.append(frill(p, width, np.array([np.cos(b + 1.0), 0.1, np.sin(b + 1.0)]), 13 + 2 * k, 1.3 * k))
    for k in range(24):
        b = k / 24 * 2 * np.pi
        q = np.linspace(0, 1, 12)[:, None]
        ln = 0.42 + 0.30 * rng.random()
        p = np.column_stack([np.cos(b) * (0.112 + 0.035 * q[:, 0] ** 2) + 0.012 * np.sin(9 * q[:, 0] + k), -0.035 - ln * q[:, 0], np.sin(b) * (0.112 + 0.035 * q[:, 0] ** 2) + 0.012 * np.cos(8 * q[:, 0] + k)])
        # Wide and faint instead of thin and full: what is narrower than a pixel would break into dots.
        threads.append(ribbon(p, np.linspace(0.009, 0.005, 12), np.array([-np.sin(b), 0.0, np.cos(b)]), -1.0, 1.0))
    hang = join([
        soft(join(arms), [0.62, 0.50, 0.40], lambda y: 0.34 * (1 - 0.7 * N.smooth(-0.20, -0.66, y))),
        soft(join(threads), [0.46, 0.30, 0.20], lambda y: 0.40 * (1 - 0.75 * N.smooth(-0.25, -0.75, y))),
    ])
    hang.uv = 0.5 + 0.5 * hang.uv
    y = hang.pos[:, 1]
    w = np.zeros((len(y), 6))
    knots = np.array([-0.05, -0.25, -0.48, -0.72])
    for k in range(4):
        w[:, 2 + k] = np.clip(1 - np.abs(y - knots[k]) / 0.24, 0, 1)
    outer = N.smooth(0.085, 0.11, np.hypot(hang.pos[:, 0], hang.pos[:, 2])) * N.smooth(-0.20, -0.06, y)
    w *= (1 - outer)[:, None]
    w[:, 1] = outer
    w[:, 0] = N.smooth(-0.04, 0.03, y) * (1 - outer) + 1e-6
    bound(hang, w)
    g = Glb("jellyfish")
    m_bell = g.material("bell", rough=0.25, double=True, blend=True)
    m_hang = g.material("arms", rough=0.5, double=True, blend=True)
    rest = np.array([(0, 0, 0), (0, 0, 0), (0, 0.0, 0), (0, -0.2, 0), (0, -0.42, 0), (0, -0.64, 0)], float)
    parent = [None, 0, 0, 2, 3, 4]
    nodes = []
    for k, name in enumerate(["bell", "rim", "arm_0", "arm_1", "arm_2", "arm_3"]):
        base = rest[parent[k]] if parent[k] is not None else np.zeros(3)
        nodes.append(g.node(name, at=rest[k] - base, parent=None if parent[k] is None else nodes[parent[k]]))
    g.node("jellyfish", g.mesh("jellyfish", [(hang, m_hang), (bell, m_bell)]), skin=g.skin("jellyfish", nodes, rest))
    t = np.linspace(0, 1.8, 25)
    ph = t / 1.8 * 2 * np.pi
    pulse = np.maximum(0, np.sin(ph)) ** 1.3
    rim_s = 1.06 - 0.34 * pulse
    tracks = [
        (nodes[1], "scale", np.column_stack([rim_s, 1 + 0.25 * pulse, rim_s])),
        (nodes[1], "translation", np.column_stack([0 * t, -0.022 * pulse, 0 * t])),
        (nodes[0], "translation", np.column_stack([0 * t, 0.02 * np.sin(ph - 1.2), 0 * t])),
    ]
    for k in range(4):
        sway = 6 * np.sin(ph - 0.9 * k)
        tracks.append((nodes[2 + k], "rotation", qmul(quat("x", sway), quat("z", 4 * np.cos(ph - 0.9 * k)))))
    g.animation("pulse", t, tracks)
    g.save(OUT / "jellyfish.glb")


def fish_body(zs, h, w, sides, solid=False):
    """A body strip between nose and tail root; uv: x along, y from back to belly. solid: its halves meet exactly."""
    v = np.linspace(0, 1, sides)
    rows, uv = [], []
    for z, hh, ww in zip(zs, h, w):
        a = np.pi * v
        rows.append(np.column_stack([ww * np.sin(a) ** 0.85, hh * np.cos(a), np.full(sides, z)]))
        if solid:
            rows[-1][[0, -1], 0] = 0.0
        uv.append(np.column_stack([np.full(sides, (z - zs[0]) / (0.97 * 2 * -zs[0])), 0.04 + 0.92 * v]))
    p = loft(np.array(rows), (False, False), wrap=False, orient=False)
    p.uv = np.concatenate(uv)
    t = p.pos[p.tri]
    if np.cross(t[:, 1] - t[:, 0], t[:, 2] - t[:, 0])[:, 0].sum() < 0:
        p = p.flipped()
    return join([p, p.mirrored()])


def fin(points, length):
    q = np.array([(0, y, z) for y, z in points], float)
    n = len(q)
    tri = [(0, k, k + 1) for k in range(1, n - 1)]
    return Part(q, tri, np.column_stack([(q[:, 2] + length / 2) / length * 0.98, np.full(n, 0.06) + 0.88 * (q[:, 1] < 0)]))


def rays(rgb, root, outer):
    """A fin of rays in a colour (linear), from its root to its outer edge, both as (y, z), or (x, y, z) of one that stands out.

    u runs out along the rays, v from ray to ray.
    """
    a, b = (q_list([q if len(q) == 3 else (0.0, *q) for q in edge], len(outer)) for edge in (root, outer))
    n = len(b)
    b = b + np.outer(0.04 * np.linalg.norm(b - a, axis=1) * (-1.0) ** np.arange(n), [1, 0, 0])  # pleated
    v, k = np.linspace(0.0, 1.0, n), np.arange(n - 1)
    tri = np.concatenate([np.stack([k, k + n, k + n + 1], 1), np.stack([k, k + n + 1, k + 1], 1)])
    uv = np.concatenate([np.column_stack([0 * v + u, v]) for u in (0.02, 0.98)])
    return Part(np.concatenate([a, b]), tri, uv, col=np.tile([*rgb, 1.0], (2 * n, 1)))


def q_list(points, n):
    """n points evenly along a line through some."""
    p = np.asarray(points, float)
    t = np.linspace(0, len(p) - 1, n)
    return np.column_stack([np.interp(t, np.arange(len(p)), p[:, i]) for i in range(p.shape[1])])


def ray_picture(n=128, count=14):
    """Dark rays that fork outwards on a clear membrane, which hangs back between their tips; RGBA."""
    v = ((np.arange(n) + 0.5) / n)[:, None] * np.ones((1, n))
    u = ((np.arange(n) + 0.5) / n)[None, :] * np.ones((n, 1))
    one = np.abs((v * count) % 1 - 0.5) * 2  # 0 on a ray
    two = np.abs((v * count * 2 + 0.5) % 1 - 0.5) * 2
    line = N.smooth(0.46, 0.14, N.mix(one, np.minimum(1, two + 0.15), N.smooth(0.45, 0.7, u)))
    joints = 0.5 + 0.5 * np.cos(2 * np.pi * 26 * u)
    veins = np.abs(N.spectral(n, 5, 1.6, 6, stretch=(0.6, 1.6)))
    tone = 0.94 - (0.46 + 0.12 * joints) * line * (1 - 0.4 * u) - 0.06 * veins * (1 - line) - 0.30 * N.smooth(0.18, 0.0, u)
    tone = tone + 0.10 * N.smooth(0.70, 0.98, u)
    frayed = u + 0.13 * one + 0.02 * N.spectral(n, 6, 1.0, 4)
    return np.dstack([np.clip(tone, 0, 1)] * 3 + [N.smooth(0.99, 0.96, frayed)])


def fish_picture(back, flank, belly, marks, n=64, m=128):
    v = ((np.arange(n) + 0.5) / n)[:, None] * np.ones((1, m))
    u = ((np.arange(m) + 0.5) / m)[None, :] * np.ones((n, 1))
    f = N.spectral(n, 3, 0.6, 10, m=m)
    col = N.mix(N.flat(n, back, m), flank, N.smooth(0.22, 0.42, v))
    col = N.mix(col, belly, N.smooth(0.60, 0.85, v))
    col = marks(col, u, v)
    return np.clip(col * (1 + 0.03 * f)[..., None], 0, 1)


def school_fish():
    g = Glb("school_fish")

    spines = []

    def add(name, parts, picture, at, rough, m_f=None, length=None, skin=None):
        bumps = None
        if skin:
            picture, bumps = fish_skin.dressed(picture, **skin)
            bumps = g.texture(f"{name}_normal", bumps, 72)
        b = g.texture(f"{name}_color", picture, 82)
        m_b = g.material(f"{name}_body", base=b, rough=rough, metal=0.25 if skin else 0.0, normal=bumps)
        if m_f is None:  # in one piece, with fins of two sides: what is drawn by the thousand costs by the piece
            prims = [(shade(join([*parts, *(part.flipped() for part in parts[1:])]), 80), m_b)]
        else:
            prims = [(shade(parts[0], 80), m_b), (shade(join(parts[1:]), 80), m_f)]
        if length:
            spines.append(fish_swim.swimmer(g, name, prims, length, at))
        else:
            g.node(name, g.mesh(name, prims), at=at)

    # 32 triangles, for thousands: a solid with a point at either end, so that views of both sides of sheets draw its front alone,
    # and of four sides, since the coarser versions of these keep more of its outline
    sardine = [fish_body([-0.08, -0.055, -0.015, 0.03, 0.07], [0.0, 0.013, 0.018, 0.013, 0.0], [0.0, 0.0075, 0.0095, 0.0065, 0.0], 3, solid=True),
               fin([(0, 0.060), (0.020, 0.088), (0.003, 0.076), (-0.003, 0.076), (-0.020, 0.088)], 0.16), fin([(0.016, -0.01), (0.028, 0.004), (0.014, 0.016)], 0.16)]
    silver = lambda col, u, v: N.mix(col, (0.70, 0.78, 0.80), 0.5 * N.smooth(0.08, 0.02, np.abs(v - 0.52)))
    add("sardine", sardine, fish_picture((0.07, 0.12, 0.15), (0.40, 0.47, 0.50), (0.56, 0.60, 0.60), silver, 32, 64), (-0.5, 0, 0), 0.3)
    # 14 triangles in one piece, for ten thousand in the distance
    rim = np.array([(0, 0, -0.08), (0, 0.018, -0.015), (0, 0.005, 0.062), (0, 0.020, 0.088), (0, -0.020, 0.088), (0, -0.005, 0.062), (0, -0.018, -0.015)])
    side = np.vstack([rim, [(0.008, 0.0, -0.012)]])
    fan_of = lambda mid: [(mid, k, k + 1) for k in range(6)] + [(mid, 6, 0)]
    right = Part(side, np.array(fan_of(7))[:, ::-1], np.column_stack([(side[:, 2] + 0.08) / 0.17, 0.5 - side[:, 1] / 0.045]))
    if shade(right, 80).nrm[:, 0].mean() < 0:
        right = right.flipped()
    b_far = len(g.doc["textures"]) - 1
    m_far = g.material("sardine_far", base=b_far, rough=0.35)
    g.node("sardine_far", g.mesh("sardine_far", [(shade(join([right, right.mirrored()]), 80), m_far)]), at=(-0.5, 0.3, 0))
    # Light comes through fins.
    m_rays = g.material("rays", base=g.texture("rays_color", ray_picture()), rough=0.5, double=True, mask=0.5, thin=0.6)
    gold, yellow, blue = (0.42, 0.31, 0.07), (0.62, 0.40, 0.03), (0.03, 0.09, 0.30)
    zs = [-0.16, -0.152, -0.13, -0.095, -0.05, 0.0, 0.05, 0.10]
    snapper = [fish_body(zs, [0.004, 0.018, 0.036, 0.053, 0.060, 0.053, 0.036, 0.017], [0.003, 0.010, 0.018, 0.025, 0.027, 0.022, 0.014, 0.005], 9),
               rays(gold, [(0.016, 0.088), (0.017, 0.095), (-0.017, 0.095), (-0.016, 0.088)], [(0.056, 0.163), (0.040, 0.153), (0.024, 0.142), (0.010, 0.135), (0.0, 0.133), (-0.010, 0.135), (-0.024, 0.142), (-0.040, 0.153), (-0.056, 0.163)]),
               rays(gold, [(0.052, -0.082), (0.056, -0.045), (0.050, 0.005), (0.036, 0.050), (0.026, 0.072)], [(0.066, -0.078), (0.085, -0.058), (0.086, -0.034), (0.080, -0.010), (0.074, 0.014), (0.074, 0.036), (0.070, 0.060), (0.052, 0.084), (0.034, 0.086)]),
               rays(gold, [(-0.046, 0.015), (-0.036, 0.045), (-0.024, 0.066)], [(-0.066, 0.030), (-0.070, 0.052), (-0.062, 0.070), (-0.046, 0.080), (-0.030, 0.080)])]
    for way in (1, -1):
        snapper += [rays(gold, [(way * 0.021, -0.008, -0.086), (way * 0.022, -0.024, -0.082)], [(way * 0.036, -0.006, -0.030), (way * 0.046, -0.018, -0.024), (way * 0.048, -0.030, -0.030), (way * 0.040, -0.038, -0.046), (way * 0.028, -0.034, -0.066)]),
                    rays(gold, [(way * 0.008, -0.047, -0.075), (way * 0.006, -0.049, -0.055)], [(way * 0.022, -0.070, -0.052), (way * 0.020, -0.074, -0.036), (way * 0.010, -0.064, -0.028)])]
    bands = lambda col, u, v: N.mix(col, (0.16, 0.34, 0.50), 0.8 * sum(N.smooth(0.022, 0.012, np.abs(v - b)) for b in (0.26, 0.40, 0.54)) * N.smooth(0.1, 0.16, u))
    add("snapper", snapper, fish_picture((0.52, 0.40, 0.10), (0.72, 0.56, 0.14), (0.72, 0.67, 0.56), bands, 256, 512), (0, 0, 0), 0.38, m_rays, 0.32,
        dict(length=0.31, girth=0.15, pitch=0.0068, eye=(0.100, 0.36), eye_r=0.0088, iris=(0.80, 0.66, 0.34)))
    zs = [-0.062, -0.057, -0.045, -0.026, -0.004, 0.018, 0.036, 0.046]
    damsel = [fish_body(zs, [0.002, 0.012, 0.024, 0.034, 0.037, 0.031, 0.017, 0.009], [0.001, 0.005, 0.009, 0.012, 0.012, 0.009, 0.005, 0.002], 8),
              rays(yellow, [(0.009, 0.040), (0.010, 0.045), (-0.010, 0.045), (-0.009, 0.040)], [(0.029, 0.069), (0.018, 0.063), (0.008, 0.058), (0.0, 0.056), (-0.008, 0.058), (-0.018, 0.063), (-0.029, 0.069)]),
              rays(blue, [(0.033, -0.032), (0.036, -0.008), (0.029, 0.018), (0.016, 0.036)], [(0.043, -0.028), (0.050, -0.014), (0.052, 0.004), (0.054, 0.022), (0.054, 0.040), (0.040, 0.046), (0.024, 0.044)]),
              rays(blue, [(-0.034, 0.000), (-0.028, 0.018), (-0.014, 0.036)], [(-0.046, 0.012), (-0.054, 0.028), (-0.052, 0.042), (-0.036, 0.046), (-0.022, 0.043)])]
    for way in (1, -1):
        damsel += [rays(blue, [(way * 0.0105, -0.001, -0.030), (way * 0.011, -0.011, -0.029)], [(way * 0.020, 0.002, -0.008), (way * 0.025, -0.006, -0.004), (way * 0.024, -0.014, -0.009), (way * 0.017, -0.017, -0.020)]),
                   rays(blue, [(way * 0.004, -0.033, -0.026), (way * 0.003, -0.035, -0.015)], [(way * 0.010, -0.052, -0.010), (way * 0.009, -0.055, 0.000), (way * 0.004, -0.044, 0.000)])]
    tail = lambda col, u, v: N.mix(col, (0.85, 0.66, 0.10), N.smooth(0.72, 0.80, u + 0.25 * (v - 0.4)))
    add("damsel", damsel, fish_picture((0.05, 0.12, 0.36), (0.10, 0.24, 0.58), (0.20, 0.36, 0.62), tail, 128, 256), (0.4, 0, 0), 0.42, m_rays, 0.128,
        dict(length=0.124, girth=0.085, pitch=0.0040, eye=(0.115, 0.36), eye_r=0.0050, iris=(0.45, 0.42, 0.34)))
    fish_swim.swim(g, spines)
    g.save(OUT / "school_fish.glb")


def main():
    turtle()
    ray()
    jellyfish()
    school_fish()


if __name__ == "__main__":
    main()
