#!/usr/bin/env python3
"""Draws the frame that `trueshade glsl SCENE --api vulkan -o FOLDER` wrote, by Vulkan 1.3, from the files alone
(docs/opengl.md), and writes what was drawn as a capture for `trueshade validate --gbuffer`. glslangValidator makes
SPIR-V of the shaders.

usage: replay_vulkan.py FOLDER CAPTURE.exr       (exit code 7: no loader, no device, or no glslangValidator)
"""
import ctypes
import json
import pathlib
import struct
import subprocess
import sys
import tempfile

from capture import channel_values, run, write_exr

TYPES = dict(u=ctypes.c_uint32, i=ctypes.c_int32, f=ctypes.c_float, s=ctypes.c_uint64, p=ctypes.c_void_p)
GENERAL, ALL_STAGES, READ_WRITE = 1, 0x10000, 0x18000  # a layout, pipeline stages, kinds of access
KEPT = []  # what structures point at, which Vulkan reads later


def record(letters, *values):
    """A C structure of members by their letters: u and i 32 bits, s a handle or size of 64, f a float, p a pointer."""
    kind = type("Record", (ctypes.Structure,), {"_fields_": [(f"m{i}", TYPES[c]) for i, c in enumerate(letters)]})
    made = kind(*(v if v is None or isinstance(v, (int, float)) else ctypes.cast(v, ctypes.c_void_p) for v in values))
    KEPT.append((made, values))
    return made


def info(number, letters, *values, after=None):
    """The same of a structure that starts with its type and the next one's address."""
    return record("up" + letters, number, at(after) if after is not None else None, *values)


def at(thing):
    return ctypes.addressof(thing)


def many(things):
    """Structures or numbers one after the other."""
    data = b"".join(bytes(t) if isinstance(t, ctypes.Structure) else struct.pack("<Q", t) for t in things)
    buffer = ctypes.create_string_buffer(data or b"\0", max(len(data), 1))
    KEPT.append(buffer)
    return at(buffer)


# Numbers of vulkan_core.h; the names in state.json are the members' of its enumerations.
FORMATS = dict(  # number, bytes of a texel, what channel_values() calls it
    R8G8B8A8_UNORM=(37, 4, "8"), R8G8B8A8_SRGB=(43, 4, "srgb8"), A2B10G10R10_UNORM_PACK32=(64, 4, "10"),
    R16G16B16A16_UNORM=(91, 8, "16"), R16G16B16A16_SFLOAT=(97, 8, "half"), R32G32B32A32_SFLOAT=(109, 16, "float"),
    R32_UINT=(98, 4, "uint"), D32_SFLOAT=(126, 4, "depth"), D16_UNORM=(124, 2, "depth16"))
COMPARE = ["NEVER", "LESS", "EQUAL", "LESS_OR_EQUAL", "GREATER", "NOT_EQUAL", "GREATER_OR_EQUAL", "ALWAYS"]
CULL = ["NONE", "FRONT_BIT", "BACK_BIT", "FRONT_AND_BACK"]
BLEND_OPS = ["ADD", "SUBTRACT", "REVERSE_SUBTRACT", "MIN", "MAX"]
FACTORS = ["ZERO", "ONE", "SRC_COLOR", "ONE_MINUS_SRC_COLOR", "DST_COLOR", "ONE_MINUS_DST_COLOR", "SRC_ALPHA",
           "ONE_MINUS_SRC_ALPHA", "DST_ALPHA", "ONE_MINUS_DST_ALPHA", "CONSTANT_COLOR", "ONE_MINUS_CONSTANT_COLOR",
           "CONSTANT_ALPHA", "ONE_MINUS_CONSTANT_ALPHA", "SRC_ALPHA_SATURATE"]
ADDRESS = ["REPEAT", "MIRRORED_REPEAT", "CLAMP_TO_EDGE", "CLAMP_TO_BORDER", "MIRROR_CLAMP_TO_EDGE"]
FILTERS = ["NEAREST", "LINEAR"]


