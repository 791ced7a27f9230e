# Finds the native module, checks that it belongs to this add-on, and says in one sentence what is wrong if not.
import importlib.machinery
import importlib.util
import os
import pathlib
import sys

from . import __version__

NAME = "mesograin_native"
REMEDY = "run './mesograin install' for this Blender and restart it"


class Unavailable(Exception):
    """The native module cannot be used; the message is one sentence for the artist."""


def folder():
    """Where the native module is looked for: MESOGRAIN_NATIVE_DIR, or else the add-on's own folder."""
    return pathlib.Path(os.environ.get("MESOGRAIN_NATIVE_DIR") or pathlib.Path(__file__).parent)


def get():
    """The native module. Raises Unavailable if it is missing, foreign to this Python, broken or of another version."""
    # It registers its types once a process, so it has one name whoever imports it and survives Reload Scripts.
    module = sys.modules.get(NAME) or _load()
    found = getattr(module, "__version__", "unknown")
    if found != __version__:
        raise Unavailable(f"Mesograin {__version__} needs its native module of the same version but found {found} "
                          f"in {folder()}: {REMEDY}.")
    return module


def problem():
    """One sentence about why the native module cannot be used, or None if it can."""
    try:
        get()
    except Unavailable as unavailable:
        return str(unavailable)
    return None


def _load():
    spec = importlib.machinery.PathFinder.find_spec(NAME, [str(folder())])
    if spec is None or not spec.has_location or spec.loader is None:
        raise Unavailable(_missing())
    try:
        module = importlib.util.module_from_spec(spec)
        sys.modules[NAME] = module
        spec.loader.exec_module(module)
    except Exception as error:  # whatever an extension's start-up raises: a missing library, another Python's symbols
        sys.modules.pop(NAME, None)
        reason = " ".join(str(error).split())
        raise Unavailable(f"Mesograin's native module {spec.origin} cannot be loaded ({reason}): {REMEDY}.") from error
    return module


def _missing():
    needed = importlib.machinery.EXTENSION_SUFFIXES[0]
    others = sorted(path.name for path in folder().glob(f"{NAME}.*.so"))
    if others:
        python = f"{sys.version_info.major}.{sys.version_info.minor}"
        return (f"Mesograin needs its native module for this Blender's Python {python} ({NAME}{needed}) "
                f"but found only {', '.join(others)} in {folder()}: {REMEDY}.")
    return f"Mesograin needs its native module {NAME}{needed} but there is none in {folder()}: {REMEDY}."
