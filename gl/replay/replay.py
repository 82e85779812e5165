#!/usr/bin/env python3
"""Draws the frame that `trueshade glsl SCENE --api gl|gl33|es31 -o FOLDER` wrote, by EGL and OpenGL, from the files
alone (docs/opengl.md), and writes what was drawn as a capture for `trueshade validate --gbuffer`.

usage: replay.py FOLDER CAPTURE.exr       (exit code 7: no driver gives a context)
"""
import ctypes
import json
import pathlib
import re
import sys

from capture import channel_values, run, write_exr

# Values of the Khronos registry (gl.xml).
CONSTANTS = dict(
    GL_FALSE=0, GL_TRUE=1, GL_ZERO=0, GL_ONE=1, GL_TRIANGLES=4, GL_TRIANGLE_STRIP=5, GL_NEVER=0x200, GL_LESS=0x201,
    GL_EQUAL=0x202, GL_LEQUAL=0x203, GL_GREATER=0x204, GL_NOTEQUAL=0x205, GL_GEQUAL=0x206, GL_ALWAYS=0x207,
    GL_SRC_COLOR=0x300, GL_ONE_MINUS_SRC_COLOR=0x301, GL_SRC_ALPHA=0x302, GL_ONE_MINUS_SRC_ALPHA=0x303,
    GL_DST_ALPHA=0x304, GL_ONE_MINUS_DST_ALPHA=0x305, GL_DST_COLOR=0x306, GL_ONE_MINUS_DST_COLOR=0x307,
    GL_SRC_ALPHA_SATURATE=0x308, GL_FRONT=0x404, GL_BACK=0x405, GL_FRONT_AND_BACK=0x408, GL_CW=0x900, GL_CCW=0x901,
    GL_CULL_FACE=0xB44, GL_DEPTH_TEST=0xB71, GL_STENCIL_TEST=0xB90, GL_DITHER=0xBD0, GL_BLEND=0xBE2,
    GL_SCISSOR_TEST=0xC11, GL_TEXTURE_BORDER_COLOR=0x1004, GL_FILL=0x1B02, GL_NEAREST=0x2600, GL_LINEAR=0x2601,
    GL_NEAREST_MIPMAP_NEAREST=0x2700, GL_LINEAR_MIPMAP_NEAREST=0x2701, GL_NEAREST_MIPMAP_LINEAR=0x2702,
    GL_LINEAR_MIPMAP_LINEAR=0x2703, GL_REPEAT=0x2901, GL_CONSTANT_COLOR=0x8001, GL_ONE_MINUS_CONSTANT_COLOR=0x8002,
    GL_CONSTANT_ALPHA=0x8003, GL_ONE_MINUS_CONSTANT_ALPHA=0x8004, GL_FUNC_ADD=0x8006, GL_MIN=0x8007, GL_MAX=0x8008,
    GL_FUNC_SUBTRACT=0x800A, GL_FUNC_REVERSE_SUBTRACT=0x800B, GL_POLYGON_OFFSET_FILL=0x8037, GL_MULTISAMPLE=0x809D,
    GL_CLAMP_TO_BORDER=0x812D, GL_CLAMP_TO_EDGE=0x812F, GL_MIRRORED_REPEAT=0x8370, GL_MIRROR_CLAMP_TO_EDGE=0x8743,
    GL_DEPTH_CLAMP=0x864F, GL_LOWER_LEFT=0x8CA1, GL_UPPER_LEFT=0x8CA2, GL_PRIMITIVE_RESTART_FIXED_INDEX=0x8D69,
    GL_FRAMEBUFFER_SRGB=0x8DB9, GL_FIRST_VERTEX_CONVENTION=0x8E4D, GL_LAST_VERTEX_CONVENTION=0x8E4E,
    GL_PRIMITIVE_RESTART=0x8F9D, GL_NEGATIVE_ONE_TO_ONE=0x935E, GL_ZERO_TO_ONE=0x935F)
