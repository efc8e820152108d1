"""The senses of the shark's task: a diver's eyes whose crops go to a detector, and an ROV's sonar that keeps track."""
import math

import numpy as np

import looking
from detector import model_of
from rotations import quaternion
from scenario import draw

DIVER = np.array([0.0, 0.0, -10.0])  # east, north, up
# With a detector that looks: light and water, which a person's scene has anyway; and a camera that looks where the diver's eyes do.
LIGHT = """[sun]
elevation_deg = 55
[water]
type = "{water}"
scattering = true
surface = true
"""
SEEN = """[[objects]]
name = "gaze"
shape = "sphere"
radius_m = 0.001
inputs = {{ pose = {{ from = "python", hold_s = 3600 }} }}
[[objects.cameras]]
name = "crop"
width = {crop_px}
height = {crop_px}
fov_deg = {fov}
rate_hz = 60
antialias = true
"""
CROP_DEG, EYE_M = 32.0, 0.4  # opening of a crop; the eye, ahead of the diver's middle


class Gaze:
    """The diver's eyes and the detector, asked ten times a second, on a thread of its own.

    A simulated diver turns the eyes to the shark, and each answer is awaited, so that a run's numbers do not hang on the clock.
    A person's crop is where the person looks, and an answer counts when it comes."""

    def __init__(self, world, settings, seed, person=None):
        detector = looking.Detector(model_of(settings["detector"]))
        world.images("gaze_crop/color", rate=10.0 if person else 60.0)
        self.world, self.s, self.seed, self.looker = world, settings, seed, looking.Looker(detector, settings["detector_least"])
        self.looks, self.wrong, self.work_s = 0, 0, []
        self.person, self.posed_s, self.shown = person, None, -1

    def sees_shark(self, shark):
        """Whether the detector said "shark": of this look, or of a person's since the last call."""
        return self._person_sees() if self.person else self._diver_sees(shark)

    def _diver_sees(self, shark):
        look = self.looks
        off = [math.radians(draw(self.seed, f"{way} {look}", -1, 1) * self.s["gaze_error_deg"]) for way in ("yaw", "pitch")]
        line = shark - DIVER
        yaw, up = math.atan2(line[1], line[0]), math.atan2(line[2], math.hypot(line[0], line[1]))
        self._turn(DIVER, line, yaw + off[0], up + off[1])
        self.world.tick(max(1, round(1 / 60 / self.world.step_s)))
        crop = self.world.observe().get("gaze_crop/color")
        self.looks += 1
        if crop is None:
            return False
        self.looker.show(np.array(crop.pixels), look)
        return self._heard(self.looker.answer(wait_s=30.0))

    def _person_sees(self):
        gaze = self.person.gaze
        if gaze is not None and np.linalg.norm(gaze) > 0.0:
            self._turn(self.person.eyes, gaze, math.atan2(gaze[1], gaze[0]), math.atan2(gaze[2], math.hypot(gaze[0], gaze[1])))
            if self.posed_s is None:
                self.posed_s = self.world.time
        crop = self.world.observe().get("gaze_crop/color")
        if crop is not None and self.posed_s is not None and crop.stamp > self.posed_s and crop.sequence != self.shown:
            self.shown = crop.sequence
            self.looker.show(np.array(crop.pixels), self.looks)
            self.looks += 1
        return any([self._heard(answer) for answer in self.looker.answers()])

    def _turn(self, eyes, line, yaw, up):
        eye = eyes + EYE_M * line / np.linalg.norm(line)
        self.world["gaze"].pose(eye, quaternion(yaw, -up, 0.0), velocity=[0, 0, 0])

    def _heard(self, answer):
        self.work_s.append(answer["latency_s"])
        named = [name for name, _, _ in answer["found"]]
        self.wrong += bool(named) and "shark" not in named
        return "shark" in named

    def close(self):
        self.looker.close()


SONAR = """[[vehicles.sonars]]
name = "sonar"
kind = "imaging"
position_m = [0, 0, -0.35]  # ahead of the drawn ROV: inside it hears nothing else
range_m = [0.5, 10]
azimuth_deg = 90
elevation_deg = 28
bins = [256, 128, 128]
rate_hz = {sonar_hz!r}
quality = "{sonar_quality}"
frequency_hz = 750e3
bandwidth_hz = 30e3
level = {{ tvg = 30 }}
noise = {{ self_db = 70 }}
speckle = {{}}
beam = {{ azimuth = "hamming", azimuth_deg = 1.5 }}
"""


class SonarTrack:
    """Where the ROV believes the shark: from the detector's word on, corrected by each ping (an alpha-beta filter, as in
    Bar-Shalom et al. 2001, 6.5). A sonar has no elevation: the shark counts as deep as the diver."""

    ALPHA, BETA = 0.5, 0.1

    def __init__(self, world, settings):
        self.world, self.at, self.moves, self.last, self.seen, self.errors = world, None, np.zeros(3), 0.0, -1, []
        self.ping_hz, self.pings, self.used = settings["sonar_hz"], 0, 0
        world.images("rov_sonar/echoes", rate=settings["sonar_hz"])

    def estimate(self, told):
        """(place, velocity). told: the shark's place, believed at the first call alone; later it judges the error."""
        time, image = self.world.time, self.world.observe().get("rov_sonar/echoes")
        if self.at is None:
            self.at = np.array(told)
        self.at = self.at + self.moves * (time - self.last)
        self.last = time
        if image is not None and image.sequence != self.seen:
            self.seen, heard = image.sequence, self._heard(image)
            self.pings += 1
            if heard is not None and np.hypot(*(heard - self.at)[:2]) < 2.0:
                self.used += 1
                off = heard - self.at
                self.at = self.at + self.ALPHA * off
                self.moves = self.moves + self.BETA * off * self.ping_hz
        self.errors.append(float(np.hypot(*(self.at - told)[:2])))
        return self.at, self.moves

    def _heard(self, image):
        echoes = np.asarray(image.pixels, float)
        if echoes.max() <= 0:
            return None
        loud = np.where(echoes >= 0.1 * echoes.max(), echoes, 0.0)
        near, far = image.range_limits
        first, last = image.azimuth_limits
        ranges = near + (np.arange(echoes.shape[0]) + 0.5) / echoes.shape[0] * (far - near)
        ways = first + (np.arange(echoes.shape[1]) + 0.5) / echoes.shape[1] * (last - first)
        r, way = (loud.sum(axis=1) @ ranges) / loud.sum(), (loud.sum(axis=0) @ ways) / loud.sum()
        x, y, z, w = image.orientation
        yaw = math.atan2(2 * (x * y + z * w), 1 - 2 * (y * y + z * z)) + way
        down = DIVER[2] - image.position[2]
        level = math.sqrt(max(0.0, r * r - down * down))
        return np.array([image.position[0] + level * math.cos(yaw), image.position[1] + level * math.sin(yaw), DIVER[2]])
