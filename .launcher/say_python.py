# Runs inside Blender: prints its version, its Python's version and the file suffix of that Python's native modules.
import importlib.machinery
import sys

import bpy

print("embedded_python", bpy.app.version_string.split()[0], "%d.%d" % sys.version_info[:2],
      importlib.machinery.EXTENSION_SUFFIXES[0])
