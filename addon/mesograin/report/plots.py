# The plots: figures that the page colours itself, and the same ones as SVG and PNG files for papers and slides.
"""`page` turns a plot into SVG whose colours are the page's custom properties, so that it suits light and dark alike;
`save` writes it as files on white. A plot is a function of a Palette that returns a matplotlib figure."""

import base64
import io
import os
import re
import textwrap
from dataclasses import astuple, dataclass

import matplotlib.image
import numpy
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator
from matplotlib.transforms import Bbox

from ..schema.labels import of_model
from . import colours
from .wording import form, headline


@dataclass(frozen=True)
class Palette:
    """Colours by what they are for."""

    ink: str
    quiet: str
    grid: str
    ours: str
    theirs: str
    second: str
    third: str


PAPER = Palette("#1b1c1e", "#55585d", "#dcddda", "#c2410c", "#57707f", "#7c4dbd", "#0f8a72")
# Stand-ins that the page's own colours replace.
_PAGE = Palette("#010203", "#010204", "#010205", "#010206", "#010207", "#010208", "#010209")
_PROPERTIES = ("--ink", "--quiet", "--line", "--ours", "--theirs", "--second", "--third")
_BARE = {"Date": None, "Creator": None, "Format": None, "Type": None}


def page(draw):
    """SVG text of a plot, its colours and its type taken from the page around it; "" if there is nothing to draw."""
    figure = _drawn(draw, _PAGE)
    if figure is None:
        return ""
    svg = _svg(figure)
    for stand_in, name in zip(astuple(_PAGE), _PROPERTIES):
        svg = svg.replace(stand_in, f"var({name})")
    # Type and size are the page's.
    svg = re.sub(r"font: ([\d.]+)px [^;\"]*", r"font: \1px var(--sans)", svg)
    return re.sub(r'<svg ([^>]*?)width="[\d.]+pt" height="[\d.]+pt"', r"<svg \1", svg[svg.index("<svg"):], count=1)


def save(draw, folder, name, terms=()):
    """Writes NAME.svg and NAME.png into a folder, each whole or not at all; returns [file name], none if there is
    nothing to draw. terms: sentences below a figure that is alone there and not on its page. Raises OSError."""
    figure = _drawn(draw, PAPER)
    if figure is None:
        return []
    if terms:
        _put_terms(figure, terms)
    folder.mkdir(parents=True, exist_ok=True)
    written = []
    for ending, options in (("svg", {"metadata": {"Date": None}}), ("png", {"dpi": 200})):
        path = folder / f"{name}.{ending}"
        partial = path.with_name(f".{os.getpid()}.{path.name}")
        try:
            with matplotlib.rc_context(_style(PAPER)):
                figure.savefig(partial, format=ending, facecolor="white", **options)
            partial.replace(path)
        finally:
            partial.unlink(missing_ok=True)
        written.append(path.name)
    return written


def _put_terms(figure, terms):
    width, height = figure.get_size_inches()
    lines = [line for sentence in terms for line in textwrap.wrap(sentence, int(16 * width))]  # letters to an inch
    figure.set_size_inches(width, height + 0.13 * len(lines))
    with matplotlib.rc_context(_style(PAPER)):
        figure.supxlabel("\n".join(lines), fontsize=7, color=PAPER.quiet)


def _drawn(draw, palette):
    with matplotlib.rc_context(_style(palette)):
        return draw(palette)


def _style(palette):
    return {
        "svg.fonttype": "none",
        "svg.hashsalt": "mesograin",
        "font.family": "sans-serif",
        "font.size": 9,
        "axes.edgecolor": palette.grid,
        "axes.labelcolor": palette.quiet,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "axes.linewidth": 0.8,
        "grid.color": palette.grid,
        "grid.linewidth": 0.6,
        "text.color": palette.ink,
        "xtick.color": palette.quiet,
        "ytick.color": palette.quiet,
        "xtick.major.size": 0,
        "ytick.major.size": 0,
        "xtick.minor.size": 0,
        "ytick.minor.size": 0,
    }


