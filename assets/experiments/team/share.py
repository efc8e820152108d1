"""Baseline: the buddy offers the second regulator once the other's gauge is at share_bar, or reaction_s after nothing came to
breathe any more."""


class Controller:
    def __init__(self, world, settings, seed):
        self.world, self.s, self.asked = world, settings, False

    def act(self, obs, stage):
        if not self.told or self.asked:
            return
        if self.told["bar"] <= self.s["share_bar"] or self.told["unfed_s"] >= self.s["reaction_s"]:
            self.world["low"].regulator("donor")
            self.asked = True
