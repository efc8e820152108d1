"""The figure and the notes of the shark's report: distances over time, times to block, and how many runs tell a difference."""
import numpy as np

import intervals
import report
import summary
from shark_scene import BESIDE_M

ENOUGH = 0.9  # the share of runs that must block for their times to tell a power: those of the others are cut off
LINES = ("-", "--", ":", "-.", (0, (6, 1, 1, 1, 1, 1)), (0, (8, 2)))  # of conditions, told apart in grey too, as by
MARKS = ("o", "s", "^", "D", "v", "P", "X")
MOST, ACROSS, RUNS = 12, 3, 30  # panels of conditions, in a row; runs a panel


def _enough(runs):
    return len(_times(runs)) >= max(6, ENOUGH * len(runs))


def _paired(results):
    """(mean time, deviation of the differences by seed) of the first two conditions; None where there are not two, or where
    too few of their runs blocked."""
    groups = [group for _, group in summary.by_condition(results)[:2]]
    if len(groups) < 2 or not all(_enough(group) for group in groups):
        return None
    times = [{r["seed"]: r["measures"]["time_to_block_s"] for r in group if "time_to_block_s" in r["measures"]} for group in groups]
    seeds = sorted(set(times[0]) & set(times[1]))
    if len(seeds) < 6:
        return None
    return float(np.mean(list(times[0].values()))), float(np.std([times[1][k] - times[0][k] for k in seeds], ddof=1))


def notes(results):
    """Lines for the report."""
    for condition, group in summary.by_condition(results):
        times, name = summary.values_of(group, "time_to_block_s"), report.words(condition)
        blocked = f"{len(times)} of {len(group)} runs blocked"
        if len(group) >= 6 and not _enough(group):
            yield (f"{name}: {blocked}. The times of the others are longer than a run, so these tell no power: compare the shares "
                   "that blocked.")
            continue
        runs = intervals.runs_to_tell(times) if _enough(group) else None
        if runs:
            yield (f"{name}: {runs} runs a group tell a time to block that is 10 % longer, with a power of 80 % at 5 % (two-sided, "
                   f"unpaired); by drawing groups of {max(runs, 20)} from these runs the power is "
                   f"{100 * intervals.power_by_draws(times, max(runs, 20)):.0f} %."
                   + (f" This is of those that blocked: {blocked}." if len(times) < len(group) else ""))
    spread = _paired(results)
    if spread is not None:
        pairs = intervals.pairs_to_tell(0.1 * spread[0], spread[1])
        yield (f"With the same seeds in both conditions, by the spread of the differences between the first two, {pairs} "
               "pairs tell it (paired t test, at least 3): compare conditions by factors, not by two experiments.")


