# Baking: a grain's surface as a texture, unwrapped at its UVs, by Mesograin and for comparison by Cycles.
