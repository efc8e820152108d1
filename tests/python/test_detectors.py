"""Detectors of tools/experiment without the program: boxes, crops, training and looking. Exit 77: skipped."""
import json
import math
import os
import re
import shutil
import sys
import tempfile
import unittest
from types import SimpleNamespace

from experiment_tools import TOOLS

import numpy as np

import crops
import detector
import looking
import places
import sonar_crops
from scenario import Failed, Refused

try:
    import cv2
except ModuleNotFoundError:
    cv2 = None
try:
    import torch
except ModuleNotFoundError:
    torch = None


class Boxes(unittest.TestCase):
    """One thing of class 1 with its middle at (32, 16), 20 wide and 8 high, in the raw output of each kind."""

    def found(self, kind, rows):
        (name, sure, box), = [r for r in looking.boxes_of(kind, np.array(rows, np.float32), 2, 64) if r[1] > 0.1]
        self.assertEqual(name, 1)
        np.testing.assert_allclose(box, [22, 12, 20, 8], atol=1e-4)
        return sure

    def test_yolo5_multiplies_objectness_and_share(self):
        self.assertAlmostEqual(self.found("yolo5", [[[32, 16, 20, 8, 0.9, 0.1, 0.8], [5, 5, 2, 2, 0.01, 0.5, 0.5]]]), 0.72, 5)

    def test_yolo8_lies_on_its_side(self):
        self.assertAlmostEqual(self.found("yolo8", np.transpose([[[32, 16, 20, 8, 0.1, 0.8], [5, 5, 2, 2, 0, 0]]], (0, 2, 1))), 0.8, 5)

    def test_ssd_tells_corners_as_shares(self):
        self.assertAlmostEqual(self.found("ssd", [[[[0, 1, 0.7, 22 / 64, 12 / 64, 42 / 64, 20 / 64]]]]), 0.7, 5)

    def test_three_outputs_tell_corners_in_pixels(self):
        out = {"boxes": [[22, 12, 42, 20]], "labels": [[1.0]], "scores": [0.6]}
        self.assertAlmostEqual(looking.boxes_of("rcnn", out, 2, 64)[0][1], 0.6)
        (name, _, box), = looking.boxes_of("rcnn", out, 2, 64)
        self.assertEqual((name, box), (1, (22, 12, 20, 8)))
        self.assertEqual(looking.boxes_of("rcnn", {**out, "labels": [5]}, 2, 64), [])
        self.assertEqual(looking.boxes_of("rcnn", {"boxes": np.zeros((0, 4)), "labels": [], "scores": []}, 2, 64), [])
        for wrong in ({"labels": [0.6], "scores": [1.0]}, {"boxes": [1, 2, 3]}):  # as where two are exchanged
            with self.assertRaisesRegex(Failed, "accepted: n x 4, n whole numbers"):
                looking.boxes_of("rcnn", {**out, **wrong}, 2, 64)

    def test_confidences_that_are_no_shares_are_refused_and_logits_made_shares(self):
        logit = math.log(0.8 / 0.2)
        outputs = {"yolo5": lambda a, b: [[[32, 16, 20, 8, b, -9.0, a]]], "yolo8": lambda a, b: [[[32], [16], [20], [8], [-9.0], [a]]],
                   "ssd": lambda a, b: [[[[0, 1, a, 0.1, 0.1, 0.2, 0.2]]]],
                   "rcnn": lambda a, b: {"boxes": [[1, 2, 3, 4]], "labels": [1], "scores": [a]}}
        for kind, made in outputs.items():
            def found(*values, logits=False):
                out = made(*values)
                return looking.boxes_of(kind, out if kind == "rcnn" else np.array(out, np.float32), 2, 64, logits)
            for wrong in (logit, -3.0):
                with self.assertRaisesRegex(Failed, 'accepted: shares in .*softmax or sigmoid; "outputs_are": "logits"'):
                    found(wrong, 0.5)
            for wrong in (math.nan, math.inf):
                for logits in (False, True):
                    with self.assertRaisesRegex(Failed, "1 are no number or infinite"):
                        found(wrong, 0.5, logits=logits)
            (name, sure, _), = found(logit, 0.0, logits=True)
            self.assertEqual(name, 1)
            self.assertAlmostEqual(sure, 0.4 if kind == "yolo5" else 0.8, 5)
        nan = {"yolo8": [[[math.nan], [16], [20], [8], [0.1], [0.8]]], "ssd": [[[[0, 1, 0.5, math.nan, 0.1, 0.2, 0.2]]]]}
        for kind, out in nan.items():
            with self.assertRaisesRegex(Failed, "no number"):
                looking.boxes_of(kind, np.array(out), 2, 64)
        self.assertEqual(looking.boxes_of("ssd", np.array([[[[-1, 0, 0, 0, 0, 0, 0.0]]]]), 2, 64), [])
        for out, words in ((np.zeros((1, 1, 1, 6)), "rows of 7"), (np.array([[[[0, 0.5, 0.5, 0, 0, 0.1, 0.1]]]]), "no whole number")):
            with self.assertRaisesRegex(Failed, words):
                looking.boxes_of("ssd", out, 2, 64)

    def test_a_classifiers_numbers_are_shares_or_said_to_be_logits(self):
        logits = np.array([[4.0, -1.0, 0.5]])
        whole = np.exp(logits[0]) / np.exp(logits[0]).sum()
        np.testing.assert_allclose(looking.shares_of(logits, 3, logits=True), whole, atol=1e-12)
        np.testing.assert_allclose(looking.shares_of(whole, 3), whole, atol=1e-12)
        np.testing.assert_allclose(looking.shares_of(1000 * logits, 3, logits=True), [1, 0, 0], atol=1e-12)
        for out, words in ((logits, "found shares from -1 to 4; accepted: shares in"), ([0.9, 0.1, 0.1], "sum is 1.1; accepted: 1, as after softmax"),
                           ([math.nan, 0.5, 0.5], "no number"), ([0.5, 0.5], "2 numbers; accepted: a classifier of 3")):
            with self.assertRaisesRegex(Failed, words):
                looking.shares_of(out, 3)

    def test_rows_of_another_width_are_told(self):
        with self.assertRaisesRegex(Failed, "rows of 6 numbers; accepted: 7 for 2 classes of yolo5"):
            looking.boxes_of("yolo5", np.zeros((1, 3, 6)), 2, 64)


