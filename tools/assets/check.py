"""Reads every .glb back and fails on what a renderer or a sonar would trip over.

Checks: required attributes, unit normals that agree with the triangles' winding,
volumes that face outward, textures of stone that are not stretched, normalised weights, joint names, loops that close,
power-of-two pictures, size limits. Prints the table of README.md.
"""
import io
import json
import struct
import sys
from pathlib import Path

import numpy as np
from PIL import Image

MODELS = Path(__file__).resolve().parents[2] / "assets" / "models"
TYPES = {5120: "i1", 5122: "<i2", 5121: "u1", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
WIDTH = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
SEGMENTS = {"pelvis", "abdomen", "thorax", "head"} | {
    f"{n}_{s}" for s in "lr" for n in ("upper_arm", "forearm", "hand", "upper_leg", "lower_leg", "foot")
}
GEAR = {"tank", "regulator"} | {f"jacket_{n}" for n in ("pelvis", "abdomen", "thorax", "head")}
GEAR |= {f"{n}_{s}" for s in "lr" for n in ("fin", "blade")}
# Models whose textures are even in all directions.
MAPPED = {"reef", "rocks", "seabed", "berth", "cave", "relics", "corals"}


class Model:
    def __init__(self, path):
        raw = path.read_bytes()
        magic, version, total = struct.unpack_from("<4sII", raw)
        assert magic == b"glTF" and version == 2 and total == len(raw), f"{path.name}: header"
        n = struct.unpack_from("<I", raw, 12)[0]
        self.doc, self.bin, self.path = json.loads(raw[20 : 20 + n]), raw[28 + n :], path

    def read(self, index):
        a = self.doc["accessors"][index]
        v = self.doc["bufferViews"][a["bufferView"]]
        kind = np.dtype(TYPES[a["componentType"]])
        width = v.get("byteStride", WIDTH[a["type"]] * kind.itemsize) // kind.itemsize
        flat = np.frombuffer(self.bin, kind, a["count"] * width, v["byteOffset"])
        out = flat.reshape(a["count"], -1)[:, : WIDTH[a["type"]]]
        top = {"i1": 127.0, "i2": 32767.0}.get(kind.str[1:])
        return out / top if top else out


def inside_out(pos, tri):
    """Closed shells (every edge met once from each side) of negative volume: count and size."""
    _, weld = np.unique(np.round(pos, 5), axis=0, return_inverse=True)
    t = weld[tri]
    t = t[(t[:, 0] != t[:, 1]) & (t[:, 1] != t[:, 2]) & (t[:, 2] != t[:, 0])]
    label = np.arange(weld.max() + 1)
    while True:
        low = label[t].min(1)
        new = label.copy()
        np.minimum.at(new, t.ravel(), np.repeat(low, 3))
        new = new[new]
        if (new == label).all():
            break
        label = new
    where = np.zeros((weld.max() + 1, 3))
    where[weld] = pos
    shell = label[t[:, 0]]
    n = weld.max() + 1
    e = np.concatenate([t[:, [0, 1]], t[:, [1, 2]], t[:, [2, 0]]])
    key = np.concatenate([e[:, 0] * n + e[:, 1], e[:, 1] * n + e[:, 0]])
    sign = np.concatenate([np.ones(len(e)), -np.ones(len(e))])
    u, inv = np.unique(key, return_inverse=True)
    open_edge = np.bincount(inv, sign) != 0
    is_open = np.zeros(n, bool)
    is_open[label[(u[open_edge] // n).astype(int)]] = True
    centre = (
        np.stack([np.bincount(shell, where[t].mean(1)[:, k], n) for k in range(3)], 1)
        / np.maximum(np.bincount(shell, minlength=n), 1)[:, None]
    )
    a, b, c = (where[t[:, k]] - centre[shell] for k in range(3))
    vol = np.bincount(shell, np.einsum("ij,ij->i", a, np.cross(b, c)) / 6, n)
    wrong = np.flatnonzero((vol < -1e-9) & ~is_open)
    return (
        len(wrong),
        [where[t[shell == w]].mean((0, 1)).round(2).tolist() for w in wrong[:3]],
        int(is_open[np.unique(shell)].sum()),
        len(np.unique(shell)),
    )


def stretch(at, tri):
    """How many times longer than wide the texture lies on the surface: what a tenth of the area exceeds."""
    p, u = at["POSITION"][tri].astype(float), at["TEXCOORD_0"][tri].astype(float)
    a, b = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    n = np.cross(a, b)
    area = np.linalg.norm(n, axis=1)
    keep = area > 1e-12
    a, b, n, area, u = a[keep], b[keep], n[keep], area[keep], u[keep]
    x = a / np.linalg.norm(a, axis=1)[:, None]
    y = np.cross(n / area[:, None], x)
    flat = np.stack([np.stack([(e * x).sum(1), (e * y).sum(1)], 1) for e in (a, b)], 2)
    uv = np.stack([u[:, 1] - u[:, 0], u[:, 2] - u[:, 0]], 2)
    s = np.linalg.svd(uv @ np.linalg.inv(flat), compute_uv=False)
    ratio = s[:, 0] / np.maximum(s[:, 1], 1e-9)
    order = np.argsort(ratio)
    total = np.cumsum(area[order])
    return ratio[order][np.searchsorted(total, 0.9 * total[-1])]


def check(path):
    m, bad = Model(path), []
    d = m.doc
    tris = 0
    for mesh in d["meshes"]:
        for p in mesh["primitives"]:
            at = {k: m.read(v) for k, v in p["attributes"].items()}
            name = f"{mesh['name']}/{d['materials'][p['material']]['name']}"
            tri = m.read(p["indices"]).reshape(-1, 3).astype(int)
            tris += len(tri)
            if not {"POSITION", "NORMAL", "TEXCOORD_0"} <= set(at):
                bad.append(f"{name}: an attribute is missing")
            if any(not np.isfinite(v).all() for v in at.values()):
                bad.append(f"{name}: not finite")
            if tri.max() >= len(at["POSITION"]):
                bad.append(f"{name}: index out of range")
            if np.abs(np.linalg.norm(at["NORMAL"], axis=1) - 1).max() > 1e-3:
                bad.append(f"{name}: normal not unit")
            q = at["POSITION"][tri].astype(float)
            fn = np.cross(q[:, 1] - q[:, 0], q[:, 2] - q[:, 0])
            against = (fn * at["NORMAL"][tri].mean(1)).sum(1) < 0
            share = np.linalg.norm(fn[against], axis=1).sum() / np.linalg.norm(fn, axis=1).sum()
            if share > 0.01:
                bad.append(f"{name}: {100 * share:.1f} % of the area has normals against its winding")
            textured = "baseColorTexture" in d["materials"][p["material"]].get("pbrMetallicRoughness", {})
            if path.stem in MAPPED and textured and (r := stretch(at, tri)) > 3:
                bad.append(f"{name}: the texture is stretched {r:.1f} times")
            wrong, at_where, opened, shells = inside_out(at["POSITION"].astype(float), tri)
            if wrong:
                bad.append(f"{name}: {wrong} closed shells face inward, e.g. at {at_where}")
            if "-v" in sys.argv:
                print(f"    {path.stem}/{name}: {shells} shells, {opened} open")
            if "WEIGHTS_0" in at:
                if np.abs(at["WEIGHTS_0"].sum(1) - 1).max() > 1e-3:
                    bad.append(f"{name}: weights do not sum to 1")
                if at["JOINTS_0"].max() >= len(d["skins"][0]["joints"]):
                    bad.append(f"{name}: joint out of range")
    for a in d.get("animations", []):
        for s in a["samplers"]:
            v = m.read(s["output"])
            if np.abs(v[0] - v[-1]).max() > 1e-5:
                bad.append(f"clip {a['name']}: does not close")
    for i in d.get("images", []):
        v = d["bufferViews"][i["bufferView"]]
        size = Image.open(io.BytesIO(m.bin[v["byteOffset"] : v["byteOffset"] + v["byteLength"]])).size
        if any(s & (s - 1) or s > 2048 for s in size) or size[0] * size[1] > 2 << 20:
            bad.append(f"image {i['name']}: {size}")
    joints = [d["nodes"][j]["name"] for j in d["skins"][0]["joints"]] if "skins" in d else []
    if path.stem == "diver" and set(joints) != SEGMENTS | GEAR:
        bad.append("diver: joints are not the 16 segments and the gear's")
    if path.stem == "rov" and sum(n["name"].startswith(("thruster_", "propeller_")) for n in d["nodes"]) != 16:
        bad.append("rov: thruster or propeller nodes are missing")
    mb = path.stat().st_size / 1e6
    if mb > 5:
        bad.append(f"{mb:.1f} MB is over 5")
    clips = ", ".join(a["name"] for a in d.get("animations", [])) or "-"
    print(
        f"| {path.name} | {tris} | {len(d['materials'])} | {len(d.get('images', []))} | {len(joints) or '-'} | {clips} | {mb:.2f} |"
    )
    return bad, mb


def main():
    print("| file | triangles | materials | textures | joints | clips | MB |\n|---|---|---|---|---|---|---|")
    faults, total = [], 0.0
    for path in sorted(MODELS.glob("*.glb")):
        bad, mb = check(path)
        faults += [f"{path.name}: {b}" for b in bad]
        total += mb
    print(f"total {total:.1f} MB")
    if total > 33:
        faults.append(f"all models together: {total:.1f} MB, at most 33")
    for f in faults:
        print(f, file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
