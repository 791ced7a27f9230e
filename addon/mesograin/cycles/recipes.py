# The Cycles node tree of each kind of reference, as plain data: hashed for the cache, kept with the render, built by
# `nodes`.
"""A recipe is {"nodes": {name: {"type", "properties", "inputs"}}, "links": [[from, from socket, to, to socket]],
"material": {property of `material.cycles`}}.

`inputs` maps socket names, or numbers where names repeat, to values. Names in `optional` are sockets that only some
Blenders have; they are set where they are. Tuples are linear RGB.
"""

from . import inversion, limits

OUTPUT = "Output"


def recipe(kind, values, features):
    """The recipe for a kind of reference; see the module. `values`: GrainValues. `features`: kinds.NodeFeatures.

    Raises ValueError for a kind that Cycles does not render.
    """
    if kind not in _RECIPES:
        raise ValueError(f"There are Cycles materials for {', '.join(_RECIPES)}, none for '{kind}': choose another.")
    return _RECIPES[kind](values, features)


def _recipe(nodes, surface=None, volume=(), material=None):
    """Puts the output node and its links round `nodes`; `volume` names one or two shaders, which are added."""
    nodes = dict(nodes)
    nodes[OUTPUT] = {"type": "ShaderNodeOutputMaterial", "properties": {"target": "ALL"}, "inputs": {}, "optional": {}}
    links = []
    if surface:
        links.append([surface[0], surface[1], OUTPUT, "Surface"])
    if volume:
        nodes["Sum"] = {"type": "ShaderNodeAddShader", "properties": {}, "inputs": {}, "optional": {}}
        links += [[name, "Volume", "Sum", index] for index, name in enumerate(volume)]
        links.append(["Sum", "Shader", OUTPUT, "Volume"])
    return {"nodes": nodes, "links": links, "material": material or {}}


def _diffuse(values, features):
    node = {
        "type": "ShaderNodeBsdfDiffuse",
        "properties": {},
        "inputs": {"Color": values.reflectance, "Roughness": 0.0},
        "optional": {},
    }
    return _recipe({"Diffuse": node}, surface=("Diffuse", "BSDF"))


def _glossy(values, features):
    # Cycles squares the node's roughness to get GGX's alpha.
    node = {
        "type": features.glossy_type,
        "properties": {"distribution": "GGX"},
        "inputs": {"Color": values.reflectance, "Roughness": values.roughness**0.5},
        "optional": {"Anisotropy": 0.0, "Rotation": 0.0},
    }
    return _recipe({"Glossy": node}, surface=("Glossy", "BSDF"))


def _coefficients(sigma):
    """(density, colour) with density * colour = sigma in every channel, exactly so in the brightest one."""
    density = max(sigma)
    return density, tuple(value / density for value in sigma) if density > 0.0 else (1.0, 1.0, 1.0)


def _medium(values, features):
    """The two volume shaders, by name."""
    # sigma_s = density * colour of the scatter node; sigma_a = density * (1 - colour) of the absorption node.
    scatter_density, scatter_colour = _coefficients(values.sigma_s)
    absorption_density, absorption_colour = _coefficients(values.sigma_a)
    g = min(max(values.g, -limits.PHASE_LIMIT), limits.PHASE_LIMIT)
    scatter = {
        "type": "ShaderNodeVolumeScatter",
        "properties": {"phase": "HENYEY_GREENSTEIN"} if features.has_phase_choice else {},
        "inputs": {"Color": scatter_colour, "Density": scatter_density, "Anisotropy": g},
        # Parameters of the phase functions that are not chosen.
        "optional": {"IOR": 1.33, "Backscatter": 0.1, "Alpha": 0.5, "Diameter": 20.0},
    }
    absorption = {
        "type": "ShaderNodeVolumeAbsorption",
        "properties": {},
        "inputs": {"Color": tuple(1.0 - value for value in absorption_colour), "Density": absorption_density},
        "optional": {},
    }
    return {"Scatter": scatter, "Absorption": absorption}


