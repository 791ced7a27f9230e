"""Sweeps: many comparisons from one small file, each a case of its own. Runs outside Blender."""
