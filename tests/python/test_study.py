"""Studies with people: orders, questionnaires, blocks, withdrawal, the wizard. Exit 77: skipped."""
import json
import os
import pathlib
import pty
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import unittest.mock
from types import SimpleNamespace

from experiment_tools import TOOLS

import numpy as np

import questionnaires
import scenario


class Questionnaires(unittest.TestCase):
    def test_each_block_stands_once_at_each_place_and_after_each_other(self):
        for n in range(1, 9):
            rows = questionnaires.latin_square(n)
            times = len(rows) // n
            for place in range(n):
                self.assertEqual(sorted(r[place] for r in rows), sorted(list(range(n)) * times))
            after = [(a, b) for r in rows for a, b in zip(r, r[1:])]
            if n > 1:
                counts = {p: after.count(p) for p in after}
                self.assertEqual(len(counts), n * (n - 1))
                self.assertEqual(len(set(counts.values())), 1)

    def test_one_block_has_one_order(self):
        self.assertEqual(questionnaires.latin_square(1), [[0]])

    def test_scores_at_the_ends_of_the_published_scales(self):
        worst = questionnaires.score_ssq([3] * 16)  # Kennedy et al. 1993: 200.34, 159.18, 292.32, 235.62
        np.testing.assert_allclose(list(worst.values()), [200.34, 159.18, 292.32, 235.62])
        self.assertEqual(questionnaires.score_ssq([0] * 16)["ssq_total"], 0)
        self.assertEqual(questionnaires.score_tlx([0, 20, 40, 60, 80, 100])["tlx_raw"], 50)
        self.assertEqual(questionnaires.score_trust([1] * 5 + [7] * 7)["trust_mean"], 7)
        self.assertEqual(questionnaires.score_presence([7, 6, 5, 5, 5, 2]), {"presence_mean": 5, "presence_high": 2})

    def test_answers_off_the_scale_are_refused(self):
        for text in ("", "seven", "101", "-5", "7"):
            self.assertIsNone(questionnaires.FORMS["nasa_tlx"].check(0, text)[0])
        self.assertEqual(questionnaires.FORMS["nasa_tlx"].check(0, " 55 "), (55, None))

    def test_weights_of_workload_are_how_often_a_scale_was_chosen(self):
        form = questionnaires.FORMS["nasa_tlx_weighted"]
        self.assertEqual(len(form.items), 6 + 15)
        # The first of each pair: weights 5, 4, 3, 2, 1, 0, so (5 10 + 4 20 + 3 30 + 2 40 + 50) / 15.
        self.assertEqual(form.scores([10, 20, 30, 40, 50, 60] + [1] * 15), {"tlx_raw": 35, "tlx_weighted": 350 / 15})
        self.assertEqual(form.scores([10, 20, 30, 40, 50, 60] + [2] * 15)["tlx_weighted"], (20 + 60 + 120 + 200 + 300) / 15)
        self.assertEqual(form.items[6][0], "which mattered more: mental demand (1) or physical demand (2)?")
        self.assertIsNone(form.check(6, "0")[0])

    def test_a_declined_answer_leaves_no_score(self):
        self.assertIsNone(questionnaires.FORMS["ssq"].scores([0] * 15 + [None]))

    def test_a_plans_own_questionnaire_is_checked_and_scored(self):
        made = questionnaires.own("q", {"calm": {"items": ["I was calm", "I was afraid", "I knew where I was"], "most": 5, "reversed": [2]}})["calm"]
        self.assertEqual(made.scores([5, 1, 2]), {"calm_mean": 4.0})
        for key, value in (("items", []), ("items", "calm"), ("items", [1]), ("most", 1), ("most", "x"), ("step", 4), ("reversed", [4]), ("reversed", 1),
                           ("title", 3), ("itmes", [])):
            with self.assertRaisesRegex(scenario.Refused, r"^q\.calm.*found .*; accepted: "):
                questionnaires.own("q", {"calm": {"items": ["a", "b", "c"], key: value}})
        for name in ("ssq", "a/b", "../a"):
            with self.assertRaisesRegex(scenario.Refused, "accepted: a new word"):
                questionnaires.own("q", {name: {"items": ["a"]}})


class PersonsSide(unittest.TestCase):
    def test_the_shark_is_on_either_side_by_the_seed(self):
        import shark
        import shark_person
        s = {k: v.default for k, v in shark.SETTINGS.items()}
        angles = [shark_person.away_deg(s, seed) for seed in range(1, 41)]
        self.assertTrue(10 < sum(a > 0 for a in angles) < 30, angles)
        self.assertTrue(all(60 <= abs(a) <= 120 for a in angles), angles)
        self.assertGreater(max(map(abs, angles)) - min(map(abs, angles)), 30)
        self.assertEqual(shark_person.away_deg(s | {"person_side": "starboard", "person_spread_deg": 0.0}, 3), -90.0)


