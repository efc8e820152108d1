"""Crops of a gaze: small pictures of one thing each, from scenes that are drawn by a seed.

A scene is a place, a water, a light and a camera of some opening angle (places.py); in it the diver, the ROV, the shark,
the fish or nothing stand before the camera in random poses, sizes and places of the crop, some behind a plant or a rock.
Scenes to learn from have more things that are none of them. Half of these scenes are drawn from wider ranges (WIDE_RANGES),
with up to three such things in a crop, before and behind. With the looks of the places, each scene has one of the shipped
divers, moving by one of their clips, and one kind of the shipped fish, which swims; and a crop is a part of a wider picture with
dark corners. A thing that nobody could name is no crop: one that covers less than LEAST_SHARE of it (123 pixels of 64 x 64), or
whose pixels differ from the light around them by less than LEAST_CONTRAST of 255 levels (rms), three times the noise of the
noisiest camera.
"""
import math
import os

import numpy as np

from places import CLEAR, FARTHEST_M, PLACES, SPLITS, STREWN
from rotations import quaternion
from scenario import SHIPPED

CLASSES = ["nothing", "diver", "rov", "shark", "fish"]
LABELS = {"diver": 4, "rov": 5, "shark": 7, "fish": 6}  # the scene's classes
LENGTHS_M = {"diver": 1.8, "rov": 0.6, "shark": 3.0, "fish": 0.21}
SIDE = 64
LEAST_SHARE, LEAST_CONTRAST, MOST_NOISE = 0.03, 7.5, 2.5
# To learn from, and to choose by: crops of each class, and how the scene is opened, of equal parts of the scenes.
EACH = (16, 12, 9, 14, 12)
LESSONS = [(EACH, {"margin": 1.5, "wide": wide, "looks": looks}) for looks in ("learnt", "places", "places") for wide in (False, True)]
# Small things on the bottom, near and far, are what a network most often takes for a shark: these scenes have more of nothing.
LESSONS += [((40, 6, 5, 10, 6), {"margin": 1.5, "wide": True, "looks": "places", "places": STREWN}),
            ((40, 8, 5, 12, 8), {"margin": 1.5, "wide": False, "looks": "places", "places": STREWN, "waters": CLEAR})]
CHOOSE = [(10, {"looks": looks}) for looks in ("learnt", "places")]
PATIENCE = 8  # draws of a class in a scene to learn from, that give none, until it is given up
SCENES, STEPS, COOL = 534, 6000, 3500  # to learn from; of the training; of these, in which it ends
FINE = True  # the network has a further block of its finest maps
# others: how often something else stands there too, beside a thing and where there is none.
RANGES = {"depth_m": (4.0, 25.0), "fov_deg": (14.0, 35.0), "fish_scale": (2.0, 4.0), "fills": (0.35, 1.1), "sight": (0.5, 1.0), "down": 0.2,
          "others": (0.3, 0.6)}
WIDE_RANGES = {"depth_m": (3.0, 30.0), "fov_deg": (12.0, 48.0), "fish_scale": (1.5, 4.5), "fills": (0.3, 1.3), "sight": (0.3, 1.0), "down": 0.3,
               "others": (0.35, 0.85)}
