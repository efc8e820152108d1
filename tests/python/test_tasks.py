"""Tasks of neritic experiment: formulas, triggers, measures, scenario files. Exit 77: skipped."""
import json
import math
import os
import re
import shutil
import sys
import tempfile
import unittest
import unittest.mock
from types import SimpleNamespace

import experiment_tools  # noqa: F401

import numpy as np

import runner
import scenario


class Words(unittest.TestCase):
    """How often the ROV of the shark's task is told its place."""

    def test_words_have_the_rate_that_was_asked_for(self):
        import shark
        for control_hz, physics_hz in ((50, 240), (7, 240), (20, 240), (60, 70), (60, 60), (1, 1000)):
            told, seen = [], []

            class World(dict):
                time, step, step_s = 0.0, 5, 1.0 / physics_hz

                def tick(self, steps):
                    self.step += steps
                    self.time = (self.step - 5) * self.step_s
            world = World(diver=SimpleNamespace(pose=lambda *_, **__: None), shark=SimpleNamespace(pose=lambda *_, **__: None))
            flight = shark._Flight.__new__(shark._Flight)
            flight.s = {k: v.default for k, v in shark.SETTINGS.items()} | {"control_hz": control_hz, "physics_hz": physics_hz, "seconds": 3.0}
            flight.world, flight.person, flight.gaze, flight.met_s = world, None, None, 0.0
            flight._steer = lambda *_: told.append(world.step - 5)
            flight._see = lambda: seen.append(world.step - 5)
            flight.fly()
            self.assertEqual(told, [math.ceil(i * physics_hz / control_hz - 1e-6) for i in range(3 * control_hz)], (control_hz, physics_hz))
            self.assertLessEqual(max(np.diff([0, *seen])), physics_hz / 20, (control_hz, physics_hz))
        with self.assertRaisesRegex(scenario.Refused, "control_hz: found 100; accepted: at most physics_hz, 60"):
            shark.check(flight.s | {"control_hz": 100.0, "physics_hz": 60})


class Criteria(unittest.TestCase):
    """Those that no run could ever hold are refused before the first."""

    def test_what_cannot_hold_is_refused(self):
        import shark
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "own.toml")

            def made(text, sets=()):
                with open(path, "w") as file:
                    file.write('[experiment]\nkind = "shark"\n[factors]\noffset_m = [1.0, 3.0]\n[vary]\nshark_range_m = [4, 8]\n[[criteria]]\n' + text)
                return scenario.Scenario(path, {"shark": shark}, sets=sets)
            time, share = 'measure = "time_to_block_s"\n', 'measure = "blocked"\nstatistic = "share"\n'
            for text, words in ((time + "at_most = 3\nwhere = { offset_m = 7.0 }", r"criteria\[0\].where.offset_m: found 7.0, which no run has; accepted: 1.0, 3.0"),
                                (time + 'at_most = 3\nless = { offset_m = "x" }', r'less.offset_m: found "x"; accepted: a number'),
                                (time + "at_most = 3\nwhere = { delay_s = 1.0 }", "where.delay_s: found 1.0, which no run has; accepted: 0.0"),
                                (time + "at_most = 3\nwhere = { shark_range_m = 4.0 }", "found a setting that the seed draws; accepted: a factor"),
                                (time + "at_least = 3\nat_most = 1", "found at_least 3 above at_most 1; accepted"),
                                (time + 'statistic = "share"\nat_most = 3', "found the share of time_to_block_s; accepted: of what says yes or no: blocked, "),
                                (share + "at_least = 95", r"at_least: found 95; accepted: a number in \[0, 1\]"),
                                (share + "at_least = 2\nless = { offset_m = 1 }", r"accepted: a number in \[-1, 1\]")):
                with self.assertRaisesRegex(scenario.Refused, words) as caught:
                    made(text)
                self.assertNotIn("\n", str(caught.exception))
            made(share + "at_least = -0.5\nat_most = -0.5\nwhere = { offset_m = 3 }\nless = { offset_m = 1.0 }")
            made(time + "at_most = 3\nwhere = { offset_m = 3.0 }", ["offset_m=[1, 2]"])  # other levels of a file's factor may be tried


