"""Flat plates cut from an outline with holes, by ear clipping."""
import numpy as np

from mesh import join, Part


def area(p):
    x, y = p[:, 0], p[:, 1]
    return 0.5 * np.sum(x * np.roll(y, -1) - y * np.roll(x, -1))


def bridge(outer, holes):
    """One loop: each hole is joined to the outline by its nearest visible vertex pair."""
    loop = outer if area(outer) > 0 else outer[::-1]
    for h in sorted(holes, key=lambda q: -q[:, 0].max()):
        h = h if area(h) < 0 else h[::-1]
        i = int(np.argmax(h[:, 0]))
        d = np.linalg.norm(loop - h[i], axis=1) + 10 * (loop[:, 0] < h[i, 0])
        for j in np.argsort(d):
            if clear(h[i], loop[j], [loop] + holes):
                break
        loop = np.concatenate([loop[: j + 1], h[i:], h[: i + 1], loop[j:]])
    return loop


def clear(a, b, loops):
    """No edge of the loops crosses the open segment a-b."""
    for p in loops:
        q = np.roll(p, -1, 0)
        side = lambda u, v, w: (v[..., 0] - u[..., 0]) * (w[..., 1] - u[..., 1]) - (v[..., 1] - u[..., 1]) * (
            w[..., 0] - u[..., 0]
        )
        d1, d2, d3, d4 = (
            side(p, q, a[None]),
            side(p, q, b[None]),
            side(a[None], b[None], p),
            side(a[None], b[None], q),
        )
        if ((d1 * d2 < -1e-15) & (d3 * d4 < -1e-15)).any():
            return False
    return True


def earclip(p):
    idx, tris = list(range(len(p))), []
    cross = lambda a, b, c: (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    while len(idx) > 3:
        best = None
        for k in range(len(idx)):
            i, j, l = idx[k - 1], idx[k], idx[(k + 1) % len(idx)]
            a, b, c = p[i], p[j], p[l]
            turn = cross(a, b, c)
            if turn <= 1e-14:
                continue
            q = p[[m for m in idx if m not in (i, j, l)]]
            q = q[~((q == a).all(1) | (q == b).all(1) | (q == c).all(1))]
            s = lambda u, v: (v[0] - u[0]) * (q[:, 1] - u[1]) - (v[1] - u[1]) * (q[:, 0] - u[0])
            if ((s(a, b) >= 0) & (s(b, c) >= 0) & (s(c, a) >= 0)).any():
                continue
            shape = turn / (np.sum((c - a) ** 2) + 1e-12)
            if best is None or shape > best[0]:
                best = (shape, k, (i, j, l))
        if best is None:
            break
        tris.append(best[2])
        idx.pop(best[1])
    return np.array(tris + [tuple(idx)])


def plate(outer, holes, thick):
    """Plate in the xy plane, z from -thick/2 to thick/2."""
    loop = bridge(outer, holes)
    tri = earclip(loop)
    z = np.full((len(loop), 1), thick / 2)
    front = Part(np.hstack([loop, z]), tri, loop)
    back = Part(np.hstack([loop, -z]), tri[:, ::-1], loop)
    walls = []
    for q, ccw in [(outer, True)] + [(h, False) for h in holes]:
        q = q if (area(q) > 0) == ccw else q[::-1]
        q = np.concatenate([q, q[:1]])
        n = len(q)
        pos = np.concatenate(
            [np.hstack([q, np.full((n, 1), thick / 2)]), np.hstack([q, np.full((n, 1), -thick / 2)])]
        )
        s = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(q, axis=0), axis=1))])
        uv = np.concatenate([np.stack([s, 0 * s], 1), np.stack([s, 0 * s + thick], 1)])
        i = np.arange(n - 1)
        walls.append(
            Part(pos, np.concatenate([np.stack([i, i + n, i + n + 1], 1), np.stack([i, i + n + 1, i + 1], 1)]), uv)
        )
    return join([front, back] + walls)


def fillet(points, radius, seg=4):
    """Rounds each corner of a polygon; radius may be one value or one per corner."""
    p = np.asarray(points, float)
    r = np.broadcast_to(radius, (len(p),))
    out = []
    for k in range(len(p)):
        a, b, c = p[k - 1], p[k], p[(k + 1) % len(p)]
        u, v = (a - b) / np.linalg.norm(a - b), (c - b) / np.linalg.norm(c - b)
        d = min(r[k], 0.45 * np.linalg.norm(a - b), 0.45 * np.linalg.norm(c - b))
        for t in np.linspace(0, 1, seg + 1):
            out.append((1 - t) ** 2 * (b + u * d) + 2 * t * (1 - t) * b + t * t * (b + v * d))
    return np.array(out)
