#include "gl/vulkan/device.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

#include "core/error.h"
#include "core/threads/startable_threads.h"
#include "gl/emit/format_words.h"
#include "gl/lists/api_numbers.h"

namespace trueshade::oracle {

namespace {

Error no_device(const std::string& reason) {
  return {ErrorKind::no_gl_driver, "Vulkan", reason, "install mesa-vulkan-drivers, or a GPU's driver of Vulkan 1.3"};
}

VkFormat texture_format(TextureFormat format) {
  constexpr VkFormat kFormats[] = {VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R8G8B8A8_SRGB, VK_FORMAT_R16G16B16A16_SFLOAT,
                                   VK_FORMAT_R32G32B32A32_SFLOAT};
  return kFormats[size_t(format)];
}

VkSamplerAddressMode address_mode(Wrap wrap) {
  return VkSamplerAddressMode(api_number(ShaderApi::vulkan, wrap_name(ShaderApi::vulkan, wrap)));
}

/// One of the three borders that every device has. A sampler that does not clamp to its border reads none.
VkBorderColor border_of(const Sampler& s) {
  if (!reads_border(s) || s.border == glm::vec4(0.0f)) return VK_BORDER_COLOR_FLOAT_TRANSPARENT_BLACK;
  if (s.border == glm::vec4(0.0f, 0.0f, 0.0f, 1.0f)) return VK_BORDER_COLOR_FLOAT_OPAQUE_BLACK;
  if (s.border == glm::vec4(1.0f)) return VK_BORDER_COLOR_FLOAT_OPAQUE_WHITE;
  char border[96];
  std::snprintf(border, sizeof border, "(%.4g, %.4g, %.4g, %.4g)", double(s.border.x), double(s.border.y),
                double(s.border.z), double(s.border.w));
  throw Error(ErrorKind::no_gl_driver, "Vulkan",
              std::string("a sampler that clamps to its border has the border ") + border +
                  ", and Vulkan has (0, 0, 0, 0), (0, 0, 0, 1) and (1, 1, 1, 1) alone",
              "OpenGL draws any: --driver llvmpipe; or give the sampler one of these borders, or another wrap");
}

}  // namespace

void check_vulkan(VkResult result, const char* where) {
  if (result == VK_SUCCESS) return;
  const bool memory = result == VK_ERROR_OUT_OF_HOST_MEMORY || result == VK_ERROR_OUT_OF_DEVICE_MEMORY;
  throw Error(memory ? ErrorKind::out_of_memory : ErrorKind::no_gl_driver, "Vulkan",
              "the driver fails with " + std::to_string(result) + " in " + std::string(where),
              memory ? "judge a smaller image or scene" : "another driver, or OpenGL's: --driver llvmpipe");
}

VkFormat vulkan_format(Format format) { return VkFormat(api_number(ShaderApi::vulkan, words_of(format).vulkan)); }

namespace {

/// Where SwiftShader's own manifest is: browsers bring it, and do not tell Vulkan's loader. Empty where the user has
/// named files, of which the device is taken then.
std::string swiftshader_manifest() {
  for (const char* name : {"VK_DRIVER_FILES", "VK_ICD_FILENAMES"})
    if (std::getenv(name) != nullptr) return {};
  for (const char* folder : {"/usr/lib/chromium/", "/usr/lib64/chromium-browser/", "/opt/google/chrome/"})
    if (const std::string file = std::string(folder) + "vk_swiftshader_icd.json"; access(file.c_str(), R_OK) == 0)
      return file;
  throw Error(ErrorKind::no_gl_driver, "Vulkan", "there is no SwiftShader",
              "install chromium-common, or name its vk_swiftshader_icd.json in VK_DRIVER_FILES");
}

bool is_wanted(const VkPhysicalDeviceProperties& device, VulkanDriver driver) {
  if (device.apiVersion < VK_API_VERSION_1_3) return false;
  if (driver == VulkanDriver::swiftshader)
    return std::string_view(device.deviceName).find("SwiftShader") != std::string_view::npos;
  return driver == VulkanDriver::first || device.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
}

Error no_device_of(VulkanDriver driver) {
  if (driver == VulkanDriver::swiftshader) return no_device("the driver's files have no SwiftShader of Vulkan 1.3");
  return no_device(driver == VulkanDriver::software ? "there is no software device of Vulkan 1.3"
                                                    : "there is no device of Vulkan 1.3");
}

}  // namespace

VulkanDevice::VulkanDevice(VulkanDriver driver) {
  require_threads_of_library("a driver of Vulkan");
  instance_ = make_instance(vk_, driver == VulkanDriver::swiftshader ? swiftshader_manifest() : "");
  at_end([this] { vk_.vkDestroyInstance(instance_, nullptr); });
  uint32_t count = 0;
  vk_.vkEnumeratePhysicalDevices(instance_, &count, nullptr);
  std::vector<VkPhysicalDevice> devices(count);
  vk_.vkEnumeratePhysicalDevices(instance_, &count, devices.data());
  for (const VkPhysicalDevice device : devices) {
    VkPhysicalDeviceProperties properties{};
    vk_.vkGetPhysicalDeviceProperties(device, &properties);
    if (!is_wanted(properties, driver)) continue;
    physical_ = device;
    info_.subpixel_bits = int(properties.limits.subPixelPrecisionBits);
    info_.largest_image = properties.limits.maxImageDimension2D;
    info_.most_texels = properties.limits.maxTexelBufferElements;
    info_.line = std::string(properties.deviceName) + ", Vulkan " +
                 std::to_string(VK_API_VERSION_MAJOR(properties.apiVersion)) + "." +
                 std::to_string(VK_API_VERSION_MINOR(properties.apiVersion)) + "." +
                 std::to_string(VK_API_VERSION_PATCH(properties.apiVersion));
    break;
  }
  if (physical_ == VK_NULL_HANDLE) throw no_device_of(driver);
  open_device();
}

void VulkanDevice::open_device() {
  uint32_t count = 0;
  vk_.vkGetPhysicalDeviceQueueFamilyProperties(physical_, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vk_.vkGetPhysicalDeviceQueueFamilyProperties(physical_, &count, families.data());
  while (family_ + 1 < count && (families[family_].queueFlags & VK_QUEUE_GRAPHICS_BIT) == 0) ++family_;
  count = 0;
  vk_.vkEnumerateDeviceExtensionProperties(physical_, nullptr, &count, nullptr);
  std::vector<VkExtensionProperties> offered(count);
  vk_.vkEnumerateDeviceExtensionProperties(physical_, nullptr, &count, offered.data());
  std::vector<const char*> extensions;
  const auto take = [&](const char* name) {
    const bool there = std::any_of(offered.begin(), offered.end(), [&](const VkExtensionProperties& e) {
      return std::string_view(e.extensionName) == name;
    });
    if (there) extensions.push_back(name);
    return there;
  };
  auto clip = typed<VkPhysicalDeviceDepthClipControlFeaturesEXT>(
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DEPTH_CLIP_CONTROL_FEATURES_EXT);
  auto provoking = typed<VkPhysicalDeviceProvokingVertexFeaturesEXT>(
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROVOKING_VERTEX_FEATURES_EXT);
  auto rendering =
      typed<VkPhysicalDeviceDynamicRenderingFeatures>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES);
  auto has = typed<VkPhysicalDeviceFeatures2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2);
  has.pNext = &rendering;
  if (take(VK_EXT_DEPTH_CLIP_CONTROL_EXTENSION_NAME)) clip.pNext = has.pNext, has.pNext = &clip;
  if (take(VK_EXT_PROVOKING_VERTEX_EXTENSION_NAME)) provoking.pNext = has.pNext, has.pNext = &provoking;
  info_.mirrors_once = take(VK_KHR_SAMPLER_MIRROR_CLAMP_TO_EDGE_EXTENSION_NAME);
  vk_.vkGetPhysicalDeviceFeatures2(physical_, &has);
  info_.clip_control = clip.depthClipControl == VK_TRUE;
  info_.last_provokes = provoking.provokingVertexLast == VK_TRUE;
  info_.primitive_ids = has.features.geometryShader == VK_TRUE;
  if (has.features.depthClamp == VK_FALSE || has.features.independentBlend == VK_FALSE)
    throw no_device(info_.line + " has no depth clamp, or blends all attachments alike");
  provoking.transformFeedbackPreservesProvokingVertex = VK_FALSE;
  VkPhysicalDeviceFeatures wanted{};
  wanted.depthClamp = wanted.independentBlend = VK_TRUE;
  wanted.geometryShader = has.features.geometryShader;
  has.features = wanted;
  const float priority = 1.0f;
  auto queue = typed<VkDeviceQueueCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO);
  queue.queueFamilyIndex = family_, queue.queueCount = 1, queue.pQueuePriorities = &priority;
  auto info = typed<VkDeviceCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO);
  info.pNext = &has;
  info.queueCreateInfoCount = 1, info.pQueueCreateInfos = &queue;
  info.enabledExtensionCount = uint32_t(extensions.size()), info.ppEnabledExtensionNames = extensions.data();
  check_vulkan(vk_.vkCreateDevice(physical_, &info, nullptr, &device_), "opening the device");
  at_end([this] { vk_.vkDestroyDevice(device_, nullptr); });
  vk_.vkGetDeviceQueue(device_, family_, 0, &queue_);
  auto pool = typed<VkCommandPoolCreateInfo>(VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO);
  pool.queueFamilyIndex = family_;
  check_vulkan(vk_.vkCreateCommandPool(device_, &pool, nullptr, &pool_), "making a command pool");
  at_end([this] { vk_.vkDestroyCommandPool(device_, pool_, nullptr); });
  auto allocation = typed<VkCommandBufferAllocateInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO);
  allocation.commandPool = pool_, allocation.commandBufferCount = 1;
  check_vulkan(vk_.vkAllocateCommandBuffers(device_, &allocation, &commands_), "making a command buffer");
}

