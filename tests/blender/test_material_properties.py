# Material and scene properties: remembered by files and undo, set by presets, converted once to Blender units.
import bpy
import pytest
from mesograin.scene import export
from mesograin.schema import presets as known
from mesograin.ui import presets


def grain_values(material, millimetres_per_unit):
    return dict(export.material_values(material, millimetres_per_unit).values)


@pytest.mark.parametrize("millimetres_per_unit", [1.0, 1000.0, 0.25])
def test_coefficients_are_per_blender_unit(millimetres_per_unit, native):
    material = bpy.data.materials.new("Grain")
    grain = material.mesograin
    grain.model, grain.sigma_a, grain.sigma_s, grain.scale = "model_1", (0.1, 0.2, 0.3), (1.0, 2.0, 4.0), 3.0
    values = export.material_values(material, millimetres_per_unit).to_native(native)
    # A coefficient in 1/mm times the millimetres of a unit; scale stays a factor of its own.
    assert values.sigma_a == pytest.approx([value * millimetres_per_unit for value in (0.1, 0.2, 0.3)])
    assert values.sigma_s == pytest.approx([value * millimetres_per_unit for value in (1.0, 2.0, 4.0)])
    assert values.scale == pytest.approx(3.0)
    assert values.model == "model_1"


def test_every_parameter_reaches_the_native_module(native):
    material = bpy.data.materials.new("Grain")
    wanted = {"model": "conductor", "reflectance": (0.25, 0.5, 0.75), "sigma_a": (0.5, 0.25, 0.125),
              "sigma_s": (1.5, 2.5, 3.5), "g": -0.5, "eta": 1.75, "roughness": 0.375, "scale": 2.5, "specular": False,
              "boundary": "lambert_refracted", "reflectance_to_others": (0.75, 0.5, 0.25), "masking": "separable",
              "profile": "dipole"}
    for parameter, value in wanted.items():
        setattr(material.mesograin, parameter, value)
    made = export.material_values(material, 1.0).to_native(native)
    for parameter, value in wanted.items():
        got = getattr(made, parameter)
        assert (tuple(got) if isinstance(value, tuple) else got) == value, parameter


def test_a_grain_looks_the_same_in_any_unit(native, render):
    """A grain of 2 mm modelled at 1 mm a unit, and at 1 m a unit, is one picture."""
    from test_export import add_camera, add_mesh_object, add_sun

    pictures = []
    for unit in (1.0, 1000.0):
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
        scene = bpy.context.scene
        scene.render.engine = "MESOGRAIN"
        scene.render.resolution_x = scene.render.resolution_y = 32
        scene.mesograin.samples, scene.mesograin.millimetres_per_unit = 4, unit
        cube = add_mesh_object("Cube", [(x / unit, y / unit, 0.0) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))],
                               [(0, 1, 2, 3)])
        material = bpy.data.materials.new("Grain")
        material.mesograin.model = "model_1"
        cube.data.materials.append(material)
        add_camera((0.0, 0.0, 3.0 / unit), clip_start=0.1 / unit)
        add_sun((0.3, 0.2, 1.0), 3.0)
        pictures.append(render())
    assert pictures[0][16, 16, 0] > 0.05
    assert abs(pictures[0] - pictures[1]).max() < 1e-4


@pytest.mark.parametrize("row", known.JENSEN.presets, ids=lambda row: row.name)
def test_presets_set_what_the_table_says(row):
    mesh = bpy.data.meshes.new("Mesh")
    thing = bpy.data.objects.new("Object", mesh)
    bpy.context.scene.collection.objects.link(thing)
    material = bpy.data.materials.new("Grain")
    mesh.materials.append(material)
    material.mesograin.g, material.mesograin.scale = 0.8, 7.0
    bpy.context.view_layer.objects.active = thing
    identifier = row.identifier
    assert bpy.ops.mesograin.apply_preset(preset=identifier) == {"FINISHED"}
    grain = material.mesograin
    assert tuple(grain.sigma_s) == pytest.approx(row.sigma_s_reduced)
    assert tuple(grain.sigma_a) == pytest.approx(row.sigma_a)
    # The table's scattering is reduced, so it is the grain's only without anisotropy.
    assert (grain.g, grain.scale, grain.model) == (0.0, 1.0, "auto")
    assert grain.eta == pytest.approx(1.5 if row.name == "Marble" else 1.3)


def test_presets_leave_a_translucent_model_alone():
    material = bpy.data.materials.new("Grain")
    material.mesograin.model = "model_3"
    presets.apply(known.JENSEN.presets[0], material.mesograin)
    assert material.mesograin.model == "model_3"


def test_undo_takes_a_preset_back():
    mesh = bpy.data.meshes.new("Mesh")
    thing = bpy.data.objects.new("Object", mesh)
    bpy.context.scene.collection.objects.link(thing)
    mesh.materials.append(bpy.data.materials.new("Grain"))
    bpy.context.view_layer.objects.active = thing
    bpy.ops.ed.undo_push(message="before")
    bpy.ops.mesograin.apply_preset(preset="ketchup")
    bpy.ops.ed.undo_push(message="ketchup")
    assert bpy.data.materials["Grain"].mesograin.sigma_a[2] == pytest.approx(1.45)
    bpy.ops.ed.undo()
    assert tuple(bpy.data.materials["Grain"].mesograin.sigma_a) == pytest.approx((0.1, 0.1, 0.1))
    bpy.ops.ed.redo()
    assert bpy.data.materials["Grain"].mesograin.sigma_a[2] == pytest.approx(1.45)


