"""A detector read from an ONNX file by OpenCV, and a thread of its own that looks at pictures with it.

Beside NAME.onnx lies NAME.json: {"kind": "classifier", "yolo5", "yolo8", "ssd" or "rcnn", "classes": [...], "side": 64,
"channels": 1 or 3 (the default), "normalise": "crop" (the default) or "none", "mirror": false}; KEYS has all. With "mirror" a classifier also looks at the crop with left
and right exchanged and answers the mean, for twice the time. With "with": ["OTHER.onnx"] the classifiers of those files, beside it,
look too. With "looks": N it is meant for N pictures of the same thing: [N, row, column(, channel)]. The mean of all counts, to
the power "power", which makes it as sure as it is right. A classifier gives a share to each class of a whole crop. YOLO's raw output and
SSD's rows (image, class, confidence, box) give boxes; so do three outputs, "rcnn": boxes [n, 4] as left, top, right, bottom in
pixels of the input, labels [n] and scores [n], in the order that "outputs" names. With "outputs_are": "logits" (not "shares", the
default) softmax of a classifier's numbers, and the logistic function of other kinds' confidences, give the shares. Overlapping boxes are thinned; the classes
"nothing" and "background" are no finding. Pictures are [row, column(, channel)]
as the cameras and sonars give them, RGB.
"""
import json
import multiprocessing
import os
import queue
import re
import threading
import time

import numpy as np

import onnx_network
from scenario import Failed, Refused, check_keys

SHARES_OFF = 1e-3  # how far numbers that are shares may be from [0, 1], and their sum from 1
LOGITS_OF_SHARES = 'accepted: shares in [0, 1], as after softmax or sigmoid; "outputs_are": "logits" where the file ends before these'
KINDS = ("classifier", "yolo5", "yolo8", "ssd", "rcnn")
OUTPUTS = ("boxes", "labels", "scores")
NO_FINDING = ("nothing", "background")
# made_by, share_of_crops_to_choose_by and note are for readers.
KEYS = ("kind", "classes", "side", "channels", "normalise", "mirror", "with", "looks", "power", "outputs", "outputs_are", "made_by",
        "share_of_crops_to_choose_by", "note")
CHECK_S = 120.0  # in which a network must have looked once
FORKS = multiprocessing.get_context("fork")


def normalised(pixels):
    """Light and contrast of a crop taken out: mean 0 and deviation 1 of each channel, at least 2 levels of 255."""
    x = pixels.astype(np.float32)
    x = x[..., None] if x.ndim == 2 else x
    mean, spread = x.mean(axis=(0, 1)), x.std(axis=(0, 1))
    return (x - mean) / np.maximum(spread, 2.0)


def files_of(path, alone=True):
    """(path, its description, and those of others that look with it); refused where one is not there."""
    files = (path, os.path.splitext(path)[0] + ".json")
    for file in files:
        if not os.path.isfile(file):
            raise Refused(f"{file}: found no such file; accepted: a detector's .onnx with its .json beside it")
    for other in _others(path, _described(files[1])) if alone else ():
        files += files_of(other, alone=False)
    return files


def _described(about):
    try:
        with open(about, encoding="utf-8") as file:
            told = json.load(file)
        if not isinstance(told, dict):
            raise TypeError("no object")
        check_keys(about, told, KEYS)
        return told
    except (ValueError, TypeError, OSError) as error:
        raise Refused(f"{about}: found no description ({error!r}); accepted: kind, classes, side, normalise") from None


def _others(path, about):
    others = about.get("with", [])
    if not isinstance(others, list) or not all(isinstance(o, str) and os.path.basename(o) == o and o.endswith(".onnx") for o in others) \
            or os.path.basename(path) in others:
        raise Refused(f"{path}: found with {others!r}; accepted: a list of other .onnx files beside it")
    return [os.path.join(os.path.dirname(path), o) for o in others]


