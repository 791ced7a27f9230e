# An object's texture and those of a comparison, as plain values ask for them: what a background Blender does for the
# Bake panel.
"""See `bake`."""

from pathlib import Path

import bpy

from ... import native_module
from ...cycles.cache import Cache
from ...cycles.reference import ReferenceError
from ...cycles.stage import StageError, need_cycles
from ...scene import as_rendered
from ..comparison.progress import Calls
from ..comparison.results import OutputError
from . import comparison
from .surface import BakeError, Surface


def bake(name, out, file, size, samples, view_from, margin, half, reference, reference_samples, cache, cache_limit,
         on_step, on_sentence):
    """Bakes an object of the open file as it is, and beside it by Mesograin and by Cycles as they can be compared; all
    files of `comparison.bake` go to the folder `out`, under the name that `file`, such as bake.exr, gives them.

    cache, cache_limit: of references, its folder and bytes. on_step: called with a `progress.Step`, on_sentence with
    what is to be said; from any thread. The rest as in `comparison.bake` and `comparison.Pair`. Raises BakeError with a
    sentence.
    """
    progress = Calls(on_step, on_sentence)
    try:
        native = native_module.get()
        need_cycles()
        with as_rendered.depsgraph(bpy.context) as depsgraph:
            own = Surface(depsgraph, name, tuple(size), view_from)
            pair = comparison.Pair(depsgraph, name, tuple(size), samples, view_from, {}, None, reference,
                                   reference_samples, Cache(cache, cache_limit))
            comparison.bake(Path(out) / file, own, pair, samples, margin, half, progress)
    except (native_module.Unavailable, OutputError, ReferenceError, StageError, ValueError) as error:
        raise BakeError(str(error)) from error
    except native.Error as error:
        raise BakeError(str(error)) from error
