# What the commands of the add-on share: no window, the scene opened, one sentence and an exit code for a problem.
"""A command is a file that Blender runs: blender -b --factory-startup --python FILE -- WORD ... See `main`."""

import sys

from . import interruption

OK, FAILED, BAD_INPUT, NO_OUTPUT = 0, 1, 2, 3
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
