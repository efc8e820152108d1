"""The imaging sonar of the published experiment looks at a sphere and at a diver (1 to 5 m, 90 x 28 degrees, 500 bins
an axis). The diver's mask is held against an independent ray caster, and the elevation ambiguity is shown: a diver
8 degrees up or down is at the same range and bearing."""
import math
import os

import numpy as np

import posed_model
import ray_caster
from rotations import quaternion_of, scene_matrix
from scenario import SHIPPED, Setting

MODELS = os.path.join(SHIPPED, "..", "models")
DIVER = 4  # the class of divers in labels
BINS, RANGE_M, AZIMUTH_DEG, ELEVATION_DEG = 500, (1.0, 5.0), 90.0, 28.0
# A bin is seen if it has a quarter of what one of the 500 rows gives at normal incidence.
LEAST = 0.25 / 500

SETTINGS = {
    "sampling": Setting("standard", "quality level of the sonars, or a gather at three pixels a cell",
                        words=["draft", "standard", "reference", "nearest", "published"]),
    "sphere_range_m": Setting(3.0, "the sphere's centre, straight ahead", 1.5, 4.5),
    "sphere_radius_m": Setting(0.25, "the sphere's radius", 0.02, 0.5),
    "diver_range_m": Setting(3.0, "the diver's pelvis", 2.2, 4.2),
    "diver_bearing_deg": Setting(0.0, "its bearing, positive to starboard", -25.0, 25.0),
    "diver_yaw_deg": Setting(90.0, "the way that the prone diver heads, from away (0) to port (90)", -180.0, 180.0),
    "clip_s": Setting(0.0, "when in its swimming the diver is seen", 0.0, 1000.0),
    "tilt_deg": Setting(8.0, "how far up and down for the ambiguity", 0.0, 8.0),
    "rays": Setting(4, "rays of the independent caster a cell, along each angle", 1, 8, whole=True),
}
MEASURES = {
    "sphere_bin": ("", "range bin of the sphere's first return"),
    "sphere_bin_error": ("bins", "off the bin of the geometry, at most a part of one"),
    "mask_iou": ("", "overlap over union of the diver's bins with the ray caster's"),
    "columns_within_2_bins": ("", "share of the columns that both see whose nearest range agrees within 2 bins"),
    "ambiguity_range_bins": ("bins", "largest change of the diver's nearest range when it is tilted up or down, but for what the edge of the aperture cuts off"),
    "ambiguity_bearing_bins": ("bins", "largest change of its bearing, the middle of its echo's energy, but for what the aperture cuts off"),
    "early_energy": ("", "share of the diver's energy that is heard more than 2 bins before its surface"),
    "overlap_up_down": ("", "overlap over union of the masks of the diver up and down: 1 cannot be told apart"),
}

SCENE = """
seed = {seed}
[[objects]]
name = "sphere"
shape = "sphere"
radius_m = {radius}
segments = 512
class = "target"
position_m = [0, -20, {sphere_z}]
{divers}
[[sonars]]
name = "sphere"
position_m = [0, -20, 0]
{sonar}
{sonars}
"""
SONAR = """kind = "imaging"
range_m = [1, 5]
azimuth_deg = 90
elevation_deg = 28
bins = [500, 500, 500]
"""
# Apart from each other, so that no sonar sees another's target.
PLACES = {"level": (100.0, 0.0), "up": (200.0, 1.0), "down": (300.0, -1.0)}


def _level(settings):
    """(pelvis in sonar axes, 3 x 3 of the prone diver, its triangles in sonar axes)."""
    bearing, r = math.radians(settings["diver_bearing_deg"]), settings["diver_range_m"]
    at = np.array([r * math.sin(bearing), 0.0, -r * math.cos(bearing)])
    prone = scene_matrix(settings["diver_yaw_deg"], -90.0)
    model = posed_model.Model(os.path.join(MODELS, "diver.glb"))
    return at, prone, model.triangles("swim", settings["clip_s"]) @ prone.T + at


def _tilt(triangles, tilt_rad):
    """3 x 3 that lifts the sight by an angle, about the level axis across the bearing of the diver's middle."""
    middle = triangles.reshape(-1, 3).mean(axis=0)
    across = scene_matrix(-math.degrees(math.atan2(middle[0], -middle[2])))
    c, s = math.cos(tilt_rad), math.sin(tilt_rad)
    return across @ np.array([[1, 0, 0], [0, c, -s], [0, s, c]]) @ across.T


def _nearest_m(triangles):
    """Range of the nearest corner that lies within the aperture's elevations."""
    corners = triangles.reshape(-1, 3)
    within = np.abs(np.arctan2(corners[:, 1], np.hypot(corners[:, 0], corners[:, 2]))) <= math.radians(ELEVATION_DEG / 2)
    return np.linalg.norm(corners[within], axis=1).min(initial=RANGE_M[1])


