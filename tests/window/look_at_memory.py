# What is left in memory by each kind of work in a window, done over and over. Runs outside Blender:
#   python3 tests/window/look_at_memory.py [MESOGRAIN | BLENDER_WORKBENCH | ...] [BLENDER] [CHECK ...]
import os
import pathlib
import sys
import tempfile

from launch import launch

SCREEN = (900, 640)
LIMIT = 3600  # s


def main(engine="MESOGRAIN", blender="blender", *checks):
    os.environ.update(MESOGRAIN_BLENDER=blender, MESOGRAIN_ENGINE=engine)
    with tempfile.TemporaryDirectory() as folder:
        results, output = launch("checks_memory", pathlib.Path(folder), SCREEN, LIMIT, checks=checks)
    print(*(line for line in output.splitlines() if line.startswith("check_")), *results.values(), sep="\n")


if __name__ == "__main__":
    main(*sys.argv[1:])
