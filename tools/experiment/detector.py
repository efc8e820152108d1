"""A shipped detector, or one of the user's own, looks at crops of scenes, waters and seeds that training never saw.

Each run is one scene of the split "test"; its crops go to a thread of its own (looking.py), one by one.
"""
import base64
import os

import numpy as np

import crops
import looking
import sonar_crops
from scenario import SHIPPED, Refused, Setting

MAKERS = {"camera": crops, "sonar": sonar_crops}
SETTINGS = {
    "eye": Setting("camera", "pictures of a camera or of an imaging sonar", words=list(MAKERS)),
    "model": Setting("shipped", "shipped, small (of a camera alone: a quarter of the work), or an .onnx file with its .json beside it"),
    "crops": Setting(12, "of each class and scene", 1, 1000, whole=True),
    "looks": Setting("learnt", "of a camera alone: learnt, the diver and the fish that training shows, or places, any of the shipped "
                               "divers and swimming fish, in a picture with dark corners", words=crops.LOOKS_OF),
}
MEASURES = {
    "accuracy": ("", "share of the scene's crops that are named rightly"),
    "crops": ("", "how many the scene gave: what cannot be seen is left out"),
    "overconfidence": ("", "mean confidence less the accuracy: 0 is calibrated"),
    "latency_ms": ("ms", "median from the crop to the word, on a thread of its own; by the clock, so it differs from run to run"),
}
MOST_WRONG, MOST_SCENES = 3, 10  # crops of a scene, and scenes, that a picture shows
SIZES = (0.03, 0.05, 0.08, 0.15, 0.3, 0.9)  # shares of a crop
DETECTORS = os.path.join(SHIPPED, "..", "detectors")


def model_of(name, eye="camera"):
    """The file of "shipped", of "small", or the user's own."""
    shipped = {"shipped": eye + ".onnx", "small": eye + "_2.onnx"}
    return os.path.join(DETECTORS, shipped[name]) if name in shipped else name


def files(settings):
    """The files that decide a run's numbers, beside the settings."""
    return looking.files_of(model_of(settings["model"], settings["eye"]))


def check(settings):
    """Refuses a model that is not there, cannot look or names other things, and a sonar with the looks of a camera, before anything runs."""
    if settings["eye"] != "camera" and settings["looks"] != "learnt":
        raise Refused(f"looks: found {settings['looks']} with eye {settings['eye']}; accepted: learnt")
    maker, path = MAKERS[settings["eye"]], model_of(settings["model"], settings["eye"])
    kind, classes, looks = looking.check(path, 3 if settings["eye"] == "camera" else 1)
    most = getattr(maker, "LOOKS", 1)
    if kind != "classifier" or classes != maker.CLASSES or looks not in (1, most):
        raise Refused(f"{path}: found a {kind} of {', '.join(classes)}, {looks} looks; accepted: a classifier of {', '.join(maker.CLASSES)}, "
                      f"{' or '.join(map(str, sorted({1, most})))} looks")


def run(settings, seed, tools):
    maker = MAKERS[settings["eye"]]
    detector = looking.Detector(model_of(settings["model"], settings["eye"]))
    looks = getattr(maker, "LOOKS", 1)
    scene = maker.Maker(tools, "test", seed, **({"looks": settings["looks"]} if maker is crops else {}))
    pixels, classes = scene.some(settings["crops"])
    scene.close()
    first = pixels[:, 0] if looks > 1 else pixels
    pixels = first if detector.looks == 1 else pixels
    looker = looking.Looker(_Shares(detector))
    told, latency = [], []
    for i, one in enumerate(pixels):
        looker.show(one, i)
        answer = looker.answer(wait_s=30.0)
        told.append(answer["found"])
        latency.append(answer["latency_s"])
    looker.close()
    shares = np.array(told)
    best, sure = shares.argmax(axis=1), shares.max(axis=1)
    right = best == classes
    series = {"truth": classes.tolist(), "told": best.tolist(), "sure": sure.astype(float).round(4).tolist(),
              "where": f"{scene.place}, {scene.water}", "size": np.round(getattr(scene, "sizes", []), 4).tolist(),
              "pictures": [[int(classes[i]), int(best[i]), _png(first[i])] for i in _shown(classes, right)]}
    return {"accuracy": float(right.mean()), "crops": len(classes), "overconfidence": float(sure.mean() - right.mean()),
            "latency_ms": 1e3 * float(np.median(latency))}, series


