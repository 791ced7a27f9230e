# What the renderer says of a machine on which it cannot draw.
import pathlib
import subprocess
import sys

import mesograin_native as native
import pytest

ASK = """
import mesograin_native as native
try:
    native.device_info()
except native.Error as error:
    print(error)
"""


@pytest.mark.parametrize("library, remedy", [("libEGL.so.1", "libegl1"), ("libGL.so.1", "libgl1")])
def test_a_missing_library_is_named(library, remedy, tmp_path, monkeypatch):
    (tmp_path / library).touch()  # no library at all, and found before the system's
    monkeypatch.setenv("LD_LIBRARY_PATH", str(tmp_path))
    monkeypatch.setenv("PYTHONPATH", str(pathlib.Path(native.__file__).parent))
    done = subprocess.run([sys.executable, "-c", ASK], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    assert library in done.stdout and f"{remedy}.\n" in done.stdout
