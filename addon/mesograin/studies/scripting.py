# The comparison as one Python function, for scripts and for Blender's console: mesograin.compare(...).
"""See `compare`."""

import dataclasses
from pathlib import Path

import bpy

from .. import native_module
from ..cycles import kinds, stage
from ..cycles.cache import Cache
from ..schema.parameters import PARAMETERS, SCENE, SETTABLE
from .comparison import arguments, mask_names, progress, report_page, results, run, verdict

PICTURES = ("model", "reference", "error")


class ComparisonError(Exception):
    """Nothing could be compared; one sentence that says what was needed, what came, what to do."""


@dataclasses.dataclass(frozen=True)
class Case:
    """One model against one kind of reference.

    name: 'MODEL.REFERENCE'. error: the sentence of a case that failed, else ''. folder: of its comparison.
    entry: the case in results.json with every number (docs/comparing.md), of which the properties below are the usual.
    """

    name: str
    model: str
    reference: str
    error: str
    folder: Path
    entry: dict

    @property
    def relative_l1(self):
        """sum |i - r| / sum r over the mask, a fraction without unit; None where the reference is black or it failed"""
        return self.entry.get("metrics", {}).get("relative_l1")

    @property
    def noise_floor(self):
        """What a perfect picture would score in `relative_l1` against this reference, for its noise."""
        return self.entry.get("noise_floor", {}).get("relative_l1")

    @property
    def frame_ms(self):
        """Milliseconds of one frame of ours; None if the case failed."""
        return self.entry.get("frame_ms")

    @property
    def reference_seconds(self):
        """Seconds that Cycles took when it rendered the reference; None if the case failed."""
        return self.entry.get("reference_seconds")

    @property
    def verdict(self):
        """A few words, such as '2.31% off, beyond noise in 40.0% of the pixels' or 'no significant difference, noise
        0.27%'."""
        return verdict.verdict(self.entry)

    def path(self, picture):
        """The EXR file of 'model', 'reference' or 'error'. Raises ComparisonError if the case failed."""
        if picture not in PICTURES:
            raise ComparisonError(f"A case has the pictures {', '.join(PICTURES)}; '{picture}' came.")
        if self.error:
            raise ComparisonError(f"The case {self.name} has no pictures, because it failed: {self.error}")
        return self.folder / self.entry["files"][picture]

    def image(self, picture):
        """The picture as float32, linear, row 0 at the top. 'model' and 'reference': (h, w, 4) radiance, premultiplied,
        alpha is coverage; 'error': (h, w, 3) model less reference. Raises ComparisonError if it cannot be read."""
        native = native_module.get()
        path = self.path(picture)
        try:
            return native.read_exr(path)[0]
        except native.Error as error:
            raise ComparisonError(str(error)) from error


@dataclasses.dataclass(frozen=True)
class Comparison:
    """cases: in the order asked for. folder: of results.json, results.csv and the pictures. report: report.html, or
    None without one. results: what results.json holds. warnings: sentences about what the scene has and we ignore."""

    cases: tuple
    folder: Path
    report: Path
    results: dict
    warnings: tuple

    @property
    def failed(self):
        """The cases that failed."""
        return tuple(case for case in self.cases if case.error)


