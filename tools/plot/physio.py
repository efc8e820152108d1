"""The pictures of recordings of a diver (`neritic physio --plot`): heart, breath and gaze."""
import numpy as np
from matplotlib.patches import Patch

from style import (BLUE, GREEN, GREY, INK, ORANGE, RED, area, figure, heading, legend, numbers, room, time_axis,
                   title)

WIDE, HIGH = 1600, 1000


def page(data):
    fig = figure(WIDE, HIGH)
    return fig, heading(fig, data["title"], data["facts"]) + 30


def each(rows, key):
    return numbers([row[key] for row in rows])


def draw_ecg(data):
    fig, top = page(data)
    ax, cut = area(fig, 80, top, WIDE - 30, 460), data["excerpt"]
    time, value = numbers(cut["time_s"]), numbers(cut["value"])
    ax.plot(time, value, color=GREY, lw=1.0, label="ECG")
    for name, hue, odd in (("beat", BLUE, False), ("ectopic beat", RED, True)):
        beats = [b for b in cut["beats"] if (b["kind"] == "ectopic") == odd]
        if beats:
            ax.plot(each(beats, "at_s"), each(beats, "at_value"), "o", color=hue, ms=6, label=name)
    if len(time):
        ax.set_xlim(time[0], time[-1])
    room(ax, [value], 1e-6)
    ax.set_xlabel("time, s")
    ax.set_ylabel((cut["signal"] or "ECG") + ", as recorded")
    title(ax, "Ten seconds" + (", around the first ectopic beat" if any(b["kind"] == "ectopic" for b in cut["beats"]) else ""), 11)
    legend(ax, 9)

    intervals = data["intervals"]
    normal = [i for i in intervals if i["kind"] == "normal"]
    odd = [i for i in intervals if i["kind"] != "normal"]
    ax = area(fig, 80, 560, 810, HIGH - 60)
    ax.plot(each(normal, "end_s"), each(normal, "rr_ms"), ".", color=BLUE, ms=4, label="normal")
    if odd:
        ax.plot(each(odd, "end_s"), each(odd, "rr_ms"), "x", color=RED, ms=6, label="ectopic, and the pause after")
    room(ax, [each(intervals, "rr_ms")], 100)
    time_axis(ax, max([i["end_s"] for i in intervals], default=1.0))
    ax.set_ylabel("interval, ms")
    title(ax, "Intervals between beats", 11)
    legend(ax, 9)

    spectrum = data["spectrum"]
    pairs = [i for i in intervals if i["before_ms"] is not None]
    ax = area(fig, 900, 560, 1245 if spectrum else WIDE - 30, HIGH - 60)
    before, after = each(pairs, "before_ms"), each(pairs, "rr_ms")
    room(ax, [before, after], 100)
    low, high = ax.get_ylim()
    ax.set_xlim(low, high)
    ax.plot([low, high], [low, high], color=GREY, lw=0.8, ls=(0, (4, 3)), label="equal")
    ax.plot(before, after, ".", color=BLUE, ms=4, label="normal pairs")
    ax.set_xlabel("interval, ms")
    ax.set_ylabel("next interval, ms")
    title(ax, "Each and the next", 11)
    legend(ax, 9)

    if spectrum:
        ax = area(fig, 1325, 560, WIDE - 30, HIGH - 60)
        values = [spectrum[key] for key in ("vlf_ms2", "lf_ms2", "hf_ms2")]
        ax.bar(["VLF", "LF", "HF"], values, 0.6, color=[GREY, ORANGE, BLUE])
        for i, value in enumerate(values):
            ax.annotate(f"{value:.0f}" if value >= 100 else f"{value:.3g}", (i, value), (0, 4), textcoords="offset points", ha="center", size=8.5)
        ax.set_ylim(0, 1.12 * max(values + [1e-9]))
        ax.grid(axis="x", visible=False)
        ax.set_ylabel("ms²")
        title(ax, f"Power; LF/HF {spectrum['lf_over_hf']:.2f}", 11)
    return fig


