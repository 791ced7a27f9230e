# What is compared and baked is what a render shows, not what the viewport does, and the file stays as it was.
import io

import bpy
import pytest
from cycles_scenes import make_sphere
from test_export import add_cube, add_mesh_object, add_object

from mesograin.cycles.cache import Cache
from mesograin.scene import as_rendered, export, meshes
from mesograin.studies.baking import surface
from mesograin.studies.comparison import progress, run


def differ():
    """Everything on which the viewport and a render may differ, each the other way round from the one before."""
    layer = bpy.context.view_layer
    cube = add_cube("Of the viewport")
    cube.hide_render = True
    add_cube("Of the render").hide_viewport = True
    add_cube("Closed eye").hide_set(True)
    for name, owner in (("viewport", "hide_render"), ("render", "hide_viewport")):
        collection = bpy.data.collections.new(f"Of the {name}")
        bpy.context.scene.collection.children.link(collection)
        collection.objects.link(bpy.data.objects.new(f"In the {name}'s", cube.data))
        setattr(collection, owner, True)
    for name in ("Closed", "Excluded"):
        collection = bpy.data.collections.new(name)
        bpy.context.scene.collection.children.link(collection)
        collection.objects.link(bpy.data.objects.new(f"In {name}", cube.data))
    layer.layer_collection.children["Closed"].hide_viewport = True
    layer.layer_collection.children["Excluded"].exclude = True

    finer = add_cube("Finer").modifiers.new("Finer", "SUBSURF")
    finer.levels, finer.render_levels = 0, 2
    array = add_cube("Row").modifiers.new("Row", "ARRAY")
    array.show_viewport, array.show_render = True, False
    ring = bpy.data.curves.new("Ring", "CURVE")
    ring.dimensions, ring.bevel_depth, ring.resolution_u, ring.render_resolution_u = "3D", 0.1, 2, 7
    spline = ring.splines.new("NURBS")
    spline.points.add(3)
    spline.points.foreach_set("co", [0, 0, 0, 1, 1, 0, 0, 1, 1, 1, 0, 1, 0, 1, 1, 1])
    add_object("Ring", ring)
    ball = bpy.data.metaballs.new("Ball")
    ball.elements.new()
    ball.resolution, ball.render_resolution = 0.6, 0.3
    add_object("Ball", ball)
    corners = add_mesh_object("Corners", [(0, 0, 4), (4, 0, 4), (0, 4, 4)], [(0, 1, 2)])
    corners.instance_type, corners.show_instancer_for_render = "VERTS", False
    add_cube("At the corners").parent = corners
    emitter = add_mesh_object("Emitter", [(0, 0, 8), (4, 0, 8), (0, 4, 8)], [(0, 1, 2)])
    emitter.modifiers.new("Grains", "PARTICLE_SYSTEM")
    particles = emitter.particle_systems[0].settings
    particles.type, particles.count, particles.display_percentage = "HAIR", 8, 25
    particles.render_type, particles.instance_object = "OBJECT", bpy.data.objects["Finer"]
    bpy.context.scene.render.use_simplify = True
    bpy.context.scene.render.simplify_subdivision, bpy.context.scene.render.simplify_subdivision_render = 0, 1


def flags():
    layer = bpy.context.view_layer
    found = {thing.name: (thing.hide_get(), thing.hide_viewport, thing.hide_render, thing.show_instancer_for_viewport,
                          [(each.show_viewport, getattr(each, "levels", 0)) for each in thing.modifiers])
             for thing in layer.objects}
    found["collections"] = [(each.hide_viewport, each.hide_render) for each in bpy.data.collections]
    found["layers"] = [(each.hide_viewport, each.exclude) for each in layer.layer_collection.children]
    found["rest"] = (bpy.data.curves["Ring"].resolution_u, bpy.data.metaballs["Ball"].resolution,
                     bpy.data.particles[0].display_percentage, bpy.context.scene.render.simplify_subdivision)
    return found


