# Frames of an animation on one machine or many: those that are there stay, each is written whole or not at all.
