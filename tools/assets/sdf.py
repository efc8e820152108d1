"""Signed distance modelling: blobs blended smoothly, meshed by surface nets.

A field takes points [n, 3] and returns distance in metres, negative inside.
"""
import numpy as np

from mesh import Part


def capsule(p, a, b, ra, rb):
    """Round bar from a to b with radius running from ra to rb."""
    a, b = np.asarray(a, float), np.asarray(b, float)
    ab = b - a
    t = np.clip((p - a) @ ab / (ab @ ab), 0, 1)
    return np.linalg.norm(p - a - t[:, None] * ab, axis=1) - (ra + (rb - ra) * t)


def ellipsoid(p, c, r):
    r = np.asarray(r, float)
    q = (p - np.asarray(c, float)) / r
    k0 = np.linalg.norm(q, axis=1)
    k1 = np.linalg.norm(q / r, axis=1)
    return k0 * (k0 - 1) / np.maximum(k1, 1e-9)


def rbox(p, c, half, r):
    q = np.abs(p - np.asarray(c, float)) - (np.asarray(half, float) - r)
    return np.linalg.norm(np.maximum(q, 0), axis=1) + np.minimum(q.max(1), 0) - r


def union(a, b, k=0.0):
    """Smooth minimum with blend width k (m)."""
    if k <= 0:
        return np.minimum(a, b)
    h = np.maximum(k - np.abs(a - b), 0) / k
    return np.minimum(a, b) - h * h * k * 0.25


def both(a, b, k=0.0):
    return -union(-a, -b, k)


def surface_nets(field, lo, hi, h):
    """Mesh of field = 0 inside the box, one vertex per crossed cell of size h."""
    lo, hi = np.asarray(lo, float), np.asarray(hi, float)
    n = np.ceil((hi - lo) / h).astype(int) + 1
    ax = [lo[k] + h * np.arange(n[k]) for k in range(3)]
    grid = np.stack(np.meshgrid(*ax, indexing="ij"), -1).reshape(-1, 3)
    f = np.concatenate([field(c) for c in np.array_split(grid, max(1, len(grid) // 400000))]).reshape(n)
    inside = f < 0
    cells = n - 1
    total = np.zeros(tuple(cells) + (3,))
    count = np.zeros(cells)
    corner = np.stack(np.meshgrid(*[np.arange(c) for c in cells], indexing="ij"), -1)
    for axis in range(3):
        o1, o2 = [k for k in range(3) if k != axis]
        for d1 in (0, 1):
            for d2 in (0, 1):
                s0 = [0, 0, 0]
                s0[o1], s0[o2] = d1, d2
                s1 = list(s0)
                s1[axis] = 1
                sl = lambda s: tuple(slice(s[k], s[k] + cells[k]) for k in range(3))
                a, b = f[sl(s0)], f[sl(s1)]
                x = (a < 0) != (b < 0)
                t = np.where(x, a / np.where(x, a - b, 1), 0)
                pt = corner + np.array(s0, float)
                pt[..., axis] += t
                total += pt * x[..., None]
                count += x
    live = count > 0
    ids = np.full(cells, -1)
    ids[live] = np.arange(live.sum())
    pos = lo + h * total[live] / count[live][:, None]
    quads = []
    for axis in range(3):
        o1, o2 = (axis + 1) % 3, (axis + 2) % 3
        s0 = tuple(slice(1, cells[k]) if k != axis else slice(0, cells[k]) for k in range(3))
        s1 = tuple(slice(1, cells[k]) if k != axis else slice(1, cells[k] + 1) for k in range(3))
        a, b = inside[s0], inside[s1]
        idx = np.argwhere(a != b)
        out = a[a != b]
        idx[:, [o1, o2]] += 1
        c = [idx.copy() for _ in range(4)]
        c[0][:, o1] -= 1
        c[0][:, o2] -= 1
        c[1][:, o2] -= 1
        c[3][:, o1] -= 1
        q = np.stack([ids[tuple(v.T)] for v in c], 1)
        q[~out] = q[~out][:, ::-1]
        quads.append(q)
    q = np.concatenate(quads)
    for _ in range(2):
        g = gradient(field, pos, h * 0.1)
        step = np.clip(field(pos), -0.5 * h, 0.5 * h)
        pos = pos - g * step[:, None]
    # cut each quad along its shorter diagonal
    d1 = np.linalg.norm(pos[q[:, 0]] - pos[q[:, 2]], axis=1)
    d2 = np.linalg.norm(pos[q[:, 1]] - pos[q[:, 3]], axis=1)
    s = (d1 <= d2)[:, None]
    tri = np.concatenate(
        [np.where(s, q[:, [0, 1, 2]], q[:, [0, 1, 3]]), np.where(s, q[:, [0, 2, 3]], q[:, [1, 2, 3]])]
    )
    return Part(pos, tri, nrm=gradient(field, pos, h * 0.25))


def gradient(field, pos, e):
    g = np.stack([field(pos + e * d) - field(pos - e * d) for d in np.eye(3)], 1)
    return g / (np.linalg.norm(g, axis=1, keepdims=True) + 1e-12)
