"""The picture of a dive (`neritic dive --plot`): its story on one page. Large: depth over time, with
ceiling, stops, wanted path, the ground below and whatever endangered a diver; and the path from above.
Small, beneath: gas, times, pace, breath and risks of each diver; thrust, error and speed of vehicles.
"""
import numpy as np

from style import (BLUE, FAINT, GREEN, GREY, INK, ORANGE, PAPER, PINK, RED, SAND, area, color, figure, gaps, heading,
                   legend, notes, numbers, over_time, room, time_axis, title)

MOST_DIVERS, MOST_VEHICLES = 2, 3  # that have small panels of their own
MOST_STRIPS = 12
LONGEST_MIN = 300.0  # longer times are not drawn: no diver plans by them
RESERVE_BAR = 50.0
DIVER_PX, VEHICLE_PX = 410, 250  # heights of one's small panels

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


def draw_depth(ax, data, strips, seconds):
    vehicles, divers = data["vehicles"], data["humans"]
    shown = []
    for i, one in enumerate(vehicles):
        depth = numbers(one["depth_m"])
        ax.plot(one["time_s"], depth, color=color(i), lw=2.4, alpha=0.75, label=one["name"] if i < 6 else "_")
        shown.append(depth)
        if one["wanted_depth_m"] is not None:
            wanted = numbers(one["wanted_depth_m"])
            ax.plot(one["time_s"], wanted, color=INK, lw=1.0, ls=(0, (4, 3)), label="wanted" if i == 0 else "_", zorder=5)
            shown.append(wanted)
    for i, diver in enumerate(divers):
        depth, hue = numbers(diver["depth_m"]), color(len(vehicles) + i)
        ax.plot(diver["time_s"], depth, color=hue, lw=2.4, label=diver["name"] if i < 6 else "_", zorder=4)
        shown.append(depth)
        ceiling, stop = numbers(diver["ceiling_m"]), numbers(diver["stop_m"])
        if np.nanmax(ceiling, initial=0) > 0:
            ax.fill_between(diver["time_s"], 0, ceiling, color=RED, alpha=0.13, lw=0, zorder=1)
            ax.plot(diver["time_s"], np.where(ceiling > 0, ceiling, np.nan), color=RED, lw=1.2,
                    label="ceiling" if i == 0 else "_")
            shown.append(ceiling[ceiling > 0])
        if np.nanmax(stop, initial=0) > 0:
            ax.plot(diver["time_s"], np.where(stop > 0, stop, np.nan), color=PINK, lw=1.1, ls=(0, (2, 2)),
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
                            label=f"ground below {one['name']}")
    handles = ax.get_legend_handles_labels()[0]
    for _, hue, _, time, depth in strips:
        ax.plot(time, depth, color=hue, lw=5, zorder=6, solid_capstyle="butt")
    time_axis(ax, seconds)
    ax.set_ylabel("depth, m")
    title(ax, "Depth over time", 11)
    legend(ax, 9, handles[:9])
    items = [(w["at_s"], w["at_depth_m"], str(w["number"]), INK, True) for v in vehicles[:1] for w in v["waypoints"]]
    for diver in divers:
        items += [(s["at_s"], s["depth_m"], "to " + s["to"], INK, True) for s in diver["gas_switches"][:8]]
    if items:
        ax.plot([i[0] for i in items], [i[1] for i in items], "o", color=INK, ms=4.5, zorder=8)
        notes(ax, items, 8.5)


def danger_strips(data):
    """Of each danger that was met: words, colour, its times, and the line of depth it lies on."""
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
    """One row a danger, under the depth, with its words at the right."""
    least = 0.003 * seconds  # so that a moment is seen
    for i, (words, hue, spans, _, _) in enumerate(strips):
        ax.broken_barh([(a, max(b, least)) for a, b in spans], (i + 0.1, 0.8), color=hue, lw=0)
        ax.text(1.008, (i + 0.5) / len(strips), words, transform=ax.transAxes, color=hue, size=8, va="center")
    ax.set_ylim(0, len(strips))
    ax.set_yticks([])
    ax.spines["left"].set_visible(False)
    time_axis(ax, seconds, False)
    ax.tick_params(axis="x", labelbottom=False)


