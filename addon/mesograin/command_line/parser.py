# The parser of every command, and the options that several of them have.
"""See `Parser` and `add_settings`, `add_exchange`, `add_cache`. Readable without Blender."""

import argparse
from pathlib import Path

from ..schema.parameters import SCENE, SETTABLE
from . import values

BAD_INPUT = 2


class Parser(argparse.ArgumentParser):
    """Says what is wrong in one sentence, by the name of the command that was called."""

    def error(self, message):
        self.exit(BAD_INPUT, f"{self.prog.split()[-1]}: {message}; see --help.\n")

    def choose(self, words):
        """argparse.Namespace of the command line after `--`, with `settings` as a dict and a `scene` that exists."""
        chosen = self.parse_args(words)
        chosen.settings = dict(chosen.settings)
        if chosen.scene and not chosen.scene.is_file():
            self.error(f"there is no scene '{chosen.scene}'")
        return chosen


def add_scene(parser, what):
    """The optional SCENE.blend. what: that is done with it."""
    parser.add_argument("scene", nargs="?", type=Path, default=None, metavar="SCENE.blend", help=f"the scene to {what}")


def add_settings(parser, where):
    """--set NAME=VALUE. where: the parameter counts, as in 'for every material'."""
    parser.add_argument(
        "--set",
        action="append",
        type=values.setting,
        default=[],
        dest="settings",
        metavar="NAME=VALUE",
        help=(
            f"a material parameter{where}: {', '.join(SETTABLE)}; RGB as one number or three with commas; may be"
            " repeated"
        ),
    )


def add_exchange(parser):
    """--exchange, as the schema has it."""
    exchange = SCENE["exchange"]
    parser.add_argument(
        "--exchange",
        choices=[choice.name for choice in exchange.choices],
        default=None,
        help=f"{exchange.label}: {'; '.join(f'{choice.name}, {choice.sentence}' for choice in exchange.choices)}"
        " (default: as the scene says)",
    )


def add_cache(parser):
    """--cache and --cache-limit."""
    parser.add_argument(
        "--cache",
        type=Path,
        default=None,
        metavar="DIR",
        help="folder of rendered references (default: MESOGRAIN_CACHE, or mesograin/references in the user's cache)",
    )
    parser.add_argument(
        "--cache-limit",
        type=values.byte_count,
        default=None,
        metavar="SIZE",
        help="bytes that it may take, with an optional K, M or G (default: MESOGRAIN_CACHE_LIMIT, or 2G)",
    )
