"""Runs of a scenario, many at once, each in a process of its own; what is finished is kept.

OUT/runs.jsonl has a first line that names the scenario and then one line a finished run, in the order in which they
ended; each is flushed to the disk. A line that a kill cut off is dropped when the file is resumed.
"""
import concurrent.futures
import concurrent.futures.process
import json
import os
import resource
import signal
import sys
import tempfile
import time
import traceback

from scenario import Failed, Refused

FORMAT = 3


def _one(do, run, program, out=""):
    """One run. Its failure is a result, not the end of the others; Ctrl-C ends it where the worker is the main process."""
    begun, worked, folder = time.monotonic(), _processor_s(), ""
    try:
        with tempfile.TemporaryDirectory(prefix="neritic_experiment_") as folder:
            measures, series = do(run.settings, run.seed, Tools(program, folder, out))
        failure = measures.pop("failure", None)
    except Failed as error:
        measures, series, failure = {}, {}, str(error)
    except Exception as error:  # a fault of ours: told with its place, the other runs go on
        place = traceback.extract_tb(error.__traceback__)[-1]
        measures, series = {}, {}
        failure = f"{type(error).__name__}: {error} ({os.path.basename(place.filename)}:{place.lineno})"
        failure = failure.replace(folder + os.sep, "")  # so that the same cause has the same words
    return {"condition": run.condition, "seed": run.seed, "files": run.files, "settings": run.settings, "measures": measures,
            "failure": failure, "series": series, "wall_s": round(time.monotonic() - begun, 3),
            "processor_s": round(_processor_s() - worked, 3)}


def _processor_s():
    """Processor seconds of this process and of those that it ran."""
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(u.ru_utime + u.ru_stime for u in used)


class Tools:
    """Things that a kind of experiment may use: the program, a folder that is removed after the run, the experiment's own."""

    def __init__(self, program, folder, out=""):
        self.program, self.folder, self.out = program, folder, out

    def neritic(self, *arguments):
        """Runs the program; Failed with its own line if it does not end with 0."""
        import subprocess
        done = subprocess.run([self.program, *map(str, arguments)], capture_output=True, text=True)
        if done.returncode != 0:
            lines = (done.stderr or done.stdout).strip().splitlines() or [f"status {done.returncode}"]
            raise Failed(f"neritic {arguments[0]}: {lines[-1]}")
        return done.stdout

    def python(self):
        """The Python package, of the build that the program is in."""
        import importlib
        import sys
        build = os.path.normpath(os.path.join(os.path.dirname(os.path.realpath(self.program)), "..", "python"))
        if build not in sys.path:
            sys.path.insert(0, build)
        try:
            return importlib.import_module("neritic")
        except ImportError as error:
            raise Failed(f"no Python package neritic in {build} ({error}); accepted: a build with pybind11-dev and "
                         "python3-dev, run by /usr/bin/python3") from None

    def write(self, name, text):
        path = os.path.join(self.folder, name)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        return path


class Progress:
    """One line on a terminal, with the time left; nothing where the output is no terminal."""

    def __init__(self, name, total, done, quiet):
        self.name, self.total, self.before, self.done = name, total, done, done
        self.begun, self.on = time.monotonic(), sys.stderr.isatty() and not quiet

    def step(self):
        self.done += 1
        if self.on:
            fresh = self.done - self.before
            left = (time.monotonic() - self.begun) / fresh * (self.total - self.done)
            print(f"\r{self.name}: run {self.done} of {self.total}, {left:.0f} s left   ", end="", file=sys.stderr)

    def end(self):
        if self.on:
            print("\r" + " " * 60 + "\r", end="", file=sys.stderr)


def read_results(path):
    """(head, results) of a runs.jsonl; a last line that was cut off is left out."""
    with open(path, encoding="utf-8") as file:
        lines = file.read().split("\n")
    whole = lines[:-1]  # what ends with a newline
    try:
        head, results = json.loads(whole[0]), [json.loads(line) for line in whole[1:]]
    except (IndexError, ValueError):
        raise Refused(f"{path}: found no results of an experiment; accepted: a file that an experiment wrote") from None
    if not isinstance(head, dict) or head.get("format") != FORMAT:
        raise Refused(f"{path}: found format {head.get('format') if isinstance(head, dict) else '?'}; accepted: {FORMAT}")
    return head, results


def run_all(scenario, out, program, workers, resume, quiet):
    """Every run's result, in the scenario's order. Interrupted: KeyboardInterrupt, what is finished is in the file."""
    path = os.path.join(out, "runs.jsonl")
    runs = scenario.list_runs()
    head = {"format": FORMAT, "scenario": scenario.name, "kind": scenario.kind_name, "fingerprint": scenario.fingerprint()}
    kept = {}
    if os.path.exists(path):
        if not resume:
            raise Refused(f"{path}: found results of an earlier call; accepted: --resume, or another --out")
        found, results = read_results(path)
        if found.get("fingerprint") != head["fingerprint"]:
            raise Refused(f"{path}: found results of other settings; accepted: the scenario and --set that began it, "
                          "or another --out")
        kept = {json.dumps([r["condition"], r["seed"]], sort_keys=True): r for r in results}
        files = {r.key(): r.files for r in runs}  # a file that was edited since makes its runs anew
        kept = {k: r for k, r in kept.items() if files.get(k, r["files"]) == r["files"]}
    missing = [r for r in runs if r.key() not in kept]
    if any(getattr(scenario.kind, "alone", lambda _: False)(r.settings) for r in missing):
        workers = 1
    # Written anew when whole, so that a line that was cut off is gone.
    _write_lines(path, [head, *kept.values()])
    progress = Progress(scenario.name, len(runs), len(runs) - len(missing), quiet)
    try:
        with open(path, "a", encoding="utf-8") as file:
            for result in _results(scenario.kind.run, missing, program, workers, out):
                kept[json.dumps([result["condition"], result["seed"]], sort_keys=True)] = result
                file.write(json.dumps(result) + "\n")
                file.flush()
                os.fsync(file.fileno())
                progress.step()
    except OSError as error:
        raise Failed(f"{path}: cannot be written: {error.strerror}; {len(kept)} finished runs are kept") from None
    except concurrent.futures.process.BrokenProcessPool:
        raise Failed(f"{scenario.name}: a run's process was killed, as where memory ends; {len(kept)} finished runs are kept, "
                     "--resume goes on, --workers 1 needs less memory") from None
    finally:
        progress.end()
    return [kept[r.key()] for r in runs]


def _results(do, runs, program, workers, out):
    if workers <= 1 or len(runs) <= 1:
        for run in runs:
            yield _one(do, run, program, out)
        return
    with concurrent.futures.ProcessPoolExecutor(workers, initializer=signal.signal, initargs=(signal.SIGINT, signal.SIG_IGN)) as pool:
        waiting = [pool.submit(_one, do, run, program, out) for run in runs]
        try:
            for done in concurrent.futures.as_completed(waiting):
                yield done.result()
        except BaseException:
            for one in waiting:
                one.cancel()
            raise


def _write_lines(path, rows):
    name = f"{path}.{os.getpid()}.tmp"
    try:
        with open(name, "w", encoding="utf-8") as file:
            for row in rows:
                file.write(json.dumps(row) + "\n")
        os.replace(name, path)
    except OSError as error:
        if os.path.exists(name):
            os.remove(name)
        raise Failed(f"{path}: cannot be written: {error.strerror}") from None
