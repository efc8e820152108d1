"""The parts of tools/experiment that need no program: runs, tasks, criteria, figures, intervals, power. Exit 77: skipped."""
import errno
import io
import json
import math
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
import unittest.mock
from types import SimpleNamespace

try:
    import numpy as np
except ModuleNotFoundError:
    sys.exit(77)

HERE = os.path.dirname(os.path.realpath(__file__))
sys.dont_write_bytecode = True
TOOLS = os.path.join(HERE, "..", "..", "tools", "experiment")
sys.path.insert(0, TOOLS)

import detector
import imaging
import intervals
import report
import rotations
import runner
import scenario
import summary


class Rotations(unittest.TestCase):
    def test_turns_go_about_up_then_left_then_forward(self):
        ahead, left, up = np.eye(3)
        np.testing.assert_allclose(rotations.matrix(rotations.quaternion(math.pi / 2, 0, 0)) @ ahead, left, atol=1e-12)
        np.testing.assert_allclose(rotations.matrix(rotations.quaternion(0, math.pi / 2, 0)) @ ahead, -up, atol=1e-12)
        np.testing.assert_allclose(rotations.matrix(rotations.quaternion(0, 0, math.pi / 2)) @ left, up, atol=1e-12)
        np.testing.assert_allclose(rotations.scene_matrix(90) @ [0, 0, -1], [-1, 0, 0], atol=1e-12)  # to port

    def test_a_matrix_gives_its_quaternion_back(self):
        rng = np.random.Generator(np.random.Philox(key=3))
        for turn in [*rng.uniform(-math.pi, math.pi, (50, 3)), [math.pi, 0, 0], [0, math.pi, 0], [0, 0, 0]]:
            m = rotations.matrix(rotations.quaternion(*turn))
            np.testing.assert_allclose(m @ m.T, np.eye(3), atol=1e-12)
            np.testing.assert_allclose(rotations.matrix(rotations.quaternion_of(m)), m, atol=1e-9)


class Outcomes(unittest.TestCase):
    @unittest.skipUnless(os.path.exists(detector.model_of("shipped")), "no shipped detector")
    def test_every_level_of_every_knob_is_one_that_the_task_accepts(self):
        import outcomes
        import shark
        asked = SimpleNamespace(runs=2, seed=None, set=[])
        made = outcomes.plans({"shark": shark}, asked)
        self.assertEqual([len(p.list_runs()) for p in made], [2 * len(k[1]) for k in outcomes.KNOBS])
        for plan, knob in zip(made, outcomes.KNOBS):
            self.assertIn(f"one knob turned: {knob[3]}. Its levels: {report.number(knob[1][0])}, ", plan.about)

    def test_a_run_that_did_not_block_is_slower_than_any(self):
        import outcomes
        import provenance
        import shark
        sys.path.insert(0, os.path.join(TOOLS, "..", "plot"))  # the program does so
        times = {60: [1.0 + 0.1 * i for i in range(10)], 120: [1.0 + 0.1 * i for i in range(6)] + [None] * 4, 240: [1.0] * 4 + [None] * 6}

        def one(plan, out):
            return [{"condition": {"physics_hz": hz}, "measures": {"blocked_in_3_s": t is not None, **({} if t is None else {"time_to_block_s": t})},
                     "processor_s": 1.0} for hz, given in times.items() for t in given]
        made = {"version": "neritic 0.1.0", "commit": None, "changed": None, "program": "feed"}
        with tempfile.TemporaryDirectory() as folder, unittest.mock.patch.object(provenance, "of", lambda program: made), \
                unittest.mock.patch.object(outcomes, "KNOBS", [("physics_hz", list(times), [], "physics, steps a second")]):
            rows = outcomes.run({"shark": shark}, one, SimpleNamespace(out=folder, program="none", runs=10, seed=3, set=[]))
            page = pathlib.Path(folder, "index.html").read_text()
        self.assertEqual([[r[k] for k in ("time_low_s", "time_to_block_s", "time_high_s", "blocked_in_3_s")] for r in rows],
                         [[1.1, 1.45, 1.8, 1.0], [1.1, 1.45, None, 0.6], [1.0, None, None, 0.4]])
        for words in ("<td>half or more did not block</td><td>1 or more</td>", "seeds everywhere, 3 to 12", "neritic 0.1.0, commit unknown, program feed"):
            self.assertIn(words, page)


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


class Sonar(unittest.TestCase):
    def test_the_sharks_sonar_is_ahead_of_the_rov_in_which_it_would_hear_nothing(self):
        import shark_scene
        import shark_senses
        place = [float(x) for x in re.search(r"position_m = \[(.*)\]", shark_senses.SONAR)[1].split(",")]
        self.assertIn("size_m = [0.457, 0.254, 0.575]", open(shark_scene.__file__).read())
        self.assertLess(place[2], -0.575 / 2)


class Imaging(unittest.TestCase):
    @staticmethod
    def plate(left, right, low, high):
        """Two triangles 3 m ahead: a wall between these metres to starboard and up."""
        a, b, c, d = (np.array([x, y, -3.0]) for x, y in ((left, low), (right, low), (right, high), (left, high)))
        return np.array([[a, b, c], [a, c, d]])

    def test_what_the_aperture_cuts_off_moves_the_middle(self):
        tilt = math.radians(8)
        # Within 14 degrees of elevation at either tilt.
        self.assertAlmostEqual(imaging.cut_bins(self.plate(-0.3, 0.5, -0.1, 0.1), tilt), 0.0, places=6)
        # A low plate of 0.4 m to port and a high one of 0.4 m to starboard, which leaves the aperture when it is lifted: the middle
        # goes from 0 to the port one's, 0.2 / 3 rad or 3.81 degrees away, 21 of the 500 bins of 90 degrees.
        both = np.concatenate([self.plate(-0.4, 0.0, -0.2, 0.0), self.plate(0.0, 0.4, 0.45, 0.65)])
        self.assertAlmostEqual(imaging.cut_bins(both, tilt), -21.2, delta=1.0)
        self.assertAlmostEqual(imaging.cut_bins(both, -tilt), 0.0, places=6)


