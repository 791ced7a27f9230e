# How wide a region is, and what of that text has, at a UI scale of 1 in pixels.
CHARACTER_WIDTH = 6.5  # of a character, on average
MARGINS = 75  # what margins and an icon take of a panel's width
LABELS = 0.4  # the share of the rest that Blender gives to what stands before its buttons
USUAL = 300  # of no region at all, as in a script


def width(context):
    """Of the region that is drawn."""
    return context.region.width / context.preferences.system.ui_scale if context.region else USUAL
