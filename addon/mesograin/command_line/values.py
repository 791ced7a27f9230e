# The values of options as words of the command line: counts, fractions, sizes, bytes, material parameters.
"""Each takes a word and returns what it means, or raises argparse.ArgumentTypeError: what is needed and what came."""

import argparse
import re

from ..schema.parameters import PARAMETERS, SETTABLE


def positive(text):
    """A whole number above 0."""
    if not text.isdigit() or not 1 <= int(text) <= 1 << 20:
        raise argparse.ArgumentTypeError(f"a whole number from 1 to {1 << 20} is needed, '{text}' came")
    return int(text)


def fraction(text):
    """A number in (0, 1]."""
    try:
        number = float(text)
    except ValueError:
        number = 0.0
    if not 0.0 < number <= 1.0:
        raise argparse.ArgumentTypeError(f"a number above 0 and up to 1 is needed, '{text}' came")
    return number


def picture_size(text):
    """(width, height) of WIDTHxHEIGHT."""
    found = re.fullmatch(r"(\d{1,5})[xX](\d{1,5})", text)
    if not found or not all(8 <= int(side) <= 16384 for side in found.groups()):
        raise argparse.ArgumentTypeError(f"WIDTHxHEIGHT with 8 to 16384 pixels a side is needed, '{text}' came")
    return tuple(int(side) for side in found.groups())


def byte_count(text):
    """Bytes, of a number with an optional K, M or G."""
    found = re.fullmatch(r"(\d+)([KMG]?)", text, re.IGNORECASE)
    if not found:
        raise argparse.ArgumentTypeError(f"a number of bytes such as 500M is needed, '{text}' came")
    return int(found[1]) * 1024 ** " KMG".index(found[2].upper() or " ")


def setting(text):
    """(name, value) of a word NAME=VALUE, one of SETTABLE: a number, three, true or false, or a name."""
    name, equals, word = text.partition("=")
    if not equals or name not in SETTABLE:
        chosen = name in PARAMETERS and PARAMETERS[name].decided_by == "reference"
        hint = " (the reference chooses it)" if chosen else ""
        raise argparse.ArgumentTypeError(f"NAME=VALUE with one of {', '.join(SETTABLE)} is needed, '{text}' came{hint}")
    parameter = PARAMETERS[name]
    value = parameter.check(_value(parameter.kind, word))
    if value is None:
        raise argparse.ArgumentTypeError(f"{name} takes {parameter.allowed}, '{word}' came")
    return name, value


def _value(kind, word):
    """What a word means to a kind of parameter; None if nothing."""
    if kind == "choice":
        return word
    if kind == "switch":
        return {"true": True, "false": False}.get(word)
    try:
        numbers = [float(number) for number in word.split(",")]
    except ValueError:
        return None
    return numbers[0] if len(numbers) == 1 else numbers