class Pages(unittest.TestCase):
    def test_the_page_of_all_tells_what_failed_and_what_is_missing(self):
        criterion = {"measure": "m", "statistic": "median", "where": {}, "less": None, "found": 0.5, "low": 0.25, "high": 0.75, "n": 3,
                     "of": 3, "at_most": 1.0, "at_least": None, "holds": True, "counts": True}
        made = {"version": "neritic 0.1.0", "commit": "0123456789ab", "changed": True, "program": "feed"}
        told = {"experiment": "one", "runs": 3, "seed": 4, "last_seed": 6, "made_by": made, "processor_s": 90.0, "criteria": [criterion, {**criterion, "holds": False},
                                                                                            {**criterion, "holds": False, "counts": False}]}
        with tempfile.TemporaryDirectory() as folder:
            report.index([told], [("two", "no <GPU>")], ["three"], folder)
            with open(os.path.join(folder, "index.html")) as file:
                text = file.read()
            self.assertEqual(os.listdir(folder), ["index.html"])
        for words in ("1 of 2 criteria hold; 3 runs took 1.5 minutes", "no &lt;GPU&gt;", "not run yet", "does not hold", "<td>0.25 to 0.75</td>",
                      "<td>4 to 6</td>", "Made by neritic 0.1.0, commit 0123456789ab with changes, program feed."):
            self.assertIn(words, text)

    def test_results_say_what_made_them(self):
        import provenance
        with tempfile.TemporaryDirectory() as folder:
            program = pathlib.Path(folder, "neritic")
            program.write_text("#!/bin/sh\necho neritic 7.8.9\n")
            program.chmod(0o755)
            here = provenance.of(str(program))
            self.assertEqual((here["version"], len(here["program"])), ("neritic 7.8.9", 16))
            commit = subprocess.run(["git", "-C", TOOLS, "rev-parse", "HEAD"], capture_output=True, text=True).stdout.strip()
            self.assertEqual(here["commit"], commit[:12] or None)
            # A copy that lies in somebody's repository is not of its commit.
            for name in ("provenance", "files_read", "runner", "scenario", "endings"):
                shutil.copy(os.path.join(TOOLS, name + ".py"), folder)
            for words in (["init", "-q"], ["-c", "user.name=a", "-c", "user.email=a@b", "commit", "-q", "--allow-empty", "-m", "one"]):
                if subprocess.run(["git", "-C", folder, *words]).returncode != 0:
                    self.skipTest("no git here")
            told = subprocess.run([sys.executable, "-B", "-c", f"import json, provenance; print(json.dumps(provenance.of({str(program)!r})))"],
                                  cwd=folder, capture_output=True, text=True)
            self.assertEqual(json.loads(told.stdout)["commit"], None, told.stderr)
            program.write_text("#!/bin/sh\nexit 3\n")
            provenance.of.cache_clear()
            with self.assertRaisesRegex(scenario.Failed, "neritic --version: status 3"):
                provenance.of(str(program))


