"""Meshes as arrays: primitives, joins, normals and tangents.

Axes: x right, y up, -z forward, metres. Triangles wind counter-clockwise seen
from outside. A Part is one material's triangles; uv is in metres until a
caller scales it by its texture's tile size.
"""
import numpy as np


class Part:
    """Triangles with per-vertex attributes; nrm is None until shade()."""

    def __init__(self, pos, tri, uv=None, nrm=None, col=None, joints=None, weights=None):
        self.pos = np.asarray(pos, float).reshape(-1, 3)
        self.tri = np.asarray(tri, int).reshape(-1, 3)
        self.uv = np.zeros((len(self.pos), 2)) if uv is None else np.asarray(uv, float)
        self.nrm, self.col, self.joints, self.weights = nrm, col, joints, weights

    def copy(self):
        c = lambda a: None if a is None else a.copy()
        return Part(c(self.pos), c(self.tri), c(self.uv), c(self.nrm), c(self.col), c(self.joints), c(self.weights))

    def map(self, f):
        out = self.copy()
        out.pos = np.asarray(f(out.pos), float)
        return out

    def at(self, x=0, y=0, z=0):
        return self.map(lambda p: p + np.array([x, y, z], float))

    def rot(self, axis, deg):
        r = rotation(axis, deg)
        out = self.map(lambda p: p @ r.T)
        if out.nrm is not None:
            out.nrm = out.nrm @ r.T
        return out

    def scaled(self, sx, sy=None, sz=None):
        s = np.array([sx, sx if sy is None else sy, sx if sz is None else sz], float)
        out = self.map(lambda p: p * s)
        if np.prod(s) < 0:
            out.tri = out.tri[:, ::-1]
        return out

    def mirrored(self):
        """The copy across x = 0, still facing outward."""
        out = self.scaled(-1, 1, 1)
        if out.nrm is not None:
            out.nrm = out.nrm * np.array([-1, 1, 1])
        return out

    def flipped(self):
        out = self.copy()
        out.tri = out.tri[:, ::-1]
        return out

    def tiled(self, metres):
        out = self.copy()
        out.uv = out.uv / metres
        return out

    def colored(self, rgb):
        out = self.copy()
        out.col = np.tile(np.append(np.asarray(rgb, float), 1.0), (len(out.pos), 1))
        return out


def rotation(axis, deg):
    a = np.radians(deg)
    c, s = np.cos(a), np.sin(a)
    return {
        "x": np.array([[1, 0, 0], [0, c, -s], [0, s, c]]),
        "y": np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]),
        "z": np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]),
    }[axis]


def join(parts):
    parts = [p for p in parts if p is not None and len(p.tri)]
    start = np.cumsum([0] + [len(p.pos) for p in parts])

    def stack(name, width, fill):
        if all(getattr(p, name) is None for p in parts):
            return None
        return np.concatenate(
            [np.full((len(p.pos), width), fill) if getattr(p, name) is None else getattr(p, name) for p in parts]
        )

    if any(p.nrm is None for p in parts) and not all(p.nrm is None for p in parts):
        parts = [p if p.nrm is not None else shade(p) for p in parts]
        start = np.cumsum([0] + [len(p.pos) for p in parts])
    return Part(
        np.concatenate([p.pos for p in parts]),
        np.concatenate([p.tri + s for p, s in zip(parts, start)]),
        np.concatenate([p.uv for p in parts]),
        stack("nrm", 3, 0.0),
        stack("col", 4, 1.0),
        stack("joints", 4, 0),
        stack("weights", 4, 0.0),
    )


def volume(part):
    """Signed volume: positive when a closed part faces outward."""
    c = part.pos.mean(0)
    a, b, d = (part.pos[part.tri[:, i]] - c for i in range(3))
    return np.einsum("ij,ij->i", a, np.cross(b, d)).sum() / 6


def outward(part):
    return part if volume(part) >= 0 else part.flipped()


