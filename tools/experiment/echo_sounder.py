"""The echo sounder of the published experiment: an ROV sinks from 20 m above the floor at 5 m/min for 180 s, in a heave
that it does or does not feel. The slope of range over time is the speed; on a slope the first return is the
perpendicular distance. The seed draws what a repeat would not have the same: how high the descent begins, and where in the heave."""
import csv
import math
import os

import numpy as np

import report
import summary
from scenario import SHIPPED, Setting, draw

SETTINGS = {
    "height_m": Setting(20.0, "above the floor at the start", 2.0, 40.0),
    "start_spread_m": Setting(0.05, "by which the seed sets the start higher or lower, at most", 0.0, 0.5),
    "speed_m_min": Setting(5.0, "downwards", 0.1, 60.0),
    "seconds": Setting(180.0, "of the descent", 5.0, 600.0),
    "rate_hz": Setting(2.0, "pings a second", 0.2, 20.0),
    "slope_deg": Setting(0.0, "of the floor", 0.0, 12.0),
    "heave_m": Setting(0.0, "amplitude of a heave of 8 s, whose beginning the seed draws", 0.0, 2.0),
    "bins": Setting(500, "range bins", 50, 4000, whole=True),
}
MEASURES = {
    "slope_m_s": ("m/s", "of range over time, by a line fitted to the first returns"),
    "slope_error_percent": ("%", "off the true speed"),
    "residual_rms_bins": ("range bins", "of the first returns about the line"),
    "first_return_bins": ("range bins", "largest error of a first return against the perpendicular distance"),
    "heave_rms_m_s": ("m/s", "heave velocity by the first returns less the true one, over 2 s windows"),
}
SCENE = """seed = {seed}
[[objects]]
name = "floor"
shape = "plane"
size_m = [400, 400]
class = "seabed"
position_m = [0, {floor!r}, 0]
roll_deg = {slope!r}
[[sonars]]
name = "sounder"
kind = "echosounder"
range_m = [0.5, {farthest!r}]
semi_angle_deg = 12.5
bins = [{bins}, 500, 500]
gbuffer_scale = 0.5
rate_hz = {rate!r}
pitch_deg = -90
track = {{ file = "descent.csv", heading = "fixed" }}
"""
MOST, LINES = 8, ("-", "--", ":", "-.")  # conditions of the figure, their lines
TOP_M = -5.0  # where the descent begins


def _depths(settings, seed, times):
    """(metres sunk, metres up by the heave and the start) at these seconds."""
    sunk = settings["speed_m_min"] / 60.0 * times
    start = draw(seed, "start", -1.0, 1.0) * settings["start_spread_m"]
    return sunk, start + settings["heave_m"] * np.sin(2 * math.pi * (times / 8.0 + draw(seed, "heave", 0.0, 1.0)))


