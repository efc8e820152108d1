"""Scenario files: what an experiment is, as TOML. README.md lists the keys.

A scenario becomes a list of runs: every combination of the factors' levels, each with the same seeds. A varied setting
is drawn by (seed, key) alone, so a run is the same whatever runs beside it.
"""
import copy
import difflib
import hashlib
import itertools
import json
import math
import os
import tomllib

import files_read

HERE = os.path.dirname(os.path.realpath(__file__))
DRAWS = 2  # how settings are drawn: another number where a seed draws other values
SHIPPED = os.path.normpath(os.path.join(HERE, "..", "..", "assets", "experiments"))
STATISTICS = ("median", "mean", "min", "max", "share")
MOST_RUNS = 1_000_000
MOST_SEED = 2 ** 63 - 1  # of a scene's file, and of TOML
RUN_LIMIT_S = 3600.0  # of the clock, that a run may take


class Refused(Exception):
    """Bad input, in one line: where, what was found, what is accepted. Exit status 2."""


class Failed(Exception):
    """It could not be done here. Exit status 1."""


# Keys of a scene's file (assets/scenes/README.md).
SCENE_TABLES = {"include", "title", "cameras", "sonars", "objects", "vehicles", "divers", "terrain", "water", "sun"}


def names():
    """The shipped scenarios, in the order of `all`."""
    order = ["imaging", "profiling", "echo_sounder", "shark"]
    found = sorted(f[:-5] for f in os.listdir(SHIPPED) if f.endswith(".toml"))
    return [n for n in order if n in found] + [n for n in found if n not in order]


def path_of(name):
    """A shipped scenario's file, or the user's own .toml."""
    if name.endswith(".toml"):
        if not os.path.isfile(name):
            raise Refused(f"{name}: found no such file; accepted: a scenario, or one of {', '.join(names())}")
        return name
    if name not in names():
        near = difflib.get_close_matches(name, names(), 1)
        known = [n + " (the nearest)" if n in near else n for n in names()]
        raise Refused(f"experiment: found \"{short(name)}\"; accepted: {', '.join(known)}, all, or a .toml file")
    return os.path.join(SHIPPED, name + ".toml")


def read(path):
    try:
        with open(path, "rb") as file:
            return tomllib.load(file)
    except OSError as error:
        raise Refused(f"{path}: found a file that cannot be read ({error.strerror}); accepted: a scenario in TOML") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError, RecursionError) as error:
        raise Refused(f"{path}: found no TOML: {error}") from None


def check_keys(where, table, accepted):
    if not isinstance(table, dict):
        raise Refused(f"{where}: found {_words(table)}; accepted: a table")
    for key in table:
        if key not in accepted:
            near = difflib.get_close_matches(key, accepted, 1)
            raise Refused(f"{where}: found key \"{short(key)}\"; accepted: "
                          + (f"{near[0]} (the nearest)" if near else ", ".join(accepted)))


def short(text, most=120):
    """A text as it is echoed: of a long one the first part."""
    return text if len(text) <= most else f"{text[:most]}... ({len(text)} characters)"


def _words(value):
    return short(json.dumps(value, default=str)) if not isinstance(value, (dict, list)) else ("a table" if isinstance(value, dict) else "a list" if value else "an empty list")


def _number(where, value, low, high, whole=False):
    good = isinstance(value, int) if whole else isinstance(value, (int, float))
    if isinstance(value, bool) or not good or not (low <= value <= high):
        kind = "a whole number" if whole else "a number"
        low, high = (f"{v}" if isinstance(v, int) else f"{v:g}" for v in (low, high))
        raise Refused(f"{where}: found {_words(value)}; accepted: {kind} in [{low}, {high}]")
    return value


def _word_of(where, value, accepted):
    if not isinstance(value, str) or value not in accepted:
        raise Refused(f"{where}: found {_words(value)}; accepted: {', '.join(accepted)}")


def text_of(where, table, key, default=""):
    """The text of a key, or its default."""
    value = table.get(key, default)
    if not isinstance(value, str):
        raise Refused(f"{where}.{key}: found {_words(value)}; accepted: text")
    return value


class Setting:
    """A value that a kind of experiment understands: its default, its limits or words, and what it means. decides: whether a run's
    numbers depend on it."""

    def __init__(self, default, meaning, low=None, high=None, words=None, whole=False, decides=True):
        self.decides = decides
        self.default, self.meaning, self.low, self.high, self.words, self.whole = default, meaning, low, high, words, whole

    def check(self, where, value):
        if isinstance(self.default, bool):
            if not isinstance(value, bool):
                raise Refused(f"{where}: found {_words(value)}; accepted: true or false")
        elif isinstance(self.default, str):
            if not isinstance(value, str) or (self.words and value not in self.words) or (not value and self.default):
                raise Refused(f"{where}: found {_words(value)}; accepted: "
                              + (", ".join(self.words) if self.words else "text"))
        else:
            _number(where, value, self.low, self.high, self.whole)
        return value