def loft(rings, caps=(True, True), wrap=True, orient=True, uv_scale=1.0):
    """Skin over k rings of n points (closed around when wrap); uv in metres."""
    r = np.asarray(rings, float)
    if wrap:
        r = np.concatenate([r, r[:, :1]], 1)
    k, n = r.shape[:2]
    around = np.concatenate([np.zeros((k, 1)), np.cumsum(np.linalg.norm(np.diff(r, axis=1), axis=2), 1)], 1)
    around = np.tile(around[np.argmax(around[:, -1])], (k, 1))
    mid = r.mean(1)
    along = np.concatenate(
        [
            [0],
            np.cumsum(
                np.maximum(np.linalg.norm(np.diff(mid, axis=0), axis=1), np.abs(np.diff(r, axis=0)).max((1, 2)) * 0.5)
            ),
        ]
    )
    uv = np.stack([around, np.tile(along[:, None], (1, n))], 2).reshape(-1, 2)
    i, j = np.meshgrid(np.arange(k - 1), np.arange(n - 1), indexing="ij")
    a = (i * n + j).ravel()
    b, c, d = a + 1, a + n + 1, a + n
    parts = [Part(r.reshape(-1, 3), np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)]), uv * uv_scale)]
    for end, on in zip((0, -1), caps):
        if on:
            ring = r[end, :-1] if wrap else r[end]
            fan = disc(ring, uv_scale)
            parts.append(fan.flipped() if end == 0 else fan)
    out = join(parts)
    out = drop_degenerate(out)
    return outward(out) if orient else out


def disc(ring, uv_scale=1.0):
    """A flat-ish cap: a fan about the ring's centre."""
    m, c = len(ring), ring.mean(0)
    t = np.stack([np.full(m, m), np.arange(m), (np.arange(m) + 1) % m], 1)
    pos = np.concatenate([ring, c[None]])
    flat = pos - c
    keep = np.argsort(np.ptp(flat, axis=0))[1:]
    return Part(pos, t, flat[:, np.sort(keep)] * uv_scale)


def drop_degenerate(part, area=1e-12):
    a, b, c = (part.pos[part.tri[:, i]] for i in range(3))
    keep = np.linalg.norm(np.cross(b - a, c - a), axis=1) > area
    out = part.copy()
    out.tri = out.tri[keep]
    return out


def box_uv(part, tile, calm=0):
    """Cube projection: every triangle on its own axis plane, vertices split.

    calm: how often facing is averaged with neighbours, so that rough surfaces are not cut into splinters.
    """
    pos = part.pos[part.tri]
    n = np.cross(pos[:, 1] - pos[:, 0], pos[:, 2] - pos[:, 0])
    if calm:
        _, weld = np.unique(np.round(part.pos, 5), axis=0, return_inverse=True)
        corner = weld[part.tri]
        for _ in range(calm):
            at = np.stack([np.bincount(corner.ravel(), np.repeat(n[:, k], 3)) for k in range(3)], 1)
            n = at[corner].sum(1)
            n /= np.linalg.norm(n, axis=1, keepdims=True) + 1e-15
    ax = np.argmax(np.abs(n), 1)
    pick = np.array([[2, 1], [0, 2], [0, 1]])[ax]
    uv = np.take_along_axis(pos, pick[:, None, :].repeat(3, 1), 2) / tile
    flip = np.sign(n[np.arange(len(n)), ax])
    uv[:, :, 0] *= flip[:, None]
    uv[:, :, 1] *= -1
    ids = part.tri.ravel()
    key = np.column_stack([ids, np.repeat(ax * 2 + (flip > 0), 3)])
    _, pick, inv = np.unique(key, axis=0, return_index=True, return_inverse=True)
    out = Part(pos.reshape(-1, 3)[pick], inv.reshape(-1, 3), uv.reshape(-1, 2)[pick])
    for name in ("nrm", "col", "joints", "weights"):
        if getattr(part, name) is not None:
            setattr(out, name, getattr(part, name)[ids[pick]])
    return out


