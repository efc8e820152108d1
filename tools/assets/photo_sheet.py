"""Renders among photographs: a shuffled sheet that asks which is which, and numbers of both.

python3 tools/assets/photo_sheet.py PLACES PHOTOGRAPHS OUT [SEED]: PLACES/NAME.png are pictures of the places;
PHOTOGRAPHS is a folder of photographs taken under water (also in folders in it, with the topic before the first `_`
of a name). They stay out of the project, and so does a sheet that shows them. Writes OUT/shuffled.png, eight of each
in tiles of one size, its key OUT/shuffled.csv, and OUT/places.png, each place beside photographs of its topic.

Prints a table, a row a picture: the median of the water's flat regions (sRGB of 8 bits), luma at 5 and 95 %,
softness at 480 pixels of width (mean gradient of luma and its 99th percentile, levels a pixel), the contrast of single
structures (median over the textured half of standard deviation over mean in 9 pixels), and the share of pixels with
a channel at 0 or 255. A place's row says which of these lie outside of the spread of its topic's photographs.
"""
import csv
import sys
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from water_sheet import FONT, Numbers, fitted, photographs

TILE, COLUMNS, GAP_PX, NAME_PX, EACH = (400, 300), 4, 6, 20, 8
WIDTH_PX = 480
MARGIN = 0.25  # of the spread or of the middle, on either side: a topic has one to seven photographs
# The photographs that a place is held against, by the topics in their names; "" are those of no topic.
TOPICS = {
    "wreck": ("wreck", "w"), "reef": ("", "f", "shark"), "kelp": ("kelp", "divers"), "pool": ("rov", "divers"),
    "quay": ("murky", "rov"), "seabed": ("lamps", "n"), "cave": ("lamps",), "night": ("lamps",),
    "blue": ("divers", "d", "shark"), "murk": ("murky",),
}
QUANTITIES = ("water r", "water g", "water b", "luma 5 %", "luma 95 %", "gradient", "gradient 99 %", "contrast")


def topic(name):
    first = name.split("_")[0]
    return "" if first.isdigit() else first


def measured(picture):
    """The quantities of a picture, and its share of clipped pixels."""
    numbers = Numbers(picture)
    small = picture.convert("RGB").resize((WIDTH_PX, round(picture.height * WIDTH_PX / picture.width)), Image.BOX if picture.width > WIDTH_PX else Image.BICUBIC)
    luma = np.asarray(small, float) @ (0.299, 0.587, 0.114)
    dy, dx = np.gradient(luma)
    steep = np.hypot(dx, dy)
    box = lambda a: np.apply_along_axis(np.convolve, 0, np.apply_along_axis(np.convolve, 1, a, np.ones(9) / 9, "valid"), np.ones(9) / 9, "valid")
    mean = box(luma)
    local = np.sqrt(np.maximum(box(luma * luma) - mean * mean, 0)) / np.maximum(mean, 1)
    return np.array([*numbers.water * 255, *numbers.luma, steep.mean(), np.quantile(steep, 0.99),
                     np.median(local[local >= np.median(local)])]), numbers.clipped


def row(name, values, clipped, note=""):
    r, g, b, low, high, steep, steepest, contrast = values
    return (f"| {name} | {r:.0f} {g:.0f} {b:.0f} | {low:.0f} to {high:.0f} | {steep:.1f}, {steepest:.0f} | {contrast:.3f} | "
            f"{100 * clipped:.1f} % | {note} |")


def outside(values, of_topic):
    """The quantities that lie farther out than the topic's photographs and a margin."""
    low, high = of_topic.min(0), of_topic.max(0)
    spare = MARGIN * np.maximum(high - low, 0.5 * (high + low))
    return ", ".join(f"{name} {v:.3g} ({a:.3g} to {b:.3g})" for name, v, a, b, s in zip(QUANTITIES, values, low, high, spare)
                     if not a - s <= v <= b + s)


def grid(tiles, names):
    wide, high = TILE[0] + GAP_PX, TILE[1] + GAP_PX + NAME_PX
    out = Image.new("RGB", (COLUMNS * wide - GAP_PX, -(-len(tiles) // COLUMNS) * high - GAP_PX), "white")
    draw, font = ImageDraw.Draw(out), ImageFont.truetype(FONT, 15)
    for i, (tile, name) in enumerate(zip(tiles, names)):
        x, y = i % COLUMNS * wide, i // COLUMNS * high
        draw.text((x + 4, y + 1), name, fill="black", font=font)
        out.paste(fitted(tile, TILE), (x, y + NAME_PX))
    return out


def main(arguments):
    if len(arguments) not in (3, 4):
        sys.exit(__doc__)
    places, folder, out = (Path(a) for a in arguments[:3])
    rng = np.random.default_rng(int(arguments[3]) if len(arguments) == 4 else 1)
    renders = [(f.stem, Image.open(f).convert("RGB")) for f in sorted(places.glob("*.png"))]
    photos = [(name, picture, *measured(picture)) for name, picture, _ in photographs(folder)]
    if len(renders) < EACH or len(photos) < EACH:
        sys.exit(f"found {len(renders)} places and {len(photos)} photographs; accepted: {EACH} of each or more")
    out.mkdir(parents=True, exist_ok=True)

    print("| picture | water | luma 5 to 95 % | softness | contrast | a channel at 0 or 255 | outside of its topic |")
    print("|---|---|---|---|---|---|---|")
    beside, names = [], []
    for name, picture in renders:
        values, clipped = measured(picture)
        mine = [p for p in photos if topic(p[0]) in TOPICS.get(name, ())] or photos
        print(row(name, values, clipped, outside(values, np.array([p[2] for p in mine])) or "nothing"))
        beside += [picture] + [p[1] for p in mine[: COLUMNS - 1]] + [Image.new("RGB", TILE, "white")] * max(0, COLUMNS - 1 - len(mine))
        names += [name] + ([p[0] for p in mine] + [""] * COLUMNS)[: COLUMNS - 1]
    for name, _, values, clipped in photos:
        print(row(name, values, clipped))
    grid(beside, names).save(out / "places.png")

    pick = lambda of: [of[k] for k in rng.permutation(len(of))[:EACH]]
    cards = [("render", name, picture) for name, picture in pick(renders)] + [("photograph", p[0], p[1]) for p in pick(photos)]
    cards = [cards[k] for k in rng.permutation(len(cards))]
    grid([c[2] for c in cards], [str(k + 1) for k in range(len(cards))]).save(out / "shuffled.png")
    with open(out / "shuffled.csv", "w", newline="") as f:
        csv.writer(f).writerows([("number", "kind", "name")] + [(k + 1, c[0], c[1]) for k, c in enumerate(cards)])


if __name__ == "__main__":
    main(sys.argv[1:])
