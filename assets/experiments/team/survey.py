"""Baseline: the square is cut into strips, a swath wide. Each ROV takes the nearest strip that it does not know to be taken, says
so, and says so again every say_s; where two have claimed one, the one who said so later turns to another. Contacts
are told to the divers until one tells that they are done. Without a channel each ROV knows its own strips alone."""
import math
import struct

import numpy as np

UP, TEAMS = -12.0, ("a", "b")


class Controller:
    def __init__(self, world, settings, seed):
        self.world, self.s = world, settings
        self.strips = int(math.ceil(settings["side_m"] / (0.9 * settings["swath_m"])))
        self.team = {t: {"strip": None, "taken": {}, "way": [], "said": -99.0, "told": -99.0, "over": set()} for t in TEAMS}

    def act(self, obs, stage):
        for name, team in self.team.items():
            self._listen(name, team)
            self._fly(name, team)
            if self.s["channel"]:
                self._talk(name, team)
        return {}

    def _listen(self, name, team):
        for _, data in self.player.talk.heard(f"rov_{name}"):
            if data[:1] == b"C":
                for strip, when in struct.iter_unpack("<BH", data[1:]):
                    mine = team["taken"].get(strip)
                    team["taken"][strip] = when if mine is None else min(mine, when)
                    if strip == team["strip"] and mine is not None and when < mine and len(team["way"]) == 2:
                        team["strip"] = None  # the other was first, and this one has not begun
            elif data[:1] == b"D":
                team["over"] |= set(data[1:])

    def _fly(self, name, team):
        rov, time = np.array(self.world.truth(f"rov_{name}").position), self.world.time
        if team["strip"] is None or not team["way"]:
            free = [k for k in range(self.strips) if k not in team["taken"]]
            if not free:
                return
            team["strip"] = min(free, key=lambda k: (abs(self._east(k) - rov[0]), k))
            team["taken"][team["strip"]], team["said"] = int(time), -99.0
            ends = [np.array([self._east(team["strip"]), north, UP]) for north in (0.0, self.s["side_m"])]
            team["way"] = ends if np.linalg.norm(ends[0] - rov) < np.linalg.norm(ends[1] - rov) else ends[::-1]
            team["at"] = rov
        # A point that moves along the way at the survey's speed, for the ROV to keep up with.
        line = team["way"][0] - team["at"]
        far = float(np.linalg.norm(line))
        step = self.s["speed_m_s"] / 5.0
        if far <= step:
            team["at"] = team["way"].pop(0)
            return
        moves = line / far * step
        if np.linalg.norm(team["at"] - rov) < 1.5:
            team["at"] = team["at"] + moves
        self.world[f"rov_{name}"].goto(*team["at"], math.atan2(line[1], line[0]), velocity=moves * 5.0)

    def _east(self, strip):
        return (strip + 0.5) * self.s["side_m"] / self.strips

    def _talk(self, name, team):
        time, talk = self.world.time, self.player.talk
        if time - team["said"] >= self.s["say_s"]:
            team["said"] = time
            newest = sorted(team["taken"].items(), key=lambda k: -k[1])[:21]  # what fits into 64 bytes
            talk.send(f"rov_{name}", b"C" + b"".join(struct.pack("<BH", k, int(when)) for k, when in newest), "claim")
        open_ones = sorted(self.player.found[name] - team["over"])
        if open_ones and time - team["told"] >= self.s["say_s"]:
            team["told"] = time
            talk.send(f"rov_{name}", b"K" + bytes(open_ones), "contact")
