"""A Wizard of Oz's console: an experimenter in another room flies the robot of a served dive by keys, unseen, and speaks for
it by numbered phrases. Each key is a marker. From the first key that flies on the robot is the wizard's until 0: without a key it
stays where it is. `neritic serve SCENE --realtime` or `neritic dive SCENE --serve` beside it; keys go through a terminal."""
import math
import os
import select
import sys
import termios
import time
import tty

from runner import Tools
from scenario import Failed

ADDRESS = "tcp://127.0.0.1:47910"
SPEED_M_S, TURN_RAD_S, TELL_HZ, HOLD_S = 0.4, math.radians(30), 10.0, 1.0
STILL = [0.0, 0.0, 0.0, 0.0]
# key: forward, left, up, turn to port
KEYS = {"w": (1, 0, 0, 0), "s": (-1, 0, 0, 0), "a": (0, 1, 0, 0), "d": (0, -1, 0, 0), "r": (0, 0, 1, 0), "f": (0, 0, -1, 0),
        "q": (0, 0, 0, 1), "e": (0, 0, 0, -1)}
PHRASES = {"1": "come here", "2": "wait", "3": "look there", "4": "go up", "5": "well done"}
HELP = ("w s forward, back; a d to the sides; r f up, down; q e turn; space stop and stay; 1-5: " + ", ".join(PHRASES.values())
        + "; 0 gives the robot back; x ends")


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
    neritic = Tools(asked.program, place).python()
    try:
        world = neritic.connect(os.environ.get("NERITIC_SERVER", ADDRESS), name="wizard")
        robot = next(a for a in world.agents.values() if hasattr(a, "goto"))
    except StopIteration:
        raise Failed("study wizard: the served scene has no vehicle") from None
    except (neritic.Error, neritic.BadInput) as error:
        raise Failed(f"study wizard: {error}") from None
    print(HELP)
    note(marker="wizard begins", robot=robot.name)
    before, pressed, told = termios.tcgetattr(sys.stdin), {}, None
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
                    note(marker="wizard says", phrase=PHRASES[key])
                    print(f"said: {PHRASES[key]}", flush=True)
                elif key == " ":
                    pressed, told = {}, told or STILL
                    note(marker="wizard stops")
                elif key == "0":
                    robot.release()
                    pressed, told = {}, None
                    note(marker="wizard releases")
            way = way_of(pressed, time.monotonic())
            if told is None and not any(way):
                continue  # the robot's own
            # Told again and again: what is not renewed ends with its hold, and the robot would go on with its own plan.
            robot.velocity(*way, hold=HOLD_S)
            if way != told:
                note(marker="wizard flies", velocity=way)
            told = way
    finally:
        termios.tcsetattr(sys.stdin, termios.TCSADRAIN, before)
        robot.release()
        note(marker="wizard ends")
        world.close()
