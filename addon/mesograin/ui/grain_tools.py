# Add > Grain: a single grain, or a pile of them.
import bpy
import numpy as np
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty
from bpy_extras.object_utils import AddObjectHelper, object_data_add
from mathutils import Vector

from .. import native_module
from ..grains import kinds, objects, pile

KIND_ITEMS = tuple((kind, kind.replace("_", " ").title(), make.__doc__.split(".")[0].replace("\n   ", ""), number)
                   for number, (kind, make) in enumerate(kinds.KINDS.items()))
# Fewer grains than this are there within a blink.
AT_ONCE = 500


class _Habit:
    """What tells grains of one kind apart."""

    kind: EnumProperty(name="Kind", items=KIND_ITEMS, description="What the grain is")
    seed: IntProperty(name="Seed", min=0, description="Another seed is another grain of the same kind")
    segments: IntProperty(name="Segments", default=16, min=4, soft_max=64, max=256,
                          description="Divisions along each of the six charts of the surface")
    angularity: FloatProperty(name="Angularity", default=0.5, min=0.0, max=1.0, subtype="FACTOR",
                              description="How far the shape is from a plain one: cuts of sand, arms of snow")
    roundness: FloatProperty(name="Roundness", default=0.3, min=0.0, max=1.0, subtype="FACTOR",
                             description="How worn edges and corners are")

    def habit(self):
        return {name: getattr(self, name) for name in ("seed", "segments", "angularity", "roundness")}


class MESOGRAIN_OT_add_grain(bpy.types.Operator, _Habit, AddObjectHelper):
    bl_idname = "mesograin.add_grain"
    bl_label = "Grain"
    bl_description = "Add a grain: a closed mesh with UVs that bake well, and a material"
    bl_options = {"REGISTER", "UNDO"}

    size: FloatProperty(name="Size", default=1.0, min=1e-6, subtype="DISTANCE",
                        description="Radius of a ball as large as the grain")

    def execute(self, context):
        _leave_edit_mode(context)
        made = objects.mesh(self.kind, size=self.size, **self.habit())
        made.materials.append(objects.material(self.kind))
        object_data_add(context, made, operator=self)
        return {"FINISHED"}


class MESOGRAIN_OT_add_pile(bpy.types.Operator, _Habit):
    bl_idname = "mesograin.add_pile"
    bl_label = "Pile of Grains"
    bl_description = "Add grains that have fallen and come to rest on each other, as instances of a few shapes"
    bl_options = {"REGISTER", "UNDO"}

    count: IntProperty(name="Grains", default=1000, min=1, soft_max=20000, max=1000000,
                       description="How many grains fall; ten thousand take some seconds, beside Blender")
    shapes: IntProperty(name="Shapes", default=3, min=1, max=32,
                        description="How many grains are modelled; all others are instances")
    size: FloatProperty(name="Size", default=0.05, min=1e-6, subtype="DISTANCE",
                        description="Radius of a ball as large as the mean grain")
    variation: FloatProperty(name="Variation", default=0.2, min=0.0, max=0.9, subtype="FACTOR",
                             description="How far sizes differ from the mean one")
    friction: FloatProperty(name="Friction", default=0.6, min=0.0, max=2.0,
                            description="Between grains and on the ground; the more, the steeper the heap")
    place: EnumProperty(name="Place", items=(
        ("HEAP", "Heap", "On the plane of the 3D cursor, as far as it runs out", 0),
        ("BOX", "Box", "Between upright walls around the 3D cursor", 1),
        ("ACTIVE", "On Active Object", "On the surface of the active mesh, or in it from above: a bowl, a jar", 2),
        ("INSIDE", "Inside Active Object",
         "In the room that the active mesh encloses, as many as fit: a box, a bottle, a body filled with grains", 3)))
    box: FloatProperty(name="Box", default=1.0, min=1e-5, subtype="DISTANCE", description="How far the walls are apart")
    settle_walls: BoolProperty(name="Walls", default=True,
                               description="Grains do not fall over the edge of the active object")

    def draw(self, _context):
        layout = self.layout
        layout.use_property_split = True
        for name in ("kind", "count", "shapes", "size", "variation", "place"):
            layout.prop(self, name)
        if self.place == "BOX":
            layout.prop(self, "box")
        elif self.place == "ACTIVE":
            layout.prop(self, "settle_walls")
        for name in ("friction", "seed", "segments", "angularity", "roundness"):
            layout.prop(self, name)

    def invoke(self, context, _event):
        """A large pile settles beside Blender."""
        if self.count < AT_ONCE:
            return self.execute(context)
        _leave_edit_mode(context)
        try:
            _, settling = self._settling(context)
            self._work = pile.Settling(pile.shapes_of([self.kind] * self.shapes, **self.habit()), self.count, self.size,
                                       self.variation, self.seed, self.friction, **settling)
        except _sentences() as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        manager = context.window_manager
        self._timer = manager.event_timer_add(0.1, window=context.window)
        manager.progress_begin(0, 100)
        manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type == "ESC":
            self._work.cancel()
            self._leave(context)
            self.report({"INFO"}, "The pile was cancelled.")
            return {"CANCELLED"}
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        if not self._work.done:
            percent = 100.0 * self._work.share
            context.window_manager.progress_update(percent)
            context.workspace.status_text_set(f"{self.count} grains are falling, {percent:.0f} %. Esc cancels.")
            return {"PASS_THROUGH"}
        self._leave(context)
        try:
            self._work.result()
        except _sentences() as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return self.execute(context)

    def _leave(self, context):
        context.window_manager.event_timer_remove(self._timer)
        context.window_manager.progress_end()
        context.workspace.status_text_set(None)

    def execute(self, context):
        _leave_edit_mode(context)
        try:
            place, settling = self._settling(context)
            made = objects.pile_of([self.kind] * self.shapes, self.count, self.size, variation=self.variation,
                                   friction=self.friction, **self.habit(), **settling)
        except _sentences() as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        came = len(made.data.vertices)
        if came < self.count:
            self.report({"WARNING"}, f"{came} of {self.count} grains fit inside the active mesh: "
                        "smaller grains or a larger mesh hold more.")
        made.location = place
        context.collection.objects.link(made)
        for other in context.selected_objects:
            other.select_set(False)
        context.view_layer.objects.active = made
        made.select_set(True)
        return {"FINISHED"}

    def _settling(self, context):
        """(the pile's place, what pile.settle takes of it)."""
        cursor = context.scene.cursor.location.copy()
        if self.place == "HEAP":
            return cursor, {}
        if self.place == "BOX":
            return cursor, {"walls": (self.box, self.box)}
        place, span, surface = _surface(context)
        if self.place == "INSIDE":
            return place, {"surface": surface, "inside": True}
        return place, {"walls": span if self.settle_walls else None, "surface": surface}


