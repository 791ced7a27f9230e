# The material that an operator of the material's tab changes.


def active_material(context):
    """The one whose tab is shown, which may be pinned; else the active object's; else None."""
    return getattr(context, "material", None) or (context.object and context.object.active_material)


class OnActiveMaterial:
    """An operator that there must be a material for."""

    @classmethod
    def poll(cls, context):
        return context.object is not None and active_material(context) is not None
