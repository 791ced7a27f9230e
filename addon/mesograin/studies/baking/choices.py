# What may be chosen of a bake, for the command line and the panel alike; needs no Blender.

VIEW_FROM = ("above_surface", "active_camera")
"""What looks at the surface, in Blender's words for its own bake; the first is the default."""

LARGEST_SIDE = 16384
"""Texels."""

LARGEST_MARGIN = 32767
"""Texels."""

DEFAULT_MARGIN = 16
"""Texels, as of Blender's own bake."""

DEFAULT_COMPONENTS = 8
LARGEST_COMPONENTS = 25
"""Textures of a relightable bake."""
