"""Takes the sand's colour and normal pictures out of seabed.glb for terrains made of heightfields.

Writes assets/textures/sand_color.jpg and sand_normal.jpg (a repeat every 2.5 m).
"""
import json
import struct
from pathlib import Path

ASSETS = Path(__file__).resolve().parents[2] / "assets"


def images(glb):
    """(name, bytes) of the pictures in a binary glTF file."""
    length = struct.unpack_from("<I", glb, 12)[0]
    doc = json.loads(glb[20:20 + length])
    binary = 20 + length + 8
    for image in doc["images"]:
        view = doc["bufferViews"][image["bufferView"]]
        start = binary + view.get("byteOffset", 0)
        yield image["name"], glb[start:start + view["byteLength"]]


def main():
    for name, data in images((ASSETS / "models" / "seabed.glb").read_bytes()):
        if name.startswith("sand_"):
            (ASSETS / "textures" / f"{name}.jpg").write_bytes(data)


if __name__ == "__main__":
    main()
