# What a file remembers: the grain of each material and the render settings of each scene.
import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, FloatVectorProperty, IntProperty, PointerProperty

# Numbered, so that files keep their meaning when an item is added; names and order are the native module's.
MODELS = (
    ("lambert", "Lambert", "Opaque and diffuse: reflectance and nothing else", 0),
    ("conductor", "Conductor", "A rough mirror (GGX), single scattering between facets", 1),
    ("model_1", "Model 1: surface", "Translucent; light leaves where it enters. Right for grains many mean free paths "
     "thick, and the fastest", 2),
    ("model_2", "Model 2: thickness", "Translucent; adds light that shines through, by the thickness towards the light",
     3),
    ("model_3", "Model 3: area", "Translucent; gathers light over the lit surface. The slowest", 4),
)
BOUNDARIES = (
    ("dielectric", "Dielectric", "A smooth or rough interface of relative index eta: what a grain has", 0),
    ("index_matched", "Index matched", "No interface: light enters and leaves without refraction or reflection", 1),
    ("lambert_lambert", "Lambert, Lambert", "A cosine lobe on the light's and on the view's side: what the Subsurface "
     "Scattering node of Blender 3 solves", 2),
    ("lambert_refracted", "Lambert, refracted", "A cosine lobe on the light's side, a view ray refracted by eta: what "
     "the Subsurface Scattering node of Blender 4 solves", 3),
)
MASKINGS = (
    ("correlated", "Correlated", "Height-correlated Smith masking and shadowing, as Cycles has from Blender 4", 0),
    ("separable", "Separable", "Separable Smith masking and shadowing, as Cycles has in Blender 3", 1),
)
PROFILES = (
    ("half_space", "Half space", "The exact answer of a flat, infinitely thick medium", 0),
    ("better_dipole", "Better dipole", "The dipole of d'Eon", 1),
    ("dipole", "Dipole", "The dipole of Jensen and others", 2),
    ("photon_beam", "Photon beam", "Photon beam diffusion of Habel and others", 3),
)


# Blender tags nothing when a script sets a value of ours; an update function does, and redraws follow.
def _tag(properties, _context):
    properties.id_data.update_tag()


class MaterialProperties(bpy.types.PropertyGroup):
    """`material.mesograin`: one grain material, in the units and names of the native module but for 1/mm."""

    model: EnumProperty(name="Model", items=MODELS, default="lambert", update=_tag,
                        description="Which physics answers")
    reflectance: FloatVectorProperty(
        name="Reflectance", size=3, default=(0.5, 0.5, 0.5), min=0.0, max=1.0, precision=3, update=_tag,
        description="Albedo of Lambert, or reflectance of the conductor's facets, linear R, G and B, without unit")
    sigma_a: FloatVectorProperty(
        name="sigma_a", size=3, default=(0.1, 0.1, 0.1), min=0.0, max=1e12, soft_max=10.0, step=1,
        precision=4, update=_tag, description="Absorption coefficient for R, G and B, in 1/mm")
    sigma_s: FloatVectorProperty(
        name="sigma_s", size=3, default=(0.9, 0.9, 0.9), min=0.0, max=1e12, soft_max=20.0, step=1,
        precision=4, update=_tag, description="Scattering coefficient for R, G and B, in 1/mm. Not reduced: a table's "
        "sigma_s' equals sigma_s where g is 0")
    g: FloatProperty(
        name="g", default=0.0, min=-1.0, max=1.0, soft_min=-0.99, soft_max=0.99, precision=3, update=_tag,
        description="Mean cosine of the scattering angle (Henyey-Greenstein), without unit; above 0 is forward")
    eta: FloatProperty(
        name="eta", default=1.3, min=0.5, max=4.0, soft_min=1.0, soft_max=2.5, precision=3, update=_tag,
        description="Index of refraction of the grain relative to what surrounds it, without unit")
    roughness: FloatProperty(
        name="Roughness", default=0.0, min=0.0, max=1.0, precision=3, update=_tag,
        description="GGX alpha of the surface, without unit; the roughness of Cycles' nodes is its square root")
    scale: FloatProperty(
        name="Scale", default=1.0, min=0.0, max=1e12, soft_max=100.0, precision=3, update=_tag,
        description="Multiplies sigma_a and sigma_s, without unit; a larger one is a denser grain")
    specular: BoolProperty(
        name="Specular", default=True, update=_tag,
        description="Show what a dielectric surface reflects. What enters is the rest, shown or not. A roughness of 0 "
        "is a mirror, in which only a sun with an angle shows")
    boundary: EnumProperty(name="Boundary", items=BOUNDARIES, default="dielectric", update=_tag,
                           description="What light meets at the grain's surface")
    masking: EnumProperty(name="Masking", items=MASKINGS, default="correlated", update=_tag,
                          description="How facets of a rough surface hide one another")
    profile: EnumProperty(name="Profile", items=PROFILES, default="half_space", update=_tag,
                          description="The theory that answers for multiple scattering")


class SceneProperties(bpy.types.PropertyGroup):
    """`scene.mesograin`: how finely to render, and how long a Blender unit is."""

    samples: IntProperty(name="Render samples", default=64, min=1, max=1 << 20, soft_max=4096, update=_tag,
                         description="Samples of each pixel in a final render")
    viewport_samples: IntProperty(name="Viewport samples", default=64, min=1, max=1 << 20, soft_max=4096, update=_tag,
                                  description="Samples of each pixel after which the viewport rests")
    millimetres_per_unit: FloatProperty(
        name="Millimetres per unit", default=1.0, min=1e-6, max=1e9, soft_min=0.001, soft_max=1000.0, precision=4,
        update=_tag, description="Length of one Blender unit in mm; coefficients in 1/mm are multiplied by it")


MATERIAL_PARAMETERS = ("model", "reflectance", "sigma_a", "sigma_s", "g", "eta", "roughness", "scale", "specular",
                       "boundary", "masking", "profile")

_register_classes, _unregister_classes = bpy.utils.register_classes_factory((MaterialProperties, SceneProperties))


def register():
    _register_classes()
    bpy.types.Material.mesograin = PointerProperty(type=MaterialProperties)
    bpy.types.Scene.mesograin = PointerProperty(type=SceneProperties)


def unregister():
    del bpy.types.Scene.mesograin
    del bpy.types.Material.mesograin
    _unregister_classes()
