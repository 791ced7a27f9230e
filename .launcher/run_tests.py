"""Runs the parts of the test suite, two at a time, sums what their JUnit files say, and prints the sum last.

A part that crashes, hangs or runs no test counts as a failure.
"""
import argparse
import concurrent.futures
import itertools
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import threading
import time
import xml.etree.ElementTree as ElementTree
from dataclasses import asdict, dataclass, field

SOURCE = pathlib.Path(__file__).resolve().parent.parent
PARTS = ("lint", "physics", "native", "python", "blender", "window")
# Most suites keep one core busy, so two run side by side: the longest first, last what shares its work out by itself.
LANES = 2
ORDER = ("python", "window", "blender", "native", "physics", "lint")
FATAL = "Fatal Python error"
MOST_CALLS = 8  # of a crash
LIMIT = 50 * 60  # seconds for one suite; only a hang takes so long


@dataclass
class Suite:
    """One process that writes one JUnit file."""
    name: str
    command: list
    environment: dict = field(default_factory=dict)


@dataclass
class Result:
    name: str
    passed: int = 0
    failed: int = 0
    skipped: int = 0
    seconds: float = 0.0
    failures: list = field(default_factory=list)  # [(test, first lines of what it said)]


def google_tests(part, folder, environment):
    """One suite for each GoogleTest executable of a build folder; their names end in _tests."""
    executables = sorted(path for path in folder.glob("*_tests") if os.access(path, os.X_OK))
    names = {path: path.name.replace("mesograin_", "").replace("_tests", "") for path in executables}
    return [Suite(part if names[path] in part else f"{part}, {names[path]}", [str(path), "--gtest_output=xml:{junit}"],
                  environment) for path in executables]


def pytest_suite(part, python, folder):
    return Suite(part, [python, "-m", "pytest", "-q", "-p", "no:cacheprovider", str(folder), "--junitxml={junit}"])


def suites_of(part, options):
    """The suites that make up a part; an empty list when there is nothing to run."""
    build = pathlib.Path(options.build)
    if part == "lint":
        return [pytest_suite("lint", options.python, SOURCE / "tests/lint")]
    if part == "physics":
        return [suite for room in ("physics", "transport", "heap", "referee")
                for suite in google_tests(part, build / "tests" / room, {})]
    if part == "native":
        strict = {"ASAN_OPTIONS": "detect_leaks=1:detect_stack_use_after_return=1",
                  "UBSAN_OPTIONS": "print_stacktrace=1"}
        plain = google_tests(part, build / "tests/native", {})
        sanitized = google_tests("native, sanitized", SOURCE / "build/sanitize/tests/native", strict)
        return plain + sanitized
    if part == "python":
        return [pytest_suite("python", options.python, SOURCE / "tests/python")]
    if part == "blender":
        return [Suite(f"blender {options.blender_version}", [
            options.blender, "--background", "--factory-startup", "--python-exit-code", "1",
            "--python", str(SOURCE / "tests/blender/run.py"), "--", "--junitxml={junit}"])]
    window = pytest_suite("window", options.python, SOURCE / "tests/window")
    window.name += f" {options.blender_version}"
    return [window]


def read_junit(path, result):
    """Adds what a JUnit file says to a result; False when there is no readable file."""
    try:
        cases = list(ElementTree.parse(path).getroot().iter("testcase"))
    except (OSError, ElementTree.ParseError):
        return False
    for case in cases:
        complaint = case.find("failure")
        if complaint is None:
            complaint = case.find("error")
        if complaint is not None:
            result.failed += 1
            text = (complaint.get("message") or "") + "\n" + (complaint.text or "")
            result.failures.append((f"{case.get('classname')}.{case.get('name')}", text.strip()))
        elif case.find("skipped") is not None or case.get("status") == "notrun":
            result.skipped += 1
        else:
            result.passed += 1
    return True


