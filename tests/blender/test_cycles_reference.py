# A reference leaves the user's scene as it was, is found again if and only if nothing that it shows has changed, and
# shows what theory says.
import json
import math
import pathlib

import bpy
import numpy as np
import pytest
from cycles_scenes import RADIUS, depsgraph, make_sphere, sphere_points, unit

from test_export import read_scene

from mesograin.cycles import nodes, reference, shot
from mesograin.cycles.cache import Cache
from mesograin.cycles.stage import StageError
from mesograin.scene import export
from mesograin.studies.comparison.ours import Ours

FRONT = [((1.0, 1.0, 1.0), 20.0)]


def state():
    """All that a render could disturb: the data-blocks and the scene's settings. Blender itself keeps its last
    render."""
    blocks = {
        name: sorted(block.name for block in getattr(bpy.data, name) if block.name != "Render Result")
        for name in ("scenes", "worlds", "meshes", "objects", "lights", "cameras", "materials", "images", "node_groups")
    }
    scene = bpy.context.scene
    owners = (scene.render, scene.render.image_settings, scene.cycles, scene.view_settings)
    settings = [
        {
            name: getattr(owner, name)
            for name, kind in owner.bl_rna.properties.items()
            if kind.type in ("INT", "FLOAT", "BOOLEAN") and not getattr(kind, "is_array", False)
        }
        for owner in owners
    ]
    return blocks, settings, bpy.context.window.scene if bpy.context.window else None


@pytest.fixture
def counted(monkeypatch):
    """Puts a quick stand-in where Cycles renders; returns the list of scenes it was given."""
    rendered = []

    def stand_in(native, scene, on_progress, light):
        rendered.append(scene.cycles.seed)
        on_progress(1.0)
        return np.full((scene.render.resolution_y, scene.render.resolution_x, 4), 1.0 + scene.cycles.seed, np.float32)

    monkeypatch.setattr(shot, "render_stage", stand_in)
    return rendered


def test_scene_stays_as_it_was(tmp_path):
    make_sphere(FRONT, segments=16, rings=8)
    bpy.context.scene.cycles.samples = 123
    before = state()
    found = reference.render(depsgraph(), "diffuse", (16, 16), samples=2, cache=Cache(tmp_path))
    assert found.mean.shape == (16, 16, 4) and not found.cached and found.seconds > 0.0
    assert state() == before


def test_scene_stays_as_it_was_when_rendering_fails(monkeypatch):
    make_sphere(FRONT, segments=16, rings=8)
    before = state()

    def fail(*_):
        raise MemoryError("no more")

    monkeypatch.setattr(shot, "render_stage", fail)
    with pytest.raises(MemoryError):
        reference.render(depsgraph(), "diffuse", (16, 16), samples=2)
    assert state() == before


def test_found_again_bit_for_bit(tmp_path):
    make_sphere(FRONT, segments=16, rings=8)
    fractions = []
    first = reference.render(
        depsgraph(), "volume_index_matched", (16, 16), samples=2, cache=Cache(tmp_path), on_progress=fractions.append
    )
    again = reference.render(depsgraph(), "volume_index_matched", (16, 16), samples=2, cache=Cache(tmp_path))
    assert again.cached and again.seconds == first.seconds and again.provenance == first.provenance
    np.testing.assert_array_equal(again.images, first.images)
    assert not np.array_equal(first.images[0], first.images[1])
    assert fractions == sorted(fractions) and fractions[-1] == 1.0


def move_camera(_):
    bpy.context.scene.camera.location.x += 1e-3


def move_vertex(_):
    bpy.data.objects["Sphere"].data.vertices[0].co.x += 1e-3


def flatten(_):
    bpy.data.objects["Sphere"].data.polygons[0].use_smooth = False


def sharpen(_):
    bpy.data.objects["Sphere"].data.edges[0].use_edge_sharp = True


