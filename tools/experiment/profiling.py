"""The profiling sonar of the published experiment on a ship (90 x 0.5 degrees): a flat floor, and a survey of the swell
z = 10 + sin(2 pi x / 10) on a chart of 0.25 m; the same with a ship that rolls, with a tide that nobody corrects or
that is corrected, and with a wrong sound speed, whose smile is known."""
import math
import os

import numpy as np

import report
from scenario import SHIPPED, Refused, Setting

SETTINGS = {
    "floor": Setting("waves", "flat, or the swell of 1 m", words=["flat", "waves"]),
    "depth_m": Setting(10.0, "mean depth below the sonar", 4.0, 25.0),
    "length_m": Setting(50.0, "of the line", 2.0, 200.0),
    "spacing_m": Setting(0.125, "from ping to ping", 0.02, 5.0),
    "cell_m": Setting(0.25, "of the chart", 0.05, 5.0),
    "roll_deg": Setting(0.0, "amplitude of the ship's roll, 6 s, known to the processing", 0.0, 30.0),
    "tide_m": Setting(0.0, "how far the water rises over the line", -5.0, 5.0),
    "tide_known": Setting(True, "true: the processing corrects the tide"),
    "surface_speed_m_s": Setting(1500.0, "sound speed at the sonar, which the processing takes for that of all the water", 1400.0, 1600.0),
    "bottom_speed_m_s": Setting(1500.0, "true sound speed at 30 m, linear between", 1400.0, 1600.0),
}
MEASURES = {
    "rmse_m": ("m", "root mean square error of the chart's cells"),
    "bias_m": ("m", "mean error of the chart's cells, positive too deep"),
    "coverage": ("", "share of the cells in the swath that have soundings"),
    "worst_beam_bins": ("range bins", "largest error of a beam's range over the flat floor against r = h / cos(theta)"),
    "middle_m": ("m", "depth error of the middle 20 degrees of a flat floor, positive too deep"),
    "smile_m": ("m", "depth error of the beams at 42 to 44 degrees less that of the middle 20 degrees, positive too deep"),
    "smile_expected_m": ("m", "the same by rays traced through the layers"),
    "smile_off_m": ("m", "smile_m less smile_expected_m"),
}
TRACED_RAD = np.radians(np.linspace(0.0, 46.0, 47))  # straight lines between them are off by 0.05 mm
HALF_SWATH_RAD = math.radians(45.0)
SPEED_M_S = 1.0
PROFILE_M = 30.0  # depth of the bottom's sound speed
GRID_M = 0.2  # of the swell's heights; straight lines between them are off by 2 mm at most
SHIP = """seed = {seed}
[[objects]]
name = "ship"
track = {{ file = "line.csv" }}
[[objects.sonars]]
name = "multibeam"
include = "{sensor}"
pitch_deg = -90
range_m = [1, {farthest!r}]
rate_hz = {rate!r}
"""


def depth_at(settings, x):
    """Metres below the mean surface at metres along the line."""
    waves = 1.0 if settings["floor"] == "waves" else 0.0
    return settings["depth_m"] + waves * np.sin(2 * math.pi * np.asarray(x, float) / 10.0)


