# Cycles' glossy pass, and by it a picture's two parts: what the surface reflects, and what entered the grain.
"""See `ask_for` and `read`. What entered is all light less the glossy pass: what was refracted into a volume and comes
back stands in none of Cycles' own passes (seen on Blender 3.4)."""

import numpy

from .. import compat


def ask_for(scene):
    """Has a staged scene render a file of many layers that holds the glossy pass."""
    compat.ask_for_layers(scene.render.image_settings)
    layer = scene.view_layers[0]
    layer.use_pass_glossy_direct = layer.use_pass_glossy_indirect = layer.use_pass_glossy_color = True


def read(pixels, channels, light):
    """(h, w, 4) float32: 'reflected' or 'entered' light, and the alpha of all. pixels, channels: of the file."""

    def layer(*names, parts="RGB"):
        """Of the pass that bears one of these names."""
        places = {each.split(".", 1)[-1]: at for at, each in enumerate(channels)}  # without the view layer's name
        name = next(name for name in names if f"{name}.{parts[0]}" in places)
        return pixels[..., [places[f"{name}.{part}"] for part in parts]]

    found = numpy.array(layer("Combined", parts="RGBA"))
    # The light of a pass is divided by the colour of what reflected it. Blender 5 writes the names out.
    direct, indirect, colour = (layer(f"Gloss{short}", f"Glossy {name}") for short, name in (
        ("Dir", "Direct"), ("Ind", "Indirect"), ("Col", "Color")))
    reflected = (direct + indirect) * colour
    found[..., :3] = reflected if light == "reflected" else found[..., :3] - reflected
    return found