class Judging(unittest.TestCase):
    """Criteria on runs of which some gave no value."""

    def judge(self, values, **criterion):
        """values: a list, or two of them for b 0 and 1; None: no value."""
        groups = values if isinstance(values[0], list) else [values]
        results = [{"condition": {"b": b}, "seed": i, "settings": {"b": b}, "measures": {} if v is None else {"m": v},
                    "failure": "no" if v is None else None, "processor_s": 0} for b, group in enumerate(groups) for i, v in enumerate(group)]
        scenario = SimpleNamespace(kind=SimpleNamespace(MEASURES={"m": ("s", "")}), criteria=[{"measure": "m", **criterion}],
                                   name="", title="", about="", kind_name="", seed=1, settings={}, vary={}, factors={}, added=[], replaced=set())
        told = summary.summarise(scenario, results)
        return told["criteria"][0], told

    def test_a_run_without_a_value_counts_as_the_worst(self):
        few = [1.0, 2.0] + [None] * 8  # the survivors alone would pass
        for statistic in ("median", "mean", "max", "share"):
            self.assertFalse(self.judge(few, statistic=statistic, at_most=3.0 if statistic != "share" else 0.5)[0]["holds"], statistic)
        for statistic in ("median", "mean", "min", "share"):
            self.assertFalse(self.judge(few, statistic=statistic, at_least=0.5)[0]["holds"], statistic)
        self.assertFalse(self.judge(few, at_least=0.0, at_most=3.0)[0]["holds"])

    def test_the_statistic_is_told_where_it_is_determined(self):
        found = self.judge([1.0, 2.0, 3.0, 4.0, None], at_most=3.5)[0]
        self.assertEqual((found["found"], found["n"], found["of"], found["holds"]), (3.0, 4, 5, True))
        found = self.judge([1.0, 2.0, 3.0, 4.0, None], at_least=2.0, at_most=9.0)[0]
        self.assertEqual((found["found"], found["holds"]), (3.0, True))
        self.assertEqual(self.judge([1.0, 2.0, None], statistic="min", at_most=1.5)[0]["found"], 1.0)
        lost = self.judge([1.0, None, None], at_most=1.5)[0]
        self.assertIsNone(lost["found"])
        self.assertEqual(report.found(lost), "not determined (1 of 3 runs gave a value)")
        self.assertEqual(report.found(found), "3 (4 of 5 runs)")

    def test_a_comparison_is_not_won_by_the_others_failures(self):
        both = {"where": {"b": 1}, "less": {"b": 0}, "at_most": -2.0}
        self.assertTrue(self.judge([[9.0, 8.0, 9.0], [1.0, 1.0, 1.0]], **both)[0]["holds"])
        self.assertFalse(self.judge([[9.0, None, None], [1.0, 1.0, 1.0]], **both)[0]["holds"])
        self.assertFalse(self.judge([[9.0, 8.0, 9.0], [1.0, None, None]], **both)[0]["holds"])

    def test_what_is_found_has_an_interval(self):
        up = [float(i) for i in range(1, 21)]
        one = self.judge(up, at_most=20.0)[0]
        self.assertEqual((one["found"], one["low"], one["high"]), intervals.median_interval(up))
        self.assertEqual(report.found(one, True), "10.5 (6 to 15; 20 of 20 runs)")
        # What gave no value counts as the worst there too.
        lost = self.judge(up[:13] + [None] * 7, at_most=20.0)[0]
        self.assertEqual((lost["found"], lost["low"], lost["high"], report.interval(lost)), (10.5, 6.0, None, "6 or more"))
        lost = self.judge(up[:13] + [None] * 7, at_least=-9.0)[0]
        self.assertEqual((lost["found"], lost["low"], report.interval(lost)), (3.5, None, "8 or less"))
        share = self.judge([True] * 19 + [None], statistic="share", at_least=0.5)[0]
        self.assertEqual((share["low"], share["high"]), intervals.share_interval(19, 20)[1:])
        mean = self.judge(up, statistic="mean", at_most=20.0)[0]
        self.assertAlmostEqual(mean["high"] - 10.5, 2.0930 * np.std(up, ddof=1) / math.sqrt(20), 3)
        for criterion in ({"statistic": "max", "at_most": 20.0}, {"statistic": "min", "at_least": 0.0}):
            self.assertEqual(report.interval(self.judge(up, **criterion)[0]), "–")
        # Runs of two conditions share their seeds, and count for no more than they are.
        self.assertEqual(report.interval(self.judge([up, up], at_most=20.0)[0]), "–")

    def test_a_difference_is_paired_by_its_seeds(self):
        both, up = {"where": {"b": 1}, "less": {"b": 0}, "at_most": 9.0}, [float(i * i) for i in range(20)]
        shifted = self.judge([up, [v + 0.5 for v in up]], **both)[0]
        self.assertEqual((shifted["found"], shifted["low"], shifted["high"]), (0.5, 0.5, 0.5))  # as spread as they are
        apart = self.judge([up, [v + 0.5 for v in up[::-1]]], **both)[0]
        self.assertEqual(apart["found"], 0.5)
        self.assertTrue(apart["low"] < -20 and apart["high"] > 20, apart)
        self.assertEqual(report.interval(self.judge([up, up[:-1]], **both)[0]), "–")  # a seed without its pair
        mean = self.judge([up, [v + 0.5 + 0.1 * (-1) ** i for i, v in enumerate(up)]], statistic="mean", **both)[0]
        self.assertAlmostEqual(mean["high"] - mean["found"], 2.0930 * 0.1 * math.sqrt(20 / 19) / math.sqrt(20), 4)
        lost = self.judge([up, [v + 0.5 for v in up[:-2]] + [None] * 2], **both)[0]
        self.assertEqual(lost["found"], 0.5)
        self.assertGreaterEqual(lost["high"], 0.5)

    def test_intervals_of_differences_by_published_tables_and_by_draws(self):
        # Examples of Newcombe 1998, method 10: pairs (yes, yes), (yes, no), (no, yes), (no, no) and the limits.
        for counts, limits in (((36, 12, 2, 0), (0.0569, 0.3404)), ((20, 12, 2, 16), (0.0562, 0.3292))):
            kinds = ((True, True), (True, False), (False, True), (False, False))
            found, low, high = intervals.share_difference_interval([k for k, n in zip(kinds, counts) for _ in range(n)])
            self.assertAlmostEqual(found, 0.2)
            np.testing.assert_allclose((low, high), limits, atol=6e-5)
        rng, within = np.random.Generator(np.random.Philox(key=7)), 0
        for _ in range(200):
            first = rng.normal(0, 1, 20)
            second = 0.5 * first + rng.normal(1, 1, 20)
            _, low, high = intervals.median_difference_interval(list(zip(second, first)), draws=400)
            within += low <= 1.0 <= high
        self.assertTrue(0.90 <= within / 200 <= 1.0, within)
        self.assertEqual(intervals.median_difference_interval([(math.inf, 1.0)] * 3 + [(2.0, 1.0)] * 4), (1.0, 1.0, math.inf))

    def compare(self, sets, numbers, tables="", of="m"):
        """(summary, criteria as {words: verdict}) of a task with its measure m of each controller's runs, as --set asks for them."""
        import task
        text = ('[experiment]\nkind = "task"\nruns = 2\n[task]\nscene = "s.toml"\ncontroller = "mine.py"\n[task.settings]\n'
                'b = { default = 0.0, meaning = "" }\n[[stages]]\nname = "a"\nuntil = "time > 1"\n'
                '[[measures]]\nname = "m"\nof = "time"\n' + tables)
        robot = "class Controller:\n    def act(self):\n        pass\n"
        with tempfile.TemporaryDirectory() as folder:
            for name, content in (("t.toml", text), ("s.toml", ""), ("mine.py", robot), ("yours.py", robot)):
                pathlib.Path(folder, name).write_text(content)
            plan = scenario.Scenario(os.path.join(folder, "t.toml"), {"task": task.Task}, sets=[s.replace("DIR", folder) for s in sets])
            results = [{"condition": r.condition, "seed": r.seed, "settings": r.settings, "failure": None, "processor_s": 0.0,
                        "measures": {"m": numbers[os.path.basename(str(r.settings["controller"]))] + r.settings["b"]}} for r in plan.list_runs()]
            told = summary.summarise(plan, results)
            return told, {report.claim(c).replace(folder + "/", ""): report.verdict(c) for c in told["criteria"]}

    LIMIT = '[[criteria]]\nmeasure = "m"\nat_most = 1.0\n'

    def test_a_criterion_is_of_each_controller_by_itself(self):
        sets, numbers = ['controller=["baseline", "null", "DIR/yours.py"]'], {"baseline": 0.5, "null": 9.0, "yours.py": 0.9}
        told, verdicts = self.compare(sets, numbers, self.LIMIT)
        self.assertEqual(verdicts, {"median of m (controller baseline)": "holds", "median of m (controller null)": "not asked",
                                    "median of m (controller yours.py)": "holds"})
        self.assertTrue(told["passed"])
        lines = report.comparison(told)
        self.assertRegex(lines[0], r"controller baseline +controller null +controller .*yours.py$")
        self.assertRegex(lines[1], r"^m +0.5 +9 +0.9$")
        told, verdicts = self.compare(sets, numbers | {"yours.py": 1.5}, self.LIMIT)
        self.assertEqual((told["passed"], list(verdicts.values())), (False, ["holds", "not asked", "does not hold"]))
        # Alone, the null robot is judged as any other.
        self.assertFalse(self.compare(['controller="null"'], numbers, self.LIMIT)[0]["passed"])
        self.assertFalse(self.compare(['controller=["null"]'], numbers, self.LIMIT)[0]["passed"])

    def test_a_criterion_is_of_each_level_that_was_asked_for(self):
        told, verdicts = self.compare(["b=[0, 2]"], {"baseline": 0.5}, self.LIMIT)
        self.assertEqual(verdicts, {"median of m (b 0)": "holds", "median of m (b 2)": "does not hold"})
        # The scenario's own factors are together, as it says.
        own = "[factors]\nb = [0.0, 0.75]\n"
        told, verdicts = self.compare([], {"baseline": 0.5}, own + self.LIMIT)
        self.assertEqual((verdicts, report.comparison(told)), ({"median of m": "holds"}, []))
        differs = own + '[[criteria]]\nmeasure = "m"\nat_least = 0.5\nwhere = { b = 0.75 }\nless = { b = 0.0 }\n'
        told, verdicts = self.compare(['controller=["baseline", "DIR/yours.py"]'], {"baseline": 0.5, "yours.py": 7.0}, differs)
        self.assertEqual(verdicts, {f"median of m (b 0.75, controller {c}) less that of b 0, controller {c}": "holds" for c in ("baseline", "yours.py")})

    def test_a_criterion_of_a_condition_that_was_left_out_is_not_judged(self):
        tables = '[factors]\nb = [0.0, 3.0]\n' + self.LIMIT + 'where = { b = 3.0 }\n'
        told, verdicts = self.compare(["b=0.0"], {"baseline": 0.5}, tables)
        self.assertEqual((verdicts, told["passed"]), ({"median of m (b 3)": "not run"}, True))
        with self.assertRaisesRegex(scenario.Refused, "which no run has"):  # nobody left it out
            self.compare([], {"baseline": 0.5}, tables.replace("b = 3.0 }", "b = 4.0 }"))

    def test_equal_runs_have_no_interval(self):
        def told(series):
            results = [{"condition": {}, "seed": i, "settings": {}, "measures": {"m": 2.0, "y": True}, "failure": None, "series": s, "processor_s": 0}
                       for i, s in enumerate(series)]
            kind = SimpleNamespace(MEASURES={"m": ("s", ""), "y": ("yes or no", "")})
            plan = SimpleNamespace(kind=kind, criteria=[], name="", title="", about="", kind_name="", seed=1, settings={}, vary={}, factors={}, added=[], replaced=set())
            condition, = summary.summarise(plan, results)["conditions"]
            return condition["equal"], [condition["measures"][k]["low"] for k in "my"], report._condition_table(plan, condition)
        equal, low, page = told([{"t": [1]}] * 8)
        self.assertEqual((equal, low), (True, [None, None]))
        self.assertIn("All 8 runs gave the same numbers to the bit", page)
        equal, low, page = told([{"t": [i]} for i in range(8)])  # of other courses that end alike
        self.assertFalse(equal or None in low or "to the bit" in page)

    def test_the_seed_moves_the_echo_sounders_start_and_heave(self):
        import echo_sounder
        settings = {k: v.default for k, v in echo_sounder.SETTINGS.items()} | {"heave_m": 0.2}
        times = np.arange(80) / 10.0
        ups = np.array([echo_sounder._depths(settings, seed, times)[1] for seed in range(1, 41)])
        self.assertTrue((np.abs(ups.mean(axis=1)) <= 0.05).all() and ups.mean(axis=1).std() > 0.02)  # over whole heaves: the start
        self.assertTrue(((ups - ups.mean(axis=1, keepdims=True)).argmax(axis=1).std()) > 10)  # the top of the heave comes at any time
        still = echo_sounder._depths(settings | {"start_spread_m": 0.0, "heave_m": 0.0}, 3, times)
        np.testing.assert_array_equal(still[1], 0.0)

    def test_broken_runs_are_counted(self):
        self.assertEqual(self.judge([1.0, None], at_most=3.0)[1]["broken"], 1)

    def test_two_pairs_tell_nothing(self):
        import shark_figures
        runs = [{"condition": {"b": b}, "seed": i, "measures": {"time_to_block_s": 1.5 + b + 0.001 * i * (b + 1)}} for b in (0, 1) for i in range(10)]
        self.assertIn("3 pairs tell it (paired t test, at least 3)", list(shark_figures.notes(runs))[-1])

    def test_a_power_is_not_told_from_the_few_that_blocked(self):
        import shark_figures
        runs = [{"condition": {}, "seed": i, "measures": {"time_to_block_s": 1.5 + 0.02 * i} if i < 12 else {}} for i in range(40)]
        line, = shark_figures.notes(runs)
        self.assertIn("12 of 40 runs blocked", line)
        self.assertNotIn("80 %", line)
        self.assertIn("This is of those that blocked: 12 of 13 runs", next(shark_figures.notes(runs[:13])))


