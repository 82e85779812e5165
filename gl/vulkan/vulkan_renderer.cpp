#include "gl/vulkan/vulkan_renderer.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <map>
#include <stdexcept>

#include "gl/emit/light_text.h"
#include "gl/lists/frame_list.h"
#include "gl/lists/scene_records.h"
#include "gl/vulkan/device.h"
#include "gl/vulkan/pass_pipeline.h"

namespace trueshade::oracle {

namespace {

constexpr size_t kUniformAlignment = 256;  // no device asks for more

size_t aligned_to(size_t size, size_t alignment) { return (size + alignment - 1) / alignment * alignment; }

const NamedValue* value_of(const std::vector<NamedValue>& values, const std::string& name) {
  const auto found = std::find_if(values.begin(), values.end(), [&](const NamedValue& v) { return v.name == name; });
  return found == values.end() ? nullptr : &*found;
}

/// A uniform as std140 has it: arrays here are of vec4, so that nothing lies between their elements.
void write_member(const BlockMember& m, const NamedValue& value, uint8_t* block) {
  for (size_t i = 0; i < value.numbers.size(); ++i) {
    const auto real = float(value.numbers[i]);
    const auto whole = int32_t(is_integer(m.variable.type) ? value.numbers[i] : 0);
    std::memcpy(block + m.offset + 4 * i, is_integer(m.variable.type) ? static_cast<const void*>(&whole) : &real, 4);
  }
}

/// How a picture's texels become an image's, rows from the lowest: as they are, or without an alpha, or as floats.
void copy_texel(Format stored, Format wanted, const uint8_t* from, uint8_t* to) {
  float depth = 0;
  if (stored == Format::d16) {
    uint16_t code = 0;
    std::memcpy(&code, from, sizeof code);
    depth = float(code) / 65535.0f;
    std::memcpy(to, &depth, sizeof depth);
  } else if (stored == Format::d24) {
    uint32_t code = 0;
    std::memcpy(&code, from, sizeof code);
    depth = float(double(code & 0xFFFFFFu) / double(0xFFFFFF));
    std::memcpy(to, &depth, sizeof depth);
  } else {
    std::memcpy(to, from, size_t(info(wanted).bytes_per_texel()));
  }
}

class VulkanDrawing {
 public:
  VulkanDrawing(VulkanDevice& device, const FrameList& list, const VulkanDraw& draw, Format target, int lights)
      : device_(device), vk_(device.vk()), list_(list), draw_(draw), target_(target), lights_(lights) {
    nearest_ = device.make_sampler(
        {{Wrap::clamp_to_edge, Wrap::clamp_to_edge}, Filter::nearest, Filter::nearest, MipFilter::none}, 1);
    for (const ListedPicture& p : list.pictures) pictures_[p.name] = device.make_picture(p.format, p.width, p.height);
    for (const ListedBuffer& b : list.buffers)
      buffers_[b.name] =
          device.make_buffer(b.bytes.size(),
                             b.texels ? VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT
                                      : VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_INDEX_BUFFER_BIT |
                                            VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT,
                             b.bytes, b.texels);
    for (const ListedTexture& t : list.textures)
      textures_[t.name] = {device.make_texture(t.texture),
                           device.make_sampler(t.sampler, int(t.texture.levels.size()))};
    for (const ListedPass& pass : list.passes) passes_.push_back(prepared(pass));
    for (const ListedPass& pass : list.passes)
      for (const ListedDraw& d : pass.draws) objects_ += d.object >= 0 && pass.colors[0] == "target" ? 1 : 0;
  }

  void run() {
    for (size_t i = 0; i < list_.passes.size(); ++i) run_pass(list_.passes[i], passes_[i]);
    if (draw_.after_light && !started_lights_) show_unlit();
  }