def _floor(settings, tools):
    length, half_wide = settings["length_m"], 1.4 * (settings["depth_m"] + 1) + 2
    if settings["floor"] == "flat":
        return (f'shape = "plane"\nsize_m = [{length + 6}, {2 * half_wide}]\n'
                f'position_m = [{length / 2}, {-settings["depth_m"]}, 0]\n')
    # Rows of a terrain run from north to south; the line runs along x, so all rows are equal.
    count = 2 * math.ceil((length / 2 + 3) / GRID_M) + 1
    along = length / 2 + (np.arange(count) - count // 2) * GRID_M
    rows = 2 * math.ceil(half_wide / GRID_M) + 1
    np.save(os.path.join(tools.folder, "floor.npy"),
            np.repeat(-depth_at(settings, along)[None, :], rows, axis=0).astype(np.float32))
    return f'terrain = "floor.npy"\ncell_m = {GRID_M}\nposition_m = [{length / 2}, 0, 0]\n'


def _farthest_m(settings):
    return (settings["depth_m"] + 1.2) / math.cos(HALF_SWATH_RAD) * 1.25


def _tide_m(settings, x):
    return settings["tide_m"] * x / settings["length_m"]


def _scene(settings, seed, tools, pings):
    rows = ["t_s,x,y,z,yaw_deg,pitch_deg,roll_deg"]
    for i in range(pings):
        x = i * settings["spacing_m"]
        roll_deg = settings["roll_deg"] * math.sin(2 * math.pi * x / SPEED_M_S / 6.0)
        rows.append(f"{x / SPEED_M_S!r},{x!r},{_tide_m(settings, x)!r},0,-90,0,{roll_deg!r}")
    tools.write("line.csv", "\n".join(rows) + "\n")
    scene = SHIP.format(seed=seed, sensor=os.path.join(SHIPPED, "..", "sensors", "profiling_90x0_5.toml"),
                        farthest=_farthest_m(settings),
                        rate=SPEED_M_S / settings["spacing_m"])
    top, bottom = settings["surface_speed_m_s"], settings["bottom_speed_m_s"]
    if bottom != top:
        scene += (f"[objects.sonars.water]\nsound_speed_m_s = {top}\n[objects.sonars.sound_speed]\n"
                  f'profile = [[0, {top}], [{PROFILE_M!r}, {bottom}]]\nrays = "bent"\n')
    return tools.write("scene.toml", scene + '[[objects]]\nname = "floor"\nclass = "seabed"\n' + _floor(settings, tools))


def traced_depth(settings, angle_rad, layers=4000):
    """Depth that the processing finds where a ray at this angle off the vertical meets the flat floor: the ray bends by
    Snell's law through thin layers, and its time counts at the surface's speed along a straight line."""
    top, bottom, h = settings["surface_speed_m_s"], settings["bottom_speed_m_s"], settings["depth_m"]
    speed = top + (bottom - top) * (np.arange(layers) + 0.5) / layers * h / PROFILE_M
    cosine = np.sqrt(1 - (math.sin(angle_rad) / top * speed) ** 2)
    time = (h / layers / speed / cosine).sum()
    return top * time * math.cos(angle_rad)


def heard(settings, across, down):
    """(across, down) of soundings as the processing finds them, which counts with the surface's speed along straight lines; arrays of
    metres from the head. Given: the direction in which each point truly lies, as far off as its echo's time counts at that speed. The
    program bends the times alone, so the direction in which an echo arrives is found here.

    In a constant gradient g a ray is an arc. From speed c0 to a point at r in a direction at the angle a off the vertical, with h = r cos a
    and x = r sin a, its time t has cosh(g t) = 1 + g^2 r^2 / (2 c0 (c0 + g h)), and it leaves at the angle b off the vertical with
    tan b = x / (h + g r^2 / (2 c0)). Jensen et al., Computational Ocean Acoustics, 2nd ed. 2011, section 3.3.5 (rays are arcs of circles); the
    rest follows from the circle through both points whose centre lies where the speed would be 0. Valid where c0 + g h > 0. The
    gradient begins at the head, which lies at the mean surface or above."""
    top = settings["surface_speed_m_s"]
    gradient = (settings["bottom_speed_m_s"] - top) / PROFILE_M
    if gradient == 0.0:
        return across, down
    counted = np.hypot(across, down)
    sine, cosine = across / counted, down / counted
    # The true range: r^2 - g k cos(a) r - c0 k = 0.
    k = 2.0 * top * (np.cosh(gradient * counted / top) - 1.0) / gradient ** 2
    r = 0.5 * (gradient * k * cosine + np.sqrt((gradient * k * cosine) ** 2 + 4.0 * top * k))
    leaves = np.arctan2(r * sine, r * cosine + gradient * r ** 2 / (2.0 * top))
    return counted * np.sin(leaves), counted * np.cos(leaves)


def check(settings):
    """Refuses a rising tide in layers of sound speed: heard() has the head at the mean surface."""
    if settings["tide_m"] and settings["bottom_speed_m_s"] != settings["surface_speed_m_s"]:
        raise Refused(f"tide_m: found {settings['tide_m']:g} with a bottom_speed_m_s that is not surface_speed_m_s; accepted: one of the two")


def run(settings, seed, tools):
    pings = int(round(settings["length_m"] / settings["spacing_m"])) + 1
    scene = _scene(settings, seed, tools, pings)
    tools.neritic("render", scene, "--frames", pings, "--track-only", "--out", tools.folder, "-q")
    cloud = np.load(os.path.join(tools.folder, "track", "ship_multibeam", "cloud.npy"))
    bin_m = (_farthest_m(settings) - 1) / 500
    x, up = cloud[:, 0], _tide_m(settings, cloud[:, 0])
    z, below = heard(settings, cloud[:, 2], up - cloud[:, 1])
    found = below - up
    if not settings["tide_known"]:
        found = found + up  # the processing puts the ship at the mean surface

    # The chart: the mean of the soundings of a cell, against the mean depth of the cell.
    cell, length = settings["cell_m"], settings["length_m"]
    columns = int(length / cell)
    wide = int(2 * (settings["depth_m"] - (1 if settings["floor"] == "waves" else 0)) * math.tan(HALF_SWATH_RAD) / cell)
    column, row = np.floor(x / cell).astype(int), np.floor(z / cell + wide / 2).astype(int)
    inside = (column >= 0) & (column < columns) & (row >= 0) & (row < wide)
    count, total = np.zeros((wide, columns)), np.zeros((wide, columns))
    np.add.at(count, (row[inside], column[inside]), 1)
    np.add.at(total, (row[inside], column[inside]), found[inside])
    fine = (np.arange(columns * 20) + 0.5) * cell / 20
    truth = depth_at(settings, fine).reshape(columns, 20).mean(axis=1)
    error = (total / np.maximum(count, 1) - truth)[count > 0]
    measures = {"rmse_m": float(np.sqrt((error ** 2).mean())), "bias_m": float(error.mean()),
                "coverage": float((count > 0).mean())}
    middle = np.abs(z) < 0.5
    order = np.argsort(x[middle])[:: max(1, np.count_nonzero(middle) // 800)]
    series = {"x": x[middle][order].round(4).tolist(), "depth": found[middle][order].round(4).tolist()}
    if settings["floor"] == "flat":
        height = settings["depth_m"] + up
        angle = np.arctan2(z, below)
        measures["worst_beam_bins"] = float(np.abs((below - height) / np.cos(angle)).max() / bin_m)
        # Beams of 42 to 44 degrees and of the middle 20: over each of these the range passes several bins.
        outer, inner = np.abs(np.abs(angle) - math.radians(43.0)) < math.radians(1.0), np.abs(angle) < math.radians(10.0)
        if outer.any() and inner.any():
            measures["middle_m"] = float(found[inner].mean() - settings["depth_m"])
            measures["smile_m"] = float(found[outer].mean() - found[inner].mean())
            by_rays = np.array([traced_depth(settings, a) for a in TRACED_RAD])
            expected = np.interp(np.abs(angle), TRACED_RAD, by_rays)
            measures["smile_expected_m"] = float(expected[outer].mean() - expected[inner].mean())
            measures["smile_off_m"] = measures["smile_m"] - measures["smile_expected_m"]
        series["angle_deg"] = np.degrees(angle[:: max(1, len(angle) // 600)]).round(3).tolist()
        series["beam_depth"] = found[:: max(1, len(angle) // 600)].round(4).tolist()
    return measures, series


def figures(scenario, results, style):
    done = [r for r in results if r["series"]]
    if not done:
        return
    line, of_line = _shown([r for r in done if r["settings"]["floor"] == "waves"] or done)
    flat, of_flat = _shown([r for r in done if "angle_deg" in r["series"]])
    fig = style.figure(900, 620)
    _line(style.area(fig, 70, 50, 870, 280), line, of_line, style)
    _errors(style.area(fig, 70, 360, 450 if flat else 870, 545), done, style)
    if flat:
        _beams(style.area(fig, 520, 360, 870, 570), flat, of_flat, flat == line, style)
    yield "profiling.png", "The line's soundings, the chart's errors by condition, and the flat floor by beam", fig


def _shown(runs):
    """A run of each condition, of more than three of the first, the middle and the last one; and what the title adds then."""
    first = {}
    for r in runs:
        first.setdefault(report.words(r["condition"]), r)
    runs = list(first.values())
    if len(runs) <= 3:
        return runs, ""
    return [runs[0], runs[len(runs) // 2], runs[-1]], f", 3 of {len(runs)} conditions"


def _marked(ax, runs, x, y, style):
    for i, r in enumerate(runs):
        ax.plot(r["series"][x], r["series"][y], ".x+"[i], ms=2.5 + i, mew=0.7, color=style.color(i), label=report.words(r["condition"]))
    ax.invert_yaxis()
    ax.set_ylabel("depth, m")


def _line(ax, runs, of, style):
    x = np.linspace(0, runs[0]["settings"]["length_m"], 1000)
    ax.plot(x, depth_at(runs[0]["settings"], x), color=style.INK, lw=3.2, alpha=0.35, label="true")
    _marked(ax, runs, "x", "depth", style)
    ax.set_xlabel("along the line, m")
    style.title(ax, "Soundings within 0.5 m of the middle" + of)
    style.legend(ax)


def _errors(ax, runs, style):
    factors = list(runs[0]["condition"])
    if len(factors) == 1:  # its name once, since many side by side have no room
        names = [report.number(r["condition"][factors[0]]) for r in runs]
        ax.set_xlabel(factors[0])
    else:
        names = [report.words(r["condition"]).replace(", ", "\n") for r in runs]
    for name, dx, hue in (("rmse_m", -0.2, style.BLUE), ("bias_m", 0.2, style.ORANGE)):
        ax.bar(np.arange(len(runs)) + dx, [1000 * r["measures"][name] for r in runs], 0.38, color=hue,
               edgecolor=style.INK, lw=0.6, label=name.removesuffix("_m"), hatch="//" if dx > 0 else None)
    swell = any(r["settings"]["floor"] == "waves" for r in runs)
    if swell:
        ax.axhline(50, color=style.INK, lw=0.9, ls="--")
    ax.set_xticks(np.arange(len(runs)), names, rotation=0 if len(runs) < 5 else 90)
    ax.set_ylabel("error of the chart, mm")
    style.title(ax, "Chart (dashed: 50 mm)" if swell else "Chart")
    style.legend(ax)


def _beams(ax, runs, of, named, style):
    """named: whether the line's soundings above have the same marks, so that no second legend lies on the beams."""
    _marked(ax, runs, "angle_deg", "beam_depth", style)
    ax.set_xlabel("angle of the beam, degrees")
    style.title(ax, f"Flat floor (marks as above){of}" if named else f"Flat floor{of}")
    if not named:
        style.legend(ax)
