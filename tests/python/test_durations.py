# How long something takes, in words.
from addon_rooms import room

duration = room("durations").duration


def test_seconds_minutes_and_hours_are_said_as_such():
    assert [duration(seconds) for seconds in (-1, 0.4, 41.2, 59.6, 185, 7620)] == [
        "0 s", "0 s", "41 s", "1 min 00 s", "3 min 05 s", "2 h 07 min"]