class Runner:
    def __init__(self, options):
        self.options = options
        self.results = []
        self.folder = pathlib.Path(options.results)
        shutil.rmtree(self.folder, ignore_errors=True)
        self.folder.mkdir(parents=True)
        self.children = []
        self.speaking = threading.Lock()
        self.interrupted = False

    def execute(self, command, log_path, environment):
        """Runs one process in a session of its own, so that whatever it started ends with it."""
        variables = dict(os.environ, MESOGRAIN_BLENDER=self.options.blender, MESOGRAIN_BUILD=self.options.build,
                         **environment)
        with open(log_path, "wb") as log:
            child = subprocess.Popen(command, cwd=SOURCE, env=variables, stdin=subprocess.DEVNULL, stdout=log,
                                     stderr=subprocess.STDOUT, start_new_session=True)
            self.children.append(child)
            try:
                if self.interrupted:
                    return None
                return child.wait(timeout=LIMIT)
            except subprocess.TimeoutExpired:
                return f"no end after {LIMIT // 60} minutes"
            finally:
                self.end(child)
                self.children.remove(child)

    @staticmethod
    def end(child):
        try:
            os.killpg(child.pid, signal.SIGKILL)
        except ProcessLookupError:
            pass

    def interrupt(self):
        """Ends every suite that runs, and each that would begin."""
        self.interrupted = True
        for child in list(self.children):
            self.end(child)

    def run_suite(self, suite):
        stem = "".join(letter if letter.isalnum() or letter in "._" else "-" for letter in suite.name)
        junit, log = self.folder / f"{stem}.xml", self.folder / f"{stem}.log"
        result = Result(suite.name)
        start = time.monotonic()
        code = self.execute([part.replace("{junit}", str(junit)) for part in suite.command], log, suite.environment)
        if self.interrupted:
            return
        result.seconds = time.monotonic() - start
        readable = read_junit(junit, result)
        if code != 0 and result.failed == 0:
            how = f"ended by signal {-code}" if isinstance(code, int) and code < 0 else f"exit code {code}"
            result.failed += 1
            result.failures.append((suite.name, f"{how}\n{last_words(log)}"))
        elif not readable or result.passed + result.failed == 0:
            result.failed += 1
            result.failures.append((suite.name, f"ran no test\n{tail(log)}"))
        self.report(result, log)

    def run_parts(self, parts):
        """Runs every suite of these parts."""
        suites = [suite for part in ORDER if part in parts for suite in self.suites_of(part)]
        with concurrent.futures.ThreadPoolExecutor(LANES) as pool:
            try:
                for done in [pool.submit(self.run_suite, suite) for suite in suites]:
                    done.result()
            except KeyboardInterrupt:
                self.interrupt()
                raise

    def suites_of(self, part):
        suites = suites_of(part, self.options)
        if not suites:
            self.report(Result(part, failed=1, failures=[(part, "has no test to run")]), None)
        return suites

    def add_run(self, title, path):
        """Adds the results of a run that has already ended, in the Debian of this title; returns the Blender it ran."""
        try:
            run = json.loads(pathlib.Path(path).read_text())
        except (OSError, ValueError) as error:
            self.report(Result(title, failed=1, failures=[(title, f"left no summary: {error}")]), None)
            return None
        for fields in run["results"]:
            result = Result(**fields)
            result.name += f" in {title}" if run["blender"] not in result.name else ""
            self.report(result, path)
        return run["blender"]

    def report(self, result, log):
        with self.speaking:
            self.say(result, log)
            self.results.append(result)

    @staticmethod
    def say(result, log):
        counts = f"{result.passed} passed" + (f", {result.failed} failed" if result.failed else "") + (
            f", {result.skipped} skipped" if result.skipped else "")
        print(f"{result.name:<44}{counts:<40}{result.seconds:6.1f} s", flush=True)
        for test, text in result.failures:
            print(f"  FAILED {test}")
            for line in telling(text):
                print(f"    {line}")
        if result.failures and log:
            print(f"  the whole log: {log}", flush=True)


def telling(text, count=12):
    """The lines of a failure worth a look: the message, then what pytest marks with E, or else how it begins."""
    lines = text.splitlines()
    marked = [line for line in lines[1:] if line.startswith("E ")]
    return (lines[:1] + marked if marked else lines)[:count]


def last_words(path):
    """Of a process that a signal ended: where Python was, innermost call first, down to the test; else a log's end."""
    lines = read_lines(path)
    begun = [number for number, line in enumerate(lines) if FATAL in line]  # after pytest's dots
    if not begun:
        return tail(path)
    died = lines[begun[-1]:]
    # Other threads may stand before the one that died.
    at = next((number for number, line in enumerate(died) if line.startswith("Current thread")), 0)
    calls = list(itertools.takewhile(lambda line: line.startswith("  ") and "/_pytest/" not in line, died[at + 1:]))
    if len(calls) > MOST_CALLS:
        calls = [*calls[:MOST_CALLS - 2], "  ...", calls[-1]]
    return "\n".join([died[0][died[0].index(FATAL):], *died[at:at + 1], *calls])


def tail(path, count=30):
    """The last lines of a log."""
    return "\n".join(read_lines(path)[-count:])


def read_lines(path):
    try:
        return path.read_text(errors="replace").splitlines()
    except OSError:
        return []


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    for name in ("--build", "--python", "--blender", "--blender-version", "--results"):
        parser.add_argument(name, required=True)
    parser.add_argument("--also", metavar="TITLE=SUMMARY", action="append", default=[],
                        help="summary.json of a run in another Debian, to be summed with this")
    parser.add_argument("parts", nargs="+", choices=PARTS)
    options = parser.parse_args()
    runner = Runner(options)
    # Started in a shell's background, Ctrl-C is ignored, and so it would be in every process that a test starts.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        runner.run_parts(options.parts)
        versions = [options.blender_version]
        versions += filter(None, [runner.add_run(*also.split("=", 1)) for also in options.also])
    except KeyboardInterrupt:
        print("\nmesograin: interrupted", file=sys.stderr)
        return 130
    return summarise(runner, options, versions)


def summarise(runner, options, versions):
    print()
    ran_blender = any(part in options.parts for part in ("blender", "window"))
    print(f"Blender run: {', '.join(versions) if ran_blender else 'none'}", end="")
    families = {version.split(".")[0] for version in versions} if ran_blender else set()
    missing = [f"{family}.x" for family in ("3", "4", "5") if family not in families]
    print(f"; not run: {', '.join(missing)}." if missing else ".")
    for family, name in (("4", "Blender 4.3"), ("5", "Blender 5 of Debian sid")):
        if family not in families and ran_blender:
            print(f"./mesograin test --blender-{family} also runs {name}.")
    passed, failed, skipped = (sum(getattr(result, name) for result in runner.results)
                               for name in ("passed", "failed", "skipped"))
    summary = {"blender": options.blender_version, "versions": versions, "passed": passed, "failed": failed,
               "skipped": skipped, "results": [asdict(result) for result in runner.results]}
    (runner.folder / "summary.json").write_text(json.dumps(summary, indent=1))
    print(f"{passed} passed, {failed} failed" + (f", {skipped} skipped" if skipped else ""))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
