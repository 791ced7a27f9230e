# Where a sweep keeps its cases: a finished case is a folder, so a killed sweep loses only what was under way.
"""See `Folder`."""
import contextlib
import fcntl
import json
import os
import shutil
import time
from pathlib import Path

RESULTS, LOCKS = "results.json", ".locks"
LOOK_SECONDS = 0.1
"""How often a sweep looks whether another one has ended its case."""


class Folder:
    """OUT/cases/KEY holds a finished case, KEY.partial one under way, KEY.failed.json what went wrong."""

    def __init__(self, out):
        self.out = Path(out)
        self._cases = self.out / "cases"
        self._locks = None

    def create(self):
        """Raises OSError if the folder cannot be written."""
        self._cases.mkdir(parents=True, exist_ok=True)
        # Open for as long as this process lives: closing it anywhere would give all its locks up.
        self._locks = open(self._cases / LOCKS, "ab")

    def finished(self, case):
        """Whether its results are there and can be read; what cannot is compared again."""
        try:
            return "cases" in self.results(case)
        except (OSError, ValueError, TypeError):
            return False

    @contextlib.contextmanager
    def alone_with(self, case, waiting):
        """Keeps every other sweep into this folder, on this machine or another, from working on the case meanwhile.

        waiting: called again and again while another one does; what it raises ends the wait. Nothing keeps sweeps
        apart where the file system knows no locks.
        """
        byte = int(case.key, 16) >> 2  # one for each case; offsets have 63 bits
        while not self._lock(byte):
            waiting()
            time.sleep(LOOK_SECONDS)
        try:
            yield
        finally:
            with contextlib.suppress(OSError):
                fcntl.lockf(self._locks, fcntl.LOCK_UN, 1, byte)

    def place(self, case):
        """Where a finished case lies, relative to the sweep's folder."""
        return Path("cases") / case.key

    def begin(self, case):
        """An empty folder to compare in."""
        partial = self._cases / f"{case.key}.partial"
        shutil.rmtree(partial, ignore_errors=True)
        partial.mkdir()
        write(partial / "case.json", case.as_json())
        return partial

    def finish(self, case):
        """Makes what was written under `begin` the case's result, all at once."""
        final = self._cases / case.key
        shutil.rmtree(final, ignore_errors=True)
        (self._cases / f"{case.key}.partial").rename(final)
        self._failure_path(case).unlink(missing_ok=True)

    def fail(self, case, sentence, code):
        write(self._failure_path(case), {**case.as_json(), "error": sentence, "exit_code": code})

    def failure(self, case):
        """{'error', 'exit_code', ...} or None."""
        try:
            return json.loads(self._failure_path(case).read_text(encoding="utf-8"))
        except (FileNotFoundError, ValueError):
            return None

    def results(self, case):
        return json.loads((self._cases / case.key / RESULTS).read_text(encoding="utf-8"))

    def _lock(self, byte):
        """False if another process has it."""
        try:
            fcntl.lockf(self._locks, fcntl.LOCK_EX | fcntl.LOCK_NB, 1, byte)
        except (BlockingIOError, PermissionError):
            return False
        except OSError:  # no locks on this file system
            pass
        return True

    def _failure_path(self, case):
        return self._cases / f"{case.key}.failed.json"


def write(path, value):
    """Writes JSON so that the file is there whole or not at all."""
    write_text(path, json.dumps(value, indent=1) + "\n")


def write_text(path, text):
    """Writes UTF-8 so that the file is there whole or not at all."""
    partial = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        partial.write_text(text, encoding="utf-8", newline="")
        partial.replace(path)
    finally:
        partial.unlink(missing_ok=True)