class FakeRobot:
    """What the wizard tells it, and when."""

    def __init__(self, name="rov", modem=0):
        self.name, self.modem, self.told, self.grips, self.sent = name, modem, [], [], []

    def send(self, words):
        if words in self.sent:
            raise ValueError("busy")
        self.sent.append(words)

    def grip(self, choice):
        self.grips.append(choice)

    def goto(self):
        pass

    def velocity(self, *way, hold):
        self.told.append((time.monotonic(), list(way), hold))

    def release(self):
        self.told.append((time.monotonic(), None, 0.0))


class Wizard(unittest.TestCase):
    """The console at a terminal of its own, with a fake robot."""

    def session(self, *presses, robots=("rov",), grips=False, modems=0, divers_modem=0, **flags):
        """(the orders of the robot that has some, markers) of keys and pauses."""
        import wizard
        self.robots, marks, (ours, theirs) = [FakeRobot(name, modems) for name in robots], [], pty.openpty()
        self.marks = marks
        diver = SimpleNamespace(name="diver", modem=divers_modem, jacket=lambda: None)
        streams = [SimpleNamespace(name=f"{name}/gripper") for name in robots if grips]
        world = SimpleNamespace(agents={a.name: a for a in [*self.robots, diver]}, streams=streams, close=lambda: None)

        def connect(address, **given):
            self.connected = address, given
            return world
        fake = SimpleNamespace(connect=connect, Error=RuntimeError, BadInput=ValueError)
        asked = SimpleNamespace(**{"program": "", **dict.fromkeys(("robot", "server", "key", "server_key", "speak")), **flags})
        before = wizard.Tools, sys.stdin, sys.stdout

        def play():
            for press in presses:
                if isinstance(press, str):
                    os.write(ours, press.encode())
                else:
                    time.sleep(press)
            os.write(ours, b"x")
        player = threading.Thread(target=play)
        wizard.Tools = lambda *_: SimpleNamespace(python=lambda: fake)
        sys.stdin, sys.stdout = os.fdopen(theirs, "r"), open(os.devnull, "w")
        try:
            player.start()
            wizard.run(asked, "", lambda **what: marks.append(what))
        finally:
            player.join()
            sys.stdin.close()
            sys.stdout.close()
            wizard.Tools, sys.stdin, sys.stdout = before
            os.close(ours)
        return next((r.told for r in self.robots if r.told), []), marks

    def test_the_robot_and_the_server_are_chosen(self):
        _, marks = self.session(0.2, "w", 0.3, robots=("one", "two"), robot="two", server="tcp://lab:5", key="w.secret", server_key="server.public")
        self.assertEqual([bool(r.told) for r in self.robots], [False, True])
        self.assertEqual(self.connected, ("tcp://lab:5", {"name": "wizard", "key": "w.secret", "server_key": "server.public"}))
        self.assertEqual(marks[0], {"marker": "wizard begins", "robot": "two"})
        self.session(0.3)
        self.assertEqual(self.connected[0], "tcp://127.0.0.1:47910")
        for robots, name, told in ((("one", "two"), None, "found 2 vehicles; accepted: --robot, one of one, two"),
                                   (("one", "two"), "three", "--robot: found three; accepted: one, two"), ((), None, "has no vehicle")):
            with self.assertRaisesRegex(scenario.Refused if robots else scenario.Failed, told):
                self.session(robots=robots, robot=name)

    def test_the_gripper_closes_and_opens_and_is_given_back(self):
        _, marks = self.session(0.2, "g", 0.2, "o", 0.2, "0", 0.2, grips=True)
        self.assertEqual(self.robots[0].grips, ["close", "open", "auto", "auto"])
        self.assertEqual([m["gripper"] for m in marks if m["marker"] == "wizard grips"], ["close", "open"])
        _, marks = self.session(0.2, "g", 0.2)
        self.assertEqual((self.robots[0].grips, [m for m in marks if m["marker"] == "wizard grips"]), ([], []))

    def test_a_program_says_the_phrases(self):
        with tempfile.TemporaryDirectory() as folder:
            out = os.path.join(folder, "said")
            speaks = f"{sys.executable} -c 'import sys; open(sys.argv[1], \"a\").write(sys.argv[2] + chr(10)); sys.exit(\"wait\" in sys.argv[2])' {out}"
            _, marks = self.session(0.2, "1", 0.5, "2", 1.0, speak=speaks)
            self.assertEqual(pathlib.Path(out).read_text(), "come here\nwait\n")
            self.assertEqual([(m["marker"], m["phrase"], m.get("spoken")) for m in marks if "phrase" in m],
                             [("wizard says", "come here", True), ("wizard says", "wait", True), ("wizard was not heard", "wait", None)])
        _, marks = self.session(0.2, "1", 0.3)
        self.assertEqual([m["spoken"] for m in marks if m["marker"] == "wizard says"], [False])
        for wrong in ("no_such_program_here -x", "", "'"):
            with self.assertRaisesRegex(scenario.Refused, "--speak: found .*; accepted"):
                self.session(speak=wrong)

    def test_phrases_go_by_modem_to_a_diver_who_has_one(self):
        _, marks = self.session(0.2, "1", 0.2, "2", 0.2, "1", 0.3, modems=1, divers_modem=2)
        self.assertEqual(self.robots[0].sent, ["come here", "wait"])
        self.assertEqual([m["sent"] for m in marks if m["marker"] == "wizard says"], [True, True, False])
        for modems, divers_modem in ((0, 1), (1, 0)):
            _, marks = self.session(0.2, "1", 0.3, modems=modems, divers_modem=divers_modem)
            self.assertEqual(self.robots[0].sent, [])
            self.assertEqual([m["sent"] for m in marks if m["marker"] == "wizard says"], [False])

    def test_keys_that_come_at_once_are_all_taken(self):
        _, marks = self.session(0.3, "135", 0.5)
        self.assertEqual([m["phrase"] for m in marks if m["marker"] == "wizard says"], ["come here", "look there", "well done"])

    def test_its_end_is_marked_where_the_server_has_gone(self):
        def gone(*_, **__):
            raise RuntimeError("no answer")
        with unittest.mock.patch.object(FakeRobot, "release", gone):
            with self.assertRaisesRegex(scenario.Failed, "study wizard: no answer"):
                self.session(0.3, "w", 0.2)
        self.assertEqual([m for m in self.marks if "ends" in m["marker"]], [{"marker": "wizard ends", "released": False}])
        self.session(0.3)
        self.assertEqual(self.marks[-1], {"marker": "wizard ends", "released": True})

    def test_after_a_key_and_after_stop_the_robot_is_held_until_it_is_given_back(self):
        told, marks = self.session(0.2, "w", 0.3, " ", 2.5, "0", 1.0)
        orders = [o for o in told if o[1] is not None]
        self.assertIn([0.4, 0.0, 0.0, 0.0], [o[1] for o in orders])
        still = [o for o in orders if not any(o[1])]
        self.assertGreater(still[-1][0] - still[0][0], 2.0)
        # No order ends before the next comes.
        for a, b in zip(orders, orders[1:]):
            self.assertLess(b[0] - a[0], a[2])
        self.assertIn("wizard releases", [m["marker"] for m in marks])
        released = next(o[0] for o in told if o[1] is None)
        self.assertFalse([o for o in orders if o[0] > released])


