"""A task in a scene: participants, stages with triggers, measures, a controller in Python. The scenario file says it all:
README.md lists its keys.

The controller is a Python file with a class Controller: __init__(self, world, settings, seed) and
act(self, observations, stage), called control_hz times a second. What act returns, a dict of numbers, formulas may name.
A player, a class Player of the same form, plays people and props by rules, so that controllers can be compared: its act has
a third argument, what the controller told last, and is called first; the controller has what it tells as self.told, and the
player itself as self.player.
"""
import importlib.util
import math
import os
import sys

import numpy as np

from formulas import Formula
from scenario import Failed, Refused, Setting, check_keys, _number, _word_of

STATISTICS = ("last", "first", "mean", "rms", "min", "max", "ever", "share", "duration")
MOST_SECONDS = 86400.0


class Moment:
    """What formulas see: the truth of one instant, and numbers by name."""

    def __init__(self, world, fixed, numbers):
        self._world, self._fixed, self._numbers, self._truths = world, fixed, numbers, {}

    def truth(self, name):
        if name not in self._truths:
            self._truths[name] = self._world.truth(name)
        return self._truths[name]

    def place(self, name):
        return self._fixed[name] if name in self._fixed else self.truth(name).position

    def number(self, name):
        value = self._numbers.get(name, math.nan)
        return float(value)


