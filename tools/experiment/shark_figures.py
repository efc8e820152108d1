"""The figure and the notes of the shark's report: distances over time, times to block, and how many runs tell a difference."""
import math

import numpy as np

import intervals
import report
import summary
from shark_scene import BESIDE_M

LINES = ("-", "--", ":", "-.", (0, (1, 1)), (0, (5, 1)))  # of conditions, told apart in grey too


def _paired(results):
    """(mean time, deviation of the differences by seed) of the first two conditions; None where there are not two."""
    groups = [{r["seed"]: r["measures"]["time_to_block_s"] for r in group if "time_to_block_s" in r["measures"]}
              for _, group in summary.by_condition(results)[:2]]
    seeds = sorted(set(groups[0]) & set(groups[1])) if len(groups) == 2 else []
    if len(seeds) < 6:
        return None
    return float(np.mean(list(groups[0].values()))), float(np.std([groups[1][k] - groups[0][k] for k in seeds], ddof=1))


def notes(results):
    """Lines for the report."""
    for condition, group in summary.by_condition(results):
        times = summary.values_of(group, "time_to_block_s")
        runs = intervals.runs_to_tell(times) if len(times) >= 6 else None
        if runs:
            name = report.words(condition)
            yield (f"{name}: {runs} runs a group tell a time to block that is 10 % longer, with a power of 80 % at 5 % (two-sided, "
                   f"unpaired); by drawing groups of {max(runs, 20)} from these runs the power is "
                   f"{100 * intervals.power_by_draws(times, max(runs, 20)):.0f} %.")
    spread = _paired(results)
    if spread is not None:
        pairs = math.ceil(((intervals.Z95 + intervals.normal_quantile(0.8)) * spread[1] / (0.1 * spread[0])) ** 2)
        yield (f"With the same seeds in both conditions, by the spread of the differences between the first two, {max(2, pairs)} "
               "pairs tell it: compare conditions by factors, not by two experiments.")


def figures(scenario, results, style):
    done = [r for r in results if r["series"]]
    if not done:
        return
    groups = {}
    for r in done:
        groups.setdefault(report.words(r["condition"]), []).append(r)
    shown = list(groups.items())[:len(LINES)]
    fig = style.figure(900, 640)
    _distances(style.area(fig, 70, 60, 870, 320), shown, style)
    _shares(style.area(fig, 70, 400, 450, 590), shown, style)
    _power(style.area(fig, 520, 400, 870, 590), shown, _paired(results), style)
    yield "shark.png", "The ROV's distance from the line over time, times to block, and the power over the number of runs", fig


def _times(runs):
    return sorted(r["measures"]["time_to_block_s"] for r in runs if "time_to_block_s" in r["measures"])


def _distances(ax, groups, style):
    for i, (name, runs) in enumerate(groups):
        for k, r in enumerate(runs[:30]):
            ax.plot(r["series"]["t"], r["series"]["beside"], color=style.color(i), lw=0.8, alpha=0.6, ls=LINES[i],
                    label=name if k == 0 else None)
    ax.axhline(BESIDE_M, color=style.INK, lw=0.9, ls="--")
    ax.set_xlabel("time since the gaze met the shark, s")
    ax.set_ylabel("beside the line, m")
    style.title(ax, "Distance of the ROV from the line between diver and shark")
    style.legend(ax)


def _shares(ax, groups, style):
    for i, (_, runs) in enumerate(groups):
        times = _times(runs)
        if times:
            ax.step([0, *times], np.arange(len(times) + 1) / len(runs), where="post", color=style.color(i), lw=1.4, ls=LINES[i])
    ax.set_xlim(0, None)
    ax.set_ylim(0, 1.03)
    ax.set_xlabel("time to block, s")
    style.title(ax, "Share of the runs that blocked by then")


def _power(ax, groups, spread, style):
    n = np.unique(np.geomspace(2, 2000, 120).astype(int))
    for i, (_, runs) in enumerate(groups):
        times = _times(runs)
        if len(times) >= 6:
            ax.plot(n, [intervals.power_of(times, int(k)) for k in n], color=style.color(i), lw=1.4, ls=LINES[i])
            drawn = [20, 60, 200, 600, 2000]
            ax.plot(drawn, [intervals.power_by_draws(times, k) for k in drawn], "o", color=style.color(i), ms=4.5, mec=style.INK, mew=0.5)
    if spread is not None:
        mean, deviation = spread
        ax.plot(n, [intervals.normal_share(0.1 * mean * math.sqrt(k) / max(deviation, 1e-12) - intervals.Z95) for k in n],
                color=style.INK, lw=1.2, ls=":")
        ax.text(0.35, 0.06, "dotted: the same seeds in both groups", transform=ax.transAxes, size=7.5)
    ax.set_xscale("log")
    style.plain_log(ax.xaxis)
    ax.axhline(0.8, color=style.INK, lw=0.9, ls="--")
    ax.set_ylim(0, 1.03)
    ax.set_xlabel("runs a group")
    style.title(ax, "Power to tell 10 % more time (dots: by draws)")
