"""The picture of a dive (`neritic dive --plot`): its story on one page. Large: depth over time with
ceiling, stops, the wanted path, the ground below and whatever endangered a diver; of vehicles the path
from above too. Small, beneath: gas, pace and risks of each diver; error and thruster load of vehicles.
The small panels are in dive_panels.py; all others follow on request: `python3 tools/plot F.plot.json --all`.
"""
import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patheffects import withStroke

from dive_panels import RESERVE_BAR, diver_story, draw_more, height_of_more, vehicle_story
from style import (GREY, INK, PAPER, PINK, RED, SAND, area, color, figure, fit, gaps, heading, legend, notes, numbers,
                   section, short, time_axis, title)

MOST_DIVERS, MOST_VEHICLES = 2, 3  # that have small panels of their own
MOST_STRIPS = 12
ROW_PX, PANEL_PX = 222, 130  # heights of one's small panels, with words and alone
WANTED = dict(color="#f0b93a", lw=5.5, path_effects=[withStroke(linewidth=6.8, foreground=INK)], zorder=3,
              solid_capstyle="butt")  # a broad band, the flown path runs thin on it

# Dangers to a diver: words, colour, and the rows in which each holds.
DANGERS = (
    ("nothing to breathe", INK, lambda d: numbers(d["out_of_gas"]) > 0),
    ("above the ceiling", "#8c1a8c", lambda d: numbers(d["ceiling_violated"]) > 0),
    ("rises dangerously fast", RED, lambda d: numbers(d["ascent_alarm"]) == 2),
    ("rises fast", "#ee6a5a", lambda d: numbers(d["ascent_alarm"]) == 1),
    ("oxygen risk high", "#007a52", lambda d: numbers(d["oxygen_high"]) > 0),
    ("CO2, narcosis, density or breath: risk high", "#b87a00", lambda d: numbers(d["risk_high"]) > 0),
)


def danger_lines(diver):
    """One line for each danger that there was, as the summary has it."""
    name, dangers = diver["name"], diver["dangers"]
    out = []
    if dangers["out_of_gas"]:
        d = dangers["out_of_gas"]
        out.append(f"{name}: NOTHING TO BREATHE for {d['seconds']:.0f} s, from {d['from_s']:.0f} s on ({d['tank']})")
    if dangers["ascent_alarm"]:
        d = dangers["ascent_alarm"]
        out.append(f"{name}: ascent too fast, up to {dangers['fastest_ascent_m_min']:.0f} m/min at "
                   f"{d['fastest_at_s']:.0f} s ({d['worst']} alarm for {d['seconds']:.0f} s)")
    if dangers["ceiling_violation"]:
        d = dangers["ceiling_violation"]
        out.append(f"{name}: ceiling violated from {d['from_s']:.0f} s on, by up to {d['worst_m']:.1f} m")
    if dangers["oxygen_risk"]:
        d = dangers["oxygen_risk"]
        out.append(f"{name}: oxygen risk {d['worst']} from {d['from_s']:.0f} s on, "
                   f"{d['least_po2_bar']:.2f} to {d['most_po2_bar']:.2f} bar breathed")
    return out


def mean_depth(diver):
    """Over time, of the rows that the data holds: they are not evenly spaced."""
    time, depth = numbers(diver["time_s"]), numbers(diver["depth_m"])
    span = np.diff(time)
    if span.sum() <= 0:
        return depth.mean()
    return float((0.5 * (depth[1:] + depth[:-1]) * span).sum() / span.sum())


def mark_depths(ax, divers, first_color, seconds):
    """Lines of mean depths, points of deepest ones; returns their labels."""
    items = []
    for i, diver in enumerate(divers[:MOST_DIVERS]):
        depth, hue = numbers(diver["depth_m"]), color(first_color + i)
        if not np.isfinite(depth).any():
            continue
        whose = f"{short(diver['name'])}: " if len(divers) > 1 else ""
        deepest, mean = int(np.nanargmax(depth)), mean_depth(diver)
        ax.axhline(mean, color=hue, lw=1.0, ls=(0, (1, 2)), zorder=2)
        ax.plot(diver["time_s"][deepest], depth[deepest], "v", color=hue, mec=INK, ms=7, zorder=8)
        items.append((diver["time_s"][deepest], depth[deepest], f"{whose}deepest {depth[deepest]:.1f} m", hue, True))
        items.append((0.985 * seconds, mean, f"{whose}mean {mean:.1f} m", hue, True))
    return items


