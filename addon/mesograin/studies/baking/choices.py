# What may be chosen of a bake, for the command line and the panel alike; needs no Blender.

VIEW_FROM = ("above_surface", "active_camera")
"""What looks at the surface, in Blender's words for its own bake; the first is the default."""

LARGEST_SIDE = 16384
"""Texels."""

LARGEST_MARGIN = 32767
"""Texels."""

DEFAULT_MARGIN = 16
"""Texels, as of Blender's own bake."""

FEWEST_COMPONENTS = 2
DEFAULT_COMPONENTS = 8
LARGEST_COMPONENTS = 25
"""Textures of a relightable bake."""

SAMPLES = 64
SAMPLES_OF_A_DIRECTION = 4
"""A texel, unless asked otherwise: of a bake, and of a relightable one."""
