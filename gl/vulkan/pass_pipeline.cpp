#include "gl/vulkan/pass_pipeline.h"

#include <algorithm>

#include "core/error.h"
#include "gl/emit/light_text.h"
#include "gl/vulkan/spirv.h"

namespace trueshade::oracle {

namespace {

// In the order of the enumerators.
constexpr VkCompareOp kCompareOps[] = {VK_COMPARE_OP_NEVER,
                                       VK_COMPARE_OP_LESS,
                                       VK_COMPARE_OP_EQUAL,
                                       VK_COMPARE_OP_LESS_OR_EQUAL,
                                       VK_COMPARE_OP_GREATER,
                                       VK_COMPARE_OP_NOT_EQUAL,
                                       VK_COMPARE_OP_GREATER_OR_EQUAL,
                                       VK_COMPARE_OP_ALWAYS};
constexpr VkCullModeFlags kCullModes[] = {VK_CULL_MODE_NONE, VK_CULL_MODE_FRONT_BIT, VK_CULL_MODE_BACK_BIT,
                                          VK_CULL_MODE_FRONT_AND_BACK};
constexpr VkBlendOp kBlendOps[] = {VK_BLEND_OP_ADD, VK_BLEND_OP_SUBTRACT, VK_BLEND_OP_REVERSE_SUBTRACT, VK_BLEND_OP_MIN,
                                   VK_BLEND_OP_MAX};
constexpr VkBlendFactor kBlendFactorsOfVulkan[] = {VK_BLEND_FACTOR_ZERO,
                                                   VK_BLEND_FACTOR_ONE,
                                                   VK_BLEND_FACTOR_SRC_COLOR,
                                                   VK_BLEND_FACTOR_ONE_MINUS_SRC_COLOR,
                                                   VK_BLEND_FACTOR_DST_COLOR,
                                                   VK_BLEND_FACTOR_ONE_MINUS_DST_COLOR,
                                                   VK_BLEND_FACTOR_SRC_ALPHA,
                                                   VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA,
                                                   VK_BLEND_FACTOR_DST_ALPHA,
                                                   VK_BLEND_FACTOR_ONE_MINUS_DST_ALPHA,
                                                   VK_BLEND_FACTOR_CONSTANT_COLOR,
                                                   VK_BLEND_FACTOR_ONE_MINUS_CONSTANT_COLOR,
                                                   VK_BLEND_FACTOR_CONSTANT_ALPHA,
                                                   VK_BLEND_FACTOR_ONE_MINUS_CONSTANT_ALPHA,
                                                   VK_BLEND_FACTOR_SRC_ALPHA_SATURATE};

VkPipelineColorBlendAttachmentState attachment_of(const BlendState& b) {
  VkPipelineColorBlendAttachmentState out{};
  out.blendEnable = b.enabled ? VK_TRUE : VK_FALSE;
  out.srcColorBlendFactor = kBlendFactorsOfVulkan[size_t(b.rgb.src)];
  out.dstColorBlendFactor = kBlendFactorsOfVulkan[size_t(b.rgb.dst)];
  out.colorBlendOp = kBlendOps[size_t(b.rgb.equation)];
  out.srcAlphaBlendFactor = kBlendFactorsOfVulkan[size_t(b.alpha.src)];
  out.dstAlphaBlendFactor = kBlendFactorsOfVulkan[size_t(b.alpha.dst)];
  out.alphaBlendOp = kBlendOps[size_t(b.alpha.equation)];
  for (size_t c = 0; c < 4; ++c)
    if (b.mask[c]) out.colorWriteMask |= uint32_t(VK_COLOR_COMPONENT_R_BIT) << c;
  return out;
}

VkFormat attribute_format(const ListedAttribute& a) {
  constexpr VkFormat kFloats[] = {VK_FORMAT_R32_SFLOAT, VK_FORMAT_R32G32_SFLOAT, VK_FORMAT_R32G32B32_SFLOAT,
                                  VK_FORMAT_R32G32B32A32_SFLOAT};
  return a.integers ? VK_FORMAT_R32G32_UINT : kFloats[a.components - 1];
}

VkDescriptorSetLayoutBinding binding_of(uint32_t binding, VkDescriptorType type, ShaderStage stage) {
  return {binding, type, 1,
          VkShaderStageFlags(stage == ShaderStage::vertex ? VK_SHADER_STAGE_VERTEX_BIT : VK_SHADER_STAGE_FRAGMENT_BIT),
          nullptr};
}

/// Blocks, samplers, and the layouts that they make.
void add_layouts(VulkanDevice& device, const std::array<const std::string*, 2>& texts, bool parameters,
                 PassPipeline& out) {
  const VulkanFunctions& vk = device.vk();
  std::vector<VkDescriptorSetLayoutBinding> bindings;
  for (const ShaderStage stage : {ShaderStage::vertex, ShaderStage::fragment}) {
    const ShaderInterface shader = interface_of(*texts[size_t(stage)]);
    out.blocks[size_t(stage)] = block_of(shader);
    bindings.push_back(binding_of(uint32_t(block_binding(stage)), VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, stage));
    for (const ShaderVariable& v : shader.uniforms) {
      if (!v.is_sampler()) continue;
      out.samplers.push_back({v, uint32_t(sampler_binding(stage, shader, v.name))});
      bindings.push_back(binding_of(
          out.samplers.back().binding,
          v.is_buffer() ? VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER : VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, stage));
    }
  }
  if (parameters)
    bindings.push_back(
        binding_of(uint32_t(kParameterBinding), VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, ShaderStage::fragment));
  auto set = typed<VkDescriptorSetLayoutCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO);
  set.bindingCount = uint32_t(bindings.size()), set.pBindings = bindings.data();
  check_vulkan(vk.vkCreateDescriptorSetLayout(device.device(), &set, nullptr, &out.set_layout), "a set's layout");
  auto layout = typed<VkPipelineLayoutCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO);
  layout.setLayoutCount = 1, layout.pSetLayouts = &out.set_layout;
  check_vulkan(vk.vkCreatePipelineLayout(device.device(), &layout, nullptr, &out.layout), "a pipeline's layout");
  device.at_end([&device, set_layout = out.set_layout, made = out.layout] {
    device.vk().vkDestroyPipelineLayout(device.device(), made, nullptr);
    device.vk().vkDestroyDescriptorSetLayout(device.device(), set_layout, nullptr);
  });
}

