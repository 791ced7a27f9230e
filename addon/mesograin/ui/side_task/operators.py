# The buttons of a long task and of its result's pictures. Mixed into operators that name their `session`.
import bpy
from bpy.props import EnumProperty

from ... import native_module
from ...cycles.wording import in_labels
from . import pictures


class StartOperator:
    """Starts the session's task; what is wrong is one sentence, in the report and in the panel."""

    @classmethod
    def poll(cls, _context):
        return native_module.problem() is None and not cls.session.running

    def execute(self, context):
        try:
            self.session.start(context)
        except self.session.refusals() as error:
            self.session.error = str(error)
            self.report({"ERROR"}, in_labels(str(error)))
            return {"CANCELLED"}
        return {"FINISHED"}


class CancelOperator:
    @classmethod
    def poll(cls, _context):
        return cls.session.running

    def execute(self, _context):
        self.session.cancel()
        return {"FINISHED"}


class ShowPictureOperator:
    """Shows a picture of `self.entry()`: (what `pictures.show` takes, its folder). It may raise LookupError with a
    sentence."""

    bl_label = "Show Picture"

    picture: EnumProperty(name="Picture", items=tuple(
        (name, *pictures.BUTTONS[name], number) for number, name in enumerate(pictures.FILES)))

    @classmethod
    def description(cls, _context, properties):
        return f"{pictures.BUTTONS[properties.picture][1]}; shown in an Image Editor"

    @classmethod
    def poll(cls, _context):
        return cls.session.results is not None

    def execute(self, context):
        try:
            entry, folder = self.entry()
            if self.picture not in pictures.pictures_of(entry):
                raise LookupError(f"There is no picture '{self.picture}' of {entry['name']}.")
            image = pictures.show(entry, self.picture, folder)
        except LookupError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        except RuntimeError as error:
            self.report({"ERROR"}, f"The picture cannot be shown: {' '.join(str(error).split())}")
            return {"CANCELLED"}
        area = _image_editor(context)
        area.spaces.active.image = image
        return {"FINISHED"}


def _image_editor(context):
    """The Image Editor that is used, or else the largest, or else one in a window of its own."""
    if context.area and context.area.type == "IMAGE_EDITOR":
        return context.area
    editors = [area for window in context.window_manager.windows for area in window.screen.areas
               if area.type == "IMAGE_EDITOR"]
    if not editors:
        before = set(context.window_manager.windows)
        bpy.ops.wm.window_new()
        [window] = set(context.window_manager.windows) - before
        editors = [window.screen.areas[0]]
        editors[0].ui_type = "IMAGE_EDITOR"
    return max(editors, key=lambda area: area.width * area.height)
