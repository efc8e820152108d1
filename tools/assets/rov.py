"""An eight-thruster observation vehicle, 457 x 575 x 254 mm, imaging sonar in front.

Origin at the centre, bow along -z, y up. thruster_0..3 are the horizontal ones
(45 degrees; starboard bow, port bow, starboard stern, port stern), 4..7 the
vertical ones in the same order. A propeller node's own -z is its thrust axis.
"""
from pathlib import Path

import numpy as np

import noise as N
from glb import Glb, qmul, quat
from mesh import join, loft, shade
from plate import fillet, plate
from shapes import box, circle, curve, cylinder, foil, revolve, ring_band, round_rect, tube

OUT = Path(__file__).resolve().parents[2] / "assets" / "models"
L, W, H = 0.457, 0.575, 0.254
BLACK, BLUE, WHITE, GREY, GREEN, RED = (
    (0.025, 0.025, 0.028),
    (0.02, 0.16, 0.45),
    (0.75, 0.76, 0.76),
    (0.20, 0.21, 0.22),
    (0.10, 0.42, 0.16),
    (0.55, 0.05, 0.03),
)


def plastic(n=512, size=0.3):
    """Clean moulded plastic with slight wear; tinted by vertex colour."""
    a, f = N.spectral(n, 12, 2.2, 2, 24), N.spectral(n, 13, 0.4, 60)
    scratch = N.smooth(2.0, 3.0, N.spectral(n, 14, 1.0, 6, stretch=(1, 12)))
    tone = 0.90 + 0.015 * a + 0.02 * f - 0.15 * scratch
    rough = 0.52 + 0.05 * a + 0.2 * scratch
    return (
        np.clip(tone[..., None] * np.ones(3), 0, 1),
        N.rough_metal(np.clip(rough, 0.3, 0.9)),
        N.normal_map(0.00003 * f + 0.00004 * a, size),
    )


def side_plate():
    """Black side plate with lightening holes, drawn in (z, y) and stood up."""
    o = fillet(
        [
            (-L / 2, -H / 2),
            (L / 2, -H / 2),
            (L / 2, -0.085),
            (0.200, -0.055),
            (0.200, 0.030),
            (0.150, 0.070),
            (-0.150, 0.070),
            (-0.200, 0.030),
            (-0.200, -0.055),
            (-L / 2, -0.085),
        ],
        [0.012, 0.012, 0.015, 0.02, 0.03, 0.03, 0.03, 0.03, 0.02, 0.015],
    )
    holes = [
        fillet([(-0.175, -0.045), (-0.06, -0.045), (-0.06, 0.025), (-0.145, 0.025), (-0.175, 0)], 0.014),
        fillet([(0.06, -0.045), (0.175, -0.045), (0.175, 0), (0.145, 0.025), (0.06, 0.025)], 0.014),
        fillet([(-0.040, -0.050), (0.040, -0.050), (0.040, 0.035), (-0.040, 0.035)], 0.018),
        fillet([(-0.19, -0.105), (-0.055, -0.105), (-0.055, -0.075), (-0.19, -0.075)], 0.010),
        fillet([(0.055, -0.105), (0.19, -0.105), (0.19, -0.075), (0.055, -0.075)], 0.010),
        fillet([(-0.035, -0.105), (0.035, -0.105), (0.035, -0.075), (-0.035, -0.075)], 0.010),
    ]
    return plate(o, holes, 0.010).rot("y", 90)


def frame():
    """Side plates, outriggers for the vertical thrusters, cross members, skids."""
    bits = [side_plate().at(s * 0.164, 0, 0) for s in (1, -1)]
    centre = plate(
        fillet([(-0.159, -0.16), (0.159, -0.16), (0.159, 0.16), (-0.159, 0.16)], 0.01),
        [
            fillet([(-0.12, 0.03), (0.12, 0.03), (0.12, 0.12), (-0.12, 0.12)], 0.015),
            fillet([(-0.12, -0.12), (0.12, -0.12), (0.12, -0.03), (-0.12, -0.03)], 0.015),
        ],
        0.008,
    )
    bits.append(centre.rot("x", 90).at(0, -0.058, 0))
    for s in (1, -1):
        arm = fillet(
            [
                (0.0, -0.15),
                (0.03, -0.185),
                (0.115, -0.185),
                (0.118, -0.06),
                (0.05, -0.035),
                (0.05, 0.035),
                (0.118, 0.06),
                (0.115, 0.185),
                (0.03, 0.185),
                (0.0, 0.15),
            ],
            0.02,
        )
        p = plate(arm, [circle(24, 0.040) + [0.072, -0.120], circle(24, 0.040) + [0.072, 0.120]], 0.008).rot("x", 90)
        p = p if s > 0 else p.mirrored()
        bits.append(p.at(s * 0.169, 0.034, 0))
        bits.append(box(0.026, 0.016, L - 0.02, 0.006).at(s * 0.164, -H / 2 + 0.008, 0))
    for z in (-0.155, 0.155):
        bits.append(cylinder(0.009, 0.32, 12).rot("y", 90).at(0, -0.112, z))
        bits.append(box(0.32, 0.02, 0.008, 0.003).at(0, 0.052, z))
    return join(bits)