def test_files_remember(tmp_path):
    material = bpy.data.materials.new("Grain")
    material.use_fake_user = True
    wanted = {"model": "model_3", "g": 0.5, "eta": 1.5, "roughness": 0.25, "scale": 6.0, "specular": False,
              "boundary": "lambert_lambert", "masking": "separable", "profile": "photon_beam"}
    for parameter, value in wanted.items():
        setattr(material.mesograin, parameter, value)
    material.mesograin.sigma_s = (1.0, 2.0, 3.0)
    bpy.context.scene.mesograin.samples = 17
    bpy.context.scene.mesograin.millimetres_per_unit = 1000.0
    path = str(tmp_path / "file.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    bpy.ops.wm.open_mainfile(filepath=path)
    grain, settings = bpy.data.materials["Grain"].mesograin, bpy.context.scene.mesograin
    assert {parameter: getattr(grain, parameter) for parameter in wanted} == wanted
    assert tuple(grain.sigma_s) == (1.0, 2.0, 3.0)
    assert (settings.samples, settings.millimetres_per_unit) == (17, 1000.0)


@pytest.mark.parametrize("link", [False, True], ids=["appended", "linked"])
def test_a_material_goes_to_another_file(tmp_path, link):
    material = bpy.data.materials.new("Grain")
    material.use_fake_user = True
    material.mesograin.model, material.mesograin.sigma_s, material.mesograin.eta = "model_2", (1.0, 2.0, 3.0), 1.5
    path = str(tmp_path / "file.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    with bpy.data.libraries.load(path, link=link) as (there, here):
        here.materials = there.materials
    [taken] = here.materials
    assert (taken.library is not None) == link
    values = dict(export.material_values(taken, 1.0).values)
    assert (values["model"], values["sigma_s"], values["eta"]) == ("model_2", (1.0, 2.0, 3.0), 1.5)
    assert taken.copy().mesograin.model == "model_2"


def test_no_button_changes_a_linked_material(tmp_path):
    """It would be as it was when the file is opened again."""
    bpy.ops.mesh.primitive_uv_sphere_add()
    bpy.context.object.name = "Sphere"
    bpy.context.object.active_material = bpy.data.materials.new("Grain")
    bpy.context.object.active_material.mesograin.model = "model_2"
    library = str(tmp_path / "library.blend")
    buttons = (bpy.ops.mesograin.make_grain, bpy.ops.mesograin.apply_preset, bpy.ops.mesograin.choose_model,
               bpy.ops.mesograin.to_cycles, bpy.ops.mesograin.from_cycles)
    assert all(button.poll() for button in buttons)
    bpy.ops.wm.save_as_mainfile(filepath=library)
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    with bpy.data.libraries.load(library, link=True) as (_, here):
        here.objects = ["Sphere"]
    linked = here.objects[0]
    bpy.context.scene.collection.objects.link(linked)
    bpy.context.view_layer.objects.active = linked
    assert not any(button.poll() for button in buttons)
    bpy.ops.mesh.primitive_uv_sphere_add()
    bpy.context.object.active_material = linked.active_material
    assert not any(button.poll() for button in buttons)
    bpy.context.object.active_material = linked.active_material.copy()
    assert all(button.poll() for button in buttons)


def test_a_library_override_keeps_what_was_changed(tmp_path, native):
    material = bpy.data.materials.new("Grain")
    material.use_fake_user, material.mesograin.model = True, "model_2"
    library, path = str(tmp_path / "library.blend"), str(tmp_path / "file.blend")
    bpy.ops.wm.save_as_mainfile(filepath=library)
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    with bpy.data.libraries.load(library, link=True) as (_, here):
        here.materials = ["Grain"]
    own = here.materials[0].override_create()
    own.use_fake_user = True
    own.mesograin.g, own.mesograin.model, own.mesograin.roughness = 0.75, "model_3", 0.25
    own.mesograin_look.way, own.mesograin_look.surroundings = "look", "water"
    own.mesograin_look.mean_free_path, own.mesograin_look.colour = (0.25, 0.5, 1.0), (0.5, 0.4, 0.3)
    own.mesograin_colours.vary, own.mesograin_colours.colour_from = True, (0.25, 0.5, 0.75)
    wanted = dict(export.material_values(own, 1.0).values)
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    [own] = [each for each in bpy.data.materials if each.override_library]
    kept = dict(export.material_values(own, 1.0).values)
    assert all(kept[name] == pytest.approx(wanted[name], rel=1e-5) for name in wanted), (kept, wanted)
    assert (own.mesograin_look.way, own.mesograin_look.surroundings) == ("look", "water")
    assert own.mesograin_colours.vary and tuple(own.mesograin_colours.colour_from) == (0.25, 0.5, 0.75)


@pytest.mark.parametrize("parameter, value, kept", [
    ("sigma_a", (-1.0, 0.0, 0.0), (0.0, 0.0, 0.0)), ("g", -3.0, -1.0), ("eta", 9.0, 4.0), ("roughness", 2.0, 1.0),
    ("scale", -1.0, 0.0), ("reflectance", (2.0, 0.5, 0.5), (1.0, 0.5, 0.5))])
def test_limits_hold(parameter, value, kept):
    grain = bpy.data.materials.new("Grain").mesograin
    setattr(grain, parameter, value)
    got = getattr(grain, parameter)
    assert (tuple(got) if isinstance(kept, tuple) else got) == kept


def test_tooltips_name_units():
    declared = bpy.types.Material.bl_rna.properties["mesograin"].fixed_type.properties
    for parameter in ("sigma_a", "sigma_s"):
        assert "1/mm" in declared[parameter].description
        assert declared[parameter].subtype == "NONE"  # plain numbers: a colour picker would convert them
    assert "GGX alpha" in declared["roughness"].description and "square root" in declared["roughness"].description
    for prop in declared:
        if prop.identifier not in ("rna_type", "name"):
            assert prop.description and not prop.description.endswith("."), prop.identifier
