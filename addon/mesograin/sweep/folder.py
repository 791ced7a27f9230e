# Where a sweep keeps its cases: a finished case is a folder, so a killed sweep loses only what was under way.
"""See `Folder`."""
import json
import os
import shutil
from pathlib import Path

RESULTS = "results.json"


class Folder:
    """OUT/cases/KEY holds a finished case, KEY.partial one under way, KEY.failed.json what went wrong."""

    def __init__(self, out):
        self.out = Path(out)
        self._cases = self.out / "cases"

    def create(self):
        """Raises OSError if the folder cannot be written."""
        self._cases.mkdir(parents=True, exist_ok=True)

    def finished(self, case):
        return (self._cases / case.key / RESULTS).is_file()

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
        except FileNotFoundError:
            return None

    def results(self, case):
        return json.loads((self._cases / case.key / RESULTS).read_text(encoding="utf-8"))

    def _failure_path(self, case):
        return self._cases / f"{case.key}.failed.json"


def write(path, value):
    """Writes JSON so that the file is there whole or not at all."""
    partial = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        partial.write_text(json.dumps(value, indent=1) + "\n", encoding="utf-8")
        partial.replace(path)
    finally:
        partial.unlink(missing_ok=True)
