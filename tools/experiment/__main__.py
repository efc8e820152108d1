"""neritic experiment: runs a scenario many times and reports it. The program starts this module; README.md has the
format of scenarios. Exit status: 0 every criterion holds, 1 one does not, a run broke or it could not be done, 2 bad input,
130 interrupted, 143 by SIGTERM (finished runs are kept)."""
# First of all, so that Ctrl-C while the rest is loaded is told in one line.
import endings
endings.wait_for_imports("neritic: experiment: interrupted before it began")

import argparse
import contextlib
import json
import os
import sys

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.realpath(__file__))
sys.path[:0] = [HERE, os.path.join(HERE, "..", "plot")]

try:
    import numpy  # noqa: F401
except ModuleNotFoundError:
    print("neritic: experiment: no numpy here; tools/setup plots installs it", file=sys.stderr)
    sys.exit(1)


import crops
import detector
import echo_sounder
import imaging
import outcomes
import profiling
import shark
import sonar_crops
import task
import training

import provenance
import report
import runner
import scenario
import summary

KINDS = {"imaging": imaging, "profiling": profiling, "echo_sounder": echo_sounder, "shark": shark,
         "task": task.Task, "detector": detector}
# name: the file's name, where crops come from, their channels
TRAINED = {"train_camera": ("camera", crops, 3), "train_sonar": ("sonar", sonar_crops, 1)}


def planned(name, asked):
    return scenario.Scenario(scenario.path_of(name), KINDS, asked.runs, asked.seed, asked.set)


def folder(out):
    try:
        os.makedirs(out, exist_ok=True)
    except OSError as error:
        raise scenario.Failed(f"{out}: cannot be made: {error.strerror}") from None
    if not os.access(out, os.W_OK):
        raise scenario.Failed(f"{out}: cannot be written")


def do(plan, asked, out):
    """(summary, results) of a scenario; its files are in out."""
    folder(out)
    if any(getattr(plan.kind, "alone", lambda _: False)(run.settings) for run in plan.list_runs()):
        plan.criteria = []  # they are of the robot; a person who is slow is no fault
    results = runner.run_all(plan, out, asked.program, asked.workers, asked.resume, asked.quiet)
    told = {**summary.summarise(plan, results), "made_by": provenance.of(asked.program)}
    note = report.write(plan, results, told, out)
    if note and not asked.quiet:
        print(f"neritic: {plan.name}: {note}", file=sys.stderr)
    return told, results


@contextlib.contextmanager
def named(name):
    """Where one of many is refused, the line says which."""
    try:
        yield
    except scenario.Refused as error:
        raise scenario.Refused(f"{name}: {error}") from None


def every(asked):
    """Each shipped scenario, all checked before the first runs; one that cannot be done is told, and the others go on. Returns
    (summaries, [(name, why)])."""
    folder(asked.out)
    names, plans, told, failed = scenario.names(), {}, [], []
    for name in names:
        with named(name):
            plans[name] = planned(name, asked)
    for i, name in enumerate(names):
        line, plans[name].told_as = "", f"{i + 1} of {len(names)}: {name}"
        try:
            with named(name):
                told.append(do(plans[name], asked, os.path.join(asked.out, name))[0])
        except scenario.Failed as error:
            failed.append((name, str(error)))
            line = f"neritic: {name}: {error}"
        report.index(told, failed, names[i + 1:], asked.out)  # a full disk ends it here, with one line
        if line:
            print(line, file=sys.stderr)
    return told, failed


def train(asked):
    name, maker, channels = TRAINED[asked.name]
    folder(asked.out)
    share = training.train(name, maker, maker.CLASSES, channels, asked.program, asked.runs, 1 if asked.seed is None else asked.seed, asked.workers,
                           asked.out, asked.quiet, asked.set)
    if not asked.quiet:
        print(f"{asked.out}/{name}.onnx: {100 * share:.1f} % of the crops kept aside")
    return 0


def trade(asked):
    folder(asked.out)
    rows = outcomes.run(KINDS, lambda plan, out: do(plan, asked, out)[1], asked)
    if asked.json:
        print(json.dumps(rows, indent=2))
    elif not asked.quiet:
        print(f"{asked.out}: index.html, outcomes.csv, .json, .png; a folder a knob")
    return 0


def tell(told, out):
    print(f"{told['experiment']}: {told['runs']} runs, {told['failed']} failed; {out}/report.html")
    for c in told["criteria"]:
        verdict = report.verdict(c)
        print(f"  {verdict.upper() if verdict == 'does not hold' else verdict:<14}{report.claim(c)}: {report.found(c, True)}; asked: {report.limit(c)}")
    for condition in told["conditions"]:
        for cause, n in condition["failures"].items():
            print(f"  {n} runs failed ({report.words(condition['condition'])}): {cause}")
        for why, n in condition["absent"].items():
            print(f"  {n} runs gave no value ({report.words(condition['condition'])}): {why}")
    for line in report.comparison(told):
        print(f"  {line}")


def main():
    parser = argparse.ArgumentParser(prog="neritic experiment")
    parser.add_argument("name")
    parser.add_argument("--out", required=True)
    parser.add_argument("--program", required=True)
    parser.add_argument("--runs", type=int)
    parser.add_argument("--seed", type=int)
    parser.add_argument("--set", action="append", default=[])
    parser.add_argument("--workers", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--resume", action="store_true")
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--quiet", action="store_true")
    parser.add_argument("--quick", action="store_true")  # of tradeoff
    asked = parser.parse_args()
    try:
        endings.listen()
        if asked.name in TRAINED:
            return train(asked)
        if asked.name == "tradeoff":
            return trade(asked)
        told, failed = every(asked) if asked.name == "all" else ([do(planned(asked.name, asked), asked, asked.out)[0]], [])
        if asked.json:
            print(json.dumps(told if asked.name == "all" else told[0], indent=2))
        elif not asked.quiet:
            for t in told:
                tell(t, os.path.join(asked.out, t["experiment"]) if asked.name == "all" else asked.out)
        return 0 if not failed and all(t["passed"] and not t["broken"] for t in told) else 1
    except scenario.Refused as error:
        print(f"neritic: {error}", file=sys.stderr)
        return 2
    except scenario.Failed as error:
        print(f"neritic: {error}", file=sys.stderr)
        return 1
    except endings.Ended as ended:
        kept = "nothing is kept" if asked.name in TRAINED else "finished runs are kept, --resume goes on"
        print(f"neritic: experiment: interrupted; {kept}", file=sys.stderr)
        return ended.status


if __name__ == "__main__":
    sys.exit(main())