class Detector:
    """One thread at a time uses it."""

    def __init__(self, path, alone=True):
        """alone: others may look with it."""
        try:
            import cv2
        except ModuleNotFoundError:
            raise Failed("detector: no OpenCV here; tools/setup detector installs python3-opencv") from None
        self._cv2, about = cv2, files_of(path)[1]
        self.about = _described(about)
        missing = [k for k in ("kind", "classes", "side") if k not in self.about]
        if missing:
            raise Refused(f"{about}: found no {missing[0]}; accepted: kind, classes and side, and more as README.md says")
        self.kind, self.classes, self.side = (self.about[k] for k in ("kind", "classes", "side"))
        if not isinstance(self.classes, list) or not all(isinstance(c, str) and c for c in self.classes) or len(set(self.classes)) < len(self.classes):
            raise Refused(f"{about}: found classes {self.classes!r}; accepted: a list of words that differ")
        if self.kind not in KINDS or type(self.side) is not int or not 8 <= self.side <= 4096 or not self.classes:
            raise Refused(f"{about}: found kind {self.kind!r}, side {self.side!r}, {len(self.classes)} classes; accepted: "
                          f"{', '.join(KINDS)}; 8 to 4096; one or more")
        self.channels, outputs = self.about.get("channels", 3), self.about.get("outputs", list(OUTPUTS))
        if self.channels not in (1, 3) or isinstance(self.channels, bool):
            raise Refused(f"{about}: found channels {self.channels!r}; accepted: 1, 3")
        if not isinstance(outputs, list) or sorted(map(str, outputs)) != sorted(OUTPUTS) or ("outputs" in self.about and self.kind != "rcnn"):
            raise Refused(f"{about}: found outputs {outputs!r} of kind {self.kind}; accepted: of kind rcnn, {', '.join(OUTPUTS)} in the file's order")
        self.normalise, self.mirror = self.about.get("normalise", "crop"), self.about.get("mirror", False)
        self.looks = self.about.get("looks", 1)
        if self.normalise not in ("crop", "none") or not isinstance(self.mirror, bool) or type(self.looks) is not int or not 1 <= self.looks <= 64:
            raise Refused(f"{about}: found normalise {self.normalise!r}, mirror {self.mirror!r}, looks {self.looks!r}; "
                          "accepted: crop, none; true, false; a whole number in [1, 64]")
        self.logits = self.about.get("outputs_are", "shares") == "logits"
        if not self.logits and self.about.get("outputs_are", "shares") != "shares":
            raise Refused(f"{about}: found outputs_are {self.about['outputs_are']!r}; accepted: shares, logits")
        self.power, others = self.about.get("power", 1.0), _others(path, self.about)
        if isinstance(self.power, bool) or not isinstance(self.power, (int, float)) or not 0.1 <= self.power <= 10:
            raise Refused(f"{about}: found power {self.power!r}; accepted: a number in [0.1, 10]")
        if others and not alone:
            raise Refused(f"{about}: found with in a detector that looks with another; accepted: none")
        self.others = [Detector(o, alone=False) for o in others]
        for other in self.others:
            if {self.kind, other.kind} != {"classifier"} or other.classes != self.classes:
                raise Refused(f"{about}: found with a {other.kind} of {', '.join(other.classes)}; accepted: classifiers of the same classes")
        try:
            self._net = cv2.dnn.readNetFromONNX(path)
            self._net.setPreferableBackend(cv2.dnn.DNN_BACKEND_OPENCV)
        except cv2.error as error:
            raise Refused(f"{path}: found a network that OpenCV cannot read ({_line(error)}); accepted: ONNX of its layers") from None
        names = onnx_network.outputs_of(path)
        if self.kind == "rcnn":
            if len(names) != 3:
                raise Refused(f"{path}: found {len(names)} outputs ({', '.join(names)}); accepted: three of kind rcnn, {', '.join(OUTPUTS)}")
            self._named = dict(zip(outputs, names))
        else:
            self._named = {"all": names[0]} if len(names) > 1 else None  # as YOLOv5's, whose other outputs are of its heads

    def _blob(self, pixels):
        x = self._cv2.resize(pixels, (self.side, self.side), interpolation=self._cv2.INTER_AREA) \
            if pixels.shape[:2] != (self.side, self.side) else pixels
        x = np.atleast_3d(x).astype(np.float32) / 255.0 if self.normalise == "none" else normalised(x)
        return np.ascontiguousarray(x.transpose(2, 0, 1)[None])

    def forward(self, pixels):
        try:
            self._net.setInput(self._blob(pixels))
            if self._named is None:
                return np.asarray(self._net.forward())
            told = dict(zip(self._named, self._net.forward(list(self._named.values()))))
            return np.asarray(told["all"]) if "all" in told else told
        except self._cv2.error as error:
            raise Failed(f"detector: {_line(error)}") from None

    def shares(self, pixels):
        """The answer of a classifier, and of those that look with it: the share of each class, their sum is 1. pixels: one
        picture, or where looks is not 1 as many."""
        looks = pixels if self.looks > 1 else pixels[None]
        if len(looks) != self.looks or looks[0].ndim not in (2, 3):
            raise Failed(f"detector: found a picture of {pixels.shape}; accepted: {self.looks} of one thing")
        out = sum(one._own_shares(look) for one in (self, *self.others) for look in looks) ** self.power
        return out / out.sum()

    def _own_shares(self, pixels):
        if self.kind != "classifier":
            raise Failed(f"detector: found a {self.kind}; accepted: a classifier")
        sides = [pixels, np.ascontiguousarray(pixels[:, ::-1])] if self.mirror else [pixels]
        return sum(shares_of(self.forward(side), len(self.classes), self.logits) for side in sides) / len(sides)

    def look(self, pixels, least=0.25, overlap=0.45):
        """[(class, confidence, (left, top, width, height) in pixels of the picture)], surest first; never "nothing"."""
        high, wide = pixels.shape[:2]
        if self.kind == "classifier":
            shares = self.shares(pixels)
            best = int(shares.argmax())
            name = self.classes[best]
            return [] if name in NO_FINDING or shares[best] < least else [(name, float(shares[best]), (0, 0, wide, high))]
        rows = boxes_of(self.kind, self.forward(pixels), len(self.classes), self.side, self.logits)
        rows = [r for r in rows if r[1] >= least and self.classes[r[0]] not in NO_FINDING]
        chosen = self._cv2.dnn.NMSBoxes([list(r[2]) for r in rows], [r[1] for r in rows], least, overlap) if rows else []
        scale = (wide / self.side, high / self.side) * 2
        return [(self.classes[rows[i][0]], rows[i][1], tuple(float(v * s) for v, s in zip(rows[i][2], scale)))
                for i in np.array(chosen).ravel()]


