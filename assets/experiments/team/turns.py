"""Modems that take turns: each node sends one message in its slot of a round, so that no two talk at once. The messages
themselves go over the scene's modems, which lose some to noise and fading.

    talk = Turns(world, ["rov_a", "diver_a"], slot_s=1.5)
    talk.send("rov_a", b"...", kind="claim")          # waits for the slot; a newer one of the same kind replaces it
    talk.step()
    for sender, data in talk.heard("diver_a"): ..."""
import sys

import numpy as np


class Turns:
    def __init__(self, world, names, slot_s):
        self.world, self.names, self.slot_s = world, list(names), slot_s
        self.queues, self.last_turn, self.asked, self.delays_s = {n: [] for n in names}, None, {}, []
        self.counts = {"sent": 0, "received": 0, "lost": 0}
        events = sys.modules["neritic"].MODEM_EVENTS
        for name in names:
            world.on(f"{name}/modem", lambda seen: self._count(events[int(seen.event)]))

    def _count(self, event):
        if event in self.counts:
            self.counts[event] += 1
        elif event != "refused":
            self.counts["lost"] += 1

    def send(self, sender, data, kind):
        self.queues[sender] = [m for m in self.queues[sender] if m[0] != kind] + [(kind, data)]
        self.asked[sender, data] = self.world.time

    def step(self):
        turn = int(self.world.time / self.slot_s)
        if turn != self.last_turn:
            self.last_turn, name = turn, self.names[turn % len(self.names)]
            if self.queues[name]:
                self.world[name].send(self.queues[name].pop(0)[1])

    def heard(self, who):
        out = []
        for message in self.world[who].receive():
            if (message.sender, message.data) in self.asked:
                self.delays_s.append(message.received - self.asked[message.sender, message.data])
            out.append((message.sender, message.data))
        return out

    def delay_s(self):
        """Median from a message's asking to its last bit at a receiver: the wait for the slot, the travel, the bits."""
        return float(np.median(self.delays_s)) if self.delays_s else float("nan")
