"""What a scene's file says of its things, for a robot that wants to know what a diver looks at: how large they are, where those stand that
the program does not tell of, and what a diver is. By the file alone: README.md of assets/scenes has the keys. East, north, up.

Not known: where a thing is that a track, a swell or another thing carries and that is no agent, and copies.
"""
import os

import numpy as np

from posed_model import Model
from rotations import scene_matrix
from scenario import Refused, read

DEEPEST = 8  # files that include one another, as the program reads them
NO_TARGETS = {"terrain", "copies", "copies_file", "scatter"}  # grounds and many at once
CARRIED = {"on", "track", "flock", "afloat", "dynamics", "swim"}
HEIGHT_M = 1.78  # a human's file without it (diver/anthropometry.hpp)


class Thing:
    """radius_m: of a sphere about its middle, by the mean of its three half sides. middle_m: of that, from its origin, right, up, back in its
    own axes. place: its middle, or None where it moves."""

    def __init__(self, radius_m, middle_m, place):
        self.radius_m, self.middle_m, self.place = radius_m, middle_m, place


class Person:
    """height_m, sex ("male", "female") and live: the groups of inputs (gaze, heart, breath) that a device or a program feeds."""

    def __init__(self, height_m, sex, live):
        self.height_m, self.sex, self.live = height_m, sex, live


def things_of(path):
    """{name: Thing} of the named objects and vehicles of a scene, but for grounds."""
    out = {}
    for name, table in _tables(path).items():
        if NO_TARGETS & table.keys() or table.get("class") == "seabed" or table.get("inside_out") or table.get("shape") == "plane":
            continue
        half, middle = _half_and_middle(table)
        place = None
        if not CARRIED & table.keys():
            turn = np.eye(3) if "rotation_xyzw" in table else scene_matrix(*(float(table.get(k, 0.0)) for k in ("yaw_deg", "pitch_deg", "roll_deg")))
            x, y, z = np.array(table.get("position_m", [0, 0, 0]), float) + turn @ middle
            place = np.array([x, -z, y])
        out[name] = Thing(float(np.mean(half)), middle, place)
    return out


def person_of(path, name):
    """The Person that a scene makes of the object of this name."""
    tables = _tables(path)
    if name not in tables:
        raise Refused(f"{path}: found no object {name}; accepted: {', '.join(sorted(tables)) or 'a scene that names it'}")
    table = tables[name]
    human = _merged(table["human"], DEEPEST) if "human" in table else {}
    live = set()
    for group, source in table.get("inputs", {}).items():
        source = source.get("from") if isinstance(source, dict) else source
        if source not in ("autopilot", "recording"):
            live.add(group)
    return Person(float(human.get("height_m", HEIGHT_M)), human.get("sex", "male"), live)


def _half_and_middle(table):
    """Half of its three sides, and the middle of them from its origin, m; zeros where it has no size that is known here."""
    scale = np.ones(3) * np.array(table.get("scale", 1.0), float)
    none = np.zeros(3)
    shape = table.get("shape")
    if shape == "sphere":
        return np.full(3, float(table.get("radius_m", 0.5))) * scale, none
    if shape == "cylinder":
        radius_m = float(table.get("radius_m", 0.5))
        return np.array([radius_m, 0.5 * float(table.get("height_m", 1.0)), radius_m]) * scale, none
    if shape == "box":
        return 0.5 * np.array(table.get("size_m", [1, 1, 1]), float) * scale, none
    if not str(table.get("model", "")).endswith(".glb"):
        return none, none
    try:
        corners = Model(table["model"]).triangles(table.get("clip")).reshape(-1, 3)
    except (OSError, ValueError, KeyError, IndexError, TypeError):
        return none, none  # a model that posed_model does not read, as a packed one, counts as a point
    low, high = corners.min(axis=0) * scale, corners.max(axis=0) * scale
    return 0.5 * (high - low), 0.5 * (high + low)


def _tables(path):
    """{name: table} of a scene's objects and vehicles."""
    data = _merged(os.path.abspath(path), DEEPEST)
    return {t["name"]: t for key in ("objects", "vehicles") for t in data.get(key, []) if isinstance(t, dict) and isinstance(t.get("name"), str)}


def _merged(path, depth):
    """A file with what it includes, whose keys it overrides; names of files below it are absolute."""
    return _with_includes(read(path), os.path.dirname(path), depth)


def _with_includes(table, folder, depth):
    out, own = {}, {}
    for key, value in table.items():
        if isinstance(value, dict):
            own[key] = _with_includes(value, folder, depth)
        elif isinstance(value, list):
            own[key] = [_with_includes(v, folder, depth) if isinstance(v, dict) else v for v in value]
        else:
            own[key] = os.path.join(folder, value) if key in ("model", "human") and isinstance(value, str) else value
    files = own.pop("include", [])
    for file in files if isinstance(files, list) else [files]:
        if depth > 0 and isinstance(file, str):
            out = _over(out, _merged(os.path.join(folder, file), depth - 1))
    return _over(out, own)


def _over(below, above):
    """Tables merge key by key; arrays of tables are joined, and an entry with an existing name changes that entry."""
    out = dict(below)
    for key, value in above.items():
        old = out.get(key)
        if isinstance(value, dict) and isinstance(old, dict):
            out[key] = _over(old, value)
        elif isinstance(value, list) and isinstance(old, list) and all(isinstance(v, dict) for v in value + old):
            joined = list(old)
            for entry in value:
                same = [i for i, o in enumerate(joined) if "name" in entry and o.get("name") == entry["name"]]
                if same:
                    joined[same[0]] = _over(joined[same[0]], entry)
                else:
                    joined.append(entry)
            out[key] = joined
        else:
            out[key] = value
    return out
