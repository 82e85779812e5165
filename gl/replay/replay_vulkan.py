#!/usr/bin/env python3
"""Draws the frame that `trueshade glsl SCENE --api vulkan -o FOLDER` wrote, by Vulkan 1.3, from the files alone
(docs/opengl.md), and writes what was drawn as a capture for `trueshade validate --gbuffer`. glslangValidator makes
SPIR-V of the shaders.

usage: replay_vulkan.py FOLDER CAPTURE.exr       (exit code 7: no loader, no device, or no glslangValidator)
"""
import ctypes
import itertools
import pathlib
import struct
import subprocess
import tempfile

from capture import run, texel_bytes

# Structures of vulkan_core.h: the type, and the members behind pNext, as record() has them.
STRUCTURES = dict(
    ApplicationInfo=(0, "QIQII"), InstanceCreateInfo=(1, "IQIQIQ"), DeviceQueueCreateInfo=(2, "IIIQ"),
    DeviceCreateInfo=(3, "IIQIQIQQ"), SubmitInfo=(4, "IQQIQIQ"), MemoryAllocateInfo=(5, "QI"),
    BufferCreateInfo=(12, "IQIIIQ"), BufferViewCreateInfo=(13, "IQIQQ"), ImageCreateInfo=(14, "13IQI"),
    ImageViewCreateInfo=(15, "IQ11I"), ShaderModuleCreateInfo=(16, "IQQ"),
    PipelineShaderStageCreateInfo=(18, "IIQQQ"), PipelineVertexInputStateCreateInfo=(19, "IIQIQ"),
    PipelineInputAssemblyStateCreateInfo=(20, "III"), PipelineViewportStateCreateInfo=(22, "IIQIQ"),
    PipelineRasterizationStateCreateInfo=(23, "7I4f"), PipelineMultisampleStateCreateInfo=(24, "IIIfQII"),
    PipelineDepthStencilStateCreateInfo=(25, "20Iff"), PipelineColorBlendStateCreateInfo=(26, "4IQ4f"),
    GraphicsPipelineCreateInfo=(28, "II12QIQi"), PipelineLayoutCreateInfo=(30, "IIQIQ"),
    SamplerCreateInfo=(31, "7IfIfIIffII"), DescriptorSetLayoutCreateInfo=(32, "IIQ"),
    DescriptorPoolCreateInfo=(33, "IIIQ"), DescriptorSetAllocateInfo=(34, "QIQ"), WriteDescriptorSet=(35, "Q4IQQQ"),
    CommandPoolCreateInfo=(39, "II"), CommandBufferAllocateInfo=(40, "QII"), CommandBufferBeginInfo=(42, "IQ"),
    ImageMemoryBarrier=(45, "6IQ5I"), MemoryBarrier=(46, "II"), RenderingInfo=(1000044000, "IiiIIIIIQQQ"),
    RenderingAttachmentInfo=(1000044001, "QIIQ7I"), PipelineRenderingCreateInfo=(1000044002, "IIQII"),
    PhysicalDeviceDynamicRenderingFeatures=(1000044003, "I"), PhysicalDeviceFeatures2=(1000059000, "55I"),
    PhysicalDeviceProvokingVertexFeaturesEXT=(1000254000, "II"),
    PipelineRasterizationProvokingVertexStateCreateInfoEXT=(1000254001, "I"),
    PhysicalDeviceDepthClipControlFeaturesEXT=(1000355000, "I"),
    PipelineViewportDepthClipControlCreateInfoEXT=(1000355001, "I"))
VERSION_1_3, ALL = 1 << 22 | 3 << 12, 2 ** 64 - 1
GENERAL, ALL_STAGES, READ_WRITE = 1, 0x10000, 0x18000  # a layout, pipeline stages, kinds of access
COLOR, DEPTH = 1, 2  # aspects of an image
VERTEX, FRAGMENT = 1, 16  # stages, by their bits
UNIFORM_BUFFER, TEXEL_BUFFER, IMAGE = 6, 4, 1  # types of descriptors
KEPT = []  # what structures point at, which Vulkan reads later


def word(value):
    """A number as it is, and the address of all else: of bytes, of a list of such in a row, of a value of ctypes."""
    if isinstance(value, list):
        value = b"".join(value)
    if isinstance(value, bytes):
        value = ctypes.create_string_buffer(value)
        KEPT.append(value)
    return value if isinstance(value, (int, float)) else ctypes.addressof(value) if value is not None else 0


def record(members, *values):
    """A structure of C as bytes: I and i 32 bits, f a float, Q a handle, a size or an address."""
    return struct.pack(f"@{members}{'0Q' if 'Q' in members else ''}", *map(word, values))


