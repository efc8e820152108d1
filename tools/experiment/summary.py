"""From the results of single runs to a summary by condition, and whether the scenario's criteria hold."""
import collections
import itertools
import json
import math

import intervals as ours
import runner


def by_condition(results):
    """[(condition, results)] in the order of the runs."""
    groups = collections.OrderedDict()
    for result in results:
        groups.setdefault(json.dumps(result["condition"], sort_keys=True), []).append(result)
    return [(group[0]["condition"], group) for group in groups.values()]


def values_of(results, measure):
    """Its finite numbers in runs that gave it; a truth counts as 1 or 0."""
    found = [r["measures"].get(measure) for r in results]
    return [float(v) for v in found if v is not None and math.isfinite(v)]


def _statistic(name, values):
    if not values:
        return None
    return {"median": lambda: ours.quantile(values, 0.5), "mean": lambda: sum(values) / len(values),
            "min": lambda: min(values), "max": lambda: max(values),
            "share": lambda: sum(v > 0.5 for v in values) / len(values)}[name]()


def are_equal(results):
    """Whether runs of other seeds gave the same numbers to the bit, all measures and series: they are one run, and tell no
    interval."""
    return len(results) > 1 and bool(results[0]["measures"]) and bool(results[0].get("series")) and \
        all(r["measures"] == results[0]["measures"] and r.get("series") == results[0]["series"] for r in results[1:])


def summarise(scenario, results):
    """Plain data: {conditions: [...], criteria: [...], passed}. Broken: failed without any measure, as by an exception."""
    conditions = []
    for condition, group in by_condition(results):
        measures, equal = {}, are_equal(group)
        for name, (unit, meaning) in scenario.kind.MEASURES.items():
            values = values_of(group, name)
            if not values:
                continue
            if unit == "yes or no":
                share, low, high = ours.share_interval(int(sum(values)), len(values))
                measures[name] = {"unit": unit, "n": len(values), "share": share, "low": low, "high": high}
            else:
                middle, low, high = ours.median_interval(values)
                measures[name] = {"unit": unit, "n": len(values), "median": middle, "low": low, "high": high,
                                  "min": min(values), "max": max(values)}
            if equal:
                measures[name] |= {"low": None, "high": None}
        causes = collections.Counter(r["failure"] for r in group if r["failure"])
        absent = collections.Counter(f"{name}: {why}" for r in group for name, why in r.get("absent", {}).items())
        conditions.append({"condition": condition, "runs": len(group), "failed": sum(causes.values()),
                           "failures": dict(causes.most_common()), "absent": dict(absent.most_common()), "measures": measures,
                           "equal": equal})
    criteria = [_judge(scenario, results, part) for c in scenario.criteria for part in _by_level(scenario, c)]
    return {"experiment": scenario.name, "title": scenario.title, "about": scenario.about, "kind": scenario.kind_name,
            "seed": scenario.seed, "last_seed": max((r["seed"] for r in results), default=scenario.seed), "runs": len(results),
            "processor_s": round(sum(r["processor_s"] for r in results), 1), "failed": sum(1 for r in results if r["failure"]),
            "broken": sum(runner.is_broken(r) for r in results),
            "settings": scenario.settings, "vary": scenario.vary, "factors": scenario.factors, "compared": scenario.added,
            "conditions": conditions, "criteria": criteria, "passed": all(c["holds"] for c in criteria if c["counts"])}


def _by_level(scenario, criterion):
    """The criterion at each level of the factors that --set made and that it does not name: a claim about one robot, or one
    offset, is none about the runs of several together."""
    named = {**criterion.get("where", {}), **criterion.get("less", {})}
    free = [k for k in scenario.added if k not in named]
    for levels in itertools.product(*(scenario.factors[k] for k in free)):
        at = dict(zip(free, levels))
        parts = {part: {**criterion.get(part, {}), **at} for part in ("where", "less") if part in criterion or part == "where"}
        yield {**criterion, **parts}


