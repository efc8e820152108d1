"""Crops of an imaging sonar's picture: 64 ranges by 64 bearings around one thing on or over a bottom, drawn by a seed.

A scene is a bottom, a device (frequency, beam, pulse, noise, speckle) and a range; the diver, the ROV, a moored mine, a
tyre or nothing but stones are in it in random poses. Devices and bottoms of the split "test" never occur in "train". A crop
whose thing is the loudest in fewer than LEAST_BINS bins is not made.
"""
import json
import math
import os
import struct

import numpy as np

from crops import ASSETS, FAR, THING, rotation, some_of

CLASSES = ["nothing", "diver", "rov", "mine", "tyre"]
LABELS = {"diver": 4, "rov": 5, "mine": 12, "tyre": 11}
SIDE, LEAST_BINS, WINDOW_M = 64, 24, 4.0
SPLITS = {"train": {"bottoms": ["sand", "gravel", "mud"], "khz": [550, 750, 1200], "beam": [0.8, 1.0, 1.4]},
          "test": {"bottoms": ["rock", "silt"], "khz": [900], "beam": [0.6, 1.2]}}
HEAD = """title = "Sonar crops"
seed = {seed}
[physics]
rate_hz = 60
[[objects]]
name = "eye"
shape = "sphere"
radius_m = 0.001
inputs = {{ pose = {{ from = "python", hold_s = 3600 }} }}
[[objects.sonars]]
name = "crop"
kind = "imaging"
range_m = [{near:.2f}, {far:.2f}]
azimuth_deg = {azimuth:.2f}
elevation_deg = 20
bins = [64, 64, 64]
quality = "draft"
rate_hz = 60
frequency_hz = {hertz:.0f}
bandwidth_hz = {band:.0f}
beam = {{ azimuth = "hamming", azimuth_deg = {beam:.2f}, elevation = "sinc", elevation_deg = 20 }}
level = {{ tvg = 30 }}
noise = {{ self_db = {noise:.1f} }}
speckle = {{ shape = {shape:.2f} }}
labels = {{ energy = true }}
[[objects]]
name = "floor"
class = "seabed"
material = "{bottom}"
terrain = "floor.npy"
cell_m = 0.25
position_m = [0, 0, 0]
[[objects]]
name = "stones"
class = "rock"
material = "rock"
model = "{assets}/models/rocks.glb"
node = "rock_1"
scatter = {{ count = 30, area_m = [-14, -14, 14, 14], on = "floor", scale = [0.1, 0.5] }}
"""


def torus(path, ring_m, tube_m, around=40, across=16):
    """A tyre as .glb: the ring lies level, about y."""
    a, b = np.meshgrid(np.arange(around) * 2 * math.pi / around, np.arange(across) * 2 * math.pi / across, indexing="ij")
    out = np.stack([np.cos(b) * np.cos(a), 1.25 * np.sin(b), np.cos(b) * np.sin(a)], -1)
    points = np.stack([ring_m * np.cos(a), 0 * a, ring_m * np.sin(a)], -1) + tube_m * out
    i, k = np.meshgrid(np.arange(around), np.arange(across), indexing="ij")
    at = [(i + di) % around * across + (k + dk) % across for di, dk in ((0, 0), (0, 1), (1, 1), (1, 0))]
    corners = np.stack([np.stack([at[0], at[1], at[2]], -1), np.stack([at[0], at[2], at[3]], -1)], 2)
    write_glb(path, points.reshape(-1, 3), (out / np.linalg.norm(out, axis=-1, keepdims=True)).reshape(-1, 3), corners.reshape(-1))


