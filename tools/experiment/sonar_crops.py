"""Crops of an imaging sonar's pictures: 64 ranges by 64 bearings, some 2.8 m by 3 m, around one thing on or over a bottom,
drawn by a seed.

A scene is a bottom, a device (frequency, beam, pulse, noise, speckle) and a range; the diver, the ROV, a moored mine, a
tyre or nothing but stones are in it in random poses. The sonar moves around the thing: a crop is LOOKS pictures, each from
6 to 14 degrees farther on. Frequencies, bottoms and beams of the split "test" never occur in "train"; the strengths of bottoms
and the widths of beams to learn from lie on both sides of them. A crop whose thing is, in the first picture, the loudest in
fewer than LEAST_BINS of the 64 x 64 bins, or there not LEAST_LOUDER levels of 255 (3.5 dB) over the rest, is not made: nobody
could name it. Crops to learn from may be fainter: LESSON_BINS of the sonar's own bins are enough.
"""
import math
import os

import numpy as np

from crops import ASSETS, FAR, THING, some_of
from rotations import quaternion

CLASSES = ["nothing", "diver", "rov", "mine", "tyre"]
LABELS = {"diver": 4, "rov": 5, "mine": 12, "tyre": 11}
SIDE, LEAST_BINS, LEAST_LOUDER, LESSON_BINS, WINDOW_M, LOOKS = 64, 16, 20.0, 24, 2.8, 3
# To learn from, scene by scene: crops of a class, how the scene is opened.
LESSONS = [(12, {}), (12, {"wide": True})]
SCENES, STEPS = 140, 6000  # to learn from; of the training
WIDE_BOTTOM_DB, WIDE_BEAM_DEG = (-35.0, -18.0), (0.5, 1.6)
SPLITS = {"train": {"bottoms": ["sand", "gravel", "mud"], "khz": [550, 750, 1200], "beam": [0.8, 1.0, 1.4]},
          "choose": {"khz": [650]},
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
{bottom}
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


def picture(echoes, span_db=45.0):
    """Levels 0 to 255 of a sonar's intensities, [64, 64]: the loudest bin is white, span_db below it is black. Where the sonar's
    quality divides range bins that are too coarse for it, the mean of their levels counts."""
    db = 10 * np.log10(np.maximum(echoes, 1e-30) / max(float(echoes.max()), 1e-30))
    return pooled(np.rint(255 * np.clip(1 + db / span_db, 0, 1)))


def pooled(levels):
    return np.rint(_mean_of_bins(levels)).astype(np.uint8)


def _mean_of_bins(values):
    return values.reshape(SIDE, -1, values.shape[1]).mean(axis=1)


def heard(pixels, its):
    """Whether anybody could name the thing of these bins."""
    return its.sum() >= LEAST_BINS and pixels[its].mean() - pixels[~its].mean() >= LEAST_LOUDER


def _eye(spot, far, yaw, down):
    """Where a sonar is that hears the spot from so far, looking so."""
    return spot + far * np.array([-math.cos(down) * math.cos(yaw), -math.cos(down) * math.sin(yaw), math.sin(down)])


class Maker:
    """Sonar crops of one seed's scene, as crops.Maker."""

    def __init__(self, tools, split, seed, wide=False):
        """wide: the bottom's strength and the beam are drawn evenly from WIDE_BOTTOM_DB and WIDE_BEAM_DEG."""
        first = {"train": 1 << 42, "choose": 1 << 43, "test": 1 << 41}[split]
        self.rng = rng = np.random.Generator(np.random.Philox(key=seed + first))
        of, self.strict, wide = SPLITS[split], split != "train", wide or split == "choose"
        self.water = f"{rng.choice(of['khz'])} kHz"
        self.place = f"{rng.uniform(*WIDE_BOTTOM_DB):.1f} dB" if wide else str(rng.choice(of["bottoms"]))
        bottom = f"backscatter_db = {self.place.split()[0]}" if wide else f'material = "{self.place}"'
        self.near = rng.uniform(1.5, 8.0)
        self.azimuth = math.radians(np.clip(170 / (self.near + 1.4) * rng.uniform(0.8, 1.2), 14, 45))
        rough = rng.uniform(0.0, 0.06)
        n = 129
        heights = np.zeros((n, n))
        for _ in range(24):  # waves of all directions
            k, way, phase = rng.uniform(0.3, 5.0), rng.uniform(0, 2 * math.pi), rng.uniform(0, 2 * math.pi)
            x, z = np.meshgrid(np.arange(n) * 0.25, np.arange(n) * 0.25)
            heights += rough / math.sqrt(k) / 3 * np.sin(k * (x * math.cos(way) + z * math.sin(way)) + phase)
        np.save(os.path.join(tools.folder, "floor.npy"), (heights - 12.0).astype(np.float32))
        from sonar_targets import mine, torus  # which needs Pillow

        torus(os.path.join(tools.folder, "tyre.glb"), rng.uniform(0.22, 0.30), rng.uniform(0.08, 0.11))
        mine(os.path.join(tools.folder, "mine.glb"), rng.uniform(0.35, 0.5))
        hertz = float(self.water.split()[0]) * 1e3
        text = HEAD.format(seed=seed, near=self.near, far=self.near + WINDOW_M, azimuth=math.degrees(self.azimuth), hertz=hertz,
                           band=rng.uniform(20e3, 60e3), beam=rng.uniform(*WIDE_BEAM_DEG) if wide else rng.choice(of["beam"]),
                           noise=rng.uniform(60, 95), shape=rng.uniform(1.0, 10.0), bottom=bottom, assets=ASSETS)
        folder = tools.folder
        for name, kind, drawn in (("diver", "diver", f'model = "{ASSETS}/models/diver.glb"\nclip = "swim"\nclip_rate = 37.3\nmaterial = "neoprene"'),
                                  ("rov", "rov", f'model = "{ASSETS}/models/rov.glb"\nmaterial = "aluminium"'),
                                  ("mine", "target", f'model = "{folder}/mine.glb"\nmaterial = "steel"'),
                                  ("tyre", "structure", f'model = "{folder}/tyre.glb"\nmaterial = "rubber"'),
                                  ("stone", "rock", f'model = "{ASSETS}/models/rocks.glb"\nnode = "rock_0"\nscale = 0.5\nmaterial = "rock"')):
            text += THING.format(name=name, kind=kind, drawn=drawn)
        self.world = tools.python().open(tools.write(f"sonar_{split}_{seed}.toml", text), seed=seed)
        self.world.images("eye_crop/echoes", "eye_crop/echo_labels")
        self.things = ["diver", "rov", "mine", "tyre", "stone"]

    def close(self):
        self.world.close()

    def one(self, name):
        """(pictures [LOOKS, 64, 64], range in metres), or None where the thing cannot be heard."""
        rng, world = self.rng, self.world
        yaw, down = rng.uniform(-math.pi, math.pi), rng.uniform(0.06, 0.35)
        far = self.near + WINDOW_M * rng.uniform(0.25, 0.75)
        bearing = rng.normal(0.0, 0.12) * self.azimuth
        over = {"tyre": 0.1, "mine": rng.uniform(0.3, 1.2), "rov": rng.uniform(0.2, 1.5), "diver": rng.uniform(0.4, 1.5),
                "nothing": 0.3}[name]
        spot = np.array([rng.uniform(-4, 4), rng.uniform(-4, 4), -12.0 + over])
        poses = {}
        if name != "nothing":
            turn = {"tyre": (rng.choice([0.0, rng.uniform(-1.6, 1.6)]), 0.2), "mine": (0.0, 0.2), "rov": (0.0, 0.1),
                    "diver": (rng.uniform(0.9, 1.75) if rng.random() < 0.7 else rng.uniform(-0.2, 0.4), 0.3)}[name]
            if name == "tyre" and abs(turn[0]) > 0.3:
                spot[2] += 0.2  # it leans
            poses[name] = (spot, quaternion(rng.uniform(-math.pi, math.pi), turn[0], rng.normal(0, turn[1])))
        eye = _eye(spot, far, yaw + bearing, down)
        if rng.random() < (0.25 if name != "nothing" else 0.6):
            side = rng.uniform(-0.4, 0.4) * self.azimuth
            at = eye + (self.near + WINDOW_M * rng.uniform(0.1, 0.9)) * np.array([math.cos(yaw + side), math.sin(yaw + side), 0])
            poses["stone"] = (np.array([at[0], at[1], -12.0]), quaternion(rng.uniform(-math.pi, math.pi), 0.0, 0.0))
        for i, thing in enumerate(self.things):
            at, q = poses.get(thing, ([FAR[0] + 10 * i, FAR[1], FAR[2]], [0, 0, 0, 1]))
            world[thing].pose(at, q, velocity=[0, 0, 0])
        on, looks = math.radians(rng.uniform(6, 14)) * rng.choice([-1, 1]), []
        for look in range(LOOKS):
            world["eye"].pose(_eye(spot, far, yaw + bearing + look * on, down),
                              quaternion(yaw + look * on, down, rng.normal(0, 0.03)), velocity=[0, 0, 0])
            seen = world.tick(1)
            looks.append(picture(np.array(seen["eye_crop/echoes"].pixels)))
            if look == 0 and name != "nothing" and not self._named(name, looks[0], np.array(seen["eye_crop/echo_labels"].pixels)):
                return None
        return np.stack(looks), far

    def _named(self, name, pixels, labels):
        its = labels == LABELS[name]
        return heard(pixels, _mean_of_bins(its) >= 0.5) if self.strict else np.count_nonzero(its) >= LESSON_BINS

    def some(self, each):
        return some_of(self.one, CLASSES, each)