def run(settings, seed, tools):
    pings = int(round(settings["seconds"] * settings["rate_hz"])) + 1
    times = np.arange(pings) / settings["rate_hz"]
    sunk, heave = _depths(settings, seed, times)
    # Finer than the pings, so that the heave's straight pieces are none.
    fine = np.arange(int(settings["seconds"] * 20) + 21) / 20.0
    fine_sunk, fine_heave = _depths(settings, seed, fine)
    tools.write("descent.csv", "t_s,x,y,z\n" + "".join(
        f"{t!r},0,{TOP_M - s + h!r},0\n" for t, s, h in zip(fine.tolist(), fine_sunk.tolist(), fine_heave.tolist())))
    farthest = settings["height_m"] + settings["heave_m"] + settings["start_spread_m"] + 2.0
    scene = tools.write("scene.toml", SCENE.format(
        seed=seed, floor=TOP_M - settings["height_m"], slope=settings["slope_deg"], farthest=farthest,
        bins=settings["bins"], rate=settings["rate_hz"]))
    tools.neritic("render", scene, "--frames", pings, "--track-only", "--out", tools.folder, "-q")
    trace = np.load(os.path.join(tools.folder, "track", "sounder", "echo_trace.npy"))
    bin_m = (farthest - 0.5) / settings["bins"]
    with open(os.path.join(tools.folder, "track", "sounder", "echo_trace.csv")) as file:
        rows = list(csv.DictReader(file))
    found = np.array([float(r["first_range_m"] or "nan") for r in rows])
    first = 0.5 + (trace > 0).argmax(axis=1) * bin_m + 0.5 * bin_m
    perpendicular = (settings["height_m"] - sunk + heave) * math.cos(math.radians(settings["slope_deg"]))
    line = np.polyfit(times[np.isfinite(found)], found[np.isfinite(found)], 1)
    true_slope = -settings["speed_m_min"] / 60.0 * math.cos(math.radians(settings["slope_deg"]))
    residual = found - np.polyval(line, times)
    measures = {"slope_m_s": float(line[0]), "slope_error_percent": float(abs(line[0] / true_slope - 1) * 100),
                "first_return_bins": float(np.nanmax(np.abs(first - perpendicular)) / bin_m)}
    if settings["heave_m"] == 0:
        measures["residual_rms_bins"] = float(np.sqrt(np.nanmean(residual ** 2)) / bin_m)
    # Velocity by lines over 2 s.
    window = max(3, int(round(2.0 * settings["rate_hz"])) | 1)
    middle = [np.polyfit(times[i:i + window], found[i:i + window], 1)[0] for i in range(pings - window + 1)]
    true = [np.polyfit(times[i:i + window], perpendicular[i:i + window], 1)[0] for i in range(pings - window + 1)]
    measures["heave_rms_m_s"] = float(np.sqrt(np.nanmean((np.array(middle) - np.array(true)) ** 2)))
    keep = slice(None, None, max(1, pings // 400))
    return measures, {"t": times[keep].tolist(), "range": found[keep].round(5).tolist(),
                      "true": perpendicular[keep].round(5).tolist()}


def figures(scenario, results, style):
    done = [r for r in results if r["series"]]
    if not done:
        return
    # The first run of each condition.
    groups = [(c, runs) for c, runs in summary.by_condition(results) if any(r["series"] for r in runs)]
    names = report.names([c for c, _ in groups])
    shown = [next(r for r in runs if r["series"]) for _, runs in groups][:MOST]
    fig = style.figure(900, 430 + 110 * len(shown))
    top = style.area(fig, 70, 50, 870, 330)
    for i, r in enumerate(shown):
        t, found = (style.numbers(r["series"][k]) for k in ("t", "range"))
        top.plot(t, found, color=style.color(i), lw=2.0, ls=LINES[i % len(LINES)], label=names[i] if len(groups) > 1 else "first return")
    top.invert_yaxis()
    top.set_xlabel("time, s")
    top.set_ylabel("range of the first return, m")
    style.title(top, "The descent")
    style.legend(top, handle=3.5)
    errors = [1000 * (style.numbers(r["series"]["range"]) - style.numbers(r["series"]["true"])) for r in shown]
    for i, (r, error) in enumerate(zip(shown, errors)):
        low = style.area(fig, 70, 410 + 110 * i, 870, 475 + 110 * i)
        low.plot(style.numbers(r["series"]["t"]), error, color=style.BLUE, lw=1.2)
        style.room(low, errors, 0.01)
        low.set_ylabel("error, mm")
        style.title(low, "First return less the perpendicular distance" + (f": {names[i]}" if len(groups) > 1 else ""), 9)
    low.set_xlabel("time, s")
    told = f"Seed {shown[0]['seed']}. " + report.left_out(len(shown), len(groups), "conditions")
    fig.text(24 / 900, 6 / (430 + 110 * len(shown)), told, size=8, color=style.INK)
    yield "echo_sounder.png", "Range of the first return over the descent, and its error, of one run a condition. " + told, fig