def cut_bins(triangles, tilt_rad):
    """How far the edge of the aperture moves the middle of a tilted diver's echo: what it cuts off of the tilted diver, less what it
    cuts off of the level one. From the rays of an aperture that holds both; a turn about the sonar hides nothing anew."""
    high_deg = ELEVATION_DEG + 2 * abs(math.degrees(tilt_rad)) + 2
    rows = math.ceil(BINS * high_deg / ELEVATION_DEG)
    ranges, cosines = ray_caster.nearest_hits(triangles, AZIMUTH_DEG, high_deg, BINS, rows)
    row, column = np.nonzero((ranges >= RANGE_M[0]) & (ranges < RANGE_M[1]))
    azimuth = np.radians(((column + 0.5) / BINS - 0.5) * AZIMUTH_DEG)
    elevation = np.radians(((row + 0.5) / rows - 0.5) * high_deg)
    rays = np.stack([np.cos(elevation) * np.sin(azimuth), np.sin(elevation), -np.cos(elevation) * np.cos(azimuth)], axis=1)

    def moved(turn):
        x, y, z = turn @ rays.T
        # A sonar's cells are even in elevation: a patch of the sphere has more of them towards the poles.
        weight = cosines[row, column] * np.cos(elevation) / np.sqrt(1 - y * y)
        at = (np.degrees(np.arctan2(x, -z)) / AZIMUTH_DEG + 0.5) * BINS
        within = np.abs(y) <= math.sin(math.radians(ELEVATION_DEG / 2))
        if not within.any():
            return 0.0
        return np.average(at[within], weights=weight[within]) - np.average(at, weights=weight)

    return moved(_tilt(triangles, tilt_rad)) - moved(np.eye(3)) if len(row) else 0.0


def _sonar(settings):
    by_gather = settings["sampling"] in ("nearest", "published")
    return SONAR + (f'gather = "{settings["sampling"]}"\ngbuffer_scale = 3\n' if by_gather
                    else f'quality = "{settings["sampling"]}"\n')


def _scene(settings, seed, level):
    divers, sonars = "", ""
    for name, (x, side) in PLACES.items():
        tilt = _tilt(level[2], side * math.radians(settings["tilt_deg"]))
        at, q = tilt @ level[0], quaternion_of(tilt @ level[1])
        divers += (f'[[objects]]\nname = "diver_{name}"\nmodel = "{os.path.join(MODELS, "diver.glb")}"\nclass = "diver"\n'
                   f'clip = "swim"\nclip_offset_s = {settings["clip_s"]!r}\n'
                   f"position_m = [{x + at[0]!r}, {-20 + at[1]!r}, {at[2]!r}]\n"
                   f"rotation_xyzw = [{', '.join(repr(float(v)) for v in q)}]\n")
        sonars += f'[[sonars]]\nname = "{name}"\nposition_m = [{x}, -20, 0]\n' + _sonar(settings)
    return SCENE.format(seed=seed, radius=settings["sphere_radius_m"], sphere_z=-settings["sphere_range_m"],
                        divers=divers, sonars=sonars, sonar=_sonar(settings))


def _near(mask):
    """Nearest bin of each column, -1 where it is empty."""
    return np.where(mask.any(axis=0), mask.argmax(axis=0), -1)