class Crops(unittest.TestCase):
    def test_no_place_or_model_of_the_test_is_learnt_from(self):
        of = {k: set(v["places"]) for k, v in places.SPLITS.items()}
        of["train"] |= {name for _, words in crops.LESSONS for name in words.get("places", [])}
        self.assertFalse(of["test"] & (of["train"] | of["choose"]) or of["train"] & of["choose"])
        self.assertLessEqual({w for _, words in crops.LESSONS for w in words.get("waters", [])}, set(places.SPLITS["train"]["waters"]))
        self.assertFalse(set(places.SPLITS["test"]["waters"]) & {w for k in ("train", "choose") for w in places.SPLITS[k]["waters"]})
        for split, names in of.items():
            for name in names:
                self.assertTrue(places.PLACES[name].format(floor=-10, assets="A").count("[[objects]]") > 0 or name == "open", name)
                for object_name in re.findall('^name = "(.*)"', places.PLACES[name], re.M):
                    self.assertRegex(object_name, "^[A-Za-z0-9_-]{1,64}$")
                    self.assertNotIn(object_name, [*crops.CLASSES, "eye", "plant", "rock", *crops.MORE])  # names of one scene
        models = [set(part.split('"')[0] for n in of[k] for part in places.PLACES[n].split("models/")[1:]) for k in ("test", "train", "choose")]
        self.assertFalse(models[0] & (models[1] | models[2]))
        self.assertFalse(models[0] & {part.split('"')[0] for text in crops.MORE.values() for part in text.split("models/")[1:]})

    def test_what_nobody_could_name_is_no_crop(self):
        light = np.tile(np.linspace(60, 120, 64)[:, None, None], (1, 64, 3))
        its = np.zeros((64, 64), bool)
        its[20:34, 20:34] = True
        for off, seen in ((0.0, False), (crops.LEAST_CONTRAST - 1, False), (crops.LEAST_CONTRAST + 1, True)):
            self.assertEqual(crops.visible(light + off * its[..., None], its), seen)
        small = np.zeros((64, 64), bool)
        small[30:40, 30:40] = True  # 100 pixels
        self.assertFalse(crops.visible(light + 50 * small[..., None], small))

    def test_looks_of_the_places_are_each_shipped_diver_and_fish_that_move_where_they_were(self):
        texts = []
        world = SimpleNamespace(images=lambda *names: None)
        tools = SimpleNamespace(write=lambda name, text: texts.append(text), python=lambda: SimpleNamespace(open=lambda path, seed: world))
        for split in places.SPLITS:
            for seed in range(3):
                one, other = (crops.Maker(tools, split, seed, looks=looks) for looks in crops.LOOKS_OF)
                self.assertEqual((one.water, one.place, one.depth, one.fish_scale), (other.water, other.place, other.depth, other.fish_scale))
                self.assertEqual(one.rng.random(), other.rng.random())
            texts.clear()
            for seed in range(60):
                crops.Maker(tools, split, seed, looks="places")
            shown = {name: set() for name in ("diver", "shark", "fish")}
            for text in texts:
                for part in text.split("[[objects]]"):
                    kind = re.search('^class = "(.*)"', part, re.M)
                    if kind and kind[1] in shown:
                        found = [re.search(f'^{key} = "(.*)"', part, re.M) for key in ("model", "node", "clip")]
                        shown[kind[1]].add(tuple(os.path.basename(f[1]) if f else "" for f in found))
            self.assertEqual(shown["shark"], {("shark.glb", "", "swim")})
            self.assertEqual(shown["fish"], {(m, n, "swim") for m, n in (("fish.glb", ""), ("school_fish.glb", "snapper"), ("school_fish.glb", "damsel"))})
            self.assertEqual(shown["diver"], {(f"{m}.glb", "", c) for m in ("diver", "diver_grey", "diver_twin") for c in ("swim", "hover", "cruise", "frog")})

    def test_a_sonar_has_no_looks_of_a_camera(self):
        import training
        with self.assertRaisesRegex(Refused, "looks: found places with eye sonar; accepted: learnt"):
            detector.check({"eye": "sonar", "looks": "places", "model": "shipped"})
        for words in (getattr(sonar_crops, "LOOKS_OF", ()), crops.LOOKS_OF):
            with self.assertRaisesRegex(Refused, "found \"looks=grey\"; accepted: steps=N.*" + ", ".join(f"looks={w}" for w in words) + "$"):
                training.settings_of(["looks=grey"], 5, 1, words)
        self.assertEqual(training.settings_of(["looks=places", "steps=9"], 5, 1, crops.LOOKS_OF), (9, 1, None, None, "places"))

    def test_a_camera_learns_from_equal_parts_of_its_lessons_or_from_those_of_the_asked_looks(self):
        import training
        for split, kinds in (("train", crops.LESSONS), ("choose", crops.CHOOSE)):
            found = training.lessons_of(crops, split, scenes := 30 * len(kinds))
            self.assertEqual([found.count(kind) for kind in kinds], [30 * kinds.count(kind) for kind in kinds])
            for looks in crops.LOOKS_OF:
                only = training.lessons_of(crops, split, scenes, looks)
                self.assertEqual((len(only), {words["looks"] for _, words in only}), (scenes, {looks}))
        self.assertEqual(training.lessons_of(sonar_crops, "choose", 3), [(training.EACH_CHOOSE, {})] * 3)

    def test_a_scene_gives_up_a_class_that_it_cannot_show_and_else_gives_as_many_as_asked(self):
        drawn = {"all": 0, "none": 0, "late": 0, "rare": 0}

        def one(name):
            drawn[name] += 1
            seen = {"all": True, "none": False, "late": drawn[name] > 6, "rare": drawn[name] % 3 == 1}[name]
            return (np.full(2, drawn[name]),) if seen else None
        pictures, classes = crops.some_of(one, list(drawn), (3, 4, 5, 6), patience=6)
        self.assertEqual((np.bincount(classes).tolist(), drawn), ([3, 0, 0, 6], {"all": 3, "none": 6, "late": 6, "rare": 16}))
        drawn.update(dict.fromkeys(drawn, 0))
        pictures, classes = crops.some_of(one, list(drawn), 3, tries=4)
        self.assertEqual((np.bincount(classes).tolist(), drawn), ([3, 0, 3, 3], {"all": 3, "none": 12, "late": 9, "rare": 7}))
        self.assertEqual(pictures[:, 0].tolist(), [1, 2, 3, 7, 8, 9, 1, 4, 7])

    def test_corners_are_as_dark_as_cos4_of_the_angle_says(self):
        drawn = [np.array([0.3, -0.5]), 0.25]
        light = crops.falloff(SimpleNamespace(uniform=lambda *_: drawn.pop(0)), 64, 0.6)
        middle = np.arctan(np.array([0.3, -0.5]) * np.tan(np.radians([27.5, 40.0])))
        across = np.arctan((np.arange(64) + 0.5) / 32 * math.tan(0.3) - math.tan(0.3))
        for row, column in ((0, 0), (63, 0), (10, 50), (32, 32)):
            up, side = math.tan(middle[0] + across[row]), math.tan(middle[1] + across[column])
            cosine = np.dot([1, 0, 0], np.array([1, up, side]) / np.linalg.norm([1, up, side]))
            up, side = math.tan(middle[0] + across[32]), math.tan(middle[1] + across[32])
            at_middle = np.dot([1, 0, 0], np.array([1, up, side]) / np.linalg.norm([1, up, side]))
            self.assertAlmostEqual(light[row, column], (cosine / at_middle) ** (4 * 0.25), 9)
        random = np.random.Generator(np.random.Philox(key=5))
        for _ in range(50):
            light = crops.falloff(random, 64, 0.84)
            self.assertTrue(0.4 < light.min() and light.max() < 1.8, (light.min(), light.max()))

    def test_a_report_shows_a_right_crop_of_each_class_and_the_first_wrong_ones(self):
        classes = np.array([0, 0, 1, 1, 2, 2, 2])
        right = np.array([True, True, False, True, False, False, False])
        self.assertEqual(detector._shown(classes, right), [0, 3, 2, 4, 5])
        self.assertEqual(detector._shown(classes, right | True), [0, 2, 4])

    def test_a_report_tells_every_scene_and_what_is_wrong_by_water_and_size(self):
        sys.path.insert(0, os.path.join(TOOLS, "..", "plot"))
        try:
            import style
        except ModuleNotFoundError:
            self.skipTest("no matplotlib here")
        finally:
            sys.path.pop(0)
        done = [{"seed": seed, "settings": {"eye": "camera"},
                 "series": {"truth": [0, 1, 4], "told": [0, 1 + (seed < 3), 4], "sure": [0.9, 0.6, 0.99], "size": [0.0, 0.04, 0.2],
                            "where": "wreck, 3C" if seed < 6 else "garden, IB", "pictures": []}} for seed in range(1, 11)]
        made = {name: (words, fig) for name, words, fig in detector.figures(None, done, style)}
        told = [t.get_text() for ax in made["where.png"][1].axes for t in ax.texts]
        self.assertEqual(told, ["0 of 15", "2 of 15", "2 of 10", "0 of 10"])
        scenes = [t.get_text() for t in made["crops.png"][1].texts]
        self.assertEqual((scenes[0], scenes[9], len(scenes)), ("seed 1\nwreck\n3C", "seed 10\ngarden\nIB", 10))
        for run in done:  # of an older run, or of a sonar
            del run["series"]["size"]
        old = {name: fig for name, _, fig in detector.figures(None, done, style)}
        self.assertEqual(len(old["where.png"].axes), 1)

    def test_sonar_pictures_are_64_by_64_whatever_the_bins_and_things_in_noise_are_no_crops(self):
        rng = np.random.Generator(np.random.Philox(key=3))
        for finer in (1, 2, 5):
            echoes = rng.gamma(1.0, 1.0, (64 * finer, 64))
            echoes[20 * finer:26 * finer, 30:36] *= 300
            pixels = sonar_crops.picture(echoes)
            self.assertEqual((pixels.shape, pixels.dtype), ((64, 64), np.uint8))
            its = np.zeros((64, 64), bool)
            its[20:26, 30:36] = True
            self.assertGreater(pixels[its].mean(), pixels[~its].mean() + 80)
            self.assertTrue(sonar_crops.heard(pixels, its))
            few = np.zeros((64, 64), bool)
            few[20:22, 30:36] = True
            faint = np.zeros((64, 64), bool)
            faint[40:46, 30:36] = True
            self.assertFalse(sonar_crops.heard(pixels, few) or sonar_crops.heard(pixels, faint))

    def test_no_bottom_frequency_or_beam_of_the_test_is_learnt_from_but_their_ranges_are(self):
        test, train = sonar_crops.SPLITS["test"], sonar_crops.SPLITS["train"]
        for key in test:
            self.assertFalse(set(test[key]) & set(train[key]), key)
        for beam in test["beam"]:
            self.assertTrue(sonar_crops.WIDE_BEAM_DEG[0] < beam < sonar_crops.WIDE_BEAM_DEG[1])
        for impedance in (2700.0 * 5250, 1740.0 * 1615):  # rock, silt
            r, sand = ((z - 1.48e6) / (z + 1.48e6) for z in (impedance, 1941.0 * 1749))
            db = -27 + 20 * np.log10(r / sand)  # Mackenzie 1961
            self.assertTrue(sonar_crops.WIDE_BOTTOM_DB[0] < db < sonar_crops.WIDE_BOTTOM_DB[1])

    @unittest.skipIf(torch is None, "no PyTorch here")
    def test_lessons_vary_by_the_seed_and_keep_their_thing(self):
        import variations
        pictures = np.full((10, 96, 96, 4), 90, np.uint8)
        pictures[..., 3] = 0
        pictures[5:, 36:60, 36:60] = [200, 180, 40, 255]
        classes = np.array([0] * 5 + [1] * 5)
        one, other = (variations.of(torch, pictures, classes, seed) for seed in (7, 7))
        for _ in range(3):
            (x, y), (again, _) = one(16), other(16)
            self.assertTrue(torch.equal(x, again))
            self.assertEqual(tuple(x.shape), (16, 3, 64, 64))
            np.testing.assert_allclose(x.mean((2, 3)).numpy(), 0, atol=1e-4)
            for i in range(16):  # a bright thing of at least 2.5 % is there, or is not
                self.assertEqual(bool((x[i, 0] > 1.5).float().mean() > 0.02 and x[i, 0].max() - x[i, 0].mean() > 1.5 and y[i] == 1), bool(y[i] == 1))


    @unittest.skipIf(torch is None, "no PyTorch here")
    def test_sonar_lessons_are_speckled_anew_with_the_loudest_bin_white(self):
        import variations
        pictures = np.full((4, 64, 64), 100, np.uint8)
        make = variations._Sonar(torch, pictures, np.array([0, 0, 1, 1]), 5)
        out = make._speckled(pictures[0].astype(np.float32), 1.0)
        self.assertEqual(out.max(), 255)
        self.assertAlmostEqual(float(out.std()) * 45 / 255, 5.57, delta=0.3)  # dB of exponential intensities
        self.assertEqual(tuple(make.batch(8)[0].shape), (8, 1, 64, 64))