class Task:
    """A kind of experiment, made of a scenario's tables. Plain data: it goes to the worker processes."""

    def __init__(self, path, data):
        self.path = path
        task = data.get("task", {})
        check_keys(f"{path}: task", task, ["scene", "controller", "control_hz", "seconds", "participants", "places",
                                            "settings", "tells", "stop", "player"])
        for key in ("scene", "controller"):
            if not isinstance(task.get(key), str):
                raise Refused(f"{path}: task.{key}: found {task.get(key)!r}; accepted: a file's name")
        folder = os.path.dirname(os.path.abspath(path))
        self.scene, self.controller = (os.path.join(folder, task[k]) for k in ("scene", "controller"))
        if not isinstance(task.get("player", ""), str):
            raise Refused(f"{path}: task.player: found {task['player']!r}; accepted: a file's name")
        self.player = os.path.join(folder, task["player"]) if "player" in task else None
        for key, file in (("scene", self.scene), ("controller", self.controller), ("player", self.player or self.scene)):
            if not os.path.isfile(file):
                raise Refused(f"{path}: task.{key}: found no file {file}; accepted: a file beside the scenario")
        self.control_hz = _number(f"{path}: task.control_hz", task.get("control_hz", 20), 0.1, 1000)
        self.seconds = _number(f"{path}: task.seconds", task.get("seconds", 60), 0.1, MOST_SECONDS)
        self.participants = self._names("participants", task)
        self.places = {}
        for name, at in _table(f"{path}: task.places", task.get("places", {})).items():
            if not isinstance(at, list) or len(at) != 3:
                raise Refused(f"{path}: task.places.{name}: found {at!r}; accepted: [east, north, up] in metres")
            self.places[name] = [float(_number(f"{path}: task.places.{name}", v, -4e7, 4e7)) for v in at]
        self.SETTINGS = {"controller": Setting("baseline", "the scenario's own, null (the robot that holds still), or a .py file of yours")}
        for name, table in _table(f"{path}: task.settings", task.get("settings", {})).items():
            where = f"{path}: task.settings.{name}"
            check_keys(where, table, ["default", "meaning", "limits", "words"])
            default = table.get("default")
            limits, words = table.get("limits", [-1e9, 1e9]), table.get("words")
            if not isinstance(limits, list) or len(limits) != 2:
                raise Refused(f"{where}.limits: found {limits!r}; accepted: [lowest, highest]")
            low = _number(f"{where}.limits", limits[0], -1e12, 1e12)
            high = _number(f"{where}.limits", limits[1], low, 1e12)
            if words is not None and not (isinstance(words, list) and all(isinstance(w, str) for w in words)):
                raise Refused(f"{where}.words: found {words!r}; accepted: a list of words")
            if name == "controller":
                raise Refused(f"{where}: found a setting that every task has; accepted: another name")
            if not isinstance(default, (int, float, str)):
                raise Refused(f"{where}.default: found {default!r}; accepted: a number, true, false or a word")
            self.SETTINGS[name] = Setting(default, str(table.get("meaning", "")), low, high, words)
            self.SETTINGS[name].check(f"{where}.default", default)
        self.tells = self._names("tells", task)
        self.stages, names = [], self.participants + list(self.places)
        numbers = ["time", "stage_time"] + self.tells + [k for k, s in self.SETTINGS.items() if not isinstance(s.default, str)]
        def formula(where, text):
            return Formula(where, text, names, numbers)

        for i, stage in enumerate(_tables(f"{path}: stages", data.get("stages", []))):
            where = f"{path}: stages[{i}]"
            check_keys(where, stage, ["name", "until", "held_s", "at_most_s"])
            if not isinstance(stage.get("name"), str):
                raise Refused(f"{where}.name: found {stage.get('name')!r}; accepted: a word")
            self.stages.append({"name": stage["name"], "until": formula(f"{where}.until", stage.get("until")),
                                "held_s": _number(f"{where}.held_s", stage.get("held_s", 0), 0, MOST_SECONDS),
                                "at_most_s": _number(f"{where}.at_most_s", stage.get("at_most_s", self.seconds), 0, MOST_SECONDS)})
        if not self.stages:
            raise Refused(f"{path}: stages: found none; accepted: one or more")
        self.stop = formula(f"{path}: task.stop", task["stop"]) if "stop" in task else None
        self.measures, self.MEASURES = [], {
            "success": ("yes or no", "whether every stage ended in its time"),
            "time_s": ("s", "until the last stage ended, of the runs that succeed")}
        self.MEASURES |= {f"{s['name']}_s": ("s", f"how long the stage {s['name']} took") for s in self.stages}
        for i, measure in enumerate(_tables(f"{path}: measures", data.get("measures", []))):
            where = f"{path}: measures[{i}]"
            check_keys(where, measure, ["name", "of", "statistic", "stage", "unit", "meaning"])
            statistic, stage = measure.get("statistic", "mean"), measure.get("stage")
            if not isinstance(measure.get("name"), str) or measure["name"] in self.MEASURES:
                raise Refused(f"{where}.name: found {measure.get('name')!r}; accepted: a new word")
            _word_of(f"{where}.statistic", statistic, STATISTICS)
            if stage is not None and stage not in [s["name"] for s in self.stages]:
                raise Refused(f"{where}.stage: found {stage!r}; accepted: {', '.join(s['name'] for s in self.stages)}")
            self.measures.append({"name": measure["name"], "of": formula(f"{where}.of", measure.get("of")),
                                  "statistic": statistic, "stage": stage})
            unit = "yes or no" if statistic == "ever" else "s" if statistic == "duration" else str(measure.get("unit", ""))
            self.MEASURES[measure["name"]] = (unit, str(measure.get("meaning", measure.get("of"))))

    def _names(self, key, task):
        names = task.get(key, [])
        if not isinstance(names, list) or not all(isinstance(n, str) for n in names):
            raise Refused(f"{self.path}: task.{key}: found {names!r}; accepted: a list of words")
        return names

    def files(self, settings):
        """The files that decide a run's numbers, beside the settings: scene, player and controller."""
        own = {"baseline": self.controller, "null": None}.get(settings["controller"], settings["controller"])
        return [f for f in (self.scene, self.player, own) if f]

    def check(self, settings):
        """Refuses a controller that is not there, before anything runs."""
        if settings["controller"] not in ("baseline", "null") and not os.path.isfile(settings["controller"]):
            raise Refused(f"controller: found no file {settings['controller']}; accepted: baseline, null, or a controller's .py")

    def run(self, settings, seed, tools):
        neritic = tools.python()
        world = neritic.open(self.scene, seed=seed)
        missing = [n for n in self.participants if n not in world.agents]
        if missing:
            raise Failed(f"{self.scene}: found no participant {missing[0]}; accepted: {', '.join(world.agents)}")
        player = _controller(self.player, "Player")(world, settings, seed) if self.player else None
        path = {"baseline": self.controller, "null": None}.get(settings["controller"], settings["controller"])
        controller = _controller(path)(world, settings, seed) if path else Null(world, settings, seed)
        fixed = {k: np.array(v) for k, v in self.places.items()}
        every = max(1, round(1.0 / (self.control_hz * world.step_s)))
        rows = {m["name"]: [] for m in self.measures}
        series = {"t": [], "stage": [], **{m["name"]: [] for m in self.measures}}
        stage, begun, held_from, ends, failure = 0, 0.0, None, {}, None
        controller.player = player
        observations, told = world.observe(), {}
        while world.time < self.seconds - 1e-9 and stage < len(self.stages):
            played = player.act(observations, self.stages[stage]["name"], told) or {} if player else {}
            controller.told = played
            told = {**played, **(controller.act(observations, self.stages[stage]["name"]) or {})}
            unknown = [k for k in told if k not in self.tells]
            if unknown:
                raise Failed(f"{self.controller if not self.player else self.path}: act told \"{unknown[0]}\"; accepted: {', '.join(self.tells) or 'nothing'}")
            observations = world.tick(every)
            time = world.time
            moment = Moment(world, fixed, {**settings, **told, "time": time, "stage_time": time - begun})
            series["t"].append(round(time, 3))
            series["stage"].append(stage)
            for m in self.measures:
                value = float(m["of"].value(moment))
                series[m["name"]].append(round(value, 5) if math.isfinite(value) else None)
                if m["stage"] in (None, self.stages[stage]["name"]):
                    rows[m["name"]].append(value)
            if self.stop is not None and self.stop.value(moment):
                failure = f"stopped in stage {self.stages[stage]['name']}: {self.stop.text}"
                break
            now = self.stages[stage]
            if now["until"].value(moment):
                held_from = time if held_from is None else held_from
                if time - held_from >= now["held_s"] - 1e-9:
                    ends[f"{now['name']}_s"] = held_from - begun
                    stage, begun, held_from = stage + 1, time, None
                    continue
            else:
                held_from = None
            if time - begun > now["at_most_s"]:
                failure = f"stage {now['name']} not done in {now['at_most_s']:g} s"
                break
        if stage < len(self.stages) and failure is None:
            failure = f"stage {self.stages[stage]['name']} not done in {self.seconds:g} s"
        measures = {"success": failure is None, **ends, "failure": failure}
        if failure is None:
            measures["time_s"] = begun if not ends else sum(ends.values())
        for m in self.measures:
            value = _statistic(m["statistic"], np.array(rows[m["name"]]), every * world.step_s)
            if value is not None:
                measures[m["name"]] = value
        world.close()
        keep = slice(None, None, max(1, len(series["t"]) // 400))
        return measures, {k: v[keep] for k, v in series.items()}

    def figures(self, scenario, results, style):
        import summary
        groups = summary.by_condition(results)
        names = [", ".join(f"{k} {v}" for k, v in c.items()) or "all runs" for c, _ in groups]
        judged = list(dict.fromkeys(c["measure"] for c in scenario.criteria if "less" not in c))[:6]
        if judged:
            yield "outcome.png", "The measures of the criteria, a dot a run", self._dots(scenario, judged, groups, names, style)
        shown = [m["name"] for m in self.measures if m["statistic"] not in ("ever", "duration", "share")][:4]
        if not shown or not any(r["series"] for r in results):
            return
        fig = style.figure(900, 60 + 200 * len(shown))
        for i, name in enumerate(shown):
            ax = style.area(fig, 80, 50 + 200 * i, 870, 190 + 200 * i)
            for g, (_, group) in enumerate(groups[:6]):
                for k, r in enumerate([r for r in group if r["series"]][:30]):
                    ax.plot(r["series"]["t"], style.numbers(r["series"][name]), color=style.color(g), lw=0.8,
                            ls=("-", "--", ":", "-.")[g % 4], alpha=0.9 if len(results) < 4 else 0.5, label=names[g] if k == 0 else None)
            ax.set_ylabel(self.MEASURES[name][0])
            style.title(ax, f"{name}: {self.MEASURES[name][1]}" if self.MEASURES[name][1] != name else name)
            if i == 0:
                style.legend(ax)
        ax.set_xlabel("time, s")
        yield "task.png", "The measures of each run over time", fig

    def _dots(self, scenario, judged, groups, names, style):
        import summary
        fig = style.figure(900, 50 + 190 * ((len(judged) + 1) // 2))
        for i, name in enumerate(judged):
            left, top = 80 + 440 * (i % 2), 40 + 190 * (i // 2)
            ax = style.area(fig, left, top, left + 350, top + 115)
            for g, (_, group) in enumerate(groups):
                values = summary.values_of(group, name)
                # Equal values side by side, so that each run is seen.
                for value in sorted(set(values)):
                    n = values.count(value)
                    ax.plot(g + (np.arange(n) - (n - 1) / 2) * min(0.04, 0.7 / n), [value] * n, "o", ms=4, color=style.color(g),
                            mec=style.INK, mew=0.4)
                if values:
                    ax.plot([g - 0.3, g + 0.3], [float(np.median(values))] * 2, color=style.INK, lw=1.6)
            for c in scenario.criteria:
                if c["measure"] == name and "less" not in c:
                    for key in ("at_least", "at_most"):
                        if key in c:
                            ax.axhline(c[key], color=style.RED, lw=0.9, ls="--")
            ax.set_xlim(-0.5, len(groups) - 0.5)
            ax.set_xticks(range(len(groups)), names, rotation=0 if len(groups) < 4 else 25)
            ax.set_ylabel(self.MEASURES[name][0])
            style.title(ax, name)
        return fig


class Null:
    """The null robot: it holds where it starts, by the scene's own mission, and tells nothing."""

    def __init__(self, world, settings, seed):
        pass

    def act(self, observations, stage):
        return {}


def _table(where, value):
    if not isinstance(value, dict):
        raise Refused(f"{where}: found {value!r}; accepted: a table")
    return value


def _tables(where, value):
    if not isinstance(value, list):
        raise Refused(f"{where}: found {value!r}; accepted: tables, each [[{where.split()[-1]}]]")
    return value


def _controller(path, name="Controller"):
    if not os.path.isfile(path):
        raise Failed(f"{path}: found no such file; accepted: baseline, null, or a controller's .py")
    folder = os.path.dirname(os.path.abspath(path))
    if folder not in sys.path:
        sys.path.insert(0, folder)  # for what lies beside it
    spec = importlib.util.spec_from_file_location("neritic_controller", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    if not hasattr(module, name):
        raise Failed(f"{path}: found no class {name}; accepted: one with act(observations, stage)")
    return getattr(module, name)


def _statistic(name, values, step_s):
    values = values[np.isfinite(values)]
    if len(values) == 0:
        return None
    return {"last": lambda: float(values[-1]), "first": lambda: float(values[0]), "mean": lambda: float(values.mean()),
            "rms": lambda: float(np.sqrt((values ** 2).mean())), "min": lambda: float(values.min()),
            "max": lambda: float(values.max()), "ever": lambda: bool((values > 0.5).any()),
            "share": lambda: float((values > 0.5).mean()), "duration": lambda: float((values > 0.5).sum() * step_s)}[name]()
