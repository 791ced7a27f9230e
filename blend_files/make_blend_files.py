# Makes the files beside it; run it with the oldest Blender served, so that every later one can open them:
#   blender -b --factory-startup --python-exit-code 1 --python blend_files/make_blend_files.py [-- FOLDER]
import math
import pathlib
import sys

import bpy
from mathutils import Matrix, Vector, noise

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "addon")]

from parts import add_ground, add_object, plain_material  # noqa: E402


def empty_file():
    """A file with nothing in it but a scene that renders with Mesograin to 400 x 400 pixels, over black."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    bpy.context.preferences.filepaths.save_version = 0
    scene = bpy.context.scene
    scene.render.engine = "MESOGRAIN"
    scene.render.resolution_x = scene.render.resolution_y = 400
    scene.render.resolution_percentage = 100
    scene.render.film_transparent = True  # so that alpha is coverage
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_mode = "RGBA"
    scene.render.image_settings.color_depth = "32"
    scene.view_settings.view_transform = "Standard"
    scene.view_settings.exposure = -2.0  # irradiances of 20 are meant to be compared, not looked at
    # What Cycles needs to be compared with: Mesograin's pixel filter is a box of one pixel.
    scene.cycles.pixel_filter_type = "BOX"
    scene.cycles.filter_width = 1.0
    scene.cycles.use_denoising = False
    scene.cycles.use_adaptive_sampling = False
    scene.world = bpy.data.worlds.new("Black")
    scene.world.use_nodes = False
    scene.world.color = (0.0, 0.0, 0.0)
    return scene


def add_sun(name, towards, irradiance):
    light = bpy.data.lights.new(name, "SUN")
    light.energy = irradiance
    light.angle = 0.0
    # A sun shines along its -z axis.
    return add_object(name, light, Vector(towards).to_track_quat("Z", "Y").to_matrix().to_4x4())


def add_camera(matrix, fov_degrees):
    camera = bpy.data.cameras.new("Camera")
    camera.lens_unit = "FOV"
    camera.sensor_fit = "AUTO"
    camera.angle = math.radians(fov_degrees)
    bpy.context.scene.camera = add_object("Camera", camera, matrix)


def add_grain_material(name, **parameters):
    material = bpy.data.materials.new(name)
    for parameter, value in parameters.items():
        setattr(material.mesograin, parameter, value)
    return material


def smooth_mesh(name, vertices, faces, uvs=None):
    """A mesh with smooth shading; `uvs` holds one pair for each corner of each face."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(vertices, [], faces)
    mesh.polygons.foreach_set("use_smooth", [True] * len(faces))
    if uvs is not None:
        mesh.uv_layers.new(name="UVMap").data.foreach_set("uv", [value for uv in uvs for value in uv])
    mesh.update()
    return mesh


def sphere_mesh(radius, segments, rings):
    """A UV sphere around the y axis, outward and unwrapped, whose vertices lie on the sphere."""
    vertices, faces, uvs = [], [], []
    for ring in range(rings + 1):
        polar = math.pi * ring / rings
        for segment in range(1 if ring in (0, rings) else segments):
            azimuth = 2.0 * math.pi * segment / segments
            vertices.append((radius * math.sin(polar) * math.sin(azimuth), radius * math.cos(polar),
                             radius * math.sin(polar) * math.cos(azimuth)))

    def vertex(ring, segment):
        if ring == 0:
            return 0
        if ring == rings:
            return len(vertices) - 1
        return 1 + (ring - 1) * segments + segment % segments

    for ring in range(rings):
        for segment in range(segments):
            corners = [(ring, segment), (ring + 1, segment), (ring + 1, segment + 1), (ring, segment + 1)]
            if ring == 0:
                corners.pop()  # both upper corners are the pole
            elif ring == rings - 1:
                corners.pop(2)
            faces.append([vertex(*corner) for corner in corners])
            uvs += [(s / segments, 1.0 - r / rings) for r, s in corners]
    return smooth_mesh("Sphere", vertices, faces, uvs)


