"""`neritic study`: a study with people, from consent to withdrawal. STUDIES.md has the plan's format and the files.

A participant's data is under FOLDER/participants/PNN; scores.csv repeats the scores. study.json names blocks, orders and
pseudonyms that were given, never a person. Exit status: 0 done, 1 could not, 2 bad input, 130 interrupted, 143 by SIGTERM (what
is answered is kept).
"""
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.realpath(__file__)))
import endings
if __name__ == "__main__":  # first of all, so that Ctrl-C while the rest is loaded is told in one line
    endings.wait_for_imports("neritic: study: interrupted before it began")

import argparse
import contextlib
import csv
import fcntl
import glob
import io
import json
import shutil
import signal
import socket
import subprocess
import threading
import time
import tomllib

sys.dont_write_bytecode = True

import block_commands
import questionnaires
from report import write_file
import scenario
from scenario import Failed, Refused, check_keys, text_of

# By the format of a study: what stands between block and questionnaire in a file's name. No name has a hyphen; by _ the answers of
# two could share a file.
JOINTS = {1: "_", 2: "-"}
WORDS = ("begin", "enrol", "run", "ask", "mark", "withdraw", "table", "wizard")


def read_plan(path):
    try:
        with open(path, "rb") as file:
            plan = tomllib.load(file)
    except OSError as error:
        raise Refused(f"{path}: found a file that cannot be read ({error.strerror}); accepted: a study's plan in TOML") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise Refused(f"{path}: found no TOML: {error}") from None
    check_keys(path, plan, ["study", "blocks", "questionnaires"])
    forms = _forms_of(path, plan)
    study = plan.get("study", {})
    check_keys(f"{path}: study", study, ["title", "consent", "before", "after_block", "after"])
    for key in ("title", "consent"):
        if not isinstance(study.get(key), str) or not study[key].strip():
            raise Refused(f"{path}: study.{key}: found {study.get(key)!r}; accepted: text")
    for key in ("before", "after_block", "after"):
        if not isinstance(study.get(key, []), list):
            raise Refused(f"{path}: study.{key}: found {study[key]!r}; accepted: a list of {', '.join(forms)}")
        asked = {}  # {score: its questionnaire}
        for name in study.get(key, []):
            if not isinstance(name, str) or name not in forms:
                raise Refused(f"{path}: study.{key}: found {name!r}; accepted: {', '.join(forms)}")
            for score in forms[name].score_names():
                if asked.setdefault(score, name) != name or study[key].count(name) > 1:
                    raise Refused(f"{path}: study.{key}: found {asked[score]} and {name}, which both give {score}; accepted: one of them")
    blocks = plan.get("blocks", [])
    if not isinstance(blocks, list) or not 1 <= len(blocks) <= 20:
        raise Refused(f"{path}: blocks: found {len(blocks) if isinstance(blocks, list) else blocks!r}; accepted: 1 to 20")
    names = []
    for i, block in enumerate(blocks):
        check_keys(f"{path}: blocks[{i}]", block, ["name", "about", "command"])
        if not isinstance(block.get("name"), str) or not block["name"].replace("_", "").isalnum() \
                or block["name"] in [*names, "before", "after"]:
            raise Refused(f"{path}: blocks[{i}].name: found {block.get('name')!r}; accepted: a new word of letters, digits, _, "
                          "not before or after")
        text_of(f"{path}: blocks[{i}]", block, "about")
        if not isinstance(block.get("command", []), list) or not all(isinstance(w, str) for w in block.get("command", [])):
            raise Refused(f"{path}: blocks[{i}].command: found {block['command']!r}; accepted: a list of words for neritic")
        block_commands.check(f"{path}: blocks[{i}].command", block.get("command", []))
        names.append(block["name"])
    return plan


def _forms_of(path, plan):
    """The questionnaires that a plan may name: the published ones and its own."""
    return questionnaires.FORMS | questionnaires.own(f"{path}: questionnaires", plan.get("questionnaires", {}))


