"""A task's tables in a scenario file, checked: README.md lists the keys. Plain data; it goes to the worker processes."""
import ast
import keyword
import os
import re

import files_read
from formulas import Formula, says_yes
from own_modules import COMMON
from scenario import Refused, Setting, check_keys, read, short, text_of, _number, _word_of

STATISTICS = ("last", "first", "mean", "rms", "min", "max", "ever", "share", "duration")
IN_WORDS = {"last": "the last", "first": "the first", "mean": "the mean of", "rms": "the root mean square of", "min": "the least", "max": "the largest",
            "ever": "whether it ever was so:", "share": "share of the time in which", "duration": "how long"}
MOST_SECONDS = 86400.0
# Numbers and results that every task has, under these names.
OWN_NUMBERS = {"time": "the time", "stage_time": "the time in the stage", "controller": "a setting of every task",
               "run_limit_s": "a setting of every experiment"}
OWN_RESULTS = {**OWN_NUMBERS, "t": "the time in a run's series", "stage": "the stage in a run's series", "success": "a measure of every task",
               "time_s": "a measure of every task", **dict.fromkeys(("failure", "absent", "seed", "wall_s", "processor_s"), "a column of the results")}


class _Names:
    """What each name of one kind stands for: none stands for two things."""

    def __init__(self, own=()):
        self.uses = dict(own)

    def add(self, where, name, use, shown=None):
        """shown: the word of the file of which the name is made."""
        if not name.isidentifier() or keyword.iskeyword(name):
            raise Refused(f"{where}: found \"{shown or name}\"; accepted: letters, digits and _, a letter first, no word of Python")
        if name in self.uses:
            raise Refused(f"{where}: found \"{shown or name}\", but {name} is {self.uses[name]} already; accepted: another name")
        self.uses[name] = use


