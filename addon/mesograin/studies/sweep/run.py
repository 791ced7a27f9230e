# Runs a sweep's cases, each in a Blender of its own, several side by side.
"""See `run`."""
import concurrent.futures
import os
import queue
import signal
import threading
import time
from pathlib import Path

from ...command_line import batch
from ...durations import duration

COMPARE = Path(__file__).resolve().parents[1] / "comparison" / "command.py"


class Interrupted(Exception):
    """Ctrl-C: the cases under way are given up, the finished ones stay."""


def arguments(case, out):
    """The words after `--` that make `compare` do this case, written to the folder `out`."""
    words = ["--models", case.model, "--references", case.reference, "--out", str(out), "--no-report"]
    for name, value in case.settings:
        if name == "size":
            width, height = value if isinstance(value, list) else (value, value)
            words += ["--size", f"{width}x{height}"]
        elif value is True:
            words.append(f"--{name}")
        else:
            words += [f"--{name.replace('_', '-')}", str(value)]
    for name, value in case.parameters:
        text = ",".join(repr(channel) for channel in value) if isinstance(value, list) else str(value)
        words += ["--set", f"{name}={text}"]
    return words


def run(plan, groups, folder, blender, jobs=1, tell=print):
    """Runs those of the plan's cases in `groups` that have no result yet; returns (how many ran, how many failed).

    groups: of case indices; the cases of one run one after the other, since the first renders the reference that the
    others find in the cache, and `jobs` groups side by side. A case that fails is recorded in `folder` and the rest go
    on; it is tried again by the next run. tell: called with a line after each case.
    Raises Interrupted after Ctrl-C, once every Blender is gone.
    """
    waiting = [[plan.cases[index] for index in group if not folder.finished(plan.cases[index])] for group in groups]
    count, asked = sum(map(len, waiting)), sum(map(len, groups))
    if count < asked:
        tell(f"{asked - count} of {asked} cases are there already")
    processes = _Processes()
    pace = _Pace(count, jobs)
    outcomes = queue.SimpleQueue()

    def run_group(cases):
        for case in cases:
            outcomes.put(_run_case(case, folder, blender, processes))

    failed = 0
    with concurrent.futures.ThreadPoolExecutor(max_workers=jobs, thread_name_prefix="mesograin-sweep") as pool:
        futures = [pool.submit(_hand_over, run_group, cases, outcomes) for cases in waiting]
        try:
            for _ in range(count):
                outcome = outcomes.get()
                if isinstance(outcome, BaseException):
                    raise outcome
                case, seconds, sentence = outcome
                failed += sentence is not None
                tell(f"{pace.step(seconds)} {case.label}: {'done' if sentence is None else f'failed: {sentence}'}")
        except BaseException as error:
            for future in futures:
                future.cancel()
            processes.end()
            if isinstance(error, KeyboardInterrupt):
                raise Interrupted from None
            raise
    return count, failed


def _hand_over(work, cases, outcomes):
    """What goes wrong in a worker, such as a full disk, ends the sweep in its own thread."""
    try:
        work(cases)
    except BaseException as error:
        outcomes.put(error)


def _run_case(case, folder, blender, processes):
    started = time.monotonic()
    with folder.alone_with(case, processes.go_on):
        sentence = None
        if not folder.finished(case):  # another sweep may have done it meanwhile
            out = folder.begin(case)
            code, log = processes.run(blender, COMPARE, [case.scene, *arguments(case, out)])
            sentence = _complaint(case, code, log)
            if sentence is None:
                folder.finish(case)
            else:
                folder.fail(case, sentence, code)
    return case, time.monotonic() - started, sentence


def _complaint(case, code, log):
    """Why a case has no result, one sentence, or None."""
    said = _last_line(log)
    if code < 0:
        why = ", as the system does when memory runs out" if code == -signal.SIGKILL else ""
        return f"Blender was ended by signal {-code}{why}" + (f"; it last said: {said}" if said else "")
    if code > 0:
        return said or f"Blender ended with exit code {code} and said nothing"
    if case.scene_changed():
        return f"the scene {case.scene} was saved or moved meanwhile: run the sweep again"
    return None


def _last_line(log):
    said_by_blender = ("Blender quit", "Error: script failed")
    lines = [line.strip() for line in log.splitlines() if line.strip() and not line.startswith(said_by_blender)]
    return lines[-1] if lines else ""


class _Pace:
    def __init__(self, total, jobs):
        self.total, self.jobs, self.done, self.seconds = total, jobs, 0, 0.0

    def step(self, seconds):
        """'[3/12, about 40 s left]'."""
        self.done += 1
        self.seconds += seconds
        left = self.seconds / self.done * (self.total - self.done) / self.jobs
        return f"[{self.done}/{self.total}, about {duration(left)} left]"


class _Processes:
    """Blenders that run, so that ending the sweep ends every one of them."""

    def __init__(self):
        self._running = set()
        self._lock = threading.Lock()
        self._ended = False

    def go_on(self):
        """Raises Interrupted once the sweep has ended."""
        if self._ended:
            raise Interrupted

    def run(self, blender, script, words):
        with self._lock:
            self.go_on()
            process = batch.start(blender, script, words)
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
