"""A shipped detector, or one of the user's own, looks at crops of scenes, waters and seeds that training never saw.

Each run is one scene of the split "test"; its crops go to a thread of its own (looking.py), one by one.
"""
import base64
import os

import numpy as np

import crops
import looking
import sonar_crops
from scenario import SHIPPED, Failed, Setting

MAKERS = {"camera": crops, "sonar": sonar_crops}
SETTINGS = {
    "eye": Setting("camera", "pictures of a camera or of an imaging sonar", words=list(MAKERS)),
    "model": Setting("shipped", "shipped, small (of a camera alone: a quarter of the work), or an .onnx file with its .json beside it"),
    "crops": Setting(12, "of each class and scene", 1, 1000, whole=True),
}
MEASURES = {
    "accuracy": ("", "share of the scene's crops that are named rightly"),
    "crops": ("", "how many the scene gave: what cannot be seen is left out"),
    "overconfidence": ("", "mean confidence less the accuracy: 0 is calibrated"),
    "latency_ms": ("ms", "median from the crop to the word, on a thread of its own; by the clock, so it differs from run to run"),
}
DETECTORS = os.path.join(SHIPPED, "..", "detectors")


def model_of(name, eye="camera"):
    """The file of "shipped", of "small", or the user's own."""
    shipped = {"shipped": eye + ".onnx", "small": eye + "_2.onnx"}
    return os.path.join(DETECTORS, shipped[name]) if name in shipped else name


def files(settings):
    """The files that decide a run's numbers, beside the settings."""
    return looking.files_of(model_of(settings["model"], settings["eye"]))


def check(settings):
    """Refuses a model that is not there, before anything runs."""
    files(settings)


def run(settings, seed, tools):
    maker = MAKERS[settings["eye"]]
    detector = looking.Detector(model_of(settings["model"], settings["eye"]))
    if detector.classes != maker.CLASSES:
        raise Failed(f"{settings['model']}: found the classes {', '.join(detector.classes)}; accepted: {', '.join(maker.CLASSES)}")
    looks = getattr(maker, "LOOKS", 1)
    if detector.looks not in (1, looks):
        raise Failed(f"{settings['model']}: found {detector.looks} looks; accepted: 1 or {looks}")
    scene = maker.Maker(tools, "test", seed)
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
    shown = [int(np.flatnonzero(classes == k)[0]) for k in range(len(maker.CLASSES)) if (classes == k).any()]
    shown += [int(i) for i in np.flatnonzero(~right)[:3]]
    series = {"truth": classes.tolist(), "told": best.tolist(), "sure": sure.astype(float).round(4).tolist(),
              "where": f"{scene.place}, {scene.water}",
              "pictures": [[int(classes[i]), int(best[i]), _png(first[i])] for i in shown]}
    return {"accuracy": float(right.mean()), "crops": len(classes), "overconfidence": float(sure.mean() - right.mean()),
            "latency_ms": 1e3 * float(np.median(latency))}, series


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
    yield "detector.png", "How often each class is named as which, and how often the detector is right when so sure", fig
    yield "crops.png", "Crops of each scene, and the first that it got wrong", _gallery(done, names, style)


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
        ax.annotate(str(int(of.sum())), (sure[of].mean(), high), xytext=(0, 3), textcoords="offset points", ha="center", size=7.5)
    ax.plot([0, 1], [0, 1], color=style.INK, lw=0.9, ls="--")
    ax.set_xlim(0.2, 1.02)
    ax.set_ylim(0, 1.09)
    ax.set_xlabel("how sure it says it is")
    ax.set_ylabel("share that is right")
    style.title(ax, f"Calibration: {100 * error:.1f} % off on average")


def _gallery(done, names, style):
    shown = done[:6]
    across = max(len(r["series"]["pictures"]) for r in shown)
    fig = style.figure(40 + 107 * across, 20 + 132 * len(shown))
    for i, r in enumerate(shown):
        for k, (truth, told, text) in enumerate(r["series"]["pictures"]):
            ax = style.area(fig, 20 + 107 * k, 30 + 132 * i, 120 + 107 * k, 130 + 132 * i)
            ax.imshow(_pixels(text), cmap="gray", interpolation="nearest")
            ax.set_axis_off()
            ax.set_title(names[truth] if truth == told else f"{names[truth]}: \"{names[told]}\"", size=7.5, loc="left", pad=3,
                         color=style.INK if truth == told else style.RED)
    return fig
