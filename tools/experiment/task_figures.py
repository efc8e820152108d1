"""The figures of a task's report: the measures of the criteria by condition, and each run's measures over time, a stage's in that
stage alone."""
import textwrap

import numpy as np

import intervals
import report
import summary

FOOT = 150  # characters of a line at the foot of 900 pixels
MOST, ACROSS, RUNS, MEASURES, JUDGED = 12, 4, 30, 4, 6  # conditions, panels in a row, runs a panel; measures of each figure


def figures(task, scenario, results, style):
    groups = summary.by_condition(results)
    names = report.names([c for c, _ in groups])
    judged = list(dict.fromkeys(c["measure"] for c in scenario.criteria))
    if judged:
        told = [report.left_out(MOST, len(groups), "conditions"), report.left_out(JUDGED, len(judged), "measures")]
        marks = _marks(task, scenario, judged[:JUDGED])
        yield "outcome.png", " ".join(["The measures of the criteria by condition.", marks, *filter(None, told)]), \
            _outcomes(task, scenario, judged[:JUDGED], groups[:MOST], names, [marks, *told], style)
    over_time = [m for m in task.measures if m["statistic"] not in ("ever", "duration", "share")]
    if not over_time or not any(r["series"] for r in results):
        return
    told = [report.left_out(MOST, len(groups), "conditions"), report.left_out(MEASURES, len(over_time), "measures"),
            report.left_out(RUNS, max(len(group) for _, group in groups), "runs of a condition")]
    yield "task.png", " ".join(["The measures of each run over time, a panel a condition.", *filter(None, told)]), \
        _over_time(task, over_time[:MEASURES], groups[:MOST], names, told, style)


