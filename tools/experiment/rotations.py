"""Rotations in numpy: quaternions are x y z w, matrices 3 x 3; both turn what is in a body's axes into the world's."""
import math

import numpy as np


def product(a, b):
    """Quaternion of b's rotation, then a's."""
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return [aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz]


def quaternion(yaw, pitch_down, roll):
    """Quaternion of a body (forward, left, up), in radians: about up, then about its own left, then about its own forward."""
    z, y, x = ((math.sin(a / 2), math.cos(a / 2)) for a in (yaw, pitch_down, roll))
    return product(product([0, 0, z[0], z[1]], [0, y[0], 0, y[1]]), [x[0], 0, 0, x[1]])


def matrix(q):
    """Matrix of a unit quaternion."""
    x, y, z, w = q
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def quaternion_of(m):
    """Quaternion of a matrix: the eigenvector of the largest eigenvalue (Bar-Itzhack 2000)."""
    k = np.array([[m[0, 0] - m[1, 1] - m[2, 2], 0, 0, 0],
                  [m[0, 1] + m[1, 0], m[1, 1] - m[0, 0] - m[2, 2], 0, 0],
                  [m[0, 2] + m[2, 0], m[1, 2] + m[2, 1], m[2, 2] - m[0, 0] - m[1, 1], 0],
                  [m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1], np.trace(m)]]) / 3.0
    values, vectors = np.linalg.eigh(k)
    return vectors[:, np.argmax(values)]


def scene_matrix(yaw_deg, pitch_deg=0.0, roll_deg=0.0):
    """Matrix of a scene file's angles: about y, then about the own x, then about the own z."""
    y, p, r = np.radians([yaw_deg, pitch_deg, roll_deg])
    about_y = np.array([[np.cos(y), 0, np.sin(y)], [0, 1, 0], [-np.sin(y), 0, np.cos(y)]])
    about_x = np.array([[1, 0, 0], [0, np.cos(p), -np.sin(p)], [0, np.sin(p), np.cos(p)]])
    about_z = np.array([[np.cos(r), -np.sin(r), 0], [np.sin(r), np.cos(r), 0], [0, 0, 1]])
    return about_y @ about_x @ about_z
