# The Compare panel in a real window: progress, cancel, numbers and pictures, while the interface stays alive.
import bpy
import mesograin
import numpy as np
from mesograin.engine import status
from mesograin.studies.background import job as jobs
from mesograin.ui.compare_panel.session import session


def prepare(window, **settings):
    """The sphere, to be compared fast and small; gives the viewport's area and one with the render properties."""
    area = yield from window.open("sphere")
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 96, 64, 100
    bpy.data.materials["Translucent"].mesograin.roughness = 0.4
    asked = scene.mesograin_compare
    asked.models, asked.size_percent, asked.out = {"lambert"}, 50, str(window.folder / "out")
    for name, value in settings.items():
        setattr(asked, name, value)
    bpy.context.preferences.addons["mesograin"].preferences.cache_folder = str(window.folder / "cache")
    return area, (yield from window.render_properties(area))


def finished(window):
    """Waits for the job's end and for its results; gives what `silence_until` does."""
    return (yield from window.silence_until(
        lambda: not session.running and not bpy.app.timers.is_registered(session.poll)))


def check_it_compares_beside_and_shows_what_it_found(window):
    area, properties = yield from prepare(window, models={"lambert", "conductor"})
    quiet = yield from window.picture(properties)
    state = (bpy.data.filepath, bpy.data.is_dirty, [image.name for image in bpy.data.images])
    assert window.call(properties, "compare") == {"FINISHED"}
    assert session.running and not bpy.ops.mesograin.compare.poll()
    assert (bpy.data.filepath, bpy.data.is_dirty, [image.name for image in bpy.data.images]) == state
    yield from window.until(lambda: session.task.step is not None)
    busy = yield from window.picture(properties)
    assert session.running, "over before it could be looked at"
    assert (np.abs(busy - quiet).max(axis=-1) > 0.1).sum() > 500, "the panel shows no progress"
    # The artist goes on.
    status.clear()
    bpy.data.materials["Translucent"].mesograin.reflectance = (0.4, 0.2, 0.8)
    yield from window.converged_picture(area)
    silent = yield from finished(window)
    assert silent < 0.75, f"Blender did not answer for {silent:.0%} of the comparison"
    assert session.error == "" and [case["status"] for case in session.results["cases"]] == ["done", "done"]
    shown = yield from window.picture(properties)
    assert (np.abs(shown - quiet).max(axis=-1) > 0.1).sum() > 1000, "the panel shows no numbers"
    assert_pictures(window, ("lambert.diffuse", "conductor.glossy"))
    area.type = "IMAGE_EDITOR"
    try:
        yield from look_at_pictures_in_the_image_editor(window, area)
        yield from compare_again(window, properties)
        yield from window.picture(properties)
    finally:
        area.type = "VIEW_3D"
    with window.override(properties):
        assert bpy.ops.mesograin.clear_references() == {"FINISHED"}
    assert not list((window.folder / "cache").glob("*.exr"))


def assert_pictures(window, cases):
    made = {image["mesograin_picture"] for image in bpy.data.images if "mesograin_picture" in image}
    assert made == {f"{case} {picture}" for case in cases
                    for picture in ("model", "reference", "error", "error colours", "significance")}, made
    for picture in ("model", "reference", "error"):
        image = next(image for image in bpy.data.images if image.get("mesograin_picture") == f"{cases[0]} {picture}")
        pixels = np.array(image.pixels[:], np.float32).reshape(32, 48, image.channels)[::-1]
        file = window.native.read_exr(str(window.folder / "out" / cases[0] / f"{picture}.exr"))[0]
        assert image.is_float and image.colorspace_settings.name.startswith("Linear")
        np.testing.assert_allclose(pixels[..., :3], file[..., :3], atol=1e-6)


def look_at_pictures_in_the_image_editor(window, area):
    area.spaces.active.show_region_ui = True
    seen = []
    for picture in ("model", "reference", "error colours"):
        with window.override(area):
            bpy.ops.mesograin.show_picture(case="lambert.diffuse", picture=picture)
        assert area.spaces.active.image.name == f"Mesograin lambert.diffuse {picture}"
        with window.override(area):
            bpy.ops.image.view_all(fit_view=True)
        seen.append((yield from window.picture(area)))
    assert np.abs(seen[0] - seen[1]).mean() < 0.02 < np.abs(seen[0] - seen[2]).mean()


