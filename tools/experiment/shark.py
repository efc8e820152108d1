"""The published task: a diver sees a shark, a detector names what the diver looks at, and the ROV puts itself between
them and keeps the shark in its sonar. The ROV flies by its own thrusters, control and, if asked, its own sensors.

Blocked: the ROV's projection on the line from diver to shark lies in [0.1, 0.9] of it, and the ROV is at most 0.35 m
beside it, for 1 s; the time counts to the beginning of that second, from when the diver's gaze met the shark.
"""
import contextlib
import csv
import math
import os

import numpy as np

import looking
import shark_person
from detector import model_of
from instants import Instants
from rotations import matrix
from scenario import Failed, Refused, Setting, draw
from shark_figures import figures, notes  # noqa: F401: of the kind
from shark_scene import Judge, scene_of, shark_at
from shark_senses import DIVER, Gaze, SonarTrack

SETTINGS = {
    "offset_m": Setting(1.0, "the ROV's start beside the line from diver to shark, at its middle", 0.0, 10.0),
    "offset_angle_deg": Setting(0.0, "its direction about that line: 0 level, 90 above", -180.0, 180.0),
    "shark_range_m": Setting(6.0, "from the diver, at the start", 2.0, 30.0),
    "shark_bearing_deg": Setting(0.0, "from north over east", -180.0, 180.0),
    "shark_speed_m_s": Setting(0.3, "of its approach", 0.0, 5.0),
    "shark_circling_m_s": Setting(0.1, "across the line, to its left", -5.0, 5.0),
    "delay_s": Setting(0.0, "injected between the detector's word and the ROV", 0.0, 10.0),
    "detector": Setting("assumed", "assumed: a share of misses; shipped, small: the diver's gaze crops go to it; or an .onnx file"),
    "detector_latency_s": Setting(0.0, "from the gaze to the detector's word, in simulated time", 0.0, 10.0),
    "detector_miss": Setting(0.0, "share of its looks, ten a second, in which an assumed one misses the shark", 0.0, 0.99),
    "detector_least": Setting(0.6, "how sure one that looks must be", 0.0, 1.0),
    "crop_px": Setting(64, "side of the gaze crops", 16, 512, whole=True),
    "gaze_error_deg": Setting(1.5, "how far the crop's middle is off the shark, at most, by each look", 0.0, 10.0),
    "water": Setting("IB", "Jerlov's type, for a detector that looks", words=["I", "IA", "IB", "II", "III", "1C", "3C", "5C"]),
    "heading_deg": Setting(0.0, "the ROV's heading at the start, relative to the shark's bearing", -180.0, 180.0),
    "shark_known_by": Setting("truth", "the ROV knows the shark's place truly, or by its sonar from where the word says it is",
                              words=["truth", "sonar"]),
    "sonar_quality": Setting("draft", "of that sonar", words=["draft", "standard", "reference"]),
    "sonar_hz": Setting(5.0, "its pings a second", 0.5, 20.0),
    "navigation": Setting("truth", "the ROV flies by its true state or by what its sensors measure", words=["truth", "measured"]),
    "current_m_s": Setting(0.0, "of the water, towards east", -2.0, 2.0),
    "physics_hz": Setting(240, "steps a second", 60, 1000, whole=True),
    "control_hz": Setting(20.0, "how often the ROV is told its place", 1.0, 240.0),
    "seconds": Setting(8.0, "of a run at most; with a person: from when the gaze met the shark", 1.0, 120.0),
    "person": Setting("nobody", "the diver: nobody (its eyes are on the shark at once), or a person in a window or a headset, one run after "
                      "the other; recordings and markers in OUT/person", words=["nobody", "window", "headset"]),
    "person_bearing_deg": Setting(90.0, "how far to the side of the shark a person faces at the start", -180.0, 180.0),
    "person_spread_deg": Setting(30.0, "by how much more or less, at most, by the seed", 0.0, 90.0),
    "person_side": Setting("by_seed", "the side on which the shark is then", words=["by_seed", "port", "starboard"]),
    "gaze_within_deg": Setting(5.0, "a person's gaze meets the shark within this angle, or half a metre of its middle", 0.5, 45.0),
    "gaze_held_s": Setting(0.15, "for so long", 0.0, 5.0),
    "find_s": Setting(60.0, "that a person has to find the shark", 1.0, 600.0),
    "markers": Setting(0, "the port to which the dive's markers go, as of a study ({markers}); 0: a free one", 0, 65535, whole=True,
                       decides=False),
    "from_recording": Setting(False, "true: the run is recorded, replayed by the program and judged again from the replay's log"),
}
MEASURES = {
    "blocked": ("yes or no", "whether the ROV blocked the shark at all"),
    "blocked_in_3_s": ("yes or no", "whether it did within 3.0 s"),
    "time_to_block_s": ("s", "of the runs that blocked"),
    "found_s": ("s", "until a person's gaze met the shark"),
    "person_moved_m": ("m", "how far the person's eyes were from where they began, at most"),
    "time_of_motion_s": ("s", "the same without the detector's latency and the injected delay"),
    "shark_in_sonar": ("", "share of the time after the block in which the shark is in the sonar's sight (90 x 28 degrees, 10 m)"),
    "beside_rms_m": ("m", "distance from the line over the 2 s after the block"),
    "largest_force_n": ("N", "largest force of a thruster"),
    "same_from_recording": ("yes or no", "whether the replay's judgement is the run's"),
    "pings_used": ("", "share of the sonar's pings that corrected its track"),
    "track_error_m": ("m", "rms error of the shark's place, level, by the sonar"),
    "looks": ("", "of a detector that looks, until it says shark"),
    "wrong_words": ("", "how often it named something else before"),
    "look_ms": ("ms", "median of its answers on a thread of its own; by the clock, so it differs from run to run"),
}


