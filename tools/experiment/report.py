"""The report of an experiment: results.json, runs.csv, report.html and its figures (PNG)."""
import csv
import html
import io
import json
import os

from scenario import Failed

STYLE = """body{font:15px/1.5 "DejaVu Sans",sans-serif;max-width:60em;margin:2em auto;padding:0 1em;color:#21262e;background:#fdfcfa}
table{border-collapse:collapse;margin:1em 0}td,th{padding:.25em .7em;border-bottom:1px solid #d9d9d6;text-align:right}
td:first-child,th:first-child{text-align:left}img{max-width:100%}.no{color:#c01a1a;font-weight:bold}.about{color:#50555e}"""


def number(value):
    if value is None:
        return "–"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, str):
        return value
    return f"{value:.4g}"


def words(condition):
    return ", ".join(f"{k} {number(v)}" for k, v in condition.items()) or "all runs"


def names(conditions):
    """Words of each condition for figures: of a file its own name, with its folder where two files have one name."""
    files = {str(v) for c in conditions for v in c.values() if isinstance(v, str) and os.sep in v}
    base = [os.path.basename(f) for f in files]

    def short(value):
        if value not in files:
            return value
        name = os.path.basename(value)
        return os.path.join(os.path.basename(os.path.dirname(value)), name) if base.count(name) > 1 else name
    return [words({k: short(v) if isinstance(v, str) else v for k, v in c.items()}) for c in conditions]


