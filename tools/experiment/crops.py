"""Crops of a gaze: small pictures of one thing each, from scenes that are drawn by a seed.

A scene is an environment, a water, a light and a camera of some opening angle; in it the diver, the ROV, the shark, the
fish or nothing stand before the camera in random poses, sizes and places of the crop, some behind a plant or a rock. Water
types and environments of SPLITS["test"] never occur in "train". A crop whose thing covers less than LEAST_SHARE of
it, or differs from its surroundings by less than LEAST_CONTRAST levels, is not made: nobody could name it.
"""
import math
import os

import numpy as np

from scenario import SHIPPED

CLASSES = ["nothing", "diver", "rov", "shark", "fish"]
LABELS = {"diver": 4, "rov": 5, "shark": 7, "fish": 6}  # the scene's classes
LENGTHS_M = {"diver": 1.8, "rov": 0.6, "shark": 3.0, "fish": 0.21}
SIDE = 64
LEAST_SHARE, LEAST_CONTRAST = 0.03, 5.0
# Jerlov's type: how far things are shown, some three attenuation lengths.
FARTHEST_M = {"I": 20.0, "IA": 18.0, "IB": 15.0, "II": 12.0, "III": 8.0, "1C": 7.0, "3C": 5.0, "5C": 4.0}
SPLITS = {"train": {"waters": ["I", "IA", "II", "III", "1C", "5C"], "places": ["open", "sand", "tiles", "rocks", "ridge"]},
          "test": {"waters": ["IB", "3C"], "places": ["wreck", "garden"]}}
FAR = [900.0, 900.0, -40.0]
ASSETS = os.path.normpath(os.path.join(SHIPPED, ".."))

PLACES = {
    "open": "",
    "sand": ('[[objects]]\nname = "floor"\nclass = "seabed"\nshape = "plane"\nsize_m = [160, 160]\nposition_m = [0, {floor}, 0]\n'
             'color_texture = "{assets}/textures/sand_color.jpg"\ntexture_m = 3\n'),
    "tiles": ('[[objects]]\nname = "floor"\nclass = "structure"\nshape = "plane"\nsize_m = [80, 80]\nposition_m = [0, {floor}, 0]\n'
              'color_texture = "{assets}/textures/tiles_color.jpg"\ntexture_m = 2\n'
              '[[objects]]\nname = "wall"\nclass = "structure"\nshape = "box"\nsize_m = [80, 8, 0.4]\nposition_m = [0, {floor}, -14]\n'
              'color_texture = "{assets}/textures/tiles_color.jpg"\ntexture_m = 2\n'),
    "rocks": ('[[objects]]\nname = "floor"\nclass = "seabed"\nshape = "plane"\nsize_m = [160, 160]\nposition_m = [0, {floor}, 0]\n'
              'color_texture = "{assets}/textures/sand_color.jpg"\n'
              '[[objects]]\nname = "stones"\nclass = "rock"\nmodel = "{assets}/models/rocks.glb"\nnode = "rock_1"\n'
              'scatter = {{ count = 40, area_m = [-16, -16, 16, 16], on = "floor", scale = [0.6, 2.5] }}\n'
              '[[objects]]\nname = "pipe"\nclass = "pipe"\nshape = "cylinder"\nradius_m = 0.3\nheight_m = 30\npitch_deg = 90\n'
              'position_m = [3, {floor}, 0]\ncolor = [0.3, 0.28, 0.2]\n'),
    "ridge": ('[[objects]]\nname = "floor"\nclass = "seabed"\nterrain = "{assets}/terrain/ridge.npy"\ncell_m = 0.5\n'
              'height_offset_m = {floor}\ncolor_texture = "{assets}/textures/sand_color.jpg"\n'
              '[[objects]]\nname = "weed"\nclass = "plant"\nmodel = "{assets}/models/kelp.glb"\n'
              'scatter = {{ count = 20, area_m = [-12, -12, 12, 12], on = "floor", scale = [0.4, 1.2] }}\n'),
    "wreck": ('[[objects]]\nname = "floor"\nclass = "seabed"\nmodel = "{assets}/models/seabed.glb"\nposition_m = [0, {floor}, 0]\n'
              '[[objects]]\nname = "submarine"\nclass = "wreck"\nmodel = "{assets}/models/submarine.glb"\n'
              'position_m = [-6, {floor}, 0]\nyaw_deg = -3\nroll_deg = -9\n'),
    "garden": ('[[objects]]\nname = "floor"\nclass = "seabed"\nmodel = "{assets}/models/seabed.glb"\nposition_m = [0, {floor}, 0]\n'
               '[[objects]]\nname = "weed"\nclass = "plant"\nmodel = "{assets}/models/seagrass.glb"\n'
               'scatter = {{ count = 60, area_m = [-14, -14, 14, 14], on = "floor", scale = [0.7, 1.6] }}\n'
               '[[objects]]\nname = "coral"\nclass = "coral"\nmodel = "{assets}/models/corals.glb"\nnode = "coral_0"\n'
               'scatter = {{ count = 25, area_m = [-14, -14, 14, 14], on = "floor", scale = [0.7, 2.0] }}\n'),
}
HEAD = """title = "Crops"
seed = {seed}
[physics]
rate_hz = 60
[sun]
elevation_deg = {elevation:.2f}
azimuth_deg = {azimuth:.2f}
overcast = {overcast:.2f}
[ambient]
bottom_depth_m = {depth:.2f}
[water]
type = "{water}"
scattering = true
surface = true
[[objects]]
name = "eye"
shape = "sphere"
radius_m = 0.001
inputs = {{ pose = {{ from = "python", hold_s = 3600 }} }}
[[objects.cameras]]
name = "crop"
width = {side}
height = {side}
fov_deg = {fov:.2f}
rate_hz = 60
antialias = true
{lamp}
"""
THING = """[[objects]]
name = "{name}"
class = "{kind}"
model = "{assets}/models/{model}"
{more}
inputs = {{ pose = {{ from = "python", hold_s = 3600 }} }}
"""