def cost(cases):
    """A plot of error against seconds, a dot a picture: each of ours, its error less the reference's noise but not less
    than its own; each reference, whose error is its noise, with the line along which more samples lead to it."""

    def draw(palette):
        shown = sorted((dot for dot in map(_ours, cases) if dot), key=lambda dot: dot[0])
        theirs = dict(filter(None, map(_theirs, cases)))
        if not shown:
            return None
        figure, axes = new_figure(9.0, 3.1)
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.set_xlabel("time of the picture, s")
        axes.set_ylabel("relative L1")
        seconds, errors = ([dot[part] for dot in [*shown, *theirs.values()]] for part in (0, 1))
        log_axis(axes.xaxis, seconds, 1.8, lambda value, _: f"{value:g}", steps=(1, 3))
        log_axis(axes.yaxis, errors, 2.5, percent, steps=(1, 3))
        axes.set_xlim(right=4.0 * axes.get_xlim()[1])  # room for the names
        top = axes.get_ylim()[1]
        for title, (at, noise) in theirs.items():
            # Noise falls with the root of the time.
            fewer = at * (noise / top) ** 2
            axes.plot([fewer, at], [top, noise], color=palette.theirs, linewidth=1.0, linestyle=(0, (1, 2)))
            axes.plot([at], [noise], marker="s", color=palette.theirs, markersize=6)
        models = [dot[2]["model"] for dot in shown]
        names = [(title, place, palette.quiet, (_RIGHT, _ABOVE, _BELOW)) for title, place in theirs.items()]
        for at, error, case in shown:
            axes.plot([at], [error], marker="o", color=palette.ours, markersize=6)
            twice = models.count(case["model"]) > 1
            label = of_model(case["model"]) + (f", {case['reference_title']}" if twice else "")
            names.append((label, (at, error), palette.ink, (_ABOVE, _BELOW, _RIGHT, _LEFT, _HIGHER, _LOWER)))
        _put_names(axes, names)
        axes.grid(True, which="major")
        return figure

    return draw


# Where a name stands beside its dot: the offset in points, and which of its sides lie there.
_ABOVE, _BELOW = ((0, 8), "center", "bottom"), ((0, -8), "center", "top")
_RIGHT, _LEFT = ((7, 0), "left", "center"), ((-7, 0), "right", "center")
_HIGHER, _LOWER = ((0, 20), "center", "bottom"), ((0, -20), "center", "top")


def _put_names(axes, names):
    """Names of dots, [(text, (x, y), colour, places)], each at the first of its places where it covers no dot and no
    name before it, or where it covers least. Once the axes have their limits."""
    axes.figure.draw_without_rendering()  # lays the axes out
    dots = axes.transData.transform([place for _, place, _, _ in names])
    taken = [Bbox.from_extents(*(dot - 4.0), *(dot + 4.0)) for dot in dots]

    def covered(text):
        over = [Bbox.intersection(text.get_window_extent(), box) for box in taken]
        return sum(box.width * box.height for box in over if box is not None)

    for name, dot, colour, places in names:
        tried = [axes.annotate(name, dot, offset, textcoords="offset points", ha=across, va=along, fontsize=8.5,
                               color=colour) for offset, across, along in places]
        kept = min(tried, key=covered)
        taken.append(kept.get_window_extent())
        for text in tried:
            if text is not kept:
                text.remove()


def _ours(case):
    """(seconds, error, case) of our picture of a case; None where that is not known."""
    error = case["metrics"].get("relative_l1_corrected")
    if error is None:
        return None
    error = max(error, (case.get("our_noise") or {}).get("relative_l1") or 0.0)
    return (case["our_seconds"], error, case) if error > 0.0 and case["our_seconds"] > 0.0 else None


def _theirs(case):
    """(title, (seconds, error)) of a case's reference; None where that is not known."""
    noise, seconds = case["noise_floor"]["relative_l1"], case["reference_seconds"]
    return (case["reference_title"], (seconds, noise)) if noise and seconds else None


def profile(model, reference, noise):
    """A plot of radiance along the line across the picture on which the reference changes most, averaged over a band of
    5 pixels, with the standard error of the reference. noise: (h, w, 3) of single pixels, or None if it is not known.
    """

    def draw(palette):
        line = _steepest_line(reference)
        if line is None:
            return None
        theirs, ours = (_sample_band(pixels, line) for pixels in (reference, model))
        middle = theirs.mean(axis=0)
        along = numpy.linspace(0.0, numpy.hypot(*(line[1] - line[0])), middle.size)
        figure, axes = new_figure(4.4, 2.3)
        label = "reference"
        if noise is not None:
            # Pixels are independent, the channels of one are not: they see the same paths.
            spread = numpy.sqrt((_sample_band(noise, line) ** 2).sum(axis=0)) / len(theirs)
            axes.fill_between(along, middle - spread, middle + spread, color=palette.theirs, alpha=0.3, linewidth=0)
            label = "reference ± standard error"
        axes.plot(along, middle, color=palette.theirs, linewidth=2.6, alpha=0.6, solid_capstyle="round", label=label)
        axes.plot(along, ours.mean(axis=0), color=palette.ours, linewidth=1.2, label="model")
        axes.set_xlabel("distance from the dark end, pixels")
        axes.set_ylabel("radiance, W m⁻² sr⁻¹")
        axes.set_xlim(along[0], along[-1])
        axes.set_ylim(bottom=min([0.0, *ours[numpy.isfinite(ours)]]))
        axes.grid(True, axis="y")
        axes.legend(frameon=False, fontsize=8, loc="upper left")
        return figure

    return draw