def _from_recording(s, tools, record, seen):
    """When the shark was blocked, by the program's replay of the run's recording: at the same instants, by its log."""
    log = os.path.join(tools.folder, "replayed.csv")
    tools.neritic("dive", "--replay", record + ".mcap", "--headless", "--log", log, "--log-rate", s["physics_hz"], "-q")
    with open(log, encoding="utf-8") as file:
        rows = {round(float(r["time_s"]), 4): r for r in csv.DictReader(file) if r["vehicle"] == "rov"}
    judge = Judge()
    for at_s, time, shark, eyes in seen:
        row = rows.get(round(at_s, 4))
        if row is None:
            raise Failed(f"the replay's log has no line at {at_s:g} s")
        judge.see(time, np.array([float(row["x_m"]), -float(row["z_m"]), float(row["y_m"])]), shark, eyes)
    return judge.blocked_s


def _word_s(s, seed):
    """When the detector says "shark": its first look that does not miss, after its latency."""
    look = 0
    while draw(seed, f"look {look}", 0.0, 1.0) < s["detector_miss"]:
        look += 1
    return 0.1 * look + s["detector_latency_s"]


class _Flight:
    """One run: the world, who looks and listens, the judge, and what is told of them."""

    def __init__(self, s, seed, tools):
        self.s = s
        scene = tools.write("scene.toml", scene_of(s, seed))
        self.person = shark_person.Person(s, seed, tools, scene) if s["person"] != "nobody" else None
        self.world, self.gaze = self.person.world if self.person else tools.python().open(scene, seed=seed), None
        try:
            self._begin(seed)
        except BaseException:
            self.close()
            raise

    def _begin(self, seed):
        s = self.s
        self.gaze = Gaze(self.world, s, seed, self.person) if s["detector"] != "assumed" else None
        # The time of the world at which the shark was met; of a person, once the gaze has found it.
        self.met_s, self.eyes, self.moved_m = (None if self.person else 0.0), DIVER, 0.0
        self.track = SonarTrack(self.world, s) if s["shark_known_by"] == "sonar" else None
        self.told_s = math.inf if self.gaze else _word_s(s, seed) + s["delay_s"]
        self.judge, self.in_sight, self.beside_after, self.force = Judge(), [], [], 0.0
        self.series = {"t": [], "beside": [], "along": []}
        self.seen_at, self.word_marked, self.began, self.found_s = [], False, DIVER, None

    def fly(self):
        s, world = self.s, self.world
        if self.person and not self._found():
            return
        if not self.person:
            world["diver"].pose(DIVER)
        # Told control_hz times a second; judged then, and at least 20 times a second.
        words, begun, part = Instants("control_hz", s["control_hz"], world.step_s), world.step, s["physics_hz"] // 20
        while self._time() < s["seconds"] - 1e-9:
            time = self._time()
            shark, speed = shark_at(s, time)
            self._show(shark, speed)
            self._look(time, shark)
            step = world.step - begun
            if step >= words.step:
                self._steer(time, shark, speed)
                words.take(step)
            world.tick(min(part, words.step - step))
            if self.person and not self._attend():
                raise Failed("the person's dive ended before the run")
            if self._see():
                break
        if self.person:
            blocked = self.judge.blocked_s
            self.person.mark("run ends", blocked_s=blocked, found_s=self.found_s)

    def _time(self):
        """Since the shark was met."""
        return self.world.time - self.met_s

    def _show(self, shark, speed):
        heading = math.atan2(speed[1], speed[0]) if np.hypot(*speed[:2]) > 1e-6 else math.atan2(-shark[1], -shark[0])
        self.world["shark"].pose(shark, [0.0, 0.0, math.sin(heading / 2), math.cos(heading / 2)], velocity=speed)

    def _attend(self):
        """Takes where a person's eyes are; false when the dive has ended."""
        if not self.person.look():
            return False
        self.eyes = self.person.eyes
        self.moved_m = max(self.moved_m, float(np.linalg.norm(self.eyes - self.began)))
        return True

    def _found(self):
        """Shows the shark, which stands, until the person's gaze has rested on it; whether it has in time."""
        s, world, person = self.s, self.world, self.person
        shark, _ = shark_at(s, 0.0)
        self._show(shark, np.zeros(3))
        world.tick(max(1, round(shark_person.READY_S / world.step_s)))
        if not person.look():
            raise Failed("the person's dive ended before the run")
        self.began, self.found_s = person.eyes, None
        person.mark("shark shown", seed=world.seed, shark=[round(float(x), 3) for x in shark])
        begun = world.time
        while world.time - begun < s["find_s"]:
            self._show(shark, np.zeros(3))
            world.tick(max(1, round(1 / 60 / world.step_s)))
            if not self._attend():
                raise Failed("the person's dive ended before the run")
            if person.meets(shark, world.time):
                self.met_s = world.time
                self.found_s = world.time - begun
                person.mark("gaze met the shark", found_s=round(self.found_s, 3))
                return True
        person.mark("shark not found")
        return False

    def _look(self, time, shark):
        if not self.gaze or math.isfinite(self.told_s) or time < 0.1 * self.gaze.looks - 1e-9 or not self.gaze.sees_shark(shark):
            return
        # A person's detector has taken its own time already.
        latency_s = 0.0 if self.person else self.s["detector_latency_s"]
        self.told_s = time + latency_s + self.s["delay_s"]
        if self.person:
            self.person.mark("the detector says shark", looks=self.gaze.looks)

    def _steer(self, time, shark, speed):
        """Once the word is out: to the middle of the line, at half the shark's speed, facing the shark."""
        if time < self.told_s - 1e-9:
            return
        at, moves = self.track.estimate(shark) if self.track else (shark, speed)
        if self.person and not self.word_marked:
            self.word_marked = True
            self.person.mark("the ROV is told")
        middle = 0.5 * (self.eyes + at)
        self.world["rov"].goto(*middle, math.atan2(at[1] - middle[1], at[0] - middle[0]), velocity=0.5 * moves)

    def _see(self):
        """Judges this instant; true when the run has told all it can."""
        truth = self.world.truth("rov")
        time = truth.time - self.met_s
        shark, _ = shark_at(self.s, time)
        before = self.judge.blocked_s
        along, beside = self.judge.see(time, truth.position, shark, self.eyes)
        if self.person and before is None and self.judge.blocked_s is not None:
            self.person.mark("shark blocked", blocked_s=round(self.judge.blocked_s, 3))
        self.seen_at.append((truth.time, time, shark, self.eyes))
        self.force = max(self.force, float(np.abs(truth.thruster_n).max()))
        for key, value in (("t", time), ("beside", beside), ("along", along)):
            self.series[key].append(round(value, 4))
        if self.judge.held_from is not None:
            self.in_sight.append(_in_sight(truth, shark))
            self.beside_after.append(beside)
        return self.judge.blocked_s is not None and time >= self.judge.blocked_s + 2.0

    def close(self):
        if self.person:
            self.person.close()
        else:
            self.world.close()
        if self.gaze:
            self.gaze.close()

    def measures(self):
        blocked_s = self.judge.blocked_s
        out = {"blocked": blocked_s is not None, "blocked_in_3_s": blocked_s is not None and blocked_s <= 3.0,
               "largest_force_n": self.force}
        if self.person:
            out["person_moved_m"] = self.moved_m
            if self.met_s is None:
                out["failure"] = "the person did not find the shark"
                return out
            out["found_s"] = self.found_s
        if self.gaze:
            out |= {"looks": self.gaze.looks, "wrong_words": self.gaze.wrong, "look_ms": 1e3 * float(np.median(self.gaze.work_s or [0.0]))}
        if self.track and self.track.errors:
            out["pings_used"] = self.track.used / max(1, self.track.pings)
            out["track_error_m"] = float(np.sqrt(np.mean(np.square(self.track.errors))))
        if blocked_s is not None:
            out |= {"time_to_block_s": blocked_s, "time_of_motion_s": blocked_s - self.told_s,
                    "shark_in_sonar": float(np.mean(self.in_sight)),
                    "beside_rms_m": float(np.sqrt(np.mean(np.square(self.beside_after))))}
        return out


