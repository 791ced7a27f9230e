# How a long task is shown: its settings, the button that starts it or how far it is, and why there is none.
from ... import compat
from ...durations import duration
from ...studies.background import job as jobs
from .. import panels


def draw_settings(layout, context, session, draw):
    """`draw(layout, context)`, greyed while the task runs; in its place the native module's problem, if it has one."""
    if not panels.draw_native_problem(layout, context):
        column = layout.column()
        column.enabled = not session.running
        draw(column, context)


def draw_task(layout, context, session, start, cancel, unknown, detail="", **button):
    """The button of the operator `start`, or how far the task is, with `detail` below and `cancel`'s
    button; then what went wrong. unknown: what is said while nobody knows how long it takes. button: of
    `UILayout.operator`."""
    if session.running:
        left = session.task.seconds_left
        column = layout.column(align=True)
        compat.draw_progress(column, context.window_manager, session.progress,
                             f"about {duration(left)} left" if left is not None else unknown)
        if detail:
            panels.draw_sentence(column, context, detail, icon="NONE")
        layout.operator(cancel.bl_idname, text="Cancel", icon="CANCEL")
    else:
        row = layout.row()
        row.scale_y = 1.4
        row.operator(start.bl_idname, **button)
    if session.error:
        panels.draw_sentence(layout, context, session.error)


def draw_job(layout, context, session, start, cancel, kept, about="", **button):
    """`draw_task` of a job_session.JobSession, with its step; then what was left out. kept: what is said when it was
    cancelled. about: before the number of its steps, where that is a guess. button: of `UILayout.operator`."""
    job = session.task
    detail = f"{job.step.number} of {about}{job.step.count}: {job.step.what}" if job is not None and job.step else ""
    draw_task(layout, context, session, start, cancel, job.unknown if job is not None else "", detail, **button)
    if not session.error and job is not None and job.state == jobs.CANCELLED:
        layout.label(text=f"Cancelled; {kept}", icon="INFO")
    for sentence in job.sentences if job is not None else ():
        panels.draw_sentence(layout, context, sentence)
