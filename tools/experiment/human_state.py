"""The diver's state as one stream for a robot: what the published system feeds to its ROV, each value with a quality.

    from human_state import HumanState
    human = HumanState(world, "diver", scene="dive.toml")
    state = human.of(world.tick(12))       # {"breath_bpm": Value(13.2, "good", age_s=0.05), ...}

Names and units: gaze_target (a name or None), gaze_off_deg, breath_bpm, heart_bpm, rmssd_ms, depth_m, ascent_m_min, gas_bar.
Qualities: good; stale (older than STALE_S); poor (known, but not to be relied on); missing (never came, or NaN).

scene is the file of the world's scene. It says how tall the diver is, how large things are, where things stand that are no agents, and
which groups of inputs devices feed. Observations do not say whether a device or the body's model acts: heart and breath of a group that
a device feeds are poor at best, and so they are without a scene. A gaze is measured where it leaves the face's way ahead.
"""
import collections
import math

import numpy as np

import scene_things
from eyes import eyes_and_face
from rotations import matrix

Value = collections.namedtuple("Value", "value quality age_s")
STALE_S = {"motion": 0.5, "computer": 3.0, "heart": 10.0}  # by stream of the diver
GAZE_DEG = 5.0  # farther off the line of sight nothing is looked at
FACE_DEG = 1.0  # a gaze within this angle of the face's way ahead is that of nobody: the model looks out of the face
HEIGHT_M = 1.80  # of the shipped divers
BEATS = 20  # successive intervals of the heart's variability


class HumanState:
    def __init__(self, world, diver="diver", scene=None):
        self.world, self.diver, self.intervals, self.last_beats = world, diver, collections.deque(maxlen=BEATS + 1), None
        self.things = scene_things.things_of(scene) if scene else {}
        self.person = scene_things.person_of(scene, diver) if scene else scene_things.Person(HEIGHT_M, "male", {"gaze", "heart", "breath"})
        self.postures = collections.deque(maxlen=200)  # (time, joints): what arrives may be older than now

    def of(self, seen):
        motion, age = self._newest(seen, "motion")
        out = {f"{group}_bpm": _judged(getattr(motion, f"{group}_bpm", math.nan), age, STALE_S["motion"], group not in self.person.live)
               for group in ("breath", "heart")}
        tank = getattr(motion, "tank_pa", math.nan)
        out["gas_bar"] = _judged(tank / 1e5, age, STALE_S["motion"])
        out["gaze_target"], out["gaze_off_deg"] = self._gaze(motion, age)
        computer, age = self._newest(seen, "computer")
        for name, field in (("depth_m", "depth_m"), ("ascent_m_min", "ascent_m_min")):
            out[name] = _judged(getattr(computer, field, math.nan), age, STALE_S["computer"])
        out["rmssd_ms"] = self._rmssd(seen)
        return out

    def _newest(self, seen, kind):
        one = seen.get(f"{self.diver}/{kind}")
        return (one, math.inf) if one is None else (one, seen.time - one.stamp)

    def _posture(self, stamp):
        """The joints at the time of a sample, as near as they were looked at."""
        truth = self.world.truth(self.diver)
        if not self.postures or truth.time > self.postures[-1][0]:
            self.postures.append((truth.time, np.array(truth.joints)))
        return min(self.postures, key=lambda p: abs(p[0] - stamp))[1]

    def _gaze(self, motion, age):
        """The thing nearest to the line of sight from the eyes; poor where two are as near, and where the gaze may be nobody's."""
        if motion is None or not np.isfinite(motion.gaze).all() or np.linalg.norm(motion.gaze) < 1e-6:
            return Value(None, "missing", math.inf), Value(math.nan, "missing", math.inf)
        way = np.array(motion.gaze) / np.linalg.norm(motion.gaze)
        eyes, face = eyes_and_face(motion.position, motion.orientation, self._posture(motion.stamp), self.person.height_m, self.person.sex)
        measured = "gaze" not in self.person.live or _angle_deg(way, face) > FACE_DEG
        off = sorted(self._offs(way, eyes))
        if not off or off[0][0] > GAZE_DEG:
            return _named(None, age, measured), _judged(off[0][0] if off else math.nan, age, STALE_S["motion"], measured)
        alone = len(off) == 1 or off[1][0] - off[0][0] >= 1.0
        return _named(off[0][2], age, measured and alone), _judged(off[0][0], age, STALE_S["motion"], measured)

    def _offs(self, way, eyes):
        """(degrees from the line of sight to the edge, distance, name) of each thing."""
        for name in {*self.world.agents, *self.things} - {self.diver}:
            thing = self.things.get(name)
            if name in self.world.agents:
                truth = self.world.truth(name)
                middle = np.array(truth.position)
                if thing is not None and not len(truth.joints):  # a diver's place is the hips, the middle of the body
                    right, up, back = thing.middle_m
                    middle = middle + matrix(truth.orientation) @ [-back, -right, up]
            elif thing.place is None:
                continue  # it moves, and nothing tells where
            else:
                middle = thing.place
            line = middle - eyes
            far = float(np.linalg.norm(line))
            radius = thing.radius_m if thing else 0.0
            if far > 1e-6:
                yield max(0.0, _angle_deg(way, line / far) - math.degrees(math.asin(min(1.0, radius / far)))), far, name

    def _rmssd(self, seen):
        """Root mean square of successive differences of the intervals (Task Force 1996) that a strap's rates stand for: a
        strap smooths its rate, so this is poor by nature; good takes a strap that sends intervals."""
        heart, age = self._newest(seen, "heart")
        if heart is None or not math.isfinite(heart.rate_bpm) or heart.rate_bpm <= 0:
            return Value(math.nan, "missing", math.inf)
        if heart.beats != self.last_beats:
            self.last_beats = heart.beats
            self.intervals.append(60e3 / heart.rate_bpm)
        if len(self.intervals) < 5:
            return Value(math.nan, "missing", age)
        value = float(np.sqrt(np.mean(np.diff(self.intervals) ** 2)))
        return Value(value, "stale" if age > STALE_S["heart"] else "poor", age)


def _angle_deg(a, b):
    return math.degrees(math.acos(max(-1.0, min(1.0, float(a @ b)))))


def _judged(value, age, stale_s, sure=True):
    value = float(value)
    if not math.isfinite(value) or math.isinf(age):
        return Value(math.nan, "missing", age)
    return Value(value, "stale" if age > stale_s else "good" if sure else "poor", age)


def _named(name, age, sure):
    return Value(name, "stale" if age > STALE_S["motion"] else "good" if sure else "poor", age)