  /// A picture as an image of that format, rows from the top.
  Image image(const std::string& name, Format wanted) {
    const ListedPicture& p = *std::find_if(list_.pictures.begin(), list_.pictures.end(),
                                           [&](const ListedPicture& picture) { return picture.name == name; });
    const size_t texel = size_t(info(p.format).bytes_per_texel());
    VulkanBuffer& host = read_back_[p.name];
    if (host.bytes == nullptr)
      host = device_.make_buffer(texel * size_t(p.width) * size_t(p.height), VK_BUFFER_USAGE_TRANSFER_DST_BIT, {});
    const VulkanImage& picture = pictures_.at(name);
    device_.run([&](VkCommandBuffer commands) {
      VkBufferImageCopy copy{};
      copy.imageSubresource = {picture.aspect, 0, 0, 1};
      copy.imageExtent = {uint32_t(p.width), uint32_t(p.height), 1};
      device_.order(commands);
      vk_.vkCmdCopyImageToBuffer(commands, picture.image, VK_IMAGE_LAYOUT_GENERAL, host.buffer, 1, &copy);
      device_.order(commands);
    });
    Image out(p.width, p.height, wanted);
    const size_t to = size_t(info(wanted).bytes_per_texel());
    for (int y = 0; y < p.height; ++y)
      for (int x = 0; x < p.width; ++x)
        copy_texel(p.format, wanted, host.bytes + texel * (size_t(y) * size_t(p.width) + size_t(x)),
                   out.texels.data() + to * (size_t(p.height - 1 - y) * size_t(p.width) + size_t(x)));
    return out;
  }

 private:
  struct BoundTexture {
    VulkanImage image;
    VkSampler sampler = VK_NULL_HANDLE;
  };
  /// A pass, and for each of its draws a descriptor set and a block of uniforms.
  struct Prepared {
    PassPipeline pipeline;
    std::vector<VkDescriptorSet> sets;             ///< one a draw; the same where draws have no samplers of their own
    std::vector<std::array<uint32_t, 2>> offsets;  ///< of the blocks
  };

  Prepared prepared(const ListedPass& pass) {
    Prepared out;
    out.pipeline = make_pass_pipeline(device_, list_, pass);
    std::array<size_t, 2> bytes{};
    for (size_t stage = 0; stage < 2; ++stage)
      bytes[stage] = aligned_to(size_t(std::max(block_bytes(out.pipeline.blocks[stage]), 16)), kUniformAlignment);
    const size_t step = bytes[0] + bytes[1];
    const VulkanBuffer uniforms =
        device_.make_buffer(step * std::max<size_t>(pass.draws.size(), 1), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, {});
    for (size_t i = 0; i < pass.draws.size(); ++i) {
      out.offsets.push_back({uint32_t(i * step), uint32_t(i * step + bytes[0])});
      for (size_t stage = 0; stage < 2; ++stage)
        for (const BlockMember& m : out.pipeline.blocks[stage]) {
          const NamedValue* value = value_of(pass.draws[i].uniforms, m.variable.name);
          if (value == nullptr) value = value_of(pass.uniforms, m.variable.name);
          if (value != nullptr) write_member(m, *value, uniforms.bytes + out.offsets[i][stage]);
        }
    }
    add_sets(pass, uniforms, bytes, out);
    return out;
  }