_VOLUME = ("Scatter", "Absorption")
_VOLUME_SETTINGS = {"homogeneous_volume": True, "volume_sampling": "DISTANCE", "volume_interpolation": "LINEAR"}


def _volume_index_matched(values, features):
    return _recipe(_medium(values, features), volume=_VOLUME, material=_VOLUME_SETTINGS)


def _volume_lambert(values, features):
    # A cosine lobe where light enters and one where it leaves, as the random walk of `_subsurface` has them.
    entry = {
        "type": "ShaderNodeBsdfTranslucent",
        "properties": {},
        "inputs": {"Color": (1.0, 1.0, 1.0)},
        "optional": {},
    }
    nodes = {"Entry": entry, **_medium(values, features)}
    return _recipe(nodes, surface=("Entry", "BSDF"), volume=_VOLUME, material=_VOLUME_SETTINGS)


def _volume_dielectric(values, features):
    # Not the Refraction BSDF, which has no Fresnel reflection.
    glass = {
        "type": "ShaderNodeBsdfGlass",
        "properties": {"distribution": features.glass_distribution},
        "inputs": {"Color": (1.0, 1.0, 1.0), "Roughness": 0.0, "IOR": values.eta},
        "optional": {"Thin Film Thickness": 0.0, "Thin Film IOR": 1.33},
    }
    nodes = {"Glass": glass, **_medium(values, features)}
    return _recipe(nodes, surface=("Glass", "BSDF"), volume=_VOLUME, material=_VOLUME_SETTINGS)


def _dielectric_specular(values, features):
    # Cycles squares the node's roughness to get GGX's alpha.
    if not features.facets_have_fresnel and 1.0 <= values.eta <= limits.PRINCIPLED_IOR:
        return _principled_specular(values)
    glass = {
        "type": "ShaderNodeBsdfGlass",
        "properties": {"distribution": "GGX"},
        "inputs": {"Color": (1.0, 1.0, 1.0), "Roughness": values.roughness**0.5, "IOR": values.eta},
        "optional": {"Thin Film Thickness": 0.0, "Thin Film IOR": 1.33},
    }
    return _recipe({"Glass": glass}, surface=("Glass", "BSDF"))


def _principled_specular(values):
    """The Principled BSDF of Blender 3: black, with GGX facets whose Fresnel reflectance rises from `specular` * 0.08
    at normal incidence, scaled so that 0.08 * specular = ((eta - 1) / (eta + 1))^2 makes it that of a dielectric."""
    inputs = dict.fromkeys(
        ("Subsurface", "Subsurface Anisotropy", "Metallic", "Specular Tint", "Anisotropic", "Anisotropic Rotation",
         "Sheen", "Sheen Tint", "Clearcoat", "Clearcoat Roughness", "Transmission", "Transmission Roughness",
         "Emission Strength"), 0.0
    )
    black = (0.0, 0.0, 0.0)
    node = {
        "type": "ShaderNodeBsdfPrincipled",
        "properties": {"distribution": "GGX"},
        "inputs": {
            **inputs,
            "Base Color": black,
            "Subsurface Color": black,
            "Subsurface Radius": (1.0, 1.0, 1.0),
            "Subsurface IOR": 1.4,
            "Emission": black,
            "Alpha": 1.0,
            "IOR": values.eta,
            "Specular": ((values.eta - 1.0) / (values.eta + 1.0)) ** 2 / 0.08,
            "Roughness": values.roughness**0.5,
        },
        "optional": {},
    }
    return _recipe({"Principled": node}, surface=("Principled", "BSDF"))


def _subsurface(values, features):
    radius = tuple(inversion.radius_of_extinction(sigma_t, values.g) for sigma_t in values.sigma_t)
    low, high = limits.IOR_RANGE
    node = {
        "type": "ShaderNodeSubsurfaceScattering",
        "properties": {"falloff": features.subsurface_method},
        "inputs": {
            "Color": inversion.walk_colour(values),
            "Scale": 1.0,
            "Radius": radius,
            "IOR": min(max(values.eta, low), high),
            "Anisotropy": values.g,
        },
        # GGX's alpha itself, unlike the other nodes' roughness: measured.
        "optional": {"Roughness": values.roughness},
    }
    return _recipe({"Subsurface": node}, surface=("Subsurface", "BSSRDF"))


