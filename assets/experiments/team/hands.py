"""The tool lies on a rack 4 m or more from the diver, who hovers by the physics of the scene and, by the autopilot's hands,
reaches for and takes what the gripper holds out. The player only puts the tool into its rack and tells what grips say."""
import math

import numpy as np


class Player:
    def __init__(self, world, settings, seed):
        self.world = world
        rng = np.random.Generator(np.random.Philox(key=seed))
        way, far = rng.uniform(-math.pi, math.pi), rng.uniform(4.0, settings["rack_m"])
        self.rack, self.placed = [far * math.cos(way), far * math.sin(way), -12.3], False

    def act(self, obs, stage, told):
        if not self.placed:
            self.world["tool"].pose(self.rack, hold=0.1)
            self.placed = True
        hand, grip = obs.get("diver/gripper"), obs.get("rov/gripper")
        told = {"held": 0.0, "delivered": 0.0, "drops": 0.0, "load_n": 0.0}
        if grip is not None:
            told |= {"held": float(grip.held > 0), "drops": float(grip.drops), "load_n": float(grip.load_n)}
        if hand is not None:
            told |= {"delivered": float(hand.held > 0), "hand_east": hand.position[0], "hand_north": hand.position[1],
                     "hand_up": hand.position[2]}
        return told