class Study:
    def __init__(self, folder):
        self.folder, path = folder, os.path.join(folder, "study.json")
        try:
            with open(path, encoding="utf-8") as file:
                self.data = json.load(file)
        except OSError:
            raise Refused(f"{folder}: found no study; accepted: a folder that `neritic study begin` made") from None
        except ValueError:
            raise Refused(f"{path}: found no JSON; accepted: a file that `neritic study` wrote") from None
        self.plan = self.data["plan"]
        if self.data.get("format") not in JOINTS:
            raise Refused(f"{path}: found format {self.data.get('format')}; accepted: {', '.join(map(str, JOINTS))}")
        self.forms = _forms_of(path, self.plan)
        self.names = [b["name"] for b in self.plan["blocks"]]

    def save(self):
        write_file(os.path.join(self.folder, "study.json"), json.dumps(self.data, indent=2) + "\n")

    def place(self, who, withdrawn_too=False):
        known = self.data["participants"]
        if who not in known:
            raise Refused(f"{self.folder}: found no participant {who}; accepted: {', '.join(known) or 'none yet: enrol'}")
        if known[who]["withdrawn"] and not withdrawn_too:
            raise Refused(f"{self.folder}: found {who}, who has withdrawn; accepted: one who takes part")
        return os.path.join(self.folder, "participants", who)

    def answers_file(self, place, when, name):
        """Of a questionnaire (name) at a block (when; before and after are blocks too)."""
        return os.path.join(place, f"{when}{JOINTS[self.data['format']]}{name}.json")


@contextlib.contextmanager
def alone(folder):
    """The study as it is now, which no other process changes meanwhile. Nobody is asked anything in it."""
    Study(folder)  # refuses a folder that holds no study
    handle = os.open(folder, os.O_RDONLY)
    try:
        fcntl.flock(handle, fcntl.LOCK_EX)
        yield Study(folder)
    finally:
        os.close(handle)


class Present:
    """A participant's folder, locked while a command writes there, and while a block's program does, which inherits the lock.
    Many may write at once; a withdrawal waits for none: it is refused while one writes, and what begins meanwhile is too."""

    def __init__(self, folder, who, withdraws=False):
        self.place = Study(folder).place(who, withdrawn_too=withdraws)
        self.handle = None
        try:
            self.handle = os.open(self.place, os.O_RDONLY | os.O_DIRECTORY)
            fcntl.flock(self.handle, (fcntl.LOCK_EX if withdraws else fcntl.LOCK_SH) | fcntl.LOCK_NB)
            Study(folder).place(who, withdrawn_too=withdraws)  # withdrawn before the lock was had?
        except FileNotFoundError:
            if not withdraws:
                raise Failed(f"{self.place}: found no folder; accepted: one that `neritic study enrol` made") from None
        except BlockingIOError:
            self.close()
            if not withdraws:
                raise Refused(f"{folder}: found {who}, whom another command withdraws; accepted: one who takes part") from None
            raise Refused(f"study withdraw: found a command that still writes what {who} leaves (study run, ask or wizard, or the program of "
                          "a block); accepted: end it first, by Ctrl-C in its terminal; nothing is erased") from None
        except BaseException:
            self.close()
            raise

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        if self.handle is not None:
            os.close(self.handle)
            self.handle = None


def now():
    return {"unix_ns": time.time_ns(), "monotonic_ns": time.monotonic_ns()}


# Where a block's program listens for markers (neritic dive --markers), while it runs.
PORT = "markers.port"
END_S = 60.0  # that a block's program has to end its recordings, when the study is ended


def note(place, **what):
    """A marker: one line, on the disk before the next thing happens, and to the block's program, which keeps it in its
    recording and gives it to Lab Streaming Layer. recordings' clock is the host's monotonic one."""
    line = json.dumps({**now(), **what})
    _send(place, line)
    with open(os.path.join(place, "markers.jsonl"), "a", encoding="utf-8") as file:
        file.write(line + "\n")
        file.flush()
        os.fsync(file.fileno())
    return line


