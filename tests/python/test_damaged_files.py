"""Files that were damaged at random are read, or refused in a sentence; nothing else may happen."""
import pathlib
import re
import subprocess
import sys

from conftest import BUILD

DAMAGED_FILES = pathlib.Path(__file__).with_name("damaged_files.py")


def test_damaged_files_are_read_or_refused_in_a_sentence():
    ended = subprocess.run([sys.executable, DAMAGED_FILES, BUILD], capture_output=True, text=True, timeout=300)
    lines = ended.stdout.splitlines()
    assert ended.returncode == 0, f"{ended.stderr}\n{lines[-1:]}"
    assert len(lines) == 1, "\n".join(lines[:20])
    read, refused = map(int, re.fullmatch(r"(\d+) read, (\d+) refused", lines[0]).groups())
    assert read + refused == 4100 and read > 100 and refused > 1000