def act(settings, seed, tools):
    """A run whose controller does what the seed says."""
    tools.write("here", "")
    if seed == 2:
        sys.exit(3)
    if seed == 3:
        os._exit(4)
    if seed == 4:
        raise ValueError("two\nlines")
    if seed == 5:
        time.sleep(1000)
    if seed == 6:
        os.spawnlp(os.P_NOWAIT, "sleep", "sleep", "1000")
        signal.signal(signal.SIGTERM, signal.SIG_IGN)
        time.sleep(1000)
    if seed == 7:
        os.kill(os.getpid(), signal.SIGKILL)
    return {"m": seed}, {}


class Runs(unittest.TestCase):
    """Runs whose code exits, dies or does not return."""

    def run_all(self, out, seeds, workers, resume=False, run=act, program="none"):
        runs = [scenario.Run(i, {}, seed, {}) for i, seed in enumerate(seeds)]
        plan = SimpleNamespace(name="x", kind_name="x", kind=SimpleNamespace(run=run), run_limit_s=3.0, list_runs=lambda: runs,
                               fingerprint=lambda: "")
        with unittest.mock.patch.object(runner, "GRACE_S", 0.5):
            return runner.run_all(plan, out, program, workers, resume, True)

    def test_each_is_a_failed_run_and_the_others_go_on(self):
        for workers in (1, 2):
            with tempfile.TemporaryDirectory() as out, tempfile.TemporaryDirectory() as scratch, \
                    unittest.mock.patch.object(tempfile, "tempdir", scratch):
                results = self.run_all(out, range(1, 9), workers)
                causes = [r["failure"] for r in results]
                self.assertEqual([r["measures"] for r in results], [{"m": s} if s in (1, 8) else {} for s in range(1, 9)])
                self.assertEqual((causes[0], causes[7]), (None, None))
                self.assertRegex(causes[1], r"^SystemExit: 3 \(test_experiment.py:\d+\)$")
                self.assertEqual(causes[2], "its process ended with status 4")
                self.assertRegex(causes[3], r"^ValueError: two lines \(")
                self.assertEqual(causes[4:6], ["did not end within 3 s of the clock (run_limit_s)"] * 2)
                self.assertIn("killed by SIGKILL", causes[6])
                self.assertEqual(os.listdir(scratch), [])  # what the runs wrote is gone
                # Those that gave nothing are made anew by --resume; the others stay as they ended.
                again = self.run_all(out, range(1, 9), workers, resume=True, run=lambda settings, seed, tools: ({"m": 10 * seed}, {}))
                self.assertEqual([r["measures"]["m"] for r in again], [1, 20, 30, 40, 50, 60, 70, 8])
                self.assertEqual((again[0], again[7]), (results[0], results[7]))
                with open(os.path.join(out, "runs.jsonl")) as file:
                    self.assertEqual(len(file.readlines()), 1 + 8)

    def test_a_run_that_failed_by_its_scenarios_rules_is_a_result(self):
        def lost(settings, seed, tools):
            return {"m": 0, "failure": "stage one not done in 3 s"}, {}
        with tempfile.TemporaryDirectory() as out:
            results = self.run_all(out, [1], 1, run=lost)
            self.assertEqual(results[0]["failure"], "stage one not done in 3 s")
            self.assertEqual(self.run_all(out, [1], 1, resume=True, run=lambda *_: ({"m": 1}, {})), results)

    def test_results_of_another_program_are_not_gone_on_with(self):
        with tempfile.TemporaryDirectory() as folder:
            out, program = os.path.join(folder, "out"), os.path.join(folder, "tools", "neritic")
            core = os.path.join(folder, "python", "neritic", "_core.so")
            for file in (program, core):
                os.makedirs(os.path.dirname(file))
                pathlib.Path(file).write_text("one")
            os.mkdir(out)
            self.run_all(out, [1], 1, program=program)
            self.run_all(out, [1, 8], 1, program=program, resume=True)
            for file in (program, core):
                pathlib.Path(file).write_text("two!")
                with self.assertRaisesRegex(scenario.Refused, "found results of another neritic"):
                    self.run_all(out, [1, 8], 1, program=program, resume=True)
                pathlib.Path(file).write_text("one")

    def test_a_folder_that_is_erased_meanwhile_is_not_made_again(self):
        with tempfile.TemporaryDirectory() as scratch:
            out = os.path.join(scratch, "out")
            os.mkdir(out)

            def erase(settings, seed, tools):
                shutil.rmtree(out)
                return {"m": seed}, {}
            runs = [scenario.Run(i, {}, i, {}) for i in range(50)]
            plan = SimpleNamespace(name="x", kind_name="x", kind=SimpleNamespace(run=erase), run_limit_s=60.0, list_runs=lambda: runs,
                                   fingerprint=lambda: "")
            with self.assertRaisesRegex(scenario.Failed, "was removed while its runs were made"):
                runner.run_all(plan, out, "none", 1, False, True)
            import shark
            import shark_person
            settings = {k: v.default for k, v in shark.SETTINGS.items()} | {"person": "window"}
            with self.assertRaisesRegex(scenario.Failed, "found no such folder any more"):
                shark_person.Person(settings, 1, runner.Tools("none", scratch, out), "none.toml")
            self.assertEqual(os.listdir(scratch), [])

    def test_a_studys_block_that_begins_anew_goes_on_with_its_results(self):
        import shark
        import study
        plan = study.read_plan(os.path.join(scenario.SHIPPED, "studies", "shark.toml"))
        for block in plan["blocks"]:
            self.assertIn("--resume", block["command"])
            sets = [w for flag, w in zip(block["command"], block["command"][1:]) if flag == "--set"]
            # Another port at each attempt.
            made = [scenario.Scenario(scenario.path_of(block["command"][1]), {"shark": shark}, sets=[w.replace("{markers}", port) for w in sets])
                    for port in ("40001", "40002")]
            self.assertNotEqual(made[0].settings, made[1].settings)
            self.assertEqual(made[0].fingerprint(), made[1].fingerprint())

    def test_two_experiments_do_not_write_into_one_folder(self):
        def another(settings, seed, tools):
            try:
                self.run_all(tools.out, [8], 1, resume=True)
            except scenario.Refused as error:
                return {"refused": "found another experiment that still writes there" in str(error)}, {}
            return {}, {}
        with tempfile.TemporaryDirectory() as out:
            self.assertEqual(self.run_all(out, [1], 1, run=another)[0]["measures"], {"refused": True})
            self.assertEqual(self.run_all(out, [1, 8], 1, resume=True)[1]["measures"], {"m": 8})

    def test_what_a_run_prints_is_no_part_of_the_results(self):
        code = f"""import sys
sys.path.insert(0, {HERE!r})
sys.argv[1:] = []
import os, tempfile, test_experiment
def tells(settings, seed, tools):
    print("a line of the controller")
    os.system("echo a line of its program")
    return {{"m": seed}}, {{}}
with tempfile.TemporaryDirectory() as out:
    results = test_experiment.Runs().run_all(out, [1, 8], 1, run=tells)
print([r["measures"] for r in results])
"""
        done = subprocess.run([sys.executable, "-B", "-c", code], capture_output=True, text=True, timeout=60)
        self.assertEqual((done.stdout, done.stderr.count("a line of the controller"), done.stderr.count("a line of its program")),
                         ("[{'m': 1}, {'m': 8}]\n", 2, 2), done.stderr)

    def test_runs_are_counted_as_kept_once_they_are_on_the_disk(self):
        def full_after(n, real=os.fsync):
            written = []

            def sync(file):
                written.append(file)
                if len(written) > n:
                    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
                real(file)
            return sync
        with tempfile.TemporaryDirectory() as out, unittest.mock.patch.object(os, "fsync", full_after(3)), \
                self.assertRaisesRegex(scenario.Failed, "No space left on device; 3 finished runs are kept"):
            self.run_all(out, range(10, 20), 1)

    def test_the_limit_is_a_setting_that_decides_no_numbers(self):
        import echo_sounder
        path = os.path.join(scenario.SHIPPED, "echo_sounder.toml")
        made = [scenario.Scenario(path, {"echo_sounder": echo_sounder}, sets=s) for s in ([], ["run_limit_s=7"])]
        self.assertEqual([m.run_limit_s for m in made], [3600.0, 7])
        self.assertEqual(made[0].fingerprint(), made[1].fingerprint())
        for text in ("run_limit_s=0", "run_limit_s=x", "run_limit_s=[1,2]"):
            with self.assertRaisesRegex(scenario.Refused, r"run_limit_s: found .*; accepted: a number"):
                scenario.Scenario(path, {"echo_sounder": echo_sounder}, sets=[text])