class _NoSurface(Exception):
    """One sentence."""


def _sentences():
    """What can go wrong and says so itself."""
    errors = (_NoSurface, native_module.Unavailable)
    try:
        return (*errors, native_module.get().Error)
    except native_module.Unavailable:
        return errors


def _surface(context):
    """(the middle below the active mesh, how wide it is along x and y, a pile.Surface of its triangles)."""
    active = context.active_object
    if active is None or active.type != "MESH":
        raise _NoSurface("There is no active mesh that grains could fall on: select one, or choose Heap or Box.")
    evaluated = active.evaluated_get(context.evaluated_depsgraph_get())
    data = evaluated.to_mesh()
    data.calc_loop_triangles()
    vertices = np.empty(3 * len(data.vertices), dtype=np.float32)
    data.vertices.foreach_get("co", vertices)
    triangles = np.empty(3 * len(data.loop_triangles), dtype=np.int32)
    data.loop_triangles.foreach_get("vertices", triangles)
    evaluated.to_mesh_clear()
    to_world = np.array(active.matrix_world, dtype=np.float64)
    vertices = vertices.reshape(-1, 3) @ to_world[:3, :3].T + to_world[:3, 3]
    triangles = triangles.reshape(-1, 3).astype(np.uint32)
    used = vertices[triangles.ravel()] if len(triangles) else np.zeros((1, 3))
    lower, upper = used.min(axis=0), used.max(axis=0)
    span = (upper - lower)[:2]
    if not span.min() > 0.0:
        raise _NoSurface(f"Object '{active.name}' has no surface that grains could fall on from above.")
    place = np.append(0.5 * (lower + upper)[:2], 0.0)
    return Vector(place), tuple(map(float, span)), pile.Surface(vertices - place, triangles)


def _leave_edit_mode(context):
    if context.mode != "OBJECT" and context.active_object is not None:
        bpy.ops.object.mode_set(mode="OBJECT")


class MESOGRAIN_MT_add(bpy.types.Menu):
    bl_idname = "MESOGRAIN_MT_add"
    bl_label = "Grain"

    def draw(self, _context):
        layout = self.layout
        layout.operator_context = "EXEC_REGION_WIN"
        for kind, name, _description, _number in KIND_ITEMS:
            layout.operator(MESOGRAIN_OT_add_grain.bl_idname, text=name).kind = kind
        layout.separator()
        layout.operator_context = "INVOKE_REGION_WIN"
        layout.operator(MESOGRAIN_OT_add_pile.bl_idname, text="Pile", icon="PARTICLES")


def _draw_menu(self, _context):
    self.layout.menu(MESOGRAIN_MT_add.bl_idname, icon="META_BALL")


_register, _unregister = bpy.utils.register_classes_factory(
    (MESOGRAIN_OT_add_grain, MESOGRAIN_OT_add_pile, MESOGRAIN_MT_add))


def register():
    _register()
    bpy.types.VIEW3D_MT_add.append(_draw_menu)


def unregister():
    bpy.types.VIEW3D_MT_add.remove(_draw_menu)
    _unregister()