def rotation(yaw, pitch_down, roll):
    """x y z w, world from body (forward, left, up): about up, then about the own left, then about the own forward."""
    z, y, x = (np.array([math.sin(a / 2), math.cos(a / 2)]) for a in (yaw, pitch_down, roll))
    q = _times([0, 0, z[0], z[1]], [0, y[0], 0, y[1]])
    return _times(q, [x[0], 0, 0, x[1]])


def _times(a, b):
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return [aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz]


def contrast(pixels, its):
    """How far a thing's pixels are from its surroundings, whose light falls off evenly: rms of levels."""
    row, column = np.indices(its.shape) / its.shape[0]
    terms = np.stack([np.ones(its.shape), row, column], axis=-1)
    fit = np.linalg.lstsq(terms[~its], pixels[~its].astype(float), rcond=None)[0]
    return float(np.sqrt(((pixels[its] - terms[its] @ fit) ** 2).mean()))


class Maker:
    """Crops of one seed's scene. tools: as the runner gives them; it belongs to one thread."""

    def __init__(self, tools, split, seed, side=SIDE):
        self.rng = rng = np.random.Generator(np.random.Philox(key=seed + (1 << 40 if split == "test" else 0)))
        self.water = str(rng.choice(SPLITS[split]["waters"]))
        self.place = str(rng.choice(SPLITS[split]["places"]))
        self.depth, self.fov = rng.uniform(4.0, 25.0), math.radians(rng.uniform(14.0, 35.0))
        self.over_floor, self.fish_scale = 6.0 + rng.uniform(0, 2), rng.uniform(2.0, 4.0)
        floor, lamp = -(self.depth + 3.0), ""
        if rng.random() < 0.35:
            lamp = f"[[objects.lamps]]\nname = \"torch\"\nintensity_cd = {rng.uniform(200, 2500):.0f}\nposition_m = [0.3, 0.1, 0]\n"
        text = HEAD.format(seed=seed, elevation=rng.uniform(15, 85), azimuth=rng.uniform(-180, 180), overcast=rng.random(),
                           depth=self.depth + 3, water=self.water, side=side, fov=math.degrees(self.fov), lamp=lamp)
        text += PLACES[self.place].format(floor=floor, assets=ASSETS)
        swim = 'clip = "swim"\nclip_rate = 37.3'  # so that a step is another phase of the stroke
        for name, model, kind, more in (("diver", "diver.glb", "diver", swim), ("shark", "shark.glb", "shark", swim),
                                        ("rov", "rov.glb", "rov", ""), ("fish", "fish.glb", "fish", f"scale = {self.fish_scale:.3f}"),
                                        ("plant", "kelp.glb", "plant", "scale = 0.5"),
                                        ("rock", "rocks.glb", "rock", 'node = "rock_0"\nscale = 0.5')):
            text += THING.format(name=name, model=model, kind=kind, more=more, assets=ASSETS)
        self.world = tools.python().open(tools.write(f"crops_{split}_{seed}.toml", text), seed=seed)
        self.world.images("eye_crop/color", "eye_crop/labels")
        self.things = ["diver", "rov", "shark", "fish", "plant", "rock"]

    def close(self):
        self.world.close()

    def _length(self, name):
        return LENGTHS_M[name] * (self.fish_scale if name == "fish" else 1.0)

    def one(self, name):
        """(pixels [side, side, 3], what it is told of) of this class, or None where it cannot be seen."""
        rng, world = self.rng, self.world
        eye = np.array([rng.uniform(-8, 8), rng.uniform(-8, 8), -self.depth + rng.uniform(-1.5, 1.5)])
        yaw, down = rng.uniform(-math.pi, math.pi), rng.normal(0.0, 0.2)
        ahead = np.array([math.cos(yaw) * math.cos(down), math.sin(yaw) * math.cos(down), -math.sin(down)])
        left, up = np.array([-math.sin(yaw), math.cos(yaw), 0.0]), None
        up = np.cross(ahead, left)
        poses, far = {}, FARTHEST_M[self.water] * rng.uniform(0.5, 1.0)
        if name != "nothing":
            length = self._length(name)
            far = min(far, length / (2 * math.tan(rng.uniform(0.35, 1.1) * self.fov / 2)))
            if 2 * math.atan(length / 2 / far) > (2.2 if name == "shark" else 1.6) * self.fov:
                return None  # nearer than a crop can hold
            off = rng.normal(0.0, 0.10, 2).clip(-0.25, 0.25) * self.fov * far
            turn = {"diver": (rng.uniform(0.9, 1.75) if rng.random() < 0.6 else rng.uniform(-0.3, 0.9), 0.25),
                    "shark": (rng.normal(0, 0.2), 0.3), "rov": (rng.normal(0, 0.15), 0.15),
                    "fish": (rng.normal(0, 0.2), 0.2)}[name]
            poses[name] = (eye + far * ahead + off[0] * left + off[1] * up,
                           rotation(rng.uniform(-math.pi, math.pi), turn[0], rng.normal(0, turn[1])))
        if rng.random() < (0.3 if name != "nothing" else 0.6):
            near, hides = far * rng.uniform(0.4, 0.8), str(rng.choice(["plant", "rock"]))
            place = eye + near * (ahead + rng.uniform(-0.5, 0.5) * self.fov * left + rng.uniform(-0.4, 0.2) * self.fov * up)
            poses[hides] = (place, rotation(rng.uniform(-math.pi, math.pi), 0.0, 0.0))
        world["eye"].pose(eye, rotation(yaw, down, rng.normal(0, 0.05)), velocity=[0, 0, 0])
        for i, thing in enumerate(self.things):
            at, q = poses.get(thing, ([FAR[0] + 10 * i, FAR[1], FAR[2]], [0, 0, 0, 1]))
            world[thing].pose(at, q, velocity=[0, 0, 0])
        seen = world.tick(1)
        pixels, labels = np.array(seen["eye_crop/color"].pixels), np.array(seen["eye_crop/labels"].pixels)
        noise, gain = rng.uniform(0.5, 2.5), rng.uniform(0.85, 1.15)
        if name != "nothing":
            its = labels == LABELS[name]
            if its.mean() < LEAST_SHARE or its.mean() > 0.9:
                return None
            if contrast(pixels, its) < LEAST_CONTRAST:
                return None
        pixels = pixels * gain + rng.normal(0.0, noise, pixels.shape)
        return np.clip(np.rint(pixels), 0, 255).astype(np.uint8), {"range_m": far}

    def some(self, each):
        return some_of(self, CLASSES, each)


def some_of(maker, names, each):
    """(pixels [n, side, side, ...], classes [n]): so many of each class, fewer where they cannot be seen."""
    pixels, classes = [], []
    for index, name in enumerate(names):
        made = 0
        for _ in range(4 * each):
            if made == each:
                break
            one = maker.one(name)
            if one is not None:
                pixels.append(one[0])
                classes.append(index)
                made += 1
    return np.stack(pixels), np.array(classes)