class Endings(unittest.TestCase):
    """`neritic experiment` that a signal ends, with a program of its own that does not return; begun as the program begins it, with
    the signals held back."""

    def begin(self, scratch):
        os.mkdir(os.path.join(scratch, "temporary"))
        program = pathlib.Path(scratch, "program")
        program.write_text(f"#!/bin/sh\necho $$ >> '{scratch}/running'\nexec sleep 1000\n")
        program.chmod(0o755)
        return subprocess.Popen([sys.executable, "-B", TOOLS, "echo_sounder", "--out", os.path.join(scratch, "out"), "--program", str(program),
                                 "--workers", "2"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                preexec_fn=lambda: signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT, signal.SIGTERM, signal.SIGHUP]),
                                env=os.environ | {"TMPDIR": os.path.join(scratch, "temporary")})

    def wait_for(self, what):
        until = time.monotonic() + 60
        while not what() and time.monotonic() < until:
            time.sleep(0.002)
        self.assertTrue(what())

    def test_each_signal_ends_it_with_one_line_and_nothing_left_behind(self):
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            with tempfile.TemporaryDirectory() as scratch:
                run, running = self.begin(scratch), pathlib.Path(scratch, "running")
                self.wait_for(lambda: running.exists() and running.read_text().count("\n") == 2)
                self.assertEqual(len(os.listdir(os.path.join(scratch, "temporary"))), 1)
                run.send_signal(number)
                told = run.communicate(timeout=60)[0]
                self.assertEqual((run.returncode, told), (128 + number, "neritic: experiment: interrupted; finished runs are kept, --resume goes on\n"))
                self.assertEqual(os.listdir(os.path.join(scratch, "temporary")), [])
                for pid in running.read_text().split():
                    self.wait_for(lambda: not os.path.exists(f"/proc/{pid}"))

    def test_a_signal_while_it_is_loaded_is_told_in_one_line(self):
        for wait_s in (0.0, 0.02, 0.05, 0.1):  # Python starts, then loads the modules
            with tempfile.TemporaryDirectory() as scratch:
                run = self.begin(scratch)
                time.sleep(wait_s)
                run.send_signal(signal.SIGINT)
                told = run.communicate(timeout=60)[0]
                self.assertEqual(run.returncode, 130, told)
                self.assertRegex(told, r"^neritic: experiment: interrupted.*\n$")
                self.assertEqual(told.count("\n"), 1, told)
                self.assertEqual(os.listdir(os.path.join(scratch, "temporary")), [])


