"""From the results of single runs to a summary by condition, and whether the scenario's criteria hold."""
import collections
import json
import math

import intervals as ours


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


def summarise(scenario, results):
    """Plain data: {conditions: [...], criteria: [...], passed}."""
    conditions = []
    for condition, group in by_condition(results):
        measures = {}
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
        causes = collections.Counter(r["failure"] for r in group if r["failure"])
        conditions.append({"condition": condition, "runs": len(group), "failed": sum(causes.values()),
                           "failures": dict(causes.most_common()), "measures": measures})
    criteria = [_judge(scenario, results, c) for c in scenario.criteria]
    return {"experiment": scenario.name, "title": scenario.title, "about": scenario.about, "kind": scenario.kind_name,
            "seed": scenario.seed, "runs": len(results),
            "processor_s": round(sum(r["processor_s"] for r in results), 1), "failed": sum(1 for r in results if r["failure"]),
            "settings": scenario.settings, "vary": scenario.vary, "factors": scenario.factors,
            "conditions": conditions, "criteria": criteria, "passed": all(c["holds"] for c in criteria)}


def _judge(scenario, results, criterion):
    """less: the same statistic of those runs is subtracted, so that two conditions are compared."""
    where, less, name = criterion.get("where", {}), criterion.get("less"), criterion.get("statistic", "median")

    def of(condition):
        chosen = [r for r in results if all(r["settings"].get(k) == v for k, v in condition.items())]
        values = values_of(chosen, criterion["measure"])
        # A run that failed has no value: a share counts it against the criterion.
        if name == "share":
            values += [1.0 if "at_most" in criterion else 0.0] * (len(chosen) - len(values))
        return _statistic(name, values), len(values)

    found, n = of(where)
    if less is not None and found is not None:
        base, _ = of(less)
        found = None if base is None else found - base
    holds = found is not None and found <= criterion.get("at_most", math.inf) and found >= criterion.get("at_least", -math.inf)
    return {"measure": criterion["measure"], "statistic": name, "where": where, "less": less, "found": found, "n": n,
            "at_most": criterion.get("at_most"), "at_least": criterion.get("at_least"), "holds": holds}
