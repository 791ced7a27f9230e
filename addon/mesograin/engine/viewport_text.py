# A sentence drawn over a viewport's picture, for where Blender's own text line is hidden.
import textwrap

import bpy

# At a UI scale of 1, in pixels.
SIZE, LINE, MARGIN = 11, 17, 12
FONT = 0  # the interface's


def is_hidden(space):
    """Whether a 3D viewport shows no text of Blender's, which would hold what `RenderEngine.update_stats` is told."""
    return not (space.overlay.show_overlays and space.overlay.show_text)


def draw(region, sentence):
    """From a draw callback: wraps the sentence to the region's width, at its upper left corner below the header."""
    import blf

    scale = bpy.context.preferences.system.ui_scale
    blf.size(FONT, SIZE * scale)
    blf.color(FONT, 1.0, 1.0, 1.0, 1.0)
    blf.enable(FONT, blf.SHADOW)
    blf.shadow(FONT, 3, 0.0, 0.0, 0.0, 1.0)
    character = blf.dimensions(FONT, "n")[0]
    columns = max(16, int((region.width - 2 * MARGIN * scale) / character))
    for number, line in enumerate(textwrap.wrap(sentence, columns), 1):
        blf.position(FONT, MARGIN * scale, region.height - (2 * MARGIN + LINE * (1 + number)) * scale, 0.0)
        blf.draw(FONT, line)
    blf.disable(FONT, blf.SHADOW)