VulkanDevice::AtEnd::~AtEnd() {
  for (auto one = destroy.rbegin(); one != destroy.rend(); ++one) (*one)();
}

bool VulkanDevice::draws_into(VkFormat format, bool depth) const {
  VkFormatProperties properties{};
  vk_.vkGetPhysicalDeviceFormatProperties(physical_, format, &properties);
  const VkFormatFeatureFlags needs =
      depth ? VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT : VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT;
  return (properties.optimalTilingFeatures & needs) == needs;
}

void VulkanDevice::check_blends(VkFormat format, const std::string& picture) const {
  VkFormatProperties properties{};
  vk_.vkGetPhysicalDeviceFormatProperties(physical_, format, &properties);
  if ((properties.optimalTilingFeatures & VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT) == 0)
    throw no_device(info_.line + " does not blend into the format of " + picture);
}

VkDeviceMemory VulkanDevice::allocate(const VkMemoryRequirements& needs, VkMemoryPropertyFlags wanted) {
  VkPhysicalDeviceMemoryProperties memory{};
  vk_.vkGetPhysicalDeviceMemoryProperties(physical_, &memory);
  for (uint32_t i = 0; i < memory.memoryTypeCount; ++i) {
    if ((needs.memoryTypeBits >> i & 1) == 0 || (memory.memoryTypes[i].propertyFlags & wanted) != wanted) continue;
    auto info = typed<VkMemoryAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO);
    info.allocationSize = needs.size, info.memoryTypeIndex = i;
    VkDeviceMemory made_memory = VK_NULL_HANDLE;
    check_vulkan(vk_.vkAllocateMemory(device_, &info, nullptr, &made_memory), "allocating memory");
    at_end([this, made_memory] { vk_.vkFreeMemory(device_, made_memory, nullptr); });
    return made_memory;
  }
  throw std::runtime_error("Vulkan has no memory of the kind that is needed");
}

