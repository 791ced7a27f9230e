# What the artist sees and presses: panels, presets, preferences, and long work shown beside them.
