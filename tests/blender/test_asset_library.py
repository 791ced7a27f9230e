# The asset library: what it holds, how Blender is told of it, and scattered grains beside Cycles.
import bpy
import numpy as np
import pytest
from test_colours_of_instances import as_cycles_has_it
from test_export import add_camera, add_object, add_sun, read_scene

from mesograin import compat
from mesograin.grains import kinds
from mesograin.schema import presets
from mesograin.schema.parameters import PARAMETERS
from mesograin.ui import asset_library, look
from mesograin.ui import presets as preset_menu

SIZE = 96


@pytest.fixture
def library():
    """All that the library holds, appended."""
    with bpy.data.libraries.load(str(asset_library.FILE), link=False, assets_only=True) as (there, taken):
        for kind in ("objects", "materials", "collections", "node_groups"):
            setattr(taken, kind, list(getattr(there, kind)))
    return taken


def test_it_holds_every_grain_and_every_preset_as_the_menus_have_them(library):
    assert asset_library.FILE.stat().st_size < 1e6
    title = {kind: kind.replace("_", " ").title() for kind in kinds.KINDS}
    assert {grain.name for grain in library.objects} == set(title.values())
    assert {each.name for each in library.collections} == {asset_library.shapes_name(kind) for kind in kinds.KINDS}
    assert [group.name for group in library.node_groups] == [asset_library.SCATTER]
    assert {material.name for material in library.materials} == {
        preset.name for group in presets.GROUPS for preset in group.presets}
    fresh = bpy.data.materials.new("Fresh").mesograin
    for preset in presets.BY_IDENTIFIER.values():
        fresh.model = "lambert"
        preset_menu.apply(preset, fresh)
        kept = bpy.data.materials[preset.name].mesograin
        for name in PARAMETERS:
            expected, found = getattr(fresh, name), getattr(kept, name)
            assert (tuple(found) == tuple(expected)) if PARAMETERS[name].kind == "rgb" else found == expected, name


def test_its_grains_are_those_that_add_grain_makes(library):
    for grain in library.objects:
        corners = np.empty((len(grain.data.vertices), 3), dtype=np.float32)
        grain.data.vertices.foreach_get("co", corners.ravel())
        kind = grain.name.lower().replace(" ", "_")
        np.testing.assert_allclose(corners, kinds.make(kind, segments=16).vertices, atol=1e-5, err_msg=kind)


def test_each_has_a_picture_and_a_place_in_the_tree(library):
    lines = (asset_library.FOLDER / "blender_assets.cats.txt").read_text().splitlines()
    folders = {line.split(":")[0]: line.split(":")[1] for line in lines if line.count(":") == 2}
    for thing in (*library.objects, *library.materials, *library.collections, *library.node_groups):
        assert folders[thing.asset_data.catalog_id].startswith("Mesograin/")
        assert thing.asset_data.description
        pixels = np.array(thing.preview.image_pixels_float[:]).reshape(-1, 4)
        assert len(pixels) >= 64**2 and pixels[:, :3].std() > 0.02, f"{thing.name} has no picture"


def test_the_asset_browser_is_told_of_it_once():
    libraries = bpy.context.preferences.filepaths.asset_libraries
    before = len(libraries)
    assert bpy.ops.mesograin.add_asset_library() == {"FINISHED"}
    assert libraries[-1].name == asset_library.NAME and asset_library.registered(bpy.context)
    assert not bpy.ops.mesograin.add_asset_library.poll()
    bpy.ops.preferences.asset_library_remove(index=before)
    assert not asset_library.registered(bpy.context)


def ground(**chosen):
    """A black square with scattered grains under a sun; gives the modifier."""
    add_sun((0.0, 0.0, 1.0), 3.0)
    mesh = bpy.data.meshes.new("Ground")
    mesh.from_pydata([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], [], [(0, 1, 2, 3)])
    square = add_object("Ground", mesh)
    bpy.context.view_layer.objects.active = square
    square.data.materials.append(bpy.data.materials.new("Ground"))
    assert bpy.ops.mesograin.scatter(**{"kind": "sand", **chosen}) == {"FINISHED"}
    square.data.materials[0].mesograin.model = "lambert"
    square.data.materials[0].mesograin.reflectance = (0.0, 0.0, 0.0)
    return square.modifiers[0]


