"""The parts of tools/experiment that need no program: runs, their ends, files and refusals. Tasks and reports: beside it. Exit 77: skipped."""
import errno
import io
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

from experiment_tools import HERE, TOOLS

import numpy as np

import detector
import imaging
import report
import rotations
import runner
import scenario


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
        asked = SimpleNamespace(runs=2, seed=None, set=[], quick=False)
        made = outcomes.plans({"shark": shark}, asked)
        self.assertEqual([len(p.list_runs()) for p in made], [2 * len(k[1]) for k in outcomes.KNOBS])
        for plan, knob in zip(made, outcomes.KNOBS):
            self.assertIn(f"one knob turned: {knob[3]}. Its levels: {report.number(knob[1][0])}, ", plan.about)

    @unittest.skipUnless(os.path.exists(detector.model_of("shipped")), "no shipped detector")
    def test_a_quick_one_has_few_runs_that_draw(self):
        import outcomes
        import shark
        made = outcomes.plans({"shark": shark}, SimpleNamespace(runs=None, seed=4, set=[], quick=True))
        self.assertEqual([p.told_as for p in made], [f"{i + 1} of 7: {k[0]}" for i, k in enumerate(outcomes.KNOBS)])
        runs = [r for p in made for r in p.list_runs()]
        self.assertEqual({r.seed for r in runs}, set(range(4, 10)))
        self.assertLessEqual(sum(r.settings["detector"] != "assumed" or r.settings["shark_known_by"] == "sonar" for r in runs), 6 * 5)
        self.assertNotIn("reference", {r.settings["sonar_quality"] for r in runs if r.settings["shark_known_by"] == "sonar"})
        # Every level is one of the whole, so that --resume without --quick goes on.
        for plan, whole in zip(made, outcomes.plans({"shark": shark}, SimpleNamespace(runs=None, seed=4, set=[], quick=False))):
            self.assertEqual(plan.fingerprint(), whole.fingerprint())
            self.assertLessEqual({r.key() for r in plan.list_runs()}, {r.key() for r in whole.list_runs()})

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
            rows = outcomes.run({"shark": shark}, one, SimpleNamespace(out=folder, program="none", runs=10, seed=3, set=[], quick=False))
            page = pathlib.Path(folder, "index.html").read_text()
        self.assertEqual([[r[k] for k in ("time_low_s", "time_to_block_s", "time_high_s", "blocked_in_3_s")] for r in rows],
                         [[1.1, 1.45, 1.8, 1.0], [1.1, 1.45, None, 0.6], [1.0, None, None, 0.4]])
        for words in ("<td>half or more did not block</td><td>1 or more</td>", "seeds everywhere, 3 to 12", "neritic 0.1.0, commit unknown, program feed"):
            self.assertIn(words, page)


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


