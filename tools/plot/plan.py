"""The picture of a planned or replayed dive (`neritic plan`): depth with the ceiling, stops and gas
switches large; what is left of each gas beneath; the tissues at the moments that matter.
"""
import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator

from style import BLUE, GREY, INK, RED, area, color, figure, gaps, heading, legend, notes, numbers, title

GOLD = "#e69f00"  # helium
ALARMS = ((1, "rises fast", "#ee6a5a"), (2, "rises dangerously fast", RED))


def label_stops(ax, stops):
    """Each stop's words at the right edge, at the stop's own depth, at the end of a line from the stop: beside
    the stop they would stand under the next one. Returns the boxes of the words in pixels."""
    if not stops:
        return []
    minutes, leave = {}, {}
    for stop in stops:
        minutes.setdefault(stop["depth_m"], []).append(f"{stop['minutes']:.3g}")
        leave[stop["depth_m"]] = stop["leave_min"]
    end, depths = ax.get_xlim()[1], sorted(minutes)
    apart = min(np.diff(depths), default=np.inf)
    pixels = abs(ax.transData.transform((0, apart))[1] - ax.transData.transform((0, 0))[1]) if len(depths) > 1 else 20
    taken = []
    for depth in depths:
        words = ax.text(end, depth, f"{depth:g} m  {' + '.join(minutes[depth])} min", ha="right", va="center", zorder=20,
                        size=float(np.clip(0.6 * pixels, 5, 8.5)))
        box = words.get_window_extent(ax.figure.canvas.get_renderer())
        taken.append((box.x0, box.y0, box.x1, box.y1))
        left = ax.transData.inverted().transform((box.x0 - 4, box.y0))[0]
        if left > leave[depth]:
            ax.plot([leave[depth], left], [depth, depth], color=GREY, lw=0.7, ls=(0, (1, 2)), zorder=1)
    return taken


def draw_profile(ax, data, end):
    run, depth, ceiling = (numbers(data[key]) for key in ("run_min", "depth_m", "ceiling_m"))
    gas = np.array(data["gas"])
    deepest = max(3.0, np.nanmax(depth), np.nanmax(ceiling))
    ax.set_xlim(0, end)
    ax.set_ylim(1.1 * deepest, -0.02 * deepest)
    ax.yaxis.set_major_locator(MaxNLocator(8, steps=[1, 2, 5, 10]))
    ax.fill_between(run, 0, ceiling, color=RED, alpha=0.13, lw=0)
    there = ceiling > 0
    there[:-1] |= there[1:]  # with the row before: the line begins at the surface
    ax.plot(run, np.where(there, ceiling, np.nan), color=RED, lw=1.3)
    handles, items, seen = [], [], []
    starts = [0] + [i for i in range(1, len(gas)) if gas[i] != gas[i - 1]] + [len(gas)]
    for first, last in zip(starts[:-1], starts[1:]):
        kind, begin = gas[first], max(first - 1, 0)
        ax.plot(run[begin:last], depth[begin:last], color=color(kind), lw=2.6)
        name = data["gases"][kind]
        if kind not in seen:
            seen.append(kind)
            handles.append(Line2D([], [], color=color(kind), lw=2.6, label=name))
        if first > 0:
            ax.plot(run[begin], depth[begin], "o", color=color(kind), ms=7, zorder=8)
            items.append((run[begin], depth[begin], f"to {name}, {depth[begin]:.3g} m", color(kind), True))
    above = numbers(data["ceiling_violated"]) > 0
    if above.any():
        ax.plot(run, np.where(above, depth, np.nan), color="#8c1a8c", lw=5, zorder=6, solid_capstyle="butt")
        handles.append(Line2D([], [], color="#8c1a8c", lw=5, label="above the ceiling"))
    for code, words, hue in ALARMS:
        flags = numbers(data["alarm"]) == code
        if flags.any():
            for since, minutes in gaps(run, flags):
                ax.axvspan(since, since + max(minutes, 0.002 * end), color=hue, alpha=0.25, lw=0)
            handles.append(Patch(color=hue, alpha=0.4, label=words))
    notes(ax, items, 8.5, label_stops(ax, data["stops"]))
    ax.set_ylabel("depth, m")
    ax.set_xlabel("run time, min")
    title(ax, "Depth over run time", 11)
    legend(ax, 9, [Patch(color=RED, alpha=0.25, label="above the ceiling: not to be entered")] + handles)


