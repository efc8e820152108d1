"""One sheet of the same view in the ten Jerlov types, each tile named.

python3 tools/assets/water_sheet.py FOLDER SHEET.png: FOLDER/TYPE.png are pictures of one size.
"""
import sys
from pathlib import Path

from PIL import Image, ImageDraw, ImageFont

TYPES = ("I", "IA", "IB", "II", "III", "1C", "3C", "5C", "7C", "9C")
COLUMNS, GAP_PX, NAME_PX = 5, 4, 22
FONT = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"


def sheet(folder):
    tiles = [Image.open(folder / f"{name}.png").convert("RGB") for name in TYPES]
    wide, high = tiles[0].width + GAP_PX, tiles[0].height + NAME_PX + GAP_PX
    out = Image.new("RGB", (COLUMNS * wide - GAP_PX, len(TYPES) // COLUMNS * high - GAP_PX), "white")
    draw = ImageDraw.Draw(out)
    font = ImageFont.truetype(FONT, 15)
    for i, (name, tile) in enumerate(zip(TYPES, tiles)):
        x, y = i % COLUMNS * wide, i // COLUMNS * high
        draw.text((x + 4, y + 2), f"type {name}", fill="black", font=font)
        out.paste(tile, (x, y + NAME_PX))
    return out


sheet(Path(sys.argv[1])).save(sys.argv[2])