def draw_map(fig, ax, data):
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
    for i, one in enumerate(data["vehicles"] + data["humans"]):
        x, y = numbers(one["x_m"]), -numbers(one["z_m"])
        if not len(x):
            continue
        ax.plot(x, y, color=color(i), lw=2.2, alpha=0.85)
        wanted = one.get("wanted_x_m")
        if wanted is not None:
            ax.plot(numbers(wanted), -numbers(one["wanted_z_m"]), color=INK, lw=1.0, ls=(0, (4, 3)), zorder=5)
        ax.plot(x[0], y[0], "o", mfc=PAPER, mec=color(i), mew=1.6, ms=7, zorder=7)
        ax.plot(x[-1], y[-1], "s", color=color(i), ms=6.5, zorder=7)
        if i < 6:
            items.append((x[-1], y[-1], one["name"], color(i), True))
    for w in data["vehicles"][0]["waypoints"] if data["vehicles"] else []:
        ax.plot(w["at_x_m"], -w["at_z_m"], "o", color=INK, ms=4, zorder=8)
        items.append((w["at_x_m"], -w["at_z_m"], str(w["number"]), INK, False))
    notes(ax, items, 8.5)
    ax.text(1.0, 1.012, "○ start  ■ end  – – wanted", transform=ax.transAxes, ha="right", va="bottom", size=8.5,
            color=GREY)


def diver_panels(axes, diver, seconds):
    time, limits = numbers(diver["time_s"]), diver["limits"]
    column = lambda key: numbers(diver[key])
    step = iter(axes)

    ax = next(step)
    tanks = [(time, numbers(bar), f"{i + 1}: {gas}" if len(diver["tanks"]) > 1 else gas, color((0, 3, 6, 5)[i % 4]))
             for i, (gas, bar) in enumerate(zip(diver["tanks"], diver["tank_bar"]))]
    if tanks:
        over_time(ax, tanks, "bar", "Tanks", seconds, 5)
        if ax.get_ylim()[0] < 1.6 * RESERVE_BAR:
            ax.axhline(RESERVE_BAR, color=RED, lw=0.9, ls=(0, (4, 3)))
            ax.set_ylim(bottom=min(ax.get_ylim()[0], 40))
        for switch in diver["gas_switches"]:
            ax.axvline(switch["at_s"], color=INK, lw=0.8, ls=":")
    else:
        ax.set_axis_off()

    ax = next(step)
    held = lambda key: np.where(column(key) <= LONGEST_MIN, column(key), np.nan)
    over_time(ax, [(time, held("no_stop_min"), "no stop", BLUE), (time, held("remaining_min"), "gas", GREEN),
                   (time, column("to_surface_min"), "way up", ORANGE)], "min", "Time left", seconds)

    ax = next(step)
    rate = column("ascent_m_min")
    over_time(ax, [(time, rate, "", BLUE)], "m/min, up", "Ascent", seconds)
    most = np.nanmax(rate, initial=0)
    for key, hue, words in (("fast_m_min", "#ee6a5a", "fast"), ("dangerous_m_min", RED, "dangerous")):
        if most > 0.5 * limits[key]:
            ax.axhline(limits[key], color=hue, lw=1.0, ls=(0, (4, 3)), label=words)
            ax.set_ylim(top=max(ax.get_ylim()[1], 1.15 * limits[key]))
    legend(ax, 7.5)

    ax = next(step)
    over_time(ax, [(time, column("speed_m_s"), "speed, m/s", BLUE), (time, column("kick_hz"), "kicks, 1/s", ORANGE)],
              "m/s, 1/s", "Pace", seconds, 0.2)
    over_time(next(step), [(time, column("limb_power_w"), "", BLUE)], "W", "Power of the limbs", seconds)
    over_time(next(step), [(time, column("ventilation_l_min"), "gas breathed", BLUE),
                           (time, column("oxygen_l_min"), "oxygen used", ORANGE)], "l/min", "Gas", seconds,
              time_label=True)
    over_time(next(step), [(time, column("heart_bpm"), "heart", RED), (time, column("breaths_min"), "breath", BLUE)],
              "1/min", "Heart, breath", seconds, time_label=True)
    over_time(next(step), [(time, column("lungs_l"), "lungs", BLUE), (time, column("jacket_l"), "jacket", ORANGE)],
              "l", "Gas held", seconds, time_label=True)
    over_time(next(step), [(time, column("net_weight_n"), "", BLUE)], "N, down", "Weight less lift", seconds,
              time_label=True)
    next_ax = next(step)
    next_ax.axhline(0, color=FAINT, lw=0)
    shares = [(key, words, hue, limits[limit][0]) for key, words, hue, limit in (
        ("co2_proxy_mmhg", "CO2", GREY, "co2_mmhg"), ("narcosis_proxy_m", "narcosis", ORANGE, "narcotic_m"),
        ("gas_density_g_l", "density", BLUE, "density_g_l"), ("po2_bar", "O2", GREEN, "oxygen_bar"))]
    over_time(next_ax, [(time, 100 * column(key) / raised, words, hue) for key, words, hue, raised in shares],
              "% of raised", "Risk*", seconds, time_label=True)
    next_ax.axhline(100, color=RED, lw=1.0, ls=(0, (4, 3)))
    next_ax.set_ylim(0, max(next_ax.get_ylim()[1], 112))


