"""Puts tools/experiment on the path. Tests of it are skipped (exit 77) without numpy."""
import os
import sys

try:
    import numpy  # noqa: F401
except ModuleNotFoundError:
    sys.exit(77)

HERE = os.path.dirname(os.path.realpath(__file__))
TOOLS = os.path.join(HERE, "..", "..", "tools", "experiment")
sys.dont_write_bytecode = True
sys.path.insert(0, TOOLS)
