"""A task in a scene: participants, stages with triggers, measures, a controller in Python. The scenario file says it all:
README.md lists its keys.

The controller is a Python file with a class Controller: __init__(self, world, settings, seed) and
act(self, observations, stage), called control_hz times a second: each time at the first step of the physics that is not before it is
due, so that calls may be a step more or less apart where control_hz does not divide the physics' rate; world.time is exact. It returns
a dict of the numbers that it says to the player, or None. A player, a class Player of the same form, plays people and props by rules and judges, so that controllers can be compared:
its act has a third argument, what the controller said last, and is called first; formulas may name the numbers that it returns.
The controller has these as self.told, and the player itself as self.player.
"""
import contextlib
import math
import numbers
import os

import numpy as np

import files_read
import task_figures
from formulas import says_yes
from instants import Instants
from own_modules import OwnModules
from scenario import Failed, Refused, short
from task_file import TaskFile, check_class, check_helpers, check_participants


class Moment:
    """The inputs of formulas: the truth of one instant, and numbers by name."""

    def __init__(self, world, fixed, numbers, seen=None):
        """seen: the observations of this instant, which have the state of a diver's body."""
        self._world, self._fixed, self._numbers, self._seen, self._truths = world, fixed, dict(numbers), seen or {}, {}

    def truth(self, name):
        if name not in self._truths:
            self._truths[name] = self._world.truth(name)
        return self._truths[name]

    def place(self, name):
        return self._fixed[name] if name in self._fixed else self.truth(name).position

    def body(self, name, field):
        """A number of a diver's body; NaN where the scene has none."""
        motion = self._seen.get(f"{name}/motion")
        return float(getattr(motion, field, math.nan))

    def number(self, name):
        value = self._numbers.get(name, math.nan)
        return float(value)

    def define(self, name, formula):
        self._numbers[name] = formula.value(self)


class _Course:
    """Where a run is in its stages, and what its measures saw."""

    def __init__(self, task):
        self.task, self.stage, self.begun, self.held_from, self.ends, self.failure = task, 0, 0.0, None, {}, None
        self.until_known = self.stop_known = False  # whether the stage's trigger is a number now, and whether the stopping rule ever was
        self.rows = {m["name"]: [] for m in task.measures}
        self.series = {"t": [], "stage": [], **{m["name"]: [] for m in task.measures}}

    def name(self):
        return self.task.stages[self.stage]["name"]

    def is_over(self):
        return self.failure is not None or self.stage == len(self.task.stages)

    def see(self, moment, time):
        self.series["t"].append(round(time, 3))
        self.series["stage"].append(self.stage)
        for m in self.task.measures:
            value = float(m["of"].value(moment))
            self.series[m["name"]].append(round(value, 5) if math.isfinite(value) else None)
            if m["stage"] in (None, self.name()):
                self.rows[m["name"]].append(value)
        if self.task.stop is not None:
            stops = self.task.stop.value(moment)
            self.stop_known |= stops == stops
            if says_yes(stops):
                self.failure = f"stopped in stage {self.name()}: {short(self.task.stop.text)}"
                return
        now = self.task.stages[self.stage]
        done = now["until"].value(moment)
        self.until_known = done == done
        if says_yes(done):
            self.held_from = time if self.held_from is None else self.held_from
            if time - self.held_from >= now["held_s"] - 1e-9:
                self.ends[f"{now['name']}_s"] = time - self.begun
                self.stage, self.begun, self.held_from = self.stage + 1, time, None
                return
        else:
            self.held_from = None
        if time - self.begun > now["at_most_s"]:
            self._fail_late(now["at_most_s"])

    def _fail_late(self, limit_s):
        text = short(self.task.stages[self.stage]["until"].text)
        self.failure = f"stage {self.name()} not done in {limit_s:g} s" + ("" if self.until_known else f": {text} was no number at the end")

    def measures(self, step_s):
        if self.stage < len(self.task.stages) and self.failure is None:
            self._fail_late(self.task.seconds)
        if self.failure is None and self.task.stop is not None and not self.stop_known:
            self.failure = f"the stopping rule was no number at any moment: {short(self.task.stop.text)}"
        absent = {}
        out = {"success": self.failure is None, **self.ends, "failure": self.failure, "absent": absent}
        if self.failure is None:
            out["time_s"] = self.begun  # the end of the last stage
        for m in self.task.measures:
            rows = self.rows[m["name"]]
            value = _statistic(m["statistic"], np.array(rows), step_s)
            if value is not None:
                out[m["name"]] = value
            elif rows:
                absent[m["name"]] = f"{short(m['of'].text)} was no number at any moment, as where it divides by zero"
            else:
                absent[m["name"]] = f"stage {m['stage']} was not reached" if m["stage"] else "no moment was judged"
        return out


