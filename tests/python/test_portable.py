"""What makes a zip load on other machines: libraries carried under other names, and calls that reach them."""
import os
import pathlib
import subprocess
import sys

import pytest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ.get("MESOGRAIN_BUILD") or SOURCE / "build/release")


@pytest.fixture
def portable(monkeypatch):
    monkeypatch.syspath_prepend(SOURCE / ".launcher")
    import portable

    return portable


def test_a_gathered_module_takes_nothing_of_ours_from_the_machine(portable, tmp_path, monkeypatch):
    monkeypatch.setattr(portable, "NEWEST", {"GLIBC": (9, 0), "GLIBCXX": (9, 0, 0)})  # whatever Debian this is
    portable.gather(list(BUILD.glob("mesograin_native.*.so")), tmp_path / "gathered")
    code = ("import mesograin_native as native, numpy; native.settle(numpy.array([.1, .1]));"
            "print(open('/proc/self/maps').read())")
    said = subprocess.run([sys.executable, "-c", code], env={**os.environ, "PYTHONPATH": str(tmp_path / "gathered")},
                          capture_output=True, text=True, check=True).stdout
    loaded = {line.split()[-1] for line in said.splitlines() if ".so" in line}
    libraries = {path for path in loaded if any(name in path for name in ("embree", "OpenEXR", "Imath", "fmt", "tbb"))}
    assert len(libraries) >= 5 and all(path.startswith(str(tmp_path)) for path in libraries), libraries
    assert all(copy.with_suffix(".copyright.txt").stat().st_size for copy in tmp_path.rglob("libmesograin-*.so"))


def test_what_asks_for_a_newer_system_is_refused(portable, tmp_path, monkeypatch):
    monkeypatch.setattr(portable, "NEWEST", {"GLIBC": (2, 2), "GLIBCXX": (3, 4)})
    with pytest.raises(portable.Refused, match="needs GLIBC.* which is too new; make the zip on Debian 12"):
        portable.gather(list(BUILD.glob("mesograin_native.*.so")), tmp_path / "gathered")


def test_calls_reach_the_module_s_own_library_whatever_else_has_their_names(tmp_path):
    def build(name, text, *words):
        (tmp_path / f"{name}.cpp").write_text(text)
        subprocess.run(["g++", "-fPIC", str(tmp_path / f"{name}.cpp"), *words], cwd=tmp_path, check=True)

    build("stranger", 'extern "C" int rtcNumber() { return 4; }', "-shared", "-o", "libstranger.so")
    build("own", 'extern "C" int rtcNumber() { return 3; }', "-shared", "-o", "libmesograin-embree3.so",
          "-Wl,-soname,libmesograin-embree3.so")
    build("caller", 'extern "C" int rtcNumber(); extern "C" int number() { return rtcNumber(); }',
          "-c", "-o", "caller.o")
    forwards = tmp_path / "forwards.cpp"
    subprocess.run([sys.executable, SOURCE / "native/python/make_forwards.py", forwards, "nm", tmp_path / "caller.o"],
                   check=True)
    build("forwards", forwards.read_text(), "-shared", "caller.o", "-Wl,--no-as-needed", "-L.", "-lmesograin-embree3",
          "-Wl,-rpath,$ORIGIN", "-o", "module.so")
    code = (f"import ctypes; ctypes.CDLL('{tmp_path}/libstranger.so', ctypes.RTLD_GLOBAL);"
            f"print(ctypes.CDLL('{tmp_path}/module.so').number())")
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout == "3\n"
