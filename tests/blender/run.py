# Runs pytest inside Blender: blender -b --factory-startup --python-exit-code 1 --python tests/blender/run.py -- [args]
import pathlib
import sys

import pytest

HERE = pathlib.Path(__file__).resolve().parent


def main():
    arguments = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else []
    if not any(argument.split("::")[0].endswith(".py") for argument in arguments):
        arguments.append(str(HERE))
    # Blender's own exit would hide a failure; SystemExit carries pytest's code out of it.
    sys.exit(pytest.main(["-p", "no:cacheprovider", "-c", str(HERE / "pytest.ini"), *arguments]))


main()
