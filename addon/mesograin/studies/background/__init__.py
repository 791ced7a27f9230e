# Long work in a Blender of its own, beside the one that the artist works in.