def _send_once_heard(line, port, ended):
    """Sends it when somebody listens there, which a port that nobody has refuses."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        sender.connect(("127.0.0.1", port))
        while not ended.is_set():
            try:
                sender.send(b"")
                time.sleep(0.05)
                sender.send(line.encode())
                return
            except ConnectionRefusedError:
                continue


def _send(place, line):
    try:
        with open(os.path.join(place, PORT), encoding="ascii") as file:
            port = int(file.read())
    except (OSError, ValueError):
        return  # no program listens
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        sender.sendto(line.encode()[:1024], ("127.0.0.1", port))


def _free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
        free.bind(("127.0.0.1", 0))
        return free.getsockname()[1]


class Screen:
    """The terminal; or a file of answers, one a line, for rehearsals."""

    def __init__(self, answers):
        self.lines = None
        if answers:
            try:
                with open(answers, encoding="utf-8") as file:
                    self.lines = iter(file.read().splitlines())
            except OSError as error:
                raise Refused(f"{answers}: found a file that cannot be read ({error.strerror}); accepted: answers, one a line") from None

    def say(self, text):
        print(text, flush=True)

    def ask(self, text):
        print(text, end=" ", flush=True)
        try:
            answer = next(self.lines) if self.lines is not None else input()
        except (EOFError, StopIteration):
            raise Failed("study: no more answers; what was answered is kept") from None
        if self.lines is not None:
            print(answer)
        return answer.strip()


ASKED = "asked_"  # a block of `ask` is named by it and the time


def _given(path):
    """The answers of a file; None where there is none."""
    if not os.path.exists(path):
        return None
    with open(path, encoding="utf-8") as file:
        return json.load(file)


def asked_of(study, place):
    """The answers to `ask`, the oldest first."""
    found = [_given(path) for path in glob.glob(os.path.join(glob.escape(place), ASKED + "*.json"))]
    return sorted((g for g in found if g and g["when"] not in study.names), key=lambda g: (g["when"], g["questionnaire"]))


def _is_done(given):
    return bool(given.get("ended")) or "scores" in given


def ask(study, who, name, screen):
    """One questionnaire now; the newest of its kind that was interrupted goes on."""
    place = study.place(who)
    begun = [g for g in asked_of(study, place) if g["questionnaire"] == name and not _is_done(g)]
    when = at = begun[-1]["when"] if begun else time.strftime(ASKED + "%Y%m%d_%H%M%S")
    number = 1
    while not begun and os.path.exists(study.answers_file(place, when, name)):  # of the same second
        number += 1
        when = f"{at}_{number}"
    if begun:
        screen.say(f"Goes on with {name} of {when}, {len(begun[-1]['answers'])} of {len(study.forms[name].items)} answered.")
    questionnaire(study, who, name, when, screen)


def questionnaire(study, who, name, when, screen):
    """Asks what is not yet answered: a questionnaire that was interrupted goes on where it stopped. "back" asks the question before
    again, "skip" declines an answer, which is kept as null; a questionnaire with one has no score."""
    place, form = study.place(who), study.forms[name]
    path = study.answers_file(place, when, name)
    given = _given(path) or {"questionnaire": name, "when": when, "answers": []}
    if _is_done(given):
        return given
    screen.say(f"\n{form.title}: {len(form.items)} questions, {form.ends}. In place of a number: back (the question before), skip (no answer).")
    note(place, marker=f"questionnaire {name} begins", when=when)
    while not given.get("ended"):
        _ask_next(form, given, screen)
        write_file(path, json.dumps(given, indent=2) + "\n")
    note(place, marker=f"questionnaire {name} ends", when=when)
    return given


def _ask_next(form, given, screen):
    """One question, or whether all answers shall stay."""
    answers, count = given["answers"], len(form.items)
    i, value = len(answers), None
    if i < count:
        text, low, high, _ = form.items[i]
        typed = screen.ask(f"  {i + 1}/{count} {text} [{low}-{high}]:")
    else:
        typed = screen.ask("  Press Enter to end these questions, or type back:")
    if typed.lower() == "back":
        if answers:
            answers.pop()
        else:
            screen.say("    this is the first question")
    elif i < count:
        if typed.lower() != "skip":
            value, wrong = form.check(i, typed)
            if wrong is not None:
                screen.say(f"    {wrong}")
                return
        answers.append(value)
    elif typed:
        screen.say(f"    found \"{typed}\"; accepted: Enter, back")
    else:
        given["ended"] = True
        scores = form.scores(answers)
        if scores is not None:
            given["scores"] = scores


def begin(asked):
    if not asked.plan:
        raise Refused("study begin: found no --plan; accepted: --plan FILE, a study's plan in TOML (tools/experiment/STUDIES.md)")
    plan = read_plan(asked.plan)
    if os.path.exists(os.path.join(asked.folder, "study.json")):
        raise Refused(f"{asked.folder}: found a study; accepted: a new folder")
    try:
        os.makedirs(os.path.join(asked.folder, "participants"), exist_ok=True)
    except OSError as error:
        raise Failed(f"{asked.folder}: cannot be made: {error.strerror}") from None
    orders = questionnaires.latin_square(len(plan["blocks"]))
    write_file(os.path.join(asked.folder, "study.json"),
               json.dumps({"format": max(JOINTS), "plan": plan, "orders": orders, "participants": {}}, indent=2) + "\n")
    many = f"{len(plan['blocks'])} blocks in {len(orders)} orders; balanced after every {len(orders)} participants"
    print(f"{asked.folder}: {many if len(orders) > 1 else 'one block'}")


def enrol(asked, screen):
    study = Study(asked.folder)
    screen.say(study.plan["study"]["consent"].strip())
    if screen.ask("Do you consent? Type yes:").lower() != "yes":
        screen.say("No consent: nothing is kept.")
        return
    with alone(asked.folder) as study:
        known = study.data["participants"]
        # A folder that is there already was left by an enrolment that was cut short: its pseudonym is not given.
        number = len(known) + 1
        while f"P{number:02d}" in known or os.path.exists(os.path.join(asked.folder, "participants", f"P{number:02d}")):
            number += 1
        who = f"P{number:02d}"
        # The order that fewest who take part have: those who withdraw leave their place in the balance to the next.
        used = [p["order"] for p in known.values() if not p["withdrawn"]]
        order = min(range(len(study.data["orders"])), key=lambda i: (used.count(i), i))
        place = os.path.join(asked.folder, "participants", who)
        os.makedirs(place)
        note(place, marker="consent given")
        known[who] = {"order": order, "withdrawn": False}
        study.save()
    screen.say(f"You are {who}. Blocks: {', '.join(study.names[i] for i in study.data['orders'][order])}")


def run(asked, screen):
    with Present(asked.folder, asked.who) as present, open(os.path.join(present.place, "run.lock"), "w", encoding="ascii") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise Refused(f"{asked.folder}: found another `neritic study run` of {asked.who}, which goes on; accepted: one at a time") from None
        _run(asked, screen, present)


def _run(asked, screen, present):
    study = Study(asked.folder)
    who, place = asked.who, present.place
    head = study.plan["study"]
    for name in head.get("before", []):
        questionnaire(study, who, name, "before", screen)
    order = study.data["orders"][study.data["participants"][who]["order"]]
    for turn, index in enumerate(order, 1):
        block = study.plan["blocks"][index]
        done = os.path.join(place, f"{block['name']}.done")
        if not os.path.exists(done):
            screen.say(f"\nBlock {turn} of {len(order)}: {block.get('about', block['name'])}")
            tries = _attempts(place, block["name"]) + 1
            if _begins(screen, anew=tries > 1):
                _block(asked, present, block, turn, tries)
            else:
                note(place, marker="block left", block=block["name"], turn=turn)
            write_file(done, "")
        for name in head.get("after_block", []):
            questionnaire(study, who, name, block["name"], screen)
    for name in head.get("after", []):
        questionnaire(study, who, name, "after", screen)
    screen.say(f"\n{who} has done all blocks. Thank you.")


def _attempts(place, block):
    """How many attempts at a block have left something. A recording that a crash cut off stays as .mcap.part, under a number of its own."""
    tries = 0
    while any(os.path.exists(os.path.join(place, f"{block}_{tries + 1}{end}")) for end in ("", ".mcap", ".mcap.part", ".log")):
        tries += 1
    return tries


def _begins(screen, anew):
    """Waits for Enter. A block that was begun before may be left in its place: false."""
    if not anew:
        screen.ask("Press Enter to begin.")
        return True
    while typed := screen.ask("It was begun before. Press Enter to begin it anew, or type leave to go on without it:").lower():
        if typed == "leave":
            return False
        screen.say(f"    found \"{typed}\"; accepted: Enter, leave")
    return True


def _version(file):
    """What another writing of the file changes; None of a file that is not there."""
    if not os.path.exists(file):
        return None
    about = os.stat(file)
    return about.st_ino, about.st_mtime_ns


def _gave_results(files, before):
    """Whether an experiment wrote all of its results since then, and no run of it broke: one of its criteria does not hold, which is a
    result and would be the same again."""
    if not files or any(_version(f) in (None, old) for f, old in zip(files, before)):
        return False
    for file in files:
        with open(file, encoding="utf-8") as read:
            if json.load(read)["broken"]:
                return False
    return True


def _program_of(words, told, present):
    """The exit status of a block's program, once it is over. What ends the study ends the program first."""
    program = subprocess.Popen(words, stdout=told, stderr=subprocess.STDOUT, pass_fds=[present.handle])
    try:
        return program.wait()
    except BaseException:
        program.send_signal(signal.SIGTERM)  # also where a terminal's Ctrl-C reached it already: one wish
        try:
            program.wait(END_S)
        finally:
            program.kill()
            program.wait()
        raise


