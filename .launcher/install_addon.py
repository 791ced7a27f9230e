"""Runs inside Blender: installs the add-on's zip and enables it, or takes it out again.

    blender --background --python install_addon.py -- FILE.zip
    blender --background --python install_addon.py -- --remove
"""
import importlib.util
import pathlib
import shutil
import sys

import addon_utils
import bpy

REPOSITORY = "user_default"  # where Blender 4.2 and later keep extensions that are installed from a file
ARE_EXTENSIONS = hasattr(bpy.ops, "extensions") and bpy.app.version >= (4, 2, 0)
MODULE = f"bl_ext.{REPOSITORY}.mesograin" if ARE_EXTENSIONS else "mesograin"


def install(path):
    if ARE_EXTENSIONS:
        bpy.ops.extensions.package_install_files(filepath=path, repo=REPOSITORY, enable_on_install=True, overwrite=True)
    else:
        bpy.ops.preferences.addon_install(filepath=path, overwrite=True)
        bpy.ops.preferences.addon_enable(module=MODULE)
    if MODULE not in bpy.context.preferences.addons:
        sys.exit(f"mesograin: Blender {bpy.app.version_string} did not enable the add-on from '{path}'.")
    bpy.ops.wm.save_userpref()
    if importlib.util.find_spec("numpy") is None:
        sys.exit("mesograin: the add-on is installed, but needs NumPy, which this Blender's Python lacks; install it "
                 "(in Debian and Ubuntu: python3-numpy).")
    print(f"Mesograin is installed and enabled in Blender {bpy.app.version_string}.")
    print("To take it out again: ./mesograin install --remove")


def remove():
    folder = pathlib.Path(bpy.utils.user_resource("SCRIPTS", path="addons"), "mesograin")
    if MODULE not in bpy.context.preferences.addons and not folder.is_dir():
        sys.exit(f"mesograin: the add-on is not installed in Blender {bpy.app.version_string}.")
    if ARE_EXTENSIONS:
        index = next(index for index, repository in enumerate(bpy.context.preferences.extensions.repos)
                     if repository.module == REPOSITORY)
        bpy.ops.extensions.package_uninstall(repo_index=index, pkg_id="mesograin")
    else:
        # Blender's own operator wants a window to redraw.
        addon_utils.disable(MODULE, default_set=True)
        shutil.rmtree(folder)
    bpy.ops.wm.save_userpref()
    print(f"Mesograin is taken out of Blender {bpy.app.version_string}.")


if __name__ == "__main__":
    argument = sys.argv[sys.argv.index("--") + 1]
    remove() if argument == "--remove" else install(argument)
