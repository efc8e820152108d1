"""The diver's clips: swim and hover with the arms at the sides, cruise and frog in trim with the arms in front.

Conventions: see diver_body.py. A leg swings forward (flexes) with a positive rotation about x; a knee bends with a
negative one; a foot points (fin in line with the shin) with a negative one. All clips run in the upright frame.
"""
import numpy as np

from diver_body import ARM, NAMES
from glb import qmul, quat

x, y, z = (lambda deg, axis=axis: quat(axis, deg) for axis in "xyz")


def unit(v):
    v = np.asarray(v, float)
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def from_matrix(m):
    """Unit quaternions xyzw of rotation matrices [n, 3, 3] that turn by less than half a turn."""
    w = np.sqrt(np.maximum(1 + np.trace(m, axis1=1, axis2=2), 1e-9)) / 2
    v = np.stack([m[:, 2, 1] - m[:, 1, 2], m[:, 0, 2] - m[:, 2, 0], m[:, 1, 0] - m[:, 0, 1]], 1) / (4 * w[:, None])
    return unit(np.column_stack([v, w]))


def reach(side, upper, fore):
    """Rotations of upper arm and forearm that point along upper and fore ([n, 3], right side, thorax frame).

    The elbow bends in the plane of both, so that it is a hinge and the thumb stays on the inner side.
    """
    flip = np.array([1 if side == "r" else -1, 1, 1])
    along, u, f = ARM * flip, unit(upper) * flip, unit(fore) * flip
    hinge, n = np.cross(along, [0, 0, -1.0]), unit(np.cross(u, f))
    bind = np.stack([along, hinge, np.cross(along, hinge)], 1)
    to = np.stack([u, n, np.cross(u, n)], 2)
    bent = np.arccos(np.clip((u * f).sum(1), -1, 1))
    elbow = np.column_stack([hinge * np.sin(bent / 2)[:, None], np.cos(bent / 2)])
    return from_matrix(to @ bind.T), elbow


def curve(at, keys):
    """A smooth closed curve through (phase 0..1, value) at phases `at`: level where it turns round (Fritsch-Carlson)."""
    t, v = np.array(keys, float).T
    t, v = np.concatenate([t[-1:] - 1, t, t[:2] + 1]), np.concatenate([v[-1:], v, v[:2]])
    d = np.diff(v) / np.diff(t)
    m = np.where(d[:-1] * d[1:] > 0, 2 * d[:-1] * d[1:] / np.where(d[:-1] + d[1:] == 0, 1, d[:-1] + d[1:]), 0)
    t, v = t[1:-1], v[1:-1]
    k = np.clip(np.searchsorted(t, at, "right") - 1, 0, len(t) - 2)
    h = t[k + 1] - t[k]
    s = (at - t[k]) / h
    return (
        (1 + 2 * s) * (1 - s) ** 2 * v[k]
        + s * (1 - s) ** 2 * h * m[k]
        + s * s * (3 - 2 * s) * v[k + 1]
        - s * s * (1 - s) * h * m[k + 1]
    )


def swim(ph):
    out = {
        "thorax": qmul(x(6 + 0 * ph), y(2.5 * np.sin(ph))),
        "abdomen": y(2 * np.sin(ph + 0.4)),
        "pelvis": y(-3 * np.sin(ph)),
        "head": x(34 + 1.5 * np.sin(2 * ph)),
    }
    for s, sign in (("r", 1), ("l", -1)):
        k = ph if s == "r" else ph + np.pi
        out[f"upper_leg_{s}"] = qmul(z(sign * 2 + 0 * k), x(2 + 25 * np.sin(k)))
        out[f"lower_leg_{s}"] = x(-18 - 16 * np.sin(k - 1.0))
        out[f"foot_{s}"] = x(-62 + 20 * np.sin(k - 1.9))
        out[f"upper_arm_{s}"] = qmul(x(-14 + 2 * np.sin(k)), z(-sign * (31 + 1.5 * np.sin(2 * ph))))
        out[f"forearm_{s}"] = qmul(x(10 + 0 * k), z(-sign * (4 + 0 * k)))
        out[f"hand_{s}"] = z(-sign * (4 + 0 * k))
    return out


def hover(ph):
    out = {"thorax": x(3 + 1.5 * np.sin(ph)), "head": x(8 + 2 * np.sin(ph + 0.8))}
    for s, sign in (("r", 1), ("l", -1)):
        k = ph if s == "r" else ph + np.pi
        out[f"upper_leg_{s}"] = qmul(z(sign * 5 + 0 * k), x(22 + 7 * np.sin(k)))
        out[f"lower_leg_{s}"] = x(-55 - 8 * np.sin(k - 0.9))
        out[f"foot_{s}"] = x(-38 + 9 * np.sin(k - 1.7))
        out[f"upper_arm_{s}"] = qmul(x(28 + 4 * np.sin(ph + 0.5)), z(-sign * (18 + 3 * np.sin(ph))))
        out[f"forearm_{s}"] = qmul(x(62 + 5 * np.sin(ph + 1.0)), z(-sign * (14 + 0 * k)))
        out[f"hand_{s}"] = x(6 * np.sin(ph + 1.6))
    return out


