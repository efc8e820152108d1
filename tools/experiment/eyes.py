"""Where a diver's eyes are and where the face looks, from the body's place and the rotations of its spine and neck. East, north, up; the
body's axes are forward (from the hips to the head), left, up (out of the back).

Lengths of the trunk's segments: De Leva 1996, table 4, as the program has them (diver/anthropometry.cpp); the eyes in the head:
diver/reach.hpp.
"""
import numpy as np

from rotations import matrix

# Shares of the height: hips to navel, navel to the end of the sternum, from there to the neck.
TRUNK = {"male": np.array([145.7, 215.5, 242.1]) / 1741.0, "female": np.array([181.5, 205.3, 228.0]) / 1735.0}
# The middle of the eyes from the neck: towards the crown, to the front.
ABOVE, IN_FRONT = 0.0900, 0.0500


def eyes_and_face(position, orientation, joints, height_m, sex="male"):
    """(the middle of the eyes, m; the way ahead of the face, a unit vector). position: of the hips; orientation: world from body, x y z w;
    joints: 15 rotations in a row, parent from child, of which abdomen, thorax and head are the first; none: a straight body."""
    at, turn = np.array(position, float), matrix(orientation)
    turns = np.array(joints, float).reshape(-1, 4)[:3]
    for i, share in enumerate(TRUNK[sex]):
        at = at + turn @ [share * height_m, 0.0, 0.0]
        if len(turns):
            turn = turn @ matrix(turns[i])
    return at + turn @ [ABOVE * height_m, 0.0, -IN_FRONT * height_m], turn @ [0.0, 0.0, -1.0]