VkShaderModule make_module(VulkanDevice& device, const std::string& name, ShaderStage stage, const std::string& text) {
  const std::vector<uint32_t> words = spirv_of(name, stage, in_terms_of(ShaderApi::vulkan, stage, text));
  auto info = typed<VkShaderModuleCreateInfo>(VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO);
  info.codeSize = 4 * words.size(), info.pCode = words.data();
  VkShaderModule module = VK_NULL_HANDLE;
  check_vulkan(device.vk().vkCreateShaderModule(device.device(), &info, nullptr, &module), "a shader");
  device.at_end([&device, module] { device.vk().vkDestroyShaderModule(device.device(), module, nullptr); });
  return module;
}

/// The create infos of a pipeline, which point at each other.
struct PipelineState {
  VkPipelineVertexInputStateCreateInfo input;
  VkPipelineInputAssemblyStateCreateInfo assembly;
  VkPipelineViewportDepthClipControlCreateInfoEXT clip;
  VkPipelineViewportStateCreateInfo view;
  VkPipelineRasterizationProvokingVertexStateCreateInfoEXT provoking;
  VkPipelineRasterizationStateCreateInfo raster;
  VkPipelineMultisampleStateCreateInfo samples;
  VkPipelineDepthStencilStateCreateInfo depth;
  VkPipelineColorBlendStateCreateInfo blend;
  VkPipelineRenderingCreateInfo targets;
  std::vector<VkVertexInputBindingDescription> buffers;
  std::vector<VkVertexInputAttributeDescription> attributes;
  std::vector<VkPipelineColorBlendAttachmentState> attachments;
  std::vector<VkFormat> formats;
  VkViewport viewport;
  VkRect2D scissor;
};