def number(names, prefix, name):
    return names.index(name.removeprefix("VK_" + prefix))


class Device:
    """The first device of Vulkan 1.3, with one queue. Functions are attributes; those that make one thing return it."""

    def __init__(self):
        self.library = ctypes.CDLL("libvulkan.so.1")
        self.device = None
        application = info(0, "pupuu", None, 0, None, 0, 1 << 22 | 3 << 12)
        self.instance = self.made("vkCreateInstance", at(info(1, "upupup", 0, at(application), 0, None, 0, None)), None)
        count = ctypes.c_uint32(16)
        devices = (ctypes.c_uint64 * 16)()
        self.vkEnumeratePhysicalDevices(self.instance, at(count), at(devices))
        properties = ctypes.create_string_buffer(4096)
        for physical in devices[:count.value]:
            self.vkGetPhysicalDeviceProperties(physical, at(properties))
            if struct.unpack_from("<I", properties)[0] >= 1 << 22 | 3 << 12:
                break
        else:
            raise OSError("no device of Vulkan 1.3")
        self.physical = physical
        queue = info(2, "uuup", 0, 0, 1, at(record("f", 1.0)))
        names = [b"VK_EXT_depth_clip_control", b"VK_EXT_provoking_vertex"]
        strings = [ctypes.create_string_buffer(name) for name in names]
        KEPT.extend(strings)
        features = [0] * 55
        features[3] = features[11] = 1  # independentBlend, depthClamp
        chain = info(1000044003, "u", 1)
        chain = info(1000355000, "u", 1, after=chain)
        chain = info(1000254000, "uu", 1, 0, after=chain)
        chain = info(1000059000, "u" * 55, *features, after=chain)
        create = info(3, "uupupupp", 0, 1, at(queue), 0, None, 2, many(at(s) for s in strings), None, after=chain)
        self.device = self.made("vkCreateDevice", self.physical, at(create), None)
        queue = ctypes.c_uint64()
        self.vkGetDeviceQueue(self.device, 0, 0, at(queue))
        self.queue = queue.value
        self.pool = self.create("CommandPool", info(39, "uu", 0, 0))
        self.commands = self.made("vkAllocateCommandBuffers", self.device, at(info(40, "suu", self.pool, 0, 1)))

    def __getattr__(self, name):
        function = getattr(self.library, name)

        def call(*arguments):
            result = function(*(ctypes.c_uint64(a or 0) for a in arguments))
            if not name.startswith(("vkCmd", "vkGet", "vkDestroy", "vkUpdate")) and result != 0:
                raise (OSError if self.device is None else RuntimeError)(f"{name}: {result}")
        return call

    def made(self, name, *arguments):
        handle = ctypes.c_uint64()
        getattr(self, name)(*arguments, at(handle))
        return handle.value

    def create(self, kind, create_info):
        return self.made("vkCreate" + kind, self.device, at(create_info), None)

    def bind_memory(self, kind, handle, wanted):
        needs, types = (ctypes.c_uint64 * 3)(), ctypes.create_string_buffer(1024)
        getattr(self, f"vkGet{kind}MemoryRequirements")(self.device, handle, at(needs))
        self.vkGetPhysicalDeviceMemoryProperties(self.physical, at(types))
        count, = struct.unpack_from("<I", types)
        fits = [i for i in range(count) if needs[2] >> i & 1 and struct.unpack_from("<I", types, 4 + 8 * i)[0] & wanted
                == wanted]
        memory = self.made("vkAllocateMemory", self.device, at(info(5, "su", needs[0], fits[0])), None)
        getattr(self, f"vkBind{kind}Memory")(self.device, handle, memory, 0)
        return memory

    def buffer(self, size, usage, data=b""):
        """A buffer that the host sees, and where."""
        handle = self.create("Buffer", info(12, "usuuup", 0, max(size, 16), usage, 0, 0, None))
        memory = self.bind_memory("Buffer", handle, 6)  # visible to the host, and coherent
        place = ctypes.c_uint64()
        self.vkMapMemory(self.device, memory, 0, 2 ** 64 - 1, 0, at(place))
        ctypes.memmove(place.value, data, len(data))
        return handle, place.value

    def image(self, form, width, height, levels, usage, aspect):
        handle = self.create("Image", info(14, "uuuuuuuuuuuuupu", 0, 1, form, width, height, 1, levels, 1, 1, 0,
                                           usage, 0, 0, None, 0))
        self.bind_memory("Image", handle, 0)
        view = self.create("ImageView", info(15, "usuuuuuuuuuuu", 0, handle, 1, form, 0, 0, 0, 0, aspect, 0, levels, 0,
                                             1))
        barrier = info(45, "uuuuuusuuuuu", 0, READ_WRITE, 0, GENERAL, 2 ** 32 - 1, 2 ** 32 - 1, handle, aspect, 0,
                       levels, 0, 1)
        self.run(lambda: self.vkCmdPipelineBarrier(self.commands, 1, ALL_STAGES, 0, 0, None, 0, None, 1, at(barrier)))
        return handle, view

    def run(self, write):
        self.vkResetCommandPool(self.device, self.pool, 0)
        self.vkBeginCommandBuffer(self.commands, at(info(42, "up", 1, None)))
        write()
        self.vkEndCommandBuffer(self.commands)
        submit = info(4, "uppupup", 0, None, None, 1, many([self.commands]), 0, None)
        self.vkQueueSubmit(self.queue, 1, at(submit), 0)
        self.vkQueueWaitIdle(self.queue)

    def order(self):
        """All that was written before is seen by all that follows."""
        barrier = info(46, "uu", READ_WRITE, READ_WRITE)
        self.vkCmdPipelineBarrier(self.commands, ALL_STAGES, ALL_STAGES | 0x4000, 0, 1, at(barrier), 0, None, 0, None)


