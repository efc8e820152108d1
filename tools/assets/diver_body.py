"""The diver's skeleton, body shape, skin weights and suit layout.

Standing A-pose, y up, facing -z, origin at the middle of the hips; right is +x.
Segment lengths: de Leva (1996), J Biomech 29(9), Table 4, male, scaled from
1.741 m to 1.80 m. Every joint's rest rotation is identity.
"""
import numpy as np

import noise as N
import sdf as S

SCALE = 1.80 / 1.741
UPPER, FORE, THIGH, SHANK = (SCALE * v for v in (0.2817, 0.2689, 0.4222, 0.4340))
WAIST, CHEST, NECK = SCALE * 0.1457, SCALE * (0.1457 + 0.2155), SCALE * 0.6033
ARM = np.array([np.sqrt(0.5), -np.sqrt(0.5), 0.0])
SHOULDER, HIP = np.array([0.185, 0.555, 0.005]), np.array([0.090, 0.0, 0.0])
ELBOW, WRIST = SHOULDER + ARM * UPPER, SHOULDER + ARM * (UPPER + FORE)
KNEE, ANKLE = np.array([0.097, -THIGH, 0]), np.array([0.104, -THIGH - SHANK, 0.012])

JOINTS = {
    "pelvis": (None, [0, 0, 0]),
    "abdomen": ("pelvis", [0, WAIST, 0]),
    "thorax": ("abdomen", [0, CHEST, 0]),
    "head": ("thorax", [0, NECK, 0.005]),
}
for _s, _m in (("l", -1), ("r", 1)):
    _f = np.array([_m, 1, 1])
    JOINTS[f"upper_arm_{_s}"] = ("thorax", SHOULDER * _f)
    JOINTS[f"forearm_{_s}"] = (f"upper_arm_{_s}", ELBOW * _f)
    JOINTS[f"hand_{_s}"] = (f"forearm_{_s}", WRIST * _f)
    JOINTS[f"upper_leg_{_s}"] = ("pelvis", HIP * _f)
    JOINTS[f"lower_leg_{_s}"] = (f"upper_leg_{_s}", KNEE * _f)
    JOINTS[f"foot_{_s}"] = (f"lower_leg_{_s}", ANKLE * _f)
NAMES = list(JOINTS)

# Gear has joints of its own, at rest on the segment's (the blade's where the pocket ends): a scale of 0
# hides it inside the body.
GEAR = {
    "tank": ("thorax", CHEST * np.array([0, 1.0, 0])),
    "regulator": ("head", np.array([0, NECK, 0.005])),
    "jacket_pelvis": ("pelvis", np.zeros(3)),
    "jacket_abdomen": ("abdomen", WAIST * np.array([0, 1.0, 0])),
    "jacket_thorax": ("thorax", CHEST * np.array([0, 1.0, 0])),
    "jacket_head": ("head", np.array([0, NECK, 0.005])),
}
for _s, _m in (("l", -1), ("r", 1)):
    _f = np.array([_m, 1, 1])
    GEAR[f"fin_{_s}"] = (f"foot_{_s}", ANKLE * _f)
    GEAR[f"blade_{_s}"] = (f"fin_{_s}", np.array([ANKLE[0] + 0.004, -0.912, -0.165]) * _f)
BOUND = NAMES + list(GEAR)

# height: half width, half depth, centre z
TORSO = np.array(
    [
        (-0.10, 0.130, 0.095, 0.010),
        (-0.03, 0.168, 0.116, 0.008),
        (0.05, 0.172, 0.118, 0.005),
        (0.14, 0.153, 0.108, 0.0),
        (0.24, 0.150, 0.106, -0.002),
        (0.34, 0.163, 0.116, -0.004),
        (0.43, 0.176, 0.122, 0),
        (0.50, 0.176, 0.112, 0.006),
        (0.55, 0.150, 0.092, 0.012),
        (0.60, 0.095, 0.074, 0.015),
    ]
)


def fold(p):
    return np.column_stack([np.abs(p[:, 0]), p[:, 1:]])


def torso(p):
    y = np.clip(p[:, 1], TORSO[0, 0], TORSO[-1, 0])
    a, b, c = (np.interp(y, TORSO[:, 0], TORSO[:, k]) for k in (1, 2, 3))
    q = np.abs(np.column_stack([p[:, 0] / a, (p[:, 2] - c) / b]))
    r = (q**2.35).sum(1) ** (1 / 2.35)
    return np.maximum((r - 1) * np.minimum(a, b), np.abs(p[:, 1] - y) - 0.015)