def _coarse(mask):
    """A mask of finer range bins on the published 500."""
    return mask.reshape(BINS, mask.shape[0] // BINS, mask.shape[1]).any(axis=1)


def _summed(image):
    """The energy of finer range bins in the published 500."""
    return image.reshape(BINS, image.shape[0] // BINS, image.shape[1]).mean(axis=1)


def _iou(a, b):
    union = np.count_nonzero(a | b)
    return np.count_nonzero(a & b) / union if union else 1.0


def run(settings, seed, tools):
    level = _level(settings)
    scene = tools.write("scene.toml", _scene(settings, seed, level))
    tools.neritic("render", scene, "--out", tools.folder, "--only", "sonar", "-q")
    folder = os.path.join(tools.folder, "frame_0000")

    def load(name, what):
        return np.load(os.path.join(folder, name, what + ".npy"))

    heard = _coarse(load("sphere", "sonar") > 0).any(axis=1)
    sphere_bin = int(heard.argmax())
    exact = (settings["sphere_range_m"] - settings["sphere_radius_m"] - RANGE_M[0]) / (RANGE_M[1] - RANGE_M[0]) * BINS
    masks = {}
    for name in PLACES:
        image, labels = load(name, "sonar"), load(name, "sonar_labels")
        masks[name] = _coarse(labels == DIVER) & (_summed(image) >= LEAST)

    fine = BINS * settings["rays"]
    hits = ray_caster.nearest_hits(level[2], AZIMUTH_DEG, ELEVATION_DEG, fine, fine)
    truth = ray_caster.sonar_image(*hits, RANGE_M, BINS, BINS) >= LEAST

    near, near_truth = _near(masks["level"]), _near(truth)
    both = (near >= 0) & (near_truth >= 0)
    echo = {name: np.where(masks[name], _summed(load(name, "sonar")), 0.0) for name in PLACES}
    bearing = {name: float((echo[name].sum(axis=0) * (np.arange(BINS) + 0.5)).sum() / max(echo[name].sum(), 1e-300))
               for name in PLACES}
    early = (np.arange(BINS)[:, None] < near_truth - 2) & (near_truth >= 0)
    moved_range, moved_bearing = [], []
    for name in ("up", "down"):
        other = _near(masks[name])
        tilt_rad = PLACES[name][1] * math.radians(settings["tilt_deg"])
        tilt = _tilt(level[2], tilt_rad)
        cut = (_nearest_m(level[2] @ tilt.T) - _nearest_m(level[2])) / (RANGE_M[1] - RANGE_M[0]) * BINS
        moved_range.append(abs(other[other >= 0].min(initial=BINS) - near[near >= 0].min(initial=BINS) - cut))
        moved_bearing.append(abs(bearing[name] - bearing["level"] - cut_bins(level[2], tilt_rad)))
    measures = {
        "sphere_bin": sphere_bin, "sphere_bin_error": sphere_bin - math.floor(exact),
        "mask_iou": _iou(masks["level"], truth),
        "columns_within_2_bins": float((np.abs(near - near_truth)[both] <= 2).mean()) if both.any() else 0.0,
        "ambiguity_range_bins": float(max(moved_range)), "ambiguity_bearing_bins": float(max(moved_bearing)),
        "early_energy": float(echo["level"][early].sum() / max(echo["level"].sum(), 1e-300)),
        "overlap_up_down": _iou(masks["up"], masks["down"]),
    }
    series = {"near": near.tolist(), "near_truth": near_truth.tolist(), "near_up": _near(masks["up"]).tolist(),
              "near_down": _near(masks["down"]).tolist()}
    return measures, series


def figures(scenario, results, style):
    done = [r for r in results if r["series"]]
    if not done:
        return
    fig = style.figure(900, 640)
    shown = done[0]
    at = (np.arange(BINS) + 0.5) / BINS * AZIMUTH_DEG - AZIMUTH_DEG / 2

    def metres(name):
        bins = np.array(shown["series"][name], float)
        return np.where(bins >= 0, RANGE_M[0] + (bins + 0.5) * (RANGE_M[1] - RANGE_M[0]) / BINS, np.nan)

    top = style.area(fig, 70, 60, 870, 300)
    seen = np.isfinite(metres("near_truth"))
    top.plot(at, metres("near_truth"), color=style.INK, lw=3.2, alpha=0.35, label="ray caster")
    top.plot(at, metres("near"), color=style.BLUE, lw=1.2, label="sonar")
    top.plot(at, metres("near_up"), color=style.ORANGE, lw=1.2, ls="--",
             label=f"diver {shown['settings']['tilt_deg']:g}° up")
    top.plot(at, metres("near_down"), color=style.GREEN, lw=1.2, ls=":",
             label=f"{shown['settings']['tilt_deg']:g}° down")
    top.set_xlim(at[seen].min() - 3, at[seen].max() + 3) if seen.any() else None
    top.set_xlabel("azimuth, degrees")
    top.set_ylabel("nearest range, m")
    style.title(top, f"The diver of seed {shown['seed']}: elevation cannot be told")
    style.legend(top)
    for i, (name, words, bound) in enumerate((("mask_iou", "mask: overlap over union", 0.9),
                                              ("columns_within_2_bins", "columns within 2 bins", 0.95))):
        ax = style.area(fig, 70 + 430 * i, 380, 430 + 440 * i, 590)
        x = [r["settings"]["diver_range_m"] for r in done]
        ax.plot(x, [r["measures"][name] for r in done], "o", color=style.BLUE, ms=5, mec=style.INK, mew=0.6)
        ax.axhline(bound, color=style.INK, lw=0.9, ls="--")
        ax.set_ylim(min(0.8, min(r["measures"][name] for r in done) - 0.02), 1.01)
        ax.set_xlabel("range of the diver, m")
        style.title(ax, f"{words} (dashed: {bound:g})")
    yield "imaging.png", "Nearest ranges of the diver by sonar and by ray caster, and their agreement over runs", fig
