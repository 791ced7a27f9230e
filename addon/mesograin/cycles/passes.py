# Cycles' glossy pass, and by it a picture's two parts: what the surface reflects, and what entered the grain.
"""See `ask_for` and `read`. What entered is all light less the glossy pass: what was refracted into a volume and comes
back stands in none of Cycles' own passes (seen on Blender 3.4)."""

import numpy


def ask_for(scene):
    """Has a staged scene render a file of many layers that holds the glossy pass."""
    scene.render.image_settings.file_format = "OPEN_EXR_MULTILAYER"
    layer = scene.view_layers[0]
    layer.use_pass_glossy_direct = layer.use_pass_glossy_indirect = layer.use_pass_glossy_color = True


def read(pixels, channels, light):
    """(h, w, 4) float32: 'reflected' or 'entered' light, and the alpha of all. pixels, channels: of the file."""

    def layer(name, parts="RGB"):
        endings = [f".{name}.{part}" for part in parts]
        return pixels[..., [next(at for at, each in enumerate(channels) if each.endswith(end)) for end in endings]]

    found = numpy.array(layer("Combined", "RGBA"))
    # The light of a pass is divided by the colour of what reflected it.
    reflected = (layer("GlossDir") + layer("GlossInd")) * layer("GlossCol")
    found[..., :3] = reflected if light == "reflected" else found[..., :3] - reflected
    return found
