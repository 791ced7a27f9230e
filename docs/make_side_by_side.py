# Makes docs/images/scene_*.jpg and their lines of docs/scenes.md, by both engines, from blend_files/scenes and from the
# scene that Blender opens with:
#   blender -b --factory-startup --python-exit-code 1 --python docs/make_side_by_side.py [-- NAME ...]
import pathlib
import sys
import tempfile

import bpy
import numpy as np

DOCS = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(DOCS.parent / "addon"), str(DOCS.parent / "blend_files")]

import make_scene_files as files  # noqa: E402
import parts  # noqa: E402

BLOCK = 10
SAMPLES = {"MESOGRAIN": 64, "CYCLES": 128}
SCENES = {"default": "Blender's default scene",
          **{make.__name__: make.__doc__.rstrip(".") for make in files.SCENES}}


def open_scene(name):
    if name != "default":
        bpy.ops.wm.open_mainfile(filepath=str(files.FOLDER / f"{name}.blend"))
        return
    bpy.ops.wm.read_homefile(use_factory_startup=True)
    render = bpy.context.scene.render
    render.resolution_x, render.resolution_y = files.SIZE
    render.resolution_percentage = 100


def render(engine, folder, mirrored=False):
    """(picture as it looks, (h, w, 3) 0 to 1; linear, (h, w, 3)), row 0 at the bottom."""
    scene = bpy.context.scene
    scene.render.engine = engine
    scene.mesograin.samples = SAMPLES["MESOGRAIN"]
    scene.mesograin.exchange = "off"  # it is of heaps
    cycles = scene.cycles
    cycles.samples, cycles.use_denoising, cycles.use_adaptive_sampling = SAMPLES["CYCLES"], False, False
    cycles.pixel_filter_type = "BOX"
    cycles.max_bounces = 1 if mirrored else 12
    cycles.diffuse_bounces, cycles.glossy_bounces = (0, 1) if mirrored else (4, 4)
    settings = scene.render.image_settings
    settings.file_format, settings.color_mode, settings.color_depth = "OPEN_EXR", "RGB", "32"
    scene.render.filepath = str(folder / f"{engine}.exr")
    bpy.ops.render.render(write_still=True)
    linear = parts.pixels_of(scene.render.filepath)[..., :3]
    settings.file_format, settings.color_depth = "PNG", "8"
    looks = str(folder / f"{engine}.png")
    bpy.data.images["Render Result"].save_render(looks)
    return parts.pixels_of(looks)[..., :3], linear


def difference(ours, theirs):
    """Relative L1 of the means of blocks."""
    found, right = (parts.blocks(each, BLOCK) for each in (ours, theirs))
    return np.abs(found - right).sum() / right.sum()


def take(name):
    """One line of the table."""
    from mesograin.scene import export, meshes

    open_scene(name)
    warnings = export.read_scene(bpy.context.evaluated_depsgraph_get(), meshes.MeshCache()).warnings
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        looks, ours = render("MESOGRAIN", folder)
        full_looks, full = render("CYCLES", folder)
        _, mirrored = render("CYCLES", folder, mirrored=True)
    parts.save_beside(DOCS / "images" / f"scene_{name}.jpg", (looks, full_looks), 88)
    for warning in warnings:
        print(f"{name}: {warning}", flush=True)
    return (f"| {SCENES[name]} | {100.0 * difference(ours, mirrored):.1f} % | "
            f"{100.0 * difference(ours, full):.1f} % | ![](images/scene_{name}.jpg) |\n")


def write_row(name, row):
    """Puts a scene's line in place of the one that docs/scenes.md has."""
    page = DOCS / "scenes.md"
    lines = page.read_text(encoding="utf-8").splitlines(keepends=True)
    kept = [row if f"images/scene_{name}.jpg" in line else line for line in lines]
    page.write_text("".join(kept), encoding="utf-8")


def main():
    import addon_utils

    addon_utils.enable("mesograin", default_set=True)
    asked = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else []
    for name in asked or SCENES:
        write_row(name, take(name))


main()