def vehicle_panels(axes, vehicle, seconds):
    time, name = numbers(vehicle["time_s"]), vehicle["name"]
    over_time(axes[0], [(time, numbers(f), str(i + 1), color(i)) for i, f in enumerate(vehicle["thrust_n"])], "N",
              f"Thrusters of {name}", seconds, time_label=True)
    for line in axes[0].lines:
        line.set(lw=0.8, alpha=0.85)
    if vehicle["error_m"] is not None:
        over_time(axes[1], [(time, numbers(vehicle["error_m"]), "", ORANGE)], "m", "Off the wanted place", seconds, 0.05,
                  time_label=True)
    else:
        axes[1].set_axis_off()
    over_time(axes[2], [(time, numbers(vehicle["speed_m_s"]), "", BLUE)], "m/s", "Speed over ground", seconds, 0.05,
              time_label=True)


def draw(data):
    divers, vehicles = data["humans"][:MOST_DIVERS], data["vehicles"][:MOST_VEHICLES]
    everyone = data["vehicles"] + data["humans"]
    seconds = max([one["time_s"][-1] for one in everyone if one["time_s"]], default=1.0)
    warnings = [line for diver in data["humans"] for line in danger_lines(diver)][:8]
    facts = []
    if len(divers) < len(data["humans"]) or len(vehicles) < len(data["vehicles"]):
        facts = [f"{len(data['vehicles'])} vehicles and {len(data['humans'])} divers; panels of their own: the first "
                 f"{len(vehicles)} and {len(divers)}"]
    wide, large = 1600, 520
    high = 44 + 19 * (len(facts) + len(warnings)) + 34 + large + 76
    fig = figure(wide, high + DIVER_PX * len(divers) + VEHICLE_PX * len(vehicles))
    top = heading(fig, data["title"] or "Dive", facts, warnings) + 34
    strips = danger_strips(data)
    strips_px = 13 * len(strips) + 34 if strips else 0
    draw_depth(area(fig, 70, top, 1010, top + large - strips_px), data, strips, seconds)
    if strips:
        draw_strips(area(fig, 70, top + large - strips_px + 46, 1010, top + large + 12), strips, seconds)
    draw_map(fig, area(fig, 1085, top, 1085 + min(large, 430), top + min(large, 430)), data)
    top += large + 66
    for diver in divers:
        section(fig, top, diver["name"])
        axes = [area(fig, 70 + 308 * i, top + 24 + 176 * row, 70 + 308 * i + 244, top + 154 + 176 * row)
                for row in range(2) for i in range(5)]
        diver_panels(axes, diver, seconds)
        top += DIVER_PX
    for vehicle in vehicles:
        section(fig, top, vehicle["name"])
        axes = [area(fig, 70, top + 24, 620, top + 24 + 150), area(fig, 690, top + 24, 1090, top + 24 + 150),
                area(fig, 1160, top + 24, 1560, top + 24 + 150)]
        vehicle_panels(axes, vehicle, seconds)
        top += VEHICLE_PX
    if divers:
        fig.text(24 / wide, 0.08 / fig.get_size_inches()[1], f"Time left: without a stop, of gas to {RESERVE_BAR:g} bar, and what the way up takes. "
                 f"* {data['risk_note']}; 100 %: where it counts as raised.",
                 size=8, color=GREY)
    return fig


def section(fig, top, words):
    width, height = fig.get_size_inches() * 100
    fig.text(24 / width, 1 - (top - 16) / height, words, size=12, weight="bold", color=INK)