def _block(asked, present, block, turn, tries):
    """The block's program; {record} becomes a file of the participant's folder, numbered so that no try replaces another."""
    block_commands.check(f"{asked.folder}/study.json: block {block['name']}", block.get("command", []))  # of a study that began long ago, too
    place = present.place
    record = os.path.join(place, f"{block['name']}_{tries}")
    port, listens = str(_free_port()), os.path.join(place, PORT)
    words = [w.replace("{record}", record).replace("{folder}", place).replace("{markers}", port) for w in block.get("command", [])]
    results = block_commands.results_of(words, scenario.names())
    before = [_version(f) for f in results]
    begins, ended = note(place, marker="block begins", block=block["name"], turn=turn, attempt=tries), threading.Event()
    if any("{markers}" in w for w in block.get("command", [])):
        write_file(listens, port)
        threading.Thread(target=_send_once_heard, args=(begins, int(port), ended), daemon=True).start()
    status = 0
    try:
        if words:  # what the program tells is for the experimenter, not for the participant at the terminal
            with open(record + ".log", "w", encoding="utf-8") as told:
                status = _program_of([asked.program, *words], told, present)
    finally:
        ended.set()
        if os.path.exists(listens):
            os.remove(listens)
    note(place, marker="block ends", block=block["name"], turn=turn, attempt=tries, status=status)
    if status != 0 and not (status == 1 and _gave_results(results, before)):
        with open(record + ".log", encoding="utf-8", errors="replace") as told:
            last = told.read().strip().splitlines()[-1:]
        raise Failed(f"study: block {block['name']} ended with status {status} ({last[0] if last else 'it told nothing'}; all of it: "
                     f"{record}.log); `neritic study run` begins it anew or leaves it")


