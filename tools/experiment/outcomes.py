"""`neritic tradeoff experiment`: what speed costs in truth at the level that matters, the outcome. The task `shark` is run
with one knob turned at a time: time to block and success, over what a run costs by the clock.

Each knob is a scenario of its own in OUT/KNOB, with all of its runs; --resume goes on. OUT gets outcomes.csv, outcomes.json,
outcomes.png and index.html.
"""
import csv
import html
import io
import json
import math
import os

import intervals
import provenance
import report
import scenario
from summary import values_of

# (knob, levels from cheap and rough to costly and fine, other settings, what it is)
LOOKS = ['detector="shipped"', "detector_least=0.6"]
KNOBS = [
    ("physics_hz", [60, 120, 240, 480, 960], [], "physics, steps a second"),
    ("control_hz", [1.0, 2.0, 5.0, 10.0, 20.0, 60.0], [], "the ROV is told its place, times a second"),
    ("delay_s", [0.0, 0.1, 0.2, 0.5, 1.0], [], "delay of the detector's word, s"),
    ("navigation", ["truth", "measured"], [], "the ROV flies by"),
    ("crop_px", [16, 24, 32, 48, 64], LOOKS, "side of the gaze crops, pixels"),
    ("detector", ["assumed", "small", "shipped"], LOOKS[1:], "network that looks: none, small, large"),
    ("sonar_quality", ["draft", "standard", "reference"], ['shark_known_by="sonar"'], "quality of the sonar that knows the shark"),
]
RUNS = 30
QUICK_RUNS = 6  # the fewest whose median has an interval
# Of knobs whose runs draw pictures or pings: --quick leaves out the other levels.
QUICK_LEVELS = {"crop_px": [16, 48], "detector": ["assumed", "shipped"], "sonar_quality": ["draft", "standard"]}


def knobs(quick):
    return [(knob, QUICK_LEVELS.get(knob, levels) if quick else levels, others, words) for knob, levels, others, words in KNOBS]


def plans(kinds, asked):
    """The scenario of each knob, all checked before the first runs."""
    out = []
    for i, (knob, levels, others, words) in enumerate(knobs(asked.quick)):
        # From 1.0 to 1.5 m beside, where times spread least: shark_delay's, without its delay.
        sets = ["delay_s=0.0", f"{knob}={json.dumps(levels)}", *others, *asked.set]
        plan = scenario.Scenario(scenario.path_of("shark_delay"), kinds, asked.runs or (QUICK_RUNS if asked.quick else RUNS), asked.seed, sets)
        plan.told_as = f"{i + 1} of {len(KNOBS)}: {knob}"
        plan.criteria = []
        plan.title = f"Time to block over {words}"
        plan.about = (f"The task of the shark, the ROV from 1.0 to 1.5 m beside, with one knob turned: {words}. Its levels: "
                      f"{', '.join(report.number(level) for level in levels)}.")
        out.append(plan)
    return out