def bend_normals(_):
    mesh = bpy.data.objects["Sphere"].data
    if hasattr(mesh, "use_auto_smooth"):
        mesh.use_auto_smooth = True
    mesh.normals_split_custom_set_from_vertices([(0.0, 0.6, 0.8)] * len(mesh.vertices))


def turn_sun(_):
    bpy.data.objects["Sun"].rotation_euler.x += 1e-3


def brighten(_):
    bpy.data.lights["Sun"].energy *= 1.001


def colour(_):
    bpy.data.lights["Sun"].color[1] = 0.9


def widen(_):
    bpy.data.lights["Sun"].angle = 0.1


def zoom(_):
    bpy.context.scene.camera.data.lens += 0.1


def squeeze(_):
    bpy.context.scene.render.pixel_aspect_x = 1.1


def scatter(material):
    material.mesograin.g = 0.1


def densify(_):
    bpy.context.scene.mesograin.millimetres_per_unit = 2.0


@pytest.mark.parametrize(
    "change",
    [
        move_camera,
        move_vertex,
        flatten,
        sharpen,
        bend_normals,
        turn_sun,
        brighten,
        colour,
        widen,
        zoom,
        squeeze,
        scatter,
        densify,
    ],
)
def test_not_found_after_a_change(counted, tmp_path, change):
    material = make_sphere(FRONT, segments=16, rings=8)

    def render(**changes):
        done = {"size": (8, 8), "samples": 2, "seeds": (1,), "cache": Cache(tmp_path), **changes}
        return reference.render(depsgraph(), "subsurface", **done)

    render()
    assert render().cached
    change(material)
    assert not render().cached
    assert len(counted) == 2


def test_bent_normals_are_found_again(counted, tmp_path):
    make_sphere(FRONT)
    bend_normals(None)
    for _ in range(6):
        reference.render(depsgraph(), "diffuse", (8, 8), samples=2, seeds=(1,), cache=Cache(tmp_path))
    assert len(counted) == 1


def test_one_reference_serves_every_model_that_it_answers(counted, tmp_path):
    """Cycles sees no model; and a fine mesh, whose normals Blender sums in threads, is still the same mesh."""
    material = make_sphere(FRONT, segments=256, rings=128)
    for model in ("model_1", "model_2", "model_3", "model_1", "model_2", "model_3"):
        material.mesograin.model = model
        reference.render(depsgraph(), "volume_index_matched", (8, 8), samples=2, cache=Cache(tmp_path))
    assert sorted(counted) == [0, 1, 2]


def test_not_found_with_other_settings(counted, tmp_path):
    make_sphere(FRONT, segments=16, rings=8)
    base = {"kind": "subsurface", "size": (8, 8), "samples": 2, "seeds": (1,), "cache": Cache(tmp_path)}
    reference.render(depsgraph(), **base)
    for change in (
        {"samples": 3},
        {"seeds": (7,)},
        {"size": (9, 8)},
        {"kind": "diffuse"},
        {"overrides": {"sigma_s": (0.5, 0.5, 0.5)}},
    ):
        assert not reference.render(depsgraph(), **{**base, **change}).cached
    # What the picture doesn't show may change.
    bpy.context.scene.cycles.samples = 5
    bpy.data.objects["Sphere"].name = "Other"
    assert reference.render(depsgraph(), **base).cached


def test_an_unreadable_file_is_rendered_again(counted, tmp_path):
    make_sphere(FRONT, segments=16, rings=8)
    base = {"kind": "diffuse", "size": (8, 8), "samples": 2, "seeds": (1,), "cache": Cache(tmp_path)}
    first = reference.render(depsgraph(), **base)
    for path in tmp_path.iterdir():
        path.write_bytes(path.read_bytes()[:40])
    np.testing.assert_array_equal(reference.render(depsgraph(), **base).images, first.images)
    assert len(counted) == 2 and reference.render(depsgraph(), **base).cached