# (model, node, scale that makes it as long as fish.glb). What is drawn of these comes from a generator of its own, APART.
FISH = [("fish", "", 1.0), ("school_fish", "snapper", 0.77), ("school_fish", "damsel", 1.9)]
DIVERS, CLIPS = ["diver", "diver_grey", "diver_twin"], ["swim", "hover", "cruise", "frog"]
APART, LOOKS_OF = 1 << 42, ["learnt", "places"]
MOST_VIGNETTE, HALF_PICTURE_RAD = 0.3, np.radians([27.5, 40.0])  # the scenes' cameras have 0.25 at most; rows, columns
FAR = [900.0, 900.0, -40.0]
ASSETS = os.path.normpath(os.path.join(SHIPPED, ".."))
# Beside plant and rock, in scenes to learn from: three or four a scene, of these.
MORE = {"turtle": 'model = "{assets}/models/turtle.glb"\nclip = "swim"', "ray": 'model = "{assets}/models/ray.glb"\nclip = "swim"',
        "jellyfish": 'model = "{assets}/models/jellyfish.glb"\nscale = 2',
        "drum": 'model = "{assets}/models/relics.glb"\nnode = "drum"', "anchor": 'model = "{assets}/models/relics.glb"\nnode = "anchor"',
        "tyre": 'model = "{assets}/models/relics.glb"\nnode = "tyre"', "rope": 'model = "{assets}/models/relics.glb"\nnode = "rope"',
        "boulder": 'model = "{assets}/models/rocks.glb"\nnode = "rock_1"\nscale = 0.5',
        "stone": 'model = "{assets}/models/rocks.glb"\nnode = "rock_2"\nscale = 0.4',
        "tuft": 'model = "{assets}/models/eelgrass.glb"\nscale = 1.5', "frond": 'model = "{assets}/models/giant_kelp.glb"\nscale = 0.2',
        "box": 'shape = "box"\nsize_m = [0.7, 0.35, 0.5]\ncolor = [{tint:.2f}, {tint:.2f}, 0.2]',
        "post": 'shape = "cylinder"\nradius_m = 0.12\nheight_m = 2.2\ncolor = [{tint:.2f}, 0.3, {tint:.2f}]',
        "buoy": 'shape = "sphere"\nradius_m = 0.3\ncolor = [0.6, {tint:.2f}, 0.1]'}

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
{drawn}
inputs = {{ pose = {{ from = "python", hold_s = 3600 }} }}
"""


def contrast(pixels, its):
    """How far a thing's pixels are from its surroundings, whose light falls off evenly: rms of levels."""
    row, column = np.indices(its.shape) / its.shape[0]
    terms = np.stack([np.ones(its.shape), row, column], axis=-1)
    fit = np.linalg.lstsq(terms[~its], pixels[~its].astype(float), rcond=None)[0]
    return float(np.sqrt(((pixels[its] - terms[its] @ fit) ** 2).mean()))


def visible(pixels, its):
    """Whether anybody could name the thing of these pixels."""
    return LEAST_SHARE <= its.mean() <= 0.9 and contrast(pixels, its) >= LEAST_CONTRAST


