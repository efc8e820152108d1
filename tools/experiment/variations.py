"""Batches to learn from: each crop turned, scaled, shifted, mirrored, faded, blurred, its exposure and balance of colours changed,
its colours mixed as by another water, darker towards a side, and made noisy anew; and things of a camera's crops pasted, as faint as they were in their own water or fainter, before what
other scenes show behind nothing. Everything is drawn by the seed. A crop whose thing would leave the picture is drawn as it was
rendered.
"""
import math

import numpy as np

from crops import falloff

LEAST_CONTRAST = 7.0  # rms of 255 levels between a pasted thing and the light around it, however faint it was drawn
LEAST_SHARE = 0.025  # of a varied crop that its thing covers
SIDE = 64


def of(torch, pictures, classes, seed):
    """batches(n): (normalised crops, classes). pictures: [n, 64, 64] of a sonar; [n, wide, wide, 4] of a camera, where the
    fourth channel is the thing's mask and wide more than 64."""
    make = _Camera if pictures.ndim == 4 else _Sonar
    batch = make(torch, pictures, classes, seed).batch

    def normalised(n):
        x, kinds = batch(n)
        return _normalised(torch, x), kinds
    return normalised


def _normalised(torch, x):
    """As looking.normalised."""
    x = x - x.mean(dim=(2, 3), keepdim=True)
    spread = x.std(dim=(2, 3), unbiased=False, keepdim=True).clamp(min=2.0)
    return (x / spread).contiguous(memory_format=torch.channels_last)


class _Camera:
    PASTED, MOST_TURN, SCALES, SHIFT = 0.5, 0.4, (0.75, 1.45), 0.22
    MIXED, MIX, PALEST, DARKER, FALLOFFS = 0.5, 0.1, 0.3, 0.4, 256

    def __init__(self, torch, pictures, classes, seed):
        import cv2
        cv2.setNumThreads(1)
        self.torch, self.cv2, self.random = torch, cv2, np.random.Generator(np.random.Philox(key=seed))
        self.pictures, self.wide = pictures, pictures.shape[1]
        self.by_class = [np.flatnonzero(classes == k) for k in range(int(classes.max()) + 1)]
        self.noise = self.random.standard_normal(1 << 21, np.float32)  # that each crop has a part of
        self.falloffs = np.stack([falloff(self.random, SIDE, self.random.uniform(0.2, 0.84)) for _ in range(self.FALLOFFS)])
        self.falloffs = self.falloffs[..., None].astype(np.float32)
        self.before = None

    def batch(self, n):
        """As many of each class, whatever the scenes gave. Every other batch is the one before, left and right exchanged, with
        light and noise of its own."""
        kinds = np.arange(n) % len(self.by_class)
        if self.before is None:
            shown = np.stack([self._one(self.random.choice(self.by_class[k]), k > 0) for k in kinds])
            self.before = shown[:, :, ::-1]
        else:
            shown, self.before = self.before, None
        return self.torch.tensor(np.stack([self._seen(x) for x in shown]).transpose(0, 3, 1, 2)), self.torch.tensor(kinds)

    def _seen(self, x):
        """By a camera of some exposure, balance of colours and noise."""
        rng = self.random
        levels = 255 * np.linspace(0, 1, 256, dtype=np.float32) ** np.float32(rng.uniform(0.8, 1.25))
        out = levels[x]
        if rng.random() < self.MIXED:  # paler or richer, and each colour with a little of the others
            pale = rng.uniform(self.PALEST, 1.3)
            mix = pale * np.eye(3) + (1 - pale) / 3 + rng.normal(0, self.MIX, (3, 3))
            out = out @ mix.astype(np.float32)
        out = out * rng.uniform(0.8, 1.25, 3).astype(np.float32)
        if rng.random() < self.DARKER:
            out *= self.falloffs[rng.integers(self.FALLOFFS)]
        first = rng.integers(len(self.noise) - out.size)
        out += np.float32(rng.uniform(0.3, 2.8)) * self.noise[first:first + out.size].reshape(out.shape)
        return np.clip(out, 0, 255, out=out)

    def _one(self, index, may_be_pasted):
        """[64, 64, 3], uint8, without a camera's noise."""
        rng = self.random
        x = self._cut(self.pictures[index])
        colors = x[..., :3]
        if may_be_pasted and rng.random() < self.PASTED:
            light = self._cut(self.pictures[rng.choice(self.by_class[0])])[..., :3].astype(np.float32)
            colors, mask = colors.astype(np.float32), x[..., 3:].astype(np.float32) / 255
            rest, size = 1 - mask, max(float(mask.sum()), 1.0)
            around = (colors * rest).sum((0, 1)) / max(float(rest.sum()), 1.0)
            off = mask * (colors - around)
            rms = math.sqrt(float((off ** 2).sum()) / 3 / size)
            fade = max(rng.uniform(0.35, 1.3), min(1.3, LEAST_CONTRAST / max(rms, 1.0)))
            colors = np.clip(light * rest + mask * light.mean((0, 1)) + fade * off, 0, 255).astype(np.uint8)
        if rng.random() < 0.15:
            colors = self.cv2.blur(np.ascontiguousarray(colors), (3, 3), borderType=self.cv2.BORDER_REPLICATE)
        return colors

    def _cut(self, picture):
        """64 x 64 of it, somewhere, turned and scaled; where its thing would be lost, of its middle."""
        rng, cv2, side = self.random, self.cv2, SIDE
        part = math.exp(rng.uniform(*np.log(self.SCALES)))
        turn, mirror = float(np.clip(rng.normal(0, self.MOST_TURN / 2), -self.MOST_TURN, self.MOST_TURN)), rng.choice([-1.0, 1.0])
        c, s = math.cos(turn) * part, math.sin(turn) * part
        way = np.array([[c * mirror, -s], [s * mirror, c]])
        at = (self.wide - 1) / 2 + rng.uniform(-self.SHIFT, self.SHIFT, 2) * self.wide / 2 - way @ np.full(2, (side - 1) / 2)
        out = cv2.warpAffine(picture, np.hstack([way, at[:, None]]), (side, side), flags=cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP,
                             borderMode=cv2.BORDER_REFLECT_101)
        if picture[..., 3].any() and out[..., 3].mean() / 255 < LEAST_SHARE:
            edge = (self.wide - side) // 2
            out = picture[edge:edge + side, edge:edge + side]
        return out


class _Sonar:
    """Mirrored in bearing, shifted by up to 6 bins, louder or fainter bins all over, as bottoms are, and half of them with a further
    draw of speckle, as of a narrower beam: a sonar's picture cannot be turned."""

    SPECKLE, SHAPES, POWERS, SPAN_DB = 0.5, (1.0, 10.0), (0.6, 1.3), 45.0

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
            if rng.random() < self.SPECKLE:
                x[i] = self._speckled(x[i], math.exp(rng.uniform(*np.log(self.SHAPES))))
        x = 255 * (x / 255) ** rng.uniform(*self.POWERS, (n, 1, 1)) + rng.uniform(0, 12, (n, 1, 1)) * rng.standard_normal(x.shape, np.float32)
        return torch.tensor(x.clip(0, 255).astype(np.float32)[:, None]), torch.tensor(kinds)

    def _speckled(self, levels, shape):
        """Each bin times a gamma variate of mean 1; the loudest bin is white again."""
        times = np.maximum(self.random.standard_gamma(shape, levels.shape, np.float32) / shape, 1e-4)
        out = levels + np.float32(255 * 10 / self.SPAN_DB) * np.log10(times)
        return np.maximum(out + (255 - out.max()), 0)
