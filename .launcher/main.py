"""The launcher's words: what is asked for, what must be there for it, and what then runs. See ../mesograin.

    main.py plan FILE [COMMAND [WORD ...]]    writes to FILE what must be there, a line each; nothing where help was all
    main.py run COMMAND [WORD ...]            becomes the command; LAUNCHER_... say where things are
"""
import os
import pathlib
import re
import sys

from commands import COMMANDS, SOURCE, Place

USAGE = 2
OVERVIEW = """Mesograin renders granular materials in real time and compares every picture with Cycles.

  ./mesograin COMMAND [argument ...]

{commands}
  help      this text; `./mesograin help COMMAND` or `./mesograin COMMAND --help` for more

Each command first makes sure of what it needs: Debian packages (through apt, with sudo when not root) and an up-to-date
build of the native module. It says a line for each such step, and nothing when all is there. It runs from any folder.

Environment:
  MESOGRAIN_BLENDER      the Blender to use (default: blender on the PATH; --blender PATH goes before it)
  MESOGRAIN_PYTHON       a Python with headers, of the version that Blender embeds (default: /usr/bin/python3.X)
  MESOGRAIN_GL_DEVICE    the EGL device to render on (default: the first that works, hardware before software)
  XDG_CACHE_HOME         where caches live (default: ~/.cache; Mesograin's are in its folder mesograin)

Exit codes:
  0 done   1 failed, or tests failed   2 wrong usage   3 something needed is missing   130 interrupted
"""


def overview():
    lines = (f"  {name:<10}{command.sentence}" for name, command in COMMANDS.items())
    return OVERVIEW.format(commands="\n".join(lines))


def fail(sentence):
    """Ends the process."""
    sys.stderr.write(f"mesograin: {sentence}\n")
    sys.exit(USAGE)


def take_blender(words):
    """(--blender's path or None, the other words)."""
    chosen, others, words = None, [], list(words)
    while words:
        word = words.pop(0)
        if word == "--blender":
            if not words:
                fail("--blender needs the path of Blender's executable.")
            chosen = words.pop(0)
        elif word.startswith("--blender="):
            chosen = word.removeprefix("--blender=")
        else:
            others.append(word)
    return chosen, others


def plan(words):
    """The needs of a command line, a line each; none where help was asked for and given."""
    if not words:
        sys.stderr.write(overview())
        sys.exit(USAGE)
    name, *words = words
    if name == "--version":
        text = (SOURCE / "CMakeLists.txt").read_text()
        print("mesograin", re.search(r"project\(mesograin VERSION ([\d.]+)", text).group(1))
        return []
    if name in ("help", "--help", "-h"):
        if not words or words[0] == "help":
            print(overview(), end="")
        elif words[0] in COMMANDS:
            COMMANDS[words[0]].help()
        else:
            fail(f"There is no help about '{words[0]}'; the commands are {', '.join(COMMANDS)}.")
        return []
    if name not in COMMANDS:
        fail(f"There is no command '{name}'; the commands are {', '.join(COMMANDS)} and help.")
    blender, words = take_blender(words)
    if COMMANDS[name].wants_help(words):
        COMMANDS[name].help()
        return []
    needs = COMMANDS[name].check(words)
    return [f"blender_path {blender}", *needs] if blender else needs


def run(words):
    """Becomes the command."""
    _, others = take_blender(words[1:])
    program = [str(part) for part in COMMANDS[words[0]].run(others, Place())]
    os.execv(program[0], program)


if __name__ == "__main__":
    if sys.argv[1] == "plan":
        pathlib.Path(sys.argv[2]).write_text("".join(f"{need}\n" for need in plan(sys.argv[3:])))
    else:
        run(sys.argv[2:])
