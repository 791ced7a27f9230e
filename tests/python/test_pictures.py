"""The documentation's pictures are all made by `./mesograin pictures`, which says where one is not."""
import os
import pathlib
import re
import sys

import pytest

from test_launcher import SOURCE, launcher

IMAGES = SOURCE / "docs/images"


@pytest.fixture
def pictures(monkeypatch):
    monkeypatch.syspath_prepend(str(SOURCE / ".launcher"))
    import pictures

    return pictures


def test_each_image_is_made_by_one_picture(pictures):
    made = [image.name for picture in pictures.PICTURES.values() for image in IMAGES.glob(picture.images)]
    assert sorted(made) == sorted(image.name for image in IMAGES.iterdir())


def test_each_image_is_shown():
    pages = "".join(page.read_text() for page in [SOURCE / "README.md", *SOURCE.glob("docs/*.md")])
    shown = {name.rpartition("/")[2] for name in re.findall(r"!\[[^]]*\]\(([^)]+)\)", pages)}
    assert shown == {image.name for image in IMAGES.iterdir()}


def test_what_its_commands_run_is_there(pictures, tmp_path, monkeypatch):
    monkeypatch.setenv("MESOGRAIN_REFEREE", str(tmp_path))
    at = pictures.Workplace(tmp_path, "blender", tmp_path, tmp_path)
    for picture in pictures.PICTURES.values():
        for command in picture.commands(at):
            words = list(map(str, command))
            files = [word for word in words if word.startswith(str(SOURCE)) and not word.startswith(str(IMAGES))]
            assert files and all(pathlib.Path(file).exists() for file in files), command


@pytest.fixture
def two(pictures, tmp_path, monkeypatch):
    """Makes two pictures by commands that are given."""
    images = tmp_path / "images"
    images.mkdir()
    monkeypatch.setattr(pictures, "IMAGES", images)

    argv = ["pictures.py", str(tmp_path), "blender", str(tmp_path), str(tmp_path / "kept")]

    def make(first, second):
        def writes(name, script):
            return lambda _at: [["/bin/sh", "-c", script.format(image=images / f"{name}.png")]]

        monkeypatch.setattr(pictures, "PICTURES", {
            name: pictures.Picture(f"the {name}", 2.0, writes(name, script), f"{name}.png")
            for name, script in (("first", first), ("second", second))})
        monkeypatch.setattr(sys, "argv", argv)
        pictures.main()

    make.images = images
    return make


def test_time_left_is_said(two, capsys):
    two("touch {image}", "touch {image}")
    first, second, last = capsys.readouterr().out.splitlines()
    assert first == "1 of 2, first: the first; about 4 min 00 s left for all"
    assert second == "2 of 2, second: the second; about 0 s left for all"  # as fast as the first was
    assert last.startswith("2 of 2 done in ")


def test_a_command_that_fails_ends_it_with_its_code(two):
    with pytest.raises(SystemExit) as end:
        two("exit 3", "touch {image}")
    assert end.value.code == 3 and not (two.images / "second.png").exists()


def test_an_image_that_nothing_writes_is_said(two):
    (two.images / "second.png").touch()
    os.utime(two.images / "second.png", (1.0, 1.0))
    with pytest.raises(SystemExit) as end:
        two("touch {image}", "true")
    assert "nothing has written docs/images/second.png" in end.value.code


def test_a_name_that_there_is_not_is_said(tmp_path):
    outcome = launcher("pictures", "portrait", folder=tmp_path)
    assert outcome.returncode == 2 and "there is no picture 'portrait'" in outcome.stderr