void set_input(const ListedPass& pass, PipelineState& s) {
  for (const ListedAttribute& a : pass.attributes) {
    const uint32_t binding = a.per_instance ? 1 : 0;
    if (std::none_of(s.buffers.begin(), s.buffers.end(), [&](const auto& b) { return b.binding == binding; }))
      s.buffers.push_back(
          {binding, uint32_t(a.stride), a.per_instance ? VK_VERTEX_INPUT_RATE_INSTANCE : VK_VERTEX_INPUT_RATE_VERTEX});
    s.attributes.push_back({uint32_t(a.location), binding, attribute_format(a), uint32_t(a.offset)});
  }
  s.input = typed<VkPipelineVertexInputStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO);
  s.input.vertexBindingDescriptionCount = uint32_t(s.buffers.size());
  s.input.pVertexBindingDescriptions = s.buffers.data();
  s.input.vertexAttributeDescriptionCount = uint32_t(s.attributes.size());
  s.input.pVertexAttributeDescriptions = s.attributes.data();
  s.assembly =
      typed<VkPipelineInputAssemblyStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO);
  s.assembly.topology = pass.strip ? VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP : VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
}

/// Viewport, clip space, culling: as vulkan_state() has them.
void set_raster(const VulkanInfo& info, const FrameList& list, const DrawState& state, PipelineState& s) {
  const GeometryState& g = state.geometry;
  const Viewport& v = state.viewport;
  const bool down = g.clip_origin == ClipOrigin::upper_left;
  s.viewport = {float(v.x),     float(down ? v.y + v.height : v.y),
                float(v.width), float(down ? -v.height : v.height),
                g.depth_near,   g.depth_far};
  s.scissor = {{0, 0}, {uint32_t(list.width), uint32_t(list.height)}};
  s.clip = typed<VkPipelineViewportDepthClipControlCreateInfoEXT>(
      VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_DEPTH_CLIP_CONTROL_CREATE_INFO_EXT);
  s.clip.negativeOneToOne = g.clip_depth == ClipDepth::negative_one_to_one ? VK_TRUE : VK_FALSE;
  s.view = typed<VkPipelineViewportStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO);
  if (info.clip_control) s.view.pNext = &s.clip;
  s.view.viewportCount = s.view.scissorCount = 1, s.view.pViewports = &s.viewport, s.view.pScissors = &s.scissor;
  s.provoking = typed<VkPipelineRasterizationProvokingVertexStateCreateInfoEXT>(
      VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_PROVOKING_VERTEX_STATE_CREATE_INFO_EXT);
  s.provoking.provokingVertexMode = g.provoking == Provoking::last ? VK_PROVOKING_VERTEX_MODE_LAST_VERTEX_EXT
                                                                   : VK_PROVOKING_VERTEX_MODE_FIRST_VERTEX_EXT;
  s.raster = typed<VkPipelineRasterizationStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO);
  if (info.last_provokes) s.raster.pNext = &s.provoking;
  s.raster.depthClampEnable = g.depth_clamp ? VK_TRUE : VK_FALSE;
  s.raster.cullMode = kCullModes[size_t(g.cull_face)];
  s.raster.frontFace =
      (g.front_face == FrontFace::ccw) != down ? VK_FRONT_FACE_CLOCKWISE : VK_FRONT_FACE_COUNTER_CLOCKWISE;
  s.raster.depthBiasEnable = g.polygon_offset_factor != 0 || g.polygon_offset_units != 0 ? VK_TRUE : VK_FALSE;
  s.raster.depthBiasConstantFactor = g.polygon_offset_units, s.raster.depthBiasSlopeFactor = g.polygon_offset_factor;
  s.raster.lineWidth = 1.0f;
  s.samples = typed<VkPipelineMultisampleStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO);
  s.samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
}

