"""The figures of a task's report."""
import numpy as np

import summary


def figures(task, scenario, results, style):
    groups = summary.by_condition(results)
    names = [", ".join(f"{k} {v}" for k, v in c.items()) or "all runs" for c, _ in groups]
    judged = list(dict.fromkeys(c["measure"] for c in scenario.criteria if "less" not in c))[:6]
    if judged:
        yield "outcome.png", "The measures of the criteria, a dot a run", _dots(task, scenario, judged, groups, names, style)
    shown = [m["name"] for m in task.measures if m["statistic"] not in ("ever", "duration", "share")][:4]
    if not shown or not any(r["series"] for r in results):
        return
    fig = style.figure(900, 60 + 200 * len(shown))
    for i, name in enumerate(shown):
        ax = style.area(fig, 80, 50 + 200 * i, 870, 190 + 200 * i)
        for g, (_, group) in enumerate(groups[:6]):
            for k, r in enumerate([r for r in group if r["series"]][:30]):
                ax.plot(r["series"]["t"], style.numbers(r["series"][name]), color=style.color(g), lw=0.8,
                        ls=("-", "--", ":", "-.")[g % 4], alpha=0.9 if len(results) < 4 else 0.5, label=names[g] if k == 0 else None)
        ax.set_ylabel(task.MEASURES[name][0])
        style.title(ax, f"{name}: {task.MEASURES[name][1]}" if task.MEASURES[name][1] != name else name)
        if i == 0:
            style.legend(ax)
    ax.set_xlabel("time, s")
    yield "task.png", "The measures of each run over time", fig


def _dots(task, scenario, judged, groups, names, style):
    fig = style.figure(900, 50 + 190 * ((len(judged) + 1) // 2))
    for i, name in enumerate(judged):
        left, top = 80 + 440 * (i % 2), 40 + 190 * (i // 2)
        ax = style.area(fig, left, top, left + 350, top + 115)
        for g, (_, group) in enumerate(groups):
            values = summary.values_of(group, name)
            # Equal values side by side, so that each run is seen.
            for value in sorted(set(values)):
                n = values.count(value)
                ax.plot(g + (np.arange(n) - (n - 1) / 2) * min(0.04, 0.7 / n), [value] * n, "o", ms=4, color=style.color(g),
                        mec=style.INK, mew=0.4)
            if values:
                ax.plot([g - 0.3, g + 0.3], [float(np.median(values))] * 2, color=style.INK, lw=1.6)
        for c in scenario.criteria:
            if c["measure"] == name and "less" not in c:
                for key in ("at_least", "at_most"):
                    if key in c:
                        ax.axhline(c[key], color=style.RED, lw=0.9, ls="--")
        ax.set_xlim(-0.5, len(groups) - 0.5)
        ax.set_xticks(range(len(groups)), names, rotation=0 if len(groups) < 4 else 25)
        ax.set_ylabel(task.MEASURES[name][0])
        style.title(ax, name)
    return fig
