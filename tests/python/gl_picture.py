"""A fragment shader's picture, by EGL and OpenGL themselves: what a program that is not ours makes of a shader."""

import ctypes
import ctypes.util

import numpy

SURFACELESS, OPENGL_API = 0x31DD, 0x30A2
CONTEXT = (0x3098, 4, 0x30FB, 5, 0x30FD, 1, 0x3038)  # 4.5, core
VERTEX, FRAGMENT, COMPILED, LINKED = 0x8B31, 0x8B30, 0x8B81, 0x8B82
TEXTURE_2D, RGBA32F, RGB, RGBA, FLOAT, LINEAR, CLAMP = 0x0DE1, 0x8814, 0x1907, 0x1908, 0x1406, 0x2601, 0x812F
SETTINGS = ((0x2800, LINEAR), (0x2801, LINEAR), (0x2802, CLAMP), (0x2803, CLAMP))
FRAMEBUFFER, COLOUR, COMPLETE, TRIANGLES = 0x8D40, 0x8CE0, 0x8CD5, 0x0004

CORNERS = """#version 450
out vec2 uv;
void main() {
  uv = vec2((gl_VertexID << 1) & 2, gl_VertexID & 2);
  gl_Position = vec4(2.0 * uv - 1.0, 0.0, 1.0);
}
"""


class _GL:
    """OpenGL's functions by name, in a context that ends with it."""

    def __init__(self):
        self._egl = ctypes.CDLL(ctypes.util.find_library("EGL") or "libEGL.so.1")
        for name in ("eglGetPlatformDisplay", "eglCreateContext", "eglGetProcAddress"):
            getattr(self._egl, name).restype = ctypes.c_void_p
        self._display = ctypes.c_void_p(self._egl.eglGetPlatformDisplay(SURFACELESS, None, None))
        assert self._egl.eglInitialize(self._display, None, None), "EGL without a surface is not there"
        self._egl.eglBindAPI(OPENGL_API)
        wanted = (ctypes.c_int * len(CONTEXT))(*CONTEXT)
        self._context = ctypes.c_void_p(self._egl.eglCreateContext(self._display, None, None, wanted))
        assert self._egl.eglMakeCurrent(self._display, None, None, self._context)

    def __getattr__(self, name):
        address = self._egl.eglGetProcAddress(f"gl{name}".encode())
        return ctypes.CFUNCTYPE(ctypes.c_int)(address)

    def end(self):
        self._egl.eglMakeCurrent(self._display, None, None, None)
        self._egl.eglDestroyContext(self._display, self._context)

    def new(self, kind):
        number = ctypes.c_uint()
        getattr(self, f"Gen{kind}")(1, ctypes.byref(number))
        return number

    def texture(self, width, height, layout, pixels):
        made = self.new("Textures")
        self.BindTexture(TEXTURE_2D, made)
        self.TexImage2D(TEXTURE_2D, 0, RGBA32F, width, height, 0, layout, FLOAT,
                        None if pixels is None else pixels.ctypes.data_as(ctypes.c_void_p))
        for name, value in SETTINGS:
            self.TexParameteri(TEXTURE_2D, name, value)
        return made

    def program(self, fragment):
        program = self.CreateProgram()
        for kind, text in ((VERTEX, CORNERS), (FRAGMENT, "#version 450\n" + fragment)):
            shader = self.CreateShader(kind)
            source = ctypes.c_char_p(text.encode())
            self.ShaderSource(shader, 1, ctypes.byref(source), None)
            self.CompileShader(shader)
            self._require(shader, COMPILED, "Shader")
            self.AttachShader(program, shader)
        self.LinkProgram(program)
        self._require(program, LINKED, "Program")
        return program

    def _require(self, thing, what, kind):
        done = ctypes.c_int()
        getattr(self, f"Get{kind}iv")(thing, what, ctypes.byref(done))
        log = ctypes.create_string_buffer(4096)
        getattr(self, f"Get{kind}InfoLog")(thing, 4096, None, log)
        assert done.value, log.value.decode()


def draw(fragment, textures, size):
    """(h, w, 4) float32, row 0 at the top, of a shader that is given `uv`, (0, 0) at the lower left. textures:
    {sampler: (h, w, 3), row 0 at the top}."""
    gl = _GL()
    try:
        width, height = size
        program = gl.program(fragment)
        gl.UseProgram(program)
        target = gl.texture(width, height, RGBA, None)
        gl.BindFramebuffer(FRAMEBUFFER, gl.new("Framebuffers"))
        gl.FramebufferTexture2D(FRAMEBUFFER, COLOUR, TEXTURE_2D, target, 0)
        assert gl.CheckFramebufferStatus(FRAMEBUFFER) == COMPLETE
        for unit, (name, pixels) in enumerate(textures.items()):
            gl.ActiveTexture(0x84C0 + unit)
            upwards = numpy.ascontiguousarray(pixels[::-1], dtype=numpy.float32)
            gl.texture(upwards.shape[1], upwards.shape[0], RGB, upwards)
            gl.Uniform1i(gl.GetUniformLocation(program, name.encode()), unit)
        gl.BindVertexArray(gl.new("VertexArrays"))
        gl.Viewport(0, 0, width, height)
        gl.DrawArrays(TRIANGLES, 0, 3)
        pixels = numpy.empty((height, width, 4), numpy.float32)
        gl.ReadPixels(0, 0, width, height, RGBA, FLOAT, pixels.ctypes.data_as(ctypes.c_void_p))
        return pixels[::-1]
    finally:
        gl.end()