def withdraw(asked, screen):
    with Present(asked.folder, asked.who, withdraws=True):
        _withdraw(asked, screen)


def _withdraw(asked, screen):
    if not asked.yes and screen.ask(f"This erases all that {asked.who} left, for good. Type {asked.who} to do it:") != asked.who:
        raise Failed(f"study withdraw: {asked.who} was not typed; nothing is erased")
    with alone(asked.folder) as study:
        # First the word that they have withdrawn, then the data; the same command goes on where it was cut short.
        place = study.place(asked.who, withdrawn_too=True)
        study.data["participants"][asked.who]["withdrawn"] = True
        study.save()
        if os.path.exists(os.path.join(asked.folder, "scores.csv")):
            write_file(os.path.join(asked.folder, "scores.csv"), scores(study))
        for left in glob.glob(os.path.join(glob.escape(asked.folder), "*.tmp")):  # by a process that was killed
            os.remove(left)
        if os.path.isdir(place):
            shutil.rmtree(place)
    screen.say(f"{asked.who} is erased. The pseudonym is not given again; the others' data stay as they are.")


def scores(study):
    """CSV: a row a participant and block (before and after are blocks too), the scores side by side, and one for each questionnaire that
    `ask` asked, whose block says when."""
    rows, columns = [], ["participant", "block", "turn"]
    for who, about in study.data["participants"].items():
        if about["withdrawn"]:
            continue
        place = os.path.join(study.folder, "participants", who)
        order = [study.names[i] for i in study.data["orders"][about["order"]]]
        moments = [(when, [_given(study.answers_file(place, when, name)) for name in study.forms]) for when in ["before", *order, "after"]]
        for when, given in moments + [(g["when"], [g]) for g in asked_of(study, place)]:
            told = [g["scores"] for g in given if g and g.get("scores")]
            if told:
                row = {"participant": who, "block": when, "turn": order.index(when) + 1 if when in order else ""}
                rows.append(row | {k: round(v, 4) for scores_of in told for k, v in scores_of.items()})
                columns += [c for c in rows[-1] if c not in columns]
    text = io.StringIO()
    out = csv.DictWriter(text, columns, lineterminator="\n")
    out.writeheader()
    out.writerows(rows)
    return text.getvalue()


