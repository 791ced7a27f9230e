"""The launcher answers for itself: help for every command, one sentence and an exit code for what is wrong."""
import json
import os
import pathlib
import re
import subprocess
import sys
import textwrap
import zipfile

import pytest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
COMMANDS = ("compare", "trade", "sweep", "render", "bake", "match", "test", "bench", "pictures", "build", "package",
            "install")


def launcher(*arguments, folder=SOURCE, **environment):
    return subprocess.run([str(SOURCE / "mesograin"), *map(str, arguments)], cwd=folder, capture_output=True, text=True,
                          stdin=subprocess.DEVNULL, env=dict(os.environ, **environment))


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_has_help(command, tmp_path):
    outcome = launcher(command, "--help", folder=tmp_path)
    assert outcome.returncode == 0
    assert f"./mesograin {command}" in outcome.stdout
    assert launcher("help", command).stdout == outcome.stdout
    assert re.search(rf"^  {command} ", launcher("help").stdout, re.MULTILINE)


@pytest.mark.parametrize("command", ["compare", "trade", "bake", "render"])
def test_help_lists_the_models_of_the_schema(command):
    schema = json.loads((SOURCE / "addon/mesograin/schema/grain.json").read_text())
    models = [model["name"] for model in schema["models"]]
    said = " ".join(launcher(command, "--help").stdout.split())
    assert ", ".join(models) in said or command == "trade" and "models to measure" in said


def test_help_needs_no_build(tmp_path):
    """Only the renderer's own options are not known before there is one."""
    for command in COMMANDS:
        outcome = launcher(command, "--help", MESOGRAIN_BUILD=tmp_path / "none")
        assert outcome.returncode == 0 and outcome.stdout and not outcome.stderr
    assert not (tmp_path / "none").exists()


@pytest.mark.parametrize("arguments, code, sentence", [
    ((), 2, "./mesograin COMMAND"),
    (("paint",), 2, "There is no command 'paint'"),
    (("help", "paint"), 2, "There is no help about 'paint'"),
    (("compare", "no such.blend"), 2, "there is no scene 'no such.blend'"),
    (("compare", "picture.png"), 2, "there is no scene 'picture.png'"),
    (("compare", "--blender"), 2, "--blender needs the path"),
    (("test", "everything"), 2, "there is no part 'everything'"),
    (("bench", "marks"), 2, "there is no benchmark 'marks'"),
    (("render",), 2, "a scene and an output are needed"),
    (("bake",), 2, "required: SCENE.blend, -o/--output"),
    (("bake", "no such.blend", "-o", "a.exr"), 2, "there is no scene 'no such.blend'"),
    (("match", "no such.json", "a.exr"), 2, "there is no scene 'no such.json'"),
    (("build", "--blender", "/no/such/blender"), 3, "There is no Blender at '/no/such/blender'"),
    (("build", "--blender", "/bin/true"), 3, "did not say which Python it embeds"),
])
def test_what_is_wrong_is_said_in_one_sentence(arguments, code, sentence, tmp_path):
    outcome = launcher(*arguments, folder=tmp_path)
    assert outcome.returncode == code
    assert sentence in outcome.stderr
    assert not arguments or len(outcome.stderr.splitlines()) == 1


