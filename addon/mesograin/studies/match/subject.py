# A scene whose grains take coefficients to be tried, drawn again and again with the same random numbers.
"""See `Subject`."""

import math

import numpy

from ...cycles import kinds

COVERAGE_SAMPLES = 16


class SubjectError(Exception):
    """There is nothing that could be matched; one sentence."""


class Subject:
    """A native.Scene, some of whose drawn things are matched.

    instances, arrays: {number in the scene's list: factors of sigma_a and sigma_s, or None}, of what is matched.
    values: of native.Material, what they share; a function of the others as cycles.kinds.our_side has it. camera:
    native.Camera. size: (width, height). samples: of each pixel. name: of their material.
    Raises SubjectError if there is no grain to be matched.
    """

    def __init__(self, native, scene, instances, arrays, values, camera, size, samples, name=""):
        if not instances and not arrays:
            raise SubjectError("The scene has no grain whose coefficients could be matched: it needs a translucent"
                               " material, such as model_2.")
        self._native, self._scene = native, scene
        self._instances, self._arrays = instances, arrays
        self.values = {**values, "scale": 1.0}
        self._camera, self.size, self.samples, self.name = camera, size, samples, name
        self._view = native.View(*size)

    def picture(self, model, coefficients, samples=None):
        """(h, w, 4) float32, linear radiance and coverage, by this model and {'sigma_a', 'sigma_s', 'g'}, per unit of
        length of the scene. Raises native.Error."""
        values = {**self.values, **coefficients, "model": model}
        material = self._material(values)

        def of(factors):
            if not factors:
                return material
            changed = {name: tuple(numpy.multiply(values[name], factor)) for name, factor in factors.items()}
            return self._material({**values, **changed})

        scene = self._native.Scene(
            instances=[self._with(drawn, of(self._instances[number])) if number in self._instances else drawn
                       for number, drawn in enumerate(self._scene.instances)],
            arrays=[drawn.with_material(material) if number in self._arrays else drawn
                    for number, drawn in enumerate(self._scene.arrays)],
            lights=self._scene.lights, world=self._scene.world, exchange=self._scene.exchange,
            denoise=self._scene.denoise)
        return self._draw(scene, samples or self.samples)

    def covered(self):
        """(h, w) float32: how much of each pixel shows what is matched."""
        def shining(by):
            return self._native.Material(model="lambert", reflectance=(0.0,) * 3,
                                         finish=self._native.Finish(radiance=(float(by),) * 3))

        scene = self._native.Scene(
            instances=[self._with(drawn, shining(number in self._instances))
                       for number, drawn in enumerate(self._scene.instances)],
            arrays=[self._native.InstanceArray(drawn.mesh, shining(number in self._arrays), drawn.transforms)
                    for number, drawn in enumerate(self._scene.arrays)],
            exchange="off")
        return self._draw(scene, COVERAGE_SAMPLES)[..., 0]

    @property
    def lights_itself(self):
        """Whether what is matched are grains that send light to each other."""
        return bool(self._arrays) and self._scene.exchange != "off"

    @property
    def grain_size(self):
        """The radius of a ball of as much volume as the first of the matched grains, in the scene's unit."""
        number = min(self._instances, default=None)
        if number is not None:
            drawn = self._scene.instances[number]
            shape = drawn.mesh, drawn.transform
        else:
            drawn = self._scene.arrays[min(self._arrays)]
            shape = drawn.mesh, drawn.transforms[0]
        volume = self._native.shape_of(*shape)[0]
        if not volume > 0.0:
            raise SubjectError("The grain that is to be matched encloses nothing: it needs a mesh with a volume.")
        return (0.75 * volume / math.pi) ** (1.0 / 3.0)

    @property
    def warnings(self):
        """One sentence for each thing that the last picture did not draw by the model asked for."""
        return list(self._view.warnings)

    def _material(self, values):
        return self._native.Material(**kinds.of_material(values, values))

    def _with(self, drawn, material):
        return self._native.Instance(drawn.mesh, material, drawn.transform, drawn.object)

    def _draw(self, scene, samples):
        self._view.set_scene(scene)
        self._view.set_camera(self._camera)
        self._view.render(samples)
        return self._view.read()


def cut(native, camera, whole, kept):
    """The native.Camera that sees of a picture of `whole` pixels, (width, height), the upper left `kept`."""
    zoom = numpy.eye(4)
    for axis in (0, 1):
        zoom[axis, axis] = whole[axis] / kept[axis]
    # Clip space has the left at -1 and the top at 1: these edges stay.
    zoom[0, 3], zoom[1, 3] = zoom[0, 0] - 1.0, 1.0 - zoom[1, 1]
    return native.Camera(camera.world_to_camera, zoom @ camera.camera_to_clip)