VulkanBuffer VulkanDevice::make_buffer(size_t size, VkBufferUsageFlags usage, std::span<const uint8_t> bytes,
                                       bool texels) {
  constexpr size_t kTexelBytes = 4 * sizeof(float);
  if (texels && size / kTexelBytes > info_.most_texels)
    throw no_device(info_.line + " reads buffers of " + std::to_string(info_.most_texels) + " texels, and one has " +
                    std::to_string(size / kTexelBytes));
  VulkanBuffer out;
  auto info = typed<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
  info.size = std::max<size_t>(size, 16), info.usage = usage;
  check_vulkan(vk_.vkCreateBuffer(device_, &info, nullptr, &out.buffer), "making a buffer");
  VkMemoryRequirements needs{};
  vk_.vkGetBufferMemoryRequirements(device_, out.buffer, &needs);
  const VkDeviceMemory memory =
      allocate(needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
  check_vulkan(vk_.vkBindBufferMemory(device_, out.buffer, memory, 0), "binding a buffer");
  void* mapped = nullptr;
  check_vulkan(vk_.vkMapMemory(device_, memory, 0, VK_WHOLE_SIZE, 0, &mapped), "mapping a buffer");
  out.bytes = static_cast<uint8_t*>(mapped);
  if (!bytes.empty()) std::memcpy(out.bytes, bytes.data(), bytes.size());
  at_end([this, buffer = out.buffer] { vk_.vkDestroyBuffer(device_, buffer, nullptr); });
  if (!texels) return out;
  auto view = typed<VkBufferViewCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO);
  view.buffer = out.buffer, view.format = VK_FORMAT_R32G32B32A32_SFLOAT, view.range = VK_WHOLE_SIZE;
  check_vulkan(vk_.vkCreateBufferView(device_, &view, nullptr, &out.view), "viewing a buffer");
  at_end([this, made_view = out.view] { vk_.vkDestroyBufferView(device_, made_view, nullptr); });
  return out;
}