def info(name, *values, after=None):
    """The structure Vk`name`, chained before another."""
    number, members = STRUCTURES[name]
    return record("IQ" + members, number, after, *values)


class Device:
    """The first device of Vulkan 1.3, with one queue. Functions are attributes."""

    def __init__(self):
        self.library, self.device = ctypes.CDLL("libvulkan.so.1"), None
        application = info("ApplicationInfo", None, 0, None, 0, VERSION_1_3)
        instance = self.made("vkCreateInstance", info("InstanceCreateInfo", 0, application, 0, None, 0, None), None)
        self.physical = self.first_device(instance)
        queue = info("DeviceQueueCreateInfo", 0, 0, 1, record("f", 1.0))
        names = [b"VK_EXT_depth_clip_control", b"VK_EXT_provoking_vertex"]
        independent_blend, depth_clamp = 3, 11  # of VkPhysicalDeviceFeatures
        chain = info("PhysicalDeviceDynamicRenderingFeatures", 1)
        chain = info("PhysicalDeviceDepthClipControlFeaturesEXT", 1, after=chain)
        chain = info("PhysicalDeviceProvokingVertexFeaturesEXT", 1, 0, after=chain)
        chain = info("PhysicalDeviceFeatures2", *(int(k in (independent_blend, depth_clamp)) for k in range(55)),
                     after=chain)
        self.device = self.made("vkCreateDevice", self.physical, info(
            "DeviceCreateInfo", 0, 1, queue, 0, None, len(names), [record("Q", name) for name in names], None,
            after=chain), None)
        self.queue = self.made("vkGetDeviceQueue", self.device, 0, 0)
        self.pool = self.create("CommandPool", 0, 0)
        self.commands = self.made("vkAllocateCommandBuffers", self.device,
                                  info("CommandBufferAllocateInfo", self.pool, 0, 1))

    def first_device(self, instance):
        count, devices = ctypes.c_uint32(16), (ctypes.c_uint64 * 16)()
        self.vkEnumeratePhysicalDevices(instance, count, devices)
        properties = ctypes.create_string_buffer(4096)
        for physical in devices[:count.value]:
            self.vkGetPhysicalDeviceProperties(physical, properties)
            if struct.unpack_from("I", properties)[0] >= VERSION_1_3:
                return physical
        raise OSError("no device of Vulkan 1.3")

    def __getattr__(self, name):
        function = getattr(self.library, name)

        def call(*arguments):
            result = function(*(ctypes.c_uint64(word(a)) for a in arguments))
            if not name.startswith(("vkCmd", "vkGet", "vkUpdate")) and result != 0:
                raise (OSError if self.device is None else RuntimeError)(f"{name}: {result}")
        return call

    def made(self, name, *arguments):
        """What a function makes, which it writes where its last argument points."""
        handle = ctypes.c_uint64()
        getattr(self, name)(*arguments, handle)
        return handle.value

    def create(self, kind, *values):
        return self.made("vkCreate" + kind, self.device, info(kind + "CreateInfo", *values), None)

    def bind_memory(self, kind, handle, wanted):
        """Memory with the wanted properties for a Buffer or an Image."""
        needs, types = (ctypes.c_uint64 * 3)(), (ctypes.c_uint32 * 256)()
        getattr(self, f"vkGet{kind}MemoryRequirements")(self.device, handle, needs)
        self.vkGetPhysicalDeviceMemoryProperties(self.physical, types)
        fits = next(i for i in range(types[0]) if needs[2] >> i & 1 and types[1 + 2 * i] & wanted == wanted)
        memory = self.made("vkAllocateMemory", self.device, info("MemoryAllocateInfo", needs[0], fits), None)
        getattr(self, f"vkBind{kind}Memory")(self.device, handle, memory, 0)
        return memory

    def buffer(self, size, usage, data=b""):
        """A buffer that the host sees, and where."""
        handle = self.create("Buffer", 0, max(size, 16), usage, 0, 0, None)
        memory = self.bind_memory("Buffer", handle, 6)  # visible to the host, and coherent
        address = self.made("vkMapMemory", self.device, memory, 0, ALL, 0)
        ctypes.memmove(address, data, len(data))
        return handle, address

    def image(self, form, size, levels, usage, aspect):
        handle = self.create("Image", 0, 1, form, *size, 1, levels, 1, 1, 0, usage, 0, 0, None, 0)
        self.bind_memory("Image", handle, 0)
        view = self.create("ImageView", 0, handle, 1, form, 0, 0, 0, 0, aspect, 0, levels, 0, 1)
        barrier = info("ImageMemoryBarrier", 0, READ_WRITE, 0, GENERAL, 2 ** 32 - 1, 2 ** 32 - 1, handle, aspect, 0,
                       levels, 0, 1)
        self.run(lambda: self.vkCmdPipelineBarrier(self.commands, 1, ALL_STAGES, 0, 0, None, 0, None, 1, barrier))
        return handle, view

    def run(self, write):
        self.vkResetCommandPool(self.device, self.pool, 0)
        self.vkBeginCommandBuffer(self.commands, info("CommandBufferBeginInfo", 1, None))
        write()
        self.vkEndCommandBuffer(self.commands)
        submit = info("SubmitInfo", 0, None, None, 1, record("Q", self.commands), 0, None)
        self.vkQueueSubmit(self.queue, 1, submit, 0)
        self.vkQueueWaitIdle(self.queue)

    def order(self):
        """All that was written before is seen by all that follows."""
        barrier = info("MemoryBarrier", READ_WRITE, READ_WRITE)
        self.vkCmdPipelineBarrier(self.commands, ALL_STAGES, ALL_STAGES | 0x4000, 0, 1, barrier, 0, None, 0, None)