def choose(modifier, **values):
    for name, value in values.items():
        compat.set_modifier_input(modifier, name.replace("_", " "), value)
    modifier.id_data.update_tag()


def factors():
    """(n, 3) of all grains."""
    scene = read_scene()
    assert scene.warnings == ()
    return np.concatenate([np.frombuffer(numbers, dtype=np.float32).reshape(-1, 3)
                           for heap in scene.heaps for _, numbers in heap.factors])


def test_scattered_grains_are_as_asked_for():
    modifier = ground()
    found = factors()
    assert len(found) > 150 and len(np.unique(found[:, 0])) > 0.9 * len(found)
    assert 0.5 <= found.min() < 0.7 and 1.3 < found.max() <= 1.5
    choose(modifier, Colour_Spread=0.0)
    assert (factors() == 1.0).all()
    choose(modifier, Density=20.0)
    few = read_scene().instances[1:]  # the square is the first; shapes of few grains are drawn one by one
    assert 40 < len(few) < 100
    assert all(each.material == few[0].material for each in few)
    choose(modifier, Colour_Spread=1.0)
    colours = {dict(each.material.values)["sigma_a"] for each in read_scene().instances[1:]}
    assert len(colours) > 0.9 * len(few)
    sizes = [[np.cbrt(np.linalg.det(np.array(each).reshape(4, 4)[:3, :3])) for each in heap.each()]
             for heap in _heaps(modifier, Density=200.0)]
    sizes = np.concatenate(sizes)
    assert sizes.min() >= 0.7 * 0.05 * 0.999 and sizes.max() <= 1.3 * 0.05 * 1.001 and sizes.std() > 0.005
    before = [heap.placings for heap in _heaps(modifier, Seed=0)]
    assert [heap.placings for heap in _heaps(modifier, Seed=1)] != before
    assert [heap.placings for heap in _heaps(modifier, Seed=0)] == before
    choose(modifier, Turn=0.0)
    upright = [np.array(each).reshape(4, 4)[:3, 2] for heap in read_scene().heaps for each in heap.each()]
    np.testing.assert_allclose(np.array(upright)[:, :2], 0.0, atol=1e-6)


def _heaps(modifier, **values):
    choose(modifier, **values)
    return read_scene().heaps


def test_another_scatter_takes_the_same_nodes_and_shapes():
    first, second = ground(), ground()
    assert first.node_group == second.node_group and first.node_group.asset_data is None
    assert len(bpy.data.collections) == 1 and len(bpy.data.node_groups) == 1
    ground(kind="salt")
    assert len(bpy.data.collections) == 2 and len(bpy.data.node_groups) == 1


def test_grains_are_strewn_on_the_surface_and_not_on_grains(native):
    square = ground(kind="sand").id_data
    [sand] = {dict(heap.material.values)["sigma_a"] for heap in read_scene().heaps}
    alone = placings(sand)
    assert bpy.ops.mesograin.scatter(kind="salt", seed=1) == {"FINISHED"}
    assert placings(sand) == alone and 0.5 * len(alone) < len(placings()) - len(alone) < 2.0 * len(alone)
    assert len(factors()) == len(placings())
    choose(square.modifiers[1], Show_Surface=False)
    assert placings(sand) == alone and [each.mesh for each in read_scene().instances] == []


def placings(of=None):
    """Where grains are, sorted; of: the sigma_a of their material."""
    return sorted(tuple(each) for heap in read_scene().heaps for each in heap.each()
                  if of in (None, dict(heap.material.values)["sigma_a"]))


def test_the_grains_material_is_the_surfaces_active_one():
    square = ground().id_data
    assert square.active_material.name == "Strewn Sand" and square.active_material_index == 1
    bpy.ops.mesograin.scatter(kind="sand", seed=1)
    bpy.ops.mesograin.scatter(kind="salt")
    assert [slot.name for slot in square.material_slots] == ["Ground", "Strewn Sand", "Strewn Salt"]
    assert square.active_material.name == "Strewn Salt"
    square.active_material.mesograin.sigma_a = (0.25, 0.5, 1.0)
    assert [each for each in read_scene().heaps if dict(each.material.values)["sigma_a"] == (0.25, 0.5, 1.0)]


