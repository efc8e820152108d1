"""Batches to learn from: each crop turned, scaled, shifted, mirrored, faded, blurred and made noisy anew; and things of a
camera's crops pasted, as faint as they were in their own water, before what other scenes show behind nothing. Everything is
drawn by the seed. A crop whose thing would leave the picture is drawn as it was rendered.
"""
import math

import numpy as np

LEAST_SHARE = 0.025  # of a varied crop that its thing covers
SIDE = 64


def of(torch, pictures, classes, seed):
    """batches(n): (normalised crops, classes). pictures: [n, 64, 64] of a sonar; [n, wide, wide, 4] of a camera, where the
    fourth channel is the thing's mask and wide more than 64."""
    make = _Camera if pictures.ndim == 4 else _Sonar
    return make(torch, pictures, classes, seed).batch


def _normalised(torch, x):
    """As looking.normalised."""
    spread = x.std(dim=(2, 3), unbiased=False, keepdim=True).clamp(min=2.0)
    return ((x - x.mean(dim=(2, 3), keepdim=True)) / spread).contiguous(memory_format=torch.channels_last)


class _Camera:
    PASTED, MOST_TURN, SCALES, SHIFT = 0.5, 0.35, (0.75, 1.35), 0.22

    def __init__(self, torch, pictures, classes, seed):
        self.torch, self.random = torch, np.random.Generator(np.random.Philox(key=seed))
        self.noise = torch.Generator().manual_seed(seed)
        self.pictures, self.classes = pictures, classes
        self.by_class = [np.flatnonzero(classes == k) for k in range(int(classes.max()) + 1)]
        self.wide = pictures.shape[1]

    def batch(self, n):
        """As many of each class, whatever the scenes gave."""
        torch, rng = self.torch, self.random
        kinds = np.arange(n) % len(self.by_class)
        of = np.array([rng.choice(self.by_class[k]) for k in kinds])
        x = self._cut(self.pictures[of], True)
        behind = self._cut(self.pictures[rng.choice(self.by_class[0], n)], False)
        colors, mask = x[:, :3], x[:, 3:] / 255.0
        weight = 1.0 - mask
        around = (colors * weight).sum((2, 3), keepdim=True) / weight.sum((2, 3), keepdim=True).clamp(min=1.0)
        light = behind[:, :3]
        fade = torch.tensor(rng.uniform(0.7, 1.2, (n, 1, 1, 1)), dtype=torch.float32)
        pasted = light * weight + mask * (light.mean((2, 3), keepdim=True) + fade * (colors - around))
        chosen = torch.tensor((rng.random(n) < self.PASTED) & (kinds > 0)).view(n, 1, 1, 1)
        colors = torch.where(chosen, pasted, colors)
        soft = torch.nn.functional.avg_pool2d(torch.nn.functional.pad(colors, (1, 1, 1, 1), mode="replicate"), 3, 1)
        colors = torch.where(torch.tensor(rng.random(n) < 0.15).view(n, 1, 1, 1), soft, colors)
        noise = torch.tensor(rng.uniform(0.3, 2.8, (n, 1, 1, 1)), dtype=torch.float32)
        colors = (colors + noise * torch.randn(colors.shape, generator=self.noise)).clamp(0, 255)
        return _normalised(torch, colors), torch.tensor(kinds)

    def _cut(self, pictures, keeps_thing):
        """64 x 64 of each, somewhere, turned and scaled."""
        torch, n = self.torch, len(pictures)
        x = torch.tensor(pictures).permute(0, 3, 1, 2).float()
        out = torch.nn.functional.grid_sample(x, self._grid(n), mode="bilinear", padding_mode="reflection", align_corners=False)
        if keeps_thing:
            has = x[:, 3].amax((1, 2)) > 0
            lost = has & ((out[:, 3] / 255.0).mean((1, 2)) < LEAST_SHARE)
            edge = (self.wide - SIDE) // 2
            out = torch.where(lost.view(n, 1, 1, 1), x[:, :, edge:edge + SIDE, edge:edge + SIDE], out)
        return out

    def _grid(self, n):
        torch, rng = self.torch, self.random
        part = SIDE / self.wide * np.exp(rng.uniform(*np.log(self.SCALES), n))
        turn, mirror = rng.normal(0, self.MOST_TURN / 2, n).clip(-self.MOST_TURN, self.MOST_TURN), rng.choice([-1.0, 1.0], n)
        at = rng.uniform(-self.SHIFT, self.SHIFT, (n, 2))
        theta = np.zeros((n, 2, 3), np.float32)
        for i in range(n):
            c, s = math.cos(turn[i]) * part[i], math.sin(turn[i]) * part[i]
            theta[i] = [[c * mirror[i], -s, at[i, 0]], [s * mirror[i], c, at[i, 1]]]
        return torch.nn.functional.affine_grid(torch.tensor(theta), (n, 4, SIDE, SIDE), align_corners=False)


class _Sonar:
    """Mirrored in bearing, shifted by up to 6 bins, and louder or fainter bins all over: a sonar's picture cannot be turned."""

    def __init__(self, torch, pictures, classes, seed):
        self.torch, self.random, self.pictures, self.classes = torch, np.random.Generator(np.random.Philox(key=seed)), pictures, classes
        self.by_class = [np.flatnonzero(classes == k) for k in range(int(classes.max()) + 1)]

    def batch(self, n):
        torch, rng = self.torch, self.random
        kinds = np.arange(n) % len(self.by_class)
        of = np.array([rng.choice(self.by_class[k]) for k in kinds])
        x = self.pictures[of].astype(np.float32)
        for i in range(n):
            x[i] = np.roll(x[i, :, ::rng.choice([-1, 1])], rng.integers(-6, 7, 2), (0, 1))
        x = 255 * (x / 255) ** rng.uniform(0.8, 1.25, (n, 1, 1)) + rng.uniform(0, 12, (n, 1, 1)) * rng.standard_normal(x.shape, np.float32)
        return _normalised(torch, torch.tensor(x.clip(0, 255).astype(np.float32)[:, None])), torch.tensor(kinds)
