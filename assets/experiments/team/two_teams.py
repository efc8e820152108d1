"""Plays two divers and what lies on the bottom. An ROV that passes within swath_m / 2 looks at the bottom there and
finds a contact with find_share; a diver who is told of a contact swims to the nearest one that he knows and nobody has
told to be done, and looks at it for dwell_s. He tells of it by his own modem.

Messages, at most 64 bytes: C and rows of (strip, seconds) a claim; K and numbers the contacts; D and numbers what is done."""
import numpy as np

from turns import Turns

TEAMS, UP = ("a", "b"), -12.0


class Player:
    def __init__(self, world, settings, seed):
        self.world, self.s = world, settings
        rng = self.rng = np.random.Generator(np.random.Philox(key=seed))
        self.side, n = settings["side_m"], int(settings["side_m"])
        middle = np.arange(n) + 0.5
        self.cells = np.stack(np.meshgrid(middle, middle, indexing="ij"), -1)  # east, north
        self.looks = {t: np.zeros((n, n), bool) for t in TEAMS}
        self.contacts = rng.uniform(1.0, self.side - 1.0, (int(settings["contacts"]), 2))
        self.done, self.looked_s = set(), {}
        self.divers = {"a": np.array([0.0, 0.0]), "b": np.array([4.0, 0.0])}
        self.knows = {t: {} for t in TEAMS}  # of a diver: {contact: done}
        self.found, self.tried = {t: set() for t in TEAMS}, {}  # of an ROV, to tell on
        self.talk = Turns(world, [f"{k}_{t}" for t in TEAMS for k in ("rov", "diver")], settings["slot_s"])
        self.last = 0.0

    def act(self, obs, stage, told):
        time = self.world.time
        dt, self.last = time - self.last, time
        rovs = {t: np.array(self.world.truth(f"rov_{t}").position) for t in TEAMS}
        if self.s["channel"]:
            self.talk.step()
        for team in TEAMS:
            self._look(team, rovs[team])
            self._dive(team, dt)
        c = self.talk.counts
        return {"covered": float((self.looks["a"] | self.looks["b"]).mean()),
                "twice": float((self.looks["a"] & self.looks["b"]).mean()),
                "found": float(len(self.found["a"] | self.found["b"])), "inspected": float(len(self.done)),
                "sent": float(c["sent"]), "lost": float(c["lost"]), "received": float(c["received"]), "delay_s": self.talk.delay_s()}

    def _look(self, team, at):
        near = np.hypot(*(self.cells - at[:2]).transpose(2, 0, 1)) <= self.s["swath_m"] / 2
        self.looks[team] |= near
        for i, place in enumerate(self.contacts):
            if np.hypot(*(place - at[:2])) <= self.s["swath_m"] / 2:
                # One draw each 2 m of way, so that a second pass can find what the first missed.
                key = (team, i, int(at[0] // 2), int(at[1] // 2))
                if key not in self.tried:
                    self.tried[key] = self.rng.random() < self.s["find_share"]
                    if self.tried[key]:
                        self.found[team].add(i)

    def _dive(self, team, dt):
        me, knows = f"diver_{team}", self.knows[team]
        for _, data in self.talk.heard(me):
            for i in data[1:] if data[:1] in (b"K", b"D") else ():
                knows[i] = knows.get(i, False) or data[:1] == b"D"
        open_ones = [i for i, over in knows.items() if not over]
        speed = np.zeros(2)
        if open_ones:
            goal = min(open_ones, key=lambda i: (float(np.hypot(*(self.contacts[i] - self.divers[team]))), i))
            line = self.contacts[goal] - self.divers[team]
            far = float(np.hypot(*line))
            if far > 1.0:
                speed = 0.35 * line / far
            else:
                self.looked_s[team, goal] = self.looked_s.get((team, goal), 0.0) + dt
                if self.looked_s[team, goal] >= self.s["dwell_s"]:
                    knows[goal] = True
                    self.done.add(goal)
                    self.talk.send(me, b"D" + bytes(sorted(i for i, over in knows.items() if over)), "done")
        self.divers[team] = self.divers[team] + speed * dt
        self.world[me].pose([*self.divers[team], UP], velocity=[*speed, 0.0])
