"""Reports of neritic experiment: criteria, intervals, pages, figures, power. Exit 77: skipped."""
import json
import math
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest
import unittest.mock
from types import SimpleNamespace

from experiment_tools import TOOLS

import numpy as np

import intervals
import report
import scenario
import summary


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
        # A run without a value counts as the worst there, too.
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
        # Few pairs are covered as often. A share of 95 % among 600 samples has a standard deviation of 0.9 %.
        rng, within = np.random.Generator(np.random.Philox(key=8)), 0
        for _ in range(600):
            first = rng.normal(0, 1, 6)
            second = 0.5 * first + rng.normal(1, 1, 6)
            _, low, high = intervals.median_difference_interval(list(zip(second, first)))
            within += low <= 1.0 <= high
        self.assertGreaterEqual(within / 600, 0.96)
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
            fig, alt, _ = made["outcome.png"]
            for told in (alt, " ".join(t.get_text().replace("\n", " ") for t in fig.texts)):
                self.assertIn("A dot is a run, a thick bar the median. Of shares, the dot is the share, the line its 95 % interval. "
                              "Red, dashed: a criterion's limit.", told)
        # Only of marks that there are; all of it within the figure.
        for measures, limit, words in ((("success",), {"at_least": 1}, "A dot with a line is a share and its 95 % interval. Red, dashed: a criterion's limit."),
                                       (("far_0_m",), {"at_most": 1, "less": {"a": 1}}, "A dot is a run, a thick bar the median.")):
            scenario.criteria = [{"measure": m, **limit} for m in measures]
            fig, alt, _ = self.drawn(lambda *a: task_figures.figures(plan, *a), scenario, [{}], {"t": [0.0, 1.0], **{f"far_{i}_m": [1.0, None] for i in range(5)}},
                                     lambda seed: {"success": True, "far_0_m": 0.1 * seed})["outcome.png"]
            self.assertTrue(alt.endswith(words), alt)
            told, = fig.texts
            box = told.get_window_extent(fig.canvas.get_renderer())
            self.assertTrue(0 <= box.x0 and box.x1 <= fig.bbox.x1 and 0 <= box.y0, box)
            self.assertLess(box.y1, min(ax.xaxis.label.get_window_extent().y0 for ax in fig.axes))

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