class Measures(unittest.TestCase):
    """Of a task, by its formulas."""

    def test_what_has_no_value_has_a_cause(self):
        import formulas
        import task

        def measure(name, text, stage=None):
            return {"name": name, "of": formulas.Formula("", text, [], ["x"]), "statistic": "max", "stage": stage}
        plan = SimpleNamespace(stop=None, seconds=1.0, stages=[{"name": n, "until": formulas.Formula("", "x > 5", [], ["x"]), "held_s": 0, "at_most_s": 1}
                                                               for n in ("one", "two")],
                               measures=[measure("by_zero", "1 / (x - x)"), measure("late", "x", "two"), measure("root", "(0 - x) ** 0.5"),
                                         measure("large", "10.0 ** (400 * x)"), measure("none", "0 ** (0 - x)"), measure("fine", "x / (x > 1)")])
        course = task._Course(plan)
        for x in (1.0, 2.0):
            course.see(task.Moment(None, {}, {"x": x}), x / 10)
        measures = course.measures(0.1)
        self.assertEqual(measures["fine"], 2.0)
        self.assertEqual(measures["absent"]["by_zero"], "1 / (x - x) was no number at any moment, as where it divides by zero")
        self.assertEqual(measures["absent"]["late"], "stage two was not reached")
        self.assertEqual(sorted(measures["absent"]), ["by_zero", "large", "late", "none", "root"])


