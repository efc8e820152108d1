"""A Wizard of Oz's console: an experimenter in another room flies the robot of a served dive by keys, unseen, works its gripper and
speaks for it by numbered phrases: the robot's modem sends them to a diver who has one and reads them on the instruments, a program of
the experimenter's says them (--speak), or the experimenter does. Each key is a marker.
From the first key that flies on the robot is the wizard's until 0: without a key it stays where it is. `neritic serve SCENE --realtime`
or `neritic dive SCENE --serve` beside it; keys go through a terminal."""
import math
import os
import select
import shlex
import shutil
import subprocess
import sys
import termios
import time
import tty

from runner import Tools
from scenario import Failed, Refused

ADDRESS = "tcp://127.0.0.1:47910"  # of neritic serve and dive --serve
SPEED_M_S, TURN_RAD_S, TELL_HZ, HOLD_S = 0.4, math.radians(30), 10.0, 1.0
STILL = [0.0, 0.0, 0.0, 0.0]
# key: forward, left, up, turn to port
KEYS = {"w": (1, 0, 0, 0), "s": (-1, 0, 0, 0), "a": (0, 1, 0, 0), "d": (0, -1, 0, 0), "r": (0, 0, 1, 0), "f": (0, 0, -1, 0),
        "q": (0, 0, 0, 1), "e": (0, 0, 0, -1)}
PHRASES = {"1": "come here", "2": "wait", "3": "look there", "4": "go up", "5": "well done"}
GRIPS = {"g": "close", "o": "open"}


def help_of(robot, grips, speaks, writes):
    phrases = "" if speaks else "go to the diver's instruments by modem: " if writes else "are markers of what you say: "
    return (f"{robot}: w s forward, back; a d to the sides; r f up, down; q e turn; space stop and stay; "
            + ("g o close, open the gripper; " if grips else "")
            + f"1-5 {phrases}{', '.join(PHRASES.values())}; 0 gives the robot back; x ends")


class Voice:
    """Says phrases by a program of the experimenter's, which gets each as its last word; one after the other is not waited for."""

    def __init__(self, command):
        """command: its words in one text, as of a shell; None: nobody says anything."""
        try:
            self.words = shlex.split(command or "")
        except ValueError as error:
            raise Refused(f"study wizard: --speak: found {command!r} ({error}); accepted: a program and its words") from None
        if command is not None and (not self.words or shutil.which(self.words[0]) is None):
            raise Refused(f"study wizard: --speak: found no program {command!r}; accepted: one that speaks its last word, as \"spd-say --wait\"")
        self.speaks = []

    def say(self, phrase):
        if self.words:
            self.speaks.append((phrase, subprocess.Popen([*self.words, phrase], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                                         stderr=subprocess.DEVNULL)))

    def failures(self):
        """Phrases whose program has ended with another status than 0 since the last call."""
        ended = [s for s in self.speaks if s[1].poll() is not None]
        self.speaks = [s for s in self.speaks if s not in ended]
        return [phrase for phrase, program in ended if program.returncode != 0]

    def close(self):
        for _, program in self.speaks:
            try:
                program.wait(10.0)
            except subprocess.TimeoutExpired:
                program.kill()
                program.wait()


def robot_of(world, name):
    """The vehicle of this name; without one, the only vehicle."""
    robots = {a.name: a for a in world.agents.values() if hasattr(a, "goto")}
    if not robots:
        raise Failed("study wizard: the served scene has no vehicle")
    if name is None and len(robots) > 1:
        raise Refused(f"study wizard: found {len(robots)} vehicles; accepted: --robot, one of {', '.join(robots)}")
    if name is not None and name not in robots:
        raise Refused(f"study wizard: --robot: found {name}; accepted: {', '.join(robots)}")
    return robots[name] if name is not None else next(iter(robots.values()))


def is_read(world, robot):
    """Whether a diver's modem can hear the robot's, so that phrases come to the diver's instruments."""
    return bool(robot.modem) and any(a.modem for a in world.agents.values() if hasattr(a, "jacket"))


