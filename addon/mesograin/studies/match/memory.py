# What each render came to, kept on disk, so that a search that was stopped goes on where it was.
"""See `Memory`. A search takes the same way again from the same start: what it asks for is then known already."""

import contextlib
import json

import numpy


class Memory:
    """Means in blocks of renders, {what was rendered: means}. path: of a file with a line for each, or None for none.
    fingerprint: of all else that they depend on; what was kept of others is given up."""

    def __init__(self, path, fingerprint):
        self._path, self._fingerprint = path, fingerprint
        self._known = {}
        if path is not None:
            self._read()

    def __len__(self):
        return len(self._known)

    def get(self, key):
        """(3, n) or None."""
        return self._known.get(key)

    def add(self, key, means):
        self._known[key] = means
        if self._path is None:
            return
        with contextlib.suppress(OSError):  # it is remembered until the end, if no longer
            with open(self._path, "a", encoding="utf-8") as file:
                file.write(json.dumps({"key": key, "means": means.tolist()}) + "\n")

    def _read(self):
        first = {"fingerprint": self._fingerprint}
        try:
            lines = self._path.read_text(encoding="utf-8").splitlines()
            if json.loads(lines[0]) == first:
                for line in lines[1:]:
                    entry = json.loads(line)
                    self._known[entry["key"]] = numpy.array(entry["means"])
                return
        except (OSError, ValueError, KeyError, IndexError, TypeError):
            pass  # nothing there, or nothing of ours, or its last line is half: it is begun anew from here
        if not self._known:
            with contextlib.suppress(OSError):
                self._path.write_text(json.dumps(first) + "\n", encoding="utf-8")