class Study(unittest.TestCase):
    """Two participants of two blocks; the second stops in the middle of a questionnaire and goes on."""

    PLAN = ('[study]\ntitle = "T"\nconsent = "Do you?"\nafter_block = ["nasa_tlx"]\nafter = ["ssq"]\n'
            '[[blocks]]\nname = "a"\n[[blocks]]\nname = "b"\n')

    def study(self, what, *words, answers=None):
        call = [sys.executable, "-B", os.path.join(TOOLS, "study.py"), "--program", "none", what, self.folder, *words]
        if answers is not None:
            self.write("answers", answers)
            call += ["--answers", os.path.join(self.scratch, "answers")]
        done = subprocess.run(call, capture_output=True, text=True)
        return done.returncode, done.stdout + done.stderr

    def write(self, name, text):
        with open(os.path.join(self.scratch, name), "w") as file:
            file.write(text)

    def read(self, name):
        with open(os.path.join(self.folder, name)) as file:
            return file.read()

    def test_withdrawal_erases_one_participant_and_leaves_the_rest(self):
        with tempfile.TemporaryDirectory() as self.scratch:
            self.folder = os.path.join(self.scratch, "study")
            self.write("plan.toml", self.PLAN)
            self.assertEqual(self.study("begin", "--plan", os.path.join(self.scratch, "plan.toml"))[0], 0)
            self.assertIn("nothing is kept", self.study("enrol", answers="no\n")[1])
            self.assertIn("P01. Blocks: a, b", self.study("enrol", answers="yes\n")[1])
            self.assertIn("P02. Blocks: b, a", self.study("enrol", answers="yes\n")[1])
            block = "\n50\n55\n60\n101\n10\n0\n100\n\n"  # 101 is refused and asked again; Enter ends the questionnaire
            ssq = "3\n" * 16 + "\n"
            self.assertEqual(self.study("run", "P01", answers=block + block + ssq)[0], 0)
            self.assertEqual(self.study("run", "P02", answers="\n50\n55\n")[0], 1)
            self.assertEqual(self.study("run", "P02", answers="60\n10\n0\n100\n\n" + block + ssq)[0], 0)
            table = self.study("table")[1]
            for row in ("P01,a,1,45.8333", "P02,b,1,45.8333", "P01,after,,,200.34,159.18,292.32,235.62"):
                self.assertIn(row, table)
            kept = self.read("participants/P02/markers.jsonl")
            self.assertEqual(self.study("withdraw", "P01", "--yes")[0], 0)
            self.assertFalse(os.path.exists(os.path.join(self.folder, "participants", "P01")))
            self.assertEqual(self.read("participants/P02/markers.jsonl"), kept)
            self.assertNotIn("P01", self.read("scores.csv"))
            self.assertIn("P02,b,1,45.8333", self.read("scores.csv"))
            self.assertEqual(self.study("run", "P01")[0], 2)
            # A withdrawal that was cut short after its first step is ended by the same command.
            for left in ("participants/P01/markers.jsonl", "scores.csv.17.tmp"):
                os.makedirs(os.path.dirname(os.path.join(self.folder, left)), exist_ok=True)
                self.write(os.path.join(self.folder, left), "P01,a,1\n")
            self.assertEqual(self.study("withdraw", "P01", "--yes")[0], 0)
            self.assertEqual(sorted(os.listdir(self.folder)), ["participants", "scores.csv", "study.json"])
            self.assertEqual(os.listdir(os.path.join(self.folder, "participants")), ["P02"])
            # The next one takes the order of the one who left, under a new name.
            self.assertIn("P03. Blocks: a, b", self.study("enrol", answers="yes\n")[1])

    def test_an_answer_can_be_corrected_and_declined(self):
        with tempfile.TemporaryDirectory() as self.scratch:
            self.folder = os.path.join(self.scratch, "study")
            own = '[questionnaires.calm]\nitems = ["I was calm", "I was afraid"]\nmost = 5\nreversed = [2]\n'
            self.write("plan.toml", self.PLAN.replace('after = ["ssq"]', 'after = ["calm", "ssq"]') + own)
            self.assertEqual(self.study("begin", "--plan", os.path.join(self.scratch, "plan.toml"))[0], 0)
            self.study("enrol", answers="yes\n")
            for words, told in ((("mood",), "found mood"), ((), "found no questionnaire")):
                status, text = self.study("ask", "P01", *words)
                self.assertEqual((status, text.count("\n")), (2, 1), text)
                self.assertRegex(text, f"{told}; accepted: nasa_tlx, .*, calm")
            first = "\nback\n50\n55\nback\n60\n0\n0\n0\n100\nyes\nback\n10\n\n"  # 50 60 0 0 0 10: the second and the last are corrected
            second = "\n50\nskip\n0\n0\n0\n10\n\n"
            status, text = self.study("run", "P01", answers=first + second + "4\n2\n\n" + "0\n" * 16 + "\n")
            self.assertEqual(status, 0, text)
            for words in ("this is the first question", 'found "yes"; accepted: Enter, back'):
                self.assertIn(words, text)
            answers = [json.loads(self.read(f"participants/P01/{block}-nasa_tlx.json")) for block in "ab"]
            self.assertEqual([a["answers"] for a in answers], [[50, 60, 0, 0, 0, 10], [50, None, 0, 0, 0, 10]])
            table = self.study("table")[1]
            self.assertIn("P01,a,1,20.0", table)
            self.assertNotIn("P01,b", table)  # a score of five scales would be another one
            self.assertRegex(table, "calm_mean")
            self.assertRegex(table, r"P01,after,,,.*4\.0")  # (4 + (6 - 2)) / 2

    def test_each_block_and_questionnaire_has_answers_of_its_own(self):
        own = "".join(f'[questionnaires.{name}]\nitems = ["x"]\n' for name in ("c", "b_c"))
        plan = (self.PLAN.replace('["nasa_tlx"]', '["b_c", "c"]').replace('after = ["ssq"]\n', "").replace('name = "b"', 'name = "a_b"') + own)
        for form in (2, 1):  # a study that began in format 1 goes on in it, whose names two can share
            with tempfile.TemporaryDirectory() as self.scratch:
                self.folder = os.path.join(self.scratch, "study")
                self.write("plan.toml", plan)
                self.assertEqual(self.study("begin", "--plan", os.path.join(self.scratch, "plan.toml"))[0], 0)
                self.write("study/study.json", self.read("study.json").replace('"format": 2', f'"format": {form}'))
                self.study("enrol", answers="yes\n")
                status, text = self.study("run", "P01", answers="\n1\n\n2\n\n" + "\n3\n\n" + ("4\n\n" if form == 2 else ""))
                self.assertEqual(status, 0, text)
                table = self.study("table")[1]
                self.assertIn("P01,a,1,2.0,1.0", table)
                self.assertIn("P01,a_b,2,4.0,3.0" if form == 2 else "P01,a_b,2,,3.0", table)
                self.write("study/study.json", self.read("study.json").replace(f'"format": {form}', '"format": 3'))
                status, text = self.study("table")
                self.assertEqual((status, text.count("\n")), (2, 1), text)
                self.assertIn("study.json: found format 3; accepted: 1, 2", text)

    def test_what_is_asked_between_blocks_is_in_the_table_and_goes_on(self):
        with tempfile.TemporaryDirectory() as self.scratch:
            self.folder = os.path.join(self.scratch, "study")
            self.write("plan.toml", self.PLAN + '[questionnaires.c]\nitems = ["x", "y"]\n[[blocks]]\nname = "asked_b"\n')
            self.assertEqual(self.study("begin", "--plan", os.path.join(self.scratch, "plan.toml"))[0], 0)
            self.study("enrol", answers="yes\n")
            status, text = self.study("ask", "P01", "c", answers="2\n")
            self.assertEqual(status, 1, text)  # cut off after the first question
            self.assertEqual(self.study("table")[1].count("\n"), 1)
            self.assertEqual(self.study("ask", "P01", "trust", answers="4\n" * 12 + "\n")[0], 0)
            status, text = self.study("ask", "P01", "c", answers="5\n\n")
            self.assertEqual(status, 0, text)
            self.assertRegex(text, r"Goes on with c of asked_\d{8}_\d{6}, 1 of 2 answered")
            # Again at once: another one, also within the same second.
            for _ in range(3):
                status, text = self.study("ask", "P01", "c", answers="1\n1\n\n")
                self.assertEqual((status, "1/2" in text), (0, True), text)
            rows = [r.split(",") for r in self.study("table")[1].splitlines()]
            self.assertEqual(sorted(rows[0]), ["block", "c_mean", "participant", "trust_mean", "turn"])
            mean = rows[0].index("c_mean")
            self.assertEqual([r[mean] for r in rows[1:] if r[mean]], ["3.5", "1.0", "1.0", "1.0"])
            self.assertEqual(len({r[1] for r in rows[1:] if r[mean]}), 4)
            for row in rows[1:]:
                self.assertRegex(row[1], r"^asked_\d{8}_\d{6}")
            self.assertEqual(self.study("withdraw", "P01", "--yes")[0], 0)
            self.assertEqual(self.read("scores.csv").count("\n"), 1)

    def test_questionnaires_of_one_moment_do_not_give_one_score_twice(self):
        with tempfile.TemporaryDirectory() as self.scratch:
            self.folder = os.path.join(self.scratch, "study")
            for names, told in (('"ssq", "ssq"', "ssq and ssq, which both give ssq_nausea"),
                                ('"nasa_tlx", "nasa_tlx_weighted"', "nasa_tlx and nasa_tlx_weighted, which both give tlx_raw")):
                self.write("plan.toml", self.PLAN.replace('after = ["ssq"]', f"after = [{names}]"))
                status, text = self.study("begin", "--plan", os.path.join(self.scratch, "plan.toml"))
                self.assertEqual((status, text.count("\n")), (2, 1), text)
                self.assertIn(f"study.after: found {told}; accepted: one of them", text)

    def test_markers_reach_the_blocks_program_while_it_runs(self):
        with tempfile.TemporaryDirectory() as self.scratch:
            self.folder = os.path.join(self.scratch, "study")
            program = os.path.join(self.scratch, "program")
            study = [sys.executable, "-B", os.path.join(TOOLS, "study.py"), "--program", "none", "mark", self.folder, "P01", "seen"]
            self.write("program", f"""#!{sys.executable}
import json, socket, subprocess, sys
port, out = int(sys.argv[2]), sys.argv[3]
with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as listens:
    listens.bind(("127.0.0.1", port))
    listens.settimeout(10)
    heard = []
    while len(heard) < 2:
        line = listens.recv(2000)
        if line:
            heard.append(json.loads(line)["marker"])
            if len(heard) == 1:
                subprocess.run({study!r}, check=True)
json.dump(heard, open(out, "w"))
""")
            os.chmod(program, 0o755)
            self.write("plan.toml", self.PLAN + 'command = ["dive", "{markers}", "{folder}/heard"]\n')
            self.study("begin", "--plan", os.path.join(self.scratch, "plan.toml"))
            self.study("enrol", answers="yes\n")
            self.write("answers", "\n" + "50\n" * 6 + "\n\n")
            subprocess.run([sys.executable, "-B", os.path.join(TOOLS, "study.py"), "--program", program, "run", self.folder, "P01",
                            "--answers", os.path.join(self.scratch, "answers")], capture_output=True, timeout=60)
            self.assertEqual(self.read("participants/P01/heard"), '["block begins", "seen"]')
            self.assertFalse(os.path.exists(os.path.join(self.folder, "participants/P01/markers.port")))

    def begin_block(self):
        """(`study run`, its block's program) once that writes into P01's folder; it goes on until it is ended."""
        program, ready = os.path.join(self.scratch, "program"), os.path.join(self.scratch, "ready")
        self.folder = os.path.join(self.scratch, "study")
        self.write("program", f"""#!{sys.executable}
import os, signal, sys, time
ended = []
signal.signal(signal.SIGTERM, lambda *_: ended.append(1))
open(os.path.join(sys.argv[2], "begun"), "w").close()
with open({ready!r} + ".tmp", "w") as file:
    file.write(str(os.getpid()))
os.rename({ready!r} + ".tmp", {ready!r})
while not ended:
    time.sleep(0.02)
open(os.path.join(sys.argv[2], "whole"), "w").close()
""")
        os.chmod(program, 0o755)
        self.write("plan.toml", self.PLAN + 'command = ["dive", "{folder}"]\n')
        self.study("begin", "--plan", os.path.join(self.scratch, "plan.toml"))
        self.study("enrol", answers="yes\n")
        self.write("answers", "\n" + "50\n" * 6 + "\n\n")
        run = subprocess.Popen([sys.executable, "-B", os.path.join(TOOLS, "study.py"), "--program", program, "run", self.folder, "P01",
                                "--answers", os.path.join(self.scratch, "answers")], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        until = time.monotonic() + 30
        while not os.path.exists(ready) and time.monotonic() < until:
            time.sleep(0.02)
        with open(ready) as file:
            return run, int(file.read())

    def test_no_block_outlives_a_withdrawal(self):
        place = "participants/P01"
        with tempfile.TemporaryDirectory() as self.scratch:
            run, _ = self.begin_block()
            status, text = self.study("withdraw", "P01", "--yes")
            self.assertEqual((status, text.count("\n")), (2, 1), text)
            self.assertIn("nothing is erased", text)
            self.assertTrue(os.path.exists(os.path.join(self.folder, place, "begun")))
            status, text = self.study("run", "P01", answers="\n")
            self.assertEqual((status, text.count("\n")), (2, 1), text)
            self.assertIn("found another `neritic study run` of P01", text)
            self.assertEqual(self.study("mark", "P01", "still here")[0], 0)  # it was refused, and the participant takes part
            run.send_signal(signal.SIGTERM)  # ends the block first, which closes what it wrote
            self.assertEqual(run.wait(30), 143)
            self.assertIn("neritic: study: interrupted", run.stderr.read())
            run.stderr.close()
            self.assertTrue(os.path.exists(os.path.join(self.folder, place, "whole")))
            self.assertEqual(self.study("withdraw", "P01", "--yes")[0], 0)
            self.assertEqual(os.listdir(os.path.join(self.folder, "participants")), [])

    def test_a_blocks_program_that_lost_its_study_is_waited_for_too(self):
        with tempfile.TemporaryDirectory() as self.scratch:
            run, program = self.begin_block()
            run.kill()
            run.communicate()
            self.assertEqual(self.study("withdraw", "P01", "--yes")[0], 2)
            os.kill(program, signal.SIGKILL)
            until = time.monotonic() + 10
            while self.study("withdraw", "P01", "--yes")[0] == 2 and time.monotonic() < until:
                time.sleep(0.05)
            self.assertEqual(os.listdir(os.path.join(self.folder, "participants")), [])

    def test_a_block_whose_criteria_do_not_hold_is_done(self):
        with tempfile.TemporaryDirectory() as self.scratch:
            program, tells = os.path.join(self.scratch, "program"), os.path.join(self.scratch, "tells")
            self.write("program", f"""#!{sys.executable}
import json, os, sys
status, names, broken = json.load(open({tells!r}))
for name in names:
    folder = os.path.join(sys.argv[sys.argv.index("--out") + 1], name)
    os.makedirs(folder, exist_ok=True)
    with open(os.path.join(folder, "results.json.tmp"), "w") as file:
        json.dump({{"broken": broken}}, file)
    os.replace(file.name, os.path.join(folder, "results.json"))
sys.exit(status)
""")
            os.chmod(program, 0o755)

            def run(name, experiment, *attempts):
                """The exit statuses of attempts at the first block, which are (what its program does, what is typed), and the last one's output."""
                self.folder, statuses = os.path.join(self.scratch, name), []
                self.write("plan.toml", self.PLAN.replace('after_block = ["nasa_tlx"]\nafter = ["ssq"]', '').replace(
                    'name = "a"\n', f'name = "a"\ncommand = ["experiment", "{experiment}", "--out", "{{folder}}/a", "--resume"]\n'))
                self.assertEqual(self.study("begin", "--plan", os.path.join(self.scratch, "plan.toml"))[0], 0)
                self.study("enrol", answers="yes\n")
                for does, typed in attempts:
                    self.write("tells", json.dumps(does))
                    self.write("answers", typed + "\n\n")
                    done = subprocess.run([sys.executable, "-B", os.path.join(TOOLS, "study.py"), "--program", program, "run", self.folder, "P01",
                                           "--answers", os.path.join(self.scratch, "answers")], capture_output=True, text=True, timeout=60)
                    statuses.append(done.returncode)
                return statuses, done.stdout + done.stderr

            every = scenario.names()
            self.assertEqual(run("fails", "own.toml", ([1, ["."], 0], ""))[0], [0])
            self.assertEqual(run("breaks", "own.toml", ([1, ["."], 1], ""), ([1, ["."], 1], ""), ([1, ["."], 0], ""))[0], [1, 1, 0])
            self.assertEqual(run("all", "all", ([1, every[1:], 0], ""), ([1, every, 0], ""))[0], [1, 0])
            # Results of the attempt before are none of one that could not be done.
            statuses, told = run("old", "own.toml", ([2, ["."], 0], ""), ([1, [], 0], ""), ([1, [], 0], "no\nleave"))
            self.assertEqual(statuses, [1, 1, 0], told)
            self.assertIn('found "no"; accepted: Enter, leave', told)
            marks = [json.loads(line) for line in self.read("participants/P01/markers.jsonl").splitlines()]
            self.assertEqual([m.get("status", m["marker"]) for m in marks if m.get("block") == "a"], ["block begins", 2, "block begins", 1, "block left"])

    def test_blocks_write_into_the_participants_folder_alone(self):
        with tempfile.TemporaryDirectory() as self.scratch:
            self.folder = os.path.join(self.scratch, "study")
            begin = ("begin", "--plan", os.path.join(self.scratch, "plan.toml"))
            for command in ('["dive", "--record", "out.mcap"]', '["dive", "--log=log.csv"]', '["dive", "--save"]',
                            '["dive", "--record", "{folder}_x.mcap"]', '["dive", "--record", "{folder}/../x.mcap"]',
                            '["dive", "--record={record}/../../x.mcap"]', '["dive", "--record", "{folder}/{folder}/x.mcap"]',
                            '["dive", "--record", ""]', '["dive", "--record", "x/{folder}/x.mcap"]',
                            '["render", "a.toml", "--out", "{folder}/r", "--dump-graph", "/tmp/graph.txt"]', '["simulate", "lab", "--log", "l.csv"]'):
                self.write("plan.toml", self.PLAN + f"command = {command}\n")
                status, text = self.study(*begin)
                self.assertEqual((status, text.count("\n")), (2, 1), text)
                self.assertIn("the participant's own", text)
            for command in ('["dive", "--keep", "{folder}/a"]', '["dive", "-o", "/tmp/a"]', '["dive", "--dump-graph", "{folder}/a"]'):
                self.write("plan.toml", self.PLAN + f"command = {command}\n")
                status, text = self.study(*begin)
                self.assertEqual((status, text.count("\n")), (2, 1), text)
            self.write("plan.toml", self.PLAN.rsplit("[[blocks]]", 1)[0])
            one, self.folder = self.folder, os.path.join(self.scratch, "one")
            self.assertEqual(self.study(*begin), (0, f"{self.folder}: one block\n"))
            self.folder = one
            self.write("plan.toml", self.PLAN.replace('name = "b"', 'name = "after"'))
            self.assertEqual(self.study(*begin)[0], 2)
            for i, command in enumerate(('["-q", "dive", "s.toml", "--record", "{record}.mcap", "--log={folder}/log.csv", "--task", "Look!"]',
                                         '["experiment", "shark", "--out", "{folder}", "--resume", "--set", "delay_s=0.5"]',
                                         '["plan", "--log", "depths.csv", "--out={folder}/plan"]',
                                         '["render", "a.toml", "--out", "{folder}/r", "--offset", "-1", "-.5", "0"]')):
                self.write("plan.toml", self.PLAN + f"command = {command}\n")
                self.folder = os.path.join(self.scratch, f"study {i}")
                self.assertEqual(self.study(*begin), (0, f"{self.folder}: 2 blocks in 2 orders; balanced after every 2 participants\n"))

    def test_a_block_runs_a_command_of_the_program_alone(self):
        with tempfile.TemporaryDirectory() as self.scratch:
            self.folder = os.path.join(self.scratch, "study")
            for command in ('["rm", "-rf", "/"]', '["-q", "rm"]', '["-q"]', '["{folder}/mine"]'):
                self.write("plan.toml", self.PLAN + f"command = {command}\n")
                status, text = self.study("begin", "--plan", os.path.join(self.scratch, "plan.toml"))
                self.assertEqual((status, text.count("\n")), (2, 1), text)
                self.assertIn("accepted, as the first word: render, ", text)
            told = "".join(f.read_text() for f in pathlib.Path(TOOLS, "..", "neritic", "command_line").glob("*.cpp"))
            import block_commands
            self.assertEqual(sorted([*block_commands.COMMANDS, "keys", "study"]), sorted(re.findall(r'app\.add_subcommand\(\s*"(\w+)"', told)))
            known = {f for flags in block_commands.COMMANDS.values() for part in flags for f in part.split()} | block_commands.OF_ALL
            found = {f for names in re.findall(r'"((?:-\w,)?--[\w,-]+)"', told) for f in re.findall(r"--([\w-]+)", names)}
            self.assertGreater(len(found), 100)
            self.assertEqual(found - known, {"client"})  # of keys
            for plan in pathlib.Path(TOOLS, "..", "..", "assets", "experiments", "studies").glob("*.toml"):
                if "[study]" in plan.read_text():
                    self.folder = os.path.join(self.scratch, plan.stem)
                    self.assertEqual(self.study("begin", "--plan", str(plan))[0], 0, plan)

    def test_a_withdrawal_that_is_not_confirmed_erases_nothing_and_says_so(self):
        with tempfile.TemporaryDirectory() as self.scratch:
            self.folder = os.path.join(self.scratch, "study")
            self.write("plan.toml", self.PLAN)
            self.study("begin", "--plan", os.path.join(self.scratch, "plan.toml"))
            self.study("enrol", answers="yes\n")
            status, text = self.study("withdraw", "P01", answers="no\n")
            self.assertEqual(status, 1, text)
            self.assertIn("P01 was not typed; nothing is erased", text)
            self.assertTrue(os.path.exists(os.path.join(self.folder, "participants", "P01")))

    def test_an_enrolment_that_was_cut_short_gives_its_pseudonym_to_nobody(self):
        with tempfile.TemporaryDirectory() as self.scratch:
            self.folder = os.path.join(self.scratch, "study")
            self.write("plan.toml", self.PLAN)
            self.assertEqual(self.study("begin", "--plan", os.path.join(self.scratch, "plan.toml"))[0], 0)
            os.makedirs(os.path.join(self.folder, "participants", "P01"))
            self.assertIn("P02. Blocks", self.study("enrol", answers="yes\n")[1])

    def test_bad_words_are_refused_in_one_line(self):
        with tempfile.TemporaryDirectory() as self.scratch:
            self.folder = os.path.join(self.scratch, "study")
            for words, told in ((("beginn",), "beginn"), (("run",), "no participant"), (("run", "P01"), "no study"), (("begin",), "found no --plan"),
                                (("begin", "--plan", "none.toml"), "none.toml"), (("run", "P01", "--robot", "rov"), "found --robot; accepted: of wizard alone"), (("ask", "P01", "mood"), "no study")):
                status, text = self.study(*words)
                self.assertEqual((status, text.count("\n")), (2, 1), text)
                self.assertIn(told, text)
            for wrong in ("before = 3", 'after = "ssq"', "after_block = [1]", "after = [[]]", "title = 3"):
                key = wrong.split()[0]
                self.write("plan.toml", "\n".join([wrong, *(line for line in self.PLAN.splitlines() if not line.startswith(key + " "))]).replace(
                    wrong + "\n[study]", "[study]\n" + wrong))
                status, text = self.study("begin", "--plan", os.path.join(self.scratch, "plan.toml"))
                self.assertEqual((status, text.count("\n")), (2, 1), text)
                self.assertIn(f"study.{key}: found", text)
            for wrong, found in (("2026-01-01", '"2026-01-01"'), ("7", "7"), ('["a"]', "a list")):
                self.write("plan.toml", self.PLAN + f"about = {wrong}\n")
                status, text = self.study("begin", "--plan", os.path.join(self.scratch, "plan.toml"))
                self.assertEqual((status, text.count("\n")), (2, 1), text)
                self.assertIn(f"blocks[1].about: found {found}; accepted: text", text)


if __name__ == "__main__":
    unittest.main()