def draw_gas(ax, curves, end):
    """Bar in the tanks that are known; where none is, litres used."""
    unit = "bar" if any(c["unit"] == "bar" for c in curves) else "l"
    shown = [c for c in curves if c["unit"] == unit]
    most = max([1.0] + [v for c in shown for v in c["value"]] + [c["minimum"]["bar"] for c in shown if c["minimum"]])
    ax.set_xlim(0, end)
    ax.set_ylim(0, 1.18 * most)
    items = []
    for c in shown:
        hue = color(c["gas"])
        ax.plot(c["run_min"], c["value"], color=hue, lw=1.8, label=c["name"])
        if c["minimum"]:
            m = c["minimum"]
            enough = m["bar"] <= m["then_bar"]
            ax.plot([m["run_min"]] * 2, [m["bar"], m["then_bar"]], color=hue if enough else RED, lw=1.2, ls=":")
            ax.plot(m["run_min"], m["bar"], "o", mfc="none", mec=hue if enough else RED, mew=1.8, ms=9)
            words = f"minimum gas of {c['name']}: {m['bar']:.0f} bar" + (
                f", {m['then_bar']:.0f} left" if enough else f", only {m['then_bar']:.0f} left")
            items.append((m["run_min"], m["bar"], words, hue if enough else RED, True))
        if c["used_up"]:
            ax.plot(c["run_min"][-1], c["value"][-1], "x", color=RED, ms=9, mew=2.4, zorder=9)
            items.append((c["run_min"][-1], c["value"][-1], f"{c['name']}: used up at {c['run_min'][-1]:.0f} min", RED,
                          True))
    notes(ax, items, 8.5)
    ax.set_ylabel("bar" if unit == "bar" else "litres at 1 bar")
    ax.set_xlabel("run time, min")
    without = ", ".join(c["name"] for c in curves if c["unit"] != unit)
    title(ax, ("Pressure of the tanks" if unit == "bar" else "Gas used") + (f" (no tank given: {without})" if without else ""),
          10)
    legend(ax, 8.5)


def draw_tissues(ax, moment, gf_high, helium, first):
    x = np.arange(1, len(moment["n2_bar"]) + 1)
    n2, he, m_value = (numbers(moment[key]) for key in ("n2_bar", "he_bar", "m_value_bar"))
    ax.bar(x, n2, 0.72, color=BLUE, alpha=0.85)
    if helium:
        ax.bar(x, he, 0.72, bottom=n2, color=GOLD, alpha=0.9)
    ambient = moment["ambient_bar"]
    off = np.isfinite(m_value)  # compartments that give off gas
    ax.hlines(m_value[off], x[off] - 0.4, x[off] + 0.4, color=RED, lw=2)
    ax.hlines(ambient + gf_high * (m_value[off] - ambient), x[off] - 0.4, x[off] + 0.4, color=INK, lw=1.4)
    ax.axhline(ambient, color=GREY, lw=1.2, ls=(0, (5, 3)))
    ax.set_ylim(0, 1.08 * max(ambient, np.nanmax(n2 + he), np.max(m_value[off], initial=0)))
    ax.set_xlim(0.4, len(x) + 0.6)
    ax.set_xticks([1, 4, 8, 12, 16])
    ax.grid(axis="x", visible=False)
    ax.yaxis.set_major_locator(MaxNLocator(5, steps=[1, 2, 5, 10]))
    if first:  # the others are of the same quantity, and stand too close for their own
        ax.set_ylabel("inert gas, bar")
    ax.set_xlabel("compartment, fast to slow")
    title(ax, f"{moment['name'].capitalize()}: {moment['run_min']:.0f} min, {moment['depth_m']:.3g} m, {ambient:.2f} bar", 9.5)


def draw(data):
    # Room for the words of the stops beside the last of them.
    end = max((1.09 if data["stops"] else 1.04) * max(data["run_min"]), 1e-3)
    curves = data["gas_left"]
    wide, profile, gas, tissues = 1600, 520, 150, 240
    lines = len(data["facts"]) + len(data["warnings"])
    high = 44 + 19 * lines + 34 + profile + 80 + (gas + 84 if curves else 0) + tissues + 86
    fig = figure(wide, high)
    top = heading(fig, data["title"], data["facts"], data["warnings"]) + 34
    draw_profile(area(fig, 70, top, wide - 30, top + profile), data, end)
    top += profile + 80
    if curves:
        draw_gas(area(fig, 70, top, wide - 30, top + gas), curves, end)
        top += gas + 84
    helium = any(v > 1e-6 for moment in data["moments"] for v in moment["he_bar"])
    count = len(data["moments"])
    pitch = (wide - 100) / count
    for i, moment in enumerate(data["moments"]):
        draw_tissues(area(fig, 70 + i * pitch, top, i * pitch + pitch + 20, top + tissues), moment, data["gf_high"], helium,
                     i == 0)
    handles = [Patch(color=BLUE, label="nitrogen")] + ([Patch(color=GOLD, label="helium")] if helium else []) + [
        Line2D([], [], color=GREY, lw=1.2, ls=(0, (5, 3)), label="pressure of the water")]
    if any(v is not None for moment in data["moments"] for v in moment["m_value_bar"]):
        handles += [Line2D([], [], color=RED, lw=2, label="M-value of what gives off gas"),
                    Line2D([], [], color=INK, lw=1.4,
                           label=f"GF high, {100 * data['gf_high']:g} % of the way to the M-value")]
    fig.legend(handles=handles, loc="lower left", bbox_to_anchor=(0.035, 0.0), ncol=len(handles), frameon=False, fontsize=9)
    return fig
