# The one match that may run beside this Blender, and what the last one found.
from ...studies.background.launch import launch
from ...studies.match import files, of_blender
from ...studies.match.run import MatchError
from ...studies.match.target import TargetError
from ..active_material import active_material
from ..side_task import pictures
from ..side_task.job_session import JobSession
from . import properties


class MatchSession(JobSession):
    def asked_of(self, scene):
        return scene.mesograin_match

    def begin(self, context, out):
        scene, asked = context.scene, context.scene.mesograin_match
        if asked.image is None:
            raise MatchError("No picture is chosen: choose or open one.")
        if not asked.parameters:
            raise MatchError("Nothing is searched for: choose at least one of sigma_a, sigma_s and g.")
        of_blender.target(asked.image)  # what is wrong with it is said at once
        return launch("match", str(out), **properties.arguments(scene), material=active_material(context).name_full,
                      memory=str(out))

    def show(self, _results, folder):
        pictures.show_all(self.entry, folder)

    @property
    def entry(self):
        """The result as `side_task.pictures` shows it."""
        return {"name": f"match {self.results['material']}", "files": self.results["files"]}


session = MatchSession("mesograin_match_progress", {"PROPERTIES", "IMAGE_EDITOR"}, "match", "match", files.RESULTS,
                       MatchError, (TargetError,))
register, unregister = session.register, session.unregister