def shares_of(out, classes, logits=False):
    """The share of each class, of a classifier's output: [classes], in [0, 1]."""
    out = np.asarray(out).ravel()
    if out.size != classes:
        raise Failed(f"detector: found a classifier of {out.size} numbers; accepted: a classifier of {classes}")
    if logits:
        _check_finite("numbers", out)
        raised = np.exp(out - out.max())
        return raised / raised.sum()
    out = _confidences("shares", out)
    if abs(out.sum() - 1) > SHARES_OFF:
        raise Failed(f"detector: found shares whose sum is {out.sum():.4g}; accepted: 1, as after softmax; \"outputs_are\": \"logits\" where "
                     "the file ends before that")
    return out


def _check_finite(what, values):
    if not np.isfinite(values).all():
        raise Failed(f"detector: found {what} of which {np.count_nonzero(~np.isfinite(values))} are no number or infinite; accepted: numbers")


def _confidences(what, values, logits=False):
    """These numbers in [0, 1]: of logits by the logistic function."""
    values = np.asarray(values)
    _check_finite(what, values)
    if logits:
        return 0.5 * (1 + np.tanh(0.5 * values))
    if values.size and not -SHARES_OFF <= values.min() <= values.max() <= 1 + SHARES_OFF:
        raise Failed(f"detector: found {what} from {values.min():.4g} to {values.max():.4g}; {LOGITS_OF_SHARES}")
    return values.clip(0, 1)


def boxes_of(kind, out, classes, side, logits=False):
    """[(class, confidence, (left, top, width, height) in pixels of the network's input)] of a raw output; of kind rcnn of
    {"boxes", "labels", "scores"}."""
    if kind == "rcnn":
        boxes, labels, scores = (np.asarray(out[k], float) for k in OUTPUTS)
        n = labels.size
        if boxes.size != 4 * n or scores.size != n or not np.array_equal(labels, np.round(labels)):
            raise Failed(f"detector: found boxes {boxes.shape}, labels {labels.shape}, scores {scores.shape}; accepted: n x 4, n whole "
                         "numbers, n in [0, 1], in the order that outputs names")
        _check_finite("boxes", boxes)
        scores = _confidences("scores", scores, logits)
        return [(int(k), float(s), (b[0], b[1], b[2] - b[0], b[3] - b[1]))
                for b, k, s in zip(boxes.reshape(n, 4).tolist(), labels.ravel(), scores.ravel()) if 0 <= k < classes]
    if kind == "ssd":  # [1, 1, n, 7]: image, class, confidence, left, top, right, bottom as shares of the picture
        if out.size % 7:
            raise Failed(f"detector: found an output {out.shape}; accepted: rows of 7 numbers of ssd")
        rows = out.reshape(-1, 7).astype(float)
        rows = rows[~(rows[:, 0] < 0)]  # an image of -1 is the mark of an empty row
        _check_finite("rows", rows)
        if not np.array_equal(rows[:, 1], np.round(rows[:, 1])):
            raise Failed("detector: found a class that is no whole number; accepted: rows of image, class, confidence, left, top, right, bottom")
        sure = _confidences("confidences", rows[:, 2], logits)
        return [(int(r[1]), float(s), (r[3] * side, r[4] * side, (r[5] - r[3]) * side, (r[6] - r[4]) * side))
                for r, s in zip(rows, sure) if 0 <= r[1] < classes]
    rows = out.reshape(out.shape[-2:])
    if kind == "yolo8":  # [1, 4 + classes, n]: no objectness
        rows = rows.T
    head = 5 if kind == "yolo5" else 4
    if rows.shape[1] != head + classes:
        raise Failed(f"detector: found rows of {rows.shape[1]} numbers; accepted: {head + classes} for {classes} classes of {kind}")
    _check_finite("boxes", rows[:, :4])
    sure = _confidences("confidences", rows[:, 4:], logits)
    share = sure[:, 1:] * sure[:, :1] if kind == "yolo5" else sure
    best = share.argmax(axis=1)
    return [(int(b), float(s[b]), (float(r[0] - r[2] / 2), float(r[1] - r[3] / 2), float(r[2]), float(r[3])))
            for r, s, b in zip(rows, share, best)]