def screws():
    bits = []
    for s in (1, -1):
        for z in (-0.2, -0.12, 0.12, 0.2):
            for y in (-0.06, 0.045):
                if abs(z) > 0.15 and y > 0:
                    continue
                bits.append(
                    revolve([(0.0005, 0.004), (0.004, 0.0036), (0.0055, 0.001), (0.0055, 0)], 10, (True, True))
                    .rot("y", 90 * s)
                    .at(s * 0.169, y, z)
                )
    return join(bits)


def fairing():
    """Two blue float blocks with rounded tops, on either side of the tube."""
    out = []
    for s in (1, -1):
        rings = []
        for z, k in (
            (-0.200, 0.50),
            (-0.192, 0.78),
            (-0.175, 0.95),
            (-0.14, 1),
            (0.14, 1),
            (0.175, 0.95),
            (0.192, 0.78),
            (0.200, 0.50),
        ):
            w, h = 0.086 * (0.55 + 0.45 * k), 0.066 * k
            o = round_rect(w, h, min(w, h) * 0.36, 4)
            rings.append(np.column_stack([o[:, 0] + s * 0.112, o[:, 1] + 0.062 + h / 2 - 0.001, np.full(len(o), z)]))
        out.append(loft(rings))
    return join(out)


def tubes():
    """Electronics tube with end caps, battery tube beneath, penetrators, cables."""
    metal, black, acrylic = [], [], []
    for y, z0, z1, r in ((0.020, -0.100, 0.145, 0.0572), (-0.083, -0.135, 0.135, 0.0385)):
        ln = z1 - z0
        body = cylinder(r, ln, 36, 0.002).at(0, y, (z0 + z1) / 2)
        (metal if y < 0 else black).append(body)
        for z in (z0, z1):
            black.append(ring_band(r - 0.004, r + 0.006, 0.016, 36).at(0, y, z))
            metal.append(
                cylinder(r, 0.010, 36, 0.002).at(
                    0, y, z + (0.008 if z > 0 else -0.008) * (1 if y < 0 or z > 0 else 0)
                )
            )
        for k in range(6 if y > -0.05 else 3):
            a = k / (6 if y > -0.05 else 3) * 2 * np.pi
            metal.append(
                cylinder(0.007, 0.018, 10, 0.002).at(np.cos(a) * r * 0.6, y + np.sin(a) * r * 0.6, z1 + 0.02)
            )
    for k in range(6):
        a = k / 6 * 2 * np.pi
        s = 1 if np.cos(a) > 0 else -1
        p0 = np.array([np.cos(a) * 0.034, 0.020 + np.sin(a) * 0.034, 0.17])
        black.append(
            tube(
                curve(
                    [
                        p0,
                        p0 + [s * 0.01, 0.01, 0.025],
                        [s * 0.10, 0.035, 0.185],
                        [s * 0.155, 0.036 - 0.005 * k, 0.12 - 0.03 * k],
                    ],
                    16,
                ),
                0.0033,
                6,
            )
        )
    black.append(tube(curve([[0, 0.02, 0.17], [0, 0.03, 0.205], [0, 0.075, 0.24], [0.02, 0.13, 0.30]], 16), 0.004, 6))
    return metal, black, acrylic


def camera_dome():
    """Clear dome, retaining ring and the tilt camera behind it."""
    y, z0 = 0.020, -0.110
    prof = [(0.052 * np.cos(a), z0 - 0.052 * np.sin(a)) for a in np.linspace(0, np.pi / 2 - 0.02, 12)]
    dome = revolve(prof, 36, (False, True)).at(0, y, 0)
    ring = ring_band(0.051, 0.064, 0.014, 36).at(0, y, z0)
    back = cylinder(0.050, 0.006, 32, 0.001).at(0, y, z0 + 0.010)
    cam = [
        box(0.042, 0.036, 0.022, 0.004).at(0, y, z0 - 0.006),
        box(0.056, 0.012, 0.018, 0.003).at(0, y - 0.022, z0 - 0.002),
    ]
    lens = revolve([(0.0145, 0.012), (0.0145, -0.010), (0.012, -0.014), (0.011, -0.009), (0.0005, -0.009)], 22).at(
        0, y, z0 - 0.026
    )
    eye = revolve([(0.010, 0), (0.007, -0.003), (0.0005, -0.004)], 18).at(0, y, z0 - 0.036)
    return dome, ring, [back] + cam, lens, eye


