# The scenes of docs/gallery.md and docs/scenes.md, in blend_files/gallery and blend_files/scenes, are what their
# scripts make, open in every Blender, and show something.
import importlib.util
import sys

import bpy
import numpy as np
import pytest

from conftest import ROOT
from mesograin import compat

FILES = sorted(path.relative_to(ROOT).as_posix() for room in ("gallery", "scenes")
               for path in (ROOT / "blend_files" / room).glob("*.blend"))


def script(name):
    sys.path.insert(0, str(ROOT / "blend_files"))
    try:
        spec = importlib.util.spec_from_file_location(name, ROOT / f"blend_files/{name}.py")
        module = importlib.util.module_from_spec(spec)
        sys.modules[name] = module  # where a dataclass looks its own up
        spec.loader.exec_module(module)
        return module
    finally:
        sys.path.pop(0)


def test_there_is_a_file_for_every_scene():
    gallery, scenes = script("make_gallery_files"), script("make_scene_files")
    made = [f"blend_files/gallery/{each.name}.blend" for each in (*gallery.HEAPS, *gallery.CRYSTALS)]
    assert sorted(made + [f"blend_files/scenes/{make.__name__}.blend" for make in scenes.SCENES]) == FILES


@pytest.mark.parametrize("file", FILES)
def test_a_scene_shows_something(render, file):
    bpy.ops.wm.open_mainfile(filepath=str(ROOT / file))
    scene = bpy.context.scene
    assert scene.render.engine == "MESOGRAIN"
    scene.render.resolution_percentage, scene.mesograin.samples = 20, 1
    pixels = render()[..., :3]
    assert np.isfinite(pixels).all() and pixels.min() >= 0.0
    assert pixels.mean() > 0.02 and pixels.std() > 0.02


def told():
    """What a scene says, but for where grains fell: Blender's numbers, as short as single precision is."""
    scene = bpy.context.scene
    grains = {material.name: (material.mesograin.model, tuple(material.mesograin.sigma_s),
                              tuple(material.mesograin.sigma_a), material.mesograin.eta, material.mesograin.boundary)
              for material in bpy.data.materials if material.name != "Ground"}
    depsgraph = bpy.context.evaluated_depsgraph_get()
    return {"grains": grains, "instances": sum(each.is_instance for each in depsgraph.object_instances),
            "lights": {light.name: (light.energy, tuple(light.color), light.angle) for light in bpy.data.lights},
            "images": {image.name: np.array(image.pixels) for image in bpy.data.images if image.size[0]},
            "millimetres": scene.mesograin.millimetres_per_unit, "samples": scene.mesograin.samples}


@pytest.mark.skipif(not compat.has_printed_statistics(), reason="the scripts are for Blenders before 5")
@pytest.mark.parametrize("name", ["sand", "sugar", "sugar_crystal_soft"])
def test_a_file_holds_what_its_script_makes(name):
    files = script("make_gallery_files")
    bpy.ops.wm.open_mainfile(filepath=str(files.FOLDER / f"{name}.blend"))
    held = told()
    scenes = {each.name: each for each in (*files.HEAPS, *files.CRYSTALS)}
    (files.set_on_table if name in {each.name for each in files.CRYSTALS} else files.pour)(scenes[name])
    made = told()
    assert held["images"].keys() == made["images"].keys()
    for image, pixels in made.pop("images").items():
        assert np.array_equal(held["images"][image], pixels)
    del held["images"]
    assert held == made
