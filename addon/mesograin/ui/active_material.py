# The material that an operator of the material's tab changes.


def active_material(context):
    """The one whose tab is shown, which may be pinned; else the active object's; else None."""
    return getattr(context, "material", None) or (context.object and context.object.active_material)


def is_own(operator, datablock):
    """Whether a datablock belongs to this file; else what is changed of it would be gone when the file is opened, and
    the operator's tooltip says so."""
    if datablock.library is not None:
        operator.poll_message_set(f"'{datablock.name}' is linked: make it local, or override it")
    return datablock.library is None


class OnActiveMaterial:
    """An operator that there must be a material for, which it may change."""

    @classmethod
    def poll(cls, context):
        material = active_material(context)
        return context.object is not None and material is not None and is_own(cls, material)
