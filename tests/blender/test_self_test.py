# The preferences' self-test: what it keeps is what is drawn, and it finds what is drawn wrongly. And the device.
import os

import bpy
import pytest
from mesograin.schema import models
from mesograin.ui import preferences, self_test


def test_what_is_kept_is_what_is_drawn(native):
    assert set(self_test.KEPT) == {name for name, model in models.MODELS.items() if not model.mesh}
    for name in self_test.KEPT:
        assert self_test.bead_error(native, name) < 0.01, name


def test_a_model_that_is_drawn_wrongly_is_named(native, monkeypatch):
    right = self_test.bead
    monkeypatch.setattr(self_test, "bead", lambda *of: right(*of) * (1.2 if of[-1] == "model_2" else 1.0))
    with pytest.raises(RuntimeError) as refusal:  # how an operator's report reaches a script
        bpy.ops.mesograin.self_test()
    assert "Model 2" in str(refusal.value) and "driver" in str(refusal.value)
    monkeypatch.undo()
    assert bpy.ops.mesograin.self_test() == {"FINISHED"}
    assert any("back takes" in sentence for sentence in preferences._told)


def test_a_preferred_device_is_asked_for_but_not_before_the_environment(monkeypatch):
    monkeypatch.setenv(preferences.DEVICE, "surfaceless")  # whatever it is, it comes back
    monkeypatch.setattr(preferences, "_given", None)
    preferences.use_device("software")
    assert os.environ[preferences.DEVICE] == "software"
    preferences.use_device("any")
    assert preferences.DEVICE not in os.environ
    monkeypatch.setenv(preferences.DEVICE, "0")
    monkeypatch.setattr(preferences, "_given", "0")
    preferences.use_device("hardware")
    assert os.environ[preferences.DEVICE] == "0"
