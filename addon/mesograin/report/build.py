# Writes report.html beside the results of a comparison, a sweep or a trade curve: python3 build.py FOLDER [--out FILE].
# Needs jinja2, matplotlib, numpy and, but for sweeps, the native module.
"""The command; one sentence and exit code 1 for whatever is missing."""

import argparse
import os
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))


def main(words):
    """Returns the exit code."""
    parser = argparse.ArgumentParser(
        description="Writes a self-contained report.html from a folder with results.json or trade.json."
    )
    parser.add_argument("folder", type=Path, help="folder with results.json or trade.json and its pictures")
    parser.add_argument("--out", type=Path, default=None, help="file to write (default: FOLDER/report.html)")
    chosen = parser.parse_args(words)
    try:
        import jinja2  # noqa: F401
        import matplotlib  # noqa: F401
        import numpy  # noqa: F401
    except ImportError as error:
        return _complain(
            f"{error.name} is needed by {sys.executable}: install python3-jinja2, python3-matplotlib and python3-numpy."
        )

    from mesograin.report import page_builder, reading, sweep_page, trade_page

    out = chosen.out or chosen.folder / "report.html"
    try:
        if (chosen.folder / reading.TRADE).exists():
            html = trade_page.build(*reading.read_trade(chosen.folder), out.parent)
        elif reading.is_sweep(chosen.folder):
            html = sweep_page.build(*reading.read_sweep(chosen.folder), out.parent)
        else:
            html = page_builder.build(*reading.read(chosen.folder), out.parent)
        partial = out.with_name(f"{out.name}.{os.getpid()}.part")
        try:
            partial.write_text(html, encoding="utf-8")
            os.replace(partial, out)
        finally:
            partial.unlink(missing_ok=True)
    except reading.UnreadableError as error:
        return _complain(error)
    except OSError as error:
        return _complain(f"{error.filename or out} cannot be written ({error.strerror}).")
    return 0


def _complain(error):
    sys.stderr.write(f"report: {error}\n")
    return 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