@pytest.mark.parametrize("damage", ["smaller", "three channels", "another's", "no provenance"])
def test_a_file_that_is_not_this_reference_is_rendered_again(native, counted, tmp_path, damage):
    make_sphere(FRONT, segments=16, rings=8)
    base = {"kind": "diffuse", "size": (8, 8), "samples": 2, "seeds": (1,), "cache": Cache(tmp_path)}
    first = reference.render(depsgraph(), **base)
    for path in tmp_path.iterdir():
        pixels, _, attributes = native.read_exr(path)
        provenance = attributes[shot.PROVENANCE]
        if damage == "another's":
            provenance = provenance.replace(path.stem, "0" * len(path.stem))
        if damage == "no provenance":
            provenance = "null"
        pixels = {"smaller": pixels[:4], "three channels": pixels[..., :3].copy()}.get(damage, pixels)
        native.write_exr(path, pixels, attributes={shot.PROVENANCE: provenance})
    np.testing.assert_array_equal(reference.render(depsgraph(), **base).images, first.images)
    assert len(counted) == 2 and reference.render(depsgraph(), **base).cached


@pytest.mark.parametrize("kind", ("volume_index_matched", "volume_lambert"))
def test_light_leaves_a_volume_by_flat_faces_that_came_in_by_smooth_ones(kind):
    make_sphere(FRONT, segments=16, rings=8, sigma_s=(2.0, 2.0, 2.0))
    faces = bpy.data.objects["Sphere"].data.polygons

    def rendered(smooth):
        faces.foreach_set("use_smooth", smooth)
        bpy.data.objects["Sphere"].data.update()
        (image,) = reference.render(depsgraph(), kind, (24, 24), samples=16, seeds=(1,)).images
        return image[..., :3].astype(float)

    mixed, flat = rendered(np.arange(len(faces)) % 2 == 0), rendered(np.zeros(len(faces), dtype=bool))
    # Where nothing refracts, normals are nothing to light. Else they are other ones, and the paths, too.
    bound = 1e-5 if kind == "volume_index_matched" else 0.1
    assert np.abs(mixed - flat).sum() <= bound * flat.sum()


def test_objects_that_are_no_shapes_are_in_nobodys_way(counted):
    make_sphere(FRONT, segments=16, rings=8)
    collection = bpy.context.scene.collection
    made = [None, bpy.data.lights.new("Lamp", "POINT"), bpy.data.armatures.new("Bones"), bpy.data.lattices.new("Cage"),
            bpy.data.cameras.new("Other"), bpy.data.speakers.new("Sound"), bpy.data.volumes.new("Fog")]
    for data in made:
        collection.objects.link(bpy.data.objects.new("Thing", data))
    reference.render(depsgraph(), "diffuse", (8, 8), samples=2)
    assert len(counted) == 2


@pytest.mark.parametrize("degrees, bar", [(20.0, 0.005), (90.0, 0.04)])
def test_a_wide_sun_is_the_same_on_both_sides(native, degrees, bar):
    # Said, because a new material of Blender 5 has nodes, and is drawn by these until it is a grain.
    make_sphere(FRONT, segments=32, rings=16, model="lambert")
    bpy.data.lights[0].angle = math.radians(degrees)
    theirs = reference.render(depsgraph(), "diffuse", (24, 24), samples=256, seeds=(1,)).images[0][..., :3]
    view = native.View(24, 24)
    view.set_scene(export.scene_from_depsgraph(depsgraph())[0])
    view.set_camera(export.camera_from_scene(depsgraph(), 24, 24))
    view.render(256)
    assert view.read()[..., :3].sum() == pytest.approx(theirs.sum(), rel=bar)


