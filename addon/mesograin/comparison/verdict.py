# What a case's numbers come to, in a few words.
"""See `verdict`."""

NOISE_MARGIN = 1.25
"""Times the noise floor: below, an error is not told from the reference's noise."""


def verdict(entry):
    """A few words on a case of results.json, such as '2.3 % off' or 'the same within the noise of 0.4 %'."""
    if entry["status"] != "done":
        return "failed"
    error, floor = entry["metrics"]["relative_l1"], entry["noise_floor"]["relative_l1"]
    if error is None:
        return "the reference is black"
    if floor is not None and error <= NOISE_MARGIN * floor:
        return f"the same within the noise of {floor:.2%}"
    corrected = entry["metrics"].get("relative_l1_corrected")
    return f"{error if corrected is None else corrected:.2%} off"
