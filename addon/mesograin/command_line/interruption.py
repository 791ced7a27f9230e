# Ctrl-C ends a comparison at once, even while Cycles keeps the main thread busy, and leaves no half file behind.
"""See `Interruption`."""

import os
import shutil
import signal
import sys
import tempfile
import threading
from pathlib import Path

from ..cycles.console import Console

SIGNALS = (signal.SIGINT, signal.SIGTERM)


class Interruption:
    """A context manager for a process of its own. Inside, temporary files live in one folder, and a signal either
    raises KeyboardInterrupt in Python code, or, while Cycles renders, removes that folder and ends the process with 128
    + signal.

    `code`: the exit code for a KeyboardInterrupt that arrived.
    """

    def __init__(self):
        self.code = 128 + signal.SIGINT

    def __enter__(self):
        self._folder = Path(tempfile.mkdtemp(prefix="mesograin-"))
        self._before = tempfile.tempdir
        tempfile.tempdir = str(self._folder)
        reading, writing = os.pipe()
        os.set_blocking(writing, False)
        for number in SIGNALS:
            signal.signal(number, self._interrupt)
        # The signal's number arrives here even while the main thread is away from Python.
        signal.set_wakeup_fd(writing, warn_on_full_buffer=False)
        threading.Thread(target=self._watch, args=(reading,), daemon=True).start()
        return self

    def raise_missed(self):
        """Raises KeyboardInterrupt for a signal that came while Blender started, as whoever passes signals on says."""
        asked = os.environ.get("MESOGRAIN_INTERRUPTED")
        if asked and os.path.exists(asked):
            raise KeyboardInterrupt

    def __exit__(self, *_):
        signal.set_wakeup_fd(-1)
        tempfile.tempdir = self._before
        shutil.rmtree(self._folder, ignore_errors=True)

    def _interrupt(self, number, _):
        self.code = 128 + number
        raise KeyboardInterrupt

    def _watch(self, reading):
        number = os.read(reading, 1)[0]
        self.code = 128 + number
        while True:
            with Console.gate:
                # Holding the gate keeps the main thread inside Cycles, so nothing else is being written.
                if Console.active:
                    shutil.rmtree(self._folder, ignore_errors=True)
                    sys.stderr.write(f"\n{INTERRUPTED}\n")
                    sys.stderr.flush()
                    os._exit(self.code)
            threading.Event().wait(0.05)


INTERRUPTED = "Interrupted: what was finished is kept, and the next run finds its references in the cache."
