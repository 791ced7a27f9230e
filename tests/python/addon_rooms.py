"""Imports rooms of the add-on that need no Blender."""

import importlib
import pathlib
import sys

ADDON = pathlib.Path(__file__).resolve().parents[2] / "addon"
sys.path.insert(0, str(ADDON))


def room(name):
    """A module of the add-on, such as `cycles.inversion`. The package itself imports nothing of Blender's."""
    return importlib.import_module(f"mesograin.{name}")