def mine(path, radius_m, horns=11):
    """A moored contact mine as .glb: a ball with horns above and around."""
    points, normals, corners = [], [], []

    def ball(middle, radius, n):
        v, u = np.meshgrid(np.linspace(0, math.pi, n + 1), np.arange(2 * n) * math.pi / n, indexing="ij")
        out = np.stack([np.sin(v) * np.cos(u), np.cos(v), np.sin(v) * np.sin(u)], -1)
        first = sum(len(p) for p in points)
        i, k = np.meshgrid(np.arange(n), np.arange(2 * n), indexing="ij")
        at = [first + (i + di) * 2 * n + (k + dk) % (2 * n) for di, dk in ((0, 0), (0, 1), (1, 1), (1, 0))]
        points.append((middle + radius * out).reshape(-1, 3))
        normals.append(out.reshape(-1, 3))
        corners.append(np.stack([np.stack([at[0], at[1], at[2]], -1), np.stack([at[0], at[2], at[3]], -1)], 2).reshape(-1))

    ball(np.zeros(3), radius_m, 24)
    for i in range(horns):
        up = 1.0 - 1.3 * i / horns  # evenly by the golden angle
        angle, level = i * 2.399963, math.sqrt(max(0.0, 1 - up * up))
        way = np.array([level * math.cos(angle), up, level * math.sin(angle)])
        for far in (1.04, 1.12, 1.2):
            ball(way * radius_m * far, 0.035, 4)
    write_glb(path, np.concatenate(points), np.concatenate(normals), np.concatenate(corners))


def write_glb(path, points, normals, corners):
    """One mesh of triangles as binary glTF 2.0."""
    parts = [np.asarray(points, "<f4").tobytes(), np.asarray(normals, "<f4").tobytes(), np.asarray(corners, "<u4").tobytes()]
    starts = np.cumsum([0] + [len(p) for p in parts]).tolist()
    told = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2}]}],
            "buffers": [{"byteLength": starts[-1]}],
            "bufferViews": [{"buffer": 0, "byteOffset": s, "byteLength": len(p)} for s, p in zip(starts, parts)],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": len(points), "type": "VEC3",
                           "min": np.float32(points).min(axis=0).tolist(), "max": np.float32(points).max(axis=0).tolist()},
                          {"bufferView": 1, "componentType": 5126, "count": len(points), "type": "VEC3"},
                          {"bufferView": 2, "componentType": 5125, "count": len(corners), "type": "SCALAR"}]}
    text = json.dumps(told).encode()
    text += b" " * (-len(text) % 4)
    binary = b"".join(parts)
    with open(path, "wb") as file:
        file.write(struct.pack("<4sII", b"glTF", 2, 12 + 8 + len(text) + 8 + len(binary)))
        file.write(struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary)


def picture(echoes, span_db=45.0):
    """Levels 0 to 255 of a sonar's intensities: the loudest bin is white, span_db below it is black."""
    db = 10 * np.log10(np.maximum(echoes, 1e-30) / max(float(echoes.max()), 1e-30))
    return np.rint(255 * np.clip(1 + db / span_db, 0, 1)).astype(np.uint8)


