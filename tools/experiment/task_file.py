"""A task's tables in a scenario file, checked: README.md lists the keys. Plain data; it goes to the worker processes."""
import os

from formulas import Formula
from scenario import Refused, Setting, check_keys, _number, _word_of

STATISTICS = ("last", "first", "mean", "rms", "min", "max", "ever", "share", "duration")
MOST_SECONDS = 86400.0


class TaskFile:
    def __init__(self, path, data):
        self.path = path
        task = data.get("task", {})
        check_keys(f"{path}: task", task, ["scene", "controller", "control_hz", "seconds", "participants", "places",
                                            "settings", "tells", "stop", "player"])
        self._read_files(task)
        self.control_hz = _number(f"{path}: task.control_hz", task.get("control_hz", 20), 0.1, 1000)
        self.seconds = _number(f"{path}: task.seconds", task.get("seconds", 60), 0.1, MOST_SECONDS)
        self.participants, self.tells = self._names("participants", task), self._names("tells", task)
        self._read_places(_table(f"{path}: task.places", task.get("places", {})))
        self._read_settings(_table(f"{path}: task.settings", task.get("settings", {})))
        self._read_stages(_tables(f"{path}: stages", data.get("stages", [])))
        self.stop = self._formula(f"{path}: task.stop", task["stop"]) if "stop" in task else None
        self._read_measures(_tables(f"{path}: measures", data.get("measures", [])))

    def _read_files(self, task):
        path = self.path
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

    def _read_places(self, tables):
        path = self.path
        self.places = {}
        for name, at in tables.items():
            if not isinstance(at, list) or len(at) != 3:
                raise Refused(f"{path}: task.places.{name}: found {at!r}; accepted: [east, north, up] in metres")
            self.places[name] = [float(_number(f"{path}: task.places.{name}", v, -4e7, 4e7)) for v in at]

    def _read_settings(self, tables):
        path = self.path
        self.SETTINGS = {"controller": Setting("baseline", "the scenario's own, null (the robot that holds still), or a .py file of yours")}
        for name, table in tables.items():
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

    def _formula(self, where, text):
        numbers = ["time", "stage_time"] + self.tells + [k for k, s in self.SETTINGS.items() if not isinstance(s.default, str)]
        return Formula(where, text, self.participants + list(self.places), numbers)

    def _read_stages(self, tables):
        path, self.stages = self.path, []
        for i, stage in enumerate(tables):
            where = f"{path}: stages[{i}]"
            check_keys(where, stage, ["name", "until", "held_s", "at_most_s"])
            if not isinstance(stage.get("name"), str):
                raise Refused(f"{where}.name: found {stage.get('name')!r}; accepted: a word")
            self.stages.append({"name": stage["name"], "until": self._formula(f"{where}.until", stage.get("until")),
                                "held_s": _number(f"{where}.held_s", stage.get("held_s", 0), 0, MOST_SECONDS),
                                "at_most_s": _number(f"{where}.at_most_s", stage.get("at_most_s", self.seconds), 0, MOST_SECONDS)})
        if not self.stages:
            raise Refused(f"{path}: stages: found none; accepted: one or more")

    def _read_measures(self, tables):
        path = self.path
        self.measures, self.MEASURES = [], {
            "success": ("yes or no", "whether every stage ended in its time"),
            "time_s": ("s", "until the last stage ended, of the runs that succeed")}
        self.MEASURES |= {f"{s['name']}_s": ("s", f"how long the stage {s['name']} took") for s in self.stages}
        for i, measure in enumerate(tables):
            where = f"{path}: measures[{i}]"
            check_keys(where, measure, ["name", "of", "statistic", "stage", "unit", "meaning"])
            statistic, stage = measure.get("statistic", "mean"), measure.get("stage")
            if not isinstance(measure.get("name"), str) or measure["name"] in self.MEASURES:
                raise Refused(f"{where}.name: found {measure.get('name')!r}; accepted: a new word")
            _word_of(f"{where}.statistic", statistic, STATISTICS)
            if stage is not None and stage not in [s["name"] for s in self.stages]:
                raise Refused(f"{where}.stage: found {stage!r}; accepted: {', '.join(s['name'] for s in self.stages)}")
            self.measures.append({"name": measure["name"], "of": self._formula(f"{where}.of", measure.get("of")),
                                  "statistic": statistic, "stage": stage})
            unit = "yes or no" if statistic == "ever" else "s" if statistic == "duration" else str(measure.get("unit", ""))
            self.MEASURES[measure["name"]] = (unit, str(measure.get("meaning", measure.get("of"))))

    def _names(self, key, task):
        names = task.get(key, [])
        if not isinstance(names, list) or not all(isinstance(n, str) for n in names):
            raise Refused(f"{self.path}: task.{key}: found {names!r}; accepted: a list of words")
        return names


def _table(where, value):
    if not isinstance(value, dict):
        raise Refused(f"{where}: found {value!r}; accepted: a table")
    return value


def _tables(where, value):
    if not isinstance(value, list):
        raise Refused(f"{where}: found {value!r}; accepted: tables, each [[{where.split()[-1]}]]")
    return value
