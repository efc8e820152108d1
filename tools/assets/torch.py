"""A diver's hand-held torch: torch.glb, lens towards -z.

The handle runs down from the body; the hand is closed round it at the origin. The lens shines as `lens`.
"""
from pathlib import Path

from glb import Glb
from mesh import join, shade
from shapes import box, cylinder, revolve, torus

OUT = Path(__file__).resolve().parents[2] / "assets" / "models"
RISE = 0.052  # metres from the hand's middle up to the axis of the body


def body():
    """Tube with cooling ribs behind a wider head, cap and lanyard ring at the rear."""
    prof = [(0.014, 0.078), (0.0205, 0.074), (0.0215, 0.066), (0.0215, 0.052), (0.019, 0.050), (0.019, -0.040)]
    for k in range(5):
        z = -0.042 - 0.007 * k
        prof += [(0.0215, z), (0.0215, z - 0.003), (0.0190, z - 0.0035), (0.0190, z - 0.0065)]
    prof += [(0.0265, -0.082), (0.0280, -0.088), (0.0280, -0.108), (0.0262, -0.112), (0.0235, -0.112), (0.0225, -0.104)]
    parts = [revolve(prof[::-1], 28, (True, True)).at(0, RISE, 0)]
    parts.append(torus(0.009, 0.0022, 14, 6).rot("y", 90).at(0, RISE, 0.086))
    parts.append(box(0.012, 0.010, 0.034, 0.003).at(0, RISE - 0.022, 0.004))
    return parts


def main():
    glb = Glb("torch")
    metal = glb.material("metal", color=(0.030, 0.031, 0.034, 1), metal=0.0, rough=0.42)
    rubber = glb.material("rubber", color=(0.045, 0.045, 0.045, 1), rough=0.9)
    lens = glb.material("lens", color=(0.9, 0.9, 0.9, 1), rough=0.2, emissive=(1, 1, 1), strength=40.0)  # a lens seen aside glares, though the beam passes
    glass = cylinder(0.0225, 0.004, 28).at(0, RISE, -0.106)
    grip = cylinder(0.0145, 0.080, 18).rot("x", 90).rot("x", -12).at(0, -0.006, 0.008)
    glb.node("torch", glb.mesh("torch", [(shade(join(body()), 35), metal), (shade(grip, 40), rubber), (shade(glass, 35), lens)]))
    glb.save(OUT / "torch.glb")


if __name__ == "__main__":
    main()