def falloff(random, side, fov):
    """How bright each pixel [side, side] of a crop is that opens by fov (radians) somewhere in a wider picture, whose corners are
    dark: cos^4 of the angle off its middle, to a power of at most MOST_VIGNETTE, as a camera's `vignette`. The crop's middle is 1."""
    off = np.arctan(random.uniform(-1, 1, 2) * np.tan(HALF_PICTURE_RAD))
    across = (np.arange(side) + 0.5) / side * 2 * math.tan(fov / 2) - math.tan(fov / 2)
    squared = np.add.outer(np.tan(off[0] + np.arctan(across)) ** 2, np.tan(off[1] + np.arctan(across)) ** 2)
    light = (1 + squared) ** (-2 * random.uniform(0, MOST_VIGNETTE))  # cos^2 = 1 / (1 + tan^2)
    return light / light[side // 2, side // 2]


class Maker:
    """Crops of one seed's scene. tools: as the runner gives them; it belongs to one thread. margin: how much wider than a
    crop the camera looks, for training to cut crops from. looks: of LOOKS_OF; poses, waters and places are the same with each. places, waters: in place of
    the split's."""

    def __init__(self, tools, split, seed, side=SIDE, margin=1.0, wide=False, looks="learnt", places=None, waters=None):
        first = {"train": 0, "choose": 1 << 41, "test": 1 << 40}[split]
        self.rng = rng = np.random.Generator(np.random.Philox(key=seed + first))
        self.varied, self.ranges = wide, WIDE_RANGES if wide else RANGES
        self.water = str(rng.choice(waters or SPLITS[split]["waters"]))
        self.place = str(rng.choice(places or SPLITS[split]["places"]))
        self.depth, self.fov = rng.uniform(*self.ranges["depth_m"]), math.radians(rng.uniform(*self.ranges["fov_deg"]))
        self.over_floor, self.fish_scale = 6.0 + rng.uniform(0, 2), rng.uniform(*self.ranges["fish_scale"])
        self.side, self.wide = side, round(side * margin)
        floor, lamp = -(self.depth + 3.0), ""
        if rng.random() < 0.35:
            lamp = f"[[objects.lamps]]\nname = \"torch\"\nintensity_cd = {rng.uniform(200, 2500):.0f}\nposition_m = [0.3, 0.1, 0]\n"
        opening = 2 * math.atan(self.wide / side * math.tan(self.fov / 2))
        text = HEAD.format(seed=seed, elevation=rng.uniform(15, 85), azimuth=rng.uniform(-180, 180), overcast=rng.random(),
                           depth=self.depth + 3, water=self.water, side=self.wide, fov=math.degrees(opening), lamp=lamp)
        text += PLACES[self.place].format(floor=floor, assets=ASSETS)
        self.hides = ["plant", "rock"]
        if split == "train":
            self.hides += [str(name) for name in rng.choice(list(MORE), 4 if wide else 3, replace=False)]
        self.apart = np.random.Generator(np.random.Philox(key=seed + first + APART))
        moves = '\nclip = "{}"\nclip_rate = 37.3'  # so that a step is another phase of the stroke
        diver, clip, (fish, node, longer) = "diver", "swim", ("fish", "", 1.0)
        self.as_places = looks == "places"
        if self.as_places:
            diver, clip, (fish, node, longer) = (of[self.apart.integers(len(of))] for of in (DIVERS, CLIPS, FISH))
        shown = {"diver": f'model = "{ASSETS}/models/{diver}.glb"' + moves.format(clip),
                 "shark": f'model = "{ASSETS}/models/shark.glb"' + moves.format("swim"),
                 "rov": f'model = "{ASSETS}/models/rov.glb"',
                 "fish": f'model = "{ASSETS}/models/{fish}.glb"\nscale = {self.fish_scale * longer:.3f}'
                         + (moves.format("swim") if self.as_places else "") + (f'\nnode = "{node}"' if node else ""),
                 "plant": f'model = "{ASSETS}/models/kelp.glb"\nscale = 0.5',
                 "rock": f'model = "{ASSETS}/models/rocks.glb"\nnode = "rock_0"\nscale = 0.5'}
        for name in self.hides[2:]:
            shown[name] = MORE[name].format(assets=ASSETS, tint=rng.uniform(0.1, 0.9))
        for name, drawn in shown.items():
            text += THING.format(name=name, drawn=drawn, kind="target" if name in MORE else name)
        self.world = tools.python().open(tools.write(f"crops_{split}_{seed}.toml", text), seed=seed)
        self.world.images("eye_crop/color", "eye_crop/labels")
        self.things = list(shown)

    def close(self):
        self.world.close()

    def _length(self, name):
        return LENGTHS_M[name] * (self.fish_scale if name == "fish" else 1.0)

    def one(self, name):
        """(pixels [side, side, 3], range in metres) of this class, or None where it cannot be seen."""
        drawn = self.drawn(name)
        if drawn is None:
            return None
        pixels, its, far = drawn
        self.size = float(its.mean())
        noise, gain = self.rng.uniform(0.5, MOST_NOISE), self.rng.uniform(0.85, 1.15)
        if self.as_places:
            gain = gain * falloff(self.apart, self.side, self.fov)[..., None]
        pixels = pixels * gain + self.rng.normal(0.0, noise, pixels.shape)
        return np.clip(np.rint(pixels), 0, 255).astype(np.uint8), far

    def lesson(self, name):
        """([wide, wide, 4]: colours, and 255 where the thing is,), for training to vary; or None."""
        drawn = self.drawn(name)
        return None if drawn is None else (np.dstack([drawn[0], np.where(drawn[1], 255, 0).astype(np.uint8)]),)

    def drawn(self, name):
        """(pixels [wide, wide, 3], which of them are its own, range) without a camera's noise, or None."""
        rng, world = self.rng, self.world
        eye = np.array([rng.uniform(-8, 8), rng.uniform(-8, 8), -self.depth + rng.uniform(-1.5, 1.5)])
        yaw, down = rng.uniform(-math.pi, math.pi), rng.normal(0.0, self.ranges["down"])
        ahead = np.array([math.cos(yaw) * math.cos(down), math.sin(yaw) * math.cos(down), -math.sin(down)])
        left = np.array([-math.sin(yaw), math.cos(yaw), 0.0])
        up = np.cross(ahead, left)
        poses, far = {}, FARTHEST_M[self.water] * rng.uniform(*self.ranges["sight"])
        if name != "nothing":
            length = self._length(name)
            far = min(far, length / (2 * math.tan(rng.uniform(*self.ranges["fills"]) * self.fov / 2)))
            if 2 * math.atan(length / 2 / far) > (2.2 if name == "shark" else 1.6) * self.fov:
                return None  # nearer than a crop can hold
            off = rng.normal(0.0, 0.10, 2).clip(-0.25, 0.25) * self.fov * far
            poses[name] = (eye + far * ahead + off[0] * left + off[1] * up, self._pose(name))
        for others in range(3 if self.varied else 1):
            if rng.random() >= self.ranges["others"][name == "nothing"] * (1.0, 0.6, 0.4)[others]:
                break
            near, hides = far * rng.uniform(0.4, 0.8), str(rng.choice(self.hides))
            if others:  # anywhere, also behind
                near = far * rng.uniform(0.4, 1.6)
            place = eye + near * (ahead + rng.uniform(-0.5, 0.5) * self.fov * left + rng.uniform(-0.4, 0.2) * self.fov * up)
            tilt = rng.uniform(-1.2, 1.2) if hides in MORE else 0.0
            poses[hides] = (place, quaternion(rng.uniform(-math.pi, math.pi), tilt, 0.0))
        world["eye"].pose(eye, quaternion(yaw, down, rng.normal(0, 0.05)), velocity=[0, 0, 0])
        for i, thing in enumerate(self.things):
            at, q = poses.get(thing, ([FAR[0] + 10 * i, FAR[1], FAR[2]], [0, 0, 0, 1]))
            world[thing].pose(at, q, velocity=[0, 0, 0])
        seen = world.tick(1)
        pixels, labels = np.array(seen["eye_crop/color"].pixels), np.array(seen["eye_crop/labels"].pixels)
        its = labels == LABELS[name] if name != "nothing" else np.zeros(labels.shape, bool)
        edge = (self.wide - self.side) // 2
        middle = slice(edge, edge + self.side)
        if name != "nothing" and not visible(pixels[middle, middle], its[middle, middle]):
            return None
        return pixels, its, far

    def _pose(self, name):
        rng = self.rng
        down, roll = {"diver": (rng.uniform(0.9, 1.75) if rng.random() < 0.6 else rng.uniform(-0.3, 0.9), 0.25),
                      "shark": (rng.normal(0, 0.2), 0.3), "rov": (rng.normal(0, 0.15), 0.15),
                      "fish": (rng.normal(0, 0.2), 0.2)}[name]
        return quaternion(rng.uniform(-math.pi, math.pi), down, rng.normal(0, roll))

    def some(self, each):
        """As some_of; `sizes` becomes the share of the crop that each thing covers."""
        self.sizes = []

        def one(name):
            given = self.one(name)
            if given is not None:
                self.sizes.append(self.size)
            return given
        return some_of(one, CLASSES, each)


def some_of(one, names, each, tries=4, patience=None):
    """(first parts of what one(name) gives, classes [n]): this number of each class (or one number a class), fewer where they
    cannot be seen. patience: draws after which a class that gave none yet is given up, as too large or faint for this scene."""
    found, classes = [], []
    for index, name in enumerate(names):
        made, asked = 0, each if isinstance(each, int) else each[index]
        for drawn in range(tries * asked):
            if made == asked or (made == 0 and drawn == patience):
                break
            given = one(name)
            if given is not None:
                found.append(given[0])
                classes.append(index)
                made += 1
    return np.stack(found), np.array(classes)