@pytest.mark.parametrize("degrees, bar", [(0.0, 1e-3), (20.0, 2e-3), (60.0, 2e-3)])
def test_a_plane_that_faces_a_wide_sun_receives_what_cycles_says(native, degrees, bar):
    """Its strength, or the mean cosine of it (docs/scene-json.md) where Cycles' suns are flat discs."""
    make_sphere([((0.0, 0.0, 1.0), 2.0)])
    bpy.data.objects.remove(bpy.data.objects["Sphere"])
    bpy.ops.mesh.primitive_plane_add(size=20.0)
    bpy.data.lights[0].angle = math.radians(degrees)
    flat = 2.0 / (1.0 + 1.0 / math.cos(math.radians(degrees) / 2.0))
    share = 1.0 if nodes.features().even_suns else flat
    expected = 2.0 * share * 0.5 / math.pi
    theirs = reference.render(depsgraph(), "diffuse", (16, 16), samples=256, seeds=(1,),
                              overrides={"reflectance": (0.5,) * 3}).images[0][..., :3]
    assert theirs.mean() == pytest.approx(expected, rel=bar)
    ours = Ours(depsgraph(), (16, 16), {"reflectance": (0.5,) * 3})
    ours.begin({"model": "lambert"})
    assert np.mean(ours.refine(256), axis=0)[..., :3].mean() == pytest.approx(expected, rel=1e-3)


def test_a_sun_that_cycles_cannot_render_like_ours_is_named(counted):
    make_sphere(FRONT, segments=16, rings=8)
    bpy.data.lights[0].angle = math.pi
    if nodes.features().even_suns:
        reference.render(depsgraph(), "diffuse", (8, 8), samples=2)
        return
    with pytest.raises(reference.ReferenceError, match="flat disc, which was compared up to 175 degrees; got 180"):
        reference.render(depsgraph(), "diffuse", (8, 8), samples=2)
    assert counted == []


def text():
    data = bpy.data.curves.new("Text", "FONT")
    data.body, data.size, data.extrude = "M", 3.0, 0.2
    return data


def metaball():
    data = bpy.data.metaballs.new("Drop")
    data.elements.new().radius = 2.0
    return data


def tube():
    data = bpy.data.curves.new("Tube", "CURVE")
    data.bevel_depth = 1.0
    points = data.splines.new("POLY").points
    points.add(1)
    points[0].co, points[1].co = (-1.0, 0.0, 0.0, 1.0), (1.0, 0.0, 0.0, 1.0)
    return data


@pytest.mark.parametrize("make", [text, metaball, tube])
def test_shapes_that_are_no_meshes_cover_what_ours_do(native, make):
    make_sphere(FRONT, segments=16, rings=8)
    scene = bpy.context.scene
    bpy.data.objects.remove(bpy.data.objects["Sphere"])
    scene.collection.objects.link(bpy.data.objects.new("Shape", make()))
    theirs = reference.render(depsgraph(), "diffuse", (32, 32), samples=16, seeds=(1,)).images[0][..., 3]
    assert len(read_scene().instances) == 1, "it is drawn twice"
    view = native.View(32, 32)
    view.set_scene(export.scene_from_depsgraph(depsgraph())[0])
    view.set_camera(export.camera_from_scene(depsgraph(), 32, 32))
    view.render(16)
    ours = view.read()[..., 3]
    assert ours.sum() > 30.0 and abs(ours - theirs).mean() < 0.02


@pytest.mark.parametrize("kind", ["PANO", "LIGHT", "EMPTY"])
def test_a_camera_that_is_not_like_for_like_is_named(counted, kind):
    make_sphere(FRONT, segments=16, rings=8)
    scene = bpy.context.scene
    if kind == "PANO":
        scene.camera.data.type = kind
    else:
        scene.camera = bpy.data.objects.new("Eye", bpy.data.lights.new("Eye", "POINT") if kind == "LIGHT" else None)
        scene.collection.objects.link(scene.camera)
    with pytest.raises(StageError, match=f"perspective or orthographic camera, and '{scene.camera.name}' is "):
        reference.render(depsgraph(), "diffuse", (8, 8), samples=2)
    assert counted == []


