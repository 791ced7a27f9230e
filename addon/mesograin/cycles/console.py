# What Cycles prints or tells while it renders, taken off the terminal and read for its progress.
"""See `Console`."""

import collections
import os
import re
import sys
import threading

import bpy

from .. import compat

_SAMPLE = re.compile(r"Sample (\d+)/(\d+)")


class Console:
    """A context manager that diverts the process's standard output and calls `on_progress(fraction)` from a thread.

    `lines`: the last lines diverted, for a message when something failed.
    """

    gate = threading.RLock()
    """Held while a diversion begins or ends: who holds it can rely on `active`."""

    active = False
    """Whether Cycles is rendering: the main thread is out of Python's reach and writes nothing but temporary files."""

    def __init__(self, on_progress=None):
        self._on_progress = on_progress
        self.lines = collections.deque(maxlen=20)
        self._handler = self._listen  # one object: what is removed must be what was appended

    def __enter__(self):
        sys.stdout.flush()
        self._saved = os.dup(1)
        reading, writing = os.pipe()
        os.dup2(writing, 1)
        os.close(writing)
        self._thread = threading.Thread(target=self._read, args=(reading,), daemon=True)
        self._thread.start()
        if not compat.has_printed_statistics():
            bpy.app.handlers.render_stats.append(self._handler)
        with Console.gate:
            Console.active = True
        return self

    def __exit__(self, *_):
        with Console.gate:
            Console.active = False
        if self._handler in bpy.app.handlers.render_stats:
            bpy.app.handlers.render_stats.remove(self._handler)
        sys.stdout.flush()
        os.dup2(self._saved, 1)  # closes the pipe's last writing end
        os.close(self._saved)
        self._thread.join()

    def _read(self, reading):
        with os.fdopen(reading, "rb") as pipe:
            for line in pipe:
                text = line.decode("utf-8", "replace").rstrip()
                self._tell(text)
                self.lines.append(text)

    def _listen(self, text, *_):
        self._tell(text)

    def _tell(self, text):
        found = _SAMPLE.search(text)
        if found and self._on_progress:
            done, total = (int(number) for number in found.groups())
            self._on_progress(done / max(total, 1))
