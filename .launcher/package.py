"""Makes the zip of the add-on: its Python files, the native modules that were built, the manifest and the licence.

    package.py SOURCE_FOLDER [FILE.zip]

The zip holds one folder, mesograin/, with the manifest in it: Blender up to 4.1 installs that as an add-on, Blender 4.2
and later as an extension.
"""
import pathlib
import re
import sys
import tempfile
import zipfile

SUFFIXES = {".py", ".so", ".toml", ".json", ".html", ".j2", ".css", ".js", ".svg", ".png", ".glsl"}


def version_of(source):
    """The version that the build states."""
    return re.search(r"project\(mesograin VERSION ([\d.]+)", (source / "CMakeLists.txt").read_text()).group(1)


def members(source):
    """[(file, its path in the zip)], sorted, so that equal sources make equal zips."""
    addon = source / "addon/mesograin"
    files = [path for path in sorted(addon.rglob("*")) if path.suffix in SUFFIXES and "__pycache__" not in path.parts]
    return [(path, "mesograin/" + path.relative_to(addon).as_posix()) for path in files] + [
        (source / "LICENSE", "mesograin/LICENSE")]


def make_zip(source, target):
    """Writes the zip beside the target and renames it when it is whole."""
    target.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.NamedTemporaryFile(dir=target.parent, suffix=".partial", delete=False) as partial:
        try:
            with zipfile.ZipFile(partial, "w", zipfile.ZIP_DEFLATED) as archive:
                for path, name in members(source):
                    entry = zipfile.ZipInfo(name)
                    entry.compress_type = zipfile.ZIP_DEFLATED
                    entry.external_attr = 0o644 << 16
                    archive.writestr(entry, path.read_bytes())
            pathlib.Path(partial.name).chmod(0o644)
            pathlib.Path(partial.name).replace(target)
        except BaseException:
            pathlib.Path(partial.name).unlink(missing_ok=True)
            raise


def main(arguments):
    source = pathlib.Path(arguments[0])
    target = pathlib.Path(arguments[1]) if len(arguments) > 1 else (
        source / "build/package" / f"mesograin-{version_of(source)}.zip")
    modules = [path.name for path, _ in members(source) if path.suffix == ".so"]
    if not modules:
        print("mesograin: there is no native module beside the add-on; ./mesograin build makes it.", file=sys.stderr)
        return 1
    try:
        make_zip(source, target)
    except OSError as error:
        print(f"mesograin: the zip could not be written to '{target}': {error.strerror}.", file=sys.stderr)
        return 1
    pythons = sorted(re.sub(r".*cpython-3(\d+)-.*", r"3.\1", name) for name in modules)
    print(f"{target} (native modules for Python {', '.join(pythons)})")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