def run(kinds, one, asked):
    """one(plan): the runner of a scenario, as __main__ has it. Returns the summaries."""
    rows = []
    for (knob, levels, _, _), plan in zip(knobs(asked.quick), plans(kinds, asked)):
        results = one(plan, os.path.join(asked.out, knob))
        for level in levels:
            of = [r for r in results if r["condition"].get(knob) == level]
            times = values_of(of, "time_to_block_s")
            # A run that did not block took longer than any: left out, it would make a level seem as fast as its best runs.
            middle, low, high = (_finite(v) for v in intervals.median_interval(times + [math.inf] * (len(of) - len(times))))
            blocked = sum(1 for r in of if r["measures"].get("blocked_in_3_s"))
            share, share_low, share_high = intervals.share_interval(blocked, len(of))
            worked = sorted(r["processor_s"] for r in of)
            rows.append({"knob": knob, "level": level, "seed": plan.seed, "last_seed": plan.seed + plan.runs - 1, "runs": len(of),
                         "time_to_block_s": middle, "time_low_s": low, "time_high_s": high, "blocked_in_3_s": share,
                         "share_low": share_low, "share_high": share_high, "processor_s": worked[len(worked) // 2]})
    _write(rows, asked.out, provenance.of(asked.program))
    return rows


def _time(row):
    return "half or more did not block" if row["time_to_block_s"] is None else f"{report.number(row['time_to_block_s'])} s"


def _finite(value):
    return value if value is not None and math.isfinite(value) else None


def _write(rows, out, made_by):
    text = io.StringIO()
    table = csv.DictWriter(text, list(rows[0]), lineterminator="\n")
    table.writeheader()
    table.writerows(rows)
    report.write_file(os.path.join(out, "outcomes.csv"), text.getvalue())
    report.write_file(os.path.join(out, "outcomes.json"), json.dumps(rows, indent=2) + "\n")
    try:
        import style
    except ModuleNotFoundError as error:
        if (error.name or "").split(".")[0] != "matplotlib":
            raise
    else:
        buffer = io.BytesIO()
        _figure(rows, style).savefig(buffer, format="png", metadata={"Software": None})
        report.write_file(os.path.join(out, "outcomes.png"), buffer.getvalue())
    cells = "".join(
        f"<tr><td><a href=\"{r['knob']}/report.html\">{r['knob']}</a></td><td>{html.escape(report.number(r['level']))}</td>"
        f"<td>{_time(r)}</td><td>{report.interval({'low': r['time_low_s'], 'high': r['time_high_s']})}</td>"
        f"<td>{100 * r['blocked_in_3_s']:.0f} %</td><td>{r['processor_s']:.2f} s</td><td>{r['runs']}</td></tr>" for r in rows)
    page = (f"<!DOCTYPE html><html lang=\"en\"><meta charset=\"utf-8\"><title>Outcomes</title><style>{report.STYLE}</style>"
            "<h1>What speed costs in the outcome</h1><p class=\"about\">The task of the shark, one knob turned at a time: median "
            "time to block, with its 95 % interval (a run that did not block counts as longer than any), the share that blocked within 3 s, "
            f"and the median processor time of a run (seconds of one core). The same seeds everywhere, {report.seeds(rows[0])}.</p>"
            f"<p>Made by {html.escape(report.made_by(made_by))}.</p><p><img src=\"outcomes.png\" alt=\"Time to block and success over "
            "each knob\"></p><table><tr><th>knob</th><th>level</th><th>time to block</th><th>95 % interval</th>"
            f"<th>within 3 s</th><th>a run takes</th><th>runs</th></tr>{cells}</table></html>\n")
    report.write_file(os.path.join(out, "index.html"), page)


def _figure(rows, style):
    """A row of three panels a pair of knobs: time to block by level; the share within 3 s as the number above; cost below."""
    names = list(dict.fromkeys(r["knob"] for r in rows))
    words = {k[0]: k[3] for k in KNOBS}
    across = 3
    down = -(-len(names) // across)
    fig = style.figure(940, 70 + 250 * down)
    top = max([r[k] for r in rows for k in ("time_low_s", "time_to_block_s", "time_high_s") if r[k] is not None], default=1.0) * 1.15
    for i, knob in enumerate(names):
        of = [r for r in rows if r["knob"] == knob]
        left, up = 62 + 305 * (i % across), 62 + 250 * (i // across)
        ax = style.area(fig, left, up, left + 235, up + 160)
        for k, r in enumerate(of):
            if r["time_low_s"] is not None:
                # Without an upper limit it goes on above the panel.
                ax.plot([k, k], [r["time_low_s"], r["time_high_s"] if r["time_high_s"] is not None else 2 * top], color=style.BLUE, lw=1.6)
            if r["time_to_block_s"] is not None:
                ax.plot(k, r["time_to_block_s"], "o", color=style.BLUE, ms=6, mec=style.INK, mew=0.6)
            else:
                ax.plot(k, 0.84 * top, "^", color=style.BLUE, ms=6, mec=style.INK, mew=0.6)
            ax.text(k, top * 0.93, f"{100 * r['blocked_in_3_s']:.0f} %", ha="center", size=7, zorder=6,
                    bbox={"fc": ax.get_facecolor(), "ec": "none", "pad": 1})
        ax.set_ylim(0, top)
        ax.set_xlim(-0.5, len(of) - 0.5)
        ax.set_xticks(range(len(of)), [f"{report.number(r['level'])}\n({r['processor_s']:.2g})" for r in of], size=7)
        ax.set_xlabel("level (and a run's seconds of one core)", size=7.5)
        if i % across == 0:
            ax.set_ylabel("time to block, s")
        style.title(ax, words[knob], 8.5)
    width, height = fig.get_size_inches() * style.DPI
    fig.text(24 / width, 1 - 16 / height, "Median and 95 % interval of the time to block; above, the share that blocked within 3 s", size=9)
    fig.text(24 / width, 1 - 32 / height, "A run that did not block counts as longer than any; triangle: half or more did not block", size=8)
    return fig