def _subsurface_burley(values, features):
    """Christensen and Burley's profile takes the diffuse reflectance itself as colour and 1 / sigma_t' as radius, and
    knows g by similarity alone ("Approximate Reflectance Profiles for Efficient Subsurface Scattering", Pixar 2015)."""
    reduced = tuple((a, (1.0 - values.g) * s) for a, s in zip(values.sigma_a, values.sigma_s))
    node = {
        "type": "ShaderNodeSubsurfaceScattering",
        "properties": {"falloff": "BURLEY"},
        "inputs": {
            "Color": inversion.profile_colour(values),
            "Scale": 1.0,
            "Radius": tuple(inversion.radius_of_extinction(a + s) for a, s in reduced),
        },
        # Of the walks; Blender 4 hides them from this one.
        "optional": {"IOR": 1.4, "Anisotropy": 0.0, "Roughness": 1.0},
    }
    return _recipe({"Subsurface": node}, surface=("Subsurface", "BSSRDF"))


def _emission():
    return {
        "type": "ShaderNodeEmission",
        "properties": {},
        "inputs": {"Color": (1.0, 1.0, 1.0), "Strength": 1.0},
        "optional": {},
    }


def _coverage(values, features):
    return _recipe({"Emission": _emission()}, surface=("Emission", "Emission"))


def _holdout(values, features):
    node = {"type": "ShaderNodeHoldout", "properties": {}, "inputs": {}, "optional": {}}
    return _recipe({"Holdout": node}, surface=("Holdout", "Holdout"))


def _vector_math(operation, *vectors):
    """Vectors by the number of their socket; those that are left out are linked or not used by the operation."""
    inputs = dict(zip((0, 1, 2), (*vectors, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))))
    properties = {"operation": operation}
    return {"type": "ShaderNodeVectorMath", "properties": properties, "inputs": inputs, "optional": {"Scale": 1.0}}


def _shown(nodes, links, vector):
    """A recipe that shows a unit vector v as the colour 0.5 + 0.5 v. vector: (node, socket)."""
    half = (0.5, 0.5, 0.5)
    made = _recipe(
        {**nodes, "Half": _vector_math("MULTIPLY_ADD", half, half, half), "Emission": _emission()},
        surface=("Emission", "Emission"),
    )
    made["links"] += [*links, [*vector, "Half", 0], ["Half", "Vector", "Emission", "Color"]]
    return made


_GEOMETRY = {"Geometry": {"type": "ShaderNodeNewGeometry", "properties": {}, "inputs": {}, "optional": {}}}


def _normal(values, features):
    return _shown(_GEOMETRY, [], ("Geometry", "Normal"))


def _mirrored(values, features):
    """REFLECT sends a vector on as light goes, so the way to the viewer comes out as its mirror image, reversed."""
    none = (0.0, 0.0, 0.0)
    nodes = {
        **_GEOMETRY,
        "Reflect": _vector_math("REFLECT", none, none),
        "Reverse": _vector_math("SCALE", none),
    }
    nodes["Reverse"]["optional"] = {"Scale": -1.0}
    links = [
        ["Geometry", "Incoming", "Reflect", 0],
        ["Geometry", "Normal", "Reflect", 1],
        ["Reflect", "Vector", "Reverse", 0],
    ]
    return _shown(nodes, links, ("Reverse", "Vector"))


_RECIPES = {
    "diffuse": _diffuse,
    "glossy": _glossy,
    "volume_index_matched": _volume_index_matched,
    "subsurface": _subsurface,
    "subsurface_burley": _subsurface_burley,
    "volume_dielectric": _volume_dielectric,
    "volume_lambert": _volume_lambert,
    "dielectric_specular": _dielectric_specular,
    "coverage": _coverage,
    "holdout": _holdout,
    "normal": _normal,
    "mirrored": _mirrored,
}