class Files(unittest.TestCase):
    """Of a task: those that decide a run's numbers."""

    TASK = ('[experiment]\nkind = "task"\n[task]\nscene = "scene.toml"\ncontroller = "mine.py"\n[[stages]]\nname = "a"\nuntil = "time > 1"\n')

    def test_an_edit_of_any_of_them_makes_a_run_anew(self):
        import task
        texts = {"t.toml": self.TASK, "scene.toml": 'include = ["parts/a.toml"]\n', "parts/a.toml": 'include = "b.toml"\n',
                 "parts/b.toml": '[[objects]]\nname = "x"\nmodel = "x.gltf"\n', "parts/x.gltf": '{"buffers": [{"uri": "x.bin"}]}', "parts/x.bin": "1",
                 "mine.py": "import os, json\nimport near\nfrom far.deep import thing\nW = os.path.join('w', 'no')\nX = 'weights.txt'\nclass Controller:\n    def act(self): pass\n",
                 "near.py": "import math, mine\ndef late():\n    import later\n", "later.py": "", "far/__init__.py": "", "far/deep/__init__.py": "",
                 "far/deep/thing.py": "from . import other\nfrom ..side import x\n", "far/deep/other.py": "", "far/side.py": "x = 1", "weights.txt": "1"}
        with tempfile.TemporaryDirectory() as folder:
            def write(name, text):
                path = pathlib.Path(folder, name)
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text)

            def files():
                return scenario.Scenario(os.path.join(folder, "t.toml"), {"task": task.Task}).list_runs()[0].files
            for name, text in texts.items():
                write(name, text)
            write("stranger.py", "")
            before = files()
            self.assertEqual(files(), before)
            for name in texts:
                if name != "t.toml":
                    write(name, texts[name] + " ")
                    self.assertNotEqual(files(), before, name)
                    write(name, texts[name])
                    self.assertEqual(files(), before, name)
            write("stranger.py", "1")
            self.assertEqual(files(), before)
            write("mine.py", "def (")  # refused before anything runs
            self.assertRaises(scenario.Refused, files)


class Progress(unittest.TestCase):
    class File(io.StringIO):
        """Stands in for stderr."""

        def __init__(self, terminal):
            super().__init__()
            self.terminal = terminal

        def isatty(self):
            return self.terminal

    def said(self, terminal=False, quiet=False):
        """Of four runs of 50 s, one kept from before, looked at each second."""
        now, told = [0.0], self.File(terminal)
        with unittest.mock.patch.object(sys, "stderr", told):
            progress = runner.Progress("dive", 4, 1, quiet, clock=lambda: now[0])
            while progress.done < 4:
                now[0] += 1.0
                progress.step() if now[0] % 50 == 0 else progress.show()
            progress.end()
        return told.getvalue()

    def test_a_file_gets_a_line_each_half_minute(self):
        self.assertEqual(self.said().splitlines(), [
            "note: dive: run 1 of 4",
            "note: dive: run 2 of 4, 2:00 left",
            "note: dive: run 2 of 4, 3:00 left",
            "note: dive: run 3 of 4, 1:00 left",
            "note: dive: run 4 of 4"])

    def test_a_terminal_gets_one_line_that_is_rewritten_and_quiet_nothing(self):
        told = self.said(terminal=True)
        self.assertNotIn("\n", told)
        self.assertIn("\rdive: run 3 of 4, 50 s left", told)
        self.assertEqual(self.said(quiet=True) + self.said(terminal=True, quiet=True), "")

    def test_a_run_that_lasts_is_told_while_it_lasts(self):
        told = self.File(False)
        with unittest.mock.patch.object(sys, "stderr", told), unittest.mock.patch.object(runner, "SAY_EVERY_S", 0.3), \
                unittest.mock.patch.object(runner, "LOOK_EVERY_S", 0.1), tempfile.TemporaryDirectory() as out:
            runs = [scenario.Run(i, {}, i, {}) for i in (0, 1)]
            kind = SimpleNamespace(run=lambda settings, seed, tools: time.sleep(1.5) or ({"m": 1.0}, {}))
            plan = SimpleNamespace(name="slow", kind_name="slow", kind=kind, run_limit_s=60.0, list_runs=lambda: runs, fingerprint=lambda: "")
            runner.run_all(plan, out, "none", 1, False, False)
        self.assertIn("note: slow: run 0 of 2\n", told.getvalue())
        self.assertRegex(told.getvalue(), r"note: slow: run 1 of 2, 0:0\d left\n")


