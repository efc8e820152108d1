"""Runs of a scenario, many at once, in processes of their own; what is finished is kept.

OUT/runs.jsonl has a first line that names the scenario and then one line a finished run, in the order in which they
ended; each is flushed to the disk. A line that a kill cut off is dropped when the file is resumed. A run whose process
ends or does not return within the scenario's run_limit_s is a failed run; the others go on in a new process.
"""
import collections
import ctypes
import fcntl
import glob
import json
import math
import multiprocessing
import multiprocessing.connection
import os
import random
import resource
import shutil
import signal
import sys
import time
import traceback

import numpy as np

import endings
import files_read
from scenario import Failed, Refused

FORMAT = 3
SCRATCH = ".neritic_scratch"  # in OUT: a folder a run, removed after it
GRACE_S = 5.0  # for a run that is stopped to close what it opened
PERSON_GRACE_S = 40.0  # of a person's dive, whose recording is ended
PR_SET_PDEATHSIG = 1  # linux/prctl.h
SAY_EVERY_S = 30.0  # a line of progress where the output is no terminal
LOOK_EVERY_S = 1.0  # whether one is due
FORKS = multiprocessing.get_context("fork")


class _Stopped(BaseException):
    """The run is stopped from outside. Not an Exception: nothing of a run catches it."""


def _stop(*_):
    raise _Stopped


def _one(do, run, program, folder, out=""):
    """One run. Its failure is a result, not the end of the others."""
    begun, worked = time.monotonic(), _processor_s()
    measures, series, absent = {}, {}, {}
    try:
        os.mkdir(folder)
        _seed_common(run.seed)
        measures, series = do(run.settings, run.seed, Tools(program, folder, out))
        failure, absent = measures.pop("failure", None), measures.pop("absent", {})
    except Failed as error:
        failure = str(error)
    except _Stopped:
        raise
    except BaseException as error:  # a fault, or an exit, of the run's own code: told with its place
        place = traceback.extract_tb(error.__traceback__)[-1]
        failure = f"{type(error).__name__}: {error} ({os.path.basename(place.filename)}:{place.lineno})"
        failure = failure.replace(folder + os.sep, "")  # so that the same cause has the same words
    return {**_result(run, measures, failure, series, time.monotonic() - begun, _processor_s() - worked), "absent": absent}


def _seed_common(seed):
    """The generators that a process has one of, as random.random() and numpy.random.random() draw from: each run begins them anew."""
    random.seed(seed)
    np.random.seed(np.random.SeedSequence(seed).generate_state(8))


def _result(run, measures, failure, series, wall_s, processor_s):
    """absent: why a measure has no value, by its name."""
    return {"condition": run.condition, "seed": run.seed, "files": run.files, "settings": run.settings, "measures": measures,
            "failure": failure and " ".join(failure.split()), "series": series, "wall_s": round(wall_s, 3),
            "processor_s": round(processor_s, 3), "absent": {}}


def is_broken(result):
    """Whether a run gave nothing, as where it was killed, a disk was full or its code raised an error: --resume makes it anew. A run that
    fails by its scenario's rules has measures, and is a result."""
    return bool(result["failure"]) and not result["measures"]


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
    """How far it is, with the time left: one line on a terminal that is rewritten; elsewhere a line every SAY_EVERY_S."""

    def __init__(self, name, total, done, quiet, clock=time.monotonic):
        self.name, self.total, self.before, self.done, self.clock = name, total, done, done, clock
        self.begun = self.said = clock()
        self.terminal, self.quiet = sys.stderr.isatty(), quiet

    def step(self):
        self.done += 1
        self.show()

    def show(self):
        """Called at least every LOOK_EVERY_S: where runs take minutes, what is said says so too."""
        if self.quiet or self.total == 0:
            return
        fresh, now = self.done - self.before, self.clock()
        left_s = (now - self.begun) / fresh * (self.total - self.done) if fresh else None
        if self.terminal:
            if fresh:
                print(f"\r{self.name}: run {self.done} of {self.total}, {left_s:.0f} s left   ", end="", file=sys.stderr, flush=True)
        elif now - self.said >= SAY_EVERY_S:
            self.said = now
            left = f", {in_words(left_s)} left" if fresh and self.done < self.total else ""
            print(f"note: {self.name}: run {self.done} of {self.total}{left}", file=sys.stderr, flush=True)

    def end(self):
        if self.terminal and not self.quiet:
            print("\r" + " " * 60 + "\r", end="", file=sys.stderr, flush=True)


