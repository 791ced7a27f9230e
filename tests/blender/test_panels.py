# What the panels offer and how they name it, without a window: each is drawn into a layout that remembers.
import itertools
import types

import bpy
import numpy as np
import pytest
from mesograin import compat
from mesograin.engine import engine, status
from mesograin.scene import export
from mesograin.schema import models, parameters
from mesograin.ui import grain_colours, node_panels, panels, presets
from mesograin.ui.bake_panel import panel as bake_panel
from mesograin.ui.compare_panel import panel as compare_panel
from mesograin.ui.match_panel import panel as match_panel
from mesograin.ui.side_task import pictures, results

# Pixels at a UI scale of 1, in a Properties editor of Blender's default layout on a screen 1500 wide, 260 across: what
# a label left of its value gets, and one right of a box there.
LABEL, BESIDE_BOX = 71, 85
# On a screen 1920 wide, 333 across: one of two columns in a box; what a choice as wide as the panel has for the name of
# what was chosen, beside its dot.
HALF, WHOLE = 115, 160
# On a screen 1280 wide, the width of the Properties editor; there, what Blender leaves of it for what a list is called,
# and for a number or a switch.
NARROW, BESIDE_LIST, IN_FIELD = 190, 42, 100
# The height of what is not seen.
HIDDEN = 0.001


class Layout:
    """Takes whatever a panel draws. labels: what stands left of values. boxes: what stands right of boxes. menus: their
    names. whole: properties as wide as the panel. split: properties whose names stand left of them. lists: what stands
    left of lists that are not split. said: texts. dotted: what has a dot to animate it."""

    def __init__(self):
        self.labels, self.boxes, self.menus, self.whole, self.split, self.lists, self.said = ([] for _ in range(7))
        self.dotted, self.use_property_decorate = [], False
        self.use_property_split = False

    def __getattr__(self, name):
        def part(*_, heading=None, **_named):
            if heading is not None:
                self.labels.append(heading)
            inner = object.__new__(type(self))  # which remembers in the same lists, and is split as this one at first
            vars(inner).update(vars(self))
            return inner

        return part

    def prop(self, owner, name, text=None, expand=False, **_):
        declared = owner.bl_rna.properties[name]
        if vars(self).get("scale_y") == HIDDEN:
            return
        if self.use_property_split:
            self.split.append(name)
            if self.use_property_decorate:
                self.dotted.append(name)
        elif declared.type == "ENUM" and text != "" and not expand and not declared.is_enum_flag:
            self.lists.append(declared.name if text is None else text)
        if text != "":
            (self.boxes if declared.type == "BOOLEAN" else self.labels).append(declared.name if text is None else text)
        if text == "":
            self.whole.append(name)

    def prop_decorator(self, _owner, name):
        self.dotted.append(name)

    def menu(self, menu, **_):
        self.menus.append(menu)

    def label(self, text="", **_):
        """Of a column of its own."""
        self.said.append(text)


def draw(panel, **context):
    """The Layout that a panel fills."""
    layout = Layout()
    functions = {name: value for name, value in vars(panel).items() if callable(value) or
                 isinstance(value, (staticmethod, classmethod))}
    fake = type("Fake", (), {name: functions[name] for name in functions if not name.startswith("__")})()
    fake.layout = layout
    given = {"scene": bpy.context.scene, "region": None, "view_layer": bpy.context.view_layer,
             "preferences": types.SimpleNamespace(system=types.SimpleNamespace(ui_scale=1.0)),  # which is 0 here
             "window_manager": bpy.context.window_manager, **context}
    fake.draw(types.SimpleNamespace(**given))
    return layout


def width(text):
    import blf

    blf.size(0, 11)
    return blf.dimensions(0, text)[0]


@pytest.fixture
def material():
    return bpy.data.materials.new("Sand")


