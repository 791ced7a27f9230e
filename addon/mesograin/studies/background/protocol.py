# The lines by which a background Blender tells how far it is, among whatever else it prints.
"""An event is a dict with `event`: 'step' (the fields of progress.Step), 'sentence', 'done' or 'failed' (`text`)."""

import json

MARK = "mesograin-event "


def encode(event, **values):
    """One line, bytes. It begins with a line break, because what was printed before may lack one."""
    return f"\n{MARK}{json.dumps({'event': event, **values})}\n".encode()


def decode(line):
    """The dict of a line, bytes; None if it is other text."""
    text = line.decode("utf-8", "replace")
    if not text.startswith(MARK):
        return None
    try:
        return json.loads(text[len(MARK):])
    except ValueError:
        return None
