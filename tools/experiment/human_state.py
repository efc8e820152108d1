"""The diver's state as one stream for a robot: what the published system feeds to its ROV, each value with a quality.

    from human_state import HumanState
    human = HumanState(world, "diver")
    state = human.of(world.tick(12))       # {"breath_bpm": Value(13.2, "good", age_s=0.05), ...}

Names and units: gaze_target (an agent's name or None), gaze_off_deg, breath_bpm, heart_bpm, rmssd_ms, depth_m, ascent_m_min,
gas_bar. Qualities: good; stale (older than STALE_S); poor (known, but not to be relied on, as rmssd_ms always is); missing
(never came, or NaN).
"""
import collections
import math

import numpy as np

Value = collections.namedtuple("Value", "value quality age_s")
STALE_S = {"motion": 0.5, "computer": 3.0, "heart": 10.0}  # by stream of the diver
GAZE_DEG = 5.0  # farther off the line of sight nothing is looked at
BEATS = 20  # successive intervals of the heart's variability


class HumanState:
    def __init__(self, world, diver="diver"):
        self.world, self.diver, self.intervals, self.last_beats = world, diver, collections.deque(maxlen=BEATS + 1), None

    def of(self, seen):
        motion, age = self._newest(seen, "motion")
        out = {name: _judged(getattr(motion, name, math.nan), age, STALE_S["motion"]) for name in ("breath_bpm", "heart_bpm")}
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

    def _gaze(self, motion, age):
        """The agent nearest to the line of sight from the diver's place; poor where two are as near."""
        if motion is None or not np.isfinite(motion.gaze).all() or np.linalg.norm(motion.gaze) < 1e-6:
            return Value(None, "missing", math.inf), Value(math.nan, "missing", math.inf)
        way, eye = np.array(motion.gaze) / np.linalg.norm(motion.gaze), np.array(motion.position)
        off = []
        for name in self.world.agents:
            if name == self.diver:
                continue
            line = np.array(self.world.truth(name).position) - eye
            far = float(np.linalg.norm(line))
            if far > 1e-6:
                off.append((math.degrees(math.acos(max(-1.0, min(1.0, float(way @ line) / far)))), name))
        off.sort()
        if not off or off[0][0] > GAZE_DEG:
            return _judged_as(None, age), _judged(off[0][0] if off else math.nan, age, STALE_S["motion"])
        doubt = len(off) > 1 and off[1][0] - off[0][0] < 1.0
        return _judged_as(off[0][1], age, doubt), _judged(off[0][0], age, STALE_S["motion"])

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


def _judged(value, age, stale_s):
    value = float(value)
    if not math.isfinite(value) or math.isinf(age):
        return Value(math.nan, "missing", age)
    return Value(value, "stale" if age > stale_s else "good", age)


def _judged_as(name, age, doubt=False):
    return Value(name, "stale" if age > STALE_S["motion"] else "poor" if doubt else "good", age)