def lights():
    body, glass = [], []
    for s in (1, -1):
        b = revolve(
            [
                (0.010, 0.035),
                (0.016, 0.03),
                (0.0185, 0.02),
                (0.0185, -0.018),
                (0.017, -0.022),
                (0.0145, -0.022),
                (0.0135, -0.016),
            ],
            22,
        )
        body.append(b.rot("y", -s * 6).at(s * 0.128, -0.085, -0.196))
        fins = [
            ring_band(0.017, 0.021, 0.003, 20).rot("y", -s * 6).at(s * 0.128, -0.085, -0.196 + dz)
            for dz in (0.004, 0.012, 0.020)
        ]
        body += fins
        glass.append(
            revolve([(0.0137, -0.015), (0.010, -0.017), (0.0005, -0.0175)], 18)
            .rot("y", -s * 6)
            .at(s * 0.128, -0.085, -0.196)
        )
    return body, glass


def sonar_head():
    """Multibeam imaging sonar under the front: body, tilted array face, bracket."""
    o = fillet(
        [(-0.062, -0.030), (0.062, -0.030), (0.062, 0.022), (0.045, 0.034), (-0.045, 0.034), (-0.062, 0.022)], 0.008
    )
    rings = [
        np.column_stack([o * k, np.full(len(o), z)])
        for z, k in ((-0.030, 0.90), (-0.026, 1), (0.034, 1), (0.040, 0.9))
    ]
    body = loft(rings).rot("x", -12).at(0, -0.094, -0.205)
    a = np.radians(np.linspace(-62, 62, 25))
    arc = np.column_stack([np.sin(a) * 0.052, np.zeros(25), -np.cos(a) * 0.030])
    face = loft(
        [
            arc + [0, 0.013, -0.012],
            arc * [1.04, 1, 1.10] + [0, 0.008, -0.012],
            arc * [1.04, 1, 1.10] + [0, -0.014, -0.012],
            arc + [0, -0.019, -0.012],
        ],
        (False, False),
        wrap=False,
        orient=False,
    )
    n = np.cross(
        face.pos[face.tri[:, 1]] - face.pos[face.tri[:, 0]], face.pos[face.tri[:, 2]] - face.pos[face.tri[:, 0]]
    )
    if n[:, 2].sum() > 0:
        face = face.flipped()
    face = face.rot("x", -12).at(0, -0.094, -0.205)
    bracket = [box(0.006, 0.05, 0.05, 0.002).at(s * 0.050, -0.090, -0.160) for s in (1, -1)] + [
        box(0.11, 0.006, 0.05, 0.002).at(0, -0.117, -0.160)
    ]
    cable = tube(
        curve([[0.02, -0.094, -0.165], [0.055, -0.085, -0.135], [0.085, -0.07, -0.08], [0.10, -0.04, 0.0]], 14),
        0.0035,
        6,
    )
    return body, face, bracket + [cable]


def thruster():
    """Duct, stator and motor about z, thrusting along -z."""
    duct = ring_band(0.0385, 0.0475, 0.048, 30, 0.25)
    flare = ring_band(0.0415, 0.0500, 0.010, 30, 0.25).at(0, 0, -0.021)
    motor = revolve(
        [
            (0.002, 0.052),
            (0.012, 0.050),
            (0.0175, 0.040),
            (0.019, 0.030),
            (0.019, 0.004),
            (0.017, 0.002),
            (0.002, 0.002),
        ],
        22,
    )
    bits = [duct, flare, motor]
    for k in range(3):
        bits.append(box(0.007, 0.030, 0.012, 0.002).at(0, 0.0295, 0.014).rot("z", 120 * k + 60))
    bits.append(box(0.022, 0.014, 0.040, 0.004).at(0, 0.052, 0.004))
    return join(bits)