def cruise(ph):
    """A flutter kick from bent knees; the arms lie folded under the chest, the left hand over the right wrist."""
    out = {
        "thorax": qmul(x(8 + 0.8 * np.sin(2 * ph)), y(1.8 * np.sin(ph))),
        "abdomen": y(1.5 * np.sin(ph + 0.4)),
        "pelvis": y(-2 * np.sin(ph)),
        "head": qmul(x(36 + 1.5 * np.sin(2 * ph)), y(5 * np.sin(ph - 0.6))),
    }
    sway = 0.03 * np.sin(2 * ph + 0.7)
    for s, sign in (("r", 1), ("l", -1)):
        k = ph if s == "r" else ph + np.pi
        out[f"upper_leg_{s}"] = qmul(z(sign * 4 + 0 * k), x(-4 + 15 * np.sin(k)))
        out[f"lower_leg_{s}"] = x(-34 - 17 * np.sin(k - 1.1))
        out[f"foot_{s}"] = x(-46 + 19 * np.sin(k - 1.9))
        low = 0.0 if s == "r" else 0.10
        upper = np.stack([0.46 + 0 * ph, -0.34 - low + sway, -0.80 + 0 * ph], 1)
        fore = np.stack([-0.80 + 0 * ph, 0.42 - 0.5 * low + sway, -0.42 - 2 * low + 0 * ph], 1)
        out[f"upper_arm_{s}"], out[f"forearm_{s}"] = reach(s, upper, fore)
        out[f"hand_{s}"] = x(8 + 3 * np.sin(ph))
    return out


def frog(ph):
    """A frog kick from trim: knees bent by 90 degrees with level fins, out, together, a short glide on legs that never
    quite stretch; the hands meet ahead. The left leg is a little late and bends less: nobody kicks alike on both sides.
    """
    late = lambda s: 0.018 if s == "l" else 0.0
    on = lambda s, *keys: curve((ph / (2 * np.pi) - late(s)) % 1.0, keys)
    hip = lambda s: on(s, (0.0, 12), (0.16, 6), (0.32, -3), (0.45, -5), (0.58, -3), (0.72, 6), (0.86, 11))
    spread = lambda s: on(s, (0.0, 12), (0.16, 25), (0.32, 13), (0.43, 3), (0.60, 3), (0.80, 8))
    toe_out = lambda s: on(s, (0.0, 36), (0.16, 52), (0.32, 20), (0.43, 5), (0.60, 6), (0.80, 20))
    knee = lambda s: on(s, (0.0, -97), (0.16, -68), (0.32, -36), (0.43, -27), (0.56, -34), (0.74, -84))
    ankle = lambda s: on(s, (0.0, 4), (0.16, 0), (0.32, -30), (0.43, -52), (0.58, -46), (0.76, -8))
    out = {
        "thorax": x(7 + 1.5 * np.sin(ph)),
        "abdomen": x(3 + 1.0 * np.sin(ph + 0.5)),
        "head": qmul(x(38 + 2 * np.sin(ph + 0.4)), y(6 * np.sin(ph + 2.0))),
    }
    sway = 0.04 * np.sin(ph + 0.9)
    for s, sign in (("r", 1), ("l", -1)):
        bent = 1.0 if s == "r" else 0.92
        out[f"upper_leg_{s}"] = qmul(z(sign * spread(s)), x(hip(s)))
        out[f"lower_leg_{s}"] = qmul(x(bent * knee(s)), y(-sign * 0.35 * toe_out(s)))
        out[f"foot_{s}"] = qmul(y(-sign * 0.65 * toe_out(s)), x(ankle(s)))
        upper = np.stack([0.44 + 0 * ph, 0.14 + sway, -0.89 + 0 * ph], 1)
        fore = np.stack([-0.66 + 0 * ph, 0.70 + 0.5 * sway, -0.20 + 0 * ph], 1)
        out[f"upper_arm_{s}"], out[f"forearm_{s}"] = reach(s, upper, fore)
        out[f"hand_{s}"] = z(-sign * (8 + 0 * ph))
    return out


def clips(g, node):
    """Adds all clips to a Glb whose nodes are given by name; each loops exactly."""

    def clip(name, seconds, keys, make, root):
        t = np.linspace(0, seconds, keys)
        ph = t / seconds * 2 * np.pi
        rot = {n: np.tile([0.0, 0, 0, 1], (keys, 1)) for n in NAMES}
        rot.update({n: np.broadcast_to(q, (keys, 4)).copy() for n, q in make(ph).items()})
        tracks = [(node[n], "rotation", rot[n]) for n in NAMES]
        tracks.append((node["pelvis"], "translation", root(ph)))
        g.animation(name, t, tracks)

    bob = lambda amp: (lambda ph: np.column_stack([0 * ph, 0 * ph, amp * np.sin(2 * ph)]))
    still = lambda amp: (lambda ph: np.column_stack([0 * ph, amp * np.sin(2 * ph), 0 * ph]))
    surge = lambda ph: np.column_stack([0 * ph, 0.05 * np.sin(ph - 2.0), 0.008 * np.sin(ph)])  # forward with each kick
    clip("swim", 2.0, 41, swim, bob(0.012))
    clip("hover", 4.0, 41, hover, still(0.012))
    clip("cruise", 2.2, 41, cruise, bob(0.008))
    clip("frog", 3.4, 61, frog, surge)
