# The device's thread, held as by a program that is being compiled.
import numpy as np


def view(native, size):
    """A native.View of size x size pixels: one sample takes seconds without a GPU, and nothing can end it before."""
    square = native.Mesh([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], None, [[0, 1, 2], [0, 2, 3]])
    material = native.Material(model="model_3", sigma_s=(4.0, 4.0, 4.0), sigma_a=(0.1, 0.1, 0.1))
    slow = native.View(size, size)
    slow.set_scene(native.Scene(instances=[native.Instance(square, material, np.eye(4))],
                                lights=[native.DirectionalLight((0.0, 0.0, 1.0), (1.0, 1.0, 1.0))]))
    slow.set_camera(native.Camera.look_at((0.0, 0.0, 1.5), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0), 40.0))
    slow.set_taps(1 << 16)
    return slow
