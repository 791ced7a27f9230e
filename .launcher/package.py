"""Makes the zip of the add-on: its Python files, the native modules that were built, the manifest and the licence.

    package.py [--portable BUILD_FOLDER] SOURCE_FOLDER [FILE.zip]

The zip holds one folder, mesograin/, with the manifest in it: Blender up to 4.1 installs that as an add-on, Blender 4.2
and later as an extension. A portable one holds the libraries, too, that its modules need; see portable.py.
"""
import argparse
import pathlib
import re
import sys
import tempfile
import zipfile

import portable

SUFFIXES = {".py", ".so", ".toml", ".json", ".html", ".j2", ".css", ".js", ".svg", ".png", ".glsl", ".blend", ".txt"}


def version_of(source):
    """The version that the build states."""
    return re.search(r"project\(mesograin VERSION ([\d.]+)", (source / "CMakeLists.txt").read_text()).group(1)


def members(source, gathered=None):
    """[(file, its path in the zip)], sorted, so that equal sources make equal zips.

    gathered: a folder of modules instead of those beside the add-on
    """
    addon = source / "addon/mesograin"
    files = [path for path in sorted(addon.rglob("*")) if path.suffix in SUFFIXES and "__pycache__" not in path.parts]
    found = [(path, path.relative_to(addon)) for path in files if not (gathered and path.suffix == ".so")]
    if gathered:
        found += [(path, path.relative_to(gathered)) for path in sorted(gathered.rglob("*")) if path.is_file()]
    found.append((source / "LICENSE", "LICENSE"))
    return [(path, f"mesograin/{pathlib.PurePath(name).as_posix()}") for path, name in found]


def make_zip(source, target, gathered=None):
    """Writes the zip beside the target and renames it when it is whole."""
    target.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.NamedTemporaryFile(dir=target.parent, suffix=".partial", delete=False) as partial:
        try:
            with zipfile.ZipFile(partial, "w", zipfile.ZIP_DEFLATED) as archive:
                for path, name in members(source, gathered):
                    entry = zipfile.ZipInfo(name)
                    entry.compress_type = zipfile.ZIP_DEFLATED
                    entry.external_attr = 0o644 << 16
                    archive.writestr(entry, path.read_bytes())
            pathlib.Path(partial.name).chmod(0o644)
            pathlib.Path(partial.name).replace(target)
        except BaseException:
            pathlib.Path(partial.name).unlink(missing_ok=True)
            raise


def parse(words):
    parser = argparse.ArgumentParser()
    parser.add_argument("source", type=pathlib.Path)
    parser.add_argument("zip", nargs="?", type=pathlib.Path)
    parser.add_argument("--portable", metavar="BUILD_FOLDER", type=pathlib.Path)
    return parser.parse_args(words)


def main(words):
    chosen = parse(words)
    many = "-linux-x64" if chosen.portable else ""
    target = chosen.zip or chosen.source / "build/package" / f"mesograin-{version_of(chosen.source)}{many}.zip"
    gathered = chosen.portable / "portable/gathered" if chosen.portable else None
    try:
        if gathered:
            portable.gather(sorted(chosen.portable.glob("portable/*.so")), gathered)
        names = [path.name for path, _ in members(chosen.source, gathered)]
        modules = [name for name in names if name.startswith("mesograin_native.") and name.endswith(".so")]
        if not modules:
            print("mesograin: there is no native module beside the add-on; ./mesograin build makes it.",
                  file=sys.stderr)
            return 1
        make_zip(chosen.source, target, gathered)
    except portable.Refused as refused:
        print(f"mesograin: {refused}.", file=sys.stderr)
        return 1
    except OSError as error:
        print(f"mesograin: the zip could not be written to '{target}': {error.strerror}.", file=sys.stderr)
        return 1
    pythons = sorted(re.sub(r".*cpython-3(\d+)-.*", r"3.\1", name) for name in modules)
    print(f"{target} (native modules for Python {', '.join(pythons)})")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