def compare(models=arguments.DEFAULT_MODELS, references=None, out="//comparison", size=None, samples=64,
            reference_samples=None, seeds=2, until=None, most_seeds=arguments.MOST_SEEDS, masks=(), part=None,
            controls=False, settings=None, exchange=None, frames=9, cache=None,
            cache_limit=None, report=True, on_progress=None, command=None):
    """Renders the current scene with every model and with the Cycles materials that mean the same, and measures.

    models: of schema.models.CHOICES; every material is rendered with each.
    references: of 'diffuse', 'glossy', 'volume_index_matched', 'subsurface', 'subsurface_burley', 'volume_dielectric',
    'photon', 'volume_lambert', 'photon_scene'; None for each model's usual one.
    out: folder for all files, made if needed; '//' is the folder of the .blend file.
    size: (width, height) in pixels, None for the scene's. samples: of each pixel, on our side.
    reference_samples: Cycles samples of each pixel for each seed, None for 64 (surfaces) or 128 (volumes). seeds: how
    many independent references are averaged. until: adds seeds, to `most_seeds` at most, until the reference's noise is
    this fraction of the measured error. masks: such as 'silhouette:4', 'crop:LEFT,TOP,RIGHT,BOTTOM', 'mean_deviation',
    'otsu', one after another.
    part: 'specular' or 'subsurface' compares that part of the light alone, None the whole.
    controls: also tests the significance test: the reference's own renderer with the same and with a wrong material.
    settings: {parameter: value} for every material on both sides: reflectance, sigma_a, sigma_s (1/mm; one number or
    three), g, eta, roughness (GGX alpha), scale, profile. frames: how many are timed for `frame_ms`.
    exchange: light between grains, 'off', 'heaps', 'order_1', 'gathered' or 'path_traced'; None as the scene says.
    cache: folder of rendered references, None for the usual one. cache_limit: bytes that it may take.
    report: whether to write report.html. on_progress: called with a `progress.Step` (what, number, count, fraction,
    seconds_left), a few times a second, from any thread. command: the line that repeats this comparison, for
    provenance; None for this call.

    Returns a `Comparison`. A case that fails is in it with its sentence, and the others go on. The scene, its materials
    and the undo history stay as they are. Raises ComparisonError if nothing can be compared.
    """
    warnings = []
    line = progress.Calls(on_progress or (lambda step: None), warnings.append)
    try:
        native = native_module.get()
        request = run.Request(
            models=_names("models", models, arguments.MODELS),
            references=None if references is None else _names("references", references, tuple(kinds.KINDS)),
            out=_folder(out),
            size=_size(size),
            samples=_count("samples", samples),
            reference_samples=reference_samples and _count("reference_samples", reference_samples),
            seeds=_count("seeds", seeds),
            until=_fraction("until", until),
            most_seeds=_count("most_seeds", most_seeds),
            masks=tuple(_mask(text) for text in ((masks,) if isinstance(masks, str) else masks)),
            part=_part(part),
            controls=bool(controls),
            settings=_settings(settings or {}),
            exchange=_exchange(exchange),
            frames=_count("frames", frames),
            cache=Cache(cache, cache_limit),
            command=command or call(models=models, references=references, out=str(out), size=size, samples=samples,
                                    reference_samples=reference_samples, seeds=seeds, until=until, masks=masks or None,
                                    part=part, controls=controls or None, settings=settings, exchange=exchange))
        if request.controls and request.seeds < 2:
            raise ComparisonError("controls needs 2 or more seeds, since one does not tell its noise; 1 came.")
        for kind in request.references or ():
            if not kinds.has(kind, request.part):
                raise ComparisonError(f"part: {kinds.missing_part(kind, request.part)}.")
        if request.references is None and not run.cases(request.models, None, request.part):
            raise ComparisonError(f"No reference has a {request.part} part of {', '.join(request.models)}.")
        if not run.cases(request.models, request.references, request.part):
            raise ComparisonError(f"None of the references {', '.join(request.references)} answers "
                                  f"{', '.join(request.models)}: choose others, or None for each model's usual one.")
        stage.need_cycles()
        found = run.compare(request, line)
    except (native_module.Unavailable, results.OutputError, stage.StageError, ValueError) as error:
        raise ComparisonError(str(error)) from error
    except native.Error as error:
        raise ComparisonError(str(error)) from error
    cases = tuple(Case(entry["name"], entry["model"], entry["reference"], entry.get("error", ""), request.out, entry)
                  for entry in found["cases"])
    # What failed is said by its case.
    warnings = [sentence for sentence in warnings if not any(case.error and case.error in sentence for case in cases)]
    page = _write_report(request.out, warnings) if report else None
    return Comparison(cases, request.out, page, found, tuple(warnings))


def _part(part):
    if part is not None and part not in kinds.PARTS:
        raise ComparisonError(f"part takes {' or '.join(kinds.PARTS)}, or None for the whole; {part!r} came.")
    return part


def _exchange(exchange):
    if exchange is not None and SCENE["exchange"].check(exchange) is None:
        raise ComparisonError(
            f"exchange takes {SCENE['exchange'].allowed}, or None as the scene says; {exchange!r} came.")
    return exchange


def _mask(text):
    try:
        return mask_names.parse(text)
    except mask_names.MaskError as error:
        raise ComparisonError(f"masks: {error}.") from error


def _write_report(folder, warnings):
    try:
        return report_page.write(folder)
    except report_page.ReportError as error:
        warnings.append(f"There is no report: {error}")
        return None


def _names(what, names, allowed):
    names = (names,) if isinstance(names, str) else tuple(names)
    unknown = [name for name in names if name not in allowed]
    if unknown or not names:
        came = repr(unknown[0]) if unknown else "none"
        raise ComparisonError(f"{what} takes names of {', '.join(allowed)}; {came} came.")
    return names


def _folder(out):
    out = str(out)
    if out.startswith("//") and not bpy.data.filepath:
        raise ComparisonError(f"The file is not saved, so there is no folder '{out}' beside it: save it, or pass out.")
    return Path(bpy.path.abspath(out)).absolute()


def _size(size):
    if size is None:
        return None
    try:
        width, height = size
        fits = all(int(side) == side and 8 <= side <= 16384 for side in (width, height))
    except (TypeError, ValueError):
        fits = False
    if not fits:
        raise ComparisonError(f"size takes (width, height) with 8 to 16384 pixels a side; {size!r} came.")
    return int(width), int(height)


def _count(what, number):
    if isinstance(number, bool) or not isinstance(number, int) or not 1 <= number <= 1 << 20:
        raise ComparisonError(f"{what} takes a whole number from 1 to {1 << 20}; {number!r} came.")
    return number


def _fraction(what, number):
    if number is not None and not (isinstance(number, (int, float)) and 0.0 < number <= 1.0):
        raise ComparisonError(f"{what} takes a number above 0 and up to 1; {number!r} came.")
    return number


def _settings(settings):
    return {name: _setting(name, value) for name, value in dict(settings).items()}


def _setting(name, value):
    if name not in SETTABLE:
        raise ComparisonError(f"settings takes {', '.join(SETTABLE)}; {name!r} came.")
    parameter = PARAMETERS[name]
    # An array of numpy's, or a number of it, is as good as Python's own.
    checked = parameter.check(value.tolist() if hasattr(value, "tolist") else value)
    if checked is None:
        raise ComparisonError(f"{name} takes {parameter.allowed}; {value!r} came.")
    return checked


def call(**given):
    """The line of Python that compares with these arguments, for provenance."""
    return f"mesograin.compare({', '.join(f'{name}={value!r}' for name, value in given.items() if value is not None)})"
