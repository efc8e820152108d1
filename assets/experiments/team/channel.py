"""An acoustic channel between named places, as rules: sound travels at 1500 m/s, a packet lasts its bits over the rate and is
lost where it overlaps another one at the receiver, while the receiver itself sends (half duplex), or by chance, more often
from afar. One carrier, everybody hears everybody: no routing, no multipath.

    channel.send("rov_a", {"strip": 3}, bytes=8)      # at channel.now
    channel.step(now, places)                          # {name: position}
    for sender, message, sent_at in channel.heard("rov_b"): ..."""
import numpy as np

SOUND_M_S = 1500.0


class Channel:
    def __init__(self, names, bit_s, lost_at_100_m, seed):
        self.names, self.bit_s, self.lost, self.now, self.places = list(names), bit_s, lost_at_100_m, 0.0, {}
        self.rng = np.random.Generator(np.random.Philox(key=seed + (1 << 50)))
        self.queues, self.busy_until = {n: [] for n in names}, {n: 0.0 for n in names}
        self.on_air, self.boxes = [], {n: [] for n in names}
        self.sent = self.collided = self.faded = self.arrived = 0
        self.delays_s = []

    def send(self, sender, message, bytes=16):
        """Waits in the sender's queue until its modem is free. A newer message of the same kind replaces one that waits."""
        queue = self.queues[sender]
        queue[:] = [m for m in queue if m[0].get("kind") != message.get("kind") or message.get("kind") == "contact"]
        queue.append((message, bytes, self.now))

    def heard(self, who):
        out, self.boxes[who] = self.boxes[who], []
        return out

    def step(self, now, places):
        self.now, self.places = now, places
        for sender in self.names:
            # Listens before it talks, and waits a random while after: neighbours that start at once collide.
            if self.queues[sender] and now >= self.busy_until[sender] and not self._hears_something(sender):
                message, size, asked = self.queues[sender].pop(0)
                lasts = 8 * size / self.bit_s + 0.1  # and a preamble
                self.busy_until[sender] = now + lasts + self.rng.uniform(0.2, 1.5)
                self.sent += 1
                for to in self.names:
                    if to != sender:
                        far = float(np.linalg.norm(places[sender] - places[to]))
                        self.on_air.append({"from": sender, "to": to, "message": message, "asked": asked, "sent": now, "far": far,
                                            "begins": now + far / SOUND_M_S, "ends": now + far / SOUND_M_S + lasts})
        for one in [a for a in self.on_air if a["ends"] <= now]:
            self._arrives(one)
        self.on_air = [a for a in self.on_air if a["ends"] > now - 5.0]  # what is over still collides with what began before

    def _hears_something(self, who):
        return any(a["to"] == who and a["begins"] <= self.now < a["ends"] for a in self.on_air)

    def _arrives(self, one):
        if one.get("done"):
            return
        one["done"] = True
        over = [a for a in self.on_air if a is not one and a["begins"] < one["ends"] and a["ends"] > one["begins"]
                and (a["to"] == one["to"] and a["from"] != one["from"])]
        talks = [a for a in self.on_air if a["from"] == one["to"] and a["sent"] < one["ends"]
                 and a["sent"] + (a["ends"] - a["begins"]) > one["begins"]]
        if over or talks:
            self.collided += 1
        elif self.rng.random() < min(1.0, self.lost * (one["far"] / 100.0) ** 2):
            self.faded += 1
        else:
            self.arrived += 1
            self.delays_s.append(self.now - one["asked"])
            self.boxes[one["to"]].append((one["from"], one["message"], one["sent"]))
