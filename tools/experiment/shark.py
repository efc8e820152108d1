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
from detector import model_of
from scenario import SHIPPED, Failed, Setting, draw
from shark_senses import CROP_DEG, DIVER, SEEN, SONAR, Gaze, SonarTrack

SETTINGS = {
    "offset_m": Setting(1.0, "the ROV's start beside the line from diver to shark, at its middle", 0.0, 10.0),
    "offset_angle_deg": Setting(0.0, "its direction about that line: 0 level, 90 above", -180.0, 180.0),
    "shark_range_m": Setting(6.0, "from the diver, at the start", 2.0, 30.0),
    "shark_bearing_deg": Setting(0.0, "from north over east", -180.0, 180.0),
    "shark_speed_m_s": Setting(0.3, "of its approach", 0.0, 5.0),
    "shark_circling_m_s": Setting(0.1, "across the line, to its left", -5.0, 5.0),
    "delay_s": Setting(0.0, "injected between the detector's word and the ROV", 0.0, 10.0),
    "detector": Setting("assumed", "assumed: a share of misses; shipped: the diver's gaze crops go to it; or an .onnx file"),
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
    "seconds": Setting(8.0, "of a run at most", 1.0, 120.0),
    "from_recording": Setting(False, "true: the run is recorded, replayed by the program and judged again from the replay's log"),
}
MEASURES = {
    "blocked": ("yes or no", "whether the ROV blocked the shark at all"),
    "blocked_in_3_s": ("yes or no", "whether it did within 3.0 s"),
    "time_to_block_s": ("s", "of the runs that blocked"),
    "time_of_motion_s": ("s", "the same without the detector's latency and the injected delay"),
    "shark_in_sonar": ("", "share of the time after the block in which the shark is in the sonar's sight (90 x 28 degrees, 10 m)"),
    "beside_rms_m": ("m", "distance from the line over the 2 s after the block"),
    "largest_force_n": ("N", "largest force of a thruster"),
    "same_from_recording": ("yes or no", "whether the replay's judgement is the run's"),
    "track_error_m": ("m", "rms error of the shark's place, level, by the sonar"),
    "looks": ("", "of a detector that looks, until it says shark"),
    "wrong_words": ("", "how often it named something else before"),
    "look_ms": ("ms", "median of its answers on a thread of its own; by the clock, so it differs from run to run"),
}
LINES = ("-", "--", ":", "-.", (0, (1, 1)), (0, (5, 1)))  # of conditions, told apart in grey too
BESIDE_M, HELD_S, LEAST, MOST = 0.35, 1.0, 0.1, 0.9
SCENE = """title = "A shark, a diver, an ROV"
seed = {seed}
[physics]
rate_hz = {physics_hz}
{current}
{seen}
[[objects]]
name = "diver"
class = "diver"
shape = "sphere"
radius_m = 0.05
position_m = [0, -10, 0]
inputs = {{ pose = {{ from = "python", hold_s = 3600 }} }}
[[objects]]
name = "shark"
class = "shark"
{shark_drawn}
position_m = {shark}
inputs = {{ pose = {{ from = "python", hold_s = 3600 }} }}
[[vehicles]]
name = "rov"
{rov_drawn}
dynamics = "{vehicle}"
navigation = "{navigation}"
position_m = {rov}
yaw_deg = {yaw!r}
mission = {{ hold = "station" }}
{sonar}"""


def _scene_of_enu(p):
    return [float(p[0]), float(p[2]), -float(p[1])]


def _shark_at(s, time):
    """(place, velocity) of the shark, east, north, up: it nears the diver and circles it at once."""
    bearing = math.radians(s["shark_bearing_deg"])
    r = max(1.0, s["shark_range_m"] - s["shark_speed_m_s"] * time)
    # The angle over time at the speed across: the integral of v / r.
    fast = s["shark_speed_m_s"]
    if fast > 1e-9:
        turned = s["shark_circling_m_s"] / fast * math.log(s["shark_range_m"] / r)
        turned += s["shark_circling_m_s"] * max(0.0, time - (s["shark_range_m"] - 1.0) / fast) / 1.0
    else:
        turned = s["shark_circling_m_s"] * time / r
    angle = bearing - turned
    out = np.array([math.sin(angle), math.cos(angle), 0.0])
    left = np.array([-math.cos(angle), math.sin(angle), 0.0])
    return DIVER + r * out, -fast * (r > 1.0) * out + s["shark_circling_m_s"] * left


