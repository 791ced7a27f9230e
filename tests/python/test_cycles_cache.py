"""The reference cache: bounded, least recently used first, never half a file."""

import os
import time

import pytest
from addon_rooms import room

cache = room("cycles.cache")


def writer(size):
    return lambda path: path.write_bytes(b"x" * size)


def age(store, key, seconds):
    status = store.path(key).stat()
    os.utime(store.path(key), (status.st_atime, status.st_mtime - seconds))


def test_finds_what_was_stored(tmp_path):
    store = cache.Cache(tmp_path / "deep" / "folder", limit=1000)
    assert store.find("a") is None and store.size() == 0
    store.store("a", writer(10))
    assert store.find("a").read_bytes() == b"x" * 10
    store.forget("a")
    assert store.find("a") is None


def test_longest_unused_goes_first(tmp_path):
    store = cache.Cache(tmp_path, limit=250)
    for key, seconds in (("a", 300), ("b", 200)):
        store.store(key, writer(100))
        age(store, key, seconds)
    store.find("a")
    store.store("c", writer(100))
    assert (store.find("b"), store.size()) == (None, 200)
    assert store.find("a") and store.find("c")


def test_newest_stays_even_if_it_is_too_large(tmp_path):
    store = cache.Cache(tmp_path, limit=10)
    store.store("a", writer(5))
    age(store, "a", 10)
    store.store("b", writer(100))
    assert store.find("b") and not store.find("a")


def test_failed_write_leaves_nothing(tmp_path):
    store = cache.Cache(tmp_path, limit=10)

    def fail(path):
        raise OSError("disk full")

    with pytest.raises(OSError, match="disk full"):
        store.store("a", fail)
    assert store.find("a") is None


def test_what_killed_writers_left_goes(tmp_path):
    store = cache.Cache(tmp_path, limit=1000)
    for name, hours in ((".7.1.tmp", 25), (".8.1.tmp", 1)):
        (tmp_path / name).write_bytes(b"half")
        then = time.time() - 3600 * hours
        os.utime(tmp_path / name, (then, then))
    store.store("a", writer(3))
    assert sorted(path.name for path in tmp_path.iterdir()) == [".8.1.tmp", "a.exr"]


def test_what_cannot_be_removed_is_left(tmp_path):
    store = cache.Cache(tmp_path, limit=1000)
    store.path("a").mkdir()
    store.forget("a")
    assert store.path("a").is_dir()


def test_clear_removes_references_and_nothing_else(tmp_path):
    (tmp_path / "notes.txt").write_text("mine")
    store = cache.Cache(tmp_path, limit=1000)
    store.store("a", writer(3))
    store.store("b", writer(4))
    assert store.clear() == (2, 7)
    assert [path.name for path in tmp_path.iterdir()] == ["notes.txt"]


def test_places_and_limits_from_the_environment(monkeypatch, tmp_path):
    for name in ("MESOGRAIN_CACHE", "MESOGRAIN_CACHE_LIMIT"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    assert cache.Cache().folder == tmp_path / "mesograin" / "references"
    assert cache.Cache().limit == 2 * 1024**3
    monkeypatch.setenv("MESOGRAIN_CACHE", str(tmp_path / "here"))
    monkeypatch.setenv("MESOGRAIN_CACHE_LIMIT", "1234")
    assert (cache.Cache().folder, cache.Cache().limit) == (tmp_path / "here", 1234)
    monkeypatch.setenv("MESOGRAIN_CACHE_LIMIT", "2 GB")
    with pytest.raises(ValueError, match="whole number of bytes; got '2 GB'"):
        cache.Cache()
