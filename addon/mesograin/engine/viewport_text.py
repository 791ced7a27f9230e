# What is said over a viewport's picture: how much of it fits, and sentences that Blender's own text line cannot hold.
import textwrap

from ..schema import labels

# At a UI scale of 1, in pixels.
SIZE, LINE, MARGIN = 11, 17, 12
CHARACTER = 6.0  # of Blender's own text line, on average
NAVIGATION = 90  # what the gizmo that turns the view takes of the right end
FEWEST = 24  # characters that a sentence is worth
LEAST = 60  # columns that sentences are left, beside which there is room for facts
FONT = 0  # the interface's
PLACE = "Render Properties > Sampling"
"""Where every sentence is read in full."""


def is_hidden(space):
    """Whether a 3D viewport shows no text of Blender's, which would hold what `RenderEngine.update_stats` is told."""
    return not (space.overlay.show_overlays and space.overlay.show_text)


def columns(context):
    """How many characters of Blender's text line are seen beside the toolbar, the sidebar and the navigation gizmo."""
    space = context.space_data
    left, right = _free(context)
    if space.show_gizmo and space.show_gizmo_navigate:
        right -= NAVIGATION * context.preferences.system.ui_scale
    return int((right - left) / (CHARACTER * context.preferences.system.ui_scale))


def line(sentences, fitting):
    """The first of sentences and how many more there are, in as many characters as fit."""
    first, *others = sentences
    more = f" (and {len(others)} more: {PLACE})" if others else ""
    if len(first) + len(more) <= fitting:
        return first + more
    more = more or f" ({PLACE})"
    return textwrap.shorten(first, max(fitting - len(more), FEWEST), placeholder=" …") + more


def facts(models, timings, device):
    """By which models, in what time a sample and where the picture is drawn. models: names; timings: (pass,
    milliseconds) of a sample; device: as native.device_info()'s renderer, such as 'llvmpipe (LLVM 15.0.6, 256 bits)'
    or 'NVIDIA RTX A2000/PCIe/SSE2'."""
    milliseconds = sum(taken for _, taken in timings)
    time = f"{milliseconds:.2g}" if milliseconds < 10.0 else f"{milliseconds:.0f}"
    parts = [", ".join(labels.of_model(name) for name in models), f"{time} ms a sample",
             device.split("(")[0].split("/")[0].strip()]
    return " | ".join(part for part in parts if part)


def draw(context, sentence, below=False):
    """From a draw callback: wraps the sentence to what is free of the region, at its upper left corner below the
    header, or below all that Blender writes there."""
    import blf

    region, scale = context.region, context.preferences.system.ui_scale
    blf.size(FONT, SIZE * scale)
    blf.color(FONT, 1.0, 1.0, 1.0, 1.0)
    blf.enable(FONT, blf.SHADOW)
    blf.shadow(FONT, 3, 0.0, 0.0, 0.0, 1.0)
    left, right = _free(context)
    fitting = max(16, int((right - left - 2 * MARGIN * scale) / blf.dimensions(FONT, "n")[0]))
    top = region.height // 2 if below else region.height - (2 * MARGIN + LINE) * scale
    for number, text in enumerate(textwrap.wrap(sentence, fitting), 1):
        blf.position(FONT, left + MARGIN * scale, top - LINE * number * scale, 0.0)
        blf.draw(FONT, text)
    blf.disable(FONT, blf.SHADOW)


def _free(context):
    """(left, right) of a region, in its pixels, between what lies over its sides."""
    region = context.region
    left, right = region.x, region.x + region.width
    for other in context.area.regions:
        if other.type in ("TOOLS", "UI") and other.width > 1 and other.x < right and other.x + other.width > left:
            if other.alignment == "RIGHT":
                right = min(right, other.x)
            else:
                left = max(left, other.x + other.width)
    return left - region.x, max(left, right) - region.x
