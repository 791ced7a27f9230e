# The values of options as words of the command line: counts, fractions, sizes, bytes, material parameters.
"""Each takes a word and returns what it means, or raises argparse.ArgumentTypeError: what is needed and what came."""

import argparse
import math
import re

SETTABLE = {
    "reflectance": 3,
    "sigma_a": 3,
    "sigma_s": 3,
    "g": 1,
    "eta": 1,
    "roughness": 1,
    "scale": 1,
    "profile": 0,
}
"""Parameters that --set may change, and how many numbers each takes; 0 for a word."""


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
    """(name, value) of a word NAME=VALUE: a number, three, or a word, as SETTABLE has it."""
    name, equals, value = text.partition("=")
    if not equals or name not in SETTABLE:
        hint = " (the reference chooses it)" if name in ("boundary", "masking") else ""
        raise argparse.ArgumentTypeError(f"NAME=VALUE with one of {', '.join(SETTABLE)} is needed, '{text}' came{hint}")
    count = SETTABLE[name]
    if count == 0:
        return name, value
    try:
        numbers = tuple(float(number) for number in value.split(","))
    except ValueError:
        numbers = ()
    if not all(map(math.isfinite, numbers)):
        numbers = ()
    if count == 3 and len(numbers) == 1:
        numbers *= 3
    if len(numbers) != count:
        raise argparse.ArgumentTypeError(
            f"{name} takes {'one number or three' if count == 3 else 'one number'}, '{value}' came"
        )
    return name, numbers if count == 3 else numbers[0]
