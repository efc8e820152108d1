"""Makes a detector's weights again: `neritic experiment train_camera --out DIR` (or train_sonar). Debian's PyTorch, on the
processor; everything random follows from --seed, and the number of threads is fixed, so the same machine gives the same bits.

Crops come from --runs scenes of the split "train"; a tenth of them choose the best pass and the temperature that makes the
shares true (Guo et al. 2017). Scenes of the split "test" are never opened here. DIR gets NAME.onnx, NAME.json.
"""
import concurrent.futures
import json
import os
import tempfile

import numpy as np

import looking
from runner import Tools
from scenario import Failed, Refused

EACH = 20  # crops of a class and a scene
PASSES, BATCH, THREADS = 18, 64, 2


def _scene(maker, program, seed, each):
    with tempfile.TemporaryDirectory(prefix="neritic_crops_") as folder:
        made = maker(Tools(program, folder), "train", seed)
        try:
            return made.some(each)
        finally:
            made.close()


def gather(maker, program, scenes, seed, workers, told):
    """[(pixels, classes)] a scene, in order. A folder of results is not kept: it takes minutes to make again."""
    with concurrent.futures.ProcessPoolExecutor(max(1, workers)) as pool:
        waiting = [pool.submit(_scene, maker, program, seed + i, EACH) for i in range(scenes)]
        out = []
        for i, one in enumerate(waiting):
            out.append(one.result())
            if told and (i + 1) % 10 == 0:
                print(f"{i + 1} of {scenes} scenes", flush=True)
    return out


def network(torch, channels, classes):
    """Four convolutions, then the mean of each map: 47 000 weights."""
    nn, w = torch.nn, 16

    def block(a, b, stride):
        return [nn.Conv2d(a, b, 3, stride, 1, bias=False), nn.BatchNorm2d(b), nn.ReLU()]

    class Net(nn.Module):
        def __init__(self):
            super().__init__()
            self.maps = nn.Sequential(*block(channels, w, 2), nn.MaxPool2d(2), *block(w, 2 * w, 1),
                                      *block(2 * w, 3 * w, 2), *block(3 * w, 4 * w, 1))
            self.last = nn.Linear(4 * w, classes)
            self.mean = nn.AvgPool2d(8)

        def forward(self, x):
            return self.last(self.mean(self.maps(x)).flatten(1))

    return Net()


def _blobs(pixels):
    return np.stack([looking.normalised(p).transpose(2, 0, 1) for p in pixels])


def train(name, maker, classes, channels, program, scenes, seed, workers, out, quiet):
    try:
        import torch
    except ModuleNotFoundError:
        raise Failed("train: no PyTorch here; tools/setup detector installs python3-torch") from None
    torch.manual_seed(seed)
    torch.set_num_threads(THREADS)
    torch.use_deterministic_algorithms(True)
    scenes = 80 if scenes is None else scenes
    if scenes < 10:
        raise Refused(f"--runs: found {scenes}; accepted: 10 scenes or more, to learn from")
    made = gather(maker, program, scenes, 1000 * seed, workers, not quiet)
    kept = scenes // 10
    x, y = (np.concatenate([m[i] for m in made[kept:]]) for i in (0, 1))
    xv, yv = (np.concatenate([m[i] for m in made[:kept]]) for i in (0, 1))
    if not quiet:
        print(f"{len(y)} crops to learn from, {len(yv)} to choose by: {np.bincount(y, minlength=len(classes)).tolist()}", flush=True)
    x, y, xv, yv = torch.tensor(_blobs(x)), torch.tensor(y), torch.tensor(_blobs(xv)), torch.tensor(yv)
    x, xv = (t.to(memory_format=torch.channels_last) for t in (x, xv))  # four times as fast
    net = network(torch, channels, len(classes)).to(memory_format=torch.channels_last)
    steps = PASSES * (len(y) // BATCH)
    optimiser = torch.optim.AdamW(net.parameters(), lr=3e-3, weight_decay=2e-2)
    rate = torch.optim.lr_scheduler.OneCycleLR(optimiser, max_lr=6e-3, total_steps=steps)
    loss_of = torch.nn.CrossEntropyLoss(label_smoothing=0.05)
    generator = torch.Generator().manual_seed(seed)
    best, best_state = -1.0, None
    for turn in range(PASSES):
        net.train()
        order = torch.randperm(len(y), generator=generator)
        for i in range(len(y) // BATCH):
            of = order[i * BATCH:(i + 1) * BATCH]
            batch = _varied(torch, x[of], generator)
            optimiser.zero_grad()
            loss_of(net(batch), y[of]).backward()
            optimiser.step()
            rate.step()
        share = float((_logits(torch, net, xv).argmax(1) == yv).float().mean())
        if share >= best:
            best, best_state = share, {k: v.clone() for k, v in net.state_dict().items()}
        if not quiet and (turn + 1) % 3 == 0:
            print(f"pass {turn + 1} of {PASSES}: {100 * share:.1f} % of the crops kept aside", flush=True)
    net.load_state_dict(best_state)
    temperature = _temperature(torch, _logits(torch, net, xv), yv)
    with torch.no_grad():  # into the last layer, so that the file's shares are calibrated
        net.last.weight /= temperature
        net.last.bias /= temperature
    _export(torch, torch.nn.Sequential(net, torch.nn.Softmax(1)).eval(), name, channels, classes, seed, scenes, best, out)
    return best


def _varied(torch, batch, generator):
    """Half of the batch mirrored, and shifted by up to 6 pixels: light is taken out by the reader already."""
    if torch.rand(1, generator=generator).item() < 0.5:
        batch = batch.flip(3)
    down, right = (int(torch.randint(-6, 7, (1,), generator=generator)) for _ in range(2))
    return torch.roll(batch, (down, right), (2, 3))


def _logits(torch, net, x):
    net.eval()
    with torch.no_grad():
        return torch.cat([net(part) for part in x.split(256)])


def _temperature(torch, logits, y):
    """By which the logits are divided for the least cross entropy: a search over 0.3 to 3."""
    tried = np.exp(np.linspace(np.log(0.3), np.log(3.0), 60))
    return float(min(tried, key=lambda t: float(torch.nn.functional.cross_entropy(logits / t, y))))


def _export(torch, model, name, channels, classes, seed, scenes, share, out):
    os.makedirs(out, exist_ok=True)
    path = os.path.join(out, name + ".onnx")
    torch.onnx.export(model.to(memory_format=torch.contiguous_format), torch.zeros(1, channels, 64, 64), path + ".tmp", opset_version=11,
                      input_names=["crop"], output_names=["shares"])
    about = {"kind": "classifier", "classes": classes, "side": 64, "normalise": "crop",
             "made_by": f"neritic experiment train_{name} --runs {scenes} --seed {seed}",
             "share_of_crops_kept_aside": round(share, 4)}
    with open(os.path.join(out, name + ".json.tmp"), "w", encoding="utf-8") as file:
        file.write(json.dumps(about, indent=2) + "\n")
    for end in (".onnx", ".json"):
        os.replace(os.path.join(out, name + end + ".tmp"), os.path.join(out, name + end))
