# References that were rendered once, kept in a folder of bounded size: the longest unused go first.
"""See `Cache`."""

import contextlib
import os
import time
from pathlib import Path

DEFAULT_LIMIT = 2 * 1024**3
"""Bytes."""


def default_folder():
    """`MESOGRAIN_CACHE`, else mesograin/references in the user's cache folder."""
    chosen = os.environ.get("MESOGRAIN_CACHE")
    if chosen:
        return Path(chosen)
    base = os.environ.get("XDG_CACHE_HOME") or os.path.join(os.path.expanduser("~"), ".cache")
    return Path(base) / "mesograin" / "references"


def default_limit():
    """`MESOGRAIN_CACHE_LIMIT` (bytes), else `DEFAULT_LIMIT`. Raises ValueError with a sentence."""
    chosen = os.environ.get("MESOGRAIN_CACHE_LIMIT")
    if not chosen:
        return DEFAULT_LIMIT
    if not chosen.isdigit():
        raise ValueError(f"MESOGRAIN_CACHE_LIMIT must be a whole number of bytes; got '{chosen}'.")
    return int(chosen)


class Cache:
    """A folder of EXR files named by the key of what they show. Several processes may share it.

    folder: Path, made when the first file is stored. limit: bytes that all files together may take.
    """

    SUFFIX = ".exr"
    UNFINISHED = ".*.tmp"
    """What a process that was killed while it wrote leaves; none takes as long as UNFINISHED_SECONDS."""
    UNFINISHED_SECONDS = 24 * 3600.0

    def __init__(self, folder=None, limit=None):
        self.folder = Path(folder) if folder else default_folder()
        self.limit = default_limit() if limit is None else limit

    def path(self, key):
        """Where the file of this key is or would be."""
        return self.folder / (key + self.SUFFIX)

    def find(self, key):
        """The path of a stored file, marked as just used; None if there is none."""
        path = self.path(key)
        try:
            os.utime(path)
        except OSError:
            return None
        return path

    def store(self, key, write):
        """Has `write(path)` put a file there (by atomic rename), then trims. Raises OSError without a folder."""
        self.folder.mkdir(parents=True, exist_ok=True)
        path = self.path(key)
        write(path)
        self.trim()
        return path

    def forget(self, key):
        """Removes a file, if it is there and can be removed: one that turned out unreadable."""
        with contextlib.suppress(OSError):
            self.path(key).unlink()

    def files(self):
        """[(time of last use, bytes, path)], longest unused first; files that vanish meanwhile are left out."""
        found = []
        if self.folder.is_dir():
            for path in self.folder.glob("*" + self.SUFFIX):
                try:
                    status = path.stat()
                except OSError:
                    continue
                found.append((status.st_mtime, status.st_size, path))
        return sorted(found)

    def size(self):
        """Bytes in use."""
        return sum(size for _, size, _ in self.files())

    def trim(self):
        """Removes the longest unused files until the rest fit the limit; returns how many. The newest stays. What
        killed processes left goes, too."""
        for path in self.folder.glob(self.UNFINISHED):
            with contextlib.suppress(OSError):
                if path.stat().st_mtime < time.time() - self.UNFINISHED_SECONDS:
                    path.unlink()
        files = self.files()
        excess = sum(size for _, size, _ in files) - self.limit
        removed = 0
        for _, size, path in files[:-1]:
            if excess <= 0:
                break
            path.unlink(missing_ok=True)
            excess -= size
            removed += 1
        return removed

    def clear(self):
        """Removes every file; returns (how many, bytes)."""
        files = self.files()
        for _, _, path in files:
            path.unlink(missing_ok=True)
        return len(files), sum(size for _, size, _ in files)
