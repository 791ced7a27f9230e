# The Bake panel: a grain's surface to an EXR file while the artist goes on working.
