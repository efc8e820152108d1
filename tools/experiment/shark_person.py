"""The shark's task with a person as the diver: `neritic dive` in a headset or a window shows the scene, serves it, and records
it with its markers; this end plays the shark, tells the ROV its place and judges, by the same clock and the same rules.

The shark stands until the person's gaze (a headset's eyes, in a window the middle of the view) has rested on it; time counts
from then.
"""
import json
import math
import os
import signal
import socket
import subprocess
import time

import numpy as np

from rotations import matrix
from scenario import SHIPPED, Failed, draw
from study import now

# The eyes of a diver, from the hips: towards the crown, left, towards the back. The body lies, as divers hover.
EYES_M = np.array([0.786, 0.0, -0.09])
SCENE = """[sun]
elevation_deg = 55
[water]
type = "{water}"
scattering = true
surface = true
[water.snow]
density_m3 = 150
[ambient]
bottom_depth_m = 40
[[objects]]
name = "diver"
class = "diver"
model = "{models}/diver.glb"
human = "{divers}/recreational.toml"
position_m = [0, -10, 0]
yaw_deg = {yaw!r}
pitch_deg = -90
[[objects.cameras]]
name = "eyes"
position_m = [0, 0.79, -0.2]
pitch_deg = 90
fov_deg = 75
width = 960
height = 600
"""
DISPLAYS = {"headset": "openxr", "window": "window"}
TASK = ("A shark is near. Turn (A, D, or the mouse with its right button held) until it is in the middle of the picture, and keep it "
        "there: a robot comes between you. W swims ahead.")
READY_S, CONNECT_S, PATIENCE_S, RADIUS_M = 2.0, 90.0, 30.0, 0.5


def away_deg(s, seed):
    """How far to starboard of the shark the person faces at the start: by the seed, so that nobody learns where to turn."""
    side = s["person_side"]
    if side == "by_seed":
        side = "port" if draw(seed, "person_side", 0.0, 1.0) < 0.5 else "starboard"
    angle = s["person_bearing_deg"] + draw(seed, "person_spread", -1.0, 1.0) * s["person_spread_deg"]
    return angle if side == "port" else -angle


def diver_of(s, seed):
    """The scene's part of a diver who is a person, who faces away from the shark."""
    return SCENE.format(water=s["water"], models=os.path.join(SHIPPED, "..", "models"), divers=os.path.join(SHIPPED, "..", "divers"),
                        yaw=-(s["shark_bearing_deg"] + away_deg(s, seed)))


def rests_on(eyes, gaze, shark, within_deg):
    """Whether a gaze from the eyes meets the shark: passes its middle within half a metre, or within that angle."""
    line = shark - eyes
    size = np.linalg.norm(gaze)
    if not size > 0.0:
        return False
    along = float(gaze @ line) / size
    beside = math.sqrt(max(0.0, float(line @ line) - along * along))
    return along > 0.0 and (beside <= RADIUS_M or math.degrees(math.atan2(beside, along)) <= within_deg)


def _free_port(kind):
    with socket.socket(socket.AF_INET, kind) as free:
        free.bind(("127.0.0.1", 0))
        return free.getsockname()[1]


class Person:
    """The served dive, and what is known of who wears it."""

    def __init__(self, s, seed, tools, scene):
        self.s, self.world, self.met_s, self.since, self.eyes, self.gaze = s, None, None, None, None, None
        folder = os.path.join(tools.out, "person")
        try:
            os.mkdir(folder)  # not OUT itself: one that was erased meanwhile, as by a withdrawal, stays so
        except FileExistsError:
            pass
        except FileNotFoundError:
            raise Failed(f"{tools.out}: found no such folder any more") from None
        tries = 1
        while os.path.exists(os.path.join(folder, f"seed_{seed}_{tries}.markers.jsonl")):
            tries += 1
        self.record = os.path.join(folder, f"seed_{seed}_{tries}")
        self.markers = open(self.record + ".markers.jsonl", "a", encoding="utf-8")
        self.port = s["markers"] or _free_port(socket.SOCK_DGRAM)
        self.sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        address = f"tcp://127.0.0.1:{_free_port(socket.SOCK_STREAM)}"
        self.told = open(self.record + ".log", "w+", encoding="utf-8")
        words = ["dive", scene, "--display", DISPLAYS[s["person"]], "--serve", address, "--record", self.record + ".mcap",
                 "--markers", str(self.port), "-q"]
        if s["person"] == "window":
            words += ["--swim", "--task", TASK]
        self.program = subprocess.Popen([tools.program, *words], stdout=self.told, stderr=subprocess.STDOUT)
        try:
            self._connect(tools.python(), address)
        except BaseException:
            self.close()
            raise

    def _connect(self, neritic, address):
        until = time.monotonic() + CONNECT_S
        while True:
            if self.program.poll() is not None:
                raise Failed(f"neritic dive: {self._last_line()}")
            try:
                self.world = neritic.connect(address, name="python", patience=PATIENCE_S)
                return
            except neritic.Error as error:
                if time.monotonic() > until:
                    raise Failed(f"neritic dive: no answer in {CONNECT_S:g} s ({error})") from None
                time.sleep(0.2)

    def _last_line(self):
        self.told.seek(0)
        lines = self.told.read().strip().splitlines()
        return lines[-1] if lines else f"it ended with status {self.program.returncode}"

    def mark(self, marker, **what):
        """Into the recording, Lab Streaming Layer, and the file beside the recording."""
        line = json.dumps({**now(), "marker": marker, **what})
        self.sender.sendto(line.encode()[:1024], ("127.0.0.1", self.port))
        self.markers.write(line + "\n")
        self.markers.flush()

    def look(self):
        """Takes where the eyes are and look; false when the dive has ended."""
        if self.program.poll() is not None:
            return False
        truth, motion = self.world.truth("diver"), self.world.observe().get("diver/motion")
        self.eyes = np.array(truth.position) + matrix(truth.orientation) @ EYES_M
        self.gaze = None if motion is None else np.array(motion.gaze)
        return True

    def meets(self, shark, time_s):
        """Whether the gaze has rested on the shark for gaze_held_s, at this time."""
        if self.gaze is None or not rests_on(self.eyes, self.gaze, shark, self.s["gaze_within_deg"]):
            self.since = None
            return False
        if self.since is None:
            self.since = time_s
        return time_s - self.since >= self.s["gaze_held_s"] - 1e-9

    def close(self):
        if self.world is not None:
            self.world.close()
        if self.program.poll() is None:
            self.program.send_signal(signal.SIGINT)
            try:
                self.program.wait(30)
            except subprocess.TimeoutExpired:
                self.program.kill()
                self.program.wait()
        for file in (self.markers, self.told, self.sender):
            file.close()