def make_sphere(suns=(("Front", (1.0, 1.0, 1.0), 20.0), ("Back", (-1.0, -1.0, -1.6), 10.0))):
    """A sphere of diameter 4.8 before a camera at 6.5 with 45 degrees, under two suns: the scene of the comparison.
    Its coordinates are literal: y is up and the camera looks along -z, as a Blender camera without rotation does.
    suns: (name, direction to the light, irradiance) each."""
    empty_file()
    sphere = add_object("Sphere", sphere_mesh(2.4, 128, 64))
    sphere.data.materials.append(add_grain_material(
        "Translucent", model="model_1", sigma_s=(0.9,) * 3, sigma_a=(0.1,) * 3, g=0.0, eta=1.3, roughness=0.3,
        scale=20.0))
    add_camera(Matrix.Translation((0.0, 0.0, 6.5)), 45.0)
    for sun in suns:
        add_sun(*sun)


def make_sphere_back_lit():
    """The same sphere, its one sun behind it: what is seen has gone through the grain."""
    make_sphere([("Back", (-0.3, 0.4, -1.0), 20.0)])


def sand_radius(direction):
    """Radius of the grain towards a unit vector: a body cut by planes, worn by noise, with one hollow."""
    cuts = ((Vector((0.9, 0.2, 0.4)), 0.74), (Vector((-0.7, 0.6, 0.3)), 0.80), (Vector((-0.2, -0.9, 0.4)), 0.70),
            (Vector((0.3, 0.7, -0.7)), 0.80), (Vector((-0.8, -0.4, -0.5)), 0.84), (Vector((0.4, -0.5, -0.8)), 0.76),
            (Vector((0.1, 0.35, 0.95)), 0.78), (Vector((0.5, 0.9, 0.3)), 0.80), (Vector((-0.9, -0.5, 0.5)), 0.80))
    sharpness = 20  # of the edges between the cuts
    inverse = sum((max(direction.dot(normal.normalized()), 0.0) / distance) ** sharpness for normal, distance in cuts)
    body = (inverse + 1.1 ** -sharpness) ** (-1.0 / sharpness)  # nearly the least of the planes and a sphere
    worn = (0.035 * noise.noise(2.3 * direction + Vector((3.1, 0.7, 5.2)))
            + 0.020 * noise.noise(6.1 * direction + Vector((1.4, 9.2, 0.3)))
            + 0.006 * noise.noise(11.0 * direction))
    hollow = 0.24 * math.exp(-direction.angle(Vector((0.05, -0.1, 1.0))) ** 2 / (2.0 * 0.24 ** 2))
    return body + worn - hollow


def make_grain():
    """One irregular grain of sand, 2 mm across, faceted, worn and with a concavity, on a Blender unit of 1 mm."""
    empty_file()
    mesh = sphere_mesh(1.0, 96, 48)
    mesh.name = "Grain"
    for vertex in mesh.vertices:
        direction = vertex.co.normalized()
        vertex.co = Vector((1.2, 0.95, 1.0)) * sand_radius(direction) * direction
    mesh.update()
    grain = add_object("Grain", mesh)
    grain.data.materials.append(add_grain_material(
        "Sand", model="model_1", sigma_s=(9.0, 8.2, 6.6), sigma_a=(0.09, 0.22, 0.62), g=0.0, eta=1.54, roughness=0.35,
        scale=1.0))
    towards = Vector((0.45, 0.3, 1.0)).normalized()
    rotation = towards.to_track_quat("Z", "Y").to_matrix().to_4x4()
    add_camera(Matrix.Translation(4.2 * towards) @ rotation, 34.0)
    add_sun("Key", (1.0, 0.9, 0.15), 14.0)
    add_sun("Rim", (-1.0, 0.2, -0.7), 6.0)
    add_sun("Fill", (-0.7, -0.3, 0.8), 1.5)


def look_from(place, at, fov_degrees):
    """A camera at a place, upright, that looks at another."""
    towards = Vector(place) - Vector(at)
    add_camera(Matrix.Translation(place) @ towards.to_track_quat("Z", "Y").to_matrix().to_4x4(), fov_degrees)


def lit_world(scene, colour):
    scene.world.color = colour
    scene.render.film_transparent = False
    scene.view_settings.exposure = 0.0