void set_targets(const VulkanDevice& device, const FrameList& list, const ListedPass& pass, PipelineState& s) {
  const DrawState& state = pass.state;
  const auto format = [&](const std::string& name) {
    const auto found = std::find_if(list.pictures.begin(), list.pictures.end(),
                                    [&](const ListedPicture& p) { return p.name == name; });
    return vulkan_format(found->format);
  };
  s.depth = typed<VkPipelineDepthStencilStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO);
  s.depth.depthTestEnable = state.depth_test ? VK_TRUE : VK_FALSE;
  s.depth.depthWriteEnable = state.depth_test && state.depth_write ? VK_TRUE : VK_FALSE;
  s.depth.depthCompareOp = kCompareOps[size_t(state.geometry.depth_func)];
  BlendState nothing;
  nothing.mask = {};
  for (size_t i = 0; i < pass.colors.size(); ++i) {
    s.attachments.push_back(attachment_of(state.only < 0 || state.only == int(i) ? state.blend : nothing));
    s.formats.push_back(format(pass.colors[i]));
    if (s.formats.back() == VK_FORMAT_R32_UINT) s.attachments.back().blendEnable = VK_FALSE;
    if (s.attachments.back().blendEnable == VK_TRUE) device.check_blends(s.formats.back(), pass.colors[i]);
  }
  s.blend = typed<VkPipelineColorBlendStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO);
  s.blend.attachmentCount = uint32_t(s.attachments.size()), s.blend.pAttachments = s.attachments.data();
  std::copy(state.blend.constant.begin(), state.blend.constant.end(), s.blend.blendConstants);
  s.targets = typed<VkPipelineRenderingCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO);
  s.targets.colorAttachmentCount = uint32_t(s.formats.size()), s.targets.pColorAttachmentFormats = s.formats.data();
  if (!pass.depth.empty()) s.targets.depthAttachmentFormat = format(pass.depth);
}

void check_clip_space(const VulkanInfo& info, const GeometryState& g) {
  if (!info.clip_control && g.clip_depth == ClipDepth::negative_one_to_one)
    throw Error(ErrorKind::no_gl_driver, "Vulkan", info.line + " has no VK_EXT_depth_clip_control",
                "set geometry.clip_depth to zero_to_one in --pipeline");
  if (!info.last_provokes && g.provoking == Provoking::last)
    throw Error(ErrorKind::no_gl_driver, "Vulkan", info.line + " has no VK_EXT_provoking_vertex",
                "set geometry.provoking to first in --pipeline");
}

}  // namespace

PassPipeline make_pass_pipeline(VulkanDevice& device, const FrameList& list, const ListedPass& pass) {
  check_clip_space(device.info(), pass.state.geometry);
  const auto text = [&](const std::string& name) -> const std::string& {
    return std::find_if(list.shaders.begin(), list.shaders.end(), [&](const auto& s) { return s.first == name; })
        ->second;
  };
  PassPipeline out;
  add_layouts(device, {&text(pass.vert), &text(pass.frag)}, !pass.blocks.empty(), out);
  std::array<VkPipelineShaderStageCreateInfo, 2> stages{};
  for (VkPipelineShaderStageCreateInfo& stage : stages)
    stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO, stage.pName = "main";
  stages[0].stage = VK_SHADER_STAGE_VERTEX_BIT, stages[1].stage = VK_SHADER_STAGE_FRAGMENT_BIT;
  stages[0].module = make_module(device, pass.vert, ShaderStage::vertex, text(pass.vert));
  stages[1].module = make_module(device, pass.frag, ShaderStage::fragment, text(pass.frag));
  PipelineState s{};
  set_input(pass, s);
  set_raster(device.info(), list, pass.state, s);
  set_targets(device, list, pass, s);
  auto info = typed<VkGraphicsPipelineCreateInfo>(VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO);
  info.pNext = &s.targets;
  info.stageCount = 2, info.pStages = stages.data();
  info.pVertexInputState = &s.input, info.pInputAssemblyState = &s.assembly, info.pViewportState = &s.view;
  info.pRasterizationState = &s.raster, info.pMultisampleState = &s.samples, info.pDepthStencilState = &s.depth;
  info.pColorBlendState = &s.blend, info.layout = out.layout;
  check_vulkan(device.vk().vkCreateGraphicsPipelines(device.device(), VK_NULL_HANDLE, 1, &info, nullptr, &out.pipeline),
               "making a pipeline");
  device.at_end(
      [&device, pipeline = out.pipeline] { device.vk().vkDestroyPipeline(device.device(), pipeline, nullptr); });
  return out;
}

}  // namespace trueshade::oracle
