"""What a final render says of how far it is: often in a window, seldom in a log."""
import pytest
from addon_rooms import room

telling = room("engine.telling")


@pytest.mark.parametrize("in_log, least, most", [(True, 6, 7), (False, 1200, 1200)])
def test_a_log_gets_few_lines_of_a_minute_and_a_window_all(monkeypatch, in_log, least, most):
    now = [100.0]
    monkeypatch.setattr(telling.time, "perf_counter", lambda: now[0])
    one, told = telling.Telling(in_log), []
    for number in range(1200):
        if one.is_due():
            told.append(number)
        now[0] += 0.05
    assert told[0] == 0 and least <= len(told) <= most