def test_a_cache_that_cannot_be_written_costs_nothing_but_time(counted, tmp_path, capsys):
    make_sphere(FRONT, segments=16, rings=8)
    (tmp_path / "file").write_text("")
    found = reference.render(depsgraph(), "diffuse", (8, 8), samples=2, cache=Cache(tmp_path / "file" / "cache"))
    assert len(counted) == 2 and not found.cached
    assert "not kept" in capsys.readouterr().out


def test_what_cannot_be_rendered_is_said():
    material = make_sphere(FRONT, segments=16, rings=8, g=-0.5)
    with pytest.raises(reference.ReferenceError, match="'Sand'.*g between 0 and 0.9"):
        reference.render(depsgraph(), "subsurface", (8, 8), samples=1)
    material.mesograin.g, material.mesograin.eta = 0.0, 4.0
    assert "1.01 to 3.8" in reference.render(depsgraph(), "subsurface", (8, 8), samples=1).notes[0]
    bpy.context.scene.camera = None
    with pytest.raises(StageError, match="no camera"):
        reference.render(depsgraph(), "diffuse", (8, 8), samples=1)


def test_no_light_and_no_mesh_are_said():
    make_sphere([], segments=16, rings=8)
    with pytest.raises(StageError, match="no visible light"):
        reference.render(depsgraph(), "diffuse", (8, 8), samples=1)
    bpy.data.objects["Sphere"].hide_viewport = True
    with pytest.raises(StageError, match="no visible mesh"):
        reference.render(depsgraph(), "diffuse", (8, 8), samples=1)


def mean_where(inside, image, hits):
    """Relative L1 and ratio of sums against `inside`, over pixels that the sphere covers wholly, but for the rim."""
    covered = hits.all(axis=(2, 3))
    for axis in (0, 1):
        covered = covered & np.roll(covered, 1, axis) & np.roll(covered, -1, axis)
    expected = inside.mean(axis=(2, 3))[covered]
    found = image[covered][:, 0]
    return np.abs(found - expected).sum() / expected.sum(), found.sum() / expected.sum()


def test_diffuse_is_lambert():
    suns = [((1.0, 1.0, 1.0), 20.0), ((-1.0, -1.0, -1.6), 10.0)]
    make_sphere(suns, reflectance=(0.5,) * 3)
    image = reference.render(depsgraph(), "diffuse", (64, 64), samples=32).mean
    normals, _, hits = sphere_points(64)
    radiance = (
        sum(irradiance * np.maximum(normals @ unit(towards), 0.0) for towards, irradiance in suns) * 0.5 / math.pi
    )
    error, total = mean_where(radiance, image, hits)
    assert error < 0.003 and total == pytest.approx(1.0, abs=0.001)
    assert np.abs(image[..., 3] - hits.mean(axis=(2, 3))).max() < 0.2


def ggx(normals, viewer, light, alpha, masking):
    """GGX reflection with F = 1, per irradiance on a facing plane: Walter et al. 2007, Heitz 2014."""
    half = viewer + light
    half /= np.linalg.norm(half, axis=-1, keepdims=True)
    n_h, n_l, n_v = ((normals * other).sum(axis=-1) for other in (half, np.broadcast_to(light, normals.shape), viewer))
    n_l, n_v = np.maximum(n_l, 1e-6), np.maximum(n_v, 1e-6)
    distribution = alpha**2 / (math.pi * (n_h**2 * (alpha**2 - 1.0) + 1.0) ** 2)
    lambdas = [0.5 * (np.sqrt(1.0 + alpha**2 * (1.0 / c**2 - 1.0)) - 1.0) for c in (n_l, n_v)]
    visible = 1.0 / ((1.0 + lambdas[0]) * (1.0 + lambdas[1]) if masking == "separable" else 1.0 + sum(lambdas))
    return np.where(n_l > 1e-6, distribution * visible / (4.0 * n_v), 0.0)


