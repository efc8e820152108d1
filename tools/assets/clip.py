"""Cutting a Part along the zero line of a per-vertex field, and its open rims."""
import numpy as np

from mesh import Part


def clip(part, f):
    """Keeps f > 0. Returns the part and, per vertex, the clipped field (0 on the cut)."""
    pos, uv, col = list(part.pos), list(part.uv), None if part.col is None else list(part.col)
    field, cut, tris = list(f), {}, []

    def cross(a, b):
        key = (min(a, b), max(a, b))
        if key not in cut:
            i, j = key
            t = f[i] / (f[i] - f[j])
            pos.append(part.pos[i] + (part.pos[j] - part.pos[i]) * t)
            uv.append(part.uv[i] + (part.uv[j] - part.uv[i]) * t)
            if col is not None:
                col.append(part.col[i] + (part.col[j] - part.col[i]) * t)
            field.append(0.0)
            cut[key] = len(pos) - 1
        return cut[key]

    inside = f[part.tri] > 0
    whole = inside.all(1)
    tris.extend(part.tri[whole].tolist())
    for tri, ins in zip(part.tri[~whole & inside.any(1)], inside[~whole & inside.any(1)]):
        poly = []
        for k in range(3):
            a, b = tri[k], tri[(k + 1) % 3]
            if ins[k]:
                poly.append(a)
            if ins[k] != ins[(k + 1) % 3]:
                poly.append(cross(a, b))
        tris.extend([poly[0], poly[i], poly[i + 1]] for i in range(1, len(poly) - 1))
    tris = np.array(tris)
    used, inv = np.unique(tris, return_inverse=True)
    out = Part(
        np.array(pos)[used], inv.reshape(-1, 3), np.array(uv)[used], col=None if col is None else np.array(col)[used]
    )
    return out, np.array(field)[used]


def rim(part, on_cut, offset):
    """The wall between the cut edge and the same edge moved by offset [n, 3]."""
    e = np.concatenate([part.tri[:, [0, 1]], part.tri[:, [1, 2]], part.tri[:, [2, 0]]])
    e = e[on_cut[e].all(1)]
    key = np.sort(e, 1)
    _, idx, n = np.unique(key, axis=0, return_index=True, return_counts=True)
    e = e[idx[n == 1]]
    a, b = part.pos[e[:, 0]], part.pos[e[:, 1]]
    c, d = b + offset[e[:, 1]], a + offset[e[:, 0]]
    pos = np.stack([a, b, c, d], 1).reshape(-1, 3)
    base = np.arange(len(e))[:, None] * 4
    # reversed against the skin's own edge direction
    tri = np.concatenate([base + [1, 0, 3], base + [1, 3, 2]])
    # Across the wall by the offset's length; along it by the coordinate that changes most.
    along, across = np.repeat(np.abs(b - a).argmax(1), 4), np.linalg.norm(offset, axis=1)
    depth = np.stack([0 * across[e[:, 1]], 0 * across[e[:, 0]], across[e[:, 1]], across[e[:, 0]]], 1).reshape(-1)
    uv = np.stack([np.take_along_axis(pos, along[:, None], 1)[:, 0], depth], 1)
    return Part(pos, tri, uv)