  void add_sets(const ListedPass& pass, const VulkanBuffer& uniforms, const std::array<size_t, 2>& bytes,
                Prepared& out) {
    const auto own = [](const ListedDraw& d) { return !d.bindings.empty(); };
    const auto sets = uint32_t(1 + std::count_if(pass.draws.begin(), pass.draws.end(), own));
    const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, 2 * sets},
                                          {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, sets},
                                          {VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, 8 * sets},
                                          {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 16 * sets}};
    VkDescriptorPoolCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    info.maxSets = sets, info.poolSizeCount = uint32_t(std::size(sizes)), info.pPoolSizes = sizes;
    VkDescriptorPool pool = VK_NULL_HANDLE;
    check_vulkan(vk_.vkCreateDescriptorPool(device_.device(), &info, nullptr, &pool), "making a descriptor pool");
    device_.at_end([&device = device_, pool] { device.vk().vkDestroyDescriptorPool(device.device(), pool, nullptr); });
    VkDescriptorSet shared = VK_NULL_HANDLE;
    for (const ListedDraw& d : pass.draws) {
      if (own(d) || shared == VK_NULL_HANDLE) {
        out.sets.push_back(new_set(pool, out.pipeline.set_layout));
        write_set(pass, d, uniforms, bytes, out);
        if (!own(d)) shared = out.sets.back();
      } else {
        out.sets.push_back(shared);
      }
    }
  }

  VkDescriptorSet new_set(VkDescriptorPool pool, const VkDescriptorSetLayout& layout) const {
    VkDescriptorSetAllocateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
    info.descriptorPool = pool, info.descriptorSetCount = 1, info.pSetLayouts = &layout;
    VkDescriptorSet set = VK_NULL_HANDLE;
    check_vulkan(vk_.vkAllocateDescriptorSets(device_.device(), &info, &set), "making a descriptor set");
    return set;
  }

  /// What a sampler of a draw reads.
  static const std::string& source_of(const ListedPass& pass, const ListedDraw& d, const std::string& sampler) {
    for (const std::vector<ListedBinding>* bindings : {&d.bindings, &pass.bindings})
      for (const ListedBinding& b : *bindings)
        if (b.sampler == sampler) return b.source;
    throw std::logic_error("no source of the sampler " + sampler);
  }

  void write_set(const ListedPass& pass, const ListedDraw& d, const VulkanBuffer& uniforms,
                 const std::array<size_t, 2>& bytes, const Prepared& out) const {
    const auto write = [&](uint32_t binding, VkDescriptorType type, const VkDescriptorBufferInfo* buffer,
                           const VkDescriptorImageInfo* image, const VkBufferView* view) {
      VkWriteDescriptorSet info{};
      info.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
      info.dstSet = out.sets.back(), info.dstBinding = binding, info.descriptorCount = 1, info.descriptorType = type;
      info.pBufferInfo = buffer, info.pImageInfo = image, info.pTexelBufferView = view;
      vk_.vkUpdateDescriptorSets(device_.device(), 1, &info, 0, nullptr);
    };
    for (const ShaderStage stage : {ShaderStage::vertex, ShaderStage::fragment}) {
      const VkDescriptorBufferInfo block{uniforms.buffer, 0, bytes[size_t(stage)]};
      write(uint32_t(block_binding(stage)), VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, &block, nullptr, nullptr);
    }
    for (const ListedBinding& b : pass.blocks) {
      const VkDescriptorBufferInfo block{buffers_.at(b.source).buffer, 0, VK_WHOLE_SIZE};
      write(uint32_t(kParameterBinding), VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, &block, nullptr, nullptr);
    }
    for (const BoundSampler& s : out.pipeline.samplers) {
      const std::string& source = source_of(pass, d, s.variable.name);
      if (s.variable.is_buffer()) {
        write(s.binding, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, nullptr, nullptr, &buffers_.at(source).view);
        continue;
      }
      const auto texture = textures_.find(source);
      const bool is_texture = texture != textures_.end();
      const VkDescriptorImageInfo image{is_texture ? texture->second.sampler : nearest_,
                                        is_texture ? texture->second.image.view : pictures_.at(source).view,
                                        VK_IMAGE_LAYOUT_GENERAL};
      write(s.binding, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, nullptr, &image, nullptr);
    }
  }

