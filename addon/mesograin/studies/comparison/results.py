# The files of a comparison: results.json, results.csv, EXR and PNG pictures, each complete or absent.
"""See `Output`."""

import csv
import io
import json
import os
import tempfile
from pathlib import Path

import bpy
import numpy

from ... import native_module
from ...cycles.reference import PROVENANCE

CSV_FIRST = ("name", "scene", "model", "reference", "boundary", "status", "frame_ms", "reference_seconds")
CSV_METRICS = ("relative_l1", "relative_l1_corrected", "relative_l1_blocks", "bias", "rse_mean", "rse_max")


PNG_END = b"\0\0\0\0IEND\xae\x42\x60\x82"
"""The last chunk of every PNG file."""


class OutputError(Exception):
    """The output folder cannot be written; one sentence."""


class Output:
    """A folder of results. Raises OutputError at once if nothing can be written there."""

    def __init__(self, folder):
        self.folder = Path(folder).absolute()
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            with tempfile.TemporaryFile(dir=self.folder) as probe:
                probe.write(b"\0" * 65536)
                probe.flush()
                os.fsync(probe.fileno())
        except OSError as error:
            raise OutputError(
                f"The output folder {self.folder} cannot be written ({error.strerror}): make room for it or choose"
                " another with --out."
            ) from error

    def write_exr(self, name, pixels, provenance):
        """A picture under the folder, made with its folders; returns its name."""
        native = native_module.get()
        path = self._place(name)
        try:
            native.write_exr(path, pixels, attributes={PROVENANCE: json.dumps(provenance)})
        except native.Error as error:
            raise OutputError(str(error)) from error
        return name

    def write_png(self, name, colours):
        """(h, w, 3) sRGB-encoded values in [0, 1], row 0 at the top, as an 8-bit picture; returns its name."""
        self._write_bytes(self._place(name), _png(colours))
        return name

    def write_results(self, results):
        """results.json and results.csv."""
        self.write_text("results.json", json.dumps(results, indent=1, allow_nan=False) + "\n")
        self.write_text("results.csv", _csv(results["cases"]))

    def write_text(self, name, text):
        """A text file under the folder."""
        self._write_bytes(self.folder / name, text.encode())

    def _write_bytes(self, path, content):
        """The file appears whole or not at all, and is on the disk when this returns."""
        # Of this process alone, since another may write into the same folder.
        partial = path.with_name(f"{path.name}.{os.getpid()}.part")
        try:
            with open(partial, "wb") as file:
                file.write(content)
                file.flush()
                os.fsync(file.fileno())
            os.replace(partial, path)
        except OSError as error:
            raise OutputError(
                f"{path} cannot be written ({error.strerror}): free some space or choose another folder with --out."
            ) from error
        finally:
            partial.unlink(missing_ok=True)

    def _place(self, name):
        path = self.folder / name
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise OutputError(f"{path.parent} cannot be made ({error.strerror}).") from error
        return path


def _png(colours):
    """The bytes of a PNG file. Blender can only save to a file, and of a full disk it does not always tell: so the file
    is a temporary one, and looked at."""
    height, width = colours.shape[:2]
    image = bpy.data.images.new("Mesograin picture", width, height)
    try:
        opaque = numpy.ones((height, width, 4), numpy.float32)
        opaque[..., :3] = colours[::-1]
        image.pixels.foreach_set(opaque.ravel())
        image.file_format = "PNG"
        with tempfile.TemporaryDirectory(prefix="mesograin-") as folder:
            saved = Path(folder) / "picture.png"
            image.filepath_raw = str(saved)
            image.save()
            content = saved.read_bytes()
    except (OSError, RuntimeError) as error:
        raise OutputError(f"Blender cannot save a picture in {tempfile.gettempdir()}: free some space.") from error
    finally:
        bpy.data.images.remove(image)
    if not content.endswith(PNG_END):
        raise OutputError(f"Blender cannot save a whole picture in {tempfile.gettempdir()}: free some space.")
    return content


def _csv(cases):
    """One row a case; the columns that matter most come first, then all others by name."""
    rows = [_row(case) for case in cases]
    first = [*CSV_FIRST, *CSV_METRICS]
    names = [*first, *sorted({name for row in rows for name in row} - set(first))]
    text = io.StringIO()
    writer = csv.DictWriter(text, names, restval="", lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return text.getvalue()


def _row(case):
    row = {name: value for name, value in case.items() if not isinstance(value, (dict, list))}
    row.update(case.get("metrics", {}))
    for group in ("noise_floor", "our_noise", "mask", "significance", "until"):
        row.update({f"{group}.{name}": value for name, value in (case.get(group) or {}).items()})
    return {
        name: json.dumps(value) if isinstance(value, list) else value
        for name, value in row.items()
        if value is not None
    }
