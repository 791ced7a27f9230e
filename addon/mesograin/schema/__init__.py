# What a grain is made of and which models answer: grain.json, that C++, Blender, the commands and the docs read.
"""`models.MODELS` and `parameters.PARAMETERS`. Readable without Blender and without the native module."""

import json
from pathlib import Path

GRAIN = json.loads(Path(__file__).with_name("grain.json").read_text(encoding="utf-8"))
"""The file as it stands."""

SCENE = json.loads(Path(__file__).with_name("scene.json").read_text(encoding="utf-8"))
"""What is said of a whole scene; native/scene/scene.h says the same."""

AUTO = json.loads(Path(__file__).with_name("auto.json").read_text(encoding="utf-8"))
"""What stands for a model where it is to be chosen, and what the choice goes by."""
