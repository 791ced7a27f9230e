# Where a result comes from: the scene, the versions, the machine.
"""What `results.json` says of its origin."""

import datetime
import os
import platform
from pathlib import Path

import bpy
import numpy

from ... import __version__, native_module

COMMON_SETTINGS = {"pixel_filter": "box, one pixel, on both sides", "colour_space": "linear, scene-referred"}
"""What holds of every picture of both sides."""


def describe(command, size):
    """The keys that every file of results has. command: the line that repeats it. size: (width, height)."""
    return {
        "created": datetime.datetime.now(datetime.timezone.utc).isoformat(timespec="seconds"),
        "command": command,
        "scene": scene_name(),
        "size": list(size),
        "versions": versions(),
        "device": native_module.get().device_info(),
        "cpu": processor(),
    }


def scene_name():
    """The file's name, or 'unsaved'."""
    return Path(bpy.data.filepath).name if bpy.data.filepath else "unsaved"


def versions():
    """Of Mesograin and of what it stands on."""
    return {
        "mesograin": __version__,
        "blender": f"{bpy.app.version_string} ({bpy.app.build_hash.decode('ascii', 'replace')})",
        "python": platform.python_version(),
        "numpy": numpy.__version__,
    }


def processor():
    """The CPU as a dict: cores, machine, and its name where the system tells."""
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as lines:
            name = next((line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")), "")
    except OSError:
        name = ""
    return {"cores": os.cpu_count(), "machine": platform.machine(), "name": name}