def test_glossy_is_ggx_with_the_masking_we_claim():
    make_sphere(FRONT, reflectance=(1.0,) * 3, roughness=1.0)
    image = reference.render(depsgraph(), "glossy", (48, 48), samples=32).mean
    normals, viewer, hits = sphere_points(48)
    errors = {
        masking: mean_where(20.0 * ggx(normals, viewer, unit((1, 1, 1)), 1.0, masking), image, hits)[0]
        for masking in ("separable", "correlated")
    }
    claimed = nodes.features().glossy_masking
    other = {"separable": "correlated", "correlated": "separable"}[claimed]
    assert errors[claimed] < 0.01 < 0.03 < errors[other]


# Exitance per irradiance of a sphere of 2.4 mean free paths and albedo 0.9 at cos(n, l) = -0.9, 0.1 and 0.9, seen at
# right
# angles to the light: Monte Carlo of an index-matched walk that starts on a cosine lobe round the normal, or along the
# view
# ray refracted by 1.3.
COSINE, REFRACTED = (0.034, 0.150, 0.492), (0.0231, 0.1410, 0.5042)


@pytest.mark.parametrize("kind", ["subsurface", "volume_lambert"])
def test_subsurface_is_the_walk_we_claim(kind):
    make_sphere([((0.0, 1.0, 0.0), 20.0)], sigma_s=(0.9,) * 3, sigma_a=(0.1,) * 3, eta=1.3, roughness=0.0)
    lens = bpy.context.scene.camera.data
    lens.type, lens.ortho_scale = "ORTHO", 2.0 * RADIUS
    bpy.context.scene.camera.rotation_euler = (0.0, 0.0, 0.0)
    size = 64
    image = reference.render(depsgraph(), kind, (size, size), samples=96).mean
    cosines = 1.0 - (np.arange(size)[:, None] + 0.5) / size * 2.0
    covered = image[..., 3] > 0.9999
    refracts = kind == "subsurface" and nodes.features().subsurface_refracts
    claimed, other = (REFRACTED, COSINE) if refracts else (COSINE, REFRACTED)
    for cosine, tolerance, expected, not_expected in zip((-0.9, 0.1, 0.9), (0.12, 0.04, 0.05), claimed, other):
        found = math.pi * image[covered & (np.abs(cosines - cosine) < 0.04)][:, 0].mean() / 20.0
        assert found == pytest.approx(expected, rel=tolerance)
        if abs(expected - not_expected) > 2.0 * tolerance * expected:
            assert abs(found - expected) < abs(found - not_expected)


PHOTONS = pathlib.Path(__file__).resolve().parents[1] / "data/reference"


@pytest.mark.parametrize("file", ["mc_H_e1.0_s1_K.exr", "mc_H_e1.0_s20_A.exr"])
def test_volumes_are_what_photons_do(native, file):
    """An index-matched sphere of 2.4 mean free paths lit from behind, and one of 48 lit from the front."""
    photons = {each["file"]: each for each in json.loads((PHOTONS / "manifest.json").read_text())["images"]}[file]
    medium, [light] = photons["material"], photons["lights"]
    make_sphere([(light["direction_to_light"], light["irradiance_linear_rgb"][0])],
                **{name: medium[name] for name in ("sigma_s", "sigma_a", "scale", "eta")})
    bpy.context.scene.camera.rotation_euler = (0.0, 0.0, 0.0)
    size, block = 32, 8
    image = reference.render(depsgraph(), "volume_index_matched", (size, size), samples=64).mean[..., 1]
    truth = native.read_exr(str(PHOTONS / file))[0][..., 1]
    truth = truth.reshape(size, truth.shape[0] // size, size, -1).mean(axis=(1, 3))
    covered = sphere_points(size)[2].all(axis=(2, 3))

    def in_blocks(picture):
        return np.where(covered, picture, 0.0).reshape(size // block, block, size // block, block).sum(axis=(1, 3))

    found, expected = in_blocks(image), in_blocks(truth)
    assert found.sum() == pytest.approx(expected.sum(), rel=0.01)
    assert np.abs(found - expected).sum() < 0.03 * expected.sum()
