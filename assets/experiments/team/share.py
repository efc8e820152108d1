"""Baseline: the buddy offers the second regulator once the other's gauge is at share_bar, or reaction_s after nothing came to
breathe any more."""


class Controller:
    def __init__(self, world, settings, seed):
        self.world, self.s = world, settings
        self.last, self.unfed, self.shared, self.asked = 0.0, 0.0, 0.0, False

    def act(self, obs, stage):
        time = self.world.time
        dt, self.last = time - self.last, time
        motion, supply, condition = (obs.get(f"low/{k}") for k in ("motion", "supply", "condition"))
        if motion is None or supply is None or condition is None:
            return {}
        bar = motion.tank_pa / 1e5
        self.unfed += 0.0 if supply.fed else dt
        self.shared += dt if supply.donor > 0 and supply.fed else 0.0
        if not self.asked and (bar <= self.s["share_bar"] or self.unfed >= self.s["reaction_s"]):
            self.world["low"].regulator("donor")
            self.asked = True
        return {"bar": bar, "unfed_s": self.unfed, "shared_s": self.shared, "taken_l": supply.taken_l,
                "saturation": condition.saturation, "lost": float(condition.lost > 0), "apart_m": supply.donor_m}