class Refusals(unittest.TestCase):
    def test_each_name_is_told_once_with_the_nearest_marked(self):
        with self.assertRaises(scenario.Refused) as caught:
            scenario.path_of("ligth")
        told = str(caught.exception)
        self.assertIn("light (the nearest)", told)
        self.assertEqual(told.count("light"), 1, told)

    def test_of_all_the_scenario_that_refuses_is_named(self):
        with tempfile.TemporaryDirectory() as scratch:
            done = subprocess.run([sys.executable, "-B", TOOLS, "all", "--out", os.path.join(scratch, "out"), "--program", "none", "--set", "offset_m=1"],
                                  capture_output=True, text=True)
            self.assertEqual((done.returncode, done.stderr.count("\n")), (2, 1), done.stderr)
            self.assertRegex(done.stderr, '^neritic: imaging: --set: found "offset_m=1"; accepted: ')
            self.assertEqual(os.listdir(os.path.join(scratch, "out")), [])

    def test_a_seed_is_one_that_a_scenes_file_may_have(self):
        import echo_sounder
        path, most = os.path.join(scenario.SHIPPED, "echo_sounder.toml"), 2 ** 63 - 1
        last = scenario.Scenario(path, {"echo_sounder": echo_sounder}, runs=3, seed=most - 2).list_runs()[-1].seed
        self.assertEqual(last, most)
        self.assertIn(f"seed = {most}\n", echo_sounder.SCENE.format(seed=last, floor=0, slope=0, farthest=1, bins=1, rate=1))
        for seed in (most, -1, 2 ** 64):
            with self.assertRaisesRegex(scenario.Refused, rf"--seed: found {seed}; accepted: a whole number in \[0, {most - 2}\]"):
                scenario.Scenario(path, {"echo_sounder": echo_sounder}, runs=3, seed=seed)

    def test_a_scene_is_no_scenario(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "scene.toml")
            with open(path, "w") as file:
                file.write('title = "A reef"\n[[cameras]]\nname = "eye"\n')
            with self.assertRaisesRegex(scenario.Refused, r"^.*scene\.toml: found a scene; accepted: a scenario, .*$"):
                scenario.Scenario(path, {})


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
        world = SimpleNamespace(time=0.0, step=0, step_s=1.0 / hz, agents={"rov": None, "diver": None}, close=lambda: None)
        seen = {"diver/motion": SimpleNamespace(breath_bpm=bpm, heart_bpm=6 * bpm)}

        def tick(steps):
            world.step += steps
            world.time = world.step * world.step_s
            return seen
        world.observe, world.tick = lambda: seen, tick
        world.truth = lambda name: SimpleNamespace(position=np.array([2.0 * (name == "rov"), 0.0, -10.0]))
        tools = SimpleNamespace(python=lambda: SimpleNamespace(open=lambda *_, **__: world))
        measures, self.series = plan.kind.run(plan.settings, 1, tools)
        return measures

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
        for until in ("done", "1 / 0", "heart(rov) - 500", "not (heart(rov) < 500)"):
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


class Report(unittest.TestCase):
    def test_a_setting_that_is_a_factor_or_drawn_is_told_as_such(self):
        told = {"settings": {"slope_deg": 0.0, "range_m": 6.0, "water": "IB"}, "factors": {"slope_deg": [0.0, 5.0]}, "vary": {"range_m": [4.0, 8.0]}}
        self.assertEqual([report.setting(told, k) for k in told["settings"]], ["0 / 5", "4 to 8", "IB"])


