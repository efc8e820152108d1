"""Targets of sonar crops, in sizes that a seed draws: a tyre and a moored contact mine, as .glb by the assets' own writer."""
import contextlib
import io
import math
import os
import pathlib
import sys

import numpy as np

sys.path.append(os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "assets"))
import glb  # noqa: E402
import mesh  # noqa: E402


def _grid(rows, columns, across_wraps):
    """Triangles over rows of points: rows wrap if across_wraps, columns always; seen from where rows x columns points."""
    last = rows if across_wraps else rows - 1
    i, k = np.meshgrid(np.arange(last), np.arange(columns), indexing="ij")
    at = [(i + di) % rows * columns + (k + dk) % columns for di, dk in ((0, 0), (0, 1), (1, 1), (1, 0))]
    return np.stack([np.stack([at[0], at[1], at[2]], -1), np.stack([at[0], at[2], at[3]], -1)], 2).reshape(-1, 3)


def torus(path, ring_m, tube_m, around=40, across=16):
    """A tyre: the ring lies level, about y."""
    a, b = np.meshgrid(np.arange(around) * 2 * math.pi / around, np.arange(across) * 2 * math.pi / across, indexing="ij")
    out = np.stack([np.cos(b) * np.cos(a), 1.25 * np.sin(b), np.cos(b) * np.sin(a)], -1)
    points = np.stack([ring_m * np.cos(a), 0 * a, ring_m * np.sin(a)], -1) + tube_m * out
    normals = out / np.linalg.norm(out, axis=-1, keepdims=True)
    _write(path, mesh.Part(points, _grid(around, across, True), nrm=normals.reshape(-1, 3)))


def _ball(middle, radius_m, n):
    v, u = np.meshgrid(np.linspace(0, math.pi, n + 1), np.arange(2 * n) * math.pi / n, indexing="ij")
    out = np.stack([np.sin(v) * np.cos(u), np.cos(v), np.sin(v) * np.sin(u)], -1).reshape(-1, 3)
    return mesh.Part(middle + radius_m * out, _grid(n + 1, 2 * n, False), nrm=out)


def mine(path, radius_m, horns=11):
    """A moored contact mine: a ball with horns above and around."""
    parts = [_ball(np.zeros(3), radius_m, 24)]
    for i in range(horns):
        up = 1.0 - 1.3 * i / horns  # evenly by the golden angle
        angle, level = i * 2.399963, math.sqrt(max(0.0, 1 - up * up))
        way = np.array([level * math.cos(angle), up, level * math.sin(angle)])
        parts += [_ball(way * radius_m * far, 0.035, 4) for far in (1.04, 1.12, 1.2)]
    _write(path, mesh.join(parts))


def _write(path, part):
    model = glb.Glb("target")
    model.node("target", model.mesh("target", [(part, model.material("target"))]))
    with contextlib.redirect_stdout(io.StringIO()):  # it tells the size
        model.save(pathlib.Path(path))