def _shown(classes, right):
    """Of each class the first crop that it named rightly, and the first ones that it got wrong."""
    of_classes = [np.flatnonzero((classes == k) & right)[:1] for k in np.unique(classes)]
    return [int(i) for i in np.concatenate([*of_classes, np.flatnonzero(~right)[:MOST_WRONG]])]


class _Shares:
    """A detector whose look() gives the share of each class: calibration needs them all."""

    def __init__(self, detector):
        self.look = lambda pixels, least: detector.shares(pixels)


def _png(pixels):
    import cv2
    return base64.b64encode(cv2.imencode(".png", pixels[..., ::-1] if pixels.ndim == 3 else pixels)[1].tobytes()).decode()


def _pixels(text):
    import cv2
    out = cv2.imdecode(np.frombuffer(base64.b64decode(text), np.uint8), cv2.IMREAD_UNCHANGED)
    return out[..., ::-1] if out.ndim == 3 else out


def figures(scenario, results, style):
    done = [r for r in results if r["series"]]
    if not done:
        return
    names = MAKERS[done[0]["settings"]["eye"]].CLASSES
    truth, told, sure = (np.concatenate([r["series"][k] for r in done]) for k in ("truth", "told", "sure"))
    fig = style.figure(900, 380)
    _confusion(style.area(fig, 110, 60, 430, 320), names, truth.astype(int), told.astype(int), style)
    _calibration(style.area(fig, 520, 60, 870, 320), truth == told, sure, style)
    yield "detector.png", ("Left: how often each class is named as which. Right: how often it is right when so sure, with 95 % "
                           "intervals; numbers of crops above"), fig
    where = np.concatenate([[r["series"]["where"]] * len(r["series"]["truth"]) for r in done])
    size = np.concatenate([r["series"].get("size", []) for r in done])
    yield "where.png", "What it gets wrong, by place and water, and by the size of the thing: 95 % intervals, and crops wrong of all", \
        _where(truth == told, where, size if len(size) == len(truth) else None, truth > 0, style)
    yield "crops.png", (f"Crops of each scene of {'these' if len(done) <= MOST_SCENES else f'the first {MOST_SCENES} of {len(done)}'}: "
                        f"one of each class that it named rightly, and up to {MOST_WRONG} that it got wrong (red)"), _gallery(done, names, style)


def _where(right, where, size, thing, style):
    """A row a place and water, and a row a size of the things."""
    parts = [("Wrong by place and water", [(w, where == w) for w in sorted(set(where))])]
    if size is not None:
        parts.append(("Wrong by size: share of the crop", [(f"{100 * a:g} to {100 * b:g} %", thing & (size >= a) & (size < b))
                                                          for a, b in zip(SIZES, SIZES[1:])]))
    parts = [(words, [(name, of) for name, of in rows if of.any()]) for words, rows in parts]
    import intervals
    tall = 26 * max(len(rows) for _, rows in parts)
    fig = style.figure(900, 110 + tall)
    for i, (words, rows) in enumerate(parts):
        ax = style.area(fig, 130 + 440 * i, 50, 400 + 440 * i, 50 + tall)
        most = 0.0
        for k, (_, of) in enumerate(rows):
            wrong, n = int((~right[of]).sum()), int(of.sum())
            share, low, high = (100 * v for v in intervals.share_interval(wrong, n))
            ax.plot([low, high], [k, k], color=style.BLUE, lw=1.4)
            ax.plot(share, k, "o", color=style.BLUE, ms=6, mec=style.INK, mew=0.6)
            ax.annotate(f"{wrong} of {n}", (high, k), xytext=(6, 0), textcoords="offset points", va="center", size=7.5)
            most = max(most, high)
        ax.set_xlim(0, 1.3 * most)
        ax.set_ylim(len(rows) - 0.5, -0.5)
        ax.set_yticks(range(len(rows)), [name for name, _ in rows])
        ax.set_xlabel("% of the crops")
        style.title(ax, words)
    return fig


