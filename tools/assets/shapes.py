"""Primitive shapes as Parts: boxes, turned profiles, tubes, fins, rings (see mesh.py)."""
import numpy as np

from mesh import loft


def circle(n, rx=1.0, ry=None, start=0.0):
    t = np.arange(n) / n * 2 * np.pi + np.radians(start)
    return np.stack([np.cos(t) * rx, np.sin(t) * (rx if ry is None else ry)], 1)


def round_rect(w, h, r, seg=3):
    """Corner-rounded rectangle, counter-clockwise, centred."""
    out = []
    for cx, cy, a0 in ((1, 1, 0), (-1, 1, 90), (-1, -1, 180), (1, -1, 270)):
        t = np.radians(a0 + np.linspace(0, 90, seg + 1))
        out.append(np.stack([cx * (w / 2 - r) + r * np.cos(t), cy * (h / 2 - r) + r * np.sin(t)], 1))
    return np.concatenate(out)


def box(w, h, d, r=None, seg=2):
    """Box with rounded edges of radius r, centred."""
    r = min(w, h, d) * 0.12 if r is None else min(r, min(w, h, d) * 0.49)
    rings = []
    for z, inset in (
        (-d / 2, r),
        (-d / 2 + 0.3 * r, 0.3 * r),
        (-d / 2 + r, 0),
        (d / 2 - r, 0),
        (d / 2 - 0.3 * r, 0.3 * r),
        (d / 2, r),
    ):
        xy = round_rect(w - 2 * inset, h - 2 * inset, max(r - inset, r * 0.25), seg)
        rings.append(np.column_stack([xy, np.full(len(xy), z)]))
    return loft(rings)


def revolve(profile, n=24, caps=(True, True)):
    """Profile of (radius, z) pairs turned about z."""
    c = circle(n)
    rings = [np.column_stack([c * max(r, 1e-6), np.full(n, z)]) for r, z in profile]
    return loft(rings, caps)


def cylinder(r, length, n=20, bevel=None, r2=None):
    b = min(r, length) * 0.1 if bevel is None else bevel
    r2 = r if r2 is None else r2
    return revolve([(r - b, -length / 2), (r, -length / 2 + b), (r2, length / 2 - b), (r2 - b, length / 2)], n)


def sphere(r, n=16, m=10):
    t = np.linspace(0.001, np.pi - 0.001, m + 1)
    return revolve([(r * np.sin(a), -r * np.cos(a)) for a in t], n, (False, False))


def frames(path):
    """Parallel-transported tangent, normal, binormal along a polyline."""
    p = np.asarray(path, float)
    t = np.gradient(p, axis=0)
    t /= np.linalg.norm(t, axis=1, keepdims=True) + 1e-12
    ref = np.eye(3)[np.argmin(np.abs(t[0]))]
    n = [np.cross(t[0], ref)]
    n[0] /= np.linalg.norm(n[0])
    for k in range(1, len(p)):
        v = n[-1] - t[k] * np.dot(n[-1], t[k])
        n.append(v / np.linalg.norm(v))
    n = np.array(n)
    return t, n, np.cross(t, n)


def tube(path, radius, n=8, caps=(True, True), flat=1.0):
    """Round bar along a polyline; radius may vary; flat squashes one axis."""
    p = np.asarray(path, float)
    _, u, v = frames(p)
    c = circle(n)
    r = np.broadcast_to(np.asarray(radius, float), (len(p),))
    rings = [p[k] + r[k] * (c[:, :1] * u[k] + c[:, 1:] * v[k] * flat) for k in range(len(p))]
    return loft(rings, caps)


def curve(points, samples=24):
    """Catmull-Rom through the points."""
    p = np.asarray(points, float)
    q = np.concatenate([[2 * p[0] - p[1]], p, [2 * p[-1] - p[-2]]])
    out = []
    for s in np.linspace(0, len(p) - 1, samples):
        i = min(int(s), len(p) - 2)
        t, (a, b, c, d) = s - i, q[i : i + 4]
        out.append(
            0.5 * (2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t**2 + (3 * b - a - 3 * c + d) * t**3)
        )
    return np.array(out)


def torus(R, r, n=24, m=10):
    """Ring about z."""
    t = np.arange(n) / n * 2 * np.pi
    c = circle(m, r)
    rings = [np.column_stack([(R + c[:, 0]) * np.cos(a), (R + c[:, 0]) * np.sin(a), c[:, 1]]) for a in t]
    return loft(rings + rings[:1], (False, False))


def ring_band(r_in, r_out, length, n=32, bevel=0.15):
    """A thick duct about z: outer wall, lips, inner wall."""
    b = (r_out - r_in) * bevel * 2
    prof = [
        (r_in, -length / 2 + b),
        (r_in + b, -length / 2),
        (r_out - b, -length / 2),
        (r_out, -length / 2 + b),
        (r_out, length / 2 - b),
        (r_out - b, length / 2),
        (r_in + b, length / 2),
        (r_in, length / 2 - b),
    ]
    return revolve(prof + prof[:1], n, (False, False))


def foil(sections, n=10):
    """A fin: sections of (leading xyz, trailing xyz, thickness, thickness axis)."""
    s = (1 - np.cos(np.linspace(0, np.pi, n))) / 2
    half = 2.6 * (0.2969 * np.sqrt(s) - 0.126 * s - 0.3516 * s**2 + 0.2843 * s**3 - 0.1036 * s**4)
    rings = []
    for lead, trail, thick, axis in sections:
        lead, trail, axis = (np.asarray(a, float) for a in (lead, trail, axis))
        line = lead + (trail - lead) * s[:, None]
        up, down = line + axis * (half * thick)[:, None], line - axis * (half * thick)[:, None]
        rings.append(np.concatenate([up, down[-2:0:-1]]))
    return loft(rings)


def icosphere(level):
    g = (1 + 5**0.5) / 2
    v = np.array(
        [
            (-1, g, 0),
            (1, g, 0),
            (-1, -g, 0),
            (1, -g, 0),
            (0, -1, g),
            (0, 1, g),
            (0, -1, -g),
            (0, 1, -g),
            (g, 0, -1),
            (g, 0, 1),
            (-g, 0, -1),
            (-g, 0, 1),
        ],
        float,
    )
    f = np.array(
        [
            (0, 11, 5),
            (0, 5, 1),
            (0, 1, 7),
            (0, 7, 10),
            (0, 10, 11),
            (1, 5, 9),
            (5, 11, 4),
            (11, 10, 2),
            (10, 7, 6),
            (7, 1, 8),
            (3, 9, 4),
            (3, 4, 2),
            (3, 2, 6),
            (3, 6, 8),
            (3, 8, 9),
            (4, 9, 5),
            (2, 4, 11),
            (6, 2, 10),
            (8, 6, 7),
            (9, 8, 1),
        ]
    )
    for _ in range(level):
        e = np.sort(np.concatenate([f[:, [0, 1]], f[:, [1, 2]], f[:, [2, 0]]]), 1)
        u, inv = np.unique(e, axis=0, return_inverse=True)
        m = inv.reshape(3, -1) + len(v)
        v = np.concatenate([v, v[u].mean(1)])
        f = np.concatenate(
            [
                np.stack([f[:, 0], m[0], m[2]], 1),
                np.stack([f[:, 1], m[1], m[0]], 1),
                np.stack([f[:, 2], m[2], m[1]], 1),
                m.T,
            ]
        )
    v /= np.linalg.norm(v, axis=1, keepdims=True)
    return v, f
