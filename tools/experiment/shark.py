"""The published task: a diver sees a shark, a detector names what the diver looks at, and the ROV puts itself between
them and keeps the shark in its sonar. The ROV flies by its own thrusters, control and, if asked, its own sensors.

Blocked: the ROV's projection on the line from diver to shark lies in [0.1, 0.9] of it, and the ROV is at most 0.35 m
beside it, for 1 s; the time counts to the beginning of that second, from when the diver's gaze met the shark.
"""
import math
import os

import numpy as np

from scenario import SHIPPED, Failed, Setting, draw

SETTINGS = {
    "offset_m": Setting(1.0, "the ROV's start beside the line from diver to shark, at its middle", 0.0, 10.0),
    "offset_angle_deg": Setting(0.0, "its direction about that line: 0 level, 90 above", -180.0, 180.0),
    "shark_range_m": Setting(6.0, "from the diver, at the start", 2.0, 30.0),
    "shark_bearing_deg": Setting(0.0, "from north over east", -180.0, 180.0),
    "shark_speed_m_s": Setting(0.3, "of its approach", 0.0, 5.0),
    "shark_circling_m_s": Setting(0.1, "across the line, to its left", -5.0, 5.0),
    "delay_s": Setting(0.0, "injected between the detector's word and the ROV", 0.0, 10.0),
    "detector_latency_s": Setting(0.0, "from the gaze to the detector's word", 0.0, 10.0),
    "detector_miss": Setting(0.0, "share of its looks, ten a second, in which it misses the shark", 0.0, 0.99),
    "heading_deg": Setting(0.0, "the ROV's heading at the start, relative to the shark's bearing", -180.0, 180.0),
    "navigation": Setting("truth", "the ROV flies by its true state or by what its sensors measure", words=["truth", "measured"]),
    "current_m_s": Setting(0.0, "of the water, towards east", -2.0, 2.0),
    "physics_hz": Setting(240, "steps a second", 60, 1000, whole=True),
    "control_hz": Setting(20.0, "how often the ROV is told its place", 1.0, 240.0),
    "seconds": Setting(8.0, "of a run at most", 1.0, 120.0),
}
MEASURES = {
    "blocked": ("yes or no", "whether the ROV blocked the shark at all"),
    "blocked_in_3_s": ("yes or no", "whether it did within 3.0 s"),
    "time_to_block_s": ("s", "of the runs that blocked"),
    "time_of_motion_s": ("s", "the same without the detector's latency and the injected delay"),
    "shark_in_sonar": ("", "share of the time after the block in which the shark is in the sonar's sight (90 x 28 degrees, 10 m)"),
    "beside_rms_m": ("m", "distance from the line over the 2 s after the block"),
    "largest_force_n": ("N", "largest force of a thruster"),
}
BESIDE_M, HELD_S, LEAST, MOST = 0.35, 1.0, 0.1, 0.9
SCENE = """title = "A shark, a diver, an ROV"
seed = {seed}
[physics]
rate_hz = {physics_hz}
{current}
[[objects]]
name = "diver"
class = "diver"
shape = "sphere"
position_m = [0, -10, 0]
inputs = {{ pose = {{ from = "python", hold_s = 3600 }} }}
[[objects]]
name = "shark"
class = "shark"
shape = "sphere"
position_m = {shark}
inputs = {{ pose = {{ from = "python", hold_s = 3600 }} }}
[[vehicles]]
name = "rov"
shape = "box"
size_m = [0.457, 0.254, 0.575]
dynamics = "{vehicle}"
navigation = "{navigation}"
position_m = {rov}
yaw_deg = {yaw!r}
mission = {{ hold = "station" }}
"""


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


DIVER = np.array([0.0, 0.0, -10.0])


def between(rov, diver, shark):
    """(along, beside): the ROV's projection on the line as a share of it, and its distance from the line in metres."""
    line = shark - diver
    along = float((rov - diver) @ line / (line @ line))
    return along, float(np.linalg.norm(rov - diver - along * line))


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
    scene = tools.write("scene.toml", SCENE.format(
        seed=seed, physics_hz=s["physics_hz"], current=current, shark=_scene_of_enu(shark), rov=_scene_of_enu(rov),
        vehicle=os.path.join(SHIPPED, "..", "vehicles", file), navigation=s["navigation"],
        yaw=-(s["shark_bearing_deg"] + s["heading_deg"])))
    world = neritic.open(scene, seed=seed)
    ship, told_s = world["rov"], _word_s(s, seed) + s["delay_s"]
    every = max(1, int(round(s["physics_hz"] / s["control_hz"])))
    held_from, blocked_s, in_sight, beside_after, force = None, None, [], [], 0.0
    series = {"t": [], "beside": [], "along": []}
    world["diver"].pose(DIVER)
    steps = int(round(s["seconds"] * s["physics_hz"]))
    for step in range(0, steps, every):
        time = step / s["physics_hz"]
        shark, speed = _shark_at(s, time)
        world["shark"].pose(shark, velocity=speed)
        if time >= told_s - 1e-9:
            middle = 0.5 * (DIVER + shark)
            yaw = math.atan2(shark[1] - middle[1], shark[0] - middle[0])
            ship.goto(*middle, yaw, velocity=0.5 * speed)
        world.tick(every)
        truth, time = world.truth("rov"), world.time
        shark, _ = _shark_at(s, time)
        along, beside = between(truth.position, DIVER, shark)
        force = max(force, float(np.abs(truth.thruster_n).max()))
        series["t"].append(round(time, 4))
        series["beside"].append(round(beside, 4))
        series["along"].append(round(along, 4))
        if beside <= BESIDE_M and LEAST <= along <= MOST:
            held_from = time if held_from is None else held_from
            if blocked_s is None and time - held_from >= HELD_S - 1e-9:
                blocked_s = held_from
        elif blocked_s is None:
            held_from = None
        if held_from is not None:
            in_sight.append(_in_sight(truth, shark))
            beside_after.append(beside)
        if blocked_s is not None and time >= blocked_s + 2.0:
            break
    world.close()
    measures = {"blocked": blocked_s is not None, "blocked_in_3_s": blocked_s is not None and blocked_s <= 3.0,
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
            top.plot(r["series"]["t"], r["series"]["beside"], color=style.color(i), lw=0.8, alpha=0.6,
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
                      ls=("-", "--", ":", "-.", (0, (1, 1)), (0, (5, 1)))[i])
    left.set_xlim(0, None)
    left.set_ylim(0, 1.03)
    left.set_xlabel("time to block, s")
    style.title(left, "Share of the runs that blocked by then")
    right = style.area(fig, 520, 400, 870, 590)
    import intervals
    for i, (name, runs) in enumerate(list(groups.items())[:6]):
        times = [r["measures"]["time_to_block_s"] for r in runs if "time_to_block_s" in r["measures"]]
        if len(times) >= 6:
            n = np.arange(2, 101)
            right.plot(n, [intervals.power_of(times, int(k)) for k in n], color=style.color(i), lw=1.4)
    right.axhline(0.8, color=style.INK, lw=0.9, ls="--")
    right.set_ylim(0, 1.03)
    right.set_xlabel("runs a group")
    style.title(right, "Power to tell a 10 % difference")
    yield "shark.png", "The ROV's distance from the line over time, times to block, and the power of so many runs", fig
