#!/usr/bin/env python3
"""Draws the frame that `trueshade glsl SCENE --api gl|gl33|es31 -o FOLDER` wrote, by EGL and OpenGL, from the files
alone (docs/opengl.md), and writes what was drawn as a capture for `trueshade validate --gbuffer`.

usage: replay.py FOLDER CAPTURE.exr (exit code 7: no driver gives a context)
"""
import ctypes
import json
import re

from capture import run, texel_bytes

# Of egl.xml and gl.xml. Numbers of what every frame needs are in state.json.
SURFACELESS_PLATFORM, OPENGL_ES_API, OPENGL_API = 0x31DD, 0x30A0, 0x30A2
MAJOR_VERSION, MINOR_VERSION, END = 0x3098, 0x30FB, 0x3038
UNIFORM_BUFFER, INVALID_INDEX = 0x8A11, 0xFFFFFFFF


def open_context(api):
    """Makes a context without a window current, on Mesa's display for such or on the default one. Returns EGL."""
    egl = ctypes.CDLL("libEGL.so.1")
    for name in ("eglGetPlatformDisplay", "eglGetDisplay", "eglCreateContext", "eglGetProcAddress"):
        getattr(egl, name).restype = ctypes.c_void_p
    major, minor = {"gl": (4, 5), "gl33": (3, 3), "es31": (3, 1)}[api]
    wanted = (ctypes.c_int * 5)(MAJOR_VERSION, major, MINOR_VERSION, minor, END)
    for found in (egl.eglGetPlatformDisplay(SURFACELESS_PLATFORM, None, None), egl.eglGetDisplay(None)):
        display = ctypes.c_void_p(found)
        if display and egl.eglInitialize(display, None, None):
            egl.eglBindAPI(OPENGL_ES_API if api == "es31" else OPENGL_API)
            context = ctypes.c_void_p(egl.eglCreateContext(display, None, None, wanted))
            if context and egl.eglMakeCurrent(display, None, None, context):
                return egl
    raise OSError(f"EGL gives no context of {api} without a window")


class Driver:
    """OpenGL's functions as attributes. They take names of constants, numbers, lists of these, bytes and addresses."""

    def __init__(self, api, constants):
        self.constants, self.egl = constants, open_context(api)

    def __getattr__(self, name):
        function = ctypes.CFUNCTYPE(ctypes.c_uint)(self.egl.eglGetProcAddress(name.encode()))
        real = ctypes.c_double if name == "glDepthRange" else ctypes.c_float

        def passed(argument):
            if isinstance(argument, str):
                return self.constants[argument]
            if isinstance(argument, list):
                whole = all(isinstance(number, int) for number in argument)
                return ((ctypes.c_int if whole else ctypes.c_float) * len(argument))(*argument)
            return real(argument) if isinstance(argument, float) else argument

        setattr(self, name, lambda *arguments: function(*map(passed, arguments)))
        return getattr(self, name)

    def new(self, kind):
        """One of Textures, Buffers, Framebuffers or VertexArrays."""
        name = ctypes.c_uint()
        getattr(self, "glGen" + kind)(1, ctypes.byref(name))
        return name.value

    def run(self, calls):
        """Calls as they are written in C: glEnable(GL_DEPTH_TEST); glDepthFunc(GL_LESS)."""
        for name, words in re.findall(r"(\w+)\((.*?)\)", calls):
            getattr(self, name)(*(word if word in self.constants else json.loads(word) for word in words.split(", ")))