@pytest.mark.parametrize("model", models.CHOICES)
def test_no_label_of_a_grain_is_cut_off(material, model):
    material.mesograin.model = model
    drawn = draw(panels.MESOGRAIN_PT_material, material=material)
    assert drawn.whole == ["model"] and len(drawn.whole + drawn.labels) >= 2
    assert cut_off(drawn) == {}
    assert width(models.CHOICES[model].label) < WHOLE


@pytest.mark.parametrize("model", models.CHOICES)
def test_whatever_of_a_grain_can_be_animated_has_its_dot(material, model):
    material.mesograin.model, material.mesograin_look.way = model, "coefficients"
    drawn = draw(panels.MESOGRAIN_PT_material, material=material)
    animated = {"model", *models.CHOICES[model].parameters}
    assert animated - set(drawn.dotted) == set() and len(drawn.dotted) == len(set(drawn.dotted)) + 4 * (
        "sigma_s" in animated), drawn.dotted  # of sigma_s and sigma_a each channel
    assert narrow(panels.MESOGRAIN_PT_material, material=material).dotted == []


@pytest.mark.parametrize("way", ["coefficients", "look"])
@pytest.mark.parametrize("across", [NARROW, 220, 260, 333, 500])
def test_what_three_numbers_are_is_read_at_any_width(material, way, across):
    """Labels have two fifths of a panel where they are split, else what a field has beside its number."""
    material.mesograin.model, material.mesograin_look.way = "model_2", way
    drawn = draw(panels.MESOGRAIN_PT_material, material=material, region=types.SimpleNamespace(width=across))
    room = 0.4 * (across - 75) if drawn.split else IN_FIELD
    assert bool(drawn.split) == (across >= 260)
    for name in {"coefficients": ("sigma_s", "sigma_a"), "look": ("Path",)}[way]:
        assert f"{name} R" in drawn.labels and width(f"{name} R") <= room


def narrow(panel, **context):
    return draw(panel, region=types.SimpleNamespace(width=NARROW), **context)


def assert_nothing_is_cut_off_where_it_is_narrow(drawn):
    assert drawn.split == [] and len(drawn.labels + drawn.boxes) >= 1
    assert {name: width(f"{name}:") for name in drawn.lists if width(f"{name}:") > BESIDE_LIST} == {}
    fields = [name for name in (*drawn.labels, *drawn.boxes) if name not in drawn.lists]
    assert {name: width(name) for name in fields if width(name) > IN_FIELD} == {}


@pytest.mark.parametrize("model", models.CHOICES)
def test_no_label_of_a_grain_is_cut_off_where_it_is_narrow(material, model):
    material.mesograin.model = model
    drawn = narrow(panels.MESOGRAIN_PT_material, material=material)
    assert_nothing_is_cut_off_where_it_is_narrow(drawn)
    if "boundary" in models.CHOICES[model].parameters:
        assert {"boundary", "masking"} <= set(drawn.whole) and {"Boundary", "Masking"} <= set(drawn.said)


@pytest.mark.parametrize("source", ["RANGE", "ATTRIBUTE"])
def test_no_label_of_grains_that_vary_is_cut_off_where_it_is_narrow(material, source):
    material.mesograin.model, material.mesograin_colours.source = "model_2", source
    assert_nothing_is_cut_off_where_it_is_narrow(narrow(grain_colours.MESOGRAIN_PT_colours, material=material))


@pytest.mark.parametrize("panel", [panels.MESOGRAIN_PT_sampling, panels.MESOGRAIN_PT_passes,
                                   panels.MESOGRAIN_PT_motion_blur, bake_panel.MESOGRAIN_PT_bake,
                                   match_panel.MESOGRAIN_PT_match])
def test_no_label_of_the_render_settings_is_cut_off_where_it_is_narrow(panel):
    bpy.context.scene.mesograin_bake.compare = True
    assert_nothing_is_cut_off_where_it_is_narrow(narrow(panel))