def columns(labels, most, room=110):
    """Panels in a row, at most so many, whose titles of small letters have room for these labels."""
    return max(1, min(most, len(labels), room // max(1, max(map(len, labels)))))


def left_out(shown, of, what):
    """"" or what a figure does not show."""
    return "" if shown >= of else f"The first {shown} of {of} {what}; all are in runs.csv."


def claim(c):
    """ "median of time_to_block_s (delay_s 0.5) less that of delay_s 0"."""
    return (f"{c['statistic']} of {c['measure']}" + (f" ({words(c['where'])})" if c["where"] else "")
            + (f" less that of {words(c['less'])}" if c["less"] is not None else ""))


def found(c, with_interval=False):
    """The number, and of how many runs it is."""
    runs = f"{c['n']} of {c['of']} runs"
    if c["found"] is None:
        return f"not determined ({runs} gave a value)"
    return f"{number(c['found'])} ({f'{interval(c)}; ' if with_interval and interval(c) != '–' else ''}{runs})"


def interval(c):
    """Of 95 %, of what a criterion found."""
    low, high = c["low"], c["high"]
    if low is None or high is None:
        return "–" if low is high else f"{number(low)} or more" if high is None else f"{number(high)} or less"
    return f"{number(low)} to {number(high)}"


def seeds(summary):
    return f"{summary['seed']} to {summary['last_seed']}" if summary["last_seed"] > summary["seed"] else f"{summary['seed']}"


def made_by(made):
    """ "neritic 0.1.0, commit 0123456789ab with changes, program 0123456789abcdef", from provenance's data."""
    commit = "commit unknown" if made["commit"] is None else f"commit {made['commit']}{' with changes' if made['changed'] else ''}"
    return f"{made['version']}, {commit}, program {made['program']}"


INTERVALS = ("Intervals are of 95 %, of one condition: of a median by order statistics, of a share Wilson's, of a mean by Student's t. A "
             "difference of two conditions is paired by their seeds: of medians by 2000 resamplings of the pairs (expanded percentiles), of shares Newcombe's, of "
             "means by Student's t of the differences. The least and the most of runs have none.")


def verdict(c):
    """In words. The experiment is not judged by what was not run, and by what is not asked of the null robot."""
    if c["counts"]:
        return "holds" if c["holds"] else "does not hold"
    return "not asked" if c["of"] else "not run"


def _verdict_cell(c):
    words_ = verdict(c)
    return f'<span class="no">{words_}</span>' if words_ == "does not hold" else words_


def limit(criterion):
    low, high = criterion["at_least"], criterion["at_most"]
    if low is not None and high is not None:
        return f"{number(low)} to {number(high)}"
    return f"at least {number(low)}" if low is not None else f"at most {number(high)}"


def write_file(path, data):
    """Whole or not at all."""
    name = f"{path}.{os.getpid()}.tmp"
    try:
        with open(name, "wb") as file:
            file.write(data if isinstance(data, bytes) else data.encode())
        os.replace(name, path)
    except BaseException as error:  # a signal's too
        if os.path.exists(name):
            os.remove(name)
        if not isinstance(error, OSError):
            raise
        raise Failed(f"{path}: cannot be written: {error.strerror}") from None


def runs_csv(scenario, results):
    """A row a run: seed, the settings that vary, the measures, the cause of a failure."""
    varied = list(scenario.factors) + list(scenario.vary)
    out = io.StringIO()
    table = csv.writer(out, lineterminator="\n")
    table.writerow(["seed", *varied, *scenario.kind.MEASURES, "failure", "wall_s", "processor_s"])
    for r in results:
        table.writerow([r["seed"], *(r["settings"][k] for k in varied),
                        *(_cell(r["measures"].get(m)) for m in scenario.kind.MEASURES), r["failure"] or "", r["wall_s"], r["processor_s"]])
    return out.getvalue()


def _cell(value):
    return "" if value is None else int(value) if isinstance(value, bool) else repr(float(value))


def _criteria_rows(summary):
    rows = ["<tr><th>criterion</th><th>asked</th><th>found</th><th>95 % interval</th><th></th></tr>"]
    for c in summary["criteria"]:
        name = claim(c)
        rows.append(f"<tr><td>{html.escape(name)}</td><td>{limit(c)}</td><td>{found(c)}</td>"
                    f"<td>{interval(c)}</td><td>{_verdict_cell(c)}</td></tr>")
    return "<table>" + "".join(rows) + "</table>" if summary["criteria"] else ""


def _condition_table(scenario, condition):
    rows = ["<tr><th>measure</th><th>median or share</th><th>95 % interval</th><th>least to most</th><th>runs</th></tr>"]
    for name, m in condition["measures"].items():
        unit = "" if m["unit"] in ("", "yes or no") else " " + m["unit"]
        middle = f"{100 * m['share']:.1f} %" if "share" in m else number(m["median"]) + unit
        scale = 100 if "share" in m else 1
        interval = "–" if m["low"] is None else f"{number(m['low'] * scale)} to {number(m['high'] * scale)}"
        spread = "" if "share" in m else f"{number(m['min'])} to {number(m['max'])}"
        meaning = html.escape(scenario.kind.MEASURES[name][1])
        rows.append(f"<tr><td title=\"{meaning}\">{name}</td><td>{middle}</td><td>{interval}</td><td>{spread}</td>"
                    f"<td>{m['n']} of {condition['runs']}</td></tr>")
    failures = "".join(f"<p class=\"no\">{n} of {condition['runs']} runs: {html.escape(cause)}</p>"
                       for cause, n in condition["failures"].items())
    failures += "".join(f"<p>{n} of {condition['runs']} runs gave no {html.escape(why)}</p>" for why, n in condition["absent"].items())
    if condition.get("equal"):
        failures += f"<p>All {condition['runs']} runs gave the same numbers to the bit: nothing here is drawn by the seed, so there is no interval.</p>"
    return f"<h3>{html.escape(words(condition['condition']))}</h3>{failures}<table>{''.join(rows)}</table>"


def setting(summary, name):
    """Its value; of a factor all levels, of one that is drawn its range."""
    if name in summary["factors"]:
        return " / ".join(number(v) for v in summary["factors"][name])
    if name in summary["vary"]:
        return " to ".join(number(v) for v in summary["vary"][name])
    return number(summary["settings"][name])


MOST_COLUMNS = 5


def comparison(summary):
    """Lines of text: the measures, side by side for each condition; none where --set made no factor."""
    conditions = summary["conditions"]
    if not summary["compared"] or len(conditions) < 2:
        return []
    if len(conditions) > MOST_COLUMNS:
        return [f"numbers of {len(conditions)} conditions are in report.html"]
    names = list(dict.fromkeys(name for c in conditions for name in c["measures"]))
    rows = [["median or share (95 % interval)", *(words(c["condition"]) for c in conditions)]]
    for name in names:
        found_ = [c["measures"].get(name) for c in conditions]
        unit = next(m["unit"] for m in found_ if m)
        told = unit in ("", "yes or no") or name.endswith(f"_{unit}")
        rows.append([name if told else f"{name} ({unit})", *(_short(m) for m in found_)])
    rows.append(["runs", *(str(c["runs"]) for c in conditions)])
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    return ["  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip() for row in rows]


def _short(m):
    if m is None:
        return "–"
    scale, unit = (100, " %") if "share" in m else (1, "")
    middle = number(m.get("share", m.get("median")) * scale)
    spread = "" if m["low"] is None else f" ({number(m['low'] * scale)} to {number(m['high'] * scale)})"
    return middle + unit + spread


def page(scenario, summary, pictures, results=()):
    parts = [f"<!DOCTYPE html><html lang=\"en\"><meta charset=\"utf-8\"><title>{html.escape(scenario.title)}</title>"
             f"<style>{STYLE}</style><h1>{html.escape(scenario.title)}</h1>",
             f"<p class=\"about\">{html.escape(scenario.about)}</p>",
             f"<p>{summary['runs']} runs, of each condition with the seeds {seeds(summary)}; {summary['failed']} failed. "
             "Medians and shares of a condition are of the runs that gave a value; a criterion counts a run without one as the worst there "
             f"can be, in its interval too. {INTERVALS}</p><p>Made by {html.escape(made_by(summary['made_by']))}.</p>",
             _criteria_rows(summary)]
    if hasattr(scenario.kind, "notes"):
        parts += [f"<p>{html.escape(line)}</p>" for line in scenario.kind.notes(results)]
    parts += [f"<p><img src=\"{name}\" alt=\"{html.escape(alt)}\"></p>" for name, alt in pictures]
    parts += [_condition_table(scenario, c) for c in summary["conditions"]]
    meanings = "".join(f"<tr><td>{k}</td><td style=\"text-align:left\">{html.escape(v[1])}</td></tr>"
                       for k, v in scenario.kind.MEASURES.items())
    settings = "".join(f"<tr><td>{k}</td><td>{html.escape(setting(summary, k))}</td><td style=\"text-align:left\">"
                       f"{html.escape(scenario.kind.SETTINGS[k].meaning)}</td></tr>" for k in summary["settings"])
    parts.append(f"<h2>Measures</h2><table>{meanings}</table><h2>Settings</h2><table>{settings}</table></html>")
    return "\n".join(parts)


def write(scenario, results, summary, out):
    """All files of one experiment; returns a note where matplotlib is missing, else None."""
    write_file(os.path.join(out, "results.json"), json.dumps(summary, indent=2) + "\n")
    write_file(os.path.join(out, "runs.csv"), runs_csv(scenario, results))
    pictures, note = [], None
    try:
        import style  # of tools/plot; imports matplotlib
        for name, alt, figure in scenario.kind.figures(scenario, results, style):
            buffer = io.BytesIO()
            figure.savefig(buffer, format="png", metadata={"Software": None})
            write_file(os.path.join(out, name), buffer.getvalue())
            pictures.append((name, alt))
    except ModuleNotFoundError as error:
        if (error.name or "").split(".")[0] != "matplotlib":
            raise
        note = "figures are not drawn: no matplotlib here; tools/setup plots installs it"
    write_file(os.path.join(out, "report.html"), page(scenario, summary, pictures, results))
    return note


def index(summaries, failed, missing, out):
    """One page of results over several experiments. failed: [(experiment, why)]; missing: names not yet run."""
    rows = ["<tr><th>experiment</th><th>criterion</th><th>asked</th><th>found</th><th>95 % interval</th><th></th><th>runs</th><th>seeds</th>"
            "<th>one core, s</th></tr>"]
    for s in summaries:
        for i, c in enumerate(s["criteria"]):
            first = i == 0
            name = f"<a href=\"{s['experiment']}/report.html\">{s['experiment']}</a>" if first else ""
            count, of, cost = (f"{s['runs']}", seeds(s), f"{s['processor_s']:.0f}") if first else ("", "", "")
            rows.append(f"<tr><td>{name}</td><td style=\"text-align:left\">{html.escape(claim(c))}</td><td>{limit(c)}</td>"
                        f"<td>{found(c)}</td><td>{interval(c)}</td><td>{_verdict_cell(c)}</td><td>{count}</td><td>{of}</td><td>{cost}</td></tr>")
    for name, why in failed:
        rows.append(f"<tr><td>{name}</td><td colspan=\"8\" style=\"text-align:left\"><span class=\"no\">could not be done:</span> "
                    f"{html.escape(why)}</td></tr>")
    for name in missing:
        rows.append(f"<tr><td>{name}</td><td colspan=\"8\" style=\"text-align:left\">not run yet</td></tr>")
    judged = [c["holds"] for s in summaries for c in s["criteria"] if c["counts"]]
    told = (f"{sum(judged)} of {len(judged)} criteria hold; {sum(s['runs'] for s in summaries)} runs took "
            f"{sum(s['processor_s'] for s in summaries) / 60:.1f} minutes of one core.")
    made = "".join(f"<p>Made by {html.escape(line)}.</p>" for line in dict.fromkeys(made_by(s["made_by"]) for s in summaries))
    text = (f"<!DOCTYPE html><html lang=\"en\"><meta charset=\"utf-8\"><title>Experiments</title><style>{STYLE}</style>"
            f"<h1>Experiments</h1><p>{told}</p><p>{INTERVALS}</p>{made}<table>{''.join(rows)}</table></html>")
    write_file(os.path.join(out, "index.html"), text + "\n")
