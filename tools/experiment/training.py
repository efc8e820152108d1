"""Makes a detector's weights again: `neritic experiment train_camera --out DIR` (or train_sonar). Debian's PyTorch, on the
processor; everything random follows from --seed, and the number of threads is fixed, so the same machine gives the same bits.

Crops come from --runs scenes of the split "train" and are varied anew in each pass (variations.py). A tenth as many scenes of
the split "choose", in places that training has not, choose the temperature that makes the shares true
(Guo et al. 2017). Scenes of the split "test" are never opened here. DIR gets NAME.onnx, NAME.json.

--set steps=N, --set draw=N (the seed of weights and variations, where it is not --seed), --set looks=WORD (of a camera alone:
scenes of these looks only, where both are learned from otherwise), --set from=FILE.onnx, weights of such a file to go on from,
more slowly, and --set with=FILE.onnx, a network that looks too: DIR gets it as NAME_with, and the mean of both becomes as sure
as it is right.
"""
import concurrent.futures
import concurrent.futures.process
import copy
import importlib
import json
import os
import shutil
import signal
import tempfile

import numpy as np

import looking
import onnx_network
import variations
from crops import some_of
from runner import Tools
from scenario import Failed, Refused

EACH, EACH_CHOOSE = 12, 10  # crops of a class and a scene, where the maker's LESSONS name no other
BATCH, THREADS = 64, 1
MOST_RATE, MORE_RATE = 3e-3, 1e-3  # from the beginning, and from weights of a file
COOL = 800  # steps in which it ends, where the maker names no other
KEPT = 0.99  # of the averaged weights at each step
LEAST_SCENES = 10


def _scene(name, program, split, seed, each, opened):
    """A worker process; name: of the maker's module, opened: further words to its Maker."""
    maker = importlib.import_module(name)
    with tempfile.TemporaryDirectory(prefix="neritic_crops_") as folder:
        tools = Tools(program, folder)
        try:
            made = maker.Maker(tools, split, seed, **opened)
            lesson = getattr(made, "lesson", made.one) if split == "train" else made.one
            found = some_of(lesson, maker.CLASSES, each, patience=getattr(maker, "PATIENCE", None) if split == "train" else None)
            made.close()
        except Exception as error:  # of a class that the parent process may not know
            raise Failed(f"scene {seed} of {split}: {error}") from None
    return found


