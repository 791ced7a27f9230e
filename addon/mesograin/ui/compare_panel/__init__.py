# The comparison inside Blender's window: settings, a background job, its pictures and numbers.