def in_words(seconds):
    """A time as the program's own progress has it: 3:05, or 2 h 30 min."""
    whole_s = math.ceil(seconds)
    return f"{whole_s // 3600} h {whole_s // 60 % 60:02} min" if whole_s >= 3600 else f"{whole_s // 60}:{whole_s % 60:02}"


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
    """Every run's result, in the scenario's order. Interrupted: endings.Ended, what is finished is in the file."""
    handle = os.open(out, os.O_RDONLY | os.O_DIRECTORY)
    try:
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise Refused(f"{out}: found another experiment that still writes there; accepted: another --out, or --resume when that has "
                          "ended") from None
        return _run_all(scenario, out, program, workers, resume, quiet)
    finally:
        os.close(handle)


def _run_all(scenario, out, program, workers, resume, quiet):
    path = os.path.join(out, "runs.jsonl")
    _remove_left(out, path)
    runs = scenario.list_runs()
    head = {"format": FORMAT, "scenario": scenario.name, "kind": scenario.kind_name, "fingerprint": scenario.fingerprint(),
            "program": files_read.of_program(program)}
    kept = {}
    if os.path.exists(path):
        if not resume:
            raise Refused(f"{path}: found results of an earlier call; accepted: --resume, or another --out")
        found, results = read_results(path)
        if found.get("fingerprint") != head["fingerprint"]:
            raise Refused(f"{path}: found results of other settings; accepted: the scenario and --set that began it, "
                          "or another --out")
        if found.get("program") != head["program"]:
            raise Refused(f"{path}: found results of another neritic (program, Python package, assets or tools/experiment changed since); "
                          "accepted: the one that began it, or another --out")
        kept = {json.dumps([r["condition"], r["seed"]], sort_keys=True): r for r in results if not is_broken(r)}
        files = {r.key(): r.files for r in runs}  # a file that was edited since makes its runs anew
        kept = {k: r for k, r in kept.items() if files.get(k, r["files"]) == r["files"]}
    missing = [r for r in runs if r.key() not in kept]
    alone = any(getattr(scenario.kind, "alone", lambda _: False)(r.settings) for r in missing)
    made = _results(scenario.kind.run, missing, program, 1 if alone else workers, out, scenario.run_limit_s,
                    PERSON_GRACE_S if alone else GRACE_S)
    # Written anew when whole, so that a line that was cut off is gone.
    _write_lines(path, [head, *kept.values()])
    progress = Progress(getattr(scenario, "told_as", scenario.name), len(runs), len(runs) - len(missing), quiet)
    try:
        with open(path, "a", encoding="utf-8") as file:
            for result in made:
                if os.fstat(file.fileno()).st_nlink == 0:
                    raise Failed(f"{path}: was removed while its runs were made; no more are made")
                if result is None:
                    progress.show()
                    continue
                file.write(json.dumps(result) + "\n")
                file.flush()
                os.fsync(file.fileno())
                kept[json.dumps([result["condition"], result["seed"]], sort_keys=True)] = result  # what is on the disk
                progress.step()
    except OSError as error:
        raise Failed(f"{path}: cannot be written: {error.strerror}; {len(kept)} finished runs are kept") from None
    finally:
        made.close()
        progress.end()
    return [kept[r.key()] for r in runs]


def _remove_left(out, path):
    """What an experiment left that was killed; out is locked, so none writes there."""
    shutil.rmtree(os.path.join(out, SCRATCH), ignore_errors=True)
    for left in glob.glob(f"{glob.escape(path)}.*.tmp"):
        os.remove(left)