def shade_alarms(ax, divers, seconds):
    """The rows of dangers beneath have their words, in the same colours."""
    least = 0.002 * seconds  # so that a moment is seen
    for level, hue in ((1, "#ee6a5a"), (2, RED)):
        for diver in divers:
            for at, long in gaps(diver["time_s"], numbers(diver["ascent_alarm"]) == level):
                ax.axvspan(at, at + max(long, least), color=hue, alpha=0.22, lw=0, zorder=0.5)


def draw_depth(ax, data, strips, seconds):
    vehicles, divers = data["vehicles"], data["humans"]
    shown = []
    for i, one in enumerate(vehicles):
        depth = numbers(one["depth_m"])
        if one["wanted_depth_m"] is not None:
            wanted = numbers(one["wanted_depth_m"])
            ax.plot(one["time_s"], wanted, **WANTED, label="wanted" if i == 0 else "_")
            shown.append(wanted)
        ax.plot(one["time_s"], depth, color=color(i), lw=1.8, label=short(one["name"]) if i < 6 else "_", zorder=4)
        shown.append(depth)
    for i, diver in enumerate(divers):
        depth, hue = numbers(diver["depth_m"]), color(len(vehicles) + i)
        ax.plot(diver["time_s"], depth, color=hue, lw=2.4, label=short(diver["name"]) if i < 6 else "_", zorder=4)
        shown.append(depth)
        ceiling, stop = numbers(diver["ceiling_m"]), numbers(diver["stop_m"])
        if np.nanmax(ceiling, initial=0) > 0:
            ax.fill_between(diver["time_s"], 0, ceiling, color=RED, alpha=0.13, lw=0, zorder=1)
            ax.plot(diver["time_s"], np.where(ceiling > 0, ceiling, np.nan), color=RED, lw=1.2,
                    label="ceiling" if i == 0 else "_")
            shown.append(ceiling[ceiling > 0])
        if np.nanmax(stop, initial=0) > 0:
            ax.plot(diver["time_s"], np.where(stop > 0, stop, np.nan), color=PINK, lw=1.6, ls=(0, (2, 2)),
                    label="next stop" if i == 0 else "_")
            shown.append(stop[stop > 0])
    values = np.concatenate(shown) if shown else np.zeros(1)
    values = values[np.isfinite(values)]
    low, high = (values.min(), values.max()) if len(values) else (0.0, 1.0)
    # The surface and the ground belong to the picture where they are not far.
    if low < 0.6 * (high - low) + 3 or any(np.nanmax(numbers(d["ceiling_m"]), initial=0) > 0 for d in divers):
        low = min(low, 0.0)
    bottom = high
    for one in vehicles + divers:
        ground = numbers(one["ground_depth_m"])
        if np.isfinite(ground).any() and np.nanmax(ground) - high < max(1.2 * (high - low), 5):
            bottom = max(bottom, np.nanmax(ground))
    margin = max(0.06 * (bottom - low), 0.1)
    ax.set_ylim(bottom + margin, low - margin if low < 0 else max(low - margin, 0) if low > 0 else -0.02 * bottom)
    for i, one in enumerate((divers + vehicles)[:1]):
        ground = numbers(one["ground_depth_m"])
        if np.isfinite(ground).any() and np.nanmin(ground) < bottom + margin:
            ax.fill_between(one["time_s"], ground, bottom + margin, color=SAND, alpha=0.45, lw=0, zorder=0,
                            label=f"ground below {short(one['name'])}")
    shade_alarms(ax, divers, seconds)
    handles = ax.get_legend_handles_labels()[0]
    for _, hue, _, time, depth in strips:
        ax.plot(time, depth, color=hue, lw=5, zorder=6, solid_capstyle="butt")
    time_axis(ax, seconds)
    ax.set_ylabel("depth, m")
    title(ax, "Depth over time", 11)
    legend(ax, 9, handles)
    marks = mark_depths(ax, divers, len(vehicles), seconds)
    events = [(w["at_s"], w["at_depth_m"], str(w["number"]), INK, True) for v in vehicles[:1] for w in v["waypoints"]]
    for diver in divers:
        events += [(s["at_s"], s["depth_m"], "to " + s["to"], INK, True) for s in diver["gas_switches"][:8]]
    ax.plot([i[0] for i in events], [i[1] for i in events], "o", color=INK, ms=4.5, zorder=8)
    notes(ax, marks + events, 8.5)


