# A background process with work to do: watched, cancelled at once, its files published whole or not at all.
"""See `Job`. Knows nothing of Blender, so that it can be tested with any process.

Nothing here is done by a thread: before Python 3.12 Blender's operators take another thread's hold of the interpreter
for their own, and crash now and then. Whoever started a job looks at it a few times a second.
"""

import collections
import contextlib
import os
import shutil
import signal
import subprocess
import tempfile
import time
from pathlib import Path

from ..comparison.progress import Step
from . import protocol

RUNNING, DONE, FAILED, CANCELLED = "running", "done", "failed", "cancelled"
PATIENCE_SECONDS = 2.0
"""What a cancelled process is given to end by itself, before it is killed."""
LOOK_SECONDS = 0.02
"""How often `Job.wait` looks."""
OVERDUE_SECONDS = 2.0
"""How much longer than it was told a step may take, before the guess is no longer told."""
MOST_READ = 1 << 16
NICENESS = 10
"""How much further back a job's process stands than Blender, whose window answers while Cycles takes every core."""


class Job:
    """command: of a process that prints protocol events and writes its files to `staging`.

    folder: its temporary files, made by the caller; gone when the job ends. out: where its files go when it is done;
    other files there stay. It goes on when it is looked at, until it is `over`. Raises OSError if `out` cannot be
    written.
    """

    def __init__(self, folder, out):
        self.folder = Path(folder)
        self.out = Path(out)
        self.state = RUNNING
        self.step = None
        self.sentences = []
        self.error = ""
        self.changes = 0
        """Goes up whenever there is something new to show."""
        self._made_out = not self.out.exists()
        self.out.mkdir(parents=True, exist_ok=True)
        # On the same file system, so that a finished file is renamed and never copied.
        self.staging = Path(tempfile.mkdtemp(prefix=".unfinished-", dir=self.out))
        self.over = False
        """Whether the process and what it left are gone."""
        self._told = 0.0  # when the step was
        self._lines = collections.deque(maxlen=40)
        self._process = None
        self._read = b""  # of a line whose end is not there yet
        self._finished = False
        self._kill_at = None

    def start(self, command, environment=None):
        """Runs the command in a process group of its own; it may end itself when its standard input ends, which is
        when this process does."""
        environment = {**(os.environ if environment is None else environment), "TMPDIR": str(self.folder)}
        try:
            self._process = subprocess.Popen(command, env=environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                             stderr=subprocess.STDOUT, start_new_session=True)
        except OSError as error:
            self._end(FAILED, f"{command[0]} cannot be run ({error.strerror}).")
            return
        os.set_blocking(self._process.stdout.fileno(), False)
        # At once, since only threads started later inherit it; a process that has already ended needs none.
        with contextlib.suppress(ProcessLookupError):
            own = os.getpriority(os.PRIO_PROCESS, 0)
            os.setpriority(os.PRIO_PROCESS, self._process.pid, min(own + NICENESS, 19))

    @property
    def running(self):
        return self.state == RUNNING

    @property
    def fraction(self):
        """How much is done, 0 to 1, all steps alike."""
        step = self.step
        return (step.number - 1 + step.fraction) / step.count if step and step.count else 0.0

    @property
    def seconds_left(self):
        """None before the first step, and where the last one takes longer than was told."""
        if self.step is None:
            return None
        left = self.step.seconds_left - (time.monotonic() - self._told)
        return max(left, 0.0) if left > -OVERDUE_SECONDS else None

    @property
    def unknown(self):
        """What is said where `seconds_left` is None."""
        return "Longer than guessed" if self.step else "Blender is starting"

    def cancel(self):
        """Ends the job; its state says so at once. Looked at, its process and files are gone PATIENCE_SECONDS later."""
        if self.state != RUNNING:
            return
        self.state = CANCELLED
        self.changes += 1
        self._kill_at = time.monotonic() + PATIENCE_SECONDS
        self._signal(signal.SIGTERM)
        self.look()

    def wait(self, timeout=None):
        """Looks until the job is over, if `timeout` seconds are given at most so long; whether it is."""
        deadline = None if timeout is None else time.monotonic() + timeout
        while not self.look() and (deadline is None or time.monotonic() < deadline):
            time.sleep(LOOK_SECONDS)
        return self.over

    def look(self):
        """Takes what the process has said, and does what is due. Returns at once: whether the job is over."""
        if self.over:
            return True
        ended = self._process.poll() is not None  # asked first: what it said last is there by then
        self._listen()
        if ended:
            self._conclude(self._process.returncode)
        elif self._kill_at is not None and time.monotonic() >= self._kill_at:
            self._signal(signal.SIGKILL)
        return self.over

    def _signal(self, number):
        with contextlib.suppress(ProcessLookupError):
            os.killpg(self._process.pid, number)

    def _listen(self):
        with contextlib.suppress(BlockingIOError):
            while said := os.read(self._process.stdout.fileno(), MOST_READ):
                *lines, self._read = (self._read + said).split(b"\n")
                for line in lines:
                    self._hear(line)

    def _hear(self, line):
        event = protocol.decode(line)
        if event is not None:
            self._take(event)
        elif line.strip():
            self._lines.append(line.decode("utf-8", "replace").strip())

    def _conclude(self, code):
        if self.state == CANCELLED:
            self._signal(signal.SIGKILL)  # for what the process started itself
        self._hear(self._read)
        self._process.stdin.close()
        self._process.stdout.close()
        if self.state != RUNNING or not self._finished or code != 0:
            self._end(FAILED, self.error or self._why(code))
            return
        try:
            self._publish()
        except OSError as error:
            self._end(FAILED, f"The results cannot be put into {self.out} ({error.strerror}): choose another.")
            return
        self._end(DONE)

    def _take(self, event):
        if event["event"] == "step":
            self.step = Step(**{name: value for name, value in event.items() if name != "event"})
            self._told = time.monotonic()
        elif event["event"] == "sentence":
            self.sentences.append(event["text"])
        elif event["event"] == "failed":
            self.error = event["text"]
        elif event["event"] == "done":
            self._finished = True
        self.changes += 1

    def _end(self, state, error=""):
        self._clean()
        if self.state == RUNNING:
            self.state, self.error = state, error
        self.over = True
        self.changes += 1

    def _why(self, code):
        how = f"was ended by signal {-code}" if code < 0 else f"ended with exit code {code}"
        last = f"; it last said: {self._lines[-1]}" if self._lines else ""
        return f"The background Blender {how}{last}."

    def _publish(self):
        for path in sorted(self.staging.rglob("*")):
            target = self.out / path.relative_to(self.staging)
            if path.is_dir():
                target.mkdir(exist_ok=True)
            else:
                os.replace(path, target)

    def _clean(self):
        shutil.rmtree(self.folder, ignore_errors=True)
        shutil.rmtree(self.staging, ignore_errors=True)
        if self._made_out:
            with contextlib.suppress(OSError):
                self.out.rmdir()  # stays if there is anything in it