@pytest.mark.parametrize("kind", ["SUN", "POINT", "SPOT", "AREA"])
def test_no_label_of_a_light_is_cut_off_where_it_is_narrow(kind):
    light = bpy.data.lights.new("Light", kind)
    assert_nothing_is_cut_off_where_it_is_narrow(narrow(panels.MESOGRAIN_PT_light, light=light))


@pytest.mark.parametrize("source", ["RANGE", "ATTRIBUTE"])
@pytest.mark.parametrize("model", ["lambert", "model_2"])
def test_no_label_of_grains_that_vary_is_cut_off(material, model, source):
    material.mesograin.model, material.mesograin_colours.source = model, source
    drawn = draw(grain_colours.MESOGRAIN_PT_colours, material=material)
    assert len(drawn.labels) >= 2
    assert cut_off(drawn) == {}


def cut_off(drawn):
    return {label: width(label) for labels, most in ((drawn.labels, LABEL), (drawn.boxes, BESIDE_BOX))
            for label in labels if width(label) > most}


@pytest.mark.parametrize("panel", [panels.MESOGRAIN_PT_sampling, panels.MESOGRAIN_PT_passes,
                                   bake_panel.MESOGRAIN_PT_bake, match_panel.MESOGRAIN_PT_match])
def test_no_label_of_the_render_settings_is_cut_off(panel):
    bpy.context.scene.mesograin_bake.compare = True
    drawn = draw(panel)
    assert len(drawn.labels) >= 3
    assert cut_off(drawn) == {}


def test_the_size_of_a_comparison_is_not_cut_off():
    scene, layout = bpy.context.scene, Layout()
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 1920, 1080, 100
    scene.mesograin_compare.size_percent = 100
    compare_panel.draw_settings(layout, types.SimpleNamespace(
        scene=scene, region=None, preferences=types.SimpleNamespace(system=types.SimpleNamespace(ui_scale=1.0))))
    [said] = [text for text in layout.said if "1920" in text]
    assert "1080" in said and width(said) < BESIDE_BOX


def test_no_title_of_a_result_is_cut_off():
    entry = {"metrics": {"relative_l1": 0.01, "relative_l1_blocks": 0.01, "relative_l1_blocks_corrected": None},
             "noise_floor": {"relative_l1": 0.01}, "reference_seconds": 185.0}
    titles = [title for title, _ in results._numbers(entry, ("Mesograin", "41 ms"))]
    assert len(titles) == 5 and all(width(title) < HALF for title in titles), titles
    assert compare_panel.results is results


def test_no_button_of_a_results_picture_is_cut_off():
    class Rows(Layout):
        """rows: the texts of the buttons of each row, below one another."""

        def __init__(self):
            super().__init__()
            self.rows = []

        def row(self, **_):
            self.rows.append([])
            return self

        def operator(self, _, text):
            self.rows[-1].append(text)
            return types.SimpleNamespace()

    entry = {"name": "lambert.diffuse", "model": "lambert", "reference_title": "Cycles Diffuse",
             "status": "done", "judged_by": "relative_l1",
             "metrics": {"relative_l1": 0.01, "relative_l1_corrected": 0.005, "relative_l1_blocks": 0.01,
                         "relative_l1_blocks_corrected": None},
             "noise_floor": {"relative_l1": 0.01, "relative_l1_blocks": 0.001}, "reference_seconds": 185.0,
             "significance": None, "files": dict.fromkeys(pictures.FILES.values(), "")}
    given = types.SimpleNamespace(region=None, preferences=types.SimpleNamespace(
        system=types.SimpleNamespace(ui_scale=1.0)))
    layout = Rows()
    button = types.SimpleNamespace(bl_idname="mesograin.show_picture")
    results.draw(layout, given, entry, ("Mesograin", "41 ms"), button)
    rows = [row for row in layout.rows if row]
    assert sorted(itertools.chain(*rows)) == sorted(text for text, _ in pictures.BUTTONS.values())
    beside = 10  # pixels of a button, left and right of its text
    assert [text for row in rows for text in row if width(text) + beside > 2 * HALF / len(row)] == [], rows