def between(rov, diver, shark):
    """(along, beside): the ROV's projection on the line as a share of it, and its distance from the line in metres."""
    line = shark - diver
    along = float((rov - diver) @ line / (line @ line))
    return along, float(np.linalg.norm(rov - diver - along * line))


class Judge:
    """Whether the shark is blocked, and since when."""

    def __init__(self):
        self.held_from, self.blocked_s = None, None

    def see(self, time, rov, shark):
        """(along, beside) at this instant."""
        along, beside = between(rov, DIVER, shark)
        if beside <= BESIDE_M and LEAST <= along <= MOST:
            self.held_from = time if self.held_from is None else self.held_from
            if self.blocked_s is None and time - self.held_from >= HELD_S - 1e-9:
                self.blocked_s = self.held_from
        elif self.blocked_s is None:
            self.held_from = None
        return along, beside


def _from_recording(s, tools, record, times):
    """When the shark was blocked, by the program's replay of the run's recording: at the same instants, by its log."""
    log = os.path.join(tools.folder, "replayed.csv")
    tools.neritic("dive", "--replay", record + ".mcap", "--headless", "--log", log, "--log-rate", s["physics_hz"], "-q")
    with open(log, encoding="utf-8") as file:
        rows = {round(float(r["time_s"]), 4): r for r in csv.DictReader(file) if r["vehicle"] == "rov"}
    judge = Judge()
    for time in times:
        row = rows.get(round(time, 4))
        if row is None:
            raise Failed(f"the replay's log has no line at {time:g} s")
        judge.see(time, np.array([float(row["x_m"]), -float(row["z_m"]), float(row["y_m"])]), _shark_at(s, time)[0])
    return judge.blocked_s


def _word_s(s, seed):
    """When the detector says "shark": its first look that does not miss, after its latency."""
    look = 0
    while draw(seed, f"look {look}", 0.0, 1.0) < s["detector_miss"]:
        look += 1
    return 0.1 * look + s["detector_latency_s"]


