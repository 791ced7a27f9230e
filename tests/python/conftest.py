"""Finds the native module in the build folder: MESOGRAIN_BUILD, or build/release in the checkout."""

import os
import pathlib
import sys

SOURCE = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ.get("MESOGRAIN_BUILD") or SOURCE / "build/release")
sys.path.insert(0, str(BUILD))
