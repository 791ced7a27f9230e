"""Runs inside a Blender with a portable zip installed: renders a heap as F12 does, and says which libraries it took.

    blender --background --python tests/zip/render_heap.py -- PICTURE.exr
"""
import pathlib
import sys

import bpy

TRACER = "libmesograin-embree3.so"


def render(path):
    bpy.ops.wm.read_homefile(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine = "MESOGRAIN"
    scene.render.resolution_x = scene.render.resolution_y = 64
    scene.render.image_settings.file_format, scene.render.filepath = "OPEN_EXR", path
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=20, y_subdivisions=20, size=4.0)
    places = bpy.context.object
    bpy.ops.mesh.primitive_uv_sphere_add(radius=0.1)
    grain = bpy.context.object
    bpy.ops.object.shade_smooth()
    grain.data.materials.append(bpy.data.materials.new("grain"))
    grain.parent, places.instance_type = places, "VERTS"  # many of one mesh, which Embree finds
    bpy.ops.object.light_add(type="SUN", rotation=(0.5, 0.5, 0.0))
    bpy.ops.object.camera_add(location=(0.0, 0.0, 6.0))
    scene.camera = bpy.context.object
    bpy.ops.render.render(write_still=True)


def brightest(path):
    pixels = bpy.data.images.load(path).pixels[:]
    return max(pixels[::4])


def mapped():
    """The files with code that this process holds."""
    lines = pathlib.Path("/proc/self/maps").read_text().splitlines()
    return sorted({line.split(maxsplit=5)[5] for line in lines if ".so" in line})


def main():
    picture = sys.argv[sys.argv.index("--") + 1]
    render(picture)
    value = brightest(picture)
    own = [path for path in mapped() if "mesograin" in path]
    strangers = [path for path in own if "/extensions/" not in path and "/addons/" not in path]
    print(f"mesograin: Blender {bpy.app.version_string}, Python {sys.version.split()[0]}: brightest pixel {value:.4f}, "
          f"{len(own)} files of the zip loaded")
    if not value > 0.01 or not [path for path in own if path.endswith(TRACER)] or strangers:
        sys.exit(f"mesograin: the zip's add-on did not render, or not with its own libraries: {own}")


if __name__ == "__main__":
    main()