def figures(scenario, results, style):
    if not any(r["series"] for r in results):
        return
    groups = summary.by_condition(results)
    shown = list(zip(report.names([c for c, _ in groups]), (runs for _, runs in groups)))[:MOST]
    across = report.columns([name for name, _ in shown], ACROSS)
    down = -(-len(shown) // across)
    tall = 190 if len(shown) > 1 else 260
    low = 60 + tall * down + (16 * -(-len(shown) // across) + 30 if len(shown) > 1 else 20)  # where the curves below begin
    fig = style.figure(900, low + 260)
    _distances(fig, shown, across, tall, style)
    _shares(style.area(fig, 70, low, 450, low + 190), shown, style)
    _power(style.area(fig, 520, low, 870, low + 190), shown, _paired(results), style)
    width, height = fig.get_size_inches() * style.DPI
    if len(shown) > 1:
        from matplotlib.lines import Line2D
        lines = [Line2D([], [], color=style.color(i), lw=2.0, ls=LINES[i % len(LINES)], marker=MARKS[i % len(MARKS)], ms=4.5, mec=style.INK, mew=0.5)
                 for i in range(len(shown))]
        fig.legend(lines, [name for name, _ in shown], loc="lower left", bbox_to_anchor=(60 / width, 1 - (low - 24) / height), ncol=across,
                   frameon=False, fontsize=8, handlelength=4.5, borderaxespad=0)
    told = [report.left_out(len(shown), len(groups), "conditions"),
            report.left_out(RUNS, max(len(runs) for _, runs in shown), "runs of a condition are drawn as lines")]
    told = " ".join(t for t in told if t)
    if told:
        fig.text(24 / width, 12 / height, told, size=8, color=style.INK)
    yield "shark.png", "The ROV's distance from the line over time, times to block, and the power over the number of runs. " + told, fig


def _times(runs):
    return sorted(r["measures"]["time_to_block_s"] for r in runs if "time_to_block_s" in r["measures"])


def _distances(fig, groups, across, tall, style):
    """A panel a condition."""
    width, height = fig.get_size_inches() * style.DPI
    every = [r for _, runs in groups for r in runs[:RUNS] if r["series"].get("t")]
    most = max([max(r["series"]["beside"]) for r in every], default=1.0)
    last = max([r["series"]["t"][-1] for r in every], default=1.0)
    fig.text(24 / width, 1 - 22 / height, "Distance of the ROV from the line between diver and shark; dashed: near enough to block", size=10)
    wide = 800 // across
    for i, (name, runs) in enumerate(groups):
        left, top = 70 + wide * (i % across), 60 + tall * (i // across)
        ax = style.area(fig, left, top, left + wide - (35 if across > 1 else 0), top + tall - 75)
        begun = [r for r in runs[:RUNS] if r["series"].get("t")]
        for r in begun:
            ax.plot(r["series"]["t"], r["series"]["beside"], color=style.BLUE, lw=1.0, alpha=0.8)
        if not begun:
            ax.text(0.5, 0.5, "no run began: nothing met the shark", transform=ax.transAxes, ha="center", va="center", color=style.INK, size=8)
        ax.axhline(BESIDE_M, color=style.INK, lw=1.2, ls="--")
        ax.set_xlim(0, 1.02 * last)
        ax.set_ylim(0, 1.05 * most)
        if i % across == 0:
            ax.set_ylabel("beside the line, m")
        if i + across >= len(groups):
            ax.set_xlabel("time since the gaze met the shark, s")
        style.title(ax, style.short(name, 120 // across), 9)


def _shares(ax, groups, style):
    for i, (_, runs) in enumerate(groups):
        times = _times(runs)
        if times:
            ax.step([0, *times], np.arange(len(times) + 1) / len(runs), where="post", color=style.color(i), lw=2.0,
                    ls=LINES[i % len(LINES)])
    ax.set_xlim(0, None)
    ax.set_ylim(0, 1.03)
    ax.set_xlabel("time to block, s")
    style.title(ax, "Share of the runs that blocked by then")
    if not any(_times(runs) for _, runs in groups):
        ax.text(0.5, 0.5, "no run blocked", transform=ax.transAxes, ha="center", va="center", color=style.INK, size=9)


def _power(ax, groups, spread, style):
    n = np.unique(np.geomspace(3, 2000, 60).astype(int))
    for i, (_, runs) in enumerate(groups):
        times = _times(runs)
        if _enough(runs):
            ax.plot(n, [intervals.power_of(times, int(k)) for k in n], color=style.color(i), lw=1.8,
                    ls=LINES[i % len(LINES)])
            drawn = [20, 60, 200, 600, 2000]
            ax.plot(drawn, [intervals.power_by_draws(times, k) for k in drawn], MARKS[i % len(MARKS)], color=style.color(i), ms=5,
                    mec=style.INK, mew=0.5)
    words = ["runs a group"]
    if spread is not None:
        mean, deviation = spread
        ax.plot(n, [intervals.paired_power(0.1 * mean, deviation, int(k)) for k in n],
                color=style.INK, lw=1.2, ls=":")
        words[0] += " (dotted: the same seeds in both groups)"
    few = sum(not _enough(runs) for _, runs in groups)
    if few:
        words.append(f"not shown: {few} of {len(groups)} conditions, in which too few runs blocked")
    ax.set_xscale("log")
    style.plain_log(ax.xaxis)
    ax.axhline(0.8, color=style.INK, lw=0.9, ls="--")
    ax.set_xlim(n[0] / 1.4, n[-1] * 1.4)
    ax.set_ylim(0, 1.03)
    words[0] += "; dashed: 80 %"
    ax.set_xlabel("\n".join(words))
    style.title(ax, "Power to tell 10 % more time (marks: by draws)")