BYTE, SHORT, UINT, FLOAT, HALF, PACKED_10 = 0x1401, 0x1403, 0x1405, 0x1406, 0x140B, 0x8368
RGBA, RGB, RED_INTEGER, DEPTH = 0x1908, 0x1907, 0x8D94, 0x1902
# Of a format: its number, what glTexImage2D takes, and how it is read back: as which type, a texel's bytes, and what
# channel_values() calls that.
FORMATS = dict(
    GL_RGBA8=(0x8058, RGBA, BYTE, BYTE, 4, "8"), GL_SRGB8_ALPHA8=(0x8C43, RGBA, BYTE, BYTE, 4, "srgb8"),
    GL_RGB10_A2=(0x8059, RGBA, PACKED_10, PACKED_10, 4, "10"), GL_RGBA16=(0x805B, RGBA, SHORT, SHORT, 8, "16"),
    GL_R11F_G11F_B10F=(0x8C3A, RGB, FLOAT, FLOAT, 16, "float"), GL_RGBA16F=(0x881A, RGBA, HALF, FLOAT, 16, "float"),
    GL_RGBA32F=(0x8814, RGBA, FLOAT, FLOAT, 16, "float"), GL_RGB32F=(0x8815, RGB, FLOAT, FLOAT, 16, "float"),
    GL_RG32F=(0x8230, 0x8227, FLOAT, FLOAT, 16, "float"), GL_RGB16F=(0x881B, RGB, HALF, FLOAT, 16, "float"),
    GL_R32UI=(0x8236, RED_INTEGER, UINT, UINT, 4, "uint"),
    GL_DEPTH_COMPONENT32F=(0x8CAC, DEPTH, FLOAT, FLOAT, 4, "depth"),
    GL_DEPTH_COMPONENT24=(0x81A6, DEPTH, UINT, FLOAT, 4, "depth"),
    GL_DEPTH_COMPONENT16=(0x81A5, DEPTH, SHORT, FLOAT, 4, "depth"))
C_TYPES = dict(i=ctypes.c_int, f=ctypes.c_float, d=ctypes.c_double, p=ctypes.c_void_p)
# Arguments that are not all integers.
SIGNATURES = dict(
    glDepthRange="dd", glDepthRangef="ff", glBlendColor="ffff", glPolygonOffset="ff", glBufferData="ippi",
    glTexImage2D="iiiiiiiip", glTexParameterf="iif", glTexParameterfv="iip", glUniform1f="if", glUniform1fv="iip",
    glUniform2fv="iip", glUniform3fv="iip", glUniform4fv="iip", glUniformMatrix4fv="iiip", glShaderSource="iipp",
    glGetShaderiv="iip", glGetProgramiv="iip", glGetShaderInfoLog="iipp", glGetProgramInfoLog="iipp",
    glGetUniformLocation="ip", glVertexAttribPointer="iiiiip", glVertexAttribIPointer="iiiip",
    glDrawElementsInstanced="iiipi", glClearBufferfv="iip", glClearBufferuiv="iip", glReadPixels="iiiiiip",
    glDrawBuffers="ip", glGenTextures="ip", glGenBuffers="ip", glGenFramebuffers="ip", glGenVertexArrays="ip")


