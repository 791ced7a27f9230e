# Drawing for Blender: final renders, viewports and their words on screen.
