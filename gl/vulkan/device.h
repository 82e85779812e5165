#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/format.h"
#include "gl/vulkan/functions.h"
#include "scenes/texture.h"

namespace trueshade::oracle {

struct VulkanBuffer {
  VkBuffer buffer = VK_NULL_HANDLE;
  VkBufferView view = VK_NULL_HANDLE;  ///< of RGBA32F texels
  uint8_t* bytes = nullptr;            ///< where the host sees it
};

struct VulkanImage {
  VkImage image = VK_NULL_HANDLE;
  VkImageView view = VK_NULL_HANDLE;
  VkImageAspectFlags aspect = VK_IMAGE_ASPECT_COLOR_BIT;
};

/// Which of the machine's devices to open.
enum class VulkanDriver : uint8_t {
  first,        ///< of Vulkan 1.3 that draws
  software,     ///< the first that is a CPU: lavapipe, say
  swiftshader,  ///< of the files that VK_DRIVER_FILES names, or of Chromium's or Chrome's own
};

/// What a device is and can do.
struct VulkanInfo {
  std::string line;  ///< its name, driver and version
  int subpixel_bits = 0;
  bool primitive_ids = false;  ///< fragment shaders may read gl_PrimitiveID
  bool clip_control = false;   ///< z may run from -w to w (VK_EXT_depth_clip_control)
  bool last_provokes = false;  ///< flat attributes may follow the last vertex (VK_EXT_provoking_vertex)
  bool mirrors_once = false;   ///< samplers may mirror once
  uint32_t largest_image = 0;  ///< pixels a side
  uint32_t most_texels = 0;    ///< of a buffer that shaders read as texels
};

VkFormat vulkan_format(Format format);

/// A Vulkan device without a window, with one queue. It owns what is made on it.
class VulkanDevice {
 public:
  /// Opens the device. Error(no_gl_driver), which says what is missing, where there is none.
  explicit VulkanDevice(VulkanDriver driver);
  VulkanDevice(const VulkanDevice&) = delete;
  VulkanDevice& operator=(const VulkanDevice&) = delete;

  const VulkanInfo& info() const { return info_; }
  const VulkanFunctions& vk() const { return vk_; }
  VkDevice device() const { return device_; }
  bool draws_into(VkFormat format, bool depth) const;
  /// Throws Error(no_gl_driver) where the device does not blend into the format.
  void check_blends(VkFormat format, const std::string& picture) const;

  VulkanBuffer make_buffer(size_t size, VkBufferUsageFlags usage, std::span<const uint8_t> bytes, bool texels = false);
  VulkanImage make_picture(Format format, int width, int height);
  VulkanImage make_texture(const Texture& texture);
  VkSampler make_sampler(const Sampler& sampler, int levels);

  /// Records commands by `record`, executes them, and waits until they are done.
  void run(const std::function<void(VkCommandBuffer)>& record);
  /// Adds a barrier: all commands after it see what all commands before it wrote.
  void order(VkCommandBuffer commands) const;
  /// Calls `destroy` when the device is destroyed; calls made later come first.
  void at_end(std::function<void()> destroy) { at_end_.destroy.push_back(std::move(destroy)); }

 private:
  struct AtEnd {
    std::vector<std::function<void()>> destroy;
    ~AtEnd();
  };
  void open_device();
  VkDeviceMemory allocate(const VkMemoryRequirements& needs, VkMemoryPropertyFlags wanted);
  VulkanImage make_image(VkFormat format, int width, int height, int levels, VkImageUsageFlags usage,
                         VkImageAspectFlags aspect);

  VulkanFunctions vk_;
  VulkanInfo info_;
  VkInstance instance_ = VK_NULL_HANDLE;
  VkPhysicalDevice physical_ = VK_NULL_HANDLE;
  VkDevice device_ = VK_NULL_HANDLE;
  VkQueue queue_ = VK_NULL_HANDLE;
  VkCommandPool pool_ = VK_NULL_HANDLE;
  uint32_t family_ = 0;
  VkCommandBuffer commands_ = VK_NULL_HANDLE;
  AtEnd at_end_;  ///< last, and a member, so that it runs first, and where the constructor throws too
};

/// Throws std::runtime_error, naming `where`, if a Vulkan call did not succeed.
void check_vulkan(VkResult result, const char* where);

}  // namespace trueshade::oracle