VulkanImage VulkanDevice::make_image(VkFormat format, int width, int height, int levels, VkImageUsageFlags usage,
                                     VkImageAspectFlags aspect) {
  if (uint32_t(std::max(width, height)) > info_.largest_image)
    throw no_device(info_.line + " has images of " + std::to_string(info_.largest_image) +
                    " pixels a side, and one is " + std::to_string(width) + 'x' + std::to_string(height));
  VulkanImage out;
  out.aspect = aspect;
  auto info = typed<VkImageCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO);
  info.imageType = VK_IMAGE_TYPE_2D, info.format = format;
  info.extent = {uint32_t(width), uint32_t(height), 1};
  info.mipLevels = uint32_t(levels), info.arrayLayers = 1, info.samples = VK_SAMPLE_COUNT_1_BIT, info.usage = usage;
  check_vulkan(vk_.vkCreateImage(device_, &info, nullptr, &out.image), "making an image");
  at_end([this, image = out.image] { vk_.vkDestroyImage(device_, image, nullptr); });
  VkMemoryRequirements needs{};
  vk_.vkGetImageMemoryRequirements(device_, out.image, &needs);
  check_vulkan(vk_.vkBindImageMemory(device_, out.image, allocate(needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT), 0),
               "binding an image");
  auto view = typed<VkImageViewCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO);
  view.image = out.image, view.viewType = VK_IMAGE_VIEW_TYPE_2D, view.format = format;
  view.subresourceRange = {aspect, 0, uint32_t(levels), 0, 1};
  check_vulkan(vk_.vkCreateImageView(device_, &view, nullptr, &out.view), "viewing an image");
  at_end([this, made_view = out.view] { vk_.vkDestroyImageView(device_, made_view, nullptr); });
  run([&](VkCommandBuffer commands) {
    auto barrier = typed<VkImageMemoryBarrier>(VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER);
    barrier.newLayout = VK_IMAGE_LAYOUT_GENERAL;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = out.image, barrier.subresourceRange = view.subresourceRange;
    barrier.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
    vk_.vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0,
                             nullptr, 0, nullptr, 1, &barrier);
  });
  return out;
}

VulkanImage VulkanDevice::make_picture(Format format, int width, int height) {
  const bool depth = format == Format::d32f || format == Format::d24 || format == Format::d16;
  const VkImageUsageFlags attachment =
      depth ? VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT : VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
  if (!draws_into(vulkan_format(format), depth))
    throw no_device(info_.line + " does not draw into " + std::string(trueshade::info(format).name));
  return make_image(
      vulkan_format(format), width, height, 1,
      attachment | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
      depth ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT);
}

