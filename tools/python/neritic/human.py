"""What a robot may know of a person: the stream DIVER/human with names in place of numbers."""
from __future__ import annotations

import math
from typing import Any, NamedTuple

from .observations import Observations
from .world import World

QUALITIES = ("missing", "lost", "modelled", "poor", "good")  # by their number in the stream
STALE_S = 0.5  # the stream has ten readings a second


class Value(NamedTuple):
    """A value of a person's state. quality: missing (not known: NaN or None), lost (its device was never heard or fell silent: the
    model of a diver has it), modelled (no device is named for it), poor (measured, not to be relied on), good (measured);
    stale: the reading is older than STALE_S. age_s: of the reading."""
    value: Any
    quality: str
    age_s: float


def human_state(world: World, seen: Observations, diver: str = "diver") -> dict[str, Value]:
    """The state of a diver that a robot acts on: gaze_target (an object's name, or None), gaze_off_deg and gaze_distance_m (of the
    line of sight from it, or from the nearest thing), breath_bpm, heart_bpm, sdnn_ms and rmssd_ms (of the heart's last five
    minutes), depth_m, ascent_m_min, gas_bar (by the diver's computer and gauge)."""
    reading = seen.get(f"{diver}/human")
    names = ("gaze_target", "gaze_off_deg", "gaze_distance_m", "breath_bpm", "heart_bpm", "sdnn_ms", "rmssd_ms", "depth_m",
             "ascent_m_min", "gas_bar")
    if reading is None:
        return {name: Value(None if name == "gaze_target" else math.nan, "missing", math.inf) for name in names}
    age = seen.time - reading.stamp

    def value(number: Any, quality: float) -> Value:
        word = QUALITIES[int(quality)]
        if word == "missing":
            return Value(math.nan, word, age)
        return Value(number, "stale" if age > STALE_S else word, age)
    gaze, variability, good = reading.gaze_quality, reading.variability_quality, QUALITIES.index("good")
    target = int(reading.gaze_object)
    return {
        "gaze_target": value(world.objects[target - 1] if target else None, gaze),
        "gaze_off_deg": value(math.degrees(reading.gaze_off), gaze),
        "gaze_distance_m": value(reading.gaze_distance_m, gaze),
        "breath_bpm": value(reading.breath_bpm, reading.breath_quality),
        "heart_bpm": value(reading.heart_bpm, reading.heart_quality),
        "sdnn_ms": value(reading.sdnn_ms, variability),
        "rmssd_ms": value(reading.rmssd_ms, variability),
        "depth_m": value(reading.depth_m, good),
        "ascent_m_min": value(reading.ascent_m_min, good),
        "gas_bar": value(reading.gas_pa / 1e5, good),
    }