def danger_strips(data):
    """For each danger that was met: words, colour, its times, and the line of depth it lies on."""
    strips = []
    for diver in data["humans"]:
        time, depth = numbers(diver["time_s"]), numbers(diver["depth_m"])
        who = f"{diver['name']}: " if len(data["humans"]) > 1 else ""
        for words, hue, holds in reversed(DANGERS):
            flags = holds(diver)
            if flags.any():
                strips.append((who + words, hue, gaps(time, flags), time, np.where(flags, depth, np.nan)))
    return strips[-MOST_STRIPS:]


def draw_strips(ax, strips, seconds):
    """One row a danger, under the depth; its words stand beside its first or last time if there is room, else on it."""
    time_axis(ax, seconds, False)
    ax.set_ylim(0, len(strips))
    ax.set_yticks([])
    ax.spines["left"].set_visible(False)
    ax.tick_params(axis="x", labelbottom=False)
    least = 0.003 * seconds  # so that a moment is seen
    pixel = ax.get_xlim()[1] / ax.get_window_extent().width
    for i, (words, hue, spans, _, _) in enumerate(strips):
        spans = [(a, max(b, least)) for a, b in spans]
        ax.broken_barh(spans, (i + 0.1, 0.8), color=hue, lw=0)
        text = ax.text(0, i + 0.5, words, color=hue, size=8, va="center_baseline", zorder=5,
                       path_effects=[withStroke(linewidth=3, foreground=PAPER)])
        wide, begins, ends = text.get_window_extent().width * pixel, spans[0][0], sum(spans[0])
        after = min([a for a, _ in spans[1:]], default=ax.get_xlim()[1])
        last = sum(spans[-1])
        if after - ends > wide + 8 * pixel:
            text.set_x(ends + 4 * pixel)
        elif ax.get_xlim()[1] - last > wide + 8 * pixel:
            text.set_x(last + 4 * pixel)
        elif begins > wide + 8 * pixel:
            text.set_x(begins - wide - 4 * pixel)
        else:  # on the bar itself, where its own colour would not be read
            text.set_color(INK)


def draw_map(fig, ax, data, seconds):
    ground = data["ground"]
    title(ax, "Path from above", 11)
    ax.set_xlabel("east, m")
    ax.set_ylabel("north, m", labelpad=1)
    if ground is None:
        return
    west, north, side = ground["west_m"], ground["north_m"], ground["side_m"]
    ax.set_xlim(west, west + side)
    ax.set_ylim(north - side, north)
    if ground["depths_m"] is not None:
        depths = np.array([numbers(row) for row in ground["depths_m"]])
        low, high = np.nanmin(depths), np.nanmax(depths)
        image = ax.imshow(depths, extent=(west, west + side, north - side, north), cmap="bone", alpha=0.55,
                          vmin=low - 0.15 * max(high - low, 2.0), vmax=low + max(high - low, 2.0),
                          interpolation="nearest", zorder=0)
        x0, y0, wide, high_ = ax.get_position().bounds
        bar = fig.colorbar(image, cax=fig.add_axes([x0 + wide + 0.005, y0, 0.006, high_]))
        bar.ax.invert_yaxis()
        bar.ax.set_ylabel("depth of what is solid, m", size=8, labelpad=2)
        bar.outline.set_visible(False)
        ax.grid(False)
    items = []
    keys = [Line2D([], [], marker="o", ls="", mfc=PAPER, mec=INK, label="start"),
            Line2D([], [], marker="s", ls="", color=INK, label="end")]
    for i, one in enumerate(data["vehicles"] + data["humans"]):
        x, y = numbers(one["x_m"]), -numbers(one["z_m"])
        if not len(x):
            continue
        wanted = one.get("wanted_x_m")
        if wanted is not None:
            keys[2:] = ax.plot(numbers(wanted), -numbers(one["wanted_z_m"]), **WANTED, label="wanted")
        ax.plot(x, y, color=color(i), lw=1.8, zorder=4)
        ax.plot(x[0], y[0], "o", mfc=PAPER, mec=color(i), mew=1.6, ms=7, zorder=7)
        ax.plot(x[-1], y[-1], "s", color=color(i), ms=6.5, zorder=7)
        if i < 6:
            items.append((x[-1], y[-1], short(one["name"]), color(i), True))
    for w in data["vehicles"][0]["waypoints"] if data["vehicles"] else []:
        ax.plot(w["at_x_m"], -w["at_z_m"], "o", color=INK, ms=4, zorder=8)
        items.append((w["at_x_m"], -w["at_z_m"], f"{w['number']}: {clock(w['at_s'], seconds)}", INK, False))
    notes(ax, items, 8.5)
    legend(ax, 8.5, keys)


