# Checks a data set of `neritic render` by numpy alone: boxes and masks of coco.json against the label
# arrays, poses and velocities of the trajectories against meta.json and against differences.
# Arguments: the folder, then "coco" or "trajectory" or both.
import json
import os
import sys

import numpy as np

out, checks = sys.argv[1], sys.argv[2:]


def mask_of(segmentation):
    height, width = segmentation["size"]
    counts = segmentation["counts"]
    assert sum(counts) == height * width
    values = np.arange(len(counts)) % 2
    return np.repeat(values, counts).reshape((height, width), order="F").astype(bool)


def check_coco():
    coco = json.load(open(os.path.join(out, "coco.json")))
    names = {c["id"]: c["name"] for c in coco["categories"]}
    assert names[12] == "target" and names[1] == "seabed"
    assert [a["id"] for a in coco["annotations"]] == list(range(1, len(coco["annotations"]) + 1))
    assert len(coco["images"]) == 6  # two eyes, three frames
    for image in coco["images"]:
        folder = os.path.dirname(os.path.join(out, image["file_name"]))
        assert os.path.exists(os.path.join(out, image["file_name"]))
        meta = json.load(open(os.path.join(folder, "meta.json")))
        assert (image["width"], image["height"]) == (meta["width"], meta["height"])
        assert image["time_s"] == meta["time_s"]
        labels = np.load(os.path.join(folder, "labels.npy"))
        instances = np.load(os.path.join(folder, "instances.npy"))
        there = {(l, i) for l, i in zip(labels.ravel(), instances.ravel()) if l}
        mine = [a for a in coco["annotations"] if a["image_id"] == image["id"]]
        assert {(a["category_id"], a["instance"]) for a in mine} == there and len(mine) == len(there)
        assert len(there) >= 3
        for a in mine:
            mask = (labels == a["category_id"]) & (instances == a["instance"])
            assert (mask_of(a["segmentation"]) == mask).all()
            rows, columns = np.nonzero(mask)
            x, y = columns.min(), rows.min()
            assert a["bbox"] == [x, y, columns.max() - x + 1, rows.max() - y + 1]
            assert a["area"] == mask.sum()
            assert a["iscrowd"] == (1 if a["category_id"] == 1 else 0)


def turn(q):  # of a quaternion x y z w
    x, y, z, w = q
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def check_trajectory():
    rows = np.genfromtxt(os.path.join(out, "trajectory.csv"), delimiter=",", names=True, dtype=None,
                         encoding="ascii")
    assert set(rows["name"]) == {"sub", "sub_lens", "eyes", "ears"}
    kinds = dict(zip(rows["name"], rows["kind"]))
    assert set(rows["known"]) == {"exact"}  # by tracks
    assert kinds == {"sub": "object", "sub_lens": "camera", "eyes": "camera", "ears": "sonar"}
    for name in kinds:
        mine = rows[rows["name"] == name]
        tum = np.loadtxt(os.path.join(out, "trajectory", name + ".txt"))
        assert tum.shape == (3, 8)
        own = np.array([[r[c] for c in ("time_s", "x_m", "y_m", "z_m", "qx", "qy", "qz", "qw")]
                        for r in mine])
        assert np.abs(tum - own).max() < 1e-8
        # The middle frame's velocities against differences over its neighbours.
        dt = tum[2, 0] - tum[0, 0]
        v = np.array([mine[1][c] for c in ("vx_m_s", "vy_m_s", "vz_m_s")])
        assert np.abs((tum[2, 1:4] - tum[0, 1:4]) / dt - v).max() < 2e-3, (name, v)
        w = np.array([mine[1][c] for c in ("wx_rad_s", "wy_rad_s", "wz_rad_s")])
        between = turn(tum[2, 4:]) @ turn(tum[0, 4:]).T  # in world axes
        skew = (between - between.T) / 2
        measured = np.array([skew[2, 1], skew[0, 2], skew[1, 0]]) / dt
        assert np.abs(measured - w).max() < 2e-3, (name, measured, w)
    assert np.abs([rows[rows["name"] == "sub"]["vx_m_s"]]).max() > 0.5
    assert np.abs([rows[rows["name"] == "sub_lens"]["wy_rad_s"]]).max() > 0.1
    lens = np.loadtxt(os.path.join(out, "trajectory", "sub_lens.txt"))
    for frame in range(3):
        meta = json.load(open(os.path.join(out, "frame_%04d" % frame, "sub_lens", "meta.json")))
        pose = meta["pose"]["position_m"] + meta["pose"]["rotation_xyzw"]
        assert np.abs(np.array(pose) - lens[frame, 1:]).max() < 1e-6
        assert abs(lens[frame, 0] - meta["time_s"]) < 1e-9


for check in checks:
    {"coco": check_coco, "trajectory": check_trajectory}[check]()
