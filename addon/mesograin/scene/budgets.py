# Until when a final render goes on, as its scene says it: after so many samples, within an error, or for so long.
from ..schema import advice

SAMPLES, ERROR, TIME = "samples", "error", "time"

CHOICES = (
    (SAMPLES, "Samples", "Until so many samples of each pixel are drawn"),
    (ERROR, "Error", "Until what pixels are off is small enough; models of Auto and how light between grains is found "
                     "are the cheapest that were measured to be so near"),
    (TIME, "Time", "Until so much time has gone by from the start, with what is known of light by then"),
)
"""Items of a Blender property."""


def tolerance(settings):
    """Within how many % the models of Auto are to be. settings: properties.SceneProperties."""
    return settings.budget_error if settings.budget == ERROR else advice.TOLERANCE
