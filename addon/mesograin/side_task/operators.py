# The two buttons of a long task. Mixed into operators that name their `session`.
from .. import native_module


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
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}


class CancelOperator:
    bl_label = "Cancel"

    @classmethod
    def poll(cls, _context):
        return cls.session.running

    def execute(self, _context):
        self.session.cancel()
        return {"FINISHED"}