def make_heap():
    """Two thousand grains of sand, three shapes of them, that fell to a heap on the ground; a Blender unit is 10 mm."""
    from mesograin.grains import objects

    scene = empty_file()
    scene.render.resolution_x, scene.render.resolution_y = 480, 320
    scene.mesograin.millimetres_per_unit = 10.0
    heap = objects.pile_of(["sand"] * 3, 2000, 0.05, "Heap", seed=1, segments=10, variation=0.3)
    scene.collection.objects.link(heap)
    sand = next(material for material in bpy.data.materials if material.name == "Sand")
    sand.mesograin_colours.vary = True
    sand.mesograin_colours.colour_from, sand.mesograin_colours.colour_to = (0.4, 0.4, 0.4), (1.6, 1.7, 1.9)
    add_ground(4.0, plain_material("Ground", (0.35, 0.33, 0.3)))
    add_sun("Sun", (0.6, -0.5, 0.7), 3.0)
    lit_world(scene, (0.25, 0.3, 0.38))
    look_from((0.9, -5.4, 2.7), (0.0, 0.0, 0.2), 36.0)


def make_studio():
    """A few grains on a ground with a texture, under an area light, a spot and a point; a Blender unit is 1 mm."""
    from mesograin.grains import objects

    scene = empty_file()
    scene.render.resolution_x, scene.render.resolution_y = 480, 320
    for kind, place, size, seed in (("sand", (-1.6, 0.1, 0.55), 0.75, 3), ("salt", (0.0, -0.3, 0.52), 0.65, 1),
                                    ("sugar", (1.5, 0.2, 0.62), 0.75, 2), ("bead", (0.3, 1.5, 0.6), 0.6, 0)):
        grain = objects.add_grain(kind, size=size, seed=seed, segments=24)
        scene.collection.objects.link(grain)
        grain.rotation_euler = (0.0, 0.0, 0.4 * seed)
        lowest = min(vertex.co.z for vertex in grain.data.vertices)
        grain.location = (place[0], place[1], -lowest)
    ground = plain_material("Ground", (0.4, 0.38, 0.35))
    surface = next(node for node in ground.node_tree.nodes if node.type == "BSDF_DIFFUSE")
    texture = ground.node_tree.nodes.new("ShaderNodeTexImage")
    texture.image = boards()
    ground.node_tree.links.new(texture.outputs["Color"], surface.inputs["Color"])
    add_ground(8.0, ground)
    for name, kind, place, energy in (("Area", "AREA", (-3.0, -3.0, 5.0), 300.0),
                                      ("Spot", "SPOT", (4.0, -1.0, 3.5), 400.0),
                                      ("Point", "POINT", (1.0, 4.0, 2.0), 60.0)):
        light = bpy.data.lights.new(name, kind)
        light.energy = energy
        if kind == "AREA":
            light.size = 2.0
        else:
            light.shadow_soft_size = 0.2
        add_object(name, light, Matrix.Translation(place) @ Vector(place).to_track_quat("Z", "Y").to_matrix().to_4x4())
    lit_world(scene, (0.06, 0.07, 0.09))
    look_from((0.6, -10.0, 5.0), (0.0, 0.2, 0.4), 32.0)


def boards():
    """A small image of boards, packed into the file."""
    side = 64
    image = bpy.data.images.new("Boards", side, side)
    pixels = []
    for y in range(side):
        for x in range(side):
            board = x // 8
            shade = 0.55 + 0.12 * math.sin(7.0 * board) + 0.05 * noise.noise(Vector((3.0 * board, 0.2 * y, 1.3 * x)))
            shade *= 0.4 if x % 8 == 0 else 1.0
            pixels += [shade, 0.78 * shade, 0.55 * shade, 1.0]
    image.pixels.foreach_set(pixels)
    image.pack()
    return image


def main():
    import addon_utils

    addon_utils.enable("mesograin")
    folder = pathlib.Path(sys.argv[sys.argv.index("--") + 1]) if "--" in sys.argv else HERE
    for name, make in (("sphere", make_sphere), ("sphere_back_lit", make_sphere_back_lit), ("grain", make_grain),
                       ("heap", make_heap), ("studio", make_studio)):
        make()
        bpy.ops.wm.save_as_mainfile(filepath=str(folder / f"{name}.blend"), compress=True)


if __name__ == "__main__":
    main()
