"""Reads the gauges of the diver with little gas: nobody is played, the divers swim by the scene."""


class Player:
    def __init__(self, world, settings, seed):
        self.world, self.last, self.unfed, self.shared = world, 0.0, 0.0, 0.0

    def act(self, obs, stage, told):
        time = self.world.time
        dt, self.last = time - self.last, time
        motion, supply, condition = (obs.get(f"low/{k}") for k in ("motion", "supply", "condition"))
        if motion is None or supply is None or condition is None:
            return {}
        self.unfed += 0.0 if supply.fed else dt
        self.shared += dt if supply.donor > 0 and supply.fed else 0.0
        return {"bar": motion.tank_pa / 1e5, "unfed_s": self.unfed, "shared_s": self.shared, "taken_l": supply.taken_l,
                "saturation": condition.saturation, "lost": float(condition.lost > 0), "apart_m": supply.donor_m}