def shade(part, crease=40.0):
    """Angle-weighted normals, split where faces meet sharper than crease."""
    part = drop_degenerate(part)
    _, weld = np.unique(np.round(part.pos, 5), axis=0, return_inverse=True)
    p = part.pos[part.tri]
    fn = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
    fn /= np.linalg.norm(fn, axis=1, keepdims=True)
    ang = []
    for i in range(3):
        a, b = p[:, (i + 1) % 3] - p[:, i], p[:, (i + 2) % 3] - p[:, i]
        cosv = (a * b).sum(1) / (np.linalg.norm(a, axis=1) * np.linalg.norm(b, axis=1) + 1e-15)
        ang.append(np.arccos(np.clip(cosv, -1, 1)))
    w = np.stack(ang, 1).ravel()
    vid = weld[part.tri].ravel()
    order = np.argsort(vid, kind="stable")
    _, first, count = np.unique(vid[order], return_index=True, return_counts=True)
    reps = np.repeat(count, count)
    a = np.repeat(np.arange(len(order)), reps)
    base = np.repeat(np.repeat(first, count), reps)
    off = np.arange(len(a)) - np.repeat(np.concatenate([[0], np.cumsum(reps)[:-1]]), reps)
    ca, cb = order[a], order[base + off]
    near = (fn[ca // 3] * fn[cb // 3]).sum(1) > np.cos(np.radians(crease))
    ca, cb = ca[near], cb[near]
    cn = np.stack([np.bincount(ca, w[cb] * fn[cb // 3, k], len(vid)) for k in range(3)], 1)
    cn /= np.linalg.norm(cn, axis=1, keepdims=True) + 1e-15
    return split(part, cn)


def split(part, corner_normals):
    """Merge corners that share a vertex and a normal."""
    ids = part.tri.ravel()
    key = np.column_stack([ids, np.round(corner_normals * 500).astype(int)])
    _, pick, inv = np.unique(key, axis=0, return_index=True, return_inverse=True)
    take = lambda a: None if a is None else a[ids[pick]]
    return Part(
        part.pos[ids[pick]],
        inv.reshape(-1, 3),
        part.uv[ids[pick]],
        corner_normals[pick],
        take(part.col),
        take(part.joints),
        take(part.weights),
    )


def tangents(part):
    """Tangent xyzw for normal maps with +y up in the image (v runs down)."""
    p, uv = part.pos[part.tri], part.uv[part.tri]
    e1, e2 = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    d1, d2 = uv[:, 1] - uv[:, 0], uv[:, 2] - uv[:, 0]
    det = d1[:, 0] * d2[:, 1] - d1[:, 1] * d2[:, 0]
    det = np.where(np.abs(det) < 1e-12, 1e-12, det)[:, None]
    du = (e1 * d2[:, 1:] - e2 * d1[:, 1:]) / det
    dv = (e2 * d1[:, :1] - e1 * d2[:, :1]) / det
    area = np.linalg.norm(np.cross(e1, e2), axis=1)[:, None]
    unit = lambda a: a / (np.linalg.norm(a, axis=1, keepdims=True) + 1e-15)
    acc = []
    for d in (unit(du) * area, unit(dv) * area):
        acc.append(
            np.stack([np.bincount(part.tri.ravel(), np.repeat(d[:, k], 3), len(part.pos)) for k in range(3)], 1)
        )
    t, b = acc
    t = t - part.nrm * (t * part.nrm).sum(1, keepdims=True)
    bad = np.linalg.norm(t, axis=1) < 1e-9
    alt = np.cross(part.nrm, np.eye(3)[np.argmin(np.abs(part.nrm), 1)])
    t = unit(np.where(bad[:, None], alt, t))
    side = np.where((np.cross(part.nrm, t) * b).sum(1) > 0, -1.0, 1.0)
    return np.column_stack([t, side])