class Task(TaskFile):
    """A kind of experiment, made of a scenario's tables. Plain data: it goes to the worker processes."""

    def files(self, settings):
        """The files that decide a run's numbers, beside the settings: scene, player and controller, with those that they use."""
        own = {"baseline": self.controller, "null": None}.get(settings["controller"], settings["controller"])
        return files_read.of_scene(self.scene) + [f for module in (self.player, own) if module for f in files_read.of_module(module)]

    def check(self, settings):
        """Refuses a participant that the scene lacks, and a controller that is not there or is none, before anything runs."""
        check_participants(self.scene, self.participants, self.formulas)
        path = self._controller_of(settings)
        if path is not None and not os.path.isfile(path):
            raise Refused(f"controller: found no file {path}; accepted: baseline, null, or a controller's .py")
        for file, name in ((self.player, "Player"), (path, "Controller")):
            if file:
                check_class(file, name)
                check_helpers(file)

    def _controller_of(self, settings):
        """Its file; None is the null robot."""
        return {"baseline": self.controller, "null": None}.get(settings["controller"], settings["controller"])

    def run(self, settings, seed, tools):
        world = tools.python().open(self.scene, seed=seed)
        missing = [n for n in self.participants if n not in world.agents]
        if missing:
            raise Failed(f"{self.scene}: found no participant {missing[0]}; accepted: {', '.join(world.agents)}")
        path, modules = self._controller_of(settings), {}
        player = _Actor(self.player, "Player", modules, world, settings, seed) if self.player else None
        controller = _Actor(path, "Controller", modules, world, settings, seed)
        controller.one.player = player and player.one
        fixed = {k: np.array(v) for k, v in self.places.items()}
        calls, begun = Instants(f"{self.path}: task.control_hz", self.control_hz, world.step_s), world.step
        course, observations, told, said = _Course(self), world.observe(), {}, {}
        with _all_here(modules if len(modules) == 1 else {}):  # then act() changes none of them
            while world.time < self.seconds - 1e-9 and not course.is_over():
                told = _told(self.player, player.act(observations, course.name(), said), self.tells) if player else {}
                controller.one.told = dict(told)
                said = _told(path, controller.act(observations, course.name()), self.says)
                calls.take(world.step - begun)
                with _all_here(modules):  # events call what a file gave them
                    observations = world.tick(calls.step - (world.step - begun))
                moment = Moment(world, fixed, {**settings, **told, "time": world.time, "stage_time": world.time - course.begun}, observations)
                for name, formula in self.numbers:
                    moment.define(name, formula)
                course.see(moment, world.time)
        measures = course.measures(1.0 / self.control_hz)
        world.close()
        stages = course.series["stage"]
        every = max(1, len(stages) // 400)
        # The first moment of each stage too, so that none is lost.
        keep = [i for i in range(len(stages)) if i % every == 0 or stages[i] != stages[i - 1]]
        return measures, {k: [v[i] for i in keep] for k, v in course.series.items()}

    def figures(self, scenario, results, style):
        return task_figures.figures(self, scenario, results, style)


def _all_here(modules):
    """The imports of these files together."""
    stack = contextlib.ExitStack()
    for one in modules.values():
        stack.enter_context(one.here())
    return stack


class Null:
    """The null robot: it holds where it starts, by the scene's own mission, and tells nothing."""

    def __init__(self, world, settings, seed):
        pass

    def act(self, observations, stage):
        return {}


def _told(path, told, accepted):
    """What act of this file returned, checked: a dict of numbers of these names; None is an empty one."""
    if told is None:
        return {}
    if not isinstance(told, dict):
        raise Failed(f"{path}: act returned {type(told).__name__}; accepted: a dict of numbers, or None")
    for name, value in told.items():
        if name not in accepted:
            raise Failed(f"{path}: act told \"{name}\"; accepted: {', '.join(accepted) or 'nothing: the scenario judges by its own formulas'}")
        if not isinstance(value, (numbers.Real, np.bool_)):
            raise Failed(f"{path}: act told {name} {value!r}; accepted: a number")
    return dict(told)


class _Actor:
    """A run's controller or player, whose imports are its own; without a file the null robot."""

    def __init__(self, path, name, modules, world, settings, seed):
        """modules: the run's OwnModules by folder. Files of one folder have theirs in common."""
        self._modules, made = None, Null
        if path:
            if not os.path.isfile(path):
                raise Failed(f"{path}: found no such file; accepted: baseline, null, or a controller's .py")
            folder = os.path.dirname(os.path.realpath(path))
            self._modules = modules.setdefault(folder, OwnModules(folder))
            made = getattr(self._modules.load(path, f"neritic_{name.lower()}"), name, None)
            if made is None:
                raise Failed(f"{path}: found no class {name}; accepted: one with act(observations, stage)")
        with self.here():
            self.one = made(world, settings, seed)

    def here(self):
        return self._modules.here() if self._modules else contextlib.nullcontext()

    def act(self, *seen):
        with self.here():
            return self.one.act(*seen)


def _statistic(name, values, step_s):
    values = values[np.isfinite(values)]
    if len(values) == 0:
        return None
    return {"last": lambda: float(values[-1]), "first": lambda: float(values[0]), "mean": lambda: float(values.mean()),
            "rms": lambda: float(np.sqrt((values ** 2).mean())), "min": lambda: float(values.min()),
            "max": lambda: float(values.max()), "ever": lambda: bool((values != 0).any()),
            "share": lambda: float((values != 0).mean()), "duration": lambda: float((values != 0).sum() * step_s)}[name]()
