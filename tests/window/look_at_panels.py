# Pictures of every panel, to be looked at. Runs outside Blender:
#   [MESOGRAIN_SCREEN=1280] python3 tests/window/look_at_panels.py FOLDER [dark | light] [BLENDER] [CHECK ...]
import os
import pathlib
import sys

from launch import launch

SCREEN = (int(os.environ.get("MESOGRAIN_SCREEN", "1920")), 2200)  # the narrower, the narrower are the panels
LIMIT = 3600  # s


def main(folder, theme="dark", blender="blender", *checks):
    os.environ.update(MESOGRAIN_BLENDER=blender, MESOGRAIN_THEME=theme)
    folder = pathlib.Path(folder).resolve()
    folder.mkdir(parents=True)
    results, output = launch("checks_panels", folder, SCREEN, LIMIT, ["--enable-event-simulate"],
                             checks=checks)
    print(output, *results.values(), sep="\n")


if __name__ == "__main__":
    main(*sys.argv[1:])