def _over_time(task, shown, groups, names, told, style):
    """For each measure a panel a condition, over the time of whole runs."""
    across = report.columns(names[:len(groups)], ACROSS)
    down = -(-len(groups) // across)
    tall, wide = 165, (800 if across == 1 else 820) // across
    block = 40 + tall * down
    fig = style.figure(900, 30 + block * len(shown))
    width, height = fig.get_size_inches() * style.DPI
    for m, measure in enumerate(shown):
        name, top = measure["name"], 20 + block * m
        fig.text(24 / width, 1 - (top + 8) / height, style.short(_title(task, measure), 120), size=10, weight="bold", color=style.INK)
        curves = [[(r["series"]["t"], _curve(task, measure, r["series"], style)) for r in group[:RUNS] if r["series"]] for _, group in groups]
        values = [v for of in curves for _, v in of]
        # Flat curves get ticks of few digits.
        least = max(1e-6, 0.02 * max([float(np.abs(v[np.isfinite(v)]).max()) for v in values if np.isfinite(v).any()], default=1.0))
        last = max(t[-1] for of in curves for t, _ in of)
        for g, of in enumerate(curves):
            left, up = 80 + wide * (g % across), top + 40 + tall * (g // across)
            ax = style.area(fig, left, up, left + wide - (50 if across > 1 else 10), up + tall - 65)
            for t, v in of:
                alone = "." if np.isfinite(v).sum() == 1 else None
                ax.plot(t, v, color=style.BLUE, lw=1.0, marker=alone, alpha=1.0 if len(of) < 4 else 0.7)
            if not any(np.isfinite(v).any() for _, v in of):
                ax.text(0.5, 0.5, "no value", transform=ax.transAxes, ha="center", va="center", color=style.INK, size=8)
            style.room(ax, values, least)
            ax.set_xlim(0, 1.02 * last)
            ax.set_ylabel(task.MEASURES[name][0] if g % across == 0 else "")
            if g + across >= len(groups):
                ax.set_xlabel("time, s")
            if len(groups) > 1:
                style.title(ax, style.short(names[g], 110 // across), 8)
    _tell(fig, told, style)
    return fig


def _marks(task, scenario, judged):
    """What the marks of the outcomes' figure mean, of those that it has."""
    share = [task.MEASURES[name][0] == "yes or no" for name in judged]
    drawn = [c for c in scenario.criteria if c["measure"] in judged and "less" not in c]
    return " ".join(filter(None, [
        "" if all(share) else "A dot is a run, a thick bar the median.",
        ("A dot with a line is a share and its 95 % interval." if all(share) else "Of shares, the dot is the share, the line its 95 % interval.")
        if any(share) else "",
        "Red, dashed: a criterion's limit." if drawn else ""]))


def _tell(fig, told, style):
    """What the marks mean and what is left out, at the foot, a line each FOOT characters or less."""
    width, height = (v * style.DPI for v in fig.get_size_inches())
    lines = textwrap.wrap(" ".join(filter(None, told)), int(FOOT * width / 900))
    if lines:
        fig.text(24 / width, 8 / height, "\n".join(lines), size=8, color=style.INK, va="bottom")


def _words(task, name):
    """The measure in words, without its unit."""
    unit = task.MEASURES[name][0]
    unit = {"degrees": "deg"}.get(unit, unit.replace("/", "_"))
    return (name.removesuffix("_" + unit) if unit else name).replace("_", " ")


def _curve(task, measure, series, style):
    """A run's measure at each time of its series; NaN outside of the stage that it is of."""
    values = style.numbers(series[measure["name"]])
    if measure["stage"] is None:
        return values
    stage = [s["name"] for s in task.stages].index(measure["stage"])
    return np.where(np.array(series["stage"]) == stage, values, np.nan)


def _title(task, measure):
    """With what it means, and in which stage."""
    meaning, stage = task.MEASURES[measure["name"]][1], measure["stage"]
    of = f" (stage {stage.replace('_', ' ')})" if stage and f"in the stage {stage}" not in meaning else ""
    return f"{_words(task, measure['name'])}{of}: {meaning}"


def _outcomes(task, scenario, judged, groups, names, told, style):
    """A panel a measure, a row a condition with its name at the left."""
    down = (len(judged) + 1) // 2
    labels = [n.replace(", ", ",\n") if len(n) > 26 else n for n in names[:len(groups)]]  # a factor a line where they are long
    tall = max(60, sum(14 + 12 * (n.count("\n") + 1) for n in labels))
    room = min(180, 20 + 6 * max(len(part) for n in labels for part in n.split("\n"))) if len(groups) > 1 else 40
    wide = 900 if len(judged) > 1 else 470
    lines = len(textwrap.wrap(" ".join(filter(None, told)), int(FOOT * wide / 900)))
    fig = style.figure(wide, 40 + (tall + 85) * down + 13 * lines)
    for i, name in enumerate(judged):
        left, top = room + 440 * (i % 2), 40 + (tall + 85) * (i // 2)
        ax = style.area(fig, left, top, 430 + 440 * (i % 2), top + tall)
        unit = task.MEASURES[name][0]
        (_shares if unit == "yes or no" else _dots)(ax, [summary.values_of(group, name) for _, group in groups], style)
        for c in scenario.criteria:
            if c["measure"] == name and "less" not in c:
                for key in ("at_least", "at_most"):
                    if key in c:
                        ax.axvline(c[key], color=style.RED, lw=1.2, ls="--")
        ax.set_ylim(len(groups) - 0.5, -0.5)
        ax.set_yticks(range(len(groups)), ["\n".join(style.short(part, 28) for part in n.split("\n")) for n in labels] if len(groups) > 1 else [""])
        given, of = sum(len(summary.values_of(group, name)) for _, group in groups), sum(len(group) for _, group in groups)
        ax.set_xlabel(("share of the runs" if unit == "yes or no" else unit or _words(task, name))
                      + ("" if given == of else f"; {given} of {of} runs gave a value"))
        style.title(ax, style.short(_words(task, name), 40))
    _tell(fig, told, style)
    return fig


def _shares(ax, columns, style):
    """The share that says yes, with Wilson's interval."""
    for g, values in enumerate(columns):
        if values:
            share, low, high = intervals.share_interval(int(sum(values)), len(values))
            ax.plot([low, high], [g, g], color=style.INK, lw=1.6)
            ax.plot(share, g, "o", ms=6, color=style.BLUE, mec=style.INK, mew=0.6, clip_on=False, zorder=3)
    ax.set_xlim(0, 1.03)


def _dots(ax, columns, style):
    """A dot a run, equal values beside each other, and the median as a bar."""
    for g, values in enumerate(columns):
        for value in sorted(set(values)):
            n = values.count(value)
            ax.plot([value] * n, g + (np.arange(n) - (n - 1) / 2) * min(0.08, 0.7 / n), "o", ms=4.5, color=style.BLUE,
                    mec=style.INK, mew=0.4, zorder=4)
        if values:
            ax.plot([float(np.median(values))] * 2, [g - 0.35, g + 0.35], color=style.INK, lw=2.0)