def run(s, seed, tools):
    flight = _Flight(s, seed, tools)
    record = flight.person.record if flight.person else os.path.join(tools.folder, "run")
    with contextlib.ExitStack() as recording:
        recording.callback(flight.close)
        if s["from_recording"] and not flight.person:
            recording.enter_context(flight.world.record(record))
        flight.fly()
    measures = flight.measures()
    if s["from_recording"] and flight.met_s is not None:
        measures["same_from_recording"] = _from_recording(s, tools, record, flight.seen_at) == flight.judge.blocked_s
    return measures, flight.series


def _in_sight(truth, shark):
    """Whether the shark is in the sonar's wedge: ahead of the ROV, 90 x 28 degrees, to 10 m."""
    ahead, left, up = matrix(truth.orientation).T @ (shark - truth.position)
    return bool(math.hypot(ahead, left, up) <= 10.0 and abs(math.atan2(left, ahead)) <= math.radians(45)
                and abs(math.atan2(up, math.hypot(ahead, left))) <= math.radians(14))


def files(settings):
    """The files that decide a run's numbers, beside the settings."""
    return () if settings["detector"] == "assumed" else looking.files_of(model_of(settings["detector"]))


def check(settings):
    """Refuses what cannot run, before anything does: more words a second than steps, a detector that is not there, cannot look or knows
    no shark."""
    if settings["control_hz"] > settings["physics_hz"]:
        raise Refused(f"control_hz: found {settings['control_hz']:g}; accepted: at most physics_hz, {settings['physics_hz']}")
    if settings["detector"] == "assumed":
        return
    path = model_of(settings["detector"])
    _, classes, looks = looking.check(path, 3)
    if "shark" not in classes or looks != 1:
        raise Refused(f"{path}: found a detector of {', '.join(classes)}, {looks} looks; accepted: one with a class shark, 1 look")


def alone(settings):
    """Whether runs must come one after the other: a person has one pair of eyes."""
    return settings["person"] != "nobody"
