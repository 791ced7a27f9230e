"""Labels for identifiers, in sentences that were written for a command line."""
import pytest
from addon_rooms import room

labels = room("schema.labels")
in_labels = room("cycles.wording").in_labels


@pytest.mark.parametrize("said, read", [
    ("choose the reference volume_index_matched.", "choose the reference Volume, index-matched."),
    ("None of subsurface_burley, subsurface answers model_1: choose others.",
     "None of Subsurface Scattering, Christensen-Burley, subsurface answers Model 1: choose others."),
    ("model_3 takes lambert_lambert, not lambert_refracted", "Model 3 takes Lambert, Lambert, not Lambert, refracted"),
    ("Object 'model_1' has no volume; Cycles' model_2 is 'model_3'",
     "Object 'model_1' has no volume; Cycles' Model 2 is 'model_3'"),
    ("/tmp/model_1/x and model_1.exr and my_model_1 and model_12 stay",) * 2,
    ("transport and light in transport stay",) * 2,
])
def test_identifiers_become_labels_and_names_stay(said, read):
    assert in_labels(said) == read


def test_a_model_is_called_by_the_beginning_of_its_label():
    assert [labels.of_model(name) for name in ("model_1", "transport", "lambert", "auto", "Cycles")] == [
        "Model 1", "Transport", "Lambert", "Auto", "Cycles"]
