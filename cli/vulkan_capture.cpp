#include "cli/vulkan_capture.h"

#include <cstring>
#include <utility>

#include "gl/vulkan/vulkan_renderer.h"
#include "scenes/pipeline/transparency.h"

namespace trueshade {
namespace {

/// How many pixels differ in a bit between two captures.
uint64_t differing_pixels(const oracle::Capture& a, const oracle::Capture& b) {
  std::vector<bool> differs(size_t(a.color.width) * size_t(a.color.height));
  const auto mark = [&](const Image& x, const Image& y) {
    const size_t texel = size_t(info(x.format).bytes_per_texel());
    for (size_t i = 0; i < differs.size(); ++i)
      if (std::memcmp(&x.texels[i * texel], &y.texels[i * texel], texel) != 0) differs[i] = true;
  };
  mark(a.color, b.color);
  for (size_t i = 0; i < a.planes.size(); ++i) mark(a.planes[i].image, b.planes[i].image);
  uint64_t count = 0;
  for (const bool d : differs) count += d ? 1 : 0;
  return count;
}

oracle::VulkanDriver driver_of(const std::string& name) {
  if (name == "swiftshader") return oracle::VulkanDriver::swiftshader;
  return name == "lavapipe" ? oracle::VulkanDriver::software : oracle::VulkanDriver::first;
}

}  // namespace

DriverFrame drawn_by_vulkan_device(const std::string& name, const Scene& scene, const Pipeline& pipeline) {
  const oracle::VulkanDriver driver = driver_of(name);
  oracle::VulkanFrame frame = oracle::drawn_by_vulkan(scene, pipeline, driver);
  DriverFrame drawn;
  drawn.capture = std::move(frame.capture);
  drawn.subpixel_bits = frame.subpixel_bits;
  drawn.notes = std::move(frame.notes);
  drawn.timed_frames = 1;
  drawn.passes = {{"frame", frame.ms}};
  const auto again = [&scene, pipeline, driver](const oracle::VulkanDraw& draw) {
    return oracle::drawn_by_vulkan(scene, pipeline, driver, draw).capture;
  };
  drawn.repeat_changes = [again](const oracle::Capture& first) { return differing_pixels(first, again({})); };
  if (blends_lights(pipeline.strategy)) drawn.steps = [again](const oracle::StepSink& sink) { again({sink, {}}); };
  if (draws_transparent(scene, pipeline)) drawn.objects = [again](const oracle::StepSink& sink) { again({{}, sink}); };
  return drawn;
}

}  // namespace trueshade
