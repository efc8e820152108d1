"""A page of panels with curves or bars (`neritic tradeoff`): error over cost, defaults and knees ringed."""
import numpy as np

from style import GREY, RED, area, color, figure, heading, legend, notes, numbers, plain_log, room, title

WIDE, PANEL_PX, HEAD_PX, FOOT_PX, ROW_PX = 1800, 400, 44, 60, 24
RING_PX, ASIDE_PX = 10, 215


def log_room(values):
    values = np.concatenate(values) if values else np.ones(1)
    values = values[np.isfinite(values) & (values > 0)]
    if not len(values):
        return 0.1, 1.0
    low, high = values.min(), values.max()
    pad = max((high / low) ** 0.07, 1.15)
    return low / pad, high * pad


def beside(panel, wide):
    """Whether the names need a column at the right: the title's line does not hold them."""
    letters = 1.25 * len(panel["title"]) + sum(len(series["name"]) + 6 for series in panel["series"])
    return not panel["bars"] and letters * 6.2 > wide


def draw_curves(ax, panel, hues, aside):
    marks, levels, kept = panel["marks"], panel["levels"], []
    for series in panel["series"]:
        x, y = numbers(series["x"]), numbers(series["y"])
        good = np.isfinite(x) & np.isfinite(y)
        for axis, values in (("x_axis", x), ("y_axis", y)):
            if panel[axis]["log"]:
                good &= values > 0
        kept.append((series, x[good], y[good], [n for n, g in zip(series["notes"], good) if g]))
    for axis, place, set_limits, at in (("x_axis", 1, ax.set_xlim, "x"), ("y_axis", 2, ax.set_ylim, "y")):
        values = [one[place] for one in kept] + [np.array([m[at] for m in marks], dtype=float)]
        if at == "y":
            values.append(np.array([l["y"] for l in levels], dtype=float))
        if panel[axis]["log"]:
            getattr(ax, f"set_{at}scale")("log")
            set_limits(*log_room(values))
            plain_log(getattr(ax, f"{at}axis"))
        else:
            flat = np.concatenate(values)
            low, high = (min(flat.min(), 0), flat.max()) if len(flat) else (0, 1)
            set_limits(low - 0.03 * (high - low), high + 0.08 * (high - low) + 1e-12)
    for series, x, y, _ in kept:
        if series["joined"]:
            ax.plot(x, y, "o-", color=hues[series["name"]], lw=1.5, ms=4.5, label=series["name"], zorder=3)
        else:
            ax.plot(x, y, "o", color="#c4c4c2", ms=3.5, label=series["name"], zorder=2)
    for level in levels:
        ax.axhline(level["y"], color=RED, lw=0.9, ls=(0, (4, 3)), alpha=0.7)
    for mark in marks:
        ax.plot(mark["x"], mark["y"], "o", mfc="none", mec=RED, mew=1.8, ms=13, zorder=9)
    items = [(m["x"], m["y"], m["words"], RED, True) for m in marks]
    items += [(ax.get_xlim()[1], l["y"], l["words"], RED, True) for l in levels]
    for series, x, y, words in kept:
        items += [(a, b, w, hues.get(series["name"], GREY), False) for a, b, w in zip(x, y, words)]
    rings = [ax.transData.transform((m["x"], m["y"])) for m in marks]
    notes(ax, items, 8, [(x - RING_PX, y - RING_PX, x + RING_PX, y + RING_PX) for x, y in rings])
    ax.set_xlabel(panel["x_axis"]["label"])
    ax.set_ylabel(panel["y_axis"]["label"])
    if aside:
        ax.legend(loc="upper left", bbox_to_anchor=(1.0, 1.02), frameon=False, fontsize=8, handlelength=1.4)
    else:
        legend(ax, 8.5)


def draw_bars(ax, panel):
    bars = panel["bars"]
    groups = list(dict.fromkeys(bar["group"] for bar in bars))
    values = numbers([bar["value"] for bar in bars])
    for group in groups:
        at = [i for i, bar in enumerate(bars) if bar["group"] == group]
        ax.bar(at, values[at], 0.62, color=color(groups.index(group)), label=group or "_")
    for i, value in enumerate(values):
        ax.annotate(f"{value:.3g}", (i, max(value, 0)), (0, 3), textcoords="offset points", ha="center", size=8)
    crowded = sum(len(bar["name"]) + 2 for bar in bars) > 60
    ax.set_xticks(range(len(bars)), [bar["name"] for bar in bars], rotation=35 if crowded else 0,
                  ha="right" if crowded else "center", rotation_mode="anchor" if crowded else None)
    ax.set_ylim(min(0, np.nanmin(values, initial=0)), 1.12 * max(np.nanmax(values, initial=0), 1e-12))
    ax.set_ylabel(panel["y_axis"]["label"])
    ax.grid(axis="x", visible=False)
    legend(ax, 8.5)


def draw_rows(fig, data, top):
    """Lanes of bars, a row a name; a value stands behind its bar, a note at the right."""
    lanes, rows = data["lanes"], data["rows"]
    bottom = top + ROW_PX * len(rows)
    for i, lane in enumerate(lanes):
        left = 300 + 340 * i
        ax = area(fig, left, top, left + 230, bottom)
        values = numbers([row["values"][i] for row in rows])
        most = max(np.nanmax(values, initial=0), 1e-12)
        ax.barh(range(len(rows)), np.nan_to_num(np.maximum(values, 0)), 0.6, color=color((0, 2, 1)[i % 3]))
        for j, value in enumerate(values):
            if np.isfinite(value):
                ax.text(max(value, 0) + 0.03 * most, j, f"{value:.3g}", va="center", size=8.5)
            if i == 0:
                ax.text(-0.03, j, rows[j]["name"], transform=ax.get_yaxis_transform(), ha="right", va="center", size=9)
            if i == len(lanes) - 1:
                ax.text(1.25, j, rows[j]["note"], transform=ax.get_yaxis_transform(), va="center", size=8.5, color=GREY)
        ax.set_xlim(0, most)
        ax.set_ylim(len(rows) - 0.5, -0.5)
        ax.set_axis_off()
        title(ax, lane, 9.5)


def draw(data):
    columns = data["columns"]
    lines = -(-len(data["panels"]) // columns)
    rows_px = ROW_PX * len(data["rows"]) + 60 if data["rows"] else 0
    high = 44 + 19 * len(data["facts"]) + lines * (HEAD_PX + PANEL_PX + FOOT_PX) + rows_px
    fig = figure(WIDE, high)
    top = heading(fig, data["title"], data["facts"])
    pitch = (WIDE - 20) / columns
    # A name has the same colour in all panels.
    names = list(dict.fromkeys(s["name"] for panel in data["panels"] for s in panel["series"] if s["joined"]))
    hues = {name: color(i) for i, name in enumerate(names)}
    for i, panel in enumerate(data["panels"]):
        left, y = 20 + i % columns * pitch, top + i // columns * (HEAD_PX + PANEL_PX + FOOT_PX) + HEAD_PX
        aside = beside(panel, pitch - 100)
        ax = area(fig, left + 75, y, left + pitch - (ASIDE_PX if aside else 24), y + PANEL_PX)
        title(ax, panel["title"][:1].upper() + panel["title"][1:], 10)
        if panel["bars"]:
            draw_bars(ax, panel)
        else:
            draw_curves(ax, panel, hues, aside)
    if data["rows"]:
        draw_rows(fig, data, top + lines * (HEAD_PX + PANEL_PX + FOOT_PX) + 30)
    return fig
