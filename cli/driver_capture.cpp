#include "cli/driver_capture.h"

#include <algorithm>
#include <cstring>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "gl/driver/context.h"
#include "gl/driver/renderer.h"
#include "scenes/pipeline/transparency.h"

namespace trueshade {
namespace {

oracle::GlDriver driver_named(std::string_view name) {
  if (name == "llvmpipe") return oracle::GlDriver::llvmpipe;
  if (name == "softpipe") return oracle::GlDriver::softpipe;
  return oracle::GlDriver::any;
}

constexpr size_t kRepeats = 9;
constexpr double kBudgetMs = 2000.0;

double total_ms(const std::vector<oracle::GlPass>& passes) {
  double total = 0.0;
  for (const oracle::GlPass& pass : passes) total += pass.ms;
  return total;
}

void mark_changes(const Image& a, const Image& b, std::vector<bool>& changed) {
  const size_t texel = size_t(info(a.format).bytes_per_texel());
  for (size_t i = 0; i < changed.size(); ++i)
    if (std::memcmp(&a.texels[i * texel], &b.texels[i * texel], texel) != 0) changed[i] = true;
}

/// How many pixels differ in a bit between two captures of one driver, without those that a's mask leaves out.
uint64_t changed_pixels(const oracle::Capture& a, const oracle::Capture& b) {
  std::vector<bool> changed(size_t(a.color.width) * size_t(a.color.height));
  mark_changes(a.color, b.color, changed);
  for (size_t i = 0; i < a.planes.size(); ++i) mark_changes(a.planes[i].image, b.planes[i].image, changed);
  for (size_t i = 0; i < changed.size(); ++i)
    if (a.mask.has(i)) changed[i] = false;
  return uint64_t(std::count(changed.begin(), changed.end(), true));
}

/// Draws up to kRepeats frames within the budget, and returns the passes of the one of median time; `first` where the
/// first frame has used the budget up. `frames` receives how many frames the median is of.
std::vector<oracle::GlPass> timed_passes(oracle::GlRenderer& renderer, const Pipeline& pipeline,
                                         const std::vector<oracle::GlPass>& first, int& frames) {
  frames = 1;
  std::vector<std::vector<oracle::GlPass>> repeated;
  double spent_ms = total_ms(first);
  while (repeated.size() < kRepeats && spent_ms < kBudgetMs) {
    repeated.push_back(renderer.draw(pipeline).passes);
    spent_ms += total_ms(repeated.back());
  }
  if (repeated.empty()) return first;
  frames = int(repeated.size());
  const auto middle = repeated.begin() + std::ptrdiff_t(repeated.size() / 2);
  std::nth_element(repeated.begin(), middle, repeated.end(),
                   [](const auto& a, const auto& b) { return total_ms(a) < total_ms(b); });
  return *middle;
}

oracle::GlDraw moved() {
  oracle::GlDraw draw;
  draw.shift_x = 64;
  draw.shift_y = 32;
  return draw;
}

/// A driver and a scene on it.
struct Session {
  Session(std::string_view driver, const Scene& scene) : context(driver_named(driver)), renderer(context, scene) {}
  oracle::GlContext context;
  oracle::GlRenderer renderer;
  std::optional<oracle::Capture> stepped;  ///< the frame whose lights were watched
};

oracle::LightSteps steps_of(const std::shared_ptr<Session>& session, const Pipeline& pipeline) {
  return [session, pipeline](const oracle::StepSink& sink) {
    oracle::GlDraw draw;
    draw.after_light = sink;
    session->stepped = session->renderer.draw(pipeline, draw).capture;
  };
}

oracle::LightSteps objects_of(const std::shared_ptr<Session>& session, const Pipeline& pipeline) {
  return [session, pipeline](const oracle::StepSink& sink) {
    oracle::GlDraw draw;
    draw.after_object = sink;
    session->renderer.draw(pipeline, draw);
  };
}

}  // namespace

DriverFrame drawn_by_driver(std::string_view driver, const Scene& scene, const Pipeline& pipeline) {
  const auto session = std::make_shared<Session>(driver, scene);
  const oracle::GlContext& context = session->context;
  oracle::GlRenderer& renderer = session->renderer;
  oracle::GlFrame frame = renderer.draw(pipeline);
  DriverFrame drawn;
  drawn.capture = std::move(frame.capture);
  drawn.subpixel_bits = context.info().subpixel_bits;
  drawn.notes = std::move(frame.notes);
  // A target that is read between its lights may become another (softpipe's does): then it is no repeated frame.
  drawn.repeat_changes = [session, pipeline](const oracle::Capture& first) {
    const bool known = session->stepped && changed_pixels(first, *session->stepped) == 0;
    return known ? 0 : changed_pixels(first, session->renderer.draw(pipeline).capture);
  };
  drawn.move_changes = [session, pipeline](const oracle::Capture& first) {
    return changed_pixels(first, session->renderer.draw(pipeline, moved()).capture);
  };
  for (const oracle::GlPass& pass : timed_passes(renderer, pipeline, frame.passes, drawn.timed_frames))
    drawn.passes.push_back({pass.name, pass.ms});
  if (blends_lights(pipeline.strategy)) drawn.steps = steps_of(session, pipeline);
  if (draws_transparent(scene, pipeline)) drawn.objects = objects_of(session, pipeline);
  return drawn;
}

}  // namespace trueshade