def by_angle(profile):
    """A plot of both sides' radiance over the angle to the strongest sun, the channels' mean, with the reference's
    standard error. profile: of results.json."""

    def draw(palette):
        if not profile:
            return None
        ours, theirs = (numpy.mean(profile[name], axis=-1) for name in ("ours", "reference"))
        noise = None if profile["noise"][0] is None else numpy.mean(profile["noise"], axis=-1)
        label = "reference" if noise is None else "reference ± standard error"
        figure, axes = new_figure(4.4, 2.3)
        axes.errorbar(profile["cosine"], theirs, yerr=noise, color=palette.theirs, linewidth=2.6, alpha=0.6,
                      elinewidth=1.0, capsize=2, label=label)
        axes.plot(profile["cosine"], ours, color=palette.ours, linewidth=1.2, marker="o", markersize=2.5, label="model")
        axes.set_xlabel("cosine of the angle between normal and light")
        axes.set_ylabel("radiance, W m⁻² sr⁻¹")
        axes.set_xlim(-1.0, 1.0)
        axes.grid(True, axis="y")
        axes.legend(frameon=False, fontsize=8, loc="upper left")
        return figure

    return draw


def histogram(relative, mask):
    """A plot of how the signed relative error is distributed over the samples of the masked pixels; the outermost bars
    hold all that is beyond."""

    def draw(palette):
        values = 100.0 * relative[mask]
        values = values[numpy.isfinite(values)]
        if not values.size:
            return None
        reach = max(1.5 * float(numpy.percentile(numpy.abs(values), 95.0)), 0.05)
        figure, axes = new_figure(4.4, 2.3)
        axes.hist(numpy.clip(values, -reach, reach), bins=61, range=(-reach, reach), color=palette.ours, alpha=0.75,
                  histtype="stepfilled", linewidth=0, weights=numpy.full(values.size, 100.0 / values.size))
        axes.axvline(0.0, color=palette.quiet, linewidth=0.8)
        axes.axvline(numpy.median(values), color=palette.ink, linewidth=0.8, linestyle=(0, (4, 3)),
                     label=f"median {numpy.median(values):+.2g} %")
        axes.set_xlabel("(model − reference) / (reference + 0.01), %")
        axes.set_ylabel("samples, %")
        axes.set_xlim(-reach, reach)
        axes.grid(True, axis="y")
        axes.legend(frameon=False, fontsize=8, loc="upper left", handlelength=1.6)
        return figure

    return draw


def overview(pictures, terms):
    """A plot of model, reference and false-coloured relative error in a row for each case, with the colour bar: the
    figure for a paper. pictures: [(case, model, reference, mask)], at most a page of them is drawn. terms: [sentence],
    below it."""

    def draw(palette):
        rows = pictures[:12]
        if not rows:
            return None
        height, width = rows[0][1].shape[:2]
        side = 2.0
        figure = Figure(figsize=(3 * side + 1.7, len(rows) * side * height / width + 0.75), layout="constrained")
        FigureCanvasAgg(figure)
        grid = figure.subplots(len(rows), 3, squeeze=False)
        for axes, (case, model, reference, mask) in zip(grid, rows):
            stops = case["exposure_stops"]
            relative = colours.relative_error(model, reference)
            for place, picture in zip(axes, (colours.expose(model, stops), colours.expose(reference, stops),
                                             mask[..., None] * colours.false_colour(relative))):
                place.imshow(picture, interpolation="nearest")
                place.set_xticks([])
                place.set_yticks([])
                place.spines[:].set_visible(False)
            error = form(case["metrics"][headline(case).partition(".")[2]], "percent")
            axes[0].set_ylabel(f"{of_model(case['model'])}\n{error}\nin blocks", color=palette.ink, rotation=0,
                               ha="right", va="center")
        for place, title in zip(grid[0], ("model", "reference", "relative error")):
            place.set_title(title, fontsize=9, color=palette.ink)
        shades = matplotlib.cm.ScalarMappable(matplotlib.colors.LogNorm(*colours.ERROR_RANGE),
                                              ListedColormap(colours.SEQUENTIAL))
        bar = figure.colorbar(shades, ax=grid, location="bottom", shrink=0.66, aspect=50, pad=0.015)
        bar.set_label("|model − reference| / (reference + 0.01), mean of the channels")
        figure.supxlabel("\n".join(textwrap.fill(sentence, 100) for sentence in terms), fontsize=7, color=palette.quiet)
        bar.outline.set_visible(False)
        bar.ax.xaxis.set_major_formatter(FuncFormatter(percent))
        bar.ax.xaxis.set_minor_locator(NullLocator())
        return figure

    return draw


