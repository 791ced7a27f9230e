# Scenes without Blender whose grains are matched: those in JSON.
"""See `read`."""

from pathlib import Path

from ...schema.models import AUTO, TRANSLUCENT
from ...schema.parameters import PARAMETERS
from .subject import Subject, cut


def read(native, path, target, longest, samples):
    """(Subject, target.Target, factor): the scene of a JSON file, whose translucent grains all are what is matched, and
    the target made as small as what is drawn of it. longest: side, in pixels. Raises native.Error or SubjectError."""
    small, factor = target.reduced(longest)
    kept = tuple(factor * side for side in small.size)
    scene, camera, _ = native.load_scene(str(Path(path)), size=target.size)
    instances = {number: None for number, drawn in enumerate(scene.instances) if drawn.material.model in TRANSLUCENT}
    arrays = {number: None for number, drawn in enumerate(scene.arrays) if drawn.material.model in TRANSLUCENT}
    drawn = [scene.instances[number] for number in instances] + [scene.arrays[number] for number in arrays]
    values = {name: getattr(drawn[0].material, name) for name in PARAMETERS} if drawn else {}
    values.setdefault("model", AUTO.name)
    return Subject(native, scene, instances, arrays, values, cut(native, camera, target.size, kept), small.size,
                   samples), small, factor