def send(robot, phrase, refusals):
    """Whether the robot's modem took the phrase: it is busy while one is on its way."""
    try:
        robot.send(phrase)
    except refusals:
        return False
    return True


def way_of(pressed, at):
    """(forward, left, up, yaw rate) of the keys pressed within the last 0.6 s; {key: when}."""
    held = [KEYS[k] for k, when in pressed.items() if at - when < 0.6]
    total = [max(-1, min(1, sum(k[i] for k in held))) for i in range(4)]
    return [SPEED_M_S * v for v in total[:3]] + [TURN_RAD_S * total[3]]


def keys_waiting(terminal):
    """All keys that were pressed since the last call; waits for one a tenth of a second. None: the terminal has gone."""
    ready, _, _ = select.select([terminal], [], [], 1.0 / TELL_HZ)
    if not ready:
        return ""
    # Not by sys.stdin, whose buffer takes keys that select() then no longer sees.
    try:
        pressed = os.read(terminal, 4096)
    except OSError:
        pressed = b""
    return pressed.decode(errors="replace") if pressed else None


def run(asked, place, note):
    if not sys.stdin.isatty():
        raise Failed("study wizard: the input is no terminal; accepted: a terminal, for single keys")
    voice, neritic = Voice(asked.speak), Tools(asked.program, place).python()
    try:
        world = neritic.connect(asked.server or ADDRESS, name="wizard", key=asked.key, server_key=asked.server_key)
    except (neritic.Error, neritic.BadInput) as error:
        raise Failed(f"study wizard: {error}") from None
    try:
        robot = robot_of(world, asked.robot)
        _play(world, robot, voice, note, (neritic.Error, neritic.BadInput))
    except (neritic.Error, neritic.BadInput) as error:
        raise Failed(f"study wizard: {error}") from None
    finally:
        voice.close()
        world.close()


def _play(world, robot, voice, note, refusals):
    grips = any(stream.name == f"{robot.name}/gripper" for stream in world.streams)
    writes = is_read(world, robot)
    print(help_of(robot.name, grips, bool(voice.words), writes), flush=True)
    before, pressed, told, released = termios.tcgetattr(sys.stdin), {}, None, False
    note(marker="wizard begins", robot=robot.name)
    tty.setcbreak(sys.stdin)
    try:
        while True:
            keys = keys_waiting(sys.stdin.fileno())
            if keys is None or "x" in keys:
                break
            for key in keys:
                if key in KEYS:
                    pressed[key] = time.monotonic()
                elif key in PHRASES:
                    sent = writes and send(robot, PHRASES[key], refusals)
                    note(marker="wizard says", phrase=PHRASES[key], spoken=bool(voice.words), sent=sent)
                    voice.say(PHRASES[key])
                    print(f"{'said' if voice.words else 'sent' if sent else 'marked: say'}: {PHRASES[key]}", flush=True)
                elif key in GRIPS and grips:
                    robot.grip(GRIPS[key])
                    note(marker="wizard grips", gripper=GRIPS[key])
                    print(f"gripper: {GRIPS[key]}", flush=True)
                elif key == " ":
                    pressed, told = {}, told or STILL
                    note(marker="wizard stops")
                elif key == "0":
                    _give_back(robot, grips)
                    pressed, told = {}, None
                    note(marker="wizard releases")
            for phrase in voice.failures():
                note(marker="wizard was not heard", phrase=phrase)
                print(f"not said, the program failed: {phrase}", flush=True)
            way = way_of(pressed, time.monotonic())
            if told is None and not any(way):
                continue  # the robot's own
            # Told again and again: what is not renewed ends with its hold, and the robot would go on with its own plan.
            robot.velocity(*way, hold=HOLD_S)
            if way != told:
                note(marker="wizard flies", velocity=way)
            told = way
    finally:
        try:
            termios.tcsetattr(sys.stdin, termios.TCSADRAIN, before)
        finally:
            try:
                _give_back(robot, grips)
                released = True
            finally:  # also where the server or the terminal has gone
                note(marker="wizard ends", released=released)


def _give_back(robot, grips):
    robot.release()
    if grips:
        robot.grip("auto")  # what it holds stays held