def compare_again(window, properties):
    """Pictures and numbers are replaced, under the names that the artist gave them; a case that fails says why."""
    first = session.results["cases"][0]["metrics"]["rmse"]
    bpy.data.images["Mesograin lambert.diffuse model"].name = "Mine"
    bpy.data.images.remove(bpy.data.images["Mesograin lambert.diffuse reference"])
    grain = bpy.data.materials["Translucent"].mesograin
    grain.reflectance, grain.roughness = (0.1, 0.1, 0.1), 0.0
    window.call(properties, "compare")
    assert session.results is None
    yield from finished(window)
    lambert, conductor = session.results["cases"]
    assert 0.0 < lambert["metrics"]["rmse"] < first and "raise the roughness" in conductor["error"]
    assert "Mine" in bpy.data.images and "Mesograin lambert.diffuse reference" in bpy.data.images
    assert_pictures(window, ("lambert.diffuse", "conductor.glossy"))


def check_the_console_compares_too(window):
    yield from window.open("sphere")
    window_before = len(bpy.context.window_manager.windows)
    found = mesograin.compare(models="lambert", size=(32, 32), samples=4, reference_samples=4, frames=1, report=False,
                              out=window.folder / "console", cache=window.folder / "cache")
    [case] = found.cases
    assert case.error == "" and case.image("model").shape == (32, 32, 4) and case.relative_l1 < 0.05
    yield from window.seconds(0.5)
    assert len(bpy.context.window_manager.windows) == window_before and len(bpy.data.scenes) == 1


def check_undo_goes_on_and_cancel_is_at_once(window):
    _, properties = yield from prepare(window, models={"model_1"}, quality="final", size_percent=100,
                                       out=str(window.folder / "cancelled"))
    with window.override(properties):
        bpy.ops.ed.undo_push(message="before")
        bpy.data.materials["Translucent"].mesograin.eta = 1.7
        bpy.ops.ed.undo_push(message="eta")
    assert bpy.data.is_dirty
    window.call(properties, "compare")
    assert bpy.data.is_dirty
    with window.override(properties):
        bpy.ops.ed.undo()
        assert abs(bpy.data.materials["Translucent"].mesograin.eta - 1.3) < 1e-6
        bpy.ops.ed.redo()
        assert abs(bpy.data.materials["Translucent"].mesograin.eta - 1.7) < 1e-6
    yield from window.until(lambda: session.task.step is not None)
    job = session.task
    window.call(properties, "cancel_compare")
    assert not session.running and job.state == jobs.CANCELLED
    yield from window.until(lambda: job.wait(0.0), timeout=10.0)
    assert not job.folder.exists() and not (window.folder / "cancelled").exists()
    yield from window.picture(properties)
    assert session.error == "" and session.results is None
    assert bpy.ops.mesograin.compare.poll()


def check_another_file_ends_the_comparison_and_what_fails_is_one_sentence(window):
    _, properties = yield from prepare(window, models={"model_1"}, size_percent=100, quality="final")
    window.call(properties, "compare")
    job = session.task
    yield from window.open("sphere")
    # Not before: under a comparison's news panels move at any time, and `restore` tells what closing them then does.
    yield from window.restore()
    _, properties = yield from prepare(window)
    assert job.state == jobs.CANCELLED and session.task is None and session.results is None
    yield from window.until(lambda: job.wait(0.0), timeout=10.0)
    bpy.data.objects.remove(bpy.context.scene.camera)
    window.call(properties, "compare")
    yield from finished(window)
    assert "no active camera" in session.error and "\n" not in session.error and session.results is None
    yield from window.picture(properties)


def check_no_model_chosen_is_said(window):
    _, properties = yield from prepare(window, models=set())
    quiet = yield from window.picture(properties)
    try:
        outcome = str(window.call(properties, "compare"))
    except RuntimeError as error:  # how an operator's error report reaches a script
        outcome = str(error)
    assert "model" in session.error and session.error in outcome and "\n" not in session.error, outcome
    assert not session.running and session.results is None
    shown = yield from window.picture(properties)
    assert (np.abs(shown - quiet).max(axis=-1) > 0.1).sum() > 100, "the panel does not say it"