class Profiling(unittest.TestCase):
    """Soundings through layers that the processing does not know."""

    def test_echoes_arrive_where_rays_through_thin_layers_do(self):
        import profiling
        for bottom, depth in ((1440.0, 10.0), (1560.0, 10.0), (1560.0, 24.0), (1500.0, 10.0)):
            settings = {k: v.default for k, v in profiling.SETTINGS.items()} | {"bottom_speed_m_s": bottom, "depth_m": depth}
            for leaves in np.radians([-44.0, -20.0, 0.0, 5.0, 43.0]):
                # Snell's law from layer to layer.
                speed = 1500.0 + (bottom - 1500.0) * (np.arange(20000) + 0.5) / 20000 * depth / 30.0
                sine = math.sin(leaves) * speed / 1500.0
                across, time = (depth / 20000 * v.sum() for v in (sine / np.sqrt(1 - sine ** 2), 1 / speed / np.sqrt(1 - sine ** 2)))
                towards = math.atan2(across, depth)
                found = profiling.heard(settings, *(1500.0 * time * np.array([f(towards)]) for f in (math.sin, math.cos)))
                np.testing.assert_allclose(np.ravel(found), [1500.0 * time * math.sin(leaves), 1500.0 * time * math.cos(leaves)], atol=1e-6)

    def test_the_published_smile_is_what_is_judged(self):
        import profiling
        plan = scenario.Scenario(scenario.path_of("profiling_sound_speed"), {"profiling": profiling})
        judged = [c for c in plan.criteria if c["measure"] == "smile_off_m"]
        self.assertEqual([(c["statistic"], c.get("at_least"), c.get("at_most"), "where" in c) for c in judged],
                         [("min", -0.004, None, False), ("max", None, 0.004, False)])
        for run, smile in zip(plan.list_runs(), (-0.0576, 0.0584)):
            edge = math.radians(43.0)
            self.assertAlmostEqual(profiling.traced_depth(run.settings, edge) - profiling.traced_depth(run.settings, 0.0), smile, 4)
        with self.assertRaisesRegex(scenario.Refused, "tide_m: found 1 with a bottom_speed_m_s that is not surface_speed_m_s"):
            scenario.Scenario(scenario.path_of("profiling_sound_speed"), {"profiling": profiling}, sets=["tide_m=1"])


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
            with tempfile.TemporaryDirectory() as out:
                results = self.run_all(out, range(1, 9), workers)
                causes = [r["failure"] for r in results]
                self.assertEqual([r["measures"] for r in results], [{"m": s} if s in (1, 8) else {} for s in range(1, 9)])
                self.assertEqual((causes[0], causes[7]), (None, None))
                self.assertRegex(causes[1], r"^SystemExit: 3 \(test_experiment.py:\d+\)$")
                self.assertEqual(causes[2], "its process ended with status 4")
                self.assertRegex(causes[3], r"^ValueError: two lines \(")
                self.assertEqual(causes[4:6], ["did not end within 3 s of the clock (run_limit_s)"] * 2)
                self.assertIn("killed by SIGKILL", causes[6])
                self.assertEqual(os.listdir(out), ["runs.jsonl"])  # what the runs wrote is gone
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

    def test_what_a_kill_left_is_removed_by_the_next_call(self):
        code = f"""import sys
sys.path.insert(0, {HERE!r})
out, sys.argv[1:] = sys.argv[1], []
import os, signal, test_experiment
def killed(settings, seed, tools):
    open(os.path.join(tools.folder, "recording"), "w").close()
    os.kill(os.getppid(), signal.SIGKILL)
    while True:
        signal.pause()
test_experiment.Runs().run_all(out, [1], 1, run=killed)
"""
        with tempfile.TemporaryDirectory() as out:
            done = subprocess.run([sys.executable, "-B", "-c", code, out], capture_output=True, text=True, timeout=60)
            self.assertEqual(done.returncode, -signal.SIGKILL, done.stderr)
            pathlib.Path(out, "runs.jsonl.1.tmp").touch()
            pathlib.Path(out, "mine").touch()
            self.assertTrue(os.path.isfile(os.path.join(out, runner.SCRATCH, "0", "recording")))
            for _ in range(100):  # until its worker has ended too, which holds the lock
                try:
                    self.assertEqual(self.run_all(out, [1], 1, resume=True)[0]["measures"], {"m": 1})
                    break
                except scenario.Refused:
                    time.sleep(0.1)
            self.assertEqual(sorted(os.listdir(out)), ["mine", "runs.jsonl"])

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
        program = pathlib.Path(scratch, "program")
        program.write_text(f"#!/bin/sh\necho $$ >> '{scratch}/running'\nexec sleep 1000\n")
        program.chmod(0o755)
        return subprocess.Popen([sys.executable, "-B", TOOLS, "echo_sounder", "--out", os.path.join(scratch, "out"), "--program", str(program),
                                 "--workers", "2"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                preexec_fn=lambda: signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT, signal.SIGTERM, signal.SIGHUP]),
                                env=os.environ | {"TMPDIR": "/nowhere"})

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
                self.assertGreaterEqual(len(os.listdir(os.path.join(scratch, "out", runner.SCRATCH))), 1)
                run.send_signal(number)
                told = run.communicate(timeout=60)[0]
                self.assertEqual((run.returncode, told), (128 + number, "neritic: experiment: interrupted; finished runs are kept, --resume goes on\n"))
                self.assertFalse(os.path.exists(os.path.join(scratch, "out", runner.SCRATCH)))
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
                self.assertFalse(os.path.exists(os.path.join(scratch, "out", runner.SCRATCH)))


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


class Draws(unittest.TestCase):
    def test_a_whole_number_is_drawn_evenly_with_both_ends(self):
        import shark
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "own.toml")
            pathlib.Path(path).write_text('[experiment]\nkind = "shark"\n[vary]\ncrop_px = [62, 66]\nmarkers = [0, 65535]\ngaze_error_deg = [0.5, 1.0]\n')
            runs = scenario.Scenario(path, {"shark": shark}, runs=2000).list_runs()
            found = [r.settings["crop_px"] for r in runs]
            self.assertEqual(set(map(type, found)), {int})
            counts = [found.count(v) for v in range(62, 67)]
            self.assertEqual(sum(counts), 2000)
            # 400 each: the deviation of a count is 18.
            self.assertLess(max(abs(n - 400) for n in counts), 4 * 18, counts)
            self.assertTrue(all(0.5 <= r.settings["gaze_error_deg"] < 1.0 for r in runs))
            self.assertLess(max(r.settings["markers"] for r in runs), 65536)
        # The largest of what SHA-256 gives is still within.
        with unittest.mock.patch.object(scenario, "draw", lambda *_: 1 - 2.0 ** -53):
            self.assertEqual(scenario.draw_whole(1, "k", -3, 2 ** 31), 2 ** 31)


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


if __name__ == "__main__":
    unittest.main()