class TestRunTests:
    """What the tests' runner makes of suites that end in every possible way."""

    @pytest.fixture
    def run(self, tmp_path, monkeypatch):
        sys.path.insert(0, str(SOURCE / ".launcher"))
        import argparse

        import run_tests

        options = argparse.Namespace(build="", blender="", results=str(tmp_path / "results"))

        def run_script(script):
            runner = run_tests.Runner(options)
            runner.run_suite(run_tests.Suite("suite", ["sh", "-c", script, "sh", "{junit}"]))
            return runner.results[0]

        def run_parts(scripts):
            monkeypatch.setattr(run_tests, "suites_of", lambda part, _options: [
                run_tests.Suite(part, ["sh", "-c", scripts[part], "sh", "{junit}"])])
            runner = run_tests.Runner(options)
            runner.run_parts(list(scripts))
            return {result.name: result for result in runner.results}

        run_script.parts = run_parts
        run_script.order = run_tests.ORDER
        yield run_script
        sys.path.remove(str(SOURCE / ".launcher"))

    def test_cases_are_counted_by_how_they_ended(self, run):
        result = run("""echo '<testsuites><testsuite><testcase name="a" classname="s"/><testcase name="b" classname="s">
            <failure message="two is not one"/></testcase><testcase name="c" classname="s"><skipped/></testcase>
            <testcase name="d" classname="s"><error message="broke"/></testcase>
            <testcase name="e" classname="s" status="notrun"/></testsuite></testsuites>' > "$1"; exit 1""")
        assert (result.passed, result.failed, result.skipped) == (1, 2, 2)
        assert result.failures == [("s.b", "two is not one"), ("s.d", "broke")]

    @pytest.mark.parametrize("script", [
        "kill -SEGV $$",
        "exit 0",
        "echo '<testsuites/>' > \"$1\"",
        "echo 'no xml' > \"$1\"",
        "echo '<testsuites><testcase name=\"a\"><skipped/></testcase></testsuites>' > \"$1\"",
        "echo '<testsuites><testcase name=\"a\"/></testsuites>' > \"$1\"; exit 3",
    ], ids=["crash", "nothing", "no test", "no file", "all skipped", "failed after its tests"])
    def test_a_suite_that_proves_nothing_failed(self, run, script):
        assert run(script).failed == 1

    def test_two_run_at_a_time(self, run, tmp_path):
        passes = """echo '<testsuites><testcase name="a"/></testsuites>' > "$1\""""
        meets = ("touch {own}; n=0; until [ -e {other} ]; do sleep 0.1; n=$((n + 1)); [ $n -lt 300 ] || exit 1; done; "
                 "sleep 0.5; touch {own}.ended; " + passes)
        first, second, third = run.order[:3]
        files = {part: tmp_path / part for part in (first, second, third)}
        results = run.parts({
            first: meets.format(own=files[first], other=files[second]),
            second: meets.format(own=files[second], other=files[first]),
            third: f"[ -e {files[first]}.ended ] || [ -e {files[second]}.ended ] && {passes}"})
        assert {name: (each.passed, each.failed) for name, each in results.items()} == dict.fromkeys(files, (1, 0))

    @pytest.mark.parametrize("depth", [2, 40])
    def test_a_crash_says_in_which_test_and_call(self, run, capsys, tmp_path, depth):
        (tmp_path / "test_it.py").write_text(textwrap.dedent(f"""
            import os, signal, threading, time

            def deep(left):
                deep(left - 1) if left else innermost()

            def innermost():
                os.kill(os.getpid(), signal.SIGSEGV)

            def test_that_crashes():
                threading.Thread(target=time.sleep, args=(9,), daemon=True).start()
                deep({depth})
            """))
        result = run(f"exec {sys.executable} -m pytest -p no:cacheprovider {tmp_path / 'test_it.py'}")
        assert result.failed == 1
        said = capsys.readouterr().out
        assert "ended by signal 11" in said and "Fatal Python error: Segmentation fault" in said
        frames = [line for line in said.splitlines() if "test_it.py\", line" in line]
        assert frames[0].endswith("in innermost") and frames[-1].endswith("in test_that_crashes"), said
        assert len(said.splitlines()) <= 15


def test_the_package_holds_what_blender_needs(tmp_path):
    archive = tmp_path / "folder" / "mesograin.zip"
    subprocess.run([sys.executable, str(SOURCE / ".launcher/package.py"), str(SOURCE), str(archive)], check=True)
    names = zipfile.ZipFile(archive).namelist()
    tracked = subprocess.run(["git", "ls-files", "."], cwd=SOURCE / "addon", capture_output=True, text=True, check=True)
    assert {"mesograin/__init__.py", "mesograin/LICENSE", *tracked.stdout.split()} <= set(names)
    assert any(name.startswith("mesograin/mesograin_native.") and name.endswith(".so") for name in names)
    assert not [name for name in names if "__pycache__" in name or not name.startswith("mesograin/")]
    assert [path.name for path in archive.parent.iterdir()] == ["mesograin.zip"]


def test_a_portable_package_goes_where_it_is_asked_for(monkeypatch):
    sys.path.insert(0, str(SOURCE / ".launcher"))
    import commands
    import package

    for name in ("LAUNCHER_BUILD", "LAUNCHER_LOGS", "LAUNCHER_PYTHON"):
        monkeypatch.setenv(name, f"/{name}")
    for words, portable, archive in (([], None, None), (["-o", "a.zip"], None, "a.zip"),
                                     (["--portable"], "build", None),
                                     (["--portable", "-o", "a.zip"], "build", "a.zip")):
        python, script, *given = commands.Package().run(words, commands.Place())
        chosen = package.parse(list(map(str, given)))
        assert script.name == "package.py" and chosen.source == SOURCE
        assert chosen.zip == (archive and pathlib.Path(archive))
        assert chosen.portable == (portable and pathlib.Path("/LAUNCHER_BUILD"))


def test_versions_agree():
    """The build, the add-on and its manifest state one version, and the change log tells of it."""
    sys.path.insert(0, str(SOURCE / ".launcher"))
    import package

    version = package.version_of(SOURCE)
    assert f'version = "{version}"' in (SOURCE / "addon/mesograin/blender_manifest.toml").read_text()
    assert f'"version": ({version.replace(".", ", ")})' in (SOURCE / "addon/mesograin/__init__.py").read_text()
    assert f"## {version}" in (SOURCE / "CHANGELOG.md").read_text()


@pytest.mark.parametrize("command", [["sweep", "none.toml", "--out", "sweep"], ["render", "none.json", "-o", "a.exr"]])
def test_a_missing_file_is_one_sentence(command, tmp_path):
    outcome = launcher(*command, folder=tmp_path)
    assert outcome.returncode in (1, 2), outcome.stderr
    said = outcome.stderr.strip().splitlines()
    assert len(said) == 1 and "none." in said[0], outcome.stderr
    assert not list(tmp_path.iterdir())