def lessons_of(maker, split, scenes, looks=None):
    """(crops of a class, words to the Maker) of each scene: as many scenes of each of the maker's LESSONS, or of its CHOOSE; looks:
    of those of these looks alone."""
    kinds = getattr(maker, "LESSONS", [(EACH, {})]) if split == "train" else getattr(maker, "CHOOSE", [(EACH_CHOOSE, {})])
    kinds = [(each, words) for each, words in kinds if looks in (None, words.get("looks"))]
    return [kinds[i * len(kinds) // scenes] for i in range(scenes)]


def gather(maker, program, split, scenes, seed, workers, told, looks=None):
    """(pictures, classes) of all scenes, in order. They are not kept: minutes make them again."""
    with concurrent.futures.ProcessPoolExecutor(max(1, workers), initializer=signal.signal, initargs=(signal.SIGINT, signal.SIG_IGN)) as pool:
        lessons = lessons_of(maker, split, scenes, looks)
        waiting = [pool.submit(_scene, maker.__name__, program, split, seed + i, *of) for i, of in enumerate(lessons)]
        out = []
        try:
            for i, one in enumerate(waiting):
                out.append(one.result())
                if told and (i + 1) % 10 == 0:
                    print(f"{split}: {i + 1} of {scenes} scenes", flush=True)
        except concurrent.futures.process.BrokenProcessPool:
            raise Failed(f"{split}: a scene's process was killed, as where memory ends; --workers 1 needs less memory") from None
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise
    return tuple(np.concatenate([made[i] for made in out]) for i in (0, 1))


def network(torch, channels, classes, fine=False):
    """A residual network of 320 000 weights (1.3 MB): 64 x 64 to 4 x 4 maps, then the mean and the largest of each map. fine: with a
    residual block of the 16 x 16 maps too, 340 000 weights."""
    nn = torch.nn

    def block(a, b, stride, side=3):
        return nn.Sequential(nn.Conv2d(a, b, side, stride, side // 2, bias=False), nn.BatchNorm2d(b), nn.ReLU())

    class Residual(nn.Module):
        def __init__(self, n):
            super().__init__()
            self.one, self.two = block(n, n, 1), nn.Sequential(nn.Conv2d(n, n, 3, 1, 1, bias=False), nn.BatchNorm2d(n))

        def forward(self, x):
            return torch.relu(x + self.two(self.one(x)))

    class Net(nn.Module):
        def __init__(self):
            super().__init__()
            self.maps = nn.Sequential(block(channels, 16, 2, 5), block(16, 32, 2), *([Residual(32)] if fine else []),
                                      block(32, 64, 2), Residual(64), block(64, 96, 2), Residual(96))
            self.mean, self.most, self.drop = nn.AvgPool2d(4), nn.MaxPool2d(4), nn.Dropout(0.2)
            self.last = nn.Linear(192, classes)

        def forward(self, x):
            x = self.maps(x)
            return self.last(self.drop(torch.cat([self.mean(x), self.most(x)], 1).flatten(1)))

    return Net()


def _blobs(pictures):
    return np.stack([looking.normalised(p).transpose(2, 0, 1) for p in pictures])


def settings_of(sets, steps, seed, looks=()):
    """(steps, draw, from or None, with or None, looks or None) of --set. looks: the words for these that there are."""
    numbers, files = {"steps": steps, "draw": seed}, {"from": None, "with": None, "looks": None}
    for text in sets:
        key, _, value = text.partition("=")
        if key in files and (value in looks if key == "looks" else value):
            files[key] = value
        elif key in numbers and value.isascii() and value.isdigit() and (key == "draw" or 1 <= int(value)) and int(value) <= 10 ** 7:
            numbers[key] = int(value)
        else:
            raise Refused(f"--set: found \"{text}\"; accepted: steps=N, draw=N (whole numbers to 10000000), from=FILE.onnx, with=FILE.onnx"
                          + "".join(f", looks={word}" for word in looks))
    return numbers["steps"], numbers["draw"], files["from"], files["with"], files["looks"]


def _read(torch, path, classes):
    """(the network of a file, its description)"""
    about = looking.files_of(path, alone=False)[1]
    with open(about, encoding="utf-8") as file:
        told = json.load(file)
    if told.get("classes") != classes or told.get("normalise", "crop") != "crop":
        raise Refused(f"{about}: found classes {told.get('classes')}, normalise {told.get('normalise')}; accepted: {', '.join(classes)}; crop")
    return onnx_network.module_of(torch, path), told


def train(name, maker, classes, channels, program, scenes, seed, workers, out, quiet, sets=()):
    try:
        import torch
    except ModuleNotFoundError:
        raise Failed("train: no PyTorch here; tools/setup detector installs python3-torch") from None
    scenes = maker.SCENES if scenes is None else scenes
    if scenes < LEAST_SCENES:
        raise Refused(f"--runs: found {scenes}; accepted: {LEAST_SCENES} scenes or more, to learn from")
    steps, draw, start, beside, only = settings_of(sets, maker.STEPS, seed, getattr(maker, "LOOKS_OF", ()))
    begun, before = _read(torch, start, classes) if start else (None, {})
    other, others = _read(torch, beside, classes) if beside else (None, {})
    if other and (others.get("with") or not others.get("mirror")):
        raise Refused(f"--set with={beside}: found with {others.get('with', [])}, mirror {others.get('mirror', False)}; accepted: a "
                      "network that looks alone, both ways round")
    x, y = gather(maker, program, "train", scenes, 1000 * seed, workers, not quiet, only)
    xv, yv = gather(maker, program, "choose", max(3, scenes // 10), 1000 * seed, workers, not quiet, only)
    looks = getattr(maker, "LOOKS", 1)
    if not quiet:
        print(f"{len(y)} crops to learn from, {len(yv)} to choose by: {np.bincount(y, minlength=len(classes)).tolist()}", flush=True)
    net, best, power = fit(torch, _apart(x, y, looks), _apart(xv, yv, looks), channels, classes, steps, draw, quiet, begun, looks, other,
                           getattr(maker, "FINE", False), getattr(maker, "COOL", COOL))
    bare = [s.split("=", 1)[0] + "=" + os.path.basename(s.split("=", 1)[1]) for s in sets]  # files without their folders
    made_by = " ".join([f"neritic experiment train_{name} --runs {scenes} --seed {seed}", *(f"--set {s}" for s in bare)])
    about = {"kind": "classifier", "classes": classes, "side": 64, "channels": channels, "normalise": "crop", "mirror": True,
             **({"looks": looks} if looks > 1 else {}), **({"power": round(power, 3)} if looks > 1 or other else {}),
             "made_by": made_by + (f", from the weights of {before.get('made_by', 'another program')}" if begun else ""),
             "share_of_crops_to_choose_by": round(best, 4), **({"with": [name + "_with.onnx"]} if other else {})}
    if other:
        _beside(beside, os.path.join(out, name + "_with.onnx"))
    _export(torch, torch.nn.Sequential(net, torch.nn.Softmax(1)).eval(), name, about, out)
    return best


def _apart(pictures, classes, looks):
    """Each look at a thing as a picture of its own, those of one thing after each other."""
    return (pictures.reshape(-1, *pictures.shape[2:]), np.repeat(classes, looks)) if looks > 1 else (pictures, classes)


def fit(torch, lessons, chosen_by, channels, classes, steps, seed, quiet, start=None, looks=1, other=None, fine=False, cool=COOL):
    """start: a network to go on from. other: one that looks too. cool: steps in which it ends. Returns (network of calibrated logits, share of the crops to
    choose by that they name rightly by so many looks, the power that makes their mean as sure as it is right)."""
    torch.manual_seed(seed)
    torch.set_num_threads(THREADS)
    torch.use_deterministic_algorithms(True)
    most = MORE_RATE if start else MOST_RATE
    net = (start or network(torch, channels, len(classes), fine)).to(memory_format=torch.channels_last)
    seen = torch.tensor(_blobs(chosen_by[0])).to(memory_format=torch.channels_last), torch.tensor(chosen_by[1])
    _learn(torch, net, variations.of(torch, *lessons, seed), seen, steps, most, quiet, cool)
    logits = _logits(torch, net, seen[0])
    temperature = _temperature(torch, logits, seen[1])
    with torch.no_grad():  # into the last layer, so that the file's shares are calibrated
        net.last.weight /= temperature
        net.last.bias /= temperature
    shares, of = _shares(logits / temperature), seen[1][::looks]
    if other:
        shares = (shares + _shares(_logits(torch, other, seen[0]))) / 2
    shares = shares.reshape(-1, looks, len(classes)).mean(1)
    return net, float((shares.argmax(1) == of).float().mean()), 1 / _temperature(torch, shares.log()[None], of)


def rate(step, steps, most, cool):
    """How fast it learns: evenly, after a slow start, and slower and slower over the last steps."""
    return most * min(1.0, (step + 1) / 100, (steps - step) / min(cool, steps))


def _learn(torch, net, batches, seen, steps, most, quiet, cool):
    """Leaves the average of the last weights in net."""
    optimiser = torch.optim.AdamW(net.parameters(), lr=1e-3, weight_decay=2e-2)
    mean = copy.deepcopy(net)
    loss_of = torch.nn.CrossEntropyLoss(label_smoothing=0.05)
    with concurrent.futures.ThreadPoolExecutor(1) as ahead:  # the next batch while the network learns
        waiting = ahead.submit(batches, BATCH)
        for step in range(steps):
            net.train()
            x, y = waiting.result()
            waiting = ahead.submit(batches, BATCH)
            for group in optimiser.param_groups:
                group["lr"] = rate(step, steps, most, cool)
            optimiser.zero_grad()
            loss_of(net(x), y).backward()
            optimiser.step()
            _average(torch, mean, net, min(KEPT, (step + 1) / (step + 10)))
            if not quiet and (step + 1) % 500 == 0:
                share = _right(torch, mean, seen)
                print(f"step {step + 1} of {steps}: {100 * share:.1f} % of the crops to choose by", flush=True)
    net.load_state_dict(mean.state_dict())


def _right(torch, net, seen):
    return float((_shares(_logits(torch, net, seen[0])).argmax(1) == seen[1]).float().mean())


def _average(torch, mean, net, kept):
    with torch.no_grad():
        for of, now in zip(mean.state_dict().values(), net.state_dict().values()):
            if of.is_floating_point():
                of.mul_(kept).add_(now, alpha=1 - kept)
            else:
                of.copy_(now)


def _logits(torch, net, x):
    """[2, crops, classes]: of each crop and of its mirror image."""
    net.eval()
    with torch.no_grad():
        return torch.stack([torch.cat([net(part.flip(3) if flips else part) for part in x.split(256)]) for flips in (False, True)])


def _shares(logits):
    """As looking.py answers: the mean over a crop and its mirror image."""
    return logits.softmax(2).mean(0)


def _temperature(torch, logits, y):
    """By which the logits are divided for the least cross entropy: a search over 0.3 to 3."""
    tried = np.exp(np.linspace(np.log(0.3), np.log(3.0), 60))
    return float(min(tried, key=lambda t: float(torch.nn.functional.nll_loss(_shares(logits / t).log(), y))))


def _beside(path, at):
    """Copies a network's both files, where they are not there already."""
    for one, there in zip(looking.files_of(path, alone=False), (at, os.path.splitext(at)[0] + ".json")):
        if not (os.path.exists(there) and os.path.samefile(one, there)):
            shutil.copyfile(one, there + ".tmp")
            os.replace(there + ".tmp", there)


def _export(torch, model, name, about, out):
    """Both files, each whole or not at all."""
    path = os.path.join(out, name)
    torch.onnx.export(model.to(memory_format=torch.contiguous_format), torch.zeros(1, about["channels"], 64, 64), path + ".onnx.tmp",
                      opset_version=11, input_names=["crop"], output_names=["shares"])
    with open(path + ".json.tmp", "w", encoding="utf-8") as file:
        file.write(json.dumps(about, indent=2) + "\n")
    for end in (".onnx", ".json"):
        os.replace(path + end + ".tmp", path + end)
