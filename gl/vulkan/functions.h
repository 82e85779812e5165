#pragma once
#define VK_NO_PROTOTYPES
#include <vulkan/vulkan.h>

#include <string>

namespace trueshade::oracle {

// The functions that Vulkan hands out for an instance. Each is a member that has the function's name.
#define TRUESHADE_VULKAN_FUNCTIONS(X)                                                                                  \
  X(vkDestroyInstance)                                                                                                 \
  X(vkEnumeratePhysicalDevices) X(vkGetPhysicalDeviceProperties) X(vkGetPhysicalDeviceFeatures2)                       \
      X(vkGetPhysicalDeviceMemoryProperties) X(vkGetPhysicalDeviceFormatProperties)                                    \
          X(vkEnumerateDeviceExtensionProperties) X(vkGetPhysicalDeviceQueueFamilyProperties) X(vkCreateDevice)        \
              X(vkDestroyDevice) X(vkGetDeviceQueue) X(vkCreateCommandPool) X(vkDestroyCommandPool)                    \
                  X(vkAllocateCommandBuffers) X(vkBeginCommandBuffer) X(vkEndCommandBuffer) X(vkQueueSubmit)           \
                      X(vkQueueWaitIdle) X(vkCreateBuffer) X(vkDestroyBuffer) X(vkGetBufferMemoryRequirements) X(      \
                          vkAllocateMemory) X(vkFreeMemory) X(vkBindBufferMemory) X(vkMapMemory) X(vkCreateBufferView) \
                          X(vkDestroyBufferView) X(vkCreateImage) X(vkDestroyImage) X(vkGetImageMemoryRequirements)    \
                              X(vkBindImageMemory) X(vkCreateImageView) X(vkDestroyImageView) X(vkCreateSampler)       \
                                  X(vkDestroySampler) X(vkCreateShaderModule) X(vkDestroyShaderModule)                 \
                                      X(vkCreateDescriptorSetLayout) X(vkDestroyDescriptorSetLayout)                   \
                                          X(vkCreatePipelineLayout) X(vkDestroyPipelineLayout)                         \
                                              X(vkCreateGraphicsPipelines) X(vkDestroyPipeline)                        \
                                                  X(vkCreateDescriptorPool) X(vkDestroyDescriptorPool)                 \
                                                      X(vkAllocateDescriptorSets) X(vkUpdateDescriptorSets)            \
                                                          X(vkCmdPipelineBarrier) X(vkCmdClearColorImage)              \
                                                              X(vkCmdClearDepthStencilImage) X(vkCmdCopyBufferToImage) \
                                                                  X(vkCmdCopyImageToBuffer) X(vkCmdBeginRendering)     \
                                                                      X(vkCmdEndRendering) X(vkCmdBindPipeline)        \
                                                                          X(vkCmdBindDescriptorSets)                   \
                                                                              X(vkCmdBindVertexBuffers)                \
                                                                                  X(vkCmdBindIndexBuffer) X(vkCmdDraw) \
                                                                                      X(vkCmdDrawIndexed)              \
                                                                                          X(vkResetCommandPool)

struct VulkanFunctions {
#define MEMBER(name) PFN_##name name = nullptr;
  TRUESHADE_VULKAN_FUNCTIONS(MEMBER)
#undef MEMBER
};

/// Makes an instance of Vulkan 1.3 and loads its functions. Error(no_gl_driver) where there is no libvulkan.so.1.
///   manifest: the file of the one driver that the loader is to open; empty: all drivers that it knows
VkInstance make_instance(VulkanFunctions& functions, const std::string& manifest);

/// A Vulkan structure with its sType set and everything else zero.
template <typename T>
T typed(VkStructureType type) {
  T value{};
  value.sType = type;
  return value;
}

}  // namespace trueshade::oracle
