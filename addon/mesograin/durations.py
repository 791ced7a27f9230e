# How long something takes or will take, in the words that every line and panel has for it.


def duration(seconds):
    """'41 s', '3 min 05 s', '2 h 07 min'."""
    minutes, rest = divmod(max(0, round(seconds)), 60)
    if minutes < 60:
        return f"{minutes} min {rest:02d} s" if minutes else f"{rest} s"
    return f"{minutes // 60} h {minutes % 60:02d} min"
