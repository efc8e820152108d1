"""Triangles of a glTF model (.glb) in a pose of one of its clips, by numpy alone.

Written from the glTF 2.0 specification, apart from the program's own reader, so that an experiment can hold
the program's pictures against it. It reads what the shipped models use: float attributes, linear clips, skins.
"""
import json
import struct

import numpy as np

from rotations import matrix

TYPES = {5120: np.int8, 5121: np.uint8, 5122: np.int16, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


class Model:
    """A .glb file; triangles(clip, time_s) poses it. Metres, the file's axes."""

    def __init__(self, path):
        with open(path, "rb") as file:
            data = file.read()
        length = struct.unpack_from("<I", data, 12)[0]
        self.json = json.loads(data[20:20 + length])
        self.binary = data[20 + length + 8:]

    def _array(self, index):
        accessor = self.json["accessors"][index]
        view = self.json["bufferViews"][accessor["bufferView"]]
        kind, width = np.dtype(TYPES[accessor["componentType"]]), WIDTHS[accessor["type"]]
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        stride = view.get("byteStride", kind.itemsize * width)
        rows = np.ndarray((accessor["count"], width), kind, self.binary, start, (stride, kind.itemsize))
        values = rows.astype(np.float64)
        if accessor.get("normalized"):
            values /= np.iinfo(kind).max
        return values

    def _animated(self, clip, time_s):
        """{node: {path: value}} of the clip at that time; clips repeat."""
        names = [a.get("name", str(i)) for i, a in enumerate(self.json.get("animations", []))]
        if clip is None:
            return {}
        animation = self.json["animations"][names.index(clip)]
        inputs = [self._array(s["input"])[:, 0] for s in animation["samplers"]]
        length = max(times[-1] for times in inputs)
        at = time_s % length if length > 0 else 0.0
        moved = {}
        for channel in animation["channels"]:
            sampler = animation["samplers"][channel["sampler"]]
            times, values = inputs[channel["sampler"]], self._array(sampler["output"])
            i = int(np.clip(np.searchsorted(times, at, "right") - 1, 0, max(len(times) - 2, 0)))
            j = min(i + 1, len(times) - 1)
            part = np.clip((at - times[i]) / (times[j] - times[i]), 0, 1) if j > i else 0.0
            path = channel["target"]["path"]
            value = _slerp(values[i], values[j], part) if path == "rotation" else (1 - part) * values[i] + part * values[j]
            moved.setdefault(channel["target"]["node"], {})[path] = value
        return moved

    def triangles(self, clip=None, time_s=0.0):
        """[n, 3, 3] corners in the model's frame."""
        nodes, moved = self.json["nodes"], self._animated(clip, time_s)
        world = [np.eye(4)] * len(nodes)

        def place(index, parent):
            node = {**nodes[index], **moved.get(index, {})}
            local = np.array(node["matrix"], float).reshape(4, 4).T if "matrix" in node else _matrix(node)
            world[index] = parent @ local
            for child in node.get("children", []):
                place(child, world[index])

        for root in self.json["scenes"][self.json.get("scene", 0)]["nodes"]:
            place(root, np.eye(4))
        out = []
        for index, node in enumerate(nodes):
            if "mesh" not in node:
                continue
            for primitive in self.json["meshes"][node["mesh"]]["primitives"]:
                points = self._array(primitive["attributes"]["POSITION"])
                if "skin" in node:
                    points = self._skinned(points, primitive, self.json["skins"][node["skin"]], world)
                else:
                    points = _moved(world[index], points)
                corners = self._array(primitive["indices"])[:, 0].astype(int).reshape(-1, 3)
                out.append(points[corners])
        return np.concatenate(out)

    def _skinned(self, points, primitive, skin, world):
        inverse = self._array(skin["inverseBindMatrices"]).reshape(-1, 4, 4).transpose(0, 2, 1)
        joints = np.stack([world[j] @ inverse[k] for k, j in enumerate(skin["joints"])])
        which = self._array(primitive["attributes"]["JOINTS_0"]).astype(int)
        weight = self._array(primitive["attributes"]["WEIGHTS_0"])
        blend = np.einsum("nk,nkij->nij", weight / weight.sum(axis=1, keepdims=True), joints[which])
        return np.einsum("nij,nj->ni", blend[:, :3, :3], points) + blend[:, :3, 3]


def _slerp(a, b, part):
    dot = float(a @ b)
    if dot < 0:
        b, dot = -b, -dot
    if dot > 0.9995:
        mixed = (1 - part) * a + part * b
    else:
        angle = np.arccos(dot)
        mixed = (np.sin((1 - part) * angle) * a + np.sin(part * angle) * b) / np.sin(angle)
    return mixed / np.linalg.norm(mixed)


def _matrix(node):
    out = np.eye(4)
    out[:3, :3] = matrix(node.get("rotation", (0, 0, 0, 1))) * np.array(node.get("scale", (1, 1, 1)), float)
    out[:3, 3] = node.get("translation", (0, 0, 0))
    return out


def _moved(matrix, points):
    return points @ matrix[:3, :3].T + matrix[:3, 3]
