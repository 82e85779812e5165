#include "gl/vulkan/functions.h"

#include <dlfcn.h>

#include <cstdlib>
#include <optional>

#include "core/error.h"

namespace trueshade::oracle {

namespace {

/// A variable of the environment that has another value until this ends.
class Setting {
 public:
  Setting(const char* name, const std::string& value) : name_(name) {
    if (const char* const before = std::getenv(name)) before_ = before;
    if (!value.empty()) setenv(name, value.c_str(), 1);
  }
  ~Setting() {
    if (before_)
      setenv(name_, before_->c_str(), 1);
    else
      unsetenv(name_);
  }
  Setting(const Setting&) = delete;
  Setting& operator=(const Setting&) = delete;

 private:
  const char* name_;
  std::optional<std::string> before_;
};

}  // namespace

VkInstance make_instance(VulkanFunctions& functions, const std::string& manifest) {
  const auto no_driver = [](const char* reason) {
    return Error(ErrorKind::no_gl_driver, "Vulkan", reason, "install mesa-vulkan-drivers, or a GPU's driver");
  };
  void* library = dlopen("libvulkan.so.1", RTLD_NOW | RTLD_LOCAL);  // stays open: drivers keep threads
  if (library == nullptr) throw no_driver("there is no libvulkan.so.1");
  const auto get = reinterpret_cast<PFN_vkGetInstanceProcAddr>(dlsym(library, "vkGetInstanceProcAddr"));
  if (get == nullptr) throw no_driver("libvulkan.so.1 is not Vulkan's loader");
  const auto create = reinterpret_cast<PFN_vkCreateInstance>(get(nullptr, "vkCreateInstance"));
  VkApplicationInfo application{};
  application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
  application.apiVersion = VK_API_VERSION_1_3;
  VkInstanceCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
  info.pApplicationInfo = &application;
  VkInstance instance = VK_NULL_HANDLE;
  const Setting files("VK_DRIVER_FILES", manifest), older_name("VK_ICD_FILENAMES", manifest);  // read by the loader
  if (create(&info, nullptr, &instance) != VK_SUCCESS) throw no_driver("no driver gives an instance");
#define LOAD(name) functions.name = reinterpret_cast<PFN_##name>(get(instance, #name));
  TRUESHADE_VULKAN_FUNCTIONS(LOAD)
#undef LOAD
  return instance;
}

}  // namespace trueshade::oracle