class _Worker:
    """A process that makes one run at a time, in a process group of its own."""

    def __init__(self, do, program, out, grace_s):
        self.grace_s, self.run, self.folder, self.begun, self.ended = grace_s, None, None, 0.0, False
        self.pipe, self.theirs = FORKS.Pipe()
        self.process = FORKS.Process(target=_work, args=(self.theirs, do, program, out))

    def start(self):
        """Apart from its making, so that whoever has to end it knows it first."""
        # No signal may reach a child that still has this process's handlers.
        before = signal.pthread_sigmask(signal.SIG_BLOCK, endings.SIGNALS)
        try:
            self.process.start()
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, before)
        self.theirs.close()

    def begin(self, run, folder):
        self.run, self.folder, self.begun = run, folder, time.monotonic()
        try:
            self.pipe.send((run, folder))
        except OSError:
            pass  # it has died: the next look tells

    def take(self, limit_s):
        """The result of its run if that is over; else None."""
        taken = None
        late = time.monotonic() - self.begun > limit_s
        try:
            if self.pipe.poll():
                taken = self.pipe.recv()
        except (EOFError, OSError):
            self.process.join(self.grace_s)
        if taken is None and (late or not self.process.is_alive()):
            cause = f"did not end within {limit_s:g} s of the clock (run_limit_s)" if late else self._end_in_words()
            self.end()
            taken = _result(self.run, {}, cause, {}, time.monotonic() - self.begun, 0.0)
        if taken is not None:
            shutil.rmtree(self.folder, ignore_errors=True)
            self.run = None
        return taken

    def _end_in_words(self):
        status = self.process.exitcode
        if status is None or status >= 0:
            return f"its process ended with status {status}"
        why = ", as where memory ends: --workers 1 needs less" if -status == signal.SIGKILL else ""
        return f"its process was killed by {signal.Signals(-status).name}{why}"

    def end(self):
        """Ends the process: at once if it rests, after its run has closed what it opened if that listens."""
        if self.ended:
            return
        self.ended = True
        if self.process.pid is None:
            return
        try:
            if self.process.is_alive():
                if self.run is None:
                    self.pipe.send(None)
                else:
                    self.process.terminate()
                self.process.join(self.grace_s)
        finally:  # also where a second Ctrl-C ends the wait
            self.kill()
        self.process.join()
        self.pipe.close()

    def kill(self):
        if self.process.pid is not None:
            self.process.kill()
            self._kill_group()

    def _kill_group(self):
        """With the programs that the run started."""
        try:
            os.killpg(self.process.pid, signal.SIGKILL)
        except ProcessLookupError:
            pass


def _work(pipe, do, program, out):
    try:
        for number in endings.SIGNALS:
            signal.signal(number, _stop)
        signal.pthread_sigmask(signal.SIG_UNBLOCK, endings.SIGNALS)
        os.dup2(2, 1)  # standard output is the results': a controller that prints is no part of them
        os.setpgid(0, 0)  # Ctrl-C goes to the main process alone, which ends this one
        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGTERM)
        while (asked := pipe.recv()) is not None:
            pipe.send(_one(do, asked[0], program, asked[1], out))
    except (_Stopped, EOFError, OSError):
        pass


def _results(do, runs, program, workers, out, limit_s, grace_s):
    """The result of each run, as they end; None where none has ended for LOOK_EVERY_S."""
    waiting, pool = collections.deque(enumerate(runs)), []
    if not waiting:
        return
    base = os.path.join(os.path.abspath(out), SCRATCH)
    try:
        os.mkdir(base)
    except OSError as error:
        raise Failed(f"{out}: cannot be written: {error.strerror}") from None
    try:
        for _ in range(max(1, min(workers, len(runs)))):
            pool.append(_Worker(do, program, out, grace_s))
            pool[-1].start()
        while waiting or any(w.run for w in pool):
            for i, worker in enumerate(pool):
                if worker.run is None and waiting:
                    if not worker.process.is_alive():
                        worker.end()
                        worker = pool[i] = _Worker(do, program, out, grace_s)
                        worker.start()
                    number, run = waiting.popleft()
                    worker.begin(run, os.path.join(base, str(number)))
            busy = [w for w in pool if w.run]
            left_s = limit_s - time.monotonic() + min(w.begun for w in busy)
            multiprocessing.connection.wait([x for w in busy for x in (w.pipe, w.process.sentinel)],
                                            min(max(0.0, left_s) + 0.01, LOOK_EVERY_S))
            yield None
            for worker in busy:
                result = worker.take(limit_s)
                if result is not None:
                    yield result
    finally:
        try:
            for worker in pool:
                worker.end()
        finally:  # also where a second Ctrl-C ends the wait
            for worker in pool:
                if worker.process.pid is not None and worker.process.is_alive():
                    worker.kill()
            shutil.rmtree(base, ignore_errors=True)


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