class Replay:
    """The images, buffers and shaders of a frame, made in Vulkan, and the passes that draw with them."""

    def __init__(self, frame):
        subprocess.run(["glslangValidator", "--version"], check=True, stdout=subprocess.DEVNULL)
        self.frame, self.numbers, self.vk = frame, frame.state["constants"], Device()
        self.images, self.samplers, self.buffers, self.views, self.modules = {}, {}, {}, {}, {}
        for name, picture in frame.pictures.items():
            aspect = self.numbers[picture["aspect"]]
            usage = 0x27 if aspect == DEPTH else 0x17  # copied both ways, sampled, drawn into
            self.images[name] = self.vk.image(self.numbers[picture["format"]], picture["size"], 1, usage, aspect)
            self.samplers[name] = self.vk.create("Sampler", 0, 0, 0, 0, 2, 2, 2, 0, 0, 1, 0, 0, 0, 0, 0, 0)
        for name, buffer in frame.state["buffers"].items():
            usage = 0x4 if "texels" in buffer else 0xD0  # read as texels, or as vertices, indices and uniforms
            self.buffers[name], _ = self.vk.buffer(buffer["bytes"], usage, frame.bytes_of(buffer))
            if "texels" in buffer:
                texel = self.numbers["VK_FORMAT_R32G32B32A32_SFLOAT"]
                self.views[name] = self.vk.create("BufferView", 0, self.buffers[name], texel, 0, ALL)
        for name, texture in frame.state["textures"].items():
            self.add_texture(name, texture)

    def add_texture(self, name, texture):
        vk, s, levels = self.vk, texture["sampler"], texture["levels"]
        self.images[name] = vk.image(self.numbers[texture["format"]], levels[0]["size"], len(levels), 0x6, COLOR)
        for k, level in enumerate(levels):
            staging, _ = vk.buffer(level["bytes"], 1, self.frame.bytes_of(level))
            copy = record("QIIIIIIiiiIII", 0, 0, 0, COLOR, k, 0, 1, 0, 0, 0, *level["size"], 1)
            vk.run(lambda: vk.vkCmdCopyBufferToImage(vk.commands, staging, self.images[name][0], GENERAL, 1, copy))
        named = ("magFilter", "minFilter", "mipmapMode", "addressModeU", "addressModeV", "borderColor")
        mag, minified, mip, u, v, border = (self.numbers[s[member]] for member in named)
        self.samplers[name] = vk.create("Sampler", 0, mag, minified, mip, u, v, u, s["mipLodBias"], 0, 1, 0, 0,
                                        s["minLod"], s["maxLod"], border, 0)

    def module(self, name):
        if name not in self.modules:
            with tempfile.NamedTemporaryFile(suffix=".spv") as made:
                subprocess.run(["glslangValidator", "-V", str(self.frame.folder / name), "-o", made.name], check=True,
                               stdout=subprocess.DEVNULL)
                words = pathlib.Path(made.name).read_bytes()
            self.modules[name] = self.vk.create("ShaderModule", 0, len(words), words)
        return self.modules[name]

    def layouts(self, p):
        """What the shaders' bindings are: the two blocks of uniforms, and samplers."""
        bits = dict(vertex=VERTEX, fragment=FRAGMENT)
        bindings = [record("IIIIQ", k, UNIFORM_BUFFER, 1, bit, None) for k, bit in enumerate((VERTEX, FRAGMENT))]
        for s in p["samplers"].values():
            kind = TEXEL_BUFFER if s["type"] == "samplerBuffer" else IMAGE
            bindings.append(record("IIIIQ", s["binding"], kind, 1, bits[s["stage"]], None))
        for block in p.get("uniform_blocks", {}).values():  # of a light program
            bindings.append(record("IIIIQ", block["binding"], UNIFORM_BUFFER, 1, FRAGMENT, None))
        set_layout = self.vk.create("DescriptorSetLayout", 0, len(bindings), bindings)
        return set_layout, self.vk.create("PipelineLayout", 0, 1, record("Q", set_layout), 0, None)

    def blends(self, state):
        """What is written into each colour, and how."""
        named = ("srcColorBlendFactor", "dstColorBlendFactor", "colorBlendOp", "srcAlphaBlendFactor",
                 "dstAlphaBlendFactor", "alphaBlendOp")
        masks = [sum(1 << "RGBA".index(channel) for channel in b["colorWriteMask"]) for b in state["attachments"]]
        return [record("8I", b["blendEnable"], *(self.numbers[b[member]] for member in named), mask)
                for b, mask in zip(state["attachments"], masks)]

    def pipeline(self, p, layout):
        s, n, main = p["state"], self.numbers, b"main"
        stages = [info("PipelineShaderStageCreateInfo", 0, bit, self.module(name), main, None)
                  for name, bit in zip(p["shaders"], (VERTEX, FRAGMENT))]
        of = {"vertices": 0, "instances": 1}
        strides = {of[a["of"]]: a["stride"] for a in p["attributes"]}
        bound = [record("III", k, stride, k) for k, stride in strides.items()]
        read = [record("IIII", a["location"], of[a["of"]], n[a["format"]], a["offset"]) for a in p["attributes"]]
        forms = [n[self.frame.pictures[name]["format"]] for name in p["colors"]]
        depth = n[self.frame.pictures[p["depth"]]["format"]] if p["depth"] else 0
        targets = info("PipelineRenderingCreateInfo", 0, len(forms), struct.pack(f"{len(forms)}I", *forms), depth, 0)
        clip = info("PipelineViewportDepthClipControlCreateInfoEXT", s["negativeOneToOne"])
        provoking = info("PipelineRasterizationProvokingVertexStateCreateInfoEXT", n[s["provokingVertexMode"]])
        scissor = record("iiII", 0, 0, *self.frame.pictures["target"]["size"])
        blends = self.blends(s)
        return self.vk.made("vkCreateGraphicsPipelines", self.vk.device, 0, 1, info(
            "GraphicsPipelineCreateInfo", 0, len(stages), stages,
            info("PipelineVertexInputStateCreateInfo", 0, len(bound), bound, len(read), read),
            info("PipelineInputAssemblyStateCreateInfo", 0, n[p["topology"]], 0), None,
            info("PipelineViewportStateCreateInfo", 0, 1, record("6f", *s["viewport"]), 1, scissor, after=clip),
            info("PipelineRasterizationStateCreateInfo", 0, s["depthClampEnable"], 0, 0, n[s["cullMode"]],
                 n[s["frontFace"]], s["depthBiasEnable"], s["depthBiasConstantFactor"], 0, s["depthBiasSlopeFactor"],
                 1, after=provoking),
            info("PipelineMultisampleStateCreateInfo", 0, 1, 0, 0, None, 0, 0),
            info("PipelineDepthStencilStateCreateInfo", 0, s["depthTestEnable"], s["depthWriteEnable"],
                 n[s["depthCompareOp"]], *[0] * 16, 0, 0),
            info("PipelineColorBlendStateCreateInfo", 0, 0, 0, len(blends), blends, *s["blendConstants"]), None,
            layout, 0, 0, 0, 0, after=targets), None)

    def block(self, p, stage, draw):
        """The uniforms of a stage: the pass's, and those of the draw. Blocks may start at multiples of 256 bytes."""
        block = bytearray((max(p["blocks"][stage], 16) + 255) // 256 * 256)
        for name, u in p["uniforms"].items():
            value = draw["uniforms"].get(name, u.get("value"))
            if u["stage"] == stage and value is not None:
                kind = "i" if u["type"] in ("int", "bool") else "f"
                struct.pack_into(f"<{len(value)}{kind}", block, u["offset"], *value)
        return block

    def blocks(self, p):
        """Where the two blocks of each draw are, all in one buffer."""
        blocks = [self.block(p, stage, draw) for draw in p["draws"] for stage in ("vertex", "fragment")]
        data = b"".join(blocks)
        buffer, _ = self.vk.buffer(len(data), 0x10, data)
        ends = list(itertools.accumulate(map(len, blocks)))
        places = [record("QQQ", buffer, end - len(block), len(block)) for end, block in zip(ends, blocks)]
        return zip(places[::2], places[1::2])

    def descriptors(self, pool, set_layout, p, draw, blocks):
        """A set of the draw's two blocks of uniforms, and of what its samplers read."""
        vk, writes = self.vk, []
        made = vk.made("vkAllocateDescriptorSets", vk.device,
                       info("DescriptorSetAllocateInfo", pool, 1, record("Q", set_layout)))
        for binding, block in enumerate(blocks):
            writes.append(info("WriteDescriptorSet", made, binding, 0, 1, UNIFORM_BUFFER, None, block, None))
        for block in p.get("uniform_blocks", {}).values():
            whole = record("QQQ", self.buffers[block["reads"]], 0, ALL)
            writes.append(info("WriteDescriptorSet", made, block["binding"], 0, 1, UNIFORM_BUFFER, None, whole, None))
        for name, s in p["samplers"].items():
            source = draw["samplers"].get(name, s.get("reads"))
            if s["type"] == "samplerBuffer":
                read = TEXEL_BUFFER, None, None, record("Q", self.views[source])
            else:
                read = IMAGE, record("QQI", self.samplers[source], self.images[source][1], GENERAL), None, None
            writes.append(info("WriteDescriptorSet", made, s["binding"], 0, 1, *read))
        vk.vkUpdateDescriptorSets(vk.device, len(writes), writes, 0, None)
        return made

    def attachment(self, name, cleared):
        """A picture that is drawn into, cleared first or kept."""
        value = self.frame.pictures[name]["clear"]
        words = struct.unpack("4I", struct.pack("4I" if isinstance(value[0], int) else "4f", *value))
        return info("RenderingAttachmentInfo", self.images[name][1], GENERAL, 0, 0, 0, int(cleared), 0, *words)

    def draw_pass(self, p):
        vk, count = self.vk, len(p["draws"])
        set_layout, layout = self.layouts(p)
        pipeline = self.pipeline(p, layout)
        sizes = [record("II", kind, 16 * count) for kind in (UNIFORM_BUFFER, TEXEL_BUFFER, IMAGE)]
        pool = vk.create("DescriptorPool", 0, count, len(sizes), sizes) if count else 0
        sets = [self.descriptors(pool, set_layout, p, *each) for each in zip(p["draws"], self.blocks(p))]
        attachments = {name: self.attachment(name, name in p["clears"]) for name in [*p["colors"], p["depth"]] if name}
        rendering = info("RenderingInfo", 0, 0, 0, *self.frame.pictures["target"]["size"], 1, 0, len(p["colors"]),
                         [attachments[name] for name in p["colors"]], attachments.get(p["depth"]), None)

        def write():
            vk.order()
            vk.vkCmdBeginRendering(vk.commands, rendering)
            vk.vkCmdBindPipeline(vk.commands, 0, pipeline)
            for draw, made in zip(p["draws"], sets):
                vk.vkCmdBindDescriptorSets(vk.commands, 0, layout, 0, 1, record("Q", made), 0, None)
                self.write_draw(draw)
            vk.vkCmdEndRendering(vk.commands)
            vk.order()
        vk.run(write)

    def write_draw(self, draw):
        vk = self.vk
        for binding, of in enumerate(("vertices", "instances")):
            if of in draw:
                buffer, start = self.buffers[draw[of][0]], draw[of][1]
                vk.vkCmdBindVertexBuffers(vk.commands, binding, 1, record("Q", buffer), record("Q", start))
        if "indices" in draw:
            vk.vkCmdBindIndexBuffer(vk.commands, self.buffers[draw["indices"]], 0, 1)
            vk.vkCmdDrawIndexed(vk.commands, draw["count"], draw["instance_count"], 0, 0, 0)
        else:
            vk.vkCmdDraw(vk.commands, draw["count"], draw["instance_count"], 0, 0)

    def texels_of(self, picture):
        """What was drawn, rows from the lowest."""
        vk, (width, height) = self.vk, picture["size"]
        size = width * height * texel_bytes(picture["layout"])
        buffer, address = vk.buffer(size, 2)
        copy = record("QIIIIIIiiiIII", 0, 0, 0, self.numbers[picture["aspect"]], 0, 0, 1, 0, 0, 0, width, height, 1)
        image = self.images[picture["name"]][0]
        vk.run(lambda: (vk.vkCmdCopyImageToBuffer(vk.commands, image, GENERAL, buffer, 1, copy), vk.order()))
        return ctypes.string_at(address, size)


if __name__ == "__main__":
    run(Replay, apis=("vulkan",))