@pytest.mark.parametrize("kind, rest", [("worlds", "color"), ("materials", "diffuse_color")])
def test_the_button_for_nodes_keeps_its_name(kind, rest):
    datablock = getattr(bpy.data, kind).new("Plain")
    if not compat.has_choice_of_nodes(datablock):
        pytest.skip("this Blender has no such button")
    layout = Layout()
    node_panels.draw_surface(layout, datablock, rest)
    assert layout.boxes == ["Use Nodes"] and layout.split == [rest]  # a button with an icon loses its name in a split


def test_no_menu_of_materials_is_longer_than_a_small_screen_and_together_they_have_all():
    class Rows(Layout):
        """rows: what a menu shows, one below the other; chosen: the presets among them."""

        def __init__(self):
            super().__init__()
            self.rows, self.chosen = [], []

        def operator(self, name, **_):
            self.rows.append(name)
            chosen = types.SimpleNamespace(preset=None)
            self.chosen.append(chosen)
            return chosen

        def menu(self, name, **_):
            self.rows.append(name)
            assert hasattr(bpy.types, name), name

        def label(self, text="", **_):
            self.rows.append(text)

    shown = []
    for menu in (presets.MESOGRAIN_MT_presets, *presets.MEASURED):
        rows = Rows()
        menu.draw(types.SimpleNamespace(layout=rows), None)
        assert len(rows.rows) <= 16, "of 23 pixels each, where half a screen of 768 is free"
        shown += [chosen.preset for chosen in rows.chosen if chosen.preset]
    assert shown == list(presets.BY_IDENTIFIER)


@pytest.mark.parametrize("samples, said", [(1, "1 sample"), (2, "2 samples")])
def test_timings_are_told_in_words(samples, said):
    status.clear()
    status.put(status.RENDER, status.Status(samples, 40, 30, (("light_maps", 1.5),)))
    drawn = draw(panels.MESOGRAIN_PT_statistics)
    status.clear()
    assert drawn.said[-2:] == [f"Last render: 40 x 30, {said}", "light maps: 1.50 ms"]


def test_the_light_type_is_chosen_in_one_place():
    for name in ("DATA_PT_light", "NODE_DATA_PT_light"):
        panel = getattr(bpy.types, name, None)
        assert panel is None or engine.MesograinRenderEngine.bl_idname not in panel.COMPAT_ENGINES
    assert bpy.types.DATA_PT_lens in compat.borrowed_panels()


def test_only_profiles_that_a_model_knows_are_offered(native, material):
    assert panels.MESOGRAIN_MT_profiles.bl_idname in draw(panels.MESOGRAIN_PT_material, material=sugar(material)).menus
    mesh = native.Mesh([[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], None,
                       [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
    view = native.View(4, 4)
    view.set_camera(native.Camera.look_at((0.0, 0.0, 2.0), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0), 40.0))
    profiles = [choice.name for choice in parameters.PARAMETERS["profile"].choices]
    for model, profile in itertools.product(models.NAMES, profiles):
        material.mesograin.model, material.mesograin.profile = model, profile
        known = dict(export.material_values(material, 1.0).values)
        try:
            view.set_scene(native.Scene(instances=[native.Instance(mesh, native.Material(**known), np.eye(4))]))
            view.render(1)
            works = True
        except native.Error:
            works = False
        assert works == (profile in parameters.profiles_of(model)), (model, profile)


def test_a_profile_that_the_model_does_not_know_is_named_with_model_and_material(native, material):
    sugar(material).mesograin.profile = "photon_beam"
    with pytest.raises(native.Error) as complaint:
        export.material_values(material, 1.0).to_native(native)
    sentence = str(complaint.value)
    assert all(word in sentence for word in ("'Sand'", "Model 2", "'Photon beam'", "Half space")), sentence


def sugar(material):
    material.mesograin.model = "model_2"
    return material