class TaskFile:
    def __init__(self, path, data):
        self.path = path
        task = data.get("task", {})
        check_keys(f"{path}: task", task, ["scene", "controller", "control_hz", "seconds", "participants", "places",
                                            "settings", "numbers", "tells", "says", "stop", "player"])
        self._read_files(task)
        self.control_hz = _number(f"{path}: task.control_hz", task.get("control_hz", 20), 0.1, 1000)
        self.seconds = _number(f"{path}: task.seconds", task.get("seconds", 60), 0.1, MOST_SECONDS)
        self.formulas = []
        self._things, self._numbers, self._results = _Names(), _Names(OWN_NUMBERS), _Names(OWN_RESULTS)
        self.participants = self._words("participants", task)
        for name in self.participants:
            self._things.add(f"{path}: task.participants", name, "a participant")
        self._read_places(_table(f"{path}: task.places", task.get("places", {})))
        self._read_settings(_table(f"{path}: task.settings", task.get("settings", {})))
        self._read_told(task)
        self._read_numbers(_table(f"{path}: task.numbers", task.get("numbers", {})))
        self._read_stages(_tables(f"{path}: stages", data.get("stages", [])))
        self.stop = self._formula(f"{path}: task.stop", task["stop"]) if "stop" in task else None
        if self.stop is not None and self.stop.constant() not in (None, 0):  # also what is no number: such a run fails
            raise Refused(f"{path}: task.stop: found \"{short(self.stop.text)}\", which is always so or never known; accepted: a formula that can say no")
        self._read_measures(_tables(f"{path}: measures", data.get("measures", [])))

    def _read_files(self, task):
        path = self.path
        for key in ("scene", "controller"):
            if not isinstance(task.get(key), str):
                raise Refused(f"{path}: task.{key}: found {short(repr(task.get(key)))}; accepted: a file's name")
        folder = os.path.dirname(os.path.abspath(path))
        self.scene, self.controller = (os.path.join(folder, task[k]) for k in ("scene", "controller"))
        if not isinstance(task.get("player", ""), str):
            raise Refused(f"{path}: task.player: found {short(repr(task['player']))}; accepted: a file's name")
        self.player = os.path.join(folder, task["player"]) if "player" in task else None
        for key, file in (("scene", self.scene), ("controller", self.controller), ("player", self.player or self.scene)):
            if not os.path.isfile(file):
                raise Refused(f"{path}: task.{key}: found no file {file}; accepted: a file beside the scenario")

    def _read_places(self, tables):
        path = self.path
        self.places = {}
        for name, at in tables.items():
            self._things.add(f"{path}: task.places.{name}", name, "a place")
            if not isinstance(at, list) or len(at) != 3:
                raise Refused(f"{path}: task.places.{name}: found {short(repr(at))}; accepted: [east, north, up] in metres")
            self.places[name] = [float(_number(f"{path}: task.places.{name}", v, -4e7, 4e7)) for v in at]

    def _read_settings(self, tables):
        path = self.path
        self.SETTINGS = {"controller": Setting("baseline", "the scenario's own, null (the robot that holds still), or a .py file of yours")}
        for name, table in tables.items():
            where = f"{path}: task.settings.{name}"
            check_keys(where, table, ["default", "meaning", "limits", "words"])
            self._numbers.add(where, name, "a setting")
            self._results.add(where, name, "a setting")
            default = table.get("default")
            limits, words = table.get("limits", [-1e9, 1e9]), table.get("words")
            if not isinstance(limits, list) or len(limits) != 2:
                raise Refused(f"{where}.limits: found {short(repr(limits))}; accepted: [lowest, highest]")
            low = _number(f"{where}.limits", limits[0], -1e12, 1e12)
            high = _number(f"{where}.limits", limits[1], low, 1e12)
            if words is not None and not (isinstance(words, list) and all(isinstance(w, str) for w in words)):
                raise Refused(f"{where}.words: found {short(repr(words))}; accepted: a list of words")
            if not isinstance(default, (int, float, str)):
                raise Refused(f"{where}.default: found {short(repr(default))}; accepted: a number, true, false or a word")
            self.SETTINGS[name] = Setting(default, text_of(where, table, "meaning"), low, high, words)
            self.SETTINGS[name].check(f"{where}.default", default)

    def _read_told(self, task):
        """tells: the player's numbers, which formulas name. says: the controller's, which the player hears; formulas do not name
        them, so that no controller judges itself."""
        self.tells, self.says = self._words("tells", task), self._words("says", task)
        for key, who, names in (("tells", "player", self.tells), ("says", "controller", self.says)):
            for name in names:
                self._numbers.add(f"{self.path}: task.{key}", name, f"a number of the {who}")
            if names and self.player is None:
                raise Refused(f"{self.path}: task.{key}: found {short(repr(names))} without a player; accepted: task.player, a .py file that "
                              + ("tells them: a controller does not judge itself" if key == "tells" else "hears them"))

    def _read_numbers(self, tables):
        """Formulas by name, in their order: each may name those above it."""
        self.numbers = []
        for name, text in tables.items():
            where = f"{self.path}: task.numbers.{name}"
            formula = self._formula(where, text)
            self._numbers.add(where, name, "a number of the scenario")
            self.numbers.append((name, formula))

    def _formula(self, where, text):
        numbers = ["time", "stage_time", *self.tells, *(name for name, _ in getattr(self, "numbers", ())),
                   *(k for k, s in self.SETTINGS.items() if not isinstance(s.default, str))]
        self.formulas.append(Formula(where, text, self.participants, numbers, self.places))
        return self.formulas[-1]

    def _read_stages(self, tables):
        path, self.stages = self.path, []
        for i, stage in enumerate(tables):
            where = f"{path}: stages[{i}]"
            check_keys(where, stage, ["name", "until", "held_s", "at_most_s"])
            if not isinstance(stage.get("name"), str):
                raise Refused(f"{where}.name: found {short(repr(stage.get('name')))}; accepted: a word")
            self._results.add(f"{where}.name", f"{stage['name']}_s", "how long a stage took", stage["name"])
            self.stages.append({"name": stage["name"], "until": self._formula(f"{where}.until", stage.get("until")),
                                "held_s": _number(f"{where}.held_s", stage.get("held_s", 0), 0, MOST_SECONDS),
                                "at_most_s": _number(f"{where}.at_most_s", stage.get("at_most_s", self.seconds), 0, MOST_SECONDS)})
            self._check_possible(where, self.stages[-1])
        if not self.stages:
            raise Refused(f"{path}: stages: found none; accepted: one or more")
        held_s = sum(s["held_s"] for s in self.stages)
        if held_s >= self.seconds:
            raise Refused(f"{path}: task.seconds: found {self.seconds:g}, but the stages' held_s are {held_s:g} together; accepted: a longer run")

    def _check_possible(self, where, stage):
        """Refuses a stage that no run could end."""
        if stage["held_s"] > stage["at_most_s"]:
            raise Refused(f"{where}.held_s: found {stage['held_s']:g} of at most {stage['at_most_s']:g} s (at_most_s, or task.seconds); accepted: "
                          "no more than that")
        value = stage["until"].constant()
        if value is not None and not says_yes(value):
            raise Refused(f"{where}.until: found \"{short(stage['until'].text)}\", which is never so; accepted: a formula that can say yes")

    def _read_measures(self, tables):
        path = self.path
        self.measures, self.MEASURES = [], {
            "success": ("yes or no", "whether every stage ended in its time"),
            "time_s": ("s", "until the last stage ended, its held seconds included; of the runs that succeed")}
        self.MEASURES |= {f"{s['name']}_s": ("s", f"how long the stage {s['name'].replace('_', ' ')} took, its held seconds included") for s in self.stages}
        for i, measure in enumerate(tables):
            where = f"{path}: measures[{i}]"
            check_keys(where, measure, ["name", "of", "statistic", "stage", "unit", "meaning"])
            statistic, stage = measure.get("statistic", "mean"), measure.get("stage")
            if not isinstance(measure.get("name"), str):
                raise Refused(f"{where}.name: found {short(repr(measure.get('name')))}; accepted: a word")
            self._results.add(f"{where}.name", measure["name"], "a measure")
            _word_of(f"{where}.statistic", statistic, STATISTICS)
            if stage is not None and stage not in [s["name"] for s in self.stages]:
                raise Refused(f"{where}.stage: found {short(repr(stage))}; accepted: {', '.join(s['name'] for s in self.stages)}")
            self.measures.append({"name": measure["name"], "of": self._formula(f"{where}.of", measure.get("of")),
                                  "statistic": statistic, "stage": stage})
            own_unit = "share of the time" if statistic == "share" else ""
            unit = text_of(where, measure, "unit", own_unit)
            unit = "yes or no" if statistic == "ever" else "s" if statistic == "duration" else unit
            of = f"{IN_WORDS[statistic]} {measure.get('of')}" + (f", in the stage {stage}" if stage else "")
            self.MEASURES[measure["name"]] = (unit, text_of(where, measure, "meaning", of))

    def _words(self, key, task):
        names = task.get(key, [])
        if not isinstance(names, list) or not all(isinstance(n, str) for n in names):
            raise Refused(f"{self.path}: task.{key}: found {short(repr(names))}; accepted: a list of words")
        return names


