# Grains made from nothing: their shapes, and how they lie in a pile.