def _confusion(ax, names, truth, told, style):
    n = len(names)
    table = np.zeros((n, n), int)
    np.add.at(table, (truth, told), 1)
    share = table / np.maximum(table.sum(axis=1, keepdims=True), 1)
    ax.imshow(share, cmap="Greys", vmin=0, vmax=1.4, aspect="auto")
    for i in range(n):
        for k in range(n):
            ax.text(k, i, str(table[i, k]), ha="center", va="center", size=10, color="white" if share[i, k] > 0.75 else style.INK)
    ax.set_xticks(range(n), names)
    ax.set_yticks(range(n), names)
    ax.grid(False)
    ax.set_xlabel("named")
    style.title(ax, f"True class by row: {np.trace(table)} of {table.sum()} right, {100 * np.trace(table) / table.sum():.1f} %")


def _calibration(ax, right, sure, style):
    edges = np.array([0.2, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.97, 1.0001])
    which, error = np.digitize(sure, edges) - 1, 0.0
    import intervals
    for k in range(len(edges) - 1):
        of = which == k
        if not of.any():
            continue
        error += of.mean() * abs(right[of].mean() - sure[of].mean())
        share, low, high = intervals.share_interval(int(right[of].sum()), int(of.sum()))
        ax.plot([sure[of].mean()] * 2, [low, high], color=style.BLUE, lw=1.2)
        ax.plot(sure[of].mean(), share, "o", color=style.BLUE, ms=6, mec=style.INK, mew=0.6)
        last = k == len(edges) - 2  # below its mark: the one before it is near
        ax.annotate(str(int(of.sum())), (sure[of].mean(), min(low, share - 0.02) if last else max(high, share + 0.02)), xytext=(0, -12 if last else 3),
                    textcoords="offset points", ha="center", size=7.5)
    ax.plot([0, 1], [0, 1], color=style.INK, lw=0.9, ls="--")
    ax.set_xlim(0.2, 1.02)
    ax.set_ylim(0, 1.09)
    ax.set_xlabel("how sure it says it is (dashed: as it should be)")
    ax.set_ylabel("share that is right")
    style.title(ax, f"Calibration: {100 * error:.1f} % off on average")


def _gallery(done, names, style):
    """A row a scene: its seed, place and water, and its crops."""
    shown = done[:MOST_SCENES]
    fig = style.figure(120 + 100 * (len(names) + MOST_WRONG), 20 + 122 * len(shown))
    width, height = fig.get_size_inches() * style.DPI
    for i, r in enumerate(shown):
        place, water = r["series"]["where"].split(", ")
        fig.text(14 / width, 1 - (80 + 122 * i) / height, f"seed {r['seed']}\n{place}\n{water}", size=8, va="center")
        for k, (truth, told, text) in enumerate(r["series"]["pictures"]):
            ax = style.area(fig, 100 + 100 * k, 30 + 122 * i, 195 + 100 * k, 125 + 122 * i)
            ax.imshow(_pixels(text), cmap="gray", interpolation="nearest")
            ax.set_axis_off()
            ax.set_title(names[truth] if truth == told else f"{names[truth]}: \"{names[told]}\"", size=7.5, loc="left", pad=3,
                         color=style.INK if truth == told else style.RED)
    return fig