def check(path, channels):
    """(kind, classes, looks) of a detector that can look: it looks at a grey picture of so many channels, in a process of its own,
    since OpenCV's threads do not outlive a fork, and broken files may end it. Refused where it cannot."""
    key = (channels, *((f, os.stat(f).st_mtime_ns, os.stat(f).st_size) for f in files_of(path)))
    if key not in _CHECKED:
        ours, theirs = FORKS.Pipe(duplex=False)
        process = FORKS.Process(target=_look_once, args=(path, channels, theirs), daemon=True)
        process.start()
        theirs.close()
        try:
            told = ours.recv() if ours.poll(CHECK_S) else Refused(f"{path}: found a network that did not look within {CHECK_S:g} s; accepted: a faster one")
        except EOFError:
            told = Refused(f"{path}: found a network that ends OpenCV; accepted: ONNX of its layers")
        process.kill()
        process.join()
        ours.close()
        if isinstance(told, Exception):
            raise told
        _CHECKED[key] = told
    return _CHECKED[key]


_CHECKED = {}  # what was told of files as they were


def _look_once(path, channels, pipe):
    with open(os.devnull, "w") as nowhere:
        os.dup2(nowhere.fileno(), 2)  # OpenCV's own lines: what it found is told in one
    try:
        one = Detector(path)
        if one.channels != channels:
            raise Refused(f"{path}: found channels {one.channels}; accepted: {channels} here")
        picture = np.full((one.side, one.side, channels)[:2 if channels == 1 else 3], 127, np.uint8)
        try:
            one.look(np.stack([picture] * one.looks) if one.looks > 1 else picture)
        except Failed as error:
            raise Refused(f"{path}: {str(error).removeprefix('detector: ')}") from None
        pipe.send((one.kind, one.classes, one.looks))
    except (Refused, Failed) as error:
        pipe.send(error)
    except Exception as error:
        pipe.send(Refused(f"{path}: found a network that cannot look ({type(error).__name__}: {_line(error)}); accepted: ONNX as README.md says"))


def _line(error):
    """What an error says, without the place in OpenCV's own files."""
    missing = re.search(r'of type "(\w+)"', str(error))
    if missing:
        return f"it has no layer {missing[1]}"
    return re.sub(r"^OpenCV\S* \S+:\d+: error: ", "", str(error).strip().splitlines()[0])[:160]


class Looker:
    """Looks on a thread of its own; the newest picture waits, older ones that wait are dropped and counted.

    show() and answers() belong to the thread that made it. Each answer is a dict: sequence, found (as look() gives),
    latency_s from show() to the answer by the clock, of which work_s in the network."""

    def __init__(self, detector, least=0.25):
        self.detector, self.least, self.dropped = detector, least, 0
        self._next, self._out = queue.Queue(1), queue.Queue()
        self._thread = threading.Thread(target=self._run, name="looker", daemon=True)
        self._thread.start()

    def show(self, pixels, sequence):
        one = (pixels, sequence, time.monotonic())
        while True:
            try:
                self._next.put_nowait(one)
                return
            except queue.Full:
                try:
                    self._next.get_nowait()
                    self.dropped += 1
                except queue.Empty:
                    pass

    def answers(self, wait_s=0.0):
        """Every answer since the last call; waits up to wait_s for the first."""
        out = []
        try:
            out.append(self._out.get(timeout=wait_s) if wait_s > 0 else self._out.get_nowait())
            while True:
                out.append(self._out.get_nowait())
        except queue.Empty:
            pass
        for one in out:
            if isinstance(one, Exception):
                raise one
        return out

    def answer(self, wait_s):
        """The newest answer; waits for it."""
        told = self.answers(wait_s)
        if not told:
            raise Failed(f"detector: no answer within {wait_s:g} s")
        return told[-1]

    def close(self):
        self._next.put(None)
        self._thread.join()

    def _run(self):
        while (one := self._next.get()) is not None:
            pixels, sequence, shown = one
            begun = time.monotonic()
            try:
                found = self.detector.look(pixels, self.least)
            except Exception as error:  # told by answers(), on the caller's thread
                self._out.put(error)
                continue
            done = time.monotonic()
            self._out.put({"sequence": sequence, "found": found, "latency_s": done - shown, "work_s": done - begun})
