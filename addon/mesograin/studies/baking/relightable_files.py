# A relightable bake on disk: a layer each for artists' tools, an atlas for shaders, and the recipe that reads it.
"""See `write`. Files appear complete or not at all."""

import json
import math

import numpy

from . import lobes

MAPS_A_TEXEL = 3

RECIPE = """\
// Light on {name}, baked by Mesograin: the radiance that leaves it straight up, for irradiance 1 on a plane that faces
// a parallel light. Multiply by the light's irradiance; add what several lights give. Both textures: linear filter,
// clamped to their edges, v upwards, no sRGB. `uv`: the object's; `to_light`: towards the light, in the object's space.
uniform sampler2D coefficients;  // {stem}.atlas.exr
uniform sampler2D lobes;         // {stem}.lobes.exr

vec3 relit(vec2 uv, vec3 to_light) {{
  vec3 n = to_light / dot(abs(to_light), vec3(1.0));
  vec2 p = n.z < 0.0 ? (1.0 - abs(n.yx)) * vec2(n.x < 0.0 ? -1.0 : 1.0, n.y < 0.0 ? -1.0 : 1.0) : n.xy;
  p = (1.0 + (0.5 + 0.5 * p) * {side:.1f}) / {framed:.1f};
  vec3 sum = vec3(0.0);
  for (int k = 0; k < {count}; ++k) {{
    float lobe = texture(lobes, (p + vec2(0.0, float(k / 3))) / vec2(1.0, {rows_of_lobes:.1f}))[k % 3];
    vec2 tile = vec2(float(k % {columns}), float(k / {columns}));
    sum += lobe * texture(coefficients, (uv + tile) / vec2({columns:.1f}, {rows:.1f})).rgb;
  }}
  return max(sum, 0.0);
}}
"""


def grid(count):
    """(columns, rows) of an atlas of `count` tiles."""
    columns = math.ceil(math.sqrt(count))
    return columns, math.ceil(count / columns)


def atlas(textures):
    """One picture of (count, h, w, channels), row 0 at the top: tile k in column k % columns, and in row k // columns
    from below."""
    count, height, width, channels = textures.shape
    columns, rows = grid(count)
    picture = numpy.zeros((rows * height, columns * width, channels), numpy.float32)
    for number, texture in enumerate(textures):
        row, column = rows - 1 - number // columns, number % columns
        picture[row * height:(row + 1) * height, column * width:(column + 1) * width] = texture
    return picture


def lobes_picture(maps):
    """Framed maps, three a texel, above one another; row 0 at the top."""
    framed = lobes.framed(maps.astype(numpy.float32))
    blocks = math.ceil(len(framed) / MAPS_A_TEXEL)
    side = framed.shape[-1]
    picture = numpy.zeros((blocks * side, side, MAPS_A_TEXEL), numpy.float32)
    for number, each in enumerate(framed):
        block = number // MAPS_A_TEXEL
        picture[block * side:(block + 1) * side, :, number % MAPS_A_TEXEL] = each
    return picture[::-1]


def with_margin(native, made, margin):
    """(count, h, w, 3): the textures, charts grown by `margin` texels."""
    return numpy.stack([
        native.extend_margin(numpy.concatenate((texture, made.coverage[..., None]), axis=-1), margin)[..., :3]
        for texture in made.textures])


def paths(output):
    """{kind: path} of all files beside `output`, OUT.exr."""
    return {"layers": output, "atlas": output.with_suffix(".atlas.exr"), "lobes": output.with_suffix(".lobes.exr"),
            "recipe": output.with_suffix(".glsl"), "nodes": output.with_suffix(".blend"),
            "numbers": output.with_suffix(".json")}


def write(native, output, name, made, provenance, key, half=False):
    """Writes all but the node group. provenance: JSON-able, goes to the files' headers under `key`. Raises native.Error
    or OSError."""
    files = paths(output)
    count = len(made.textures)
    columns, rows = grid(count)
    textures = with_margin(native, made, provenance["margin"])
    told = {**provenance, "components": count, "columns": columns, "rows": rows,
            "quantity": "radiance straight above the surface per irradiance of a parallel light on a plane facing it: "
            "the sum of component_NN times lobe NN of the light's direction in the object's space",
            "relative_l1_mean": float(made.errors.mean()), "relative_l1_worst": float(made.errors.max())}
    header = {key: json.dumps(told)}
    layers = numpy.moveaxis(textures, 0, 2).reshape(*textures.shape[1:3], -1)
    native.write_exr(files["layers"], numpy.ascontiguousarray(layers),
                     [f"component_{k:02d}.{channel}" for k in range(count) for channel in "RGB"], header, half)
    native.write_exr(files["atlas"], atlas(textures), attributes=header, half=half)
    native.write_exr(files["lobes"], numpy.ascontiguousarray(lobes_picture(made.maps)), attributes=header)
    files["recipe"].write_text(RECIPE.format(
        name=name, stem=output.stem, side=lobes.SIDE, framed=lobes.SIDE + 2, count=count, columns=columns, rows=rows,
        rows_of_lobes=math.ceil(count / MAPS_A_TEXEL)))
    files["numbers"].write_text(json.dumps({
        **told, "directions": [{"to_light": [float(x) for x in direction], "relative_l1": float(error)}
                               for direction, error in zip(made.judged, made.errors)]}, indent=1) + "\n")