class Run:
    """One run: its condition (the factors' levels), seed, settings and the hashes of the files that these name. Plain data;
    crosses processes."""

    def __init__(self, index, condition, seed, settings, files=()):
        self.index, self.condition, self.seed, self.settings, self.files = index, condition, seed, settings, list(files)

    def key(self):
        return json.dumps([self.condition, self.seed], sort_keys=True)


def draw(seed, key, low, high):
    """Uniform in [low, high): by a counter, SHA-256 of the seed and the key."""
    digest = hashlib.sha256(f"{seed}:{key}".encode()).digest()
    return low + (high - low) * (int.from_bytes(digest[:8], "big") >> 11) / 2 ** 53


def draw_whole(seed, key, low, high):
    """A whole number in [low, high], each as likely."""
    return low + math.floor(draw(seed, key, 0.0, 1.0) * (high - low + 1))


class Scenario:
    """A checked scenario. kinds: {name: module with SETTINGS, MEASURES, run, figures, or a class that makes such an
    object of the file's path and data}."""

    def __init__(self, path, kinds, runs=None, seed=None, sets=()):
        self.path = path
        self.name = os.path.splitext(os.path.basename(path))[0]
        self.data = data = copy.deepcopy(read(path))
        if "experiment" not in data and SCENE_TABLES & data.keys():
            raise Refused(f"{path}: found a scene; accepted: a scenario, whose table [experiment] names its kind "
                          "(tools/experiment/README.md)")
        head = data.get("experiment", {})
        own = ["task", "stages", "measures"] if isinstance(head, dict) and head.get("kind") == "task" else []
        check_keys(path, data, ["experiment", "settings", "vary", "factors", "criteria", *own])
        check_keys(f"{path}: experiment", head, ["title", "about", "kind", "runs", "seed", "run_limit_s"])
        kind = head.get("kind")
        _word_of(f"{path}: experiment.kind", kind, kinds)
        self.kind_name = kind
        self.kind = kinds[kind](path, data) if isinstance(kinds[kind], type) else kinds[kind]
        self.title, self.about = (text_of(f"{path}: experiment", head, key, own_text) for key, own_text in (("title", self.name), ("about", "")))
        self.runs = _number("--runs" if runs is not None else f"{path}: experiment.runs",
                            runs if runs is not None else head.get("runs", 1), 1, MOST_RUNS, True)
        self.seed = _number("--seed" if seed is not None else f"{path}: experiment.seed",
                            seed if seed is not None else head.get("seed", 1), 0, MOST_SEED - self.runs + 1, True)
        self.run_limit_s = self._limit(f"{path}: experiment.run_limit_s", head.get("run_limit_s", RUN_LIMIT_S))
        known = self.kind.SETTINGS
        self.settings = {k: s.default for k, s in known.items()}
        for table in ("settings", "vary", "factors"):
            check_keys(f"{path}: {table}", data.get(table, {}), list(known))
        for key, value in data.get("settings", {}).items():
            self.settings[key] = known[key].check(f"{path}: settings.{key}", value)
        self.vary = {k: self._range(k, v) for k, v in data.get("vary", {}).items()}
        self.factors = {k: self._levels(k, v) for k, v in data.get("factors", {}).items()}
        self.added, self.replaced = [], set()  # factors of --set; keys of --set
        self._of_file = dict(self.settings), dict(self.vary), dict(self.factors)  # criteria name what the file has, before --set
        for text in sets:
            self._set(text)
        if hasattr(self.kind, "check"):  # of files that settings name, before anything runs
            for levels in itertools.product(*self.factors.values()):
                self.kind.check({**self.settings, **dict(zip(self.factors, levels))})
        both = set(self.vary) & set(self.factors)
        if both:
            raise Refused(f"{path}: vary.{min(both)}: found a factor of the same name; accepted: one of the two")
        criteria = data.get("criteria", [])
        if not isinstance(criteria, list):
            raise Refused(f"{path}: criteria: found {_words(criteria)}; accepted: tables, each [[criteria]]")
        self.criteria = [self._criterion(i, c) for i, c in enumerate(criteria)]
        conditions = math.prod(len(v) for v in self.factors.values())
        if conditions * self.runs > MOST_RUNS:
            raise Refused(f"{path}: found {conditions} conditions of {self.runs} runs; accepted: at most {MOST_RUNS} runs")

    def _range(self, key, value):
        where, setting = f"{self.path}: vary.{key}", self.kind.SETTINGS[key]
        if isinstance(setting.default, (str, bool)) or not isinstance(value, list) or len(value) != 2:
            raise Refused(f"{where}: found {_words(value)}; accepted: [lowest, highest] of a number")
        low, high = (setting.check(where, v) for v in value)
        if low > high:
            raise Refused(f"{where}: found {value}; accepted: the lower number first")
        return [low, high]

    def _limit(self, where, value):
        return _number(where, value, 0.1, 1e7)

    def _levels(self, key, value):
        if not isinstance(value, list) or not value:
            raise Refused(f"{self.path}: factors.{key}: found {_words(value)}; accepted: a list of one level or more")
        levels = [self.kind.SETTINGS[key].check(f"{self.path}: factors.{key}", v) for v in value]
        if len(set(levels)) < len(levels):
            raise Refused(f"{self.path}: factors.{key}: found a level twice; accepted: levels that differ")
        return levels

    def _set(self, text):
        """key=value of --set, in TOML: a number, a word in quotes or bare; a list makes a factor."""
        key, mark, raw = text.partition("=")
        key = key.strip()
        known = [*self.kind.SETTINGS, "run_limit_s"]
        if not mark or key not in known:
            near = difflib.get_close_matches(key, known, 1)
            raise Refused(f"--set: found \"{short(text)}\"; accepted: KEY=VALUE, KEY one of "
                          + (f"{near[0]} (the nearest), " if near else "") + ", ".join(known))
        try:
            value = tomllib.loads(f"v = {raw}")["v"]
        except tomllib.TOMLDecodeError:
            value = raw.strip()
        if key not in self.kind.SETTINGS:
            self.run_limit_s = self._limit(f"--set {key}", value)
            return
        self.vary.pop(key, None)
        self.factors.pop(key, None)
        self.replaced.add(key)
        self.added = [k for k in self.added if k != key]
        if isinstance(value, list):
            where, self.path = self.path, "--set"
            try:
                self.factors[key] = self._levels(key, value)
                self.added.append(key)
            finally:
                self.path = where
        else:
            self.settings[key] = self.kind.SETTINGS[key].check(f"--set {key}", value)

    def _criterion(self, index, table):
        where = f"{self.path}: criteria[{index}]"
        check_keys(where, table, ["measure", "statistic", "at_most", "at_least", "where", "less"])
        _word_of(f"{where}.measure", table.get("measure"), self.kind.MEASURES)
        _word_of(f"{where}.statistic", table.get("statistic", "median"), STATISTICS)
        if ("at_most" in table) + ("at_least" in table) < 1:
            raise Refused(f"{where}: found no limit; accepted: at_most, at_least or both")
        for key in ("at_most", "at_least"):
            if key in table:
                _number(f"{where}.{key}", table[key], -1e300, 1e300)
        if table.get("at_least", -math.inf) > table.get("at_most", math.inf):
            raise Refused(f"{where}: found at_least {table['at_least']:g} above at_most {table['at_most']:g}; accepted: limits that a "
                          "number can hold")
        self._check_share(where, table)
        for part in ("where", "less"):
            self._check_condition(f"{where}.{part}", table.get(part, {}))
        return table

    def _check_share(self, where, table):
        """A share is of runs that say yes, and what says yes or no lies in [0, 1]; a difference of two in [-1, 1]."""
        yes_or_no = self.kind.MEASURES[table["measure"]][0] == "yes or no"
        if table.get("statistic") == "share" and not yes_or_no:
            known = [name for name, (unit, _) in self.kind.MEASURES.items() if unit == "yes or no"]
            raise Refused(f"{where}: found the share of {table['measure']}; accepted: of what says yes or no: {', '.join(known) or 'none here'}")
        for key in ("at_most", "at_least"):
            if yes_or_no and key in table:
                _number(f"{where}.{key}", table[key], -1 if "less" in table else 0, 1)

    def _check_condition(self, where, condition):
        """Refuses a condition that no run of the file has."""
        settings, vary, factors = self._of_file
        check_keys(where, condition, list(self.kind.SETTINGS))
        for key, value in condition.items():
            self.kind.SETTINGS[key].check(f"{where}.{key}", value)
            if key in vary and key not in factors:
                raise Refused(f"{where}.{key}: found a setting that the seed draws; accepted: a factor")
            levels = factors.get(key, [settings[key]])
            if value not in levels:
                raise Refused(f"{where}.{key}: found {_words(value)}, which no run has; accepted: {', '.join(map(_words, levels))}")

    def list_runs(self):
        out = []
        for levels in itertools.product(*self.factors.values()):
            condition = dict(zip(self.factors, levels))
            files = self._hashes({**self.settings, **condition})
            for i in range(self.runs):
                seed = self.seed + i
                drawn = {k: (draw_whole if self.kind.SETTINGS[k].whole else draw)(seed, k, *v) for k, v in self.vary.items()}
                out.append(Run(len(out), condition, seed, {**self.settings, **drawn, **condition}, files))
        return out

    def _hashes(self, settings):
        """Hashes of the files that decide a run's numbers beside the settings."""
        return [files_read.hash_of(f) for f in getattr(self.kind, "files", lambda settings: [])(settings)]

    def fingerprint(self):
        """The hash of the settings that decide a single run's numbers: results of another fingerprint are not resumed. Levels of
        factors are not in it, so that more of them can be added, nor are files: each run keeps the hashes of those that decide its
        numbers, and is made anew where one was edited."""
        own = [self.data.get(k) for k in ("task", "stages", "measures")]
        decisive = {k: v for k, v in self.settings.items() if self.kind.SETTINGS[k].decides}
        told = [DRAWS, self.kind_name, decisive, self.vary, sorted(self.factors), own]
        return hashlib.sha256(json.dumps(told, sort_keys=True).encode()).hexdigest()[:16]
