# A command from its words to its exit code: no window, the scene opened, one sentence for a problem.
"""A command is a file that Blender runs: blender -b --factory-startup --python FILE -- WORD ... See `main`."""

import contextlib
import sys

from . import interruption
from .parser import BAD_INPUT

OK, FAILED, NO_OUTPUT = 0, 1, 3
"""Exit codes. FAILED: something of what was asked for, the rest is written. NO_OUTPUT: nothing can be written there."""


class CommandError(Exception):
    """Ends a command: one sentence for standard error and the exit code."""

    def __init__(self, sentence, code=BAD_INPUT):
        super().__init__(str(sentence))
        self.code = code


def main(name, parse, run, interrupted=interruption.INTERRUPTED):
    """Runs a command and ends the process with its exit code.

    name: as users call it. parse(words) -> what was chosen. run(chosen, words) -> exit code; it may raise CommandError.
    interrupted: what to say after Ctrl-C.
    """
    words = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else []
    chosen = parse(words)
    with interruption.Interruption() as interruptions:
        try:
            interruptions.raise_missed()
            code = run(chosen, words)
        except CommandError as error:
            complain(name, error)
            code = error.code
        except KeyboardInterrupt:
            sys.stderr.write(f"\n{interrupted}\n")
            code = interruptions.code
    sys.stdout.flush()
    sys.stderr.flush()
    sys.exit(code)


def complain(name, error):
    """One sentence on standard error."""
    sys.stderr.write(f"{name}: {error}\n")


def open_scene(path):
    """The add-on and Cycles enabled, then the file at `path` opened (None: what Blender starts with); returns the
    native module. Raises CommandError."""
    import addon_utils
    import bpy

    import mesograin
    from .. import native_module

    addon_utils.enable("cycles")
    if not hasattr(bpy.types.Scene, "mesograin"):
        mesograin.register()
    if path:
        # Only now, so that the file finds its engine and its properties.
        try:
            bpy.ops.wm.open_mainfile(filepath=str(path.absolute()), load_ui=False)
        except RuntimeError as error:
            reason = " ".join(str(error).split()).removeprefix("Error: ")
            raise CommandError(f"{path} cannot be opened: {reason}") from error
    try:
        return native_module.get()
    except native_module.Unavailable as error:
        raise CommandError(error) from error


def open_cache(chosen):
    """The `cycles.cache.Cache` that --cache and --cache-limit choose. Raises CommandError."""
    from ..cycles.cache import Cache

    try:
        return Cache(chosen.cache, chosen.cache_limit)
    except ValueError as error:
        raise CommandError(error) from error


@contextlib.contextmanager
def told(progress, unwritable, others, code=BAD_INPUT):
    """What goes wrong inside becomes a CommandError, and the line of progress is left empty.

    unwritable: the exception for an output folder. others: a tuple of those that end with `code`.
    """
    try:
        yield
    except unwritable as error:
        raise CommandError(error, NO_OUTPUT) from error
    except others as error:
        raise CommandError(error, code) from error
    finally:
        progress.close()