  void clear(const ListedPass& pass, VkCommandBuffer commands) const {
    for (const std::string& name : pass.cleared) {
      const VulkanImage& picture = pictures_.at(name);
      const ListedPicture& p = *std::find_if(list_.pictures.begin(), list_.pictures.end(),
                                             [&](const ListedPicture& listed) { return listed.name == name; });
      const VkImageSubresourceRange all{picture.aspect, 0, 1, 0, 1};
      if (picture.aspect == VK_IMAGE_ASPECT_DEPTH_BIT) {
        const VkClearDepthStencilValue value{p.clear[0], 0};
        vk_.vkCmdClearDepthStencilImage(commands, picture.image, VK_IMAGE_LAYOUT_GENERAL, &value, 1, &all);
      } else {
        VkClearColorValue value{};
        for (size_t c = 0; c < 4; ++c) {
          if (p.format == Format::r32ui)
            value.uint32[c] = uint32_t(p.clear[c]);
          else
            value.float32[c] = p.clear[c];
        }
        vk_.vkCmdClearColorImage(commands, picture.image, VK_IMAGE_LAYOUT_GENERAL, &value, 1, &all);
      }
    }
  }

  /// Draws [first, last) in one go.
  void record(const ListedPass& pass, const Prepared& ready, size_t first, size_t last,
              VkCommandBuffer commands) const {
    device_.order(commands);
    std::vector<VkRenderingAttachmentInfo> colors;
    const auto attachment = [&](const std::string& name) {
      VkRenderingAttachmentInfo info{};
      info.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO;
      info.imageView = pictures_.at(name).view, info.imageLayout = VK_IMAGE_LAYOUT_GENERAL;
      info.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD, info.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
      return info;
    };
    for (const std::string& name : pass.colors) colors.push_back(attachment(name));
    VkRenderingAttachmentInfo depth{};
    if (!pass.depth.empty()) depth = attachment(pass.depth);
    VkRenderingInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDERING_INFO;
    info.renderArea.extent = {uint32_t(list_.width), uint32_t(list_.height)};
    info.layerCount = 1;
    info.colorAttachmentCount = uint32_t(colors.size()), info.pColorAttachments = colors.data();
    if (!pass.depth.empty()) info.pDepthAttachment = &depth;
    vk_.vkCmdBeginRendering(commands, &info);
    vk_.vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, ready.pipeline.pipeline);
    for (size_t i = first; i < last; ++i) record_draw(pass.draws[i], ready, i, commands);
    vk_.vkCmdEndRendering(commands);
    device_.order(commands);
  }

  void record_draw(const ListedDraw& d, const Prepared& ready, size_t i, VkCommandBuffer commands) const {
    vk_.vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, ready.pipeline.layout, 0, 1, &ready.sets[i],
                                2, ready.offsets[i].data());
    const auto bind = [&](uint32_t binding, const std::string& buffer, size_t offset) {
      const VkDeviceSize bytes = offset;
      if (!buffer.empty()) vk_.vkCmdBindVertexBuffers(commands, binding, 1, &buffers_.at(buffer).buffer, &bytes);
    };
    bind(0, d.vertices, d.vertices_offset);
    bind(1, d.instances, d.instances_offset);
    if (d.indices.empty()) {
      vk_.vkCmdDraw(commands, uint32_t(d.count), uint32_t(d.instance_count), 0, 0);
    } else {
      vk_.vkCmdBindIndexBuffer(commands, buffers_.at(d.indices).buffer, 0, VK_INDEX_TYPE_UINT32);
      vk_.vkCmdDrawIndexed(commands, uint32_t(d.count), uint32_t(d.instance_count), 0, 0, 0);
    }
  }

  static bool is_of_light(const ListedDraw& d) {
    const NamedValue* light = value_of(d.uniforms, oracle::kDrawnLight);
    return light != nullptr && light->numbers[0] >= 0;
  }

  /// The target where no light is drawn, as there is none or nothing that it lights.
  void show_unlit() {
    started_lights_ = true;
    for (int light = -1; light < lights_; ++light) draw_.after_light(light, image("target", target_));
  }

  void run_pass(const ListedPass& pass, const Prepared& ready) {
    device_.run([&](VkCommandBuffer commands) {
      device_.order(commands);
      clear(pass, commands);
    });
    const bool over = pass.colors[0] == "target";
    const size_t stride = (objects_ + kMostSteps - 1) / kMostSteps;
    for (size_t first = 0; first < pass.draws.size();) {
      if (draw_.after_light && !started_lights_ && over && pass.name == "glass") show_unlit();
      if (draw_.after_light && !started_lights_ && over && is_of_light(pass.draws[first])) {
        started_lights_ = true;
        draw_.after_light(-1, image("target", target_));
      }
      if (draw_.after_object && drawn_objects_ == 0 && over && pass.draws[first].object >= 0)
        draw_.after_object(-1, image("target", target_));
      size_t last = first;
      int light = -1, object = -1;
      while (last < pass.draws.size() && light < 0 && object < 0) {
        if (draw_.after_light && over) light = pass.draws[last].light;
        if (draw_.after_object && over) object = pass.draws[last].object;
        ++last;
      }
      device_.run([&](VkCommandBuffer commands) { record(pass, ready, first, last, commands); });
      if (light >= 0) draw_.after_light(light, image("target", target_));
      if (object >= 0) {
        ++drawn_objects_;
        if (drawn_objects_ % stride == 0 || drawn_objects_ == objects_)
          draw_.after_object(object, image("target", target_));
      }
      first = last;
    }
  }

  static constexpr size_t kMostSteps = 64;  ///< of after_object, as of GlDraw
  VulkanDevice& device_;
  const VulkanFunctions& vk_;
  const FrameList& list_;
  const VulkanDraw& draw_;
  const Format target_;
  const int lights_;
  VkSampler nearest_ = VK_NULL_HANDLE;
  std::map<std::string, VulkanImage> pictures_;
  std::map<std::string, VulkanBuffer> buffers_, read_back_;
  std::map<std::string, BoundTexture> textures_;
  std::vector<Prepared> passes_;
  size_t objects_ = 0, drawn_objects_ = 0;
  bool started_lights_ = false;
};

}  // namespace