class Maker:
    """Sonar crops of one seed's scene, as crops.Maker."""

    def __init__(self, tools, split, seed, side=SIDE):
        self.rng = rng = np.random.Generator(np.random.Philox(key=seed + (1 << 41 if split == "test" else 1 << 42)))
        of = SPLITS[split]
        self.water = f"{rng.choice(of['khz'])} kHz"
        self.place = str(rng.choice(of["bottoms"]))
        self.near = rng.uniform(1.5, 8.0)
        self.azimuth = math.radians(np.clip(200 / (self.near + 2) * rng.uniform(0.8, 1.2), 20, 45))
        rough = rng.uniform(0.0, 0.06)
        n = 129
        heights = np.zeros((n, n))
        for _ in range(24):  # waves of all directions
            k, way, phase = rng.uniform(0.3, 5.0), rng.uniform(0, 2 * math.pi), rng.uniform(0, 2 * math.pi)
            x, z = np.meshgrid(np.arange(n) * 0.25, np.arange(n) * 0.25)
            heights += rough / math.sqrt(k) / 3 * np.sin(k * (x * math.cos(way) + z * math.sin(way)) + phase)
        np.save(os.path.join(tools.folder, "floor.npy"), (heights - 12.0).astype(np.float32))
        torus(os.path.join(tools.folder, "tyre.glb"), rng.uniform(0.22, 0.30), rng.uniform(0.08, 0.11))
        mine(os.path.join(tools.folder, "mine.glb"), rng.uniform(0.35, 0.5))
        hertz = float(self.water.split()[0]) * 1e3
        text = HEAD.format(seed=seed, near=self.near, far=self.near + WINDOW_M, azimuth=math.degrees(self.azimuth), hertz=hertz,
                           band=rng.uniform(20e3, 60e3), beam=rng.choice(of["beam"]), noise=rng.uniform(60, 95),
                           shape=rng.uniform(1.0, 10.0), bottom=self.place, assets=ASSETS)
        folder = tools.folder
        for name, model, kind, more in (("diver", f"{ASSETS}/models/diver.glb", "diver", 'clip = "swim"\nclip_rate = 37.3\nmaterial = "neoprene"'),
                                        ("rov", f"{ASSETS}/models/rov.glb", "rov", 'material = "aluminium"'),
                                        ("mine", f"{folder}/mine.glb", "target", 'material = "steel"'),
                                        ("tyre", f"{folder}/tyre.glb", "structure", 'material = "rubber"'),
                                        ("stone", f"{ASSETS}/models/rocks.glb", "rock", 'node = "rock_0"\nscale = 0.5\nmaterial = "rock"')):
            text += THING.replace("{assets}/models/{model}", "{model}").format(name=name, model=model, kind=kind, more=more)
        self.world = tools.python().open(tools.write(f"sonar_{split}_{seed}.toml", text), seed=seed)
        self.world.images("eye_crop/echoes", "eye_crop/echo_labels")
        self.things = ["diver", "rov", "mine", "tyre", "stone"]

    def close(self):
        self.world.close()

    def one(self, name):
        """(picture [64, 64], what it is told of), or None where the thing cannot be heard."""
        rng, world = self.rng, self.world
        yaw, down = rng.uniform(-math.pi, math.pi), rng.uniform(0.06, 0.35)
        far = self.near + WINDOW_M * rng.uniform(0.25, 0.75)
        bearing = rng.normal(0.0, 0.12) * self.azimuth
        level = np.array([math.cos(yaw + bearing), math.sin(yaw + bearing), 0.0])
        over = {"tyre": 0.1, "mine": rng.uniform(0.3, 1.2), "rov": rng.uniform(0.2, 1.5), "diver": rng.uniform(0.4, 1.5),
                "nothing": 0.3}[name]
        spot = np.array([rng.uniform(-4, 4), rng.uniform(-4, 4), -12.0 + over])
        eye = spot - far * math.cos(down) * level + np.array([0, 0, far * math.sin(down)])
        poses = {}
        if name != "nothing":
            turn = {"tyre": (rng.choice([0.0, rng.uniform(-1.6, 1.6)]), 0.2), "mine": (0.0, 0.2), "rov": (0.0, 0.1),
                    "diver": (rng.uniform(0.9, 1.75) if rng.random() < 0.7 else rng.uniform(-0.2, 0.4), 0.3)}[name]
            if name == "tyre" and abs(turn[0]) > 0.3:
                spot[2] += 0.2  # it leans
            poses[name] = (spot, rotation(rng.uniform(-math.pi, math.pi), turn[0], rng.normal(0, turn[1])))
        if rng.random() < (0.25 if name != "nothing" else 0.6):
            side = rng.uniform(-0.4, 0.4) * self.azimuth
            at = eye + (self.near + WINDOW_M * rng.uniform(0.1, 0.9)) * np.array([math.cos(yaw + side), math.sin(yaw + side), 0])
            poses["stone"] = (np.array([at[0], at[1], -12.0]), rotation(rng.uniform(-math.pi, math.pi), 0.0, 0.0))
        world["eye"].pose(eye, rotation(yaw, down, rng.normal(0, 0.03)), velocity=[0, 0, 0])
        for i, thing in enumerate(self.things):
            at, q = poses.get(thing, ([FAR[0] + 10 * i, FAR[1], FAR[2]], [0, 0, 0, 1]))
            world[thing].pose(at, q, velocity=[0, 0, 0])
        seen = world.tick(1)
        echoes, labels = np.array(seen["eye_crop/echoes"].pixels), np.array(seen["eye_crop/echo_labels"].pixels)
        if name != "nothing" and np.count_nonzero(labels == LABELS[name]) < LEAST_BINS:
            return None
        return picture(echoes), {"range_m": far}

    def some(self, each):
        return some_of(self, CLASSES, each)