class Replay:
    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.frame = json.loads((self.folder / "state.json").read_text())
        self.data = (self.folder / self.frame["file"]).read_bytes()
        self.vk = vk = Device()
        self.pictures = {p["name"]: p for p in self.frame["pictures"]}
        self.images, self.buffers, self.views, self.samplers, self.modules = {}, {}, {}, {}, {}
        for name, p in self.pictures.items():
            form, _, called = FORMATS[p["format"].removeprefix("VK_FORMAT_")]
            depth = called.startswith("depth")
            self.images[name] = vk.image(form, *p["size"], 1, 0x27 if depth else 0x17, 2 if depth else 1)
        for name, b in self.frame["buffers"].items():
            usage = 0x4 if "texels" in b else 0xC0
            self.buffers[name], _ = vk.buffer(b["bytes"], usage, self.bytes_of(b))
            if "texels" in b:
                view = info(13, "ususs", 0, self.buffers[name], 109, 0, 2 ** 64 - 1)
                self.views[name] = vk.create("BufferView", view)
        for name, t in self.frame["textures"].items():
            self.add_texture(name, t)
        nearest = info(31, "uuuuuuufufuuffuu", 0, 0, 0, 0, 2, 2, 2, 0, 0, 1, 0, 0, 0, 0, 0, 0)
        self.nearest = vk.create("Sampler", nearest)

    def bytes_of(self, block):
        return self.data[block["offset"]:block["offset"] + block["bytes"]]

    def add_texture(self, name, t):
        vk, s, levels = self.vk, t["sampler"], t["levels"]
        form = FORMATS[t["format"].removeprefix("VK_FORMAT_")][0]
        self.images[name] = vk.image(form, *levels[0]["size"], len(levels), 0x6, 1)
        for k, level in enumerate(levels):
            staging, _ = vk.buffer(level["bytes"], 1, self.bytes_of(level))
            copy = record("suuuuuuiiiuuu", 0, 0, 0, 1, k, 0, 1, 0, 0, 0, *level["size"], 1)
            vk.run(lambda: vk.vkCmdCopyBufferToImage(vk.commands, staging, self.images[name][0], GENERAL, 1, at(copy)))
        address = [number(ADDRESS, "SAMPLER_ADDRESS_MODE_", w) for w in s["wrap"]]
        border = [[0, 0, 0, 0], [0, 0, 0, 1], [1, 1, 1, 1]]
        mip = s["mipmap_mode"]  # none: level 0 alone, whether it is magnified or not
        low, high = (max(s["lod_min"], 0), min(max(s["lod_max"], 0), len(levels))) if mip else (0, 0.25)
        self.samplers[name] = vk.create("Sampler", info(
            31, "uuuuuuufufuuffuu", 0, *(number(FILTERS, "FILTER_", s[f]) for f in ("mag_filter", "min_filter")),
            number(FILTERS, "SAMPLER_MIPMAP_MODE_", mip) if mip else 0, *address, 2, s["lod_bias"], 0, 1, 0, 0,
            min(low, high), high, 2 * border.index([int(b) for b in s["border"]]) if s["border"] in border else 0, 0))

    def module(self, name):
        if name not in self.modules:
            with tempfile.NamedTemporaryFile(suffix=".spv") as made:
                subprocess.run(["glslangValidator", "-V", str(self.folder / name), "-o", made.name], check=True,
                               stdout=subprocess.DEVNULL)
                words = pathlib.Path(made.name).read_bytes()
            code = ctypes.create_string_buffer(words, len(words))
            self.modules[name] = self.vk.create("ShaderModule", info(16, "usp", 0, len(words), at(code)))
        return self.modules[name]

    def layouts(self, p):
        bindings = [record("uuuup", stage, 8, 1, bit, None) for stage, bit in ((0, 1), (1, 16))]  # the two blocks
        for s in p["samplers"].values():
            bindings.append(record("uuuup", s["binding"], 4 if s["type"] == "samplerBuffer" else 1, 1,
                                   1 if s["stage"] == "vertex" else 16, None))
        set_layout = self.vk.create("DescriptorSetLayout", info(32, "uup", 0, len(bindings), many(bindings)))
        return set_layout, self.vk.create("PipelineLayout", info(30, "uupup", 0, 1, many([set_layout]), 0, None))

    def pipeline(self, p, layout):
        s, size = p["state"], self.pictures["target"]["size"]
        main = ctypes.create_string_buffer(b"main")
        stages = [info(18, "uuspp", 0, bit, self.module(name), at(main), None)
                  for name, bit in zip(p["shaders"], (1, 16))]
        KEPT.append(main)
        strides = {a["of"]: a["stride"] for a in p["attributes"]}
        bound = [record("uuu", k, strides[of], k) for k, of in enumerate(("vertices", "instances")) if of in strides]
        read = [record("uuuu", a["location"], int(a["of"] == "instances"),
                       101 if a["type"] == "uint" else (100, 103, 106, 109)[a["components"] - 1], a["offset"])
                for a in p["attributes"]]
        blends = []
        for name, b in zip(p["colors"], s["attachments"]):
            terms = [0] * 6
            if b["blendEnable"]:
                for k, group in enumerate(("Color", "Alpha")):
                    terms[3 * k:3 * k + 3] = [*(number(FACTORS, "BLEND_FACTOR_", b[f"{end}{group}BlendFactor"])
                                                for end in ("src", "dst")),
                                              number(BLEND_OPS, "BLEND_OP_", b[f"{group.lower()}BlendOp"])]
            mask = sum(1 << k for k, c in enumerate("RGBA") if c in b["colorWriteMask"])
            integers = self.pictures[name]["format"] == "VK_FORMAT_R32_UINT"
            blends.append(record("u" * 8, int(b["blendEnable"] and not integers), *terms, mask))
        forms = [FORMATS[self.pictures[name]["format"].removeprefix("VK_FORMAT_")][0]
                 for name in [*p["colors"], p["depth"]] if name]
        colors = record("u" * max(len(p["colors"]), 1), *forms[:len(p["colors"])])
        targets = info(1000044002, "uupuu", 0, len(p["colors"]), at(colors), forms[-1] if p["depth"] else 0, 0)
        clip = info(1000355001, "u", int(s["negativeOneToOne"]))
        provoking = info(1000254001, "u", int("LAST" in s["provokingVertexMode"]))
        parts = [
            info(19, "uupup", 0, len(bound), many(bound), len(read), many(read)),
            info(20, "uuu", 0, 4 if p["topology"] == "triangle_strip" else 3, 0), None,
            info(22, "uupup", 0, 1, at(record("f" * 6, *s["viewport"])), 1, at(record("iiuu", 0, 0, *size)),
                 after=clip),
            info(23, "uuuuuuuffff", 0, int(s["depthClampEnable"]), 0, 0, number(CULL, "CULL_MODE_", s["cullMode"]),
                 int(s["frontFace"] == "VK_FRONT_FACE_CLOCKWISE"), int(s["depthBiasEnable"]),
                 s["depthBiasConstantFactor"], 0, s["depthBiasSlopeFactor"], 1, after=provoking),
            info(24, "uuufpuu", 0, 1, 0, 0, None, 0, 0),
            info(25, "uuuuuu" + "u" * 14 + "ff", 0, int(s["depthTestEnable"]), int(s["depthWriteEnable"]),
                 number(COMPARE, "COMPARE_OP_", s["depthCompareOp"]), 0, 0, *[0] * 14, 0, 0),
            info(26, "uuuupffff", 0, 0, 0, len(blends), many(blends), *s["blendConstants"]), None]
        places = [at(part) if part is not None else None for part in parts]
        create = info(28, "uup" + "p" * 9 + "ssusi", 0, 2, many(stages), *places, layout, 0, 0, 0, 0, after=targets)
        return self.vk.made("vkCreateGraphicsPipelines", self.vk.device, 0, 1, at(create), None)

    def blocks(self, p):
        """The uniforms of all draws, and where each draw's two blocks start."""
        data, starts = bytearray(), []
        for draw in p["draws"]:
            start = []
            for stage in ("vertex", "fragment"):
                block = bytearray((max(p["blocks"][stage], 16) + 255) // 256 * 256)
                for name, u in p["uniforms"].items():
                    value = draw["uniforms"].get(name, u.get("value"))
                    if u["stage"] == stage and value is not None:
                        whole = u["type"] in ("int", "bool", "uint")
                        struct.pack_into(f"<{len(value)}{'i' if whole else 'f'}", block, u["offset"],
                                         *(int(v) if whole else float(v) for v in value))
                start.append(len(data))
                data += block
            starts.append(start)
        return bytes(data), starts

    def write_set(self, pool, set_layout, uniforms, p, draw):
        vk = self.vk
        handle = vk.made("vkAllocateDescriptorSets", vk.device, at(info(34, "sup", pool, 1, many([set_layout]))))
        writes = []
        for binding, stage in enumerate(("vertex", "fragment")):
            size = (max(p["blocks"][stage], 16) + 255) // 256 * 256
            block = at(record("sss", uniforms, 0, size))
            writes.append(info(35, "suuuuppp", handle, binding, 0, 1, 8, None, block, None))
        for name, s in p["samplers"].items():
            source = draw["samplers"].get(name, s.get("reads"))
            texels = at(record("s", self.views[source])) if s["type"] == "samplerBuffer" else None
            image = None if texels else at(
                record("ssu", self.samplers.get(source, self.nearest), self.images[source][1], GENERAL))
            writes.append(info(35, "suuuuppp", handle, s["binding"], 0, 1, 4 if texels else 1, image, None, texels))
        vk.vkUpdateDescriptorSets(vk.device, len(writes), many(writes), 0, None)
        return handle

    def clear(self, p):
        for name in p["clears"]:
            value, form = self.pictures[name]["clear"], self.pictures[name]["format"]
            depth = name == p["depth"]
            all_of_it = record("uuuuu", 2 if depth else 1, 0, 1, 0, 1)
            if depth:
                self.vk.vkCmdClearDepthStencilImage(self.vk.commands, self.images[name][0], GENERAL,
                                                    at(record("fu", value[0], 0)), 1, at(all_of_it))
            else:
                texel = record("uuuu", *map(int, value)) if form == "VK_FORMAT_R32_UINT" else record("ffff", *value)
                self.vk.vkCmdClearColorImage(self.vk.commands, self.images[name][0], GENERAL, at(texel), 1,
                                             at(all_of_it))
        self.vk.order()

    def draw_pass(self, p):
        vk = self.vk
        set_layout, layout = self.layouts(p)
        pipeline = self.pipeline(p, layout)
        data, starts = self.blocks(p)
        uniforms, _ = vk.buffer(len(data), 0x10, data)
        count = len(p["draws"])
        sizes = many([record("uu", 8, 2 * count), record("uu", 4, 8 * count), record("uu", 1, 16 * count)])
        pool = vk.create("DescriptorPool", info(33, "uuup", 0, count, 3, sizes)) if count else 0
        sets = [self.write_set(pool, set_layout, uniforms, p, draw) for draw in p["draws"]]

        def attachment(name):
            return info(1000044001, "suusuuuuuuu", self.images[name][1], GENERAL, 0, 0, 0, 0, 0, 0, 0, 0, 0)

        colors = [attachment(name) for name in p["colors"]]
        depth = at(attachment(p["depth"])) if p["depth"] else None
        size = self.pictures["target"]["size"]
        rendering = info(1000044000, "uiiuuuuuppp", 0, 0, 0, *size, 1, 0, len(colors), many(colors), depth, None)

        def write():
            vk.order()
            self.clear(p)
            vk.vkCmdBeginRendering(vk.commands, at(rendering))
            vk.vkCmdBindPipeline(vk.commands, 0, pipeline)
            for draw, handle, start in zip(p["draws"], sets, starts):
                vk.vkCmdBindDescriptorSets(vk.commands, 0, layout, 0, 1, many([handle]), 2, at(record("uu", *start)))
                for binding, of in enumerate(("vertices", "instances")):
                    if of in draw:
                        buffer, first = draw[of]
                        vk.vkCmdBindVertexBuffers(vk.commands, binding, 1, many([self.buffers[buffer]]), many([first]))
                if "indices" in draw:
                    vk.vkCmdBindIndexBuffer(vk.commands, self.buffers[draw["indices"]], 0, 1)
                    vk.vkCmdDrawIndexed(vk.commands, draw["count"], draw["instance_count"], 0, 0, 0)
                else:
                    vk.vkCmdDraw(vk.commands, draw["count"], draw["instance_count"], 0, 0)
            vk.vkCmdEndRendering(vk.commands)
            vk.order()
        vk.run(write)

    def captured(self, name):
        """The channels of a picture."""
        p, vk = self.pictures[name], self.vk
        (_, size, called), (width, height) = FORMATS[p["format"].removeprefix("VK_FORMAT_")], p["size"]
        buffer, place = vk.buffer(width * height * size, 2)
        aspect = 2 if called.startswith("depth") else 1
        copy = record("suuuuuuiiiuuu", 0, 0, 0, aspect, 0, 0, 1, 0, 0, 0, width, height, 1)
        vk.run(lambda: (vk.order(), vk.vkCmdCopyImageToBuffer(vk.commands, self.images[name][0], GENERAL, buffer, 1,
                                                              at(copy)), vk.order()))
        texels = ctypes.string_at(place, width * height * size)
        return {channel: channel_values(called, texels, k) for k, channel in enumerate(p["capture"])}


def main(folder, path):
    try:
        replay = Replay(folder)
        subprocess.run(["glslangValidator", "--version"], check=True, stdout=subprocess.DEVNULL)
    except OSError as error:
        print(f"SKIPPED: {error}", file=sys.stderr)
        return 7
    for draw_pass in replay.frame["passes"]:
        replay.draw_pass(draw_pass)
    channels = {}
    for name, picture in replay.pictures.items():
        if "capture" in picture:
            channels.update(replay.captured(name))
    write_exr(path, *replay.pictures["target"]["size"], channels)
    return 0


if __name__ == "__main__":
    sys.exit(run(main))