def drawn(values):
    return sorted((instance.name, id(instance.mesh), instance.object_to_world) for instance in values.instances)


def test_it_is_what_a_render_shows(monkeypatch):
    make_sphere([((1.0, 1.0, 1.0), 20.0)], segments=16, rings=8)
    differ()
    bpy.context.scene.render.resolution_x = bpy.context.scene.render.resolution_y = 8
    seen = []

    def remember(depsgraph, cache):
        values, read_again = read_in_motion(depsgraph, cache)
        seen.append(values)
        return values, read_again

    read, read_in_motion = export.read_scene, export.read_scene_in_motion
    monkeypatch.setattr(export, "read_scene_in_motion", remember)
    bpy.ops.render.render()
    monkeypatch.undo()
    before = flags()
    in_viewport = read(bpy.context.evaluated_depsgraph_get(), meshes.MeshCache())
    with as_rendered.depsgraph(bpy.context) as depsgraph:
        shown = read(depsgraph, meshes.MeshCache())
    assert drawn(shown) == drawn(seen[-1]) != drawn(in_viewport)
    names = {instance.name for instance in shown.instances}
    assert {"Of the render", "Closed eye", "In the render's", "In Closed"} <= names
    assert not names & {"Of the viewport", "In the viewport's", "In Excluded", "Corners"}
    assert flags() == before
    assert drawn(read(bpy.context.evaluated_depsgraph_get(), meshes.MeshCache())) == drawn(in_viewport)


def test_the_file_stays_as_it_was_when_something_fails():
    make_sphere([((1.0, 1.0, 1.0), 20.0)], segments=16, rings=8)
    differ()
    before = flags()
    with pytest.raises(MemoryError), as_rendered.depsgraph(bpy.context):
        raise MemoryError
    assert flags() == before


def test_both_sides_of_a_comparison_see_it(tmp_path):
    """A cube in the way is of the viewport alone, a second sun of the render alone."""
    make_sphere([((1.0, 1.0, 1.0), 20.0), ((-1.0, 0.2, 1.0), 9.0)], segments=32, rings=16)
    request = run.Request(models=("lambert",), references=None, out=tmp_path / "a", size=(24, 24), samples=16,
                          reference_samples=16, frames=1, cache=Cache(tmp_path / "cache"), command="it")
    [plain] = run.compare(request, progress.Progress(io.StringIO()))["cases"]
    blocker = add_cube("Blocker")
    blocker.location.z, blocker.hide_render = 4.0, True
    bpy.data.objects["Sun.001"].hide_viewport = True
    [hidden] = run.compare(request, progress.Progress(io.StringIO()))["cases"]
    assert hidden["reference_cached"] and hidden["metrics"] == pytest.approx(plain["metrics"], rel=1e-4, nan_ok=True)


def test_what_is_hidden_for_renders_is_not_offered_for_baking():
    make_sphere([((1.0, 1.0, 1.0), 20.0)], segments=16, rings=8)
    add_cube("Of the viewport").hide_render = True
    bpy.data.objects["Sphere"].hide_viewport = True
    with as_rendered.depsgraph(bpy.context) as depsgraph:
        assert surface.bakeable(depsgraph) == ("Sphere",)


def test_an_object_that_was_removed_a_moment_ago_is_none_of_it():
    make_sphere([((1.0, 1.0, 1.0), 20.0)], segments=16, rings=8)
    add_cube("Left")
    bpy.context.evaluated_depsgraph_get()
    bpy.data.objects.remove(bpy.data.objects["Sphere"])  # the first, which asking the others would not mend
    assert bpy.context.view_layer.objects[0] is None  # as Blender has it until its layers are updated
    with as_rendered.depsgraph(bpy.context) as depsgraph:
        names = {instance.name for instance in export.read_scene(depsgraph, meshes.MeshCache()).instances}
    assert names == {"Left"}