def table(asked):
    with alone(asked.folder) as study:
        text = scores(study)
        write_file(os.path.join(asked.folder, "scores.csv"), text)
    print(text, end="")


class Flags(argparse.ArgumentParser):
    def error(self, message):
        raise Refused(f"study: {message}; accepted: {', '.join(WORDS)}, FOLDER, PNN: neritic study --help")


def main():
    parser = Flags(prog="neritic study", description=__doc__.splitlines()[0])
    parser.add_argument("--program", required=True, help=argparse.SUPPRESS)
    parser.add_argument("what", choices=WORDS)
    parser.add_argument("folder")
    parser.add_argument("who", nargs="?")
    parser.add_argument("text", nargs="?")
    parser.add_argument("--plan")
    parser.add_argument("--answers", help="a file of answers, one a line, in place of the keyboard: for rehearsals")
    parser.add_argument("--yes", action="store_true", help="of withdraw: erases without asking")
    parser.add_argument("--robot", metavar="NAME", help="of wizard: the vehicle that it flies, where the scene has several")
    parser.add_argument("--server", metavar="ADDRESS", help="of wizard: where the dive is served [tcp://127.0.0.1:47910]")
    parser.add_argument("--key", metavar="FILE", help="of wizard: its own NAME.secret of `neritic keys`")
    parser.add_argument("--server-key", metavar="FILE", help="of wizard: the server's server.public")
    parser.add_argument("--speak", metavar="COMMAND", help="of wizard: a program that says phrases, each its last word, as \"spd-say --wait\"")
    endings.listen()
    try:
        asked = parser.parse_args()
        screen = Screen(asked.answers)
        for flag in ("robot", "server", "key", "server_key", "speak"):
            if getattr(asked, flag) is not None and asked.what != "wizard":
                raise Refused(f"study {asked.what}: found --{flag.replace('_', '-')}; accepted: of wizard alone")
        if asked.what in ("run", "ask", "mark", "withdraw", "wizard") and not asked.who:
            raise Refused(f"study {asked.what}: found no participant; accepted: one's pseudonym, as P01")
        if asked.what == "begin":
            begin(asked)
        elif asked.what == "enrol":
            enrol(asked, screen)
        elif asked.what == "run":
            run(asked, screen)
        elif asked.what == "ask":
            study = Study(asked.folder)
            if asked.text not in study.forms:
                raise Refused(f"study ask: found {asked.text or 'no questionnaire'}; accepted: {', '.join(study.forms)}")
            with Present(asked.folder, asked.who):
                ask(study, asked.who, asked.text, screen)
        elif asked.what == "mark":
            with Present(asked.folder, asked.who) as present:
                note(present.place, marker=asked.text or "mark")
        elif asked.what == "withdraw":
            withdraw(asked, screen)
        elif asked.what == "wizard":
            import wizard
            with Present(asked.folder, asked.who) as present:
                wizard.run(asked, present.place, lambda **what: note(present.place, **what))
        else:
            table(asked)
        return 0
    except Refused as error:
        print(f"neritic: {error}", file=sys.stderr)
        return 2
    except (Failed, OSError) as error:
        print(f"neritic: {error}", file=sys.stderr)
        return 1
    except endings.Ended as ended:
        print("\nneritic: study: interrupted; what is answered is kept, the same command goes on", file=sys.stderr)
        return ended.status


if __name__ == "__main__":
    sys.exit(main())
