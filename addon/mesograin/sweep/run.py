# Runs a sweep's cases, each in a Blender of its own, several side by side.
"""See `run`."""
import concurrent.futures
import os
import signal
import subprocess
import threading
import time
from pathlib import Path

COMPARE = Path(__file__).resolve().parents[1] / "comparison" / "command.py"


class Interrupted(Exception):
    """Ctrl-C: the cases under way are given up, the finished ones stay."""


def arguments(case, out):
    """The words after `--` that make `compare` do this case, written to the folder `out`."""
    words = ["--models", case.model, "--out", str(out), "--no-report"]
    if case.reference:
        words += ["--references", case.reference]
    for name, value in case.settings:
        if name == "size":
            width, height = value if isinstance(value, list) else (value, value)
            words += ["--size", f"{width}x{height}"]
        else:
            words += [f"--{name.replace('_', '-')}", str(value)]
    for name, value in case.parameters:
        text = ",".join(repr(channel) for channel in value) if isinstance(value, list) else str(value)
        words += ["--set", f"{name}={text}"]
    return words


def command(blender, case, out):
    return [
        blender,
        "--background",
        "--factory-startup",
        "--python-exit-code",
        "1",
        "--python",
        str(COMPARE),
        "--",
        case.scene,
        *arguments(case, out),
    ]


def run(cases, folder, blender, jobs=1, tell=print):
    """Runs those of `cases` that have no result yet; returns (how many ran, how many failed).

    A case that fails is recorded in `folder` and the rest go on; it is tried again by the next run.
    tell: called with a line after each case. Raises Interrupted after Ctrl-C, once every Blender is gone.
    """
    waiting = [case for case in cases if not folder.finished(case)]
    if len(waiting) < len(cases):
        tell(f"{len(cases) - len(waiting)} of {len(cases)} cases are there already")
    processes = _Processes()
    pace = _Pace(len(waiting), jobs)
    failed = 0
    with concurrent.futures.ThreadPoolExecutor(max_workers=jobs, thread_name_prefix="mesograin-sweep") as pool:
        futures = [pool.submit(_run_case, case, folder, blender, processes) for case in waiting]
        try:
            for future in concurrent.futures.as_completed(futures):
                case, seconds, sentence = future.result()
                failed += sentence is not None
                outcome = "done" if sentence is None else f"failed: {sentence}"
                tell(f"{pace.step(seconds)} {case.label}: {outcome}")
        except KeyboardInterrupt:
            for future in futures:
                future.cancel()
            processes.end()
            raise Interrupted from None
    return len(waiting), failed


def _run_case(case, folder, blender, processes):
    started = time.monotonic()
    out = folder.begin(case)
    code, log = processes.run(command(blender, case, out))
    if code == 0:
        folder.finish(case)
        sentence = None
    else:
        sentence = _last_line(log) or f"Blender ended with exit code {code} and said nothing"
        folder.fail(case, sentence, code)
    return case, time.monotonic() - started, sentence


def _last_line(log):
    lines = [line.strip() for line in log.splitlines() if line.strip() and not line.startswith("Blender quit")]
    return lines[-1] if lines else ""


class _Pace:
    def __init__(self, total, jobs):
        self.total, self.jobs, self.done, self.seconds = total, jobs, 0, 0.0

    def step(self, seconds):
        """'[3/12, about 40 s left]'."""
        self.done += 1
        self.seconds += seconds
        left = round(self.seconds / self.done * (self.total - self.done) / self.jobs)
        text = f"{left} s" if left < 60 else f"{left // 60} min {left % 60:02d} s"
        return f"[{self.done}/{self.total}, about {text} left]"


class _Processes:
    """Children in sessions of their own, so that ending the sweep ends every one of them."""

    def __init__(self):
        self._running = set()
        self._lock = threading.Lock()
        self._ended = False

    def run(self, words):
        with self._lock:
            if self._ended:
                return -signal.SIGINT, "interrupted"
            process = subprocess.Popen(
                words,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                text=True,
                errors="replace",
                start_new_session=True,
            )
            self._running.add(process)
        try:
            log, _ = process.communicate()
        finally:
            with self._lock:
                self._running.discard(process)
        return process.returncode, log

    def end(self):
        with self._lock:
            self._ended = True
            for process in self._running:
                os.killpg(process.pid, signal.SIGTERM)