def arm(p):
    p = fold(p)
    d = S.capsule(p, SHOULDER, ELBOW, 0.057, 0.044)
    d = S.union(d, S.ellipsoid(p, SHOULDER + ARM * 0.03 + [0.012, 0.0, 0], [0.062, 0.068, 0.066]), 0.03)
    d = S.union(
        d,
        S.capsule(p, SHOULDER + ARM * 0.10 + [0, 0, -0.012], ELBOW - ARM * 0.08 + [0, 0, -0.008], 0.044, 0.040),
        0.02,
    )
    d = S.union(d, S.capsule(p, ELBOW, ELBOW + ARM * 0.09, 0.041, 0.0475), 0.02)
    return S.union(d, S.capsule(p, ELBOW + ARM * 0.09, WRIST + ARM * 0.015, 0.046, 0.033), 0.03)


def leg(p):
    p = fold(p)
    d = S.capsule(p, HIP + [0.0, -0.05, 0], KNEE, 0.090, 0.060)
    d = S.union(d, S.capsule(p, HIP + [0.012, -0.10, -0.018], KNEE + [0, 0.13, -0.012], 0.072, 0.058), 0.03)
    d = S.union(d, S.capsule(p, KNEE + [0, 0.03, -0.006], KNEE + [0, -0.05, -0.004], 0.057, 0.053), 0.02)
    d = S.union(d, S.capsule(p, KNEE, ANKLE, 0.055, 0.043), 0.03)
    return S.union(d, S.ellipsoid(p, KNEE + [0.004, -0.135, 0.022], [0.053, 0.125, 0.052]), 0.03)


def boot(p):
    p = fold(p)
    d = S.capsule(p, ANKLE + [0, 0.10, 0.004], ANKLE + [0, 0.0, 0.0], 0.050, 0.047)
    d = S.union(d, S.capsule(p, ANKLE + [0, 0.0, 0.022], ANKLE + [0, 0.002, -0.13], 0.040, 0.034), 0.035)
    return S.union(d, S.capsule(p, ANKLE + [0, 0.01, -0.05], ANKLE + [0.005, -0.004, -0.15], 0.036, 0.030), 0.03)


def head(p):
    d = S.ellipsoid(p, [0, 0.772, 0.002], [0.084, 0.108, 0.106])
    d = S.union(d, S.ellipsoid(p, [0, 0.712, -0.040], [0.060, 0.062, 0.066]), 0.05)
    d = S.union(d, S.capsule(p, [0, 0.755, -0.098], [0, 0.735, -0.108], 0.012, 0.016), 0.02)
    return S.union(d, S.capsule(p, [0, 0.57, 0.018], [0, 0.70, 0.004], 0.074, 0.066), 0.04)


def body(p):
    d = S.union(torso(p), leg(p), 0.05)
    d = S.union(d, S.ellipsoid(fold(p), [0.078, -0.03, 0.060], [0.088, 0.095, 0.075]), 0.05)
    d = S.union(d, S.ellipsoid(fold(p), [0.082, 0.435, -0.075], [0.085, 0.062, 0.050]), 0.04)
    d = S.union(d, S.capsule(fold(p), [0.05, 0.595, 0.02], SHOULDER + [-0.02, 0.02, 0.0], 0.045, 0.05), 0.05)
    d = S.union(d, head(p), 0.05)
    d = S.union(d, arm(p), 0.035)
    return S.union(d, boot(p), 0.02)


def hand(p):
    """Right gloved hand, wrist at 0, fingers along -y, thumb to -z, palm to -x."""
    d = S.rbox(p, [0, -0.050, 0.002], [0.018, 0.048, 0.041], 0.016)
    d = S.union(d, S.capsule(p, [0, 0.035, 0], [0, -0.01, 0], 0.037, 0.033), 0.02)
    for k, ln in enumerate((0.078, 0.086, 0.080, 0.064)):
        z = -0.031 + 0.0215 * k
        mid = [-0.008, -0.095 - ln * 0.5, z * 1.12]
        d = S.union(d, S.capsule(p, [0, -0.088, z], mid, 0.0118, 0.0112), 0.008)
        d = S.union(d, S.capsule(p, mid, [-0.026, -0.095 - ln, z * 1.15], 0.0112, 0.0095), 0.004)
    d = S.union(d, S.capsule(p, [-0.006, -0.025, -0.030], [-0.018, -0.068, -0.062], 0.017, 0.0135), 0.015)
    return S.union(d, S.capsule(p, [-0.018, -0.068, -0.062], [-0.026, -0.098, -0.070], 0.0135, 0.0105), 0.004)