class Driver:
    """A context without a window; its functions are attributes."""

    def __init__(self, api):
        egl = ctypes.CDLL("libEGL.so.1")
        for name in ("eglGetProcAddress", "eglGetPlatformDisplay", "eglCreateContext"):
            getattr(egl, name).restype = ctypes.c_void_p
        display = ctypes.c_void_p(egl.eglGetPlatformDisplay(0x31DD, None, None))  # EGL_PLATFORM_SURFACELESS_MESA
        if not display.value or not egl.eglInitialize(display, None, None):
            raise OSError("no EGL display without a window")
        es = api == "es31"
        egl.eglBindAPI(0x30A0 if es else 0x30A2)
        major, minor = {"gl": (4, 5), "gl33": (3, 3), "es31": (3, 1)}[api]
        wanted = [0x3098, major, 0x30FB, minor] + ([] if es else [0x30FD, 1]) + [0x3038]  # a core profile
        context = ctypes.c_void_p(egl.eglCreateContext(display, None, None, (ctypes.c_int * len(wanted))(*wanted)))
        if not context.value or not egl.eglMakeCurrent(display, None, None, context):
            raise OSError(f"no context of {api}")
        self.egl, self.found = egl, {}

    def __getattr__(self, name):
        def call(*arguments):
            types = SIGNATURES.get(name, "i" * len(arguments))
            if name not in self.found:
                address = self.egl.eglGetProcAddress(name.encode())
                self.found[name] = ctypes.CFUNCTYPE(ctypes.c_int, *(C_TYPES[t] for t in types))(address)
            return self.found[name](*arguments)
        return call

    def new(self, kind):
        name = ctypes.c_uint()
        getattr(self, "glGen" + kind)(1, ctypes.addressof(name))
        return name.value

    def run(self, line):
        """Calls as they are written in C."""
        for name, arguments in re.findall(r"(\w+)\(([^)]*)\)", line):
            floating = SIGNATURES.get(name, "i")[0] in "fd"
            words = [word.strip() for word in arguments.split(",")]
            getattr(self, name)(*(CONSTANTS[w] if w in CONSTANTS else float(w) if floating else int(w) for w in words))


