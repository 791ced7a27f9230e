# F12 shows what the native module renders, pixel for pixel.
import bpy
import numpy as np
import pytest

from mesograin import export, status


def render_directly(native, width, height):
    depsgraph = bpy.context.evaluated_depsgraph_get()
    scene, warnings = export.scene_from_depsgraph(depsgraph)
    view = native.View(width, height)
    view.set_scene(scene)
    view.set_camera(export.camera_from_scene(depsgraph, width, height))
    view.render(bpy.context.scene.mesograin.samples)
    return view.read()


@pytest.mark.parametrize("name", ["sphere", "grain"])
@pytest.mark.parametrize("model", ["lambert", "conductor"])
def test_blend_files_render_as_the_native_module_does(native, render, blend_files, name, model):
    bpy.ops.wm.open_mainfile(filepath=str(blend_files / f"{name}.blend"))
    scene = bpy.context.scene
    assert scene.render.engine == "MESOGRAIN"
    scene.mesograin.samples = 4
    for material in bpy.data.materials:
        material.mesograin.model = model
        material.mesograin.roughness = 0.4
    picture = render()
    np.testing.assert_array_equal(picture, render_directly(native, 400, 400))
    assert picture[..., 3].mean() > 0.2 and picture[..., :3].max() > 1.0
    latest = status.get(status.RENDER)
    assert (latest.samples, latest.width, latest.height, latest.warnings) == (4, 400, 400, ())
    assert latest.passes
