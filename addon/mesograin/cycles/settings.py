# Every Cycles setting that a reference depends on, as plain data, and the one place that applies it.
"""Nothing is left to a file or to a Blender's defaults: no denoiser, no clamp, a box filter of one pixel."""


def settings(kind, samples, seed, size, pixel_aspect=(1.0, 1.0)):
    """{owner: {property: value}} for a staged scene. kind: kinds.Kind. size: (width, height) in pixels."""
    return {
        "cycles": {
            "device": "CPU",
            "feature_set": "SUPPORTED",
            "shading_system": False,
            "samples": samples,
            "seed": seed,
            "use_animated_seed": False,
            "sample_offset": 0,
            "time_limit": 0.0,
            "use_adaptive_sampling": False,
            "use_denoising": False,
            "use_guiding": False,
            "sampling_pattern": ("TABULATED_SOBOL", "PROGRESSIVE_MULTI_JITTER"),
            "scrambling_distance": 1.0,
            "auto_scrambling_distance": False,
            "use_layer_samples": "IGNORE",
            "light_sampling_threshold": 0.0,
            "direct_light_sampling_type": "MULTIPLE_IMPORTANCE_SAMPLING",
            "use_light_tree": False,
            "max_bounces": kind.longest_path,
            "diffuse_bounces": kind.bounces,
            "glossy_bounces": kind.longest_path,
            "transmission_bounces": kind.bounces,
            "volume_bounces": kind.bounces,
            "transparent_max_bounces": 1024,
            "min_light_bounces": 0,
            "min_transparent_bounces": 0,
            "caustics_reflective": True,
            "caustics_refractive": True,
            "blur_glossy": 0.0,
            "sample_clamp_direct": 0.0,
            "sample_clamp_indirect": 0.0,
            "use_fast_gi": False,
            "volume_max_steps": 1024,
            "film_exposure": 1.0,
            "film_transparent_glass": False,
            "pixel_filter_type": "BOX",
            "filter_width": 1.0,
            "use_camera_cull": False,
            "use_distance_cull": False,
            "texture_limit_render": "OFF",
            "use_auto_tile": False,
        },
        "render": {
            "engine": "CYCLES",
            "resolution_x": size[0],
            "resolution_y": size[1],
            "resolution_percentage": 100,
            "pixel_aspect_x": pixel_aspect[0],
            "pixel_aspect_y": pixel_aspect[1],
            "film_transparent": True,
            "use_border": False,
            "use_crop_to_border": False,
            "use_motion_blur": False,
            "use_simplify": False,
            "use_freestyle": False,
            "use_compositing": False,
            "use_sequencer": False,
            "use_multiview": False,
            "use_persistent_data": False,
            "dither_intensity": 0.0,
            "use_file_extension": True,
            "use_overwrite": True,
            "use_placeholder": False,
            "use_stamp": False,
        },
        "image_settings": {
            "file_format": "OPEN_EXR",
            "color_mode": "RGBA",
            "color_depth": "32",
            "exr_codec": "ZIP",
        },
        "view_settings": {
            "view_transform": "Raw",
            "look": "None",
            "exposure": 0.0,
            "gamma": 1.0,
            "use_curve_mapping": False,
        },
    }


def apply(scene, description):
    """Sets them on a scene; what this Blender lacks is passed over, a tuple is a choice in order of preference."""
    owners = {
        "cycles": scene.cycles,
        "render": scene.render,
        "image_settings": scene.render.image_settings,
        "view_settings": scene.view_settings,
    }
    for owner_name, properties in description.items():
        owner = owners[owner_name]
        for name, value in properties.items():
            if not hasattr(owner, name):
                continue
            if isinstance(value, tuple):
                _set_first(owner, name, value)
            else:
                setattr(owner, name, value)


def _set_first(owner, name, choices):
    """The first choice that this Blender knows; the items of some of its enums can only be found out by trying."""
    for choice in choices:
        try:
            setattr(owner, name, choice)
            return
        except TypeError:
            continue
    raise ValueError(f"{name} can be set to none of {', '.join(choices)}.")