def png(colours):
    """Data URI of (h, w, 3) sRGB-encoded values in [0, 1]."""
    octets = io.BytesIO()
    matplotlib.image.imsave(octets, numpy.ascontiguousarray(colours), format="png")
    return "data:image/png;base64," + base64.b64encode(octets.getvalue()).decode("ascii")


def percent(value, _):
    """A share as an axis shows it."""
    return f"{100 * value:g} %"


def log_axis(axis, values, margin, write, steps=(1, 2, 3, 5, 7)):
    """Limits a logarithmic axis to the values and a margin, with ticks at `steps` of each decade."""
    if not values:
        return
    low, high = min(values) / margin, max(values) * margin
    if high < 4.0 * low:
        low, high = low / 2.0, high * 2.0
    decades = range(int(numpy.floor(numpy.log10(low))), int(numpy.ceil(numpy.log10(high))) + 1)
    axis.set_major_locator(FixedLocator([step * 10.0**decade for decade in decades for step in steps]))
    axis.set_major_formatter(FuncFormatter(write))
    axis.set_minor_locator(NullLocator())
    (axis.axes.set_xlim if axis.axis_name == "x" else axis.axes.set_ylim)(low, high)


def new_figure(width, height):
    """(figure, axes) of a size in inches."""
    figure = Figure(figsize=(width, height), layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.add_subplot()
    axes.set_axisbelow(True)
    return figure, axes


def _svg(figure):
    text = io.StringIO()
    with matplotlib.rc_context(_style(_PAGE)):
        figure.savefig(text, format="svg", metadata=_BARE, transparent=True)
    return text.getvalue()


def _steepest_line(reference):
    """((x, y) of one end, (x, y) of the other), through the middle of what is covered; None if nothing is."""
    covered = reference[..., 3] > 0.5
    if covered.sum() < 16:
        return None
    y, x = numpy.nonzero(covered)
    light = numpy.maximum(numpy.nan_to_num(reference[..., :3].mean(axis=-1)[covered]), 0.0) + 1e-12
    middle = numpy.array([x.mean(), y.mean()])
    bright = numpy.array([numpy.average(x, weights=light), numpy.average(y, weights=light)])
    direction = bright - middle
    length = numpy.hypot(*direction)
    direction = direction / length if length > 1e-3 else numpy.array([1.0, 0.0])
    reach = numpy.stack([x, y], axis=-1) - middle
    near = numpy.abs(reach @ numpy.array([-direction[1], direction[0]])) < 1.0
    along = (reach @ direction)[near]
    return middle + along.min() * direction, middle + along.max() * direction


def _sample_band(pixels, line, half_width=2):
    """Mean of the channels along a line of pixel positions and along its neighbours, nearest pixel: (lines, places)."""
    start, end = line
    count = max(int(numpy.hypot(*(end - start))), 2)
    at = start + numpy.linspace(0.0, 1.0, count)[:, None] * (end - start)
    aside = numpy.array([-(end - start)[1], (end - start)[0]]) / max(numpy.hypot(*(end - start)), 1e-9)
    height, width = pixels.shape[:2]
    bands = []
    for offset in range(-half_width, half_width + 1):
        x, y = numpy.rint(at + offset * aside).astype(int).T
        bands.append(pixels[numpy.clip(y, 0, height - 1), numpy.clip(x, 0, width - 1), :3].mean(axis=-1))
    return numpy.array(bands)
