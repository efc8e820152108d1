"""A small glTF 2.0 binary writer: textures, materials, meshes, skins, clips."""
import io
import json
import struct

import numpy as np
from PIL import Image

import mesh as M

F32, U16, U32, U8, I16, I8 = 5126, 5123, 5125, 5121, 5122, 5120


class Glb:
    """Collects one model and writes it with save().

    packed: normals of 16 bits and tangents of 8 (KHR_mesh_quantization), two fifths of a mesh's bytes less.
    """

    def __init__(self, name, packed=False):
        self.packed = packed
        self.bin = bytearray()
        self.doc = {
            "asset": {
                "version": "2.0",
                "generator": "Neritic tools/assets",
                "copyright": "Neritic authors, Apache-2.0",
            },
            "scene": 0,
            "scenes": [{"name": name, "nodes": []}],
            "nodes": [],
            "meshes": [],
            "materials": [],
            "accessors": [],
            "bufferViews": [],
        }
        self.quantized = {}

    def _view(self, data, target=None):
        while len(self.bin) % 4:
            self.bin.append(0)
        view = {"buffer": 0, "byteOffset": len(self.bin), "byteLength": len(data)}
        if target:
            view["target"] = target
        self.bin += data
        self.doc["bufferViews"].append(view)
        return len(self.doc["bufferViews"]) - 1

    def accessor(self, array, ctype, kind, target=None, bounds=False, normalized=False):
        dt = {F32: "<f4", U16: "<u2", U32: "<u4", U8: "u1", I16: "<i2", I8: "i1"}[ctype]
        a = np.ascontiguousarray(array, dt)
        acc = {"bufferView": self._view(a.tobytes(), target), "componentType": ctype, "count": len(a), "type": kind}
        if normalized:
            acc["normalized"] = True
        if bounds:
            acc["min"] = np.atleast_1d(a.min(0)).tolist()
            acc["max"] = np.atleast_1d(a.max(0)).tolist()
        self.doc["accessors"].append(acc)
        return len(self.doc["accessors"]) - 1

    def direction(self, vectors, packed_type, target):
        """Accessor of unit vectors, [n, 3] or [n, 4]; each begins at a multiple of four bytes, as glTF asks."""
        kind = f"VEC{vectors.shape[1]}"
        if not self.packed:
            return self.accessor(vectors, F32, kind, target)
        self.use("KHR_mesh_quantization", required=True)
        top = {I16: 32767, I8: 127}[packed_type]
        wide = np.zeros((len(vectors), 4))
        wide[:, : vectors.shape[1]] = np.round(np.clip(vectors, -1, 1) * top)
        index = self.accessor(wide, packed_type, kind, target, normalized=True)
        view = self.doc["bufferViews"][self.doc["accessors"][index]["bufferView"]]
        view["byteStride"] = 4 * (2 if packed_type == I16 else 1)
        return index

    def use(self, extension, required=False):
        for key in ("extensionsUsed", "extensionsRequired")[: 1 + required]:
            names = self.doc.setdefault(key, [])
            if extension not in names:
                names.append(extension)

    def texture(self, name, image, quality=88):
        """image: float 0..1 array [h, w, 3 or 4], row 0 on top; 4 channels go to PNG.

        Colours are filtered between two mip levels; normals, roughness and detail, whose steps from level to
        level nobody sees through water, take the nearest: a fifth of a software rasterizer's G-buffer.
        """
        a = np.round(np.clip(image, 0, 1) * 255).astype(np.uint8)
        buf = io.BytesIO()
        if a.shape[2] == 4:
            Image.fromarray(a, "RGBA").save(buf, "PNG", optimize=True)
            mime = "image/png"
        else:
            Image.fromarray(a, "RGB").save(buf, "JPEG", quality=quality, subsampling=0)
            mime = "image/jpeg"
        d = self.doc
        wrap = {"magFilter": 9729, "wrapS": 10497, "wrapT": 10497}
        d.setdefault("samplers", [{**wrap, "minFilter": 9987}, {**wrap, "minFilter": 9985}])
        d.setdefault("images", []).append({"name": name, "bufferView": self._view(buf.getvalue()), "mimeType": mime})
        d.setdefault("textures", []).append({"sampler": 0 if name.endswith("_color") else 1, "source": len(d["images"]) - 1, "name": name})
        return len(d["textures"]) - 1

    def extend(self, m, name, value):
        m.setdefault("extensions", {})[name] = value
        self.use(name)

    def material(
        self,
        name,
        color=(1, 1, 1, 1),
        metal=0.0,
        rough=0.8,
        base=None,
        mr=None,
        normal=None,
        normal_scale=1.0,
        emissive=None,
        strength=1.0,
        double=False,
        mask=None,
        blend=False,
        thin=None,
        detail=None,
        picture=None,
    ):
        pbr = {"baseColorFactor": list(color), "metallicFactor": metal, "roughnessFactor": rough}
        m = {"name": name, "pbrMetallicRoughness": pbr}
        if base is not None:
            pbr["baseColorTexture"] = {"index": base}
        if mr is not None:
            pbr["metallicRoughnessTexture"] = {"index": mr}
        if normal is not None:
            m["normalTexture"] = {"index": normal, "scale": normal_scale}
        if emissive is not None:
            m["emissiveFactor"] = list(emissive)
        if strength != 1.0:  # how many times white the emission is
            self.extend(m, "KHR_materials_emissive_strength", {"emissiveStrength": strength})
        if double:
            m["doubleSided"] = True
        if mask is not None:
            m["alphaMode"], m["alphaCutoff"] = "MASK", mask
        if blend:
            m["alphaMode"] = "BLEND"
        if thin is not None:  # the share of diffuse light that goes through
            self.extend(m, "KHR_materials_diffuse_transmission", {"diffuseTransmissionFactor": thin})
        if detail is not None:  # texture and repeats: detail.py
            m["extras"] = {"detailTexture": {"index": detail[0], "repeats": detail[1]}}
        if picture is not None:  # the name of a picture that a program may show here
            m.setdefault("extras", {})["picture"] = picture
        self.doc["materials"].append(m)
        return len(self.doc["materials"]) - 1

    def mesh(self, name, prims, crease=40.0):
        """prims: (Part, material index) pairs; normals are made where missing."""
        out = []
        for part, mat in prims:
            if part.nrm is None:
                part = M.shade(part, crease)
            vert = 34962
            attr = {
                "POSITION": self.accessor(part.pos, F32, "VEC3", vert, True),
                "NORMAL": self.direction(part.nrm, I16, vert),
                "TEXCOORD_0": self.accessor(part.uv, F32, "VEC2", vert),
            }
            if "normalTexture" in self.doc["materials"][mat]:
                attr["TANGENT"] = self.direction(M.tangents(part), I8, vert)
            if part.col is not None:
                attr["COLOR_0"] = self.accessor(
                    np.round(np.clip(part.col, 0, 1) * 255), U8, "VEC4", vert, normalized=True
                )
            if part.joints is not None:
                attr["JOINTS_0"] = self.accessor(part.joints, U8, "VEC4", vert)
                attr["WEIGHTS_0"] = self.accessor(part.weights, F32, "VEC4", vert)
            wide = len(part.pos) > 65535
            out.append(
                {
                    "attributes": attr,
                    "material": mat,
                    "mode": 4,
                    "indices": self.accessor(part.tri.ravel(), U32 if wide else U16, "SCALAR", 34963),
                }
            )
        self.doc["meshes"].append({"name": name, "primitives": out})
        return len(self.doc["meshes"]) - 1

    def node(self, name, mesh=None, at=None, rot=None, scale=None, parent=None, skin=None):
        n = {"name": name}
        if mesh is not None:
            n["mesh"] = mesh
        if at is not None:
            n["translation"] = [float(v) for v in at]
        if rot is not None:
            n["rotation"] = [float(v) for v in rot]
        if scale is not None:
            n["scale"] = [float(v) for v in scale]
        if skin is not None:
            n["skin"] = skin
        self.doc["nodes"].append(n)
        me = len(self.doc["nodes"]) - 1
        if parent is None:
            self.doc["scenes"][0]["nodes"].append(me)
        else:
            self.doc["nodes"][parent].setdefault("children", []).append(me)
        return me

    def skin(self, name, joints, rest):
        """rest: joint positions in the bind frame; every rest rotation is identity."""
        ibm = np.tile(np.eye(4), (len(joints), 1, 1))
        ibm[:, 3, :3] = -np.asarray(rest)
        self.doc.setdefault("skins", []).append(
            {
                "name": name,
                "joints": joints,
                "skeleton": joints[0],
                "inverseBindMatrices": self.accessor(ibm.reshape(-1, 16), F32, "MAT4"),
            }
        )
        return len(self.doc["skins"]) - 1

    def animation(self, name, times, tracks):
        """tracks: (node, 'rotation' or 'translation', values [t, 4 or 3])."""
        t = self.accessor(times, F32, "SCALAR", bounds=True)
        chans, samps = [], []
        for node, path, values in tracks:
            kind = "VEC4" if path == "rotation" else "VEC3"
            samps.append({"input": t, "output": self.accessor(values, F32, kind), "interpolation": "LINEAR"})
            chans.append({"sampler": len(samps) - 1, "target": {"node": node, "path": path}})
        self.doc.setdefault("animations", []).append({"name": name, "channels": chans, "samplers": samps})

    def save(self, path):
        self.doc["buffers"] = [{"byteLength": len(self.bin)}]
        js = json.dumps(self.doc, separators=(",", ":")).encode()
        js += b" " * (-len(js) % 4)
        data = bytes(self.bin) + b"\0" * (-len(self.bin) % 4)
        self.doc["buffers"][0]["byteLength"] = len(data)
        path.parent.mkdir(parents=True, exist_ok=True)
        tmp = path.with_suffix(".tmp")
        with open(tmp, "wb") as f:
            f.write(struct.pack("<4sII", b"glTF", 2, 12 + 8 + len(js) + 8 + len(data)))
            f.write(struct.pack("<I4s", len(js), b"JSON") + js)
            f.write(struct.pack("<I4s", len(data), b"BIN\0") + data)
        tmp.replace(path)
        print(f"{path.name}: {path.stat().st_size / 1e6:.2f} MB")


def quat(axis, deg):
    """Unit quaternion xyzw about x, y or z; deg may be an array."""
    a = np.radians(np.asarray(deg, float)) / 2
    q = np.zeros(a.shape + (4,))
    q[..., "xyz".index(axis)] = np.sin(a)
    q[..., 3] = np.cos(a)
    return q


def qmul(a, b):
    """Hamilton product: apply b, then a."""
    ax, ay, az, aw = np.moveaxis(a, -1, 0)
    bx, by, bz, bw = np.moveaxis(b, -1, 0)
    return np.stack(
        [
            aw * bx + ax * bw + ay * bz - az * by,
            aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw,
            aw * bw - ax * bx - ay * by - az * bz,
        ],
        -1,
    )