def clock(at_s, seconds):
    """A time as its axis shows it: seconds up to ten minutes, then minutes."""
    return f"{at_s:.0f} s" if seconds <= 600 else f"{at_s / 60:.0f} min"


def row_of_areas(fig, top, count):
    """Panels of equal width in one row of the page, 1600 pixels wide."""
    step = 1510 / count
    return [area(fig, 70 + step * i, top + 24, 70 + step * (i + 1) - 66 + 46 * (i + 1 == count), top + 24 + PANEL_PX)
            for i in range(count)]


def draw(data, everything=False):
    """everything: all other panels too, beneath the story."""
    divers, vehicles = data["humans"][:MOST_DIVERS], data["vehicles"][:MOST_VEHICLES]
    everyone = data["vehicles"] + data["humans"]
    seconds = max([one["time_s"][-1] for one in everyone if one["time_s"]], default=1.0)
    warnings = [line for diver in data["humans"] for line in danger_lines(diver)][:8]
    facts = []
    if len(divers) < len(data["humans"]) or len(vehicles) < len(data["vehicles"]):
        facts = [f"{len(data['vehicles'])} vehicles and {len(data['humans'])} divers; panels of their own: the first "
                 f"{len(vehicles)} and {len(divers)}"]
    wide, large = 1600, 520
    high = 44 + 19 * (len(facts) + len(warnings)) + 34 + large + 84 + ROW_PX * (len(divers) + len(vehicles))
    if everything:
        high += height_of_more(divers, vehicles)
    fig = figure(wide, high)
    top = heading(fig, data["title"] or "Dive", facts, warnings) + 34
    strips = danger_strips(data)
    strips_px = 16 * len(strips) + 34 if strips else 0
    side = 430 if divers else large - 60  # of the path from above, which divers alone do not need
    right = 1505 - side - 85 if data["vehicles"] else 1560
    draw_depth(area(fig, 70, top, right, top + large - strips_px), data, strips, seconds)
    if strips:
        draw_strips(area(fig, 70, top + large - strips_px + 46, right, top + large + 12), strips, seconds)
    if data["vehicles"]:
        draw_map(fig, area(fig, 1505 - side, top, 1505, top + side), data, seconds)
    top += large + 74
    for one, story, count in [(d, diver_story, 3) for d in divers] + [(v, vehicle_story, 2) for v in vehicles]:
        section(fig, top, short(one["name"]))
        story(row_of_areas(fig, top, count), one, seconds)
        top += ROW_PX
    if everything:
        draw_more(fig, top, divers, vehicles, seconds)
    if divers:
        words = f"* {data['risk_note']}; 100 %: where it counts as raised."
        if everything:
            words = f"Time left: without a stop, of gas to {RESERVE_BAR:g} bar, and what the way up takes. " + words
        fit(fig, fig.text(24 / wide, 8 / high, words, size=8, color=GREY))
    return fig
