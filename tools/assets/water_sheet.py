"""One sheet of the same view in the ten Jerlov types, each tile named; beside photographs, with numbers.

python3 tools/assets/water_sheet.py FOLDER SHEET.png [PHOTOGRAPHS]: FOLDER/TYPE.png are pictures of one size.
PHOTOGRAPHS is a folder of photographs taken under water (also in folders in it); they stay out of the project, and
so does a sheet that shows them. Under each type then stand the two photographs whose water is nearest to its own.

Prints a table, a row a picture: the median of the water's flat regions (sRGB of 8 bits), its hue (degrees) and chroma
in Oklab, luma at 5 and 95 %, the share of pixels at the gamut's edge (0.85 of the largest chroma that sRGB has at
their lightness and hue, or more: shaders/shared/gamut.h puts colours of the edge there), and the share with a channel
at 0 or 255. A type has also the distance in Oklab to the nearest photograph's water (0.02 is just noticeable).
"""
import sys
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont, UnidentifiedImageError

TYPES = ("I", "IA", "IB", "II", "III", "1C", "3C", "5C", "7C", "9C")
COLUMNS, GAP_PX, NAME_PX = 5, 4, 22
FONT = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"
EDGE = 0.85
NEAREST = 2
NO_PHOTOGRAPH = ("_mask", "_reference")  # labels, and pictures that a program has enhanced
# Oklab (Ottosson 2020): linear sRGB to cones, their cube roots to lightness and two opponents.
TO_CONES = np.array([[0.4122214708, 0.5363325363, 0.0514459929], [0.2119034982, 0.6806995451, 0.1073969566],
                     [0.0883024619, 0.2817188376, 0.6299787005]])
TO_LAB = np.array([[0.2104542553, 0.7936177850, -0.0040720468], [1.9779984951, -2.4285922050, 0.4505937099],
                   [0.0259040371, 0.7827717662, -0.8086757660]])


def linear(srgb):
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)


def oklab(srgb):
    return np.cbrt(linear(srgb) @ TO_CONES.T) @ TO_LAB.T


def part_of_gamut(lab):
    """Chroma over the largest that sRGB has at each lightness and hue."""
    low, high = np.zeros(len(lab)), np.full(len(lab), 64.0)
    for _ in range(24):
        part = 0.5 * (low + high)
        at = lab.copy()
        at[:, 1:] *= part[:, None]
        rgb = (at @ np.linalg.inv(TO_LAB).T) ** 3 @ np.linalg.inv(TO_CONES).T
        inside = ((rgb > -1e-6) & (rgb < 1 + 1e-6)).all(axis=1)
        low, high = np.where(inside, part, low), np.where(inside, high, part)
    return 1.0 / np.maximum(low, 1e-9)


def flat(rgb):
    """The pixels whose surroundings vary least: open water rather than things in it."""
    luma = rgb @ (0.299, 0.587, 0.114)
    rough = sum(np.abs(np.roll(luma, by, axis) - luma) for by in (1, 3) for axis in (0, 1))
    return rgb[rough <= np.quantile(rough, 0.4)]


class Numbers:
    def __init__(self, picture):
        small = picture.convert("RGB")
        small.thumbnail((320, 320))
        rgb = np.asarray(small, float) / 255.0
        pixels = rgb.reshape(-1, 3)
        self.water = np.median(flat(rgb), axis=0)
        self.lab = oklab(self.water[None])[0]
        self.hue_deg = np.degrees(np.arctan2(self.lab[2], self.lab[1])) % 360.0
        self.chroma = np.hypot(self.lab[1], self.lab[2])
        self.luma = np.quantile(pixels @ (76.245, 149.685, 29.07), (0.05, 0.95))
        self.at_edge = np.mean(part_of_gamut(oklab(pixels[::7])) >= EDGE)  # every seventh is enough
        whole = np.asarray(picture.convert("RGB"))
        self.clipped = np.mean(((whole == 0) | (whole == 255)).any(axis=-1))

    def row(self, name):
        r, g, b = np.rint(self.water * 255).astype(int)
        return (f"| {name} | {r} {g} {b} | {self.hue_deg:.0f} | {self.chroma:.3f} | {self.luma[0]:.0f} to "
                f"{self.luma[1]:.0f} | {100 * self.at_edge:.1f} % | {100 * self.clipped:.1f} % |")


def photographs(folder):
    found = []
    for file in sorted(folder.rglob("*")):
        if file.is_dir() or file.stem.endswith(NO_PHOTOGRAPH):
            continue
        try:
            picture = Image.open(file).convert("RGB")
        except (UnidentifiedImageError, OSError):
            continue
        found.append((file.stem, picture, Numbers(picture)))
    if not found:
        sys.exit(f"{folder}: found no pictures; accepted: a folder of photographs")
    return found


def fitted(picture, size):
    """Scaled and cut to a size from its middle."""
    scale = max(size[0] / picture.width, size[1] / picture.height)
    grown = picture.resize((round(picture.width * scale), round(picture.height * scale)))
    x, y = (grown.width - size[0]) // 2, (grown.height - size[1]) // 2
    return grown.crop((x, y, x + size[0], y + size[1]))


def sheet(tiles, near):
    """tiles: a type; near: of each its photographs."""
    beside = [[fitted(photo[1], (tiles[0].width // NEAREST, tiles[0].height // NEAREST)) for photo in of] for of in near]
    lower = beside[0][0].height if near and near[0] else 0
    wide, high = tiles[0].width + GAP_PX, tiles[0].height + NAME_PX + lower + GAP_PX
    out = Image.new("RGB", (COLUMNS * wide - GAP_PX, len(TYPES) // COLUMNS * high - GAP_PX), "white")
    draw = ImageDraw.Draw(out)
    font = ImageFont.truetype(FONT, 15)
    for i, (name, tile) in enumerate(zip(TYPES, tiles)):
        x, y = i % COLUMNS * wide, i // COLUMNS * high
        draw.text((x + 4, y + 2), f"type {name}", fill="black", font=font)
        out.paste(tile, (x, y + NAME_PX))
        for k, photo in enumerate(beside[i] if near else []):
            out.paste(photo, (x + k * photo.width, y + NAME_PX + tile.height))
    return out


def main(arguments):
    if len(arguments) not in (2, 3):
        sys.exit(__doc__)
    folder = Path(arguments[0])
    tiles = [Image.open(folder / f"{name}.png").convert("RGB") for name in TYPES]
    photos = photographs(Path(arguments[2])) if len(arguments) == 3 else []
    print("| picture | water | hue | chroma | luma 5 to 95 % | at the gamut's edge | a channel at 0 or 255 |"
          + (" nearest photograph |" if photos else ""))
    print("|---|---|---|---|---|---|---|" + ("---|" if photos else ""))
    near = []
    for name, tile in zip(TYPES, tiles):
        numbers = Numbers(tile)
        order = sorted(photos, key=lambda photo: np.linalg.norm(photo[2].lab - numbers.lab))
        near.append(order[:NEAREST])
        told = f" {np.linalg.norm(order[0][2].lab - numbers.lab):.3f} {order[0][0]} |" if photos else ""
        print(numbers.row(f"type {name}") + told)
    for name, _, numbers in photos:
        print(numbers.row(name) + " |")
    sheet(tiles, near if photos else []).save(arguments[1])


if __name__ == "__main__":
    main(sys.argv[1:])
