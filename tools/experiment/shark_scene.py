"""The scene of the shark's task, the shark's way in it, and the judge of whether it is blocked. East, north, up."""
import math
import os

import numpy as np

import shark_person
from scenario import SHIPPED
from shark_senses import CROP_DEG, DIVER, LIGHT, SEEN, SONAR

BESIDE_M, HELD_S, LEAST, MOST = 0.35, 1.0, 0.1, 0.9
SCENE = """title = "A shark, a diver, an ROV"
seed = {seed}
[physics]
rate_hz = {physics_hz}
{current}
{seen}
{diver}
[[objects]]
name = "shark"
class = "shark"
{shark_drawn}
position_m = {shark}
inputs = {{ pose = {{ from = "python", hold_s = 3600 }} }}
[[vehicles]]
name = "rov"
{rov_drawn}
dynamics = "{vehicle}"
navigation = "{navigation}"
position_m = {rov}
yaw_deg = {yaw!r}
mission = {{ hold = "station" }}
{sonar}"""


DRAWN = """[[objects]]
name = "diver"
class = "diver"
shape = "sphere"
radius_m = 0.05
position_m = [0, -10, 0]
inputs = { pose = { from = "python", hold_s = 3600 } }"""


def _scene_of_enu(p):
    return [float(p[0]), float(p[2]), -float(p[1])]


def shark_at(s, time):
    """(place, velocity) of the shark, east, north, up: it nears the diver and circles it at once."""
    bearing = math.radians(s["shark_bearing_deg"])
    r = max(1.0, s["shark_range_m"] - s["shark_speed_m_s"] * time)
    # The angle over time at the speed across: the integral of v / r.
    fast = s["shark_speed_m_s"]
    if fast > 1e-9:
        turned = s["shark_circling_m_s"] / fast * math.log(s["shark_range_m"] / r)
        turned += s["shark_circling_m_s"] * max(0.0, time - (s["shark_range_m"] - 1.0) / fast) / 1.0
    else:
        turned = s["shark_circling_m_s"] * time / r
    angle = bearing - turned
    out = np.array([math.sin(angle), math.cos(angle), 0.0])
    left = np.array([-math.cos(angle), math.sin(angle), 0.0])
    return DIVER + r * out, -fast * (r > 1.0) * out + s["shark_circling_m_s"] * left


def between(rov, diver, shark):
    """(along, beside): the ROV's projection on the line as a share of it, and its distance from the line in metres."""
    line = shark - diver
    along = float((rov - diver) @ line / (line @ line))
    return along, float(np.linalg.norm(rov - diver - along * line))


class Judge:
    """Whether the shark is blocked, and since when."""

    def __init__(self):
        self.held_from, self.blocked_s = None, None

    def see(self, time, rov, shark, diver=DIVER):
        """(along, beside) at this instant."""
        along, beside = between(rov, diver, shark)
        if beside <= BESIDE_M and LEAST <= along <= MOST:
            self.held_from = time if self.held_from is None else self.held_from
            if self.blocked_s is None and time - self.held_from >= HELD_S - 1e-9:
                self.blocked_s = self.held_from
        elif self.blocked_s is None:
            self.held_from = None
        return along, beside


def scene_of(s, seed):
    """The scene file of a run's settings."""
    shark, _ = shark_at(s, 0.0)
    bearing, about = math.radians(s["shark_bearing_deg"]), math.radians(s["offset_angle_deg"])
    across = np.array([math.cos(bearing) * math.cos(about), -math.sin(bearing) * math.cos(about), math.sin(about)])
    rov = 0.5 * (DIVER + shark) + s["offset_m"] * across
    file = "bluerov2_heavy_survey_dynamics.toml" if s["navigation"] == "measured" else "bluerov2_heavy_dynamics.toml"
    looks, sounds, person = s["detector"] != "assumed", s["shark_known_by"] == "sonar", s["person"] != "nobody"
    models = os.path.join(SHIPPED, "..", "models")
    return SCENE.format(
        seed=seed, physics_hz=s["physics_hz"], shark=_scene_of_enu(shark), rov=_scene_of_enu(rov), navigation=s["navigation"],
        current=f'[current]\nkind = "uniform"\nvelocity_m_s = [{s["current_m_s"]!r}, 0, 0]' if s["current_m_s"] else "",
        diver=shark_person.diver_of(s, seed) if person else DRAWN,
        seen=("" if person else LIGHT.format(**s)) + SEEN.format(fov=CROP_DEG, **s) if looks else "", sonar=SONAR.format(**s) if sounds else "",
        shark_drawn=f'model = "{models}/shark.glb"\nclip = "swim"' if looks or sounds or person else 'shape = "sphere"',
        rov_drawn=f'model = "{models}/rov.glb"' if looks or person else 'shape = "box"\nsize_m = [0.457, 0.254, 0.575]',
        vehicle=os.path.join(SHIPPED, "..", "vehicles", file),
        yaw=-(s["shark_bearing_deg"] + s["heading_deg"]))  # a scene's yaw is to port from north; a bearing is to starboard
