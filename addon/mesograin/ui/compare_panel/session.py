# The one comparison that may run beside this Blender, and what the last one found.
from ...cycles import reference_cache
from ...studies import scripting
from ...studies.background.launch import launch
from ..side_task import pictures
from ..side_task.job_session import JobSession
from . import properties


class CompareSession(JobSession):
    def asked_of(self, scene):
        return scene.mesograin_compare

    def begin(self, context, out):
        arguments = properties.arguments(context.scene)
        cache = reference_cache.cache()
        if not arguments["models"]:
            raise scripting.ComparisonError("No model is chosen: choose at least one.")
        return launch(
            "compare", str(out), **arguments, cache=str(cache.folder), cache_limit=cache.limit,
            command=scripting.call(**arguments, out=self.asked_of(context.scene).out))

    def finish(self):
        reference_cache.look_again()
        super().finish()

    def show(self, results, folder):
        for entry in results["cases"]:
            if entry["status"] == "done":
                pictures.show_all(entry, folder)


session = CompareSession("mesograin_compare_progress", {"PROPERTIES", "IMAGE_EDITOR"}, "comparison", "comparison",
                         "results.json", scripting.ComparisonError, (ValueError,))
register, unregister = session.register, session.unregister