class Replay:
    """The textures, buffers and programs of a frame, made in OpenGL, and the passes that draw with them."""

    def __init__(self, frame):
        self.frame, self.gl = frame, Driver(frame.state["api"], frame.state["constants"])
        self.textures, self.buffers, self.programs = {}, {}, {}
        for name, block in {**frame.pictures, **frame.state["textures"], **frame.state["buffers"]}.items():
            (self.add_texture if "format" in block else self.add_buffer)(name, block)

    def add_texture(self, name, block):
        """Of its levels, or of one: a picture, which has no texels yet, or a buffer that ES has as rows of texels."""
        gl, self.textures[name] = self.gl, ("GL_TEXTURE_2D", self.gl.new("Textures"))
        gl.glBindTexture(*self.textures[name])
        for k, level in enumerate(block.get("levels", [block])):
            texels = self.frame.bytes_of(level) if "offset" in level else None
            gl.glTexImage2D("GL_TEXTURE_2D", k, block["format"], *level["size"], 0, *block["pixels"], texels)
        for parameter, value in block["sampler"].items():
            kind = {list: "fv", float: "f"}.get(type(value), "i")
            getattr(gl, "glTexParameter" + kind)("GL_TEXTURE_2D", parameter, value)

    def add_buffer(self, name, block):
        gl, data, self.buffers[name] = self.gl, self.frame.bytes_of(block), self.gl.new("Buffers")
        gl.glBindBuffer("GL_ARRAY_BUFFER", self.buffers[name])
        gl.glBufferData("GL_ARRAY_BUFFER", ctypes.c_ssize_t(len(data)), data, "GL_STATIC_DRAW")
        if "texels" in block:
            self.textures[name] = "GL_TEXTURE_BUFFER", gl.new("Textures")
            gl.glBindTexture(*self.textures[name])
            gl.glTexBuffer("GL_TEXTURE_BUFFER", "GL_RGBA32F", self.buffers[name])

    def check(self, kind, thing, status, files):
        """Ends with what the driver says of a Shader or Program that it did not make."""
        made, log = ctypes.c_int(), ctypes.create_string_buffer(4096)
        getattr(self.gl, f"glGet{kind}iv")(thing, status, ctypes.byref(made))
        getattr(self.gl, f"glGet{kind}InfoLog")(thing, len(log), None, log)
        if not made:
            raise RuntimeError(f"{files}: {log.value.decode()}")

    def use_program(self, *files):
        """Of a vertex and a fragment shader, linked when they are first used."""
        gl = self.gl
        if files not in self.programs:
            program = self.programs[files] = gl.glCreateProgram()
            for file, stage in zip(files, ("GL_VERTEX_SHADER", "GL_FRAGMENT_SHADER")):
                shader, text = gl.glCreateShader(stage), ctypes.c_char_p((self.frame.folder / file).read_bytes())
                gl.glShaderSource(shader, 1, ctypes.byref(text), None)
                gl.glCompileShader(shader)
                self.check("Shader", shader, "GL_COMPILE_STATUS", file)
                gl.glAttachShader(program, shader)
            gl.glLinkProgram(program)
            self.check("Program", program, "GL_LINK_STATUS", files)
        gl.glUseProgram(self.programs[files])
        return self.programs[files]

    def bind_target(self, colors, depth):
        gl, places = self.gl, [self.gl.constants["GL_COLOR_ATTACHMENT0"] + k for k in range(len(colors))]
        gl.glBindFramebuffer("GL_FRAMEBUFFER", gl.new("Framebuffers"))
        for place, name in zip([*places, "GL_DEPTH_ATTACHMENT"], [*colors, depth]):
            if name:
                gl.glFramebufferTexture2D("GL_FRAMEBUFFER", place, *self.textures[name], 0)
        gl.glDrawBuffers(len(places), places)
        if gl.glCheckFramebufferStatus("GL_FRAMEBUFFER") != gl.constants["GL_FRAMEBUFFER_COMPLETE"]:
            raise RuntimeError(f"the driver cannot draw into {colors} with {depth}")

    def clear(self, p):
        """Masks are part of a pass's state, and would hold for clears too."""
        self.gl.run("glDisable(GL_SCISSOR_TEST); glDepthMask(GL_TRUE); glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE)")
        for name in p["clears"]:
            value = self.frame.pictures[name]["clear"]
            place = ("GL_DEPTH", 0) if name == p["depth"] else ("GL_COLOR", p["colors"].index(name))
            clear = self.gl.glClearBufferuiv if isinstance(value[0], int) else self.gl.glClearBufferfv
            clear(*place, value)

    def set_inputs(self, p, program, uniforms, samplers):
        """Uniforms to their values, and samplers to the textures that they read."""
        gl, calls = self.gl, dict(int="1i", bool="1i", float="1f", vec2="2f", vec3="3f", vec4="4f")
        for name, value in uniforms.items():
            location = gl.glGetUniformLocation(program, name.encode())
            kind, _, elements = p["uniforms"][name]["type"].partition("[")
            if kind == "mat4":
                gl.glUniformMatrix4fv(location, 1, 0, value)
            else:
                getattr(gl, f"glUniform{calls[kind]}v")(location, int(elements.strip("]") or 1), value)
        for name, source in samplers.items():
            unit = p["samplers"][name]["unit"]
            gl.glActiveTexture(gl.constants["GL_TEXTURE0"] + unit)
            gl.glBindTexture(*self.textures[source])
            gl.glUniform1i(gl.glGetUniformLocation(program, name.encode()), unit)

    def bind_blocks(self, program, blocks):
        """Blocks of uniforms, of a light program, to the buffers that they read."""
        for place, (name, block) in enumerate(blocks.items()):
            index = self.gl.glGetUniformBlockIndex(program, name.encode())
            if index != INVALID_INDEX:
                self.gl.glUniformBlockBinding(program, index, place)
                self.gl.glBindBufferBase(UNIFORM_BUFFER, place, self.buffers[block["reads"]])

    def point_attributes(self, attributes, draw):
        gl = self.gl
        for a in attributes:
            buffer, first = draw[a["of"]]
            place = a["stride"], ctypes.c_void_p(first + a["offset"])
            gl.glBindBuffer("GL_ARRAY_BUFFER", self.buffers[buffer])
            gl.glEnableVertexAttribArray(a["location"])
            if a["type"] == "GL_FLOAT":
                gl.glVertexAttribPointer(a["location"], a["components"], a["type"], 0, *place)
            else:
                gl.glVertexAttribIPointer(a["location"], a["components"], a["type"], *place)
            gl.glVertexAttribDivisor(a["location"], int(a["of"] == "instances"))

    def draw_pass(self, p):
        gl = self.gl
        self.bind_target(p["colors"], p["depth"])
        self.clear(p)
        gl.run("; ".join(p["state"]))
        program = self.use_program(*p["shaders"])
        gl.glBindVertexArray(gl.new("VertexArrays"))
        self.set_inputs(p, program, {name: u["value"] for name, u in p["uniforms"].items() if "value" in u},
                        {name: s["reads"] for name, s in p["samplers"].items() if "reads" in s})
        self.bind_blocks(program, p.get("uniform_blocks", {}))
        for draw in p["draws"]:
            self.set_inputs(p, program, draw["uniforms"], draw["samplers"])
            self.point_attributes(p["attributes"], draw)
            count, instances = draw["count"], draw["instance_count"]
            if "indices" in draw:
                gl.glBindBuffer("GL_ELEMENT_ARRAY_BUFFER", self.buffers[draw["indices"]])
                gl.glDrawElementsInstanced(p["topology"], count, "GL_UNSIGNED_INT", None, instances)
            else:
                gl.glDrawArraysInstanced(p["topology"], 0, count, instances)

    def texels_of(self, picture):
        """What was drawn, rows from the lowest."""
        name, (width, height) = picture["name"], picture["size"]
        self.bind_target(*(([], name) if "DEPTH" in picture["format"] else ([name], None)))
        texels = ctypes.create_string_buffer(width * height * texel_bytes(picture["layout"]))
        self.gl.glReadPixels(0, 0, width, height, *picture["read"], texels)
        if error := self.gl.glGetError():
            raise RuntimeError(f"OpenGL error {error:#x}")
        return texels.raw


if __name__ == "__main__":
    run(Replay, apis=("gl", "gl33", "es31"))
