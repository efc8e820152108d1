"""Draws several dives made of the data of one, and ends with status 1 and a line for each label that
overlaps another or leaves the page: /usr/bin/python3 plot_labels.py TOOLS_PLOT DIVE.plot.json
"""
import copy
import gc
import json
import sys

sys.path.insert(0, sys.argv[1])

import dive  # noqa: E402
from matplotlib.axis import Axis  # noqa: E402
from matplotlib.text import Text  # noqa: E402


def labels(figure):
    """(words, box) of all text that is drawn; ticks outside their axis are not."""
    figure.draw_without_rendering()
    renderer, texts, of_ticks = figure.canvas.get_renderer(), [], set()
    for axis in figure.findobj(Axis):
        low, high = sorted(axis.get_view_interval())
        reach = 1e-9 * (high - low)
        for tick in axis.get_major_ticks() + axis.get_minor_ticks():
            of_ticks |= {tick.label1, tick.label2}
            if low - reach <= tick.get_loc() <= high + reach and axis.axes.axison and axis.get_visible():
                texts += [text for text in (tick.label1, tick.label2) if text.get_visible()]
    off = {text for axes in figure.axes if not axes.axison for text in axes.findobj(Text)}
    texts += [t for t in figure.findobj(Text) if t not in of_ticks and t not in off and t.get_visible()]
    return [(t.get_text(), t.get_window_extent(renderer)) for t in texts if t.get_text().strip()]


def faults(figure):
    found, out = labels(figure), []
    width, height = figure.get_size_inches() * figure.dpi
    for i, (words, box) in enumerate(found):
        if box.x0 < 0 or box.y0 < 0 or box.x1 > width or box.y1 > height:
            out.append(f'"{words}" leaves the page')
        for other, that in found[:i]:
            if min(box.x1, that.x1) - max(box.x0, that.x0) > 0.5 and min(box.y1, that.y1) - max(box.y0, that.y0) > 0.5:
                out.append(f'"{words}" overlaps "{other}" at ({box.x0:.0f}, {height - box.y1:.0f})')
    return out


def everyone(data):
    return data["vehicles"] + data["humans"]


def rows_of(one):
    """The keys of columns: lists of a value a row, or lists of such lists."""
    count = len(one["time_s"])
    flat = [k for k, v in one.items() if isinstance(v, list) and len(v) == count and not isinstance(v[0], (list, dict))]
    return flat, [k for k in ("thrust_n", "tank_bar") if k in one]


def long(data):
    """Four hours, deep, with a ceiling, stops, alarms, switches of gas and forty waypoints."""
    for one in everyone(data):
        count = len(one["time_s"])
        one["time_s"] = [14400.0 * i / (count - 1) for i in range(count)]
        one["depth_m"] = [min(i, count - i, count / 4) * 400 / count for i in range(count)]
    for diver in data["humans"]:
        time, depth, count = diver["time_s"], diver["depth_m"], len(diver["time_s"])
        diver["ceiling_m"] = [max(0.0, min(i - count / 2, count - i)) * 60 / count for i in range(count)]
        diver["stop_m"] = [3 * (c // 3 + 1) if c > 0 else 0 for c in diver["ceiling_m"]]
        for key in ("ascent_alarm", "out_of_gas", "ceiling_violated", "oxygen_high", "risk_high"):
            diver[key] = [int(i % 40 < 9) * (1 + i % 2) for i in range(count)]
        diver["gas_switches"] = [{"at_s": time[i], "depth_m": depth[i], "to": f"EAN{i % 99}", "from": "air"}
                                 for i in range(count // 2, count, count // 7)]
    for vehicle in data["vehicles"]:
        rows = range(0, len(vehicle["time_s"]), max(1, len(vehicle["time_s"]) // 40))
        vehicle["waypoints"] = [{"number": n + 1, "at_s": vehicle["time_s"][i], "at_x_m": vehicle["x_m"][i],
                                 "at_z_m": vehicle["z_m"][i], "at_depth_m": vehicle["depth_m"][i]}
                                for n, i in enumerate(rows)]


def two_divers(data):
    """At one place, with names that are long."""
    data["title"] = "A dive with a long title " * 12
    data["humans"].append(copy.deepcopy(data["humans"][0]))
    for i, one in enumerate(everyone(data)):
        one["name"] = f"participant {i} of a dive whose names are long"


def nothing(data):
    """All columns stay as they begin."""
    for one in everyone(data):
        flat, nested = rows_of(one)
        for key in set(flat) - {"time_s"}:
            one[key] = [one[key][0]] * len(one[key])
        for key in nested:
            one[key] = [[column[0]] * len(column) for column in one[key]]


def one_row(data):
    for one in everyone(data):
        flat, nested = rows_of(one)
        for key in flat:
            one[key] = one[key][:1]
        for key in nested:
            one[key] = [column[:1] for column in one[key]]


def diver_alone(data):
    data["vehicles"] = []


def vehicle_alone(data):
    data["humans"] = []


def as_it_is(data):
    """Short."""


def main():
    gc.disable()  # a tenth of the time, and all pages fit into memory
    with open(sys.argv[2], encoding="utf-8") as file:
        given = file.read()
    pages = {"as it is": (as_it_is,), "long": (long,), "two divers": (two_divers,), "two divers, long": (long, two_divers),
             "nothing happens": (nothing,), "one row": (one_row,), "diver alone": (diver_alone,),
             "long, diver alone": (long, diver_alone), "long, vehicle alone": (long, vehicle_alone)}
    out = []
    for name, changes in pages.items():
        data = json.loads(given)
        for change in changes:
            change(data)
        for everything in (False, True) if name in ("as it is", "two divers, long") else (False,):
            figure = dive.draw(data, everything)
            out += [f"{name}{', all panels' if everything else ''}: {fault}" for fault in faults(figure)]
    print("\n".join(out), file=sys.stderr)
    return 1 if out else 0


if __name__ == "__main__":
    sys.exit(main())