def draw_breath(data):
    fig, top = page(data)
    seconds = data["seconds"]
    ax = area(fig, 80, top, WIDE - 30, 460)
    ax.plot(data["level"]["time_s"], data["level"]["db"], color=GREY, lw=0.9)
    room(ax, [numbers(data["level"]["db"])], 10)
    time_axis(ax, seconds)
    ax.set_ylabel("dB of full scale")
    title(ax, "Level of the sound, 100 to 2000 Hz", 11)
    shade(ax, data)

    ax = area(fig, 80, 560, WIDE - 30, HIGH - 60)
    shades = shade(ax, data)
    lines = []
    if data["reference_bpm"] is not None:
        lines += [ax.axhline(data["reference_bpm"], color=GREEN, lw=1.6, ls=(0, (6, 3)), label="reference")]
    plain, found = data["plain_spectrum"], data["estimates"]
    lines += ax.plot(each(plain, "at_s"), each(plain, "rate_bpm"), "o-", color=ORANGE, lw=1.0, ms=4,
                     label=f"plain spectrum, {data['block_s']:g} s")
    lines += ax.plot(each(found, "at_s"), each(found, "rate_bpm"), "o-", color=BLUE, lw=2.0, ms=6, label=data["estimator"])
    rates = np.concatenate([each(found, "rate_bpm"), each(plain, "rate_bpm"), [data["reference_bpm"] or 0, 20]])
    ax.set_ylim(0, max(45, 1.1 * np.nanmax(rates)))
    time_axis(ax, seconds)
    ax.set_ylabel("breaths/min")
    title(ax, "Breaths a minute", 11)
    legend(ax, 9, lines + shades)
    return fig


def shade(ax, data):
    """Where an estimate is no rate: no breath since when (red), or not sure of one (grey)."""
    before, shaded, handles = 0.0, 0.0, {}
    for one in data["estimates"]:
        if one["rate_bpm"] is None:
            quiet = one["quiet_s"] >= data["pause_heard_s"]
            since = min(before, max(one["at_s"] - one["quiet_s"], 0.0)) if quiet else before
            words, hue, alpha = ("no breath heard", RED, 0.16) if quiet else ("rate not known", INK, 0.08)
            since, shaded = max(since, shaded), one["at_s"]
            ax.axvspan(since, one["at_s"], color=hue, alpha=alpha, lw=0)
            handles[words] = Patch(color=hue, alpha=2 * alpha, label=words)
        before = one["at_s"]
    return list(handles.values())


def draw_gaze(data):
    fig, top = page(data)
    time, x, y = (numbers(data[key]) for key in ("time_s", "x_deg", "y_deg"))
    fixed = data["fixations"]
    ax = area(fig, 80, top, WIDE - 30, 460)
    lines = ax.plot(time, x, color=BLUE, lw=0.9, label="x, to the right") + ax.plot(time, y, color=ORANGE, lw=0.9, label="y, up")
    for axis in ("mean_x_deg", "mean_y_deg"):
        held = ax.hlines(each(fixed, axis), each(fixed, "start_s"), each(fixed, "end_s"), color=INK, lw=2.4, zorder=5,
                         label="fixation's mean")
    handles = lines + ([held] if fixed else [])
    for blink in data["blinks"]:
        band = ax.axvspan(blink["start_s"], blink["end_s"], color=GREY, alpha=0.3, lw=0, label="blink")
    handles += [band] if data["blinks"] else []
    room(ax, [x, y], 1)
    if len(time):
        ax.set_xlim(time[0], max(time[-1], time[0] + 1e-3))
    ax.set_xlabel("time, s")
    ax.set_ylabel("degrees")
    title(ax, "Direction of the gaze", 11)
    legend(ax, 9, handles)

    ax = area(fig, 80, 560, 810, HIGH - 60)
    ax.plot(x, y, color=GREY, lw=0.7, alpha=0.5, label="path")
    if fixed:
        length = each(fixed, "end_s") - each(fixed, "start_s")
        ax.scatter(each(fixed, "mean_x_deg"), each(fixed, "mean_y_deg"), s=25 + 400 * length / max(length.max(), 1e-9),
                   color=BLUE, alpha=0.5, lw=0, zorder=5, label="fixations, area by their time")
    ax.set_aspect("equal", adjustable="datalim")
    ax.set_xlabel("x, degrees")
    ax.set_ylabel("y, degrees")
    title(ax, "Where it went", 11)
    legend(ax, 9)

    ax, saccades = area(fig, 900, 560, WIDE - 30, HIGH - 60), data["saccades"]
    ax.plot(each(saccades, "amplitude_deg"), each(saccades, "peak_deg_s"), "o", color=ORANGE, ms=5, alpha=0.8)
    ax.set_xlim(0, 1.08 * max([s["amplitude_deg"] for s in saccades], default=1.0))
    ax.set_ylim(0, 1.12 * max([s["peak_deg_s"] for s in saccades], default=1.0))
    ax.set_xlabel("size, degrees")
    ax.set_ylabel("peak speed, degrees/s")
    title(ax, "Saccades: peak speed over size", 11)
    return fig


PAINTERS = {"physio ecg": draw_ecg, "physio breath": draw_breath, "physio gaze": draw_gaze}
