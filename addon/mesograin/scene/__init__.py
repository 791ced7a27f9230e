# What Blender holds, as the native module wants it: copied, never borrowed.