def test_how_thick_the_surface_is_says_nothing_of_its_grains(native):
    bpy.ops.mesh.primitive_uv_sphere_add()
    dune = bpy.context.object
    dune.data.materials.append(bpy.data.materials.new("Dune"))
    dune.active_material.mesograin.model = "model_2"
    assert look.hint(dune.active_material, dune, 1.0) and look.advise(dune.active_material, dune, 1.0)
    assert bpy.ops.mesograin.scatter(kind="sand") == {"FINISHED"}
    assert dune.active_material.name == "Strewn Sand"
    assert look.hint(dune.active_material, dune, 1.0) == "" and look.advise(dune.active_material, dune, 1.0) is None
    assert look.hint(bpy.data.materials["Dune"], dune, 1.0)


def test_a_surface_without_a_material_stays_without():
    mesh = bpy.data.meshes.new("Ground")
    mesh.from_pydata([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], [], [(0, 1, 2, 3)])
    bpy.context.view_layer.objects.active = square = add_object("Ground", mesh)
    before = read_scene().instances[0].material
    assert bpy.ops.mesograin.scatter(kind="sand") == {"FINISHED"}
    assert [slot.name for slot in square.material_slots] == ["", "Strewn Sand"]
    assert read_scene().instances[0].material == before


def test_colours_are_those_of_cycles(render):
    choose(ground(), Size=0.09, Show_Surface=False)
    [material] = {each.active_material for each in bpy.data.collections["Many Sand"].objects}
    material.mesograin.model = "lambert"
    material.mesograin.reflectance = (0.6, 0.5, 0.4)
    tree = _nodes(material)
    diffuse, mixed, attribute, end = map(tree.nodes.new, (
        "ShaderNodeBsdfDiffuse", "ShaderNodeVectorMath", "ShaderNodeAttribute", "ShaderNodeOutputMaterial"))
    attribute.attribute_type, attribute.attribute_name = "INSTANCER", material.mesograin_colours.colour_attribute
    mixed.operation = "MULTIPLY"
    mixed.inputs[1].default_value = (0.6, 0.5, 0.4)
    for start, to in ((attribute.outputs["Vector"], mixed.inputs[0]), (mixed.outputs[0], diffuse.inputs["Color"]),
                      (diffuse.outputs[0], end.inputs["Surface"])):
        tree.links.new(start, to)
    add_camera((0.0, 0.0, 5.0), type="ORTHO", ortho_scale=2.0)
    scene = bpy.context.scene
    scene.mesograin.exchange, scene.mesograin.samples = "off", 8
    scene.render.resolution_x = scene.render.resolution_y = SIZE
    scene.render.resolution_percentage = 100
    scene.render.film_transparent = True
    ours, theirs = render()[..., :3], as_cycles_has_it(render)[..., :3]
    blocks = [picture.astype(np.float64).reshape(SIZE // 4, 4, SIZE // 4, 4, 3).mean(axis=(1, 3))
              for picture in (ours, theirs)]
    assert np.abs(blocks[0] - blocks[1]).sum() / blocks[1].sum() < 0.02
    seen = blocks[1][blocks[1].min(axis=-1) > 0.1]
    assert (seen[:, 0] / seen[:, 2]).std() > 0.1, "hues differ from grain to grain"


def _nodes(material):
    from mesograin import compat

    compat.use_nodes(material)
    material.node_tree.nodes.clear()
    return material.node_tree


def test_what_is_missing_is_a_sentence(tmp_path, monkeypatch):
    ground()
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    mesh = add_object("Ground", bpy.data.meshes.new("Ground"))
    bpy.context.view_layer.objects.active = mesh
    monkeypatch.setattr(asset_library, "FILE", tmp_path / "gone.blend")
    with pytest.raises(RuntimeError, match="gone.blend"):
        bpy.ops.mesograin.scatter(kind="sand")
