"""The figures of a task's report."""
import numpy as np

import intervals
import report
import summary

LINES = ("-", "--", ":", "-.")


def figures(task, scenario, results, style):
    groups = summary.by_condition(results)
    names = [report.words(c) for c, _ in groups]
    judged = list(dict.fromkeys(c["measure"] for c in scenario.criteria))[:6]
    if judged:
        yield "outcome.png", "The measures of the criteria by condition", _outcomes(task, scenario, judged, groups, names, style)
    shown = [m["name"] for m in task.measures if m["statistic"] not in ("ever", "duration", "share")][:4]
    if not shown or not any(r["series"] for r in results):
        return
    fig = style.figure(900, 60 + 200 * len(shown))
    for i, name in enumerate(shown):
        ax = style.area(fig, 80, 50 + 200 * i, 870, 190 + 200 * i)
        for g, (_, group) in enumerate(groups[:6]):
            for k, r in enumerate([r for r in group if r["series"]][:30]):
                ax.plot(r["series"]["t"], style.numbers(r["series"][name]), color=style.color(g), lw=0.8,
                        ls=LINES[g % 4], alpha=0.9 if len(results) < 4 else 0.5, label=names[g] if k == 0 else None)
        ax.set_ylabel(task.MEASURES[name][0])
        style.title(ax, _title(task, name))
        if i == 0:
            style.legend(ax)
    ax.set_xlabel("time, s")
    yield "task.png", "The measures of each run over time", fig


def _words(task, name):
    """The measure in words, without its unit."""
    unit = task.MEASURES[name][0]
    return (name.removesuffix("_" + unit.replace("/", "_")) if unit else name).replace("_", " ")


def _title(task, name):
    """With the formula where that says more than another name."""
    meaning = task.MEASURES[name][1]
    return _words(task, name) if meaning.isidentifier() else f"{_words(task, name)}: {meaning}"


def _outcomes(task, scenario, judged, groups, names, style):
    down = (len(judged) + 1) // 2
    fig = style.figure(900 if len(judged) > 1 else 470, 50 + 190 * down)
    for i, name in enumerate(judged):
        left, top = 80 + 440 * (i % 2), 40 + 190 * (i // 2)
        ax = style.area(fig, left, top, left + 350, top + 115)
        unit = task.MEASURES[name][0]
        (_shares if unit == "yes or no" else _dots)(ax, [summary.values_of(group, name) for _, group in groups], style)
        for c in scenario.criteria:
            if c["measure"] == name and "less" not in c:
                for key in ("at_least", "at_most"):
                    if key in c:
                        ax.axhline(c[key], color=style.RED, lw=0.9, ls="--")
        ax.set_xlim(-0.5, len(groups) - 0.5)
        ax.set_xticks(range(len(groups)), names, rotation=0 if len(groups) < 4 else 25)
        ax.set_ylabel("share of the runs" if unit == "yes or no" else unit)
        given, of = sum(len(summary.values_of(group, name)) for _, group in groups), sum(len(group) for _, group in groups)
        style.title(ax, _words(task, name) + ("" if given == of else f" ({given} of {of} runs gave a value)"))
    return fig


def _shares(ax, columns, style):
    """The share that says yes, with Wilson's interval."""
    for g, values in enumerate(columns):
        if values:
            share, low, high = intervals.share_interval(int(sum(values)), len(values))
            ax.plot([g, g], [low, high], color=style.INK, lw=1.6)
            ax.plot(g, share, "o", ms=6, color=style.color(g), mec=style.INK, mew=0.6, clip_on=False, zorder=3)
    ax.set_ylim(0, 1.03)


def _dots(ax, columns, style):
    """A dot a run, equal values side by side, and the median."""
    for g, values in enumerate(columns):
        for value in sorted(set(values)):
            n = values.count(value)
            ax.plot(g + (np.arange(n) - (n - 1) / 2) * min(0.04, 0.7 / n), [value] * n, "o", ms=4, color=style.color(g),
                    mec=style.INK, mew=0.4)
        if values:
            ax.plot([g - 0.3, g + 0.3], [float(np.median(values))] * 2, color=style.INK, lw=1.6)