class Tasks(unittest.TestCase):
    """A task's file and its controller, without a program."""

    def made(self, task="", stages='[[stages]]\nname = "near"\nuntil = "time > 1"\n', player="", act="return None", sets=(), head="",
             scene='[[objects]]\nname = "rov"\n[[objects]]\nname = "diver"\n'):
        """The checked task of a scenario with these lines."""
        import task as kind
        folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, folder)
        self.folder = folder
        for name, text in (("scene.toml", scene),
                           ("act.py", f"class Controller:\n    def __init__(self, world, settings, seed):\n        pass\n\n    def act(self, obs, stage):\n        {act}\n"),
                           ("play.py", f"class Player:\n    def __init__(self, world, settings, seed):\n        pass\n\n    def act(self, obs, stage, told):\n        {player or 'pass'}\n"),
                           ("own.toml", '[experiment]\nkind = "task"\n' + head + '[task]\nscene = "scene.toml"\ncontroller = "act.py"\n'
                                        + ('player = "play.py"\n' if player else "") + task + "\n" + stages)):
            with open(os.path.join(folder, name), "w") as file:
                file.write(text)
        return scenario.Scenario(os.path.join(folder, "own.toml"), {"task": kind.Task}, sets=sets)

    def refused(self, words, **more):
        with self.assertRaisesRegex(scenario.Refused, words) as caught:
            self.made(**more)
        self.assertNotIn("\n", str(caught.exception))

    def run_of(self, plan, bpm=10.0, hz=20):
        """Its measures in a world that has a diver's body alone."""
        measures, self.series = plan.kind.run(plan.settings, 1, self.tools(bpm, hz))
        return measures

    def tools(self, bpm=10.0, hz=20):
        world = SimpleNamespace(time=0.0, step=0, step_s=1.0 / hz, agents={"rov": None, "diver": None}, close=lambda: None)
        seen = {"diver/motion": SimpleNamespace(breath_bpm=bpm, heart_bpm=6 * bpm)}

        def tick(steps):
            world.step += steps
            world.time = world.step * world.step_s
            return seen
        world.observe, world.tick = lambda: seen, tick
        world.truth = lambda name: SimpleNamespace(position=np.array([2.0 * (name == "rov"), 0.0, -10.0]))
        return SimpleNamespace(python=lambda: SimpleNamespace(open=lambda *_, **__: world))

    def test_the_time_of_a_run_and_of_its_stages_counts_the_held_seconds(self):
        stages = "".join(f'[[stages]]\nname = "{n}"\nuntil = "stage_time > 0.99"\nheld_s = {held}\n' for n, held in (("a", 2.0), ("b", 0.5)))
        measures = self.run_of(self.made(stages=stages))
        self.assertEqual([round(measures[k], 6) for k in ("a_s", "b_s", "time_s")], [3.0, 1.5, 4.5])

    def test_calls_have_the_rate_that_was_asked_for(self):
        stages = '[[stages]]\nname = "work"\nuntil = "time > 99"\n[[measures]]\nname = "calls"\nof = "n"\nstatistic = "last"\n' \
                 '[[measures]]\nname = "all_s"\nof = "n > 0"\nstatistic = "duration"\n'
        player = 'self.n = getattr(self, "n", 0) + 1\n        return {"n": self.n}'
        for asked_hz, physics_hz in ((100, 240), (7, 240), (20, 240), (0.3, 60), (60, 60), (240, 240), (100 / 3, 1000)):
            plan = self.made(task=f'tells = ["n"]\ncontrol_hz = {asked_hz}\nseconds = 40.0', stages=stages, player=player)
            told = self.run_of(plan, hz=physics_hz)
            self.assertEqual(told["calls"], math.ceil(40 * asked_hz - 1e-6), (asked_hz, physics_hz))
            self.assertAlmostEqual(told["all_s"], told["calls"] / asked_hz, 9)
        plan = self.made(task='control_hz = 241', stages=stages.replace('"n', '"time'))
        with self.assertRaisesRegex(scenario.Failed, r"own.toml: task.control_hz: found 241; accepted: at most 240, the rate of the physics"):
            self.run_of(plan, hz=240)

    def test_no_stage_is_lost_from_a_runs_series(self):
        stages = "".join(f'[[stages]]\nname = "{n}"\nuntil = "{u}"\n' for n, u in (("long", "time > 99"), ("short", "time > 0"), ("end", "time > 120")))
        plan = self.made(task="seconds = 200.0", stages=stages)
        self.run_of(plan)
        series = self.series
        self.assertEqual(sorted(set(series["stage"])), [0, 1, 2])
        self.assertLess(len(series["t"]), 810)

    def test_what_is_not_known_says_neither_yes_nor_no(self):
        import formulas
        unknown, values = "x / 0", {"yes": 2.0, "no": 0.0}
        moment = SimpleNamespace(number=lambda name: values.get(name, math.nan))

        def value(text):
            return formulas.Formula("", text, [], ["x", "yes", "no"]).value(moment)
        for text in ("x", unknown, "not x", "x < 1", "x != 1", "1 < x < 3", "yes and x", "x and yes", "no or x", "x or no", "not (x < 1)", "x == x"):
            self.assertTrue(math.isnan(value(text)), text)
            self.assertFalse(formulas.says_yes(value(text)), text)
        for text, says in (("x and no", False), ("no and x", False), ("x or yes", True), ("yes or x", True), ("3 < yes < x", False), ("not no", True),
                           ("not yes", False), ("yes and yes", True), ("no or no", False), ("1 < yes < 3", True), ("yes", True), ("no", False)):
            self.assertEqual((value(text) == value(text), formulas.says_yes(value(text))), (True, says), text)

    def test_no_stage_ends_and_no_run_stops_by_what_is_not_known(self):
        late = 'participants = ["rov", "diver"]\ntells = ["done"]\nseconds = 3.0'
        for until in ("done", "time / 0", "heart(rov) - 500", "not (heart(rov) < 500)"):
            stages = f'[[stages]]\nname = "work"\nuntil = "{until}"\n'
            measures = self.run_of(self.made(task=late, stages=stages, player="return {}"))
            self.assertEqual((measures["success"], measures["failure"]), (False, f"stage work not done in 3 s: {until} was no number at the end"))
        known = '[[stages]]\nname = "work"\nuntil = "done"\nheld_s = 0.5\n'
        for value, failure in ((0.0, "stage work not done in 3 s"), (1.0, None)):
            self.assertEqual(self.run_of(self.made(task=late, stages=known, player=f'return {{"done": {value}}}'))["failure"], failure)
        stages = '[[stages]]\nname = "work"\nuntil = "time > 1"\n'
        for stop in ("heart(rov) - 500", "done"):
            failure = self.run_of(self.made(task=f'{late}\nstop = "{stop}"', stages=stages, player="return {}"))["failure"]
            self.assertEqual(failure, f"the stopping rule was no number at any moment: {stop}")
        for stop, failure in (("heart(diver) > 500", None), ("heart(diver) > 50", "stopped in stage work: heart(diver) > 50")):
            self.assertEqual(self.run_of(self.made(task=f'participants = ["diver"]\nseconds = 3.0\nstop = "{stop}"', stages=stages))["failure"], failure)

    def test_measures_leave_out_the_moments_that_are_not_known(self):
        stages = '[[stages]]\nname = "work"\nuntil = "time > 1"\n'
        for of, told in (("told < 0.5", {"ever": False, "share": 0.0, "duration": 0.0}), ("told", {"ever": True, "share": 1.0, "duration": 0.5})):
            for statistic, value in told.items():
                measure = f'[[measures]]\nname = "m"\nof = "{of}"\nstatistic = "{statistic}"\n'
                player = 'self.n = getattr(self, "n", 0) + 1\n        return {"told": 0.5} if self.n % 2 else {}'
                measures = self.run_of(self.made(task='tells = ["told"]', stages=stages + measure, player=player))
                self.assertAlmostEqual(measures["m"], value, delta=0.051, msg=(of, statistic))

    def test_no_name_stands_for_two_things(self):
        stage = '[[stages]]\nname = "{}"\nuntil = "time > 1"\n'
        measure = stage.format("near") + '[[measures]]\nname = "{}"\nof = "time"\n'
        setting = "[task.settings]\n{} = {{ default = 1 }}\n"
        self.refused(r'stages\[1\]\.name: found "near", but near_s is how long a stage took already; accepted: another', stages=2 * stage.format("near"))
        for name in ("time", "wall", "processor"):
            self.refused(rf'stages\[0\]\.name: found "{name}", but {name}_s is ', stages=stage.format(name))
        for name in ("failure", "absent", "t", "stage", "success", "time_s", "near_s", "seed", "wall_s", "controller"):
            self.refused(rf'measures\[0\]\.name: found "{name}", but {name} is ', stages=measure.format(name))
        for name in ("time", "stage_time", "controller", "run_limit_s", "seed"):
            self.refused(rf'task\.settings\.{name}: found "{name}", but', task=setting.format(name))
        self.refused(r'measures\[0\]\.name: found "far", but far is a setting', task=setting.format("far"), stages=measure.format("far"))
        for told in ('"time"', '"far"', '"a", "a"'):
            self.refused("task.tells: found ", task=f"tells = [{told}]\n" + setting.format("far"), player="return {}")
        self.refused('task.says: found "a", but a is a number of the player', task='tells = ["a"]\nsays = ["a"]', player="return {}")
        self.refused(r"task\.numbers\.far: found", task=setting.format("far") + '[task.numbers]\nfar = "time"')
        self.refused('task.places.rov: found "rov", but rov is a participant already',
                     task='participants = ["rov"]\n[task.places]\nrov = [0, 0, 0]')
        self.refused("task.participants: found", task='participants = ["rov", "rov"]')
        for bad in ("two words", "and", "2nd", ""):
            self.refused(rf'found "{bad}"; accepted: letters', stages=stage.format("near") + f'[[measures]]\nname = "{bad}"\nof = "time"\n')

    def test_a_scenario_computes_what_it_judges_by_from_the_divers_body(self):
        judged = """participants = ["rov", "diver"]
[task.numbers]
share = "max(0, min(1, (breath(diver) - 10) / 10))"
wanted_m = "3 - share - 0.01 * heart(diver)"
"""
        stages = '[[stages]]\nname = "near"\nuntil = "time > 1"\n[[measures]]\nname = "off_m"\nof = "distance(rov, diver) - wanted_m"\nstatistic = "max"\n'
        for bpm, wanted in ((5.0, 2.7), (15.0, 1.6), (30.0, 0.2)):
            self.assertAlmostEqual(self.run_of(self.made(judged, stages), bpm)["off_m"], 2.0 - wanted, 9)
        absent = self.run_of(self.made(judged, stages), math.nan)
        self.assertNotIn("off_m", absent)
        self.assertIn("no number at any moment", absent["absent"]["off_m"])
        self.refused("accepted: share, stage_time, time", task='[task.numbers]\nshare = "time"\nbad = "later"\nlater = "time"')
        self.refused(r"found min of 1 in .*; accepted: two numbers", task='[task.numbers]\nshare = "min(time)"')

    def test_no_controller_tells_what_it_is_judged_by(self):
        self.refused("task.tells: found \\['wanted_m'\\] without a player; accepted: .* a controller does not judge itself", task='tells = ["wanted_m"]')
        self.refused("task.says: found", task='says = ["warn"]')
        both = {"task": 'tells = ["far"]\nsays = ["warn"]', "player": 'return {"far": told.get("warn", 0.0)}'}
        self.refused('found "warn" in "warn > 1"', stages='[[stages]]\nname = "near"\nuntil = "warn > 1"\n', **both)
        stages = '[[stages]]\nname = "near"\nuntil = "time > 1"\n[[measures]]\nname = "most"\nof = "far"\nstatistic = "max"\n'
        self.assertEqual(self.run_of(self.made(stages=stages, act='return {"warn": 7}', **both))["most"], 7.0)
        for act, words in (('return {"far": 0.0}', 'act.py: act told "far"; accepted: warn'), ("return [1]", "act.py: act returned list; accepted: a dict"),
                           ('return {"warn": "x"}', "act.py: act told warn 'x'; accepted: a number")):
            with self.assertRaisesRegex(scenario.Failed, words):
                self.run_of(self.made(stages=stages, act=act, **both))
        with self.assertRaisesRegex(scenario.Failed, 'play.py: act told "close"; accepted: far'):
            self.run_of(self.made(stages=stages, task='tells = ["far"]', player='return {"close": 1}'))

    def lasts(self, plan, controllers):
        """What the formula `told` is at the end of a run of each controller, one after another in this process."""
        out = []
        for seed, controller in controllers:
            run = scenario.Run(0, {}, seed, plan.settings | {"controller": controller})
            with tempfile.TemporaryDirectory() as scratch:
                tools = self.tools()
                with unittest.mock.patch.object(runner, "Tools", lambda *_: tools):
                    result = runner._one(plan.kind.run, run, "none", os.path.join(scratch, "run"))
            self.assertIsNone(result["failure"])
            out.append(result["measures"]["gain"])
        return out

    def write(self, name, text):
        path = os.path.join(self.folder, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w") as file:
            file.write(text)
        return path

    GAIN = 'says = ["gain"]\ntells = ["gain_told"]', '[[stages]]\nname = "near"\nuntil = "time > 1"\n[[measures]]\nname = "gain"\nof = "gain_told"\nstatistic = "last"\n'
    HELPED = ("import dataclasses\nimport helper\nfrom parts import part\n\n@dataclasses.dataclass\nclass Controller:\n    world: object\n"
              "    settings: 'dict'\n    seed: int\n\n    def act(self, obs, stage):\n        import late\n"
              "        return {'gain': helper.gain() + 1000 * part.N + 10000 * late.N}\n")

    def test_a_controllers_modules_are_its_own_and_new_in_each_run(self):
        plan = self.made(self.GAIN[0], self.GAIN[1], player="return {'gain_told': told.get('gain', 0)}")
        files = []
        for folder, gain in (("a", 100), ("b", 200)):
            # One counts its runs; the names of the others are modules of the experiment's tools or packages without __init__.py.
            self.write(f"{folder}/helper.py", f"import places\nCALLS = []\n\ndef gain():\n    CALLS.append(0)\n    return {gain} + min(len(CALLS), 2) + places.N\n")
            self.write(f"{folder}/places.py", f"N = {gain // 10}")
            self.write(f"{folder}/parts/part.py", f"N = {gain // 100}")
            self.write(f"{folder}/late.py", f"N = {gain // 100}")
            files.append(self.write(f"{folder}/ctl.py", self.HELPED))
        a, b = files
        path, names = list(sys.path), set(sys.modules)
        self.assertEqual(self.lasts(plan, [(1, a), (2, b), (3, a), (4, b)]), [11112.0, 22222.0, 11112.0, 22222.0])
        self.assertEqual(sys.path, path)
        self.assertFalse({"helper", "parts", "parts.part", "late", "neritic_controller"} & (set(sys.modules) - names))
        import places
        self.assertEqual(os.path.dirname(places.__file__), os.path.realpath(experiment_tools.TOOLS))

    def test_a_player_and_a_controller_have_each_their_helper(self):
        plan = self.made(self.GAIN[0], self.GAIN[1], player="import helper; return {'gain_told': helper.N * told.get('gain', 0)}")
        self.write("helper.py", "N = 7")
        self.write("c/helper.py", "N = 3")
        other = self.write("c/ctl.py", "import helper\n\n\nclass Controller:\n    def __init__(self, *_):\n        pass\n\n"
                                       "    def act(self, obs, stage):\n        import helper as late\n        return {'gain': helper.N * late.N}\n")
        self.assertEqual(self.lasts(plan, [(1, other)]), [63.0])
        # Beside each other they have one.
        both = self.write("both.py", "import helper\n\n\nclass Controller:\n    def __init__(self, *_):\n        pass\n\n"
                                     "    def act(self, obs, stage):\n        helper.N += 1\n        return {'gain': 1}\n")
        self.assertEqual(self.lasts(plan, [(1, both), (1, both)]), [27.0, 27.0])

    def test_common_generators_draw_by_the_seed(self):
        plan = self.made(self.GAIN[0], self.GAIN[1], player="return {'gain_told': told.get('gain', 0)}")
        own = self.write("r/ctl.py", "import random\nimport numpy as np\n\n\nclass Controller:\n    def __init__(self, *_):\n"
                                     "        self.x = random.random() + 10 * int(1e6 * np.random.random())\n\n"
                                     "    def act(self, obs, stage):\n        return {'gain': self.x}\n")
        found = self.lasts(plan, [(1, own), (2, own), (1, own), (2 ** 63 - 1, own)])
        self.assertEqual(found[0], found[2])
        self.assertEqual(len(set(found)), 3)

    def test_a_helper_that_python_would_not_import_is_refused(self):
        plan = self.made()
        text = "import random\n\n\nclass Controller:\n    def act(self, obs, stage):\n        pass\n"
        plan.kind.check(plan.settings | {"controller": self.write("q/ctl.py", text)})
        self.write("r/random.py", "")
        own = self.write("r/ctl.py", text)
        with self.assertRaisesRegex(scenario.Refused, "random.py: found a module of a name that Python or neritic has; accepted: another name"):
            plan.kind.check(plan.settings | {"controller": own})

    def test_what_no_run_could_do_is_refused(self):
        near = '[[stages]]\nname = "near"\nuntil = "{}"\n'
        held = near.format("time > 1")
        self.refused(r"stages\[0\].held_s: found 30 of at most 20 s .*accepted: no more", task="seconds = 20", stages=held + "held_s = 30\n")
        self.refused(r"held_s: found 5 of at most 4 s", stages=held + "held_s = 5\nat_most_s = 4\n")
        self.refused("task.seconds: found 20, but the stages' held_s are 24 together; accepted: a longer run", task="seconds = 20",
                     stages=held + "held_s = 12\n" + held.replace("near", "far") + "held_s = 12\n")
        for until in ("0", "1 > 2", "1 / 0", "not 3"):
            self.refused(r"stages\[0\].until: found .*, which is never so; accepted", stages=near.format(until))
        for stop in ("1", "2 > 1", "1 / 0"):
            self.refused("task.stop: found .*, which is always so or never known; accepted", task=f'stop = "{stop}"')
        self.made(task='stop = "0"\nseconds = 20', stages=held + "held_s = 19\nat_most_s = 19\n")

    def test_a_long_text_is_not_echoed_whole(self):
        long = "time > 1 and " * 500
        for text in (long, long + "depth(whale) > 1", "1" + " + 1" * 3000 + " + x", "x" * 6000, "-" * 500 + "1 > x"):
            with self.assertRaises(scenario.Refused) as caught:
                self.made(stages=f'[[stages]]\nname = "near"\nuntil = "{text}"\n')
            self.assertLess(len(str(caught.exception)), 700)
        for more in ({"sets": ["x" * 6000]}, {"sets": ["controller=" + json.dumps(["a" * 6000] * 2)]}, {"task": f"tells = '{'x' * 6000}'"},
                     {"head": "x" * 6000 + " = 1\n"}, {"task": f"seconds = '{'x' * 6000}'"}):
            with self.assertRaises(scenario.Refused) as caught:
                self.made(**more)
            self.assertLess(len(str(caught.exception)), 700, more)

    def test_an_empty_word_is_no_file(self):
        import shark
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "own.toml")
            with open(path, "w") as file:
                file.write('[experiment]\nkind = "shark"\n')
            with self.assertRaisesRegex(scenario.Refused, '--set detector: found ""; accepted: text'):
                scenario.Scenario(path, {"shark": shark}, sets=['detector=""'])
        with self.assertRaisesRegex(scenario.Refused, '--set controller: found ""; accepted: text'):
            self.made(sets=['controller=""'])

    def test_what_is_read_is_text(self):
        stages = '[[stages]]\nname = "near"\nuntil = "time > 1"\n[[measures]]\nname = "m"\nof = "time"\n'
        for wrong in ("2026-01-01", "7", "[]"):
            for key in ("unit", "meaning"):
                self.refused(rf"measures\[0\]\.{key}: found .*; accepted: text", stages=stages + f"{key} = {wrong}\n")
            self.refused(r"task\.settings\.a\.meaning: found .*; accepted: text", task=f"[task.settings]\na = {{ default = 1, meaning = {wrong} }}")
            for key in ("title", "about"):
                self.refused(rf"experiment\.{key}: found .*; accepted: text", stages=stages, head=f"{key} = {wrong}\n")

    def test_another_controller_is_named_where_it_tells_what_nobody_asked(self):
        self.made()
        mine = os.path.join(self.folder, "mine.py")
        with open(mine, "w") as file:
            file.write("class Controller:\n    def __init__(self, *_):\n        pass\n    def act(self, *_):\n        return {'foo': 1}\n")
        with self.assertRaisesRegex(scenario.Failed, 'mine.py: act told "foo"; accepted: nothing'):
            self.run_of(self.made(sets=[f"controller={mine}"]))

    def test_a_controller_that_is_none_is_refused_before_it_runs(self):
        self.made()
        mine = os.path.join(self.folder, "mine.py")
        for text, words in (("class Controller(:\n", r"mine.py: found no Python \(.*line 1\); accepted: a class Controller"),
                            ("x = 1\n", "mine.py: found no class Controller; accepted: a class Controller with act"),
                            ("class Controller:\n    pass\n", "without act"), ("\0", "found no Python")):
            with open(mine, "w") as file:
                file.write(text)
            self.refused(words, sets=[f"controller={mine}"])
        for text in ("from other import Controller\n", "from other import Mine as Controller\n", "import other\nController = other.Mine\n",
                     "from other import *\n", "import other\nclass Controller(other.Mine):\n    pass\n", "raise SystemExit\ndef Controller(*_): pass\n"):
            with open(mine, "w") as file:
                file.write(text)
            self.made(sets=[f"controller={mine}"])

    def test_the_shipped_tasks_pass_their_checks(self):
        import task as kind
        for name in scenario.names():
            if scenario.read(scenario.path_of(name))["experiment"]["kind"] == "task":
                scenario.Scenario(scenario.path_of(name), {"task": kind.Task})

    def test_a_signal_is_of_what_has_it(self):
        task = 'participants = ["rov", "diver"]\n[task.places]\nbuoy = [6.0, 6.0, -8.0]\n'
        stage = '[[stages]]\nname = "near"\nuntil = "{} < 1"\n'
        for of in ("speed(buoy)", "facing(buoy, rov)", "touched(buoy)", "heart(buoy)", "breath(buoy)"):
            self.refused(rf"stages\[0\]\.until: found {re.escape(of)}, whose buoy is a place in .*; accepted: one of diver, rov", task=task, stages=stage.format(of))
        for of in ("facing(rov, buoy)", "distance(rov, buoy)", "along(diver, rov, buoy)", "depth(buoy)", "heart(diver)"):
            self.made(task=task, stages=stage.format(of))
        vehicle = {"scene": '[[vehicles]]\nname = "rov"\n[[objects]]\nname = "diver"\n',
                   "task": 'participants = ["rov", "diver", "vehicle_1"]\n'}
        for of, name in (("heart(rov)", "rov"), ("breath(vehicle_1)", "vehicle_1")):
            self.refused(rf"until: found {re.escape(of)} in .*, but {name} is a vehicle; accepted: a diver with", stages=stage.format(of), **vehicle)
        self.made(stages=stage.format("heart(diver) + speed(rov)"), **vehicle)

    def test_a_participant_that_the_scene_lacks_is_refused_before_it_runs(self):
        self.refused("scene.toml: found no participant shark; accepted: diver, rov", task='participants = ["rov", "shark"]')
        self.made(task='participants = ["rov", "object_1"]')
        with open(os.path.join(self.folder, "outer.toml"), "w") as file:
            file.write('include = "scene.toml"\n[[vehicles]]\nname = "other"\n')
        import task_file
        outer = os.path.join(self.folder, "outer.toml")
        task_file.check_participants(outer, ["rov", "other"])
        with self.assertRaisesRegex(scenario.Refused, "accepted: diver, other, rov"):
            task_file.check_participants(outer, ["buoy"])


if __name__ == "__main__":
    unittest.main()
