# What is done with both renderers: comparisons, bakes, error against time, sweeps, here or in a Blender beside.
