# The report: a page that opens from disk, made of results.json and EXR files; runs without Blender.
