# How wide a region is, and what of that text has, at a UI scale of 1 in pixels.
CHARACTER_WIDTH = 6.5  # of a character, on average
MARGINS = 75  # what margins and an icon take of a panel's width
LABELS = 0.4  # the share of the rest that Blender gives to what stands before its buttons
LONGEST = 11  # characters of what we say before a button: "Cryptomatte"
USUAL = 300  # of no region at all, as in a script


def arrange(layout, context):
    """What properties are called stands before them, as Blender has it; in a region that is too narrow for ours, such
    as its own Properties editor on a screen 1280 wide, in them or above."""
    layout.use_property_split = LONGEST * CHARACTER_WIDTH <= LABELS * (width(context) - MARGINS)


def choose(layout, owner, name, text):
    """A property that is one of a list: beside it Blender leaves what it is called, where `arrange` had no room, but a
    quarter of the width."""
    if layout.use_property_split:
        layout.prop(owner, name, text=text)
        return
    column = layout.column(align=True)
    column.label(text=text)
    column.prop(owner, name, text="")


def width(context):
    """Of the region that is drawn."""
    return context.region.width / context.preferences.system.ui_scale if context.region else USUAL