def skin(p, arm_gate=None):
    """Joint indices and weights (four each) for suit points."""
    q, w = fold(p), np.zeros((len(p), 16))
    y = p[:, 1]
    right = N.smooth(-0.015, 0.015, p[:, 0])
    t = (q - SHOULDER) @ ARM
    other = S.union(torso(p), leg(p))
    gate = N.smooth(-0.03, 0.03, other - arm(p)) if arm_gate is None else arm_gate
    a = N.smooth(-0.05, 0.055, t) * gate * (q[:, 0] > 0.1) * (y < 0.66)
    leg_part = N.smooth(0.07, -0.10, y) * (1 - a)
    rest = 1 - a - leg_part
    thorax, abdomen, hd = (
        N.smooth(CHEST - 0.05, CHEST + 0.05, y),
        N.smooth(WAIST - 0.05, WAIST + 0.05, y),
        N.smooth(0.605, 0.695, y),
    )
    col = {n: k for k, n in enumerate(NAMES)}
    w[:, col["head"]] = rest * hd
    w[:, col["thorax"]] = rest * thorax * (1 - hd)
    w[:, col["abdomen"]] = rest * abdomen * (1 - thorax)
    w[:, col["pelvis"]] = rest * (1 - abdomen)
    fore, hnd = N.smooth(UPPER - 0.045, UPPER + 0.045, t), N.smooth(UPPER + FORE - 0.02, UPPER + FORE + 0.02, t)
    low = N.smooth(KNEE[1] + 0.06, KNEE[1] - 0.06, y)
    foot = np.maximum(N.smooth(ANKLE[1] + 0.055, ANKLE[1] - 0.005, y), N.smooth(-0.055, -0.08, p[:, 2]) * (y < -0.75))
    for s, share in (("r", right), ("l", 1 - right)):
        w[:, col[f"upper_arm_{s}"]] = a * share * (1 - fore)
        w[:, col[f"forearm_{s}"]] = a * share * fore * (1 - hnd)
        w[:, col[f"hand_{s}"]] = a * share * fore * hnd
        w[:, col[f"upper_leg_{s}"]] = leg_part * share * (1 - low)
        w[:, col[f"lower_leg_{s}"]] = leg_part * share * low * (1 - foot)
        w[:, col[f"foot_{s}"]] = leg_part * share * low * foot
    return pack(w)


def pack(w):
    j = np.argsort(-w, 1, kind="stable")[:, :4]
    top = np.take_along_axis(w, j, 1)
    top = np.where(top < 0.004, 0, top)
    top /= top.sum(1, keepdims=True)
    return np.where(top > 0, j, 0), top


def rigid(part, name):
    part.joints = np.tile([BOUND.index(name), 0, 0, 0], (len(part.pos), 1))
    part.weights = np.tile([1.0, 0, 0, 0], (len(part.pos), 1))
    return part


# Suit atlas: chart -> pixel rectangle (x, y, w, h) of 1024, with a wrap margin inside
CHARTS = {
    "torso": (0, 0, 640, 420),
    "leg": (0, 424, 400, 600),
    "arm": (410, 424, 270, 420),
    "head": (644, 0, 380, 260),
    "hand": (690, 424, 200, 220),
    "boot": (690, 650, 334, 370),
}
MARGIN = 0.08
SPAN = {
    "torso": (0.70, -0.16),
    "leg": (0.06, ANKLE[1] + 0.03),
    "arm": (-0.07, UPPER + FORE + 0.04),
    "head": (0.90, 0.58),
    "hand": (0.06, -0.20),
    "boot": (ANKLE[1] + 0.16, ANKLE[1] - 0.05),
}


def chart_coords(chart, q):
    """Turns from the front (0 front, .25 outer side) and 0 top .. 1 bottom, for points folded to x > 0."""
    if chart == "arm":
        v, d = (q - SHOULDER) @ ARM, q - SHOULDER
        side = np.column_stack([d[:, 0] * 0.7071 + d[:, 1] * 0.7071, d[:, 2]])
        turn = np.arctan2(side[:, 0], -side[:, 1]) / (2 * np.pi)
    else:
        c = {"torso": [0, 0, 0], "leg": None, "head": [0, 0, 0], "boot": [ANKLE[0], 0, -0.03], "hand": [0, 0, 0]}[
            chart
        ]
        if c is None:
            k = np.clip((q[:, 1] - ANKLE[1]) / (HIP[1] - ANKLE[1]), 0, 1)[:, None]
            c = ANKLE + (HIP - ANKLE) * k
        d = q - c
        turn = np.arctan2(d[:, 0], -d[:, 2]) / (2 * np.pi)
        v = q[:, 1]
    lo, hi = SPAN[chart]
    return turn, (v - lo) / (hi - lo)


def chart_uv(chart, turn, v):
    """Pixel rectangle to texture coordinates; turn 0 sits at the chart's left margin."""
    x, y, w, h = CHARTS[chart]
    u = MARGIN + (turn + 0.5) * (1 - 2 * MARGIN)
    return np.stack([(x + np.clip(u, 0, 1) * w) / 1024, (y + 2 + np.clip(v, 0, 1) * (h - 4)) / 1024], -1)