class Figures(unittest.TestCase):
    """Each condition is drawn, or what is left out is told."""

    def setUp(self):
        sys.path.insert(0, os.path.join(TOOLS, "..", "plot"))
        try:
            import style
        except ModuleNotFoundError:
            self.skipTest("no matplotlib here")
        self.style = style

    def drawn(self, figures, scenario, conditions, series, measures):
        results = [{"condition": c, "seed": seed, "settings": c, "measures": measures(seed), "failure": None, "series": series}
                   for c in conditions for seed in (1, 2)]
        out = {}
        for name, alt, fig in figures(scenario, results, self.style):
            out[name] = fig, alt, [t.get_text() for ax in fig.axes for t in (ax._left_title, *ax.get_yticklabels(), *ax.texts)]
            self.assert_apart(fig)
        return out

    def assert_apart(self, fig):
        """No panel with its labels lies over another, nor off the picture's edge."""
        boxes = [ax.get_tightbbox(fig.canvas.get_renderer()) for ax in fig.axes]
        for i, a in enumerate(boxes):
            self.assertTrue(a.x0 >= 0 and a.x1 <= fig.bbox.x1 + 1 and a.y0 >= 0 and a.y1 <= fig.bbox.y1, a)
            for b in boxes[:i]:
                self.assertFalse(a.x0 < b.x1 - 1 and b.x0 < a.x1 - 1 and a.y0 < b.y1 - 1 and b.y0 < a.y1 - 1, (a, b))

    def test_of_the_shark(self):
        import shark_figures
        series = {"t": [0.0, 1.0, 2.0], "beside": [3.0, 1.0, 0.2]}
        for n in (1, 8, 14):
            conditions = [{"offset_m": float(i)} for i in range(n)] if n > 1 else [{}]
            fig, alt, texts = self.drawn(shark_figures.figures, None, conditions, series, lambda seed: {"time_to_block_s": 1.0 + seed})["shark.png"]
            for c in conditions[:12]:
                self.assertIn(report.words(c), texts)
            self.assertEqual("The first 12 of 14 conditions" in alt, n > 12)
            self.assertEqual(any("The first 12 of 14 conditions" in t.get_text() for t in fig.texts), n > 12)

    def test_of_a_task(self):
        import task_figures
        plan = SimpleNamespace(stages=[{"name": "go"}], measures=[{"name": f"far_{i}_m", "statistic": "max", "stage": None} for i in range(5)],
                               MEASURES={"success": ("yes or no", ""), **{f"far_{i}_m": ("m", "how far") for i in range(5)}})
        scenario = SimpleNamespace(criteria=[{"measure": m, "at_most": 1} for m in ("success", "far_0_m", "far_1_m")])
        long = "/tmp/a/very/long/path/of/somebody/with/many/folders/mine.py"
        for conditions in ([{}], [{"controller": c} for c in ("baseline", "null", long)],
                           [{"controller": long, "rest_m": float(i), "look_ahead": True} for i in range(5)], [{"rest_m": float(i)} for i in range(14)]):
            made = self.drawn(lambda *a: task_figures.figures(plan, *a), scenario, conditions,
                              {"t": [0.0, 1.0], **{f"far_{i}_m": [1.0, None] for i in range(5)}}, lambda seed: {"success": True, "far_0_m": 0.1 * seed, **({"far_1_m": 2.0} if seed == 1 else {})})
            self.assertEqual(sorted(made), ["outcome.png", "task.png"])
            for fig, alt, texts in made.values():
                told = " ".join(texts).replace("\n", " ")
                for name in report.names(conditions)[:12] if len(conditions) > 1 else ():
                    self.assertIn(name, told)
                self.assertNotIn("folders", told)
                self.assertEqual("The first 12 of 14 conditions" in alt, len(conditions) > 12)
            self.assertIn("The first 4 of 5 measures", made["task.png"][1])

    def test_a_measure_of_a_stage_is_drawn_in_that_stage_alone(self):
        import task_figures
        plan = SimpleNamespace(stages=[{"name": "join"}, {"name": "ascend"}],
                               measures=[{"name": n, "statistic": "mean", "stage": s} for n, s in (("all_m", None), ("up_m", "ascend"), ("first_m", "join"))],
                               MEASURES={n: ("m", "how far") for n in ("all_m", "up_m", "first_m")})
        conditions = [{"controller": "baseline"}, {"controller": "null"}]
        t, far = [0.0, 1.0, 2.0, 3.0], [4.0, 3.0, 2.0, 1.0]
        results = [{"condition": c, "seed": 1, "settings": c, "measures": {}, "failure": None,
                    "series": {"t": t, "stage": stage, **dict.fromkeys(plan.MEASURES, far)}}
                   for c, stage in zip(conditions, ([0, 1, 1, 1], [0, 0, 0, 0]))]
        (name, _, fig), = task_figures.figures(plan, SimpleNamespace(criteria=[]), results, self.style)
        drawn = [[[v if math.isfinite(v) else None for v in line.get_ydata()] for line in ax.lines] for ax in fig.axes]
        self.assertEqual(drawn, [[far], [far], [[None, 3.0, 2.0, 1.0]], [[None] * 4], [[4.0, None, None, None]], [far]])
        self.assertEqual([[t.get_text() for t in ax.texts] for ax in fig.axes], [[], [], [], ["no value"], [], []])
        self.assertEqual(fig.axes[4].lines[0].get_marker(), ".")  # a line of one point is none
        self.assertIn("up (stage ascend): how far", [t.get_text() for t in fig.texts])

    def test_of_the_echo_sounder(self):
        import echo_sounder
        conditions = [{"slope_deg": float(i)} for i in range(9)]
        fig, alt, texts = self.drawn(echo_sounder.figures, None, conditions, {"t": [0.0, 1.0], "range": [9.0, 8.0], "true": [9.0, 8.001]}, lambda seed: {})["echo_sounder.png"]
        for c in conditions[:8]:
            self.assertIn("First return less the perpendicular distance: " + report.words(c), texts)
        self.assertIn("The first 8 of 9 conditions", alt)


class Power(unittest.TestCase):
    def test_runs_to_tell_by_the_textbook(self):
        # Deviations 1 and 1.1, difference 1 (10 % of 10): (1 + 1.21) (1.96 + 0.8416)^2 = 17.3, and one more by Student's t.
        values = [10 + z for z in (-1.2247449, 0, 1.2247449)]
        self.assertEqual(intervals.runs_to_tell(values * 1000, 1.1), 19)

    def test_limits_and_powers_of_students_t_by_the_tables(self):
        # Student's t, 2.5 % above (Abramowitz and Stegun 1964, table 26.10).
        for freedom, limit in ((2, 4.303), (3, 3.182), (10, 2.228), (30, 2.042), (120, 1.980), (300, 1.968)):
            self.assertAlmostEqual(intervals.t_limit(freedom), limit, delta=6e-4)
        # Paired t test (Cohen 1988, as G*Power 3 computes it).
        self.assertAlmostEqual(intervals.paired_power(0.5, 1.0, 34), 0.8078, 4)
        self.assertAlmostEqual(intervals.paired_power(1.0, 1.0, 10), 0.8031, 4)
        self.assertEqual([intervals.pairs_to_tell(*c) for c in ((0.5, 1.0), (1.0, 1.0), (1.0, 0.01), (1.0, 0.0), (0.0, 1.0))], [34, 10, 3, 3, None])

    def test_small_groups_have_the_power_that_draws_find(self):
        """Of three normal pairs whose normal approximation would claim 98 %."""
        rng = np.random.Generator(np.random.Philox(key=5))
        drawn = rng.normal(2.4, 1.0, (20000, 3))
        found = np.abs(drawn.mean(axis=1)) > intervals.t_limit(2) * drawn.std(axis=1, ddof=1) / math.sqrt(3)
        self.assertAlmostEqual(intervals.paired_power(2.4, 1.0, 3), float(found.mean()), delta=0.012)
        self.assertLess(found.mean(), 0.8)
        values = [10 + intervals.normal_quantile((i + 0.5) / 400) for i in range(400)]
        for runs in (4, 8):
            self.assertAlmostEqual(intervals.power_by_draws(values, runs, draws=20000), intervals.power_of(values, runs), delta=0.03)

    def test_draws_agree_with_the_approximation(self):
        values = [10 + 3 * intervals.normal_quantile((i + 0.5) / 400) for i in range(400)]
        for runs in (40, 100, 200):
            self.assertAlmostEqual(intervals.power_by_draws(values, runs), intervals.power_of(values, runs), delta=0.04)


if __name__ == "__main__":
    unittest.main()
