# A long task beside the artist: a button starts it, a bar shows it, another button ends it; one of its kind at a time.