def propeller(hand):
    bits = [revolve([(0.0005, -0.020), (0.006, -0.018), (0.0125, -0.008), (0.0145, 0), (0.0145, 0.006)], 18)]
    for k in range(3):
        sec = []
        for r, chord, pitch in ((0.012, 0.020, 52), (0.021, 0.026, 40), (0.030, 0.026, 31), (0.0368, 0.018, 26)):
            a = np.radians(pitch) * hand
            d = np.array([np.cos(a), 0, np.sin(a)]) * chord / 2
            sec.append(
                (np.array([0, r, -0.006]) - d, np.array([0, r, -0.006]) + d, 0.0032, [-np.sin(a), 0, np.cos(a)])
            )
        bits.append(foil(sec, 6).rot("z", 120 * k))
    return join(bits)


THRUSTERS = [  # position, yaw about y, pitch about x (degrees); -z of the node is the thrust
    ((0.108, -0.026, -0.150), 45, 0),
    ((-0.108, -0.026, -0.150), -45, 0),
    ((0.108, -0.026, 0.150), 135, 0),
    ((-0.108, -0.026, 0.150), -135, 0),
    ((0.2375, 0.034, -0.120), 0, 90),
    ((-0.2375, 0.034, -0.120), 0, 90),
    ((0.2375, 0.034, 0.120), 0, 90),
    ((-0.2375, 0.034, 0.120), 0, 90),
]


def main():
    g = Glb("rov")
    c, mr, n = plastic()
    tex = dict(base=g.texture("plastic_color", c, 85), normal=g.texture("plastic_normal", n, 64))
    mr_i = g.texture("plastic_mr", mr, 80)
    m_pl = g.material("plastic", mr=mr_i, metal=1.0, rough=1.0, **tex)
    m_foam = g.material("fairing", (1, 1, 1, 1), rough=0.42, **tex)
    m_met = g.material("metal", (0.72, 0.73, 0.75, 1), metal=1.0, rough=0.32)
    m_dome = g.material("dome", (0.55, 0.65, 0.70, 0.22), rough=0.04, blend=True)
    m_glass = g.material("lens", (0.01, 0.012, 0.018, 1), rough=0.04)
    m_lamp = g.material("lamp", (0.95, 0.95, 0.90, 1), rough=0.15, emissive=(1.0, 0.97, 0.90))
    paint = lambda ps, rgb: shade(join(ps if isinstance(ps, list) else [ps]).tiled(0.3), 38).colored(rgb)
    metal, black, _ = tubes()
    dome, ring, cam, lens, eye = camera_dome()
    lamp_body, lamp = lights()
    son, face, bracket = sonar_head()
    root = g.node("rov")
    g.node(
        "frame",
        g.mesh(
            "frame",
            [
                (join([paint(frame(), BLACK), paint(black, (0.035, 0.036, 0.04)), paint(bracket, BLACK)]), m_pl),
                (shade(join(metal + [screws()] + lamp_body).tiled(0.3)), m_met),
            ],
        ),
        parent=root,
    )
    stripe = paint(fairing(), BLUE)
    g.node("fairing", g.mesh("fairing", [(stripe, m_foam)]), parent=root)
    g.node(
        "camera",
        g.mesh(
            "camera",
            [
                (join([paint(cam, GREY), paint(ring, BLACK), paint(lens, BLACK)]), m_pl),
                (shade(eye.tiled(0.3)), m_glass),
            ],
        ),
        parent=root,
    )
    g.node("lights", g.mesh("lights", [(shade(join(lamp).tiled(0.3)), m_lamp)]), parent=root)
    g.node(
        "sonar",
        g.mesh("sonar", [(join([paint(son, (0.06, 0.065, 0.07)), paint(face, (0.55, 0.28, 0.03))]), m_pl)]),
        parent=root,
    )
    t_mesh = g.mesh("thruster", [(paint(thruster(), (0.03, 0.03, 0.033)), m_pl)])
    props = [
        g.mesh(f"propeller_{k}", [(paint(propeller(h), rgb), m_pl)])
        for k, (h, rgb) in enumerate(((1, (0.03, 0.30, 0.55)), (-1, (0.05, 0.05, 0.055))))
    ]
    for k, (at, yaw, pitch) in enumerate(THRUSTERS):
        rot = qmul(quat("y", float(yaw)), quat("x", float(pitch)))
        node = g.node(f"thruster_{k}", t_mesh, at=at, rot=rot, parent=root)
        g.node(f"propeller_{k}", props[k % 2], at=(0, 0, -0.004), parent=node)
    g.node("dome", g.mesh("dome", [(shade(dome.tiled(0.3)), m_dome)]), parent=root)
    g.save(OUT / "rov.glb")


if __name__ == "__main__":
    main()