def run(s, seed, tools):
    neritic = tools.python()
    shark, _ = _shark_at(s, 0.0)
    bearing = math.radians(s["shark_bearing_deg"])
    about = math.radians(s["offset_angle_deg"])
    across = np.array([math.cos(bearing) * math.cos(about), -math.sin(bearing) * math.cos(about), math.sin(about)])
    rov = 0.5 * (DIVER + shark) + s["offset_m"] * across
    file = "bluerov2_heavy_survey_dynamics.toml" if s["navigation"] == "measured" else "bluerov2_heavy_dynamics.toml"
    current = (f'[current]\nkind = "uniform"\nvelocity_m_s = [{s["current_m_s"]!r}, 0, 0]' if s["current_m_s"] else "")
    # A scene's yaw is to port from north; a bearing is to starboard.
    looks, sounds = s["detector"] != "assumed", s["shark_known_by"] == "sonar"
    models = os.path.join(SHIPPED, "..", "models")
    scene = tools.write("scene.toml", SCENE.format(
        seen=SEEN.format(fov=CROP_DEG, **s) if looks else "",
        shark_drawn=f'model = "{models}/shark.glb"\nclip = "swim"' if looks or sounds else 'shape = "sphere"',
        sonar=SONAR.format(**s) if sounds else "",
        rov_drawn=f'model = "{models}/rov.glb"' if looks else 'shape = "box"\nsize_m = [0.457, 0.254, 0.575]',
        seed=seed, physics_hz=s["physics_hz"], current=current, shark=_scene_of_enu(shark), rov=_scene_of_enu(rov),
        vehicle=os.path.join(SHIPPED, "..", "vehicles", file), navigation=s["navigation"],
        yaw=-(s["shark_bearing_deg"] + s["heading_deg"])))
    world = neritic.open(scene, seed=seed)
    gaze = Gaze(world, s, seed) if looks else None
    track = SonarTrack(world, s) if sounds else None
    ship, told_s = world["rov"], math.inf if looks else _word_s(s, seed) + s["delay_s"]
    every = max(1, int(round(s["physics_hz"] / s["control_hz"])))
    judge, in_sight, beside_after, force, seen_at = Judge(), [], [], 0.0, []
    series = {"t": [], "beside": [], "along": []}
    recording, record = contextlib.ExitStack(), os.path.join(tools.folder, "run")
    if s["from_recording"]:
        recording.enter_context(world.record(record))
    world["diver"].pose(DIVER)
    # Told control_hz times a second; judged at least 20 times a second.
    part, next_told = min(every, max(1, int(round(s["physics_hz"] / 20)))), 0
    while world.time < s["seconds"] - 1e-9:
        time = world.time
        shark, speed = _shark_at(s, time)
        heading = math.atan2(speed[1], speed[0]) if np.hypot(*speed[:2]) > 1e-6 else math.atan2(-shark[1], -shark[0])
        world["shark"].pose(shark, [0.0, 0.0, math.sin(heading / 2), math.cos(heading / 2)], velocity=speed)
        if looks and not math.isfinite(told_s) and time >= 0.1 * gaze.looks - 1e-9:
            if gaze.sees_shark(shark):
                told_s = time + s["detector_latency_s"] + s["delay_s"]
        if world.step >= next_told:
            next_told = world.step + every
            if time >= told_s - 1e-9:
                at, moves = track.estimate(shark) if sounds else (shark, speed)
                middle = 0.5 * (DIVER + at)
                ship.goto(*middle, math.atan2(at[1] - middle[1], at[0] - middle[0]), velocity=0.5 * moves)
        world.tick(part)
        truth, time = world.truth("rov"), world.time
        shark, _ = _shark_at(s, time)
        along, beside = judge.see(time, truth.position, shark)
        seen_at.append(time)
        force = max(force, float(np.abs(truth.thruster_n).max()))
        series["t"].append(round(time, 4))
        series["beside"].append(round(beside, 4))
        series["along"].append(round(along, 4))
        if judge.held_from is not None:
            in_sight.append(_in_sight(truth, shark))
            beside_after.append(beside)
        if judge.blocked_s is not None and time >= judge.blocked_s + 2.0:
            break
    blocked_s = judge.blocked_s
    recording.close()
    world.close()
    looked = {}
    if looks:
        gaze.close()
        looked = {"looks": gaze.looks, "wrong_words": gaze.wrong, "look_ms": 1e3 * float(np.median(gaze.work_s or [0.0]))}
    if s["from_recording"]:
        looked["same_from_recording"] = _from_recording(s, tools, record, seen_at) == blocked_s
    if sounds and track.errors:
        looked["track_error_m"] = float(np.sqrt(np.mean(np.square(track.errors))))
    measures = {**looked, "blocked": blocked_s is not None, "blocked_in_3_s": blocked_s is not None and blocked_s <= 3.0,
                "largest_force_n": force}
    if blocked_s is not None:
        measures |= {"time_to_block_s": blocked_s, "time_of_motion_s": blocked_s - told_s,
                     "shark_in_sonar": float(np.mean(in_sight)),
                     "beside_rms_m": float(np.sqrt(np.mean(np.square(beside_after))))}
    return measures, series


def _in_sight(truth, shark):
    """Whether the shark is in the sonar's wedge: ahead of the ROV, 90 x 28 degrees, to 10 m."""
    x, y, z, w = truth.orientation
    turn = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
    ahead, left, up = turn.T @ (shark - truth.position)
    return bool(math.hypot(ahead, left, up) <= 10.0 and abs(math.atan2(left, ahead)) <= math.radians(45)
                and abs(math.atan2(up, math.hypot(ahead, left))) <= math.radians(14))


def files(settings):
    """The files that decide a run's numbers, beside the settings."""
    return () if settings["detector"] == "assumed" else looking.files_of(model_of(settings["detector"]))


def check(settings):
    """Refuses a detector that is not there, before anything runs."""
    files(settings)


def _paired(results):
    """(mean time, deviation of the differences by seed) of the first two conditions; None where there are not two."""
    import summary
    groups = [{r["seed"]: r["measures"]["time_to_block_s"] for r in group if "time_to_block_s" in r["measures"]}
              for _, group in summary.by_condition(results)[:2]]
    seeds = sorted(set(groups[0]) & set(groups[1])) if len(groups) == 2 else []
    if len(seeds) < 6:
        return None
    return float(np.mean(list(groups[0].values()))), float(np.std([groups[1][k] - groups[0][k] for k in seeds], ddof=1))