def _counts(scenario, groups, criterion):
    """Whether the experiment is judged by it: not by the null robot beside others, which is there to be beaten, and not where --set left
    out the condition that the criterion is of."""
    parts = [criterion.get("where", {}), *([criterion["less"]] if "less" in criterion else [])]
    others = any(level != "null" for level in scenario.factors.get("controller", []))
    null = scenario.kind_name == "task" and others and any(p.get("controller") == "null" for p in parts) and "controller" in scenario.added
    left_out = any(not group and scenario.replaced & part.keys() for group, part in zip(groups, parts))
    return not null and not left_out


def _judge(scenario, results, criterion):
    """A run that gave no value counts as the worst there can be: above at_most, below at_least. A statistic that this leaves
    open is not determined, and the criterion does not hold. less: the same statistic of those runs is subtracted, so that two
    conditions are compared; its missing values count the other way."""
    where, less, name = criterion.get("where", {}), criterion.get("less"), criterion.get("statistic", "median")

    def chosen(condition):
        return [r for r in results if all(r["settings"].get(k) == v for k, v in condition.items())]

    groups = [chosen(c) for c in ([where] if less is None else [where, less])]
    values = [values_of(group, criterion["measure"]) for group in groups]

    def found_if(missing_are_high):
        parts = []
        for group, given, high in zip(groups, values, (missing_are_high, not missing_are_high)):
            missing = float(high) if name == "share" else math.inf if high else -math.inf
            parts.append(_statistic(name, given + [missing] * (len(group) - len(given))))
        return None if None in parts else parts[0] - sum(parts[1:])

    found, holds, missing_are_high = None, True, None
    for limit, high in (("at_least", False), ("at_most", True)):
        if limit in criterion and holds:  # what is told is what did not hold
            found, missing_are_high = found_if(high), high
            holds = found is not None and (found <= criterion[limit] if high else found >= criterion[limit])
    found = found if found is not None and math.isfinite(found) else None
    low, high = _interval(name, criterion["measure"], groups, missing_are_high) if found is not None else (None, None)
    return {"measure": criterion["measure"], "statistic": name, "where": where, "less": less, "found": found, "low": low, "high": high,
            "n": sum(len(v) for v in values), "of": sum(len(g) for g in groups), "at_most": criterion.get("at_most"), "at_least": criterion.get("at_least"),
            "holds": holds, "counts": _counts(scenario, groups, criterion)}


def _interval(statistic, measure, groups, missing_are_high):
    """(low, high) of 95 % for what a criterion found, None where it has no bound. Of one condition, or of two that share their seeds: runs
    of more share seeds, and would seem more than they are. The least and the most have none, nor have runs that are equal."""
    if any(len({json.dumps(r["condition"], sort_keys=True) for r in group}) != 1 for group in groups) or all(map(are_equal, groups)):
        return None, None
    columns = []  # {seed: value} of each group
    for group, high in zip(groups, (missing_are_high, not missing_are_high)):
        given = [(r["seed"], values_of([r], measure)) for r in group]
        columns.append({seed: v[0] if v else math.inf if high else -math.inf for seed, v in given})
    if len(columns) == 2 and columns[0].keys() != columns[1].keys():
        return None, None
    if statistic == "share":
        columns = [{seed: v > 0.5 for seed, v in c.items()} for c in columns]
    elif statistic == "mean" and any(math.isinf(v) for c in columns for v in c.values()):
        return None, None
    if len(columns) == 2:
        pairs = [(v, columns[1][seed]) for seed, v in columns[0].items()]
        of = {"median": ours.median_difference_interval, "share": ours.share_difference_interval,
              "mean": lambda pairs: ours.mean_interval([a - b for a, b in pairs])}.get(statistic)
        low, high = of(pairs)[1:] if of else (None, None)
    else:
        values = list(columns[0].values())
        of = {"median": ours.median_interval, "mean": ours.mean_interval, "share": lambda v: ours.share_interval(sum(v), len(v))}.get(statistic)
        low, high = of(values)[1:] if of else (None, None)
    return tuple(v if v is not None and math.isfinite(v) else None for v in (low, high))
