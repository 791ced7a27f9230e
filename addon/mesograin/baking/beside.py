# Both textures of an object, as plain values ask for them: what a background Blender does for the Bake panel.
"""See `bake`."""

from pathlib import Path

import bpy

from .. import as_rendered, native_module
from ..comparison.progress import Calls
from ..comparison.results import OutputError
from ..cycles.cache import Cache
from ..cycles.reference import ReferenceError
from ..cycles.stage import StageError, need_cycles
from . import comparison
from .surface import BakeError


def bake(name, out, file, size, samples, view_from, reference, reference_samples, cache, cache_limit, on_step,
         on_sentence):
    """Bakes an object of the open file by Mesograin and by Cycles; all files of `comparison.write` go to the folder
    `out`, under the name that `file`, such as bake.exr, gives them.

    cache, cache_limit: of references, its folder and bytes. on_step: called with a `progress.Step`, on_sentence with
    what is to be said; from any thread. The rest as in `comparison.compare`. Raises BakeError with a sentence.
    """
    progress = Calls(on_step, on_sentence)
    try:
        native = native_module.get()
        need_cycles()
        with as_rendered.depsgraph(bpy.context) as depsgraph:
            found = comparison.compare(depsgraph, name, tuple(size), samples, view_from, {}, None, reference,
                                       reference_samples, Cache(cache, cache_limit), progress)
        comparison.write(Path(out) / file, *found)
    except (native_module.Unavailable, OutputError, ReferenceError, StageError, ValueError) as error:
        raise BakeError(str(error)) from error
    except native.Error as error:
        raise BakeError(str(error)) from error