def _table(where, value):
    if not isinstance(value, dict):
        raise Refused(f"{where}: found {short(repr(value))}; accepted: a table")
    return value


def _tables(where, value):
    if not isinstance(value, list):
        raise Refused(f"{where}: found {short(repr(value))}; accepted: tables, each [[{where.split()[-1]}]]")
    return value


def check_participants(scene, participants, formulas=()):
    """Refuses a participant that the scene does not name, and a formula about the body of a vehicle, before the program opens it. Names
    that the program itself gives, as object_0, pass."""
    names = _names_in(scene)
    for name in participants:
        if name not in names and not re.fullmatch(r"(object|vehicle)_\d+", name):
            raise Refused(f"{scene}: found no participant {name}; accepted: {', '.join(sorted(names)) or 'a scene that names it'}")
    for formula in formulas:
        for signal, name in formula.bodies:
            if names.get(name, "vehicles" if name.startswith("vehicle_") else "") == "vehicles":
                raise Refused(f"{formula.where}: found {signal}({name}) in \"{short(formula.text)}\", but {name} is a vehicle; accepted: a diver "
                              "with a human's body")


def _names_in(path, depth=8):
    """{name: "objects" or "vehicles"} of a scene, with those of the files that it includes; at most 8 files deep, as the program reads
    them."""
    data, names = read(path), {}
    folder = os.path.dirname(path)

    def included(table):
        files = table.get("include", [])
        return [os.path.join(folder, f) for f in (files if isinstance(files, list) else [files]) if isinstance(f, str)]
    if depth > 0:
        for file in included(data):
            names |= _names_in(file, depth - 1)
    for key in ("objects", "vehicles"):
        for table in data.get(key, []) if isinstance(data.get(key), list) else ():
            if isinstance(table, dict) and isinstance(table.get("name"), str):
                names[table["name"]] = key
    return names


def check_class(path, name):
    """Refuses a Python file that no Python is or that has no class of this name with act(); it is read, not run."""
    try:
        with open(path, "rb") as file:
            tree = ast.parse(file.read())
    except (SyntaxError, ValueError, RecursionError) as error:
        place = f", line {error.lineno}" if getattr(error, "lineno", None) else ""
        raise Refused(f"{path}: found no Python ({getattr(error, 'msg', error)}{place}); accepted: a class {name}") from None
    except OSError as error:
        raise Refused(f"{path}: found a file that cannot be read ({error.strerror}); accepted: a class {name}") from None
    bound = [n for n in ast.walk(tree) if _binds(n, name)]
    if not bound:
        raise Refused(f"{path}: found no class {name}; accepted: a class {name} with act()")
    plain = [n for n in bound if isinstance(n, ast.ClassDef) and not n.bases and not n.decorator_list]
    if len(plain) == len(bound) and not any(getattr(part, "name", "") == "act" for n in plain for part in n.body):
        raise Refused(f"{path}: found a class {name} without act; accepted: a class {name} with act()")


def check_helpers(path):
    """Refuses a module beside this file that it imports in vain: the name is another module's."""
    folder = os.path.dirname(os.path.realpath(path))
    for file in files_read.of_module(path)[1:]:
        place, name = os.path.split(file.removesuffix("/__init__.py"))
        if place == folder and file.endswith(".py") and name.removesuffix(".py") in COMMON:
            raise Refused(f"{file}: found a module of a name that Python or neritic has; accepted: another name")


def _binds(node, name):
    """Whether a node of a syntax tree makes this name: a class, an import, an assignment."""
    if isinstance(node, ast.alias):
        return (node.asname or node.name) in (name, "*")
    if isinstance(node, ast.Name):
        return node.id == name and isinstance(node.ctx, ast.Store)
    return isinstance(node, (ast.ClassDef, ast.FunctionDef)) and node.name == name