VulkanFrame drawn_by_vulkan(const Scene& scene, const Pipeline& pipeline, VulkanDriver driver, const VulkanDraw& draw) {
  VulkanDevice device(driver);
  GlslOptions options = scene_options(scene);
  options.version = version_of(ShaderApi::vulkan);
  options.primitive = device.info().primitive_ids;
  options.rgb16f = device.draws_into(VK_FORMAT_R16G16B16_SFLOAT, false);
  const FrameList list = frame_list(scene, pipeline, options);
  VulkanDrawing drawing(device, list, draw, pipeline.target, int(scene.lights.size()));
  VulkanFrame out;
  const auto start = std::chrono::steady_clock::now();
  drawing.run();
  out.ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  out.subpixel_bits = device.info().subpixel_bits;
  out.capture.driver = device.info().line;
  out.capture.name = "frame";
  for (const ListedPicture& p : list.pictures) {
    if (p.plane == "color") out.capture.color = drawing.image(p.name, pipeline.target);
    if (p.plane == "depth")
      out.capture.planes.insert(out.capture.planes.begin(), {"depth", drawing.image(p.name, Format::d32f)});
    if (!p.plane.empty() && p.plane != "color" && p.plane != "depth")
      out.capture.planes.push_back({p.plane, drawing.image(p.name, p.format)});
    if (p.channels < info(p.format).channels)
      out.notes.push_back("rgb16f is not renderable on this driver: rgba16f stands in for it");
  }
  out.notes.erase(std::unique(out.notes.begin(), out.notes.end()), out.notes.end());
  if (!options.primitive) out.notes.push_back("gl_PrimitiveID is not to be had: there is no plane id.primitive");
  return out;
}

}  // namespace trueshade::oracle
