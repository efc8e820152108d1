"""The small panels of a dive (dive.py). They tell its story: gas, pace and risks of each diver, errors and
thruster load of vehicles. On request (`--all`): times left, ascent, limbs, gas held and weight of each
diver; each thruster and the speed of vehicles.
"""
import numpy as np

from style import (BLUE, GREEN, GREY, INK, ORANGE, RED, area, color, legend, numbers, over_time, section, short)

RESERVE_BAR = 50.0
LONGEST_MIN = 300.0  # longer times are not drawn: no diver plans by them
DIVER_PX, VEHICLE_PX = 410, 250  # heights of one's panels


def diver_story(axes, diver, seconds):
    """Gas, pace and risks."""
    time = diver["time_s"]
    tanks = [(time, numbers(bar), f"{i + 1}: {gas}" if len(diver["tanks"]) > 1 else gas, color((0, 3, 6, 5)[i % 4]))
             for i, (gas, bar) in enumerate(zip(diver["tanks"], diver["tank_bar"]))]
    if tanks:
        axes[0].axhline(RESERVE_BAR, color=RED, lw=1.0, ls=(0, (4, 3)), label=f"reserve {RESERVE_BAR:g} bar")
        over_time(axes[0], tanks, "bar", "Gas", seconds, time_label=True)
        axes[0].set_ylim(0, max(axes[0].get_ylim()[1], 1.6 * RESERVE_BAR))
        for switch in diver["gas_switches"]:
            axes[0].axvline(switch["at_s"], color=INK, lw=0.8, ls=":")
    else:
        axes[0].set_axis_off()
    over_time(axes[1], [(time, numbers(diver["heart_bpm"]), "heart", RED),
                        (time, numbers(diver["breaths_min"]), "breath", BLUE)], "1/min", "Pace", seconds,
              time_label=True)
    axes[1].set_ylim(bottom=0)
    shares = [(time, 100 * numbers(diver[key]) / diver["limits"][limit][0], words, hue) for key, words, hue, limit in (
        ("co2_proxy_mmhg", "CO2", GREY, "co2_mmhg"), ("narcosis_proxy_m", "narcosis", ORANGE, "narcotic_m"),
        ("gas_density_g_l", "density", BLUE, "density_g_l"), ("po2_bar", "O2", GREEN, "oxygen_bar"))]
    over_time(axes[2], shares, "% of raised", "Risks*", seconds, time_label=True)
    axes[2].axhline(100, color=RED, lw=1.0, ls=(0, (4, 3)))
    axes[2].set_ylim(0, max(axes[2].get_ylim()[1], 112))


def across_path(vehicle):
    """Distance from the line along which the wanted place moves; where it rests, from the place."""
    def line(keys):
        return np.column_stack([numbers(vehicle[key]) for key in keys])
    wanted = line(("wanted_x_m", "wanted_depth_m", "wanted_z_m"))
    off = line(("x_m", "depth_m", "z_m")) - wanted
    along = np.gradient(wanted, axis=0) if len(wanted) > 1 else np.zeros_like(wanted)
    length = np.linalg.norm(along, axis=1, keepdims=True)
    along = np.divide(along, length, out=np.zeros_like(along), where=length > 1e-9)
    return np.linalg.norm(off - (off * along).sum(axis=1, keepdims=True) * along, axis=1)


def vehicle_story(axes, vehicle, seconds):
    """Errors and the load of the thrusters."""
    time = vehicle["time_s"]
    if vehicle["error_m"] is not None:
        over_time(axes[0], [(time, numbers(vehicle["error_m"]), "from the wanted place", ORANGE),
                            (time, across_path(vehicle), "across the wanted path", BLUE)], "m", "Error", seconds, 0.05,
                  time_label=True)
    else:
        over_time(axes[0], [(time, numbers(vehicle["speed_m_s"]), "", BLUE)], "m/s", "Speed over ground", seconds, 0.05,
                  time_label=True)
    if vehicle["thrust_n"]:
        load = np.abs([numbers(force) for force in vehicle["thrust_n"]])
        over_time(axes[1], [(time, load.max(axis=0), "most loaded", ORANGE), (time, load.mean(axis=0), "mean", BLUE)],
                  "N", "Thruster load", seconds, time_label=True)
    else:
        axes[1].set_axis_off()


def diver_panels(axes, diver, seconds):
    time, limits = numbers(diver["time_s"]), diver["limits"]
    column = lambda key: numbers(diver[key])
    step = iter(axes)

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
              "m/s, 1/s", "Speed and kicks", seconds, 0.2)
    over_time(next(step), [(time, column("limb_power_w"), "", BLUE)], "W", "Power of the limbs", seconds)
    over_time(next(step), [(time, column("ventilation_l_min"), "gas breathed", BLUE),
                           (time, column("oxygen_l_min"), "oxygen used", ORANGE)], "l/min", "Gas used", seconds,
              time_label=True)
    over_time(next(step), [(time, column("lungs_l"), "lungs", BLUE), (time, column("jacket_l"), "jacket", ORANGE)],
              "l", "Gas held", seconds, time_label=True)
    over_time(next(step), [(time, column("net_weight_n"), "", BLUE)], "N, down", "Weight less lift", seconds,
              time_label=True)


def vehicle_panels(axes, vehicle, seconds):
    time = numbers(vehicle["time_s"])
    over_time(axes[0], [(time, numbers(f), str(i + 1), color(i)) for i, f in enumerate(vehicle["thrust_n"])], "N",
              "Thrusters", seconds, time_label=True)
    for line in axes[0].lines:
        line.set(lw=0.8, alpha=0.85)
    over_time(axes[1], [(time, numbers(vehicle["speed_m_s"]), "", BLUE)], "m/s", "Speed over ground", seconds, 0.05,
              time_label=True)


def height_of_more(divers, vehicles):
    """Pixels that the panels on request take."""
    return DIVER_PX * len(divers) + VEHICLE_PX * len(vehicles)


def draw_more(fig, top, divers, vehicles, seconds):
    for diver in divers:
        section(fig, top, f"{short(diver['name'])}, more")
        diver_panels([area(fig, 70 + 378 * i, top + 24 + 176 * row, 70 + 378 * i + 312, top + 154 + 176 * row)
                      for row, count in enumerate((4, 3)) for i in range(count)], diver, seconds)
        top += DIVER_PX
    for vehicle in vehicles:
        section(fig, top, f"{short(vehicle['name'])}, more")
        vehicle_panels([area(fig, 70, top + 24, 770, top + 24 + 150), area(fig, 840, top + 24, 1560, top + 24 + 150)],
                       vehicle, seconds)
        top += VEHICLE_PX