class Replay:
    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.frame = json.loads((self.folder / "state.json").read_text())
        self.data = (self.folder / self.frame["file"]).read_bytes()
        self.gl = Driver(self.frame["api"])
        self.pictures = {p["name"]: p for p in self.frame["pictures"]}
        self.textures = {name: self.new_texture(p["format"], [(p["size"], None)], {})
                         for name, p in self.pictures.items()}
        for name, t in self.frame["textures"].items():
            levels = [(level["size"], self.bytes_of(level)) for level in t["levels"]]
            self.textures[name] = self.new_texture(t["format"], levels, t["sampler"])
        self.buffers, self.texels, self.programs = {}, set(), {}
        for name, b in self.frame["buffers"].items():
            self.add_buffer(name, b)

    def bytes_of(self, block):
        return self.data[block["offset"]:block["offset"] + block["bytes"]]

    def new_texture(self, name, levels, sampler):
        gl, (internal, external, kind, *_) = self.gl, FORMATS[name]
        texture = gl.new("Textures")
        gl.glBindTexture(0x0DE1, texture)
        for k, ((width, height), texels) in enumerate(levels):
            gl.glTexImage2D(0x0DE1, k, internal, width, height, 0, external, kind, texels)
        gl.glTexParameteri(0x0DE1, 0x813D, len(levels) - 1)  # GL_TEXTURE_MAX_LEVEL
        wrap = sampler.get("wrap", ["GL_CLAMP_TO_EDGE"] * 2)
        for what, value in ((0x2802, wrap[0]), (0x2803, wrap[1]), (0x2800, sampler.get("mag_filter", "GL_NEAREST")),
                            (0x2801, sampler.get("min_filter", "GL_NEAREST"))):
            gl.glTexParameteri(0x0DE1, what, CONSTANTS[value])
        for what, key in ((0x8501, "lod_bias"), (0x813A, "lod_min"), (0x813B, "lod_max")):
            if key in sampler and (key != "lod_bias" or sampler[key] != 0):
                gl.glTexParameterf(0x0DE1, what, sampler[key])
        if "GL_CLAMP_TO_BORDER" in wrap:
            gl.glTexParameterfv(0x0DE1, 0x1004, (ctypes.c_float * 4)(*sampler["border"]))
        return texture

    def add_buffer(self, name, b):
        """Vertices and indices are buffers; texels are a texture of rows in ES, and a buffer texture elsewhere."""
        gl = self.gl
        if "size" in b:
            self.textures[name] = self.new_texture("GL_RGBA32F", [(b["size"], self.bytes_of(b))], {})
            return
        target = 0x8C2A if "texels" in b else 0x8892
        self.buffers[name] = gl.new("Buffers")
        gl.glBindBuffer(target, self.buffers[name])
        gl.glBufferData(target, b["bytes"], self.bytes_of(b), 0x88E4)
        if "texels" in b:
            self.textures[name] = gl.new("Textures")
            self.texels.add(name)
            gl.glBindTexture(0x8C2A, self.textures[name])
            gl.glTexBuffer(0x8C2A, FORMATS["GL_RGBA32F"][0], self.buffers[name])

    def program(self, shaders):
        if tuple(shaders) not in self.programs:
            self.programs[tuple(shaders)] = self.linked(shaders)
        return self.programs[tuple(shaders)]

    def linked(self, shaders):
        gl, program = self.gl, self.gl.glCreateProgram()
        status, log = ctypes.c_int(), ctypes.create_string_buffer(4096)
        for name, stage in zip(shaders, (0x8B31, 0x8B30)):
            shader = gl.glCreateShader(stage)
            text = ctypes.c_char_p((self.folder / name).read_bytes())
            gl.glShaderSource(shader, 1, ctypes.addressof(text), None)
            gl.glCompileShader(shader)
            gl.glGetShaderiv(shader, 0x8B81, ctypes.addressof(status))
            gl.glGetShaderInfoLog(shader, 4096, None, log)
            if not status.value:
                raise RuntimeError(f"{name}: {log.value.decode()}")
            gl.glAttachShader(program, shader)
        gl.glLinkProgram(program)
        gl.glGetProgramiv(program, 0x8B82, ctypes.addressof(status))
        if not status.value:
            raise RuntimeError(f"{shaders} do not link")
        return program

    def bind_target(self, colors, depth):
        gl, framebuffer = self.gl, self.gl.new("Framebuffers")
        gl.glBindFramebuffer(0x8D40, framebuffer)
        for i, name in enumerate(colors):
            gl.glFramebufferTexture2D(0x8D40, 0x8CE0 + i, 0x0DE1, self.textures[name], 0)
        if depth:
            gl.glFramebufferTexture2D(0x8D40, 0x8D00, 0x0DE1, self.textures[depth], 0)
        buffers = [0x8CE0 + i for i in range(len(colors))] or [0]
        gl.glDrawBuffers(len(buffers), (ctypes.c_uint * len(buffers))(*buffers))
        if gl.glCheckFramebufferStatus(0x8D40) != 0x8CD5:
            raise RuntimeError(f"the driver cannot draw into {colors} with {depth}")

    def clear(self, draw_pass):
        """Each picture to its value: integers as such. Masks are part of a pass's state, and hold for clears too."""
        gl = self.gl
        self.gl.run("glDisable(GL_SCISSOR_TEST); glDepthMask(GL_TRUE); glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE)")
        for name in draw_pass["clears"]:
            value = self.pictures[name]["clear"]
            if name == draw_pass["depth"]:
                gl.glClearBufferfv(0x1801, 0, (ctypes.c_float * 1)(value[0]))
            elif self.pictures[name]["format"] == "GL_R32UI":
                gl.glClearBufferuiv(0x1800, draw_pass["colors"].index(name), (ctypes.c_uint * 4)(*map(int, value)))
            else:
                gl.glClearBufferfv(0x1800, draw_pass["colors"].index(name), (ctypes.c_float * 4)(*value))

    def set_uniform(self, program, name, kind, value):
        gl, location = self.gl, self.gl.glGetUniformLocation(program, name.encode())
        numbers = [float(v) for v in value]
        floats = (ctypes.c_float * len(numbers))(*numbers)
        if kind in ("int", "bool"):
            gl.glUniform1i(location, int(value[0]))
        elif kind == "mat4":
            gl.glUniformMatrix4fv(location, 1, 0, floats)
        else:
            size, _, count = kind.replace("vec", "").replace("float", "1").partition("[")
            getattr(gl, f"glUniform{size}fv")(location, int(count.rstrip("]") or 1), floats)

    def set_sampler(self, program, unit, name, source):
        self.gl.glActiveTexture(0x84C0 + unit)
        self.gl.glBindTexture(0x8C2A if source in self.texels else 0x0DE1, self.textures[source])
        self.gl.glUniform1i(self.gl.glGetUniformLocation(program, name.encode()), unit)

    def point_attributes(self, draw_pass, draw):
        gl = self.gl
        for a in draw_pass["attributes"]:
            buffer, first = draw[a["of"]]
            gl.glBindBuffer(0x8892, self.buffers[buffer])
            gl.glEnableVertexAttribArray(a["location"])
            if a["type"] == "uint":
                gl.glVertexAttribIPointer(a["location"], a["components"], UINT, a["stride"], first + a["offset"])
            else:
                gl.glVertexAttribPointer(a["location"], a["components"], FLOAT, 0, a["stride"], first + a["offset"])
            gl.glVertexAttribDivisor(a["location"], 1 if a["of"] == "instances" else 0)

    def draw_pass(self, p):
        gl = self.gl
        self.bind_target(p["colors"], p["depth"])
        self.clear(p)
        for line in p["state"]:
            gl.run(line)
        program = self.program(p["shaders"])
        gl.glUseProgram(program)
        gl.glBindVertexArray(gl.new("VertexArrays"))
        units = {name: unit for unit, name in enumerate(p["samplers"])}
        mode = CONSTANTS["GL_TRIANGLE_STRIP" if p["topology"] == "triangle_strip" else "GL_TRIANGLES"]
        for name, u in p["uniforms"].items():
            if "value" in u:
                self.set_uniform(program, name, u["type"], u["value"])
        for name, s in p["samplers"].items():
            if "reads" in s:
                self.set_sampler(program, units[name], name, s["reads"])
        for draw in p["draws"]:
            self.point_attributes(p, draw)
            for name, value in draw["uniforms"].items():
                self.set_uniform(program, name, p["uniforms"][name]["type"], value)
            for name, source in draw["samplers"].items():
                self.set_sampler(program, units[name], name, source)
            if "indices" in draw:
                gl.glBindBuffer(0x8893, self.buffers[draw["indices"]])
                gl.glDrawElementsInstanced(mode, draw["count"], UINT, None, draw["instance_count"])
            else:
                gl.glDrawArraysInstanced(mode, 0, draw["count"], draw["instance_count"])

    def captured(self, name):
        """The channels of a picture."""
        p, gl = self.pictures[name], self.gl
        (_, external, _, kind, size, called), (width, height) = FORMATS[p["format"]], p["size"]
        depth = external == DEPTH
        self.bind_target([] if depth else [name], name if depth else None)
        texels = (ctypes.c_ubyte * (width * height * size))()
        gl.glReadPixels(0, 0, width, height, external if called in ("uint", "depth") else RGBA, kind, texels)
        return {channel: channel_values(called, texels, k) for k, channel in enumerate(p["capture"])}


def main(folder, path):
    try:
        replay = Replay(folder)
    except OSError as error:
        print(f"SKIPPED: {error}", file=sys.stderr)
        return 7
    for draw_pass in replay.frame["passes"]:
        replay.draw_pass(draw_pass)
    channels = {}
    for name, picture in replay.pictures.items():
        if "capture" in picture:
            channels.update(replay.captured(name))
    if error := replay.gl.glGetError():
        print(f"OpenGL error {error:#x}", file=sys.stderr)
        return 1
    write_exr(path, *replay.pictures["target"]["size"], channels)
    return 0


if __name__ == "__main__":
    sys.exit(run(main))
