"""Draws the data of a picture that `neritic` wrote: python3 tools/plot DATA.json [--out PICTURE.png] [--all].

The key "picture" of the data says which picture it is; README.md lists them. Exit status: 0 drawn,
1 could not write, 2 bad data or usage, 3 matplotlib is missing. One line on stderr says why.
"""
import argparse
import gc
import json
import os
import sys

NO_MATPLOTLIB = 3  # tools/common/picture.cpp knows this number


class BadData(Exception):
    """The file is no data of a picture."""


def read(path):
    try:
        with open(path, encoding="utf-8") as file:
            data = json.load(file)
    except (OSError, ValueError) as error:
        raise BadData(f"{path}: cannot be read: {error}") from None
    if not isinstance(data, dict) or not isinstance(data.get("picture"), str):
        raise BadData(f'{path}: found no key "picture"; accepted: a data file of neritic (.plot.json)')
    return data


def painters():
    """Each name of a picture and the function that draws it, data -> Figure."""
    import curves
    import dive
    import physio
    import plan
    import timeline

    return {"dive": dive.draw, "plan": plan.draw, "curves": curves.draw, "timeline": timeline.draw} | physio.PAINTERS


def save(figure, path):
    """A PNG under a temporary name, renamed when whole; a device or pipe is written in place."""
    path = os.path.realpath(path)
    in_place = os.path.exists(path) and not os.path.isfile(path)
    name = path if in_place else f"{path}.{os.getpid()}.tmp"
    try:
        # Without the library's version: the same data gives the same bytes on one machine.
        figure.savefig(name, format="png", metadata={"Software": None})
        if not in_place:
            os.replace(name, path)
    finally:
        if not in_place and os.path.exists(name):
            os.remove(name)


def main():
    parser = argparse.ArgumentParser(prog="tools/plot", description="Draws the data of a picture of neritic.")
    parser.add_argument("data", help="what neritic wrote: DIVE.plot.json, deco.json, ...")
    parser.add_argument("--out", help="the picture, .png (default: the data's name with .png)")
    parser.add_argument("--all", action="store_true", help="a dive: every panel, beneath the page of its story")
    asked = parser.parse_args()
    gc.disable()  # a page fits into memory, and its process ends with it
    stem = asked.data.removesuffix(".json").removesuffix(".plot")
    try:
        data = read(asked.data)
        known = painters()
        if data["picture"] not in known:
            raise BadData(f'{asked.data}: found picture "{data["picture"]}"; accepted: {", ".join(known)}')
        if asked.all and data["picture"] != "dive":
            raise BadData(f'{asked.data}: found --all of picture "{data["picture"]}"; accepted: dive')
        drawn = known[data["picture"]](data, everything=True) if asked.all else known[data["picture"]](data)
        save(drawn, asked.out or stem + ".png")
    except ModuleNotFoundError as error:
        if error.name is None or error.name.split(".")[0] not in ("matplotlib", "numpy"):
            raise
        print(f"tools/plot: no {error.name} here; tools/setup plots installs it", file=sys.stderr)
        return NO_MATPLOTLIB
    except BadData as error:
        print(f"tools/plot: {error}", file=sys.stderr)
        return 2
    except OSError as error:
        print(f"tools/plot: {asked.out or stem + '.png'}: cannot be written: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