FAKE = """import numpy as np
CLASSES, SCENES, STEPS = ["nothing", "bar"], 10, 24
class Maker:
    def __init__(self, tools, split, seed):
        self.rng = np.random.Generator(np.random.Philox(key=seed + len(split)))
    def one(self, name):
        picture = self.rng.integers(0, 60, (64, 64)).astype(np.uint8)
        picture[26:36] += 150 * (name == "bar")
        return picture, 1.0
    def close(self):
        pass
"""


@unittest.skipIf(torch is None or cv2 is None, "no PyTorch or no OpenCV here")
class Training(unittest.TestCase):
    def test_weights_are_made_again_to_the_bit_and_read_by_opencv(self):
        import importlib.util
        import training
        spec = importlib.util.spec_from_file_location("experiment_main", os.path.join(TOOLS, "__main__.py"))
        program = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(program)
        before = training.EACH, training.EACH_CHOOSE
        training.EACH, training.EACH_CHOOSE = 8, 4
        with tempfile.TemporaryDirectory() as folder:
            with open(os.path.join(folder, "fake_crops.py"), "w") as file:
                file.write(FAKE)
            sys.path.insert(0, folder)
            try:
                import fake_crops
                program.TRAINED["train_fake"] = ("fake", fake_crops, 1)
                made = []
                for workers in (1, 2):
                    out = os.path.join(folder, str(workers))
                    asked = SimpleNamespace(name="train_fake", out=out, program="none", runs=10, seed=3, workers=workers, quiet=True, set=[])
                    self.assertEqual(program.train(asked), 0)
                    with open(os.path.join(out, "fake.onnx"), "rb") as file:
                        made.append(file.read())
                    self.assertEqual(sorted(os.listdir(out)), ["fake.json", "fake.onnx"])
                self.assertEqual(*made)
                look = looking.Detector(os.path.join(out, "fake.onnx"))
                bar = fake_crops.Maker(None, "test", 99)
                self.assertGreater(look.shares(bar.one("bar")[0])[1], look.shares(bar.one("nothing")[0])[1] + 0.2)
                self.goes_on_from(program, training, os.path.join(out, "fake.onnx"), look, bar.one("bar")[0], folder)
            finally:
                sys.path.remove(folder)
                training.EACH, training.EACH_CHOOSE = before


    def goes_on_from(self, program, training, path, look, picture, folder):
        """The file read as a module answers as OpenCV does, and training goes on from it."""
        import onnx_network
        blob = torch.tensor(looking.normalised(picture).transpose(2, 0, 1)[None])
        with torch.no_grad():
            answer = onnx_network.module_of(torch, path).eval()(blob).softmax(1)[0].numpy()
        np.testing.assert_allclose(answer, look.forward(picture).ravel(), atol=1e-5)
        out = os.path.join(folder, "more")
        asked = SimpleNamespace(name="train_fake", out=out, program="none", runs=10, seed=3, workers=1, quiet=True,
                                set=[f"from={path}", "steps=2", "draw=5", f"with={path}"])
        self.assertEqual(program.train(asked), 0)
        with open(os.path.join(out, "fake.json")) as file:
            self.assertIn("--set from=fake.onnx --set steps=2 --set draw=5 --set with=fake.onnx, from the weights of neritic experiment "
                          "train_fake --runs 10 --seed 3", json.load(file)["made_by"])
        self.looks_with(program, path, out, asked, picture)
        for text in ("steps=0", "steps=-3", "draw=x", "form=a", "from="):
            with self.assertRaisesRegex(Refused, "accepted: steps=N"):
                training.settings_of([text], 3, 1)
        bad = os.path.join(folder, "bad.onnx")
        with open(path, "rb") as file:
            data = file.read()
        for broken in (b"", b"not a network", data[:len(data) // 2], data[:40]):
            with open(bad, "wb") as file:
                file.write(broken)
            with self.assertRaisesRegex(Refused, "accepted: "):
                onnx_network.module_of(torch, bad)


    def looks_with(self, program, other, both, asked, picture):
        """Training beside another network ships it too, with the power that makes the mean of both as sure as it is right."""
        import training
        self.assertEqual(sorted(os.listdir(both)), ["fake.json", "fake.onnx", "fake_with.json", "fake_with.onnx"])
        with open(other, "rb") as one, open(os.path.join(both, "fake_with.onnx"), "rb") as same:
            self.assertEqual(one.read(), same.read())
        two = looking.Detector(os.path.join(both, "fake.onnx"))
        self.assertEqual(two.about["with"], ["fake_with.onnx"])
        alone = looking.Detector(other)
        own, others = two._own_shares(picture).astype(float), alone.shares(picture)
        np.testing.assert_allclose(two.shares(picture), (mean := (own + others) ** two.power) / mean.sum(), atol=1e-6)
        seen = training.gather(program.TRAINED["train_fake"][1], "none", "choose", 3, 3000, 1, False)
        powers = np.exp(np.linspace(np.log(0.3), np.log(3.0), 60))
        means = np.stack([two._own_shares(p).astype(float) + alone.shares(p) for p in seen[0]]) / 2
        loss = [-np.log((means ** p / (means ** p).sum(1, keepdims=True))[np.arange(len(means)), seen[1]]).mean() for p in 1 / powers]
        self.assertAlmostEqual(two.power, 1 / powers[int(np.argmin(loss))], delta=0.05 * two.power)
        asked.set = [f"with={both}/fake.onnx", "steps=2"]
        with self.assertRaisesRegex(Refused, "found with \\['fake_with.onnx'\\].*accepted: a network that looks alone"):
            program.train(asked)


@unittest.skipIf(cv2 is None, "no OpenCV here")
class Looking(unittest.TestCase):
    def test_bad_files_are_refused_in_one_line(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "net.onnx")
            with self.assertRaisesRegex(Refused, "found no such file"):
                looking.Detector(path)
            with open(path, "wb") as file:
                file.write(b"\x08\x07not a network" * 20)
            about = os.path.join(folder, "net.json")
            for text, words in (("{", "found no description"), ('{"kind": "classifier", "classes": [], "side": 64}', "0 classes"),
                                ('{"kind": "guess", "classes": ["a"], "side": 64}', "kind 'guess'"),
                                ('{"kind": "classifier", "classes": ["a"], "side": 64}', "cannot read")):
                with open(about, "w") as file:
                    file.write(text)
                with self.assertRaisesRegex(Refused, words):
                    looking.Detector(path)

    def exported(self, folder, name, outputs, about):
        """A network of four rows that depend on the picture: boxes, labels and scores as torchvision's Faster R-CNN tells them."""
        class Three(torch.nn.Module):
            def __init__(self):
                super().__init__()
                self.part = torch.nn.Conv2d(3, 6, 32, 32)
                torch.nn.init.zeros_(self.part.weight)
                self.part.weight.data[4] = 1 / (3 * 32 * 32)  # the score: the mean of a quarter
                self.part.bias.data[:] = torch.tensor([8.0, 4.0, 40.0, 36.0, 0.0, 1.0])

            def forward(self, x):
                rows = self.part(x).reshape(6, 4)
                told = {"boxes": rows[:4].transpose(0, 1), "labels": rows[5].to(torch.int64), "scores": rows[4]}
                return tuple(told[k] for k in outputs)
        path = os.path.join(folder, name + ".onnx")
        torch.onnx.export(Three().eval(), torch.zeros(1, 3, 64, 64), path, opset_version=11, output_names=["out_" + k for k in "xyz"])
        with open(os.path.join(folder, name + ".json"), "w") as file:
            json.dump({"kind": "rcnn", "classes": ["background", "shark"], "side": 64, "normalise": "none", **about}, file)
        return path

    @unittest.skipIf(torch is None, "no PyTorch here")
    def test_an_export_of_three_outputs_looks_whatever_their_order(self):
        picture = np.zeros((128, 128, 3), np.uint8)
        picture[:64, 64:] = 204  # the second quarter, 0.8
        with tempfile.TemporaryDirectory() as folder:
            for outputs in (["boxes", "labels", "scores"], ["scores", "boxes", "labels"]):
                path = self.exported(folder, "net", outputs, {"outputs": outputs})
                self.assertEqual(looking.check(path, 3), ("rcnn", ["background", "shark"], 1))
                (name, sure, box), = looking.Detector(path).look(picture)
                self.assertEqual(name, "shark")
                self.assertAlmostEqual(sure, 0.8, 5)
                np.testing.assert_allclose(box, (16, 8, 64, 64), atol=1e-4)
            # A background is no finding.
            self.assertEqual(looking.Detector(self.exported(folder, "other", outputs, {"outputs": outputs, "classes": ["shark", "background"]})).look(picture), [])
            with self.assertRaisesRegex(Refused, "outputs .*; accepted: of kind rcnn, boxes, labels, scores"):
                looking.check(self.exported(folder, "bad", outputs, {"outputs": ["boxes", "scores"]}), 3)
            with self.assertRaisesRegex(Refused, "bad.onnx: .*accepted: n x 4, n whole numbers"):
                looking.check(self.exported(folder, "bad", ["labels", "boxes", "scores"], {}), 3)

    @unittest.skipIf(torch is None, "no PyTorch here")
    def test_an_export_without_softmax_is_refused_unless_it_says_so(self):
        net = torch.nn.Sequential(torch.nn.AvgPool2d(64), torch.nn.Flatten(1), torch.nn.Linear(3, 2))
        torch.nn.init.zeros_(net[2].weight)
        net[2].bias.data[:] = torch.tensor([1.0, 4.0])
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "net.onnx")
            torch.onnx.export(net.eval(), torch.zeros(1, 3, 64, 64), path, opset_version=11)
            for more, words in (({}, "net.onnx: found shares from 1 to 4; accepted: .*softmax"), ({"outputs_are": "logits"}, None)):
                with open(os.path.join(folder, "net.json"), "w") as file:
                    json.dump({"kind": "classifier", "classes": ["nothing", "shark"], "side": 64, "normalise": "none", **more}, file)
                if words:
                    with self.assertRaisesRegex(Refused, words):
                        looking.check(path, 3)
            self.assertEqual(looking.check(path, 3)[0], "classifier")
            (name, sure, _), = looking.Detector(path).look(np.zeros((64, 64, 3), np.uint8))
            self.assertEqual(name, "shark")
            self.assertAlmostEqual(sure, 1 / (1 + math.exp(-3)), 5)

    @unittest.skipIf(torch is None, "no PyTorch here")
    def test_a_layer_that_opencv_lacks_is_named(self):
        class Chosen(torch.nn.Module):
            def forward(self, x):
                return x[torch.nonzero(x > 0.5)[:, 0]]
        with tempfile.TemporaryDirectory() as folder:
            path = self.exported(folder, "net", ["boxes", "labels", "scores"], {})
            torch.onnx.export(Chosen(), torch.zeros(10, 4), path, opset_version=11)
            with self.assertRaisesRegex(Refused, "it has no layer NonZero"):
                looking.check(path, 3)

    @unittest.skipUnless(os.path.exists(detector.model_of("shipped")), "no shipped detector")
    def test_what_cannot_look_is_refused_before_a_run(self):
        import shark
        settings = {k: v.default for k, v in shark.SETTINGS.items()}
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "mine.onnx")
            with open(detector.model_of("small"), "rb") as file:
                net = file.read()

            def refused(words, data=net, **more):
                about = {"kind": "classifier", "classes": crops.CLASSES, "side": 64, **more}
                with open(path, "wb") as file:
                    file.write(data)
                with open(os.path.join(folder, "mine.json"), "w") as file:
                    json.dump({k: v for k, v in about.items() if v is not None}, file)
                for check in (lambda: shark.check(settings | {"detector": path}),
                              lambda: detector.check({"eye": "camera", "looks": "learnt", "model": path})):
                    with self.assertRaisesRegex(Refused, words) as caught:
                        check()
                    self.assertNotIn("\n", str(caught.exception))
            refused("mine.onnx: found a network that OpenCV cannot read", b"\x08\x07 no network" * 9)
            refused("mine.onnx: found a network that OpenCV cannot read", net[:len(net) // 2])
            refused("mine.onnx: found a network that OpenCV cannot read", b"")
            refused('mine.json: found key "clases"; accepted: classes', clases=["a"])
            refused('mine.json: found key "normalize"; accepted: normalise', normalize="none")
            refused("mine.json: found no classes; accepted", classes=None)
            refused("found kind 'guess'", kind="guess")
            refused("found a classifier of 5 numbers; accepted: a classifier of 2", classes=["shark", "nothing"])
            refused(r"accepted: (one with a class shark|a classifier of nothing, diver)", classes=["nothing", "diver", "rov", "whale", "fish"])
            refused("found channels 1; accepted: 3 here", channels=1)
            refused("found outputs_are 'numbers'; accepted: shares, logits", outputs_are="numbers")
            refused("found classes 'shark'", classes="shark")
            shark.check(settings | {"detector": "shipped"})

    @unittest.skipUnless(os.path.exists(detector.model_of("shipped")), "no shipped detector")
    def test_several_look_with_their_mean_and_both_ways_round(self):
        picture = np.random.Generator(np.random.Philox(key=2)).integers(0, 255, (64, 64, 3), dtype=np.uint8)
        pair = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, pair)
        for name, of, more in (("a", "shipped", {"with": ["b.onnx"], "power": 1.3}), ("b", "small", {})):
            shutil.copy(detector.model_of(of), os.path.join(pair, name + ".onnx"))
            with open(os.path.join(pair, name + ".json"), "w") as file:
                json.dump({"kind": "classifier", "classes": crops.CLASSES, "side": 64, "mirror": True, **more}, file)
        path = os.path.join(pair, "a.onnx")
        shipped = looking.Detector(path)
        self.assertEqual(len(shipped.others), 1)
        views = []
        for one in (shipped, *shipped.others):
            for side in (picture, np.ascontiguousarray(picture[:, ::-1])):
                one._net.setInput(np.ascontiguousarray(looking.normalised(side).transpose(2, 0, 1)[None]))
                views.append(one._net.forward().ravel().astype(float))
        mean = np.mean(views, axis=0) ** shipped.power
        np.testing.assert_allclose(shipped.shares(picture), mean / mean.sum(), atol=1e-6)
        self.assertEqual(len(looking.files_of(path)), 4)
        with tempfile.TemporaryDirectory() as folder:
            for name in ("a.onnx", "b.onnx"):
                shutil.copy(detector.model_of("small"), os.path.join(folder, name))
            about = {"kind": "classifier", "classes": crops.CLASSES, "side": 64}
            for a, b, words in (({"with": ["b.onnx"]}, {"with": ["a.onnx"]}, "looks with another"), ({"with": ["a.onnx"]}, {}, "found with"),
                                ({"with": ["../b.onnx"]}, {}, "beside it"), ({"with": ["b.onnx"]}, {"classes": ["a"]}, "of the same classes"),
                                ({"power": True}, {}, "found power True"), ({"mirror": 1}, {}, "mirror 1")):
                for name, more in (("a", a), ("b", b)):
                    with open(os.path.join(folder, name + ".json"), "w") as file:
                        json.dump({**about, **more}, file)
                with self.assertRaisesRegex(Refused, words):
                    looking.Detector(os.path.join(folder, "a.onnx"))

    @unittest.skipUnless(os.path.exists(detector.model_of("shipped")), "no shipped detector")
    def test_looks_at_one_thing_count_together_and_their_number_is_checked(self):
        rng = np.random.Generator(np.random.Philox(key=4))
        looks = rng.integers(0, 255, (3, 64, 64, 3), dtype=np.uint8)
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "a.onnx")
            shutil.copy(detector.model_of("small"), path)

            def with_more(**more):
                with open(os.path.join(folder, "a.json"), "w") as file:
                    json.dump({"kind": "classifier", "classes": crops.CLASSES, "side": 64, **more}, file)
                return looking.Detector(path)
            alone = with_more()
            mean = np.mean([alone.shares(look) for look in looks], axis=0) ** 1.5
            np.testing.assert_allclose(with_more(looks=3, power=1.5).shares(looks), mean / mean.sum(), atol=1e-6)
            for wrong, pixels in ((with_more(looks=3), looks[:2]), (with_more(looks=3), looks[0]), (alone, looks)):
                with self.assertRaisesRegex(Failed, "accepted: [13] of one thing"):
                    wrong.shares(pixels)
            for bad in (0, 1.5, True, "3"):
                with self.assertRaisesRegex(Refused, "a whole number in"):
                    with_more(looks=bad)

    @unittest.skipUnless(os.path.exists(detector.model_of("shipped")), "no shipped detector")
    def test_a_thread_answers_and_drops_what_is_old(self):
        shipped = looking.Detector(detector.model_of("shipped"))
        self.assertEqual(shipped.classes, crops.CLASSES)
        self.assertLess(os.path.getsize(detector.model_of("shipped")), 1_400_000)
        rng = np.random.Generator(np.random.Philox(key=1))
        picture = rng.integers(0, 255, (48, 80, 3), dtype=np.uint8)
        shares = shipped.shares(picture)
        self.assertAlmostEqual(float(shares.sum()), 1.0, 5)
        np.testing.assert_array_equal(shares, shipped.shares(picture))  # the same bits
        looker = looking.Looker(shipped, 0.0)
        for i in range(50):
            looker.show(picture, i)
        told = looker.answers(wait_s=10)
        while told[-1]["sequence"] != 49:
            told += looker.answers(wait_s=10)
        looker.close()
        self.assertEqual(len(told) + looker.dropped, 50)
        self.assertTrue(all(a["latency_s"] >= a["work_s"] > 0 for a in told))


if __name__ == "__main__":
    unittest.main()