VulkanImage VulkanDevice::make_texture(const Texture& texture) {
  const TextureLevel& first = texture.levels[0];
  const VulkanImage out =
      make_image(texture_format(texture.format), first.width, first.height, int(texture.levels.size()),
                 VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT, VK_IMAGE_ASPECT_COLOR_BIT);
  for (size_t k = 0; k < texture.levels.size(); ++k) {
    const TextureLevel& level = texture.levels[k];
    const VulkanBuffer staging = make_buffer(level.bytes.size(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT, level.bytes);
    run([&](VkCommandBuffer commands) {
      VkBufferImageCopy copy{};
      copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, uint32_t(k), 0, 1};
      copy.imageExtent = {uint32_t(level.width), uint32_t(level.height), 1};
      vk_.vkCmdCopyBufferToImage(commands, staging.buffer, out.image, VK_IMAGE_LAYOUT_GENERAL, 1, &copy);
      order(commands);
    });
  }
  return out;
}

VkSampler VulkanDevice::make_sampler(const Sampler& s, int levels) {
  auto info = typed<VkSamplerCreateInfo>(VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO);
  const auto filter = [](Filter f) { return f == Filter::linear ? VK_FILTER_LINEAR : VK_FILTER_NEAREST; };
  info.magFilter = filter(s.mag_filter), info.minFilter = filter(s.min_filter);
  info.mipmapMode = s.mip_filter == MipFilter::linear ? VK_SAMPLER_MIPMAP_MODE_LINEAR : VK_SAMPLER_MIPMAP_MODE_NEAREST;
  info.addressModeU = address_mode(s.wrap[0]), info.addressModeV = address_mode(s.wrap[1]);
  for (const Wrap wrap : s.wrap)
    if (wrap == Wrap::mirror_clamp_to_edge && !info_.mirrors_once)
      throw no_device(info_.line + " has no samplers that mirror once");
  // Without levels the first alone is read, magnified or not: as Vulkan's manual has it of GL_LINEAR and GL_NEAREST.
  info.mipLodBias = s.lod_bias, info.minLod = std::max(s.lod_min, 0.0f), info.maxLod = std::max(s.lod_max, 0.0f);
  if (s.mip_filter == MipFilter::none) info.minLod = 0.0f, info.maxLod = 0.25f;
  info.maxLod = std::min(info.maxLod, float(levels));
  info.minLod = std::min(info.minLod, info.maxLod);
  info.borderColor = border_of(s);
  VkSampler sampler = VK_NULL_HANDLE;
  check_vulkan(vk_.vkCreateSampler(device_, &info, nullptr, &sampler), "making a sampler");
  at_end([this, sampler] { vk_.vkDestroySampler(device_, sampler, nullptr); });
  return sampler;
}

void VulkanDevice::run(const std::function<void(VkCommandBuffer)>& record) {
  check_vulkan(vk_.vkResetCommandPool(device_, pool_, 0), "starting anew");
  const VkCommandBuffer commands = commands_;
  auto begin = typed<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
  begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  check_vulkan(vk_.vkBeginCommandBuffer(commands, &begin), "beginning");
  record(commands);
  check_vulkan(vk_.vkEndCommandBuffer(commands), "recording");
  auto submit = typed<VkSubmitInfo>(VK_STRUCTURE_TYPE_SUBMIT_INFO);
  submit.commandBufferCount = 1, submit.pCommandBuffers = &commands;
  check_vulkan(vk_.vkQueueSubmit(queue_, 1, &submit, VK_NULL_HANDLE), "submitting");
  check_vulkan(vk_.vkQueueWaitIdle(queue_), "drawing");
}

void VulkanDevice::order(VkCommandBuffer commands) const {
  auto barrier = typed<VkMemoryBarrier>(VK_STRUCTURE_TYPE_MEMORY_BARRIER);
  barrier.srcAccessMask = barrier.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
  vk_.vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                           VK_PIPELINE_STAGE_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &barrier, 0, nullptr,
                           0, nullptr);
}

}  // namespace trueshade::oracle
