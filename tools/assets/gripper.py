"""A straight two-jaw gripper for the ROV: gripper.glb, about 0.39 m long, its jaws open to 62 mm.

The origin is where it holds, between the jaws; axes are those of the vehicle (bow along -z). From there it
goes back, down and to starboard, to the frame's lower bow corner where the origin lies at (0, -0.05, -0.45) on
rov.glb: below the camera's sight and above the sonar's. jaw_starboard and jaw_port turn about their own y.
"""
from pathlib import Path

import numpy as np

from glb import Glb, qmul, quat
from mesh import join, shade
from plate import fillet, plate
from shapes import box, curve, cylinder, revolve, ring_band, tube

OUT = Path(__file__).resolve().parents[2] / "assets" / "models"
YAW, PITCH = 18.5, 9.5  # degrees
PIN = np.array([0.011, 0.076])  # x and z of the starboard jaw's


def body():
    """Along +z from where it holds: clevis, wrist tube, motor tube with its clamps, cable."""
    bits = [
        revolve([(0.0005, 0.128), (0.0155, 0.128), (0.0155, 0.300), (0.0125, 0.306), (0.0005, 0.306)], 28),
        revolve(
            [(0.0005, 0.090), (0.0105, 0.090), (0.0105, 0.114), (0.0172, 0.120), (0.0172, 0.132), (0.0005, 0.132)], 28
        ),
        ring_band(0.0100, 0.0125, 0.006, 24).at(0, 0, 0.100),
        box(0.026, 0.016, 0.012, 0.002).at(0, 0, 0.094),
        tube(curve([[0, 0, 0.300], [0, 0.002, 0.322], [0.012, 0.020, 0.345], [0.010, 0.050, 0.380]], 12), 0.0033, 6),
    ]
    for z in (0.245, 0.296):
        bits += [ring_band(0.0150, 0.0172, 0.012, 28).at(0, 0, z), box(0.026, 0.020, 0.012, 0.003).at(0, -0.022, z)]
    return join(bits + [box(0.040, 0.004, 0.034, 0.0015).at(0, s * 0.0085, 0.080) for s in (1, -1)])


def jaw():
    """The starboard jaw about its pin: it bends round what it holds, with teeth along its inner side."""
    teeth = [(0.0310 + 0.0016 * (k % 2), z) for k, z in enumerate(np.arange(-0.028, 0.027, 0.0045))]
    outline = fillet(
        [(0.004, 0.086), (0.021, 0.086), (0.0425, 0.048), (0.0435, -0.008), (0.0330, -0.041), (0.0235, -0.042), *teeth]
        + [(0.0310, 0.033), (0.0150, 0.064), (0.004, 0.066)],
        [0.005, 0.008, 0.012, 0.012, 0.003, 0.002] + [0.0003] * len(teeth) + [0.006, 0.004, 0.004],
    )
    hole = fillet([(0.0245, 0.065), (0.0360, 0.043), (0.0370, 0.010), (0.0345, 0.010), (0.0335, 0.035)], 0.001)
    return plate(outline - PIN, [hole - PIN], 0.012).rot("x", 90)


def main():
    g = Glb("gripper")
    black = g.material("anodised", (0.045, 0.046, 0.050, 1), metal=0.0, rough=0.45)
    steel = g.material("metal", (0.72, 0.73, 0.75, 1), metal=1.0, rough=0.32)
    made = lambda part: shade(part.tiled(0.3), 38)
    turn = qmul(quat("y", YAW), quat("x", PITCH))
    root = g.node("gripper")
    held = g.node("body", g.mesh("body", [(made(body()), black)]), rot=turn, parent=root)
    pin = cylinder(0.0042, 0.026, 14, 0.001).rot("x", 90)
    for name, part, side in (("jaw_starboard", jaw(), 1), ("jaw_port", jaw().mirrored(), -1)):
        mesh = g.mesh(name, [(made(part), black), (made(pin), steel)])
        g.node(name, mesh, at=(side * PIN[0], 0, PIN[1]), parent=held)
    g.save(OUT / "gripper.glb")


if __name__ == "__main__":
    main()
