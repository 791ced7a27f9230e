# The node group that lights a baked surface anew, in Cycles and in EEVEE.
"""See `build`, and `save`, which puts it into a .blend file to append from."""

import bpy

from ... import compat
from . import lobes
from .relightable_files import MAPS_A_TEXEL, grid

NEXT_TO_NOTHING = 1e-4  # of the side of a map of 26 texels; less is lost in float numbers from pixel to pixel
SOCKETS = (("To Light", "NodeSocketVector", (0.0, 0.0, 1.0)), ("Irradiance", "NodeSocketColor", (1.0, 1.0, 1.0, 1.0)))


class _Wires:
    """Nodes of a tree, made and linked by what flows in; what is no socket is a constant."""

    def __init__(self, tree):
        self._tree = tree

    def node(self, kind, *sources, **settings):
        made = self._tree.nodes.new(kind)
        for name, value in settings.items():
            setattr(made, name, value)
        for socket, source in zip(made.inputs, sources):
            if isinstance(source, bpy.types.NodeSocket):
                self._tree.links.new(source, socket)
            elif source is not None:
                socket.default_value = source
        return made.outputs

    def math(self, operation, *sources):
        return self.node("ShaderNodeMath", *sources, operation=operation)[0]

    def vector(self, operation, *sources):
        outputs = self.node("ShaderNodeVectorMath", *sources, operation=operation)
        return outputs["Value" if operation in ("DOT_PRODUCT", "LENGTH") else "Vector"]

    def image(self, image, place):
        made = self._tree.nodes.new("ShaderNodeTexImage")
        made.image, made.interpolation, made.extension = image, "Linear", "EXTEND"
        self._tree.links.new(place, made.inputs["Vector"])
        return made.outputs["Color"]


def build(name, atlas, maps, count, eta=None):
    """The node group `name`: from the direction to a light in the world and its irradiance to the radiance of the
    object that wears it, which goes to an Emission. atlas, maps: images as relightable_files has them, `count`
    components. eta: of the surface that light leaves through, which lets less out slantwise; None for no such."""
    group = bpy.data.node_groups.new(name, "ShaderNodeTree")
    for socket, kind, default in SOCKETS:
        compat.add_group_socket(group, socket, "INPUT", kind).default_value = default
    compat.add_group_socket(group, "Radiance", "OUTPUT", "NodeSocketColor")
    wires = _Wires(group)
    given = wires.node("NodeGroupInput")
    square = _on_the_map(wires, given["To Light"])
    uv = wires.node("ShaderNodeUVMap")["UV"]
    amounts = _lobes(wires, square, uv, maps, count)
    columns, rows = grid(count)
    total = None
    for component, amount in enumerate(amounts):
        tile = (component % columns, component // columns, 0.0)
        place = wires.vector("DIVIDE", wires.vector("ADD", uv, tile), (columns, rows, 1.0))
        share = wires.node("ShaderNodeVectorMath", operation="SCALE")
        scale = share["Vector"].node
        group.links.new(wires.image(atlas, place), scale.inputs["Vector"])
        group.links.new(amount, scale.inputs["Scale"])
        total = share["Vector"] if total is None else wires.vector("ADD", total, share["Vector"])
    radiance = wires.vector("MULTIPLY", wires.vector("MAXIMUM", total, (0.0,) * 3), given["Irradiance"])
    if eta is not None:
        scale = wires.node("ShaderNodeVectorMath", operation="SCALE")["Vector"].node
        group.links.new(radiance, scale.inputs["Vector"])
        group.links.new(_let_out(wires, eta), scale.inputs["Scale"])
        radiance = scale.outputs["Vector"]
    wires.node("NodeGroupOutput", radiance)
    return group


def _on_the_map(wires, to_light):
    """(x, y) on the octahedral map, 0 to 1 over a framed one."""
    towards = wires.node("ShaderNodeVectorTransform", to_light, vector_type="VECTOR", convert_from="WORLD",
                         convert_to="OBJECT")[0]
    size = wires.vector("DOT_PRODUCT", wires.vector("ABSOLUTE", towards), (1.0,) * 3)
    x, y, z = wires.node("ShaderNodeSeparateXYZ", towards)
    x, y, z = (wires.math("DIVIDE", part, size) for part in (x, y, z))
    below = wires.math("LESS_THAN", z, 0.0)
    placed = []
    for along, across in ((x, y), (y, x)):
        sign = wires.math("SUBTRACT", 1.0, wires.math("MULTIPLY", 2.0, wires.math("LESS_THAN", along, 0.0)))
        folded = wires.math("MULTIPLY", wires.math("SUBTRACT", 1.0, wires.math("ABSOLUTE", across)), sign)
        moved = wires.math("MULTIPLY", below, wires.math("SUBTRACT", folded, along))
        on_map = wires.math("MULTIPLY_ADD", wires.math("ADD", along, moved), 0.5 * lobes.SIDE, 0.5 * lobes.SIDE + 1.0)
        placed.append(wires.math("DIVIDE", on_map, lobes.SIDE + 2.0))
    return placed


def _lobes(wires, square, uv, maps, count):
    """A socket for each component: how much of it there is. Where a picture is looked up at the very same place all
    over an object, EEVEE of Blender 4.3 sees black on a software device: it moves by next to nothing along `uv`."""
    blocks = -(-count // MAPS_A_TEXEL)
    found, moves = [], wires.vector("MULTIPLY", uv, (NEXT_TO_NOTHING, NEXT_TO_NOTHING, 0.0))
    for block in range(blocks):
        v = wires.math("DIVIDE", wires.math("ADD", square[1], float(block)), float(blocks))
        place = wires.node("ShaderNodeCombineXYZ", square[0], v, 0.0)[0]
        found.extend(wires.node("ShaderNodeSeparateXYZ", wires.image(maps, wires.vector("ADD", place, moves))))
    return found[:count]


def _let_out(wires, eta):
    """What a smooth surface lets out towards the viewer, as a part of what it lets out straight up."""
    straight = 1.0 - ((eta - 1.0) / (eta + 1.0)) ** 2
    reflected = wires.node("ShaderNodeFresnel", eta)[0]
    return wires.math("DIVIDE", wires.math("SUBTRACT", 1.0, reflected), straight)


def load_images(files):
    """(atlas, lobes) of relightable_files.paths, as numbers rather than colours."""
    images = [bpy.data.images.load(str(files[kind].absolute())) for kind in ("atlas", "lobes")]
    for image in images:
        image.colorspace_settings.name = "Non-Color"
        image.alpha_mode = "NONE"
    return images


def save(files, name, count, eta=None):
    """Writes the node group `name` to files["nodes"], to append from; the open file stays as it is."""
    images = load_images(files)
    group = build(name, *images, count, eta)
    try:
        bpy.data.libraries.write(str(files["nodes"].absolute()), {group}, path_remap="RELATIVE_ALL", fake_user=True)
    finally:
        bpy.data.node_groups.remove(group)
        for image in images:
            bpy.data.images.remove(image)