def notes(results):
    """Lines for the report."""
    import intervals
    import summary
    for condition, group in summary.by_condition(results):
        times = summary.values_of(group, "time_to_block_s")
        runs = intervals.runs_to_tell(times) if len(times) >= 6 else None
        if runs:
            name = ", ".join(f"{k} {v}" for k, v in condition.items()) or "all runs"
            yield (f"{name}: {runs} runs a group tell a time to block that is 10 % longer, with a power of 80 % at 5 % (two-sided, "
                   f"unpaired); by drawing groups of {max(runs, 20)} from these runs the power is "
                   f"{100 * intervals.power_by_draws(times, max(runs, 20)):.0f} %.")
    spread = _paired(results)
    if spread is not None:
        pairs = math.ceil(((intervals.Z95 + intervals.normal_quantile(0.8)) * spread[1] / (0.1 * spread[0])) ** 2)
        yield (f"With the same seeds in both conditions, by the spread of the differences between the first two, {max(2, pairs)} "
               "pairs tell it: compare conditions by factors, not by two experiments.")


def figures(scenario, results, style):
    done = [r for r in results if r["series"]]
    if not done:
        return
    groups = {}
    for r in done:
        groups.setdefault(", ".join(f"{k} {v}" for k, v in r["condition"].items()) or "all runs", []).append(r)
    fig = style.figure(900, 640)
    top = style.area(fig, 70, 60, 870, 320)
    for i, (name, runs) in enumerate(list(groups.items())[:6]):
        for k, r in enumerate(runs[:30]):
            top.plot(r["series"]["t"], r["series"]["beside"], color=style.color(i), lw=0.8, alpha=0.6, ls=LINES[i],
                     label=name if k == 0 else None)
    top.axhline(BESIDE_M, color=style.INK, lw=0.9, ls="--")
    top.set_xlabel("time since the gaze met the shark, s")
    top.set_ylabel("beside the line, m")
    style.title(top, "Distance of the ROV from the line between diver and shark")
    style.legend(top)
    left = style.area(fig, 70, 400, 450, 590)
    for i, (name, runs) in enumerate(list(groups.items())[:6]):
        times = sorted(r["measures"]["time_to_block_s"] for r in runs if "time_to_block_s" in r["measures"])
        if times:
            left.step([0, *times], np.arange(len(times) + 1) / len(runs), where="post", color=style.color(i), lw=1.4,
                      ls=LINES[i])
    left.set_xlim(0, None)
    left.set_ylim(0, 1.03)
    left.set_xlabel("time to block, s")
    style.title(left, "Share of the runs that blocked by then")
    right = style.area(fig, 520, 400, 870, 590)
    import intervals
    for i, (name, runs) in enumerate(list(groups.items())[:6]):
        times = [r["measures"]["time_to_block_s"] for r in runs if "time_to_block_s" in r["measures"]]
        if len(times) >= 6:
            n = np.unique(np.geomspace(2, 2000, 120).astype(int))
            right.plot(n, [intervals.power_of(times, int(k)) for k in n], color=style.color(i), lw=1.4, ls=LINES[i])
            drawn = [20, 60, 200, 600, 2000]
            right.plot(drawn, [intervals.power_by_draws(times, k) for k in drawn], "o", color=style.color(i), ms=4.5,
                       mec=style.INK, mew=0.5)
    spread = _paired(results)
    if spread is not None:
        mean, deviation = spread
        n = np.unique(np.geomspace(2, 2000, 120).astype(int))
        right.plot(n, [intervals.normal_share(0.1 * mean * math.sqrt(k) / max(deviation, 1e-12) - intervals.Z95) for k in n],
                   color=style.INK, lw=1.2, ls=":")
        right.text(0.35, 0.06, "dotted: the same seeds in both groups", transform=right.transAxes, size=7.5)
    right.set_xscale("log")
    style.plain_log(right.xaxis)
    right.axhline(0.8, color=style.INK, lw=0.9, ls="--")
    right.set_ylim(0, 1.03)
    right.set_xlabel("runs a group")
    style.title(right, "Power to tell 10 % more time to block (dots: by draws)", 8.5)
    yield "shark.png", "The ROV's distance from the line over time, times to block, and the power of so many runs", fig
