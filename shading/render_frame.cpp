#include <algorithm>
#include <chrono>
#include <optional>

#include "core/error.h"
#include "core/fp_env.h"
#include "scenes/light_shapes.h"
#include "shading/draw_frame.h"
#include "shading/output/derived_planes.h"
#include "shading/output/heat_map.h"
#include "shading/output/light_planes.h"
#include "shading/output/overlay.h"
#include "shading/output/post_frame.h"
#include "shading/output/view_image.h"
#include "shading/picture_region.h"

namespace trueshade {
namespace {

constexpr std::string_view kAovNames[] = {"depth",       "Z",           "position",        "normal",
                                          "albedo",      "specular",    "emission",        "uv",
                                          "id.object",   "id.material", "light.count",     "light.tile",
                                          "light.boxes", "light.edges", "light.intensity", "overdraw"};

bool is_plane(std::string_view name) {
  return light_of_plane(name) || std::find(std::begin(kAovNames), std::end(kAovNames), name) != std::end(kAovNames);
}

void check_planes(std::span<const std::string> names, const Scene& scene) {
  for (const std::string& name : names) {
    if (!is_aov_name(name)) {
      std::string known;
      for (const auto& n : kAovNames) known += std::string(n) + ", ";
      throw Error(ErrorKind::usage, "aov", "there is no plane '" + name + "'", "one or more of " + known + "light.<i>");
    }
    if (const auto light = light_of_plane(name); light && *light >= scene.lights.size())
      throw Error(ErrorKind::usage, "aov",
                  "there is no plane '" + name + "': the scene has " + std::to_string(scene.lights.size()) + " lights",
                  "light.<i> counts from 0");
  }
}

void add_missing(std::vector<std::string>& names, const std::vector<std::string>& more) {
  for (const std::string& name : more)
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

std::vector<std::string> planes_needed(const Pipeline& pipeline, std::span<const std::string> asked) {
  const ImageView view = pipeline.view;
  std::vector<std::string> names(asked.begin(), asked.end());
  add_missing(names, planes_of_view(view));
  if (view == ImageView::lit && pipeline.post.marker_radius > 0.0f) add_missing(names, {"depth"});
  return names;
}

auto named(std::string_view name) {
  return [name](const NamedImage& plane) { return plane.name == name; };
}

const Image* depth_of(std::span<const NamedImage> planes) {
  const auto there = std::find_if(planes.begin(), planes.end(), named("depth"));
  return there == planes.end() ? nullptr : &there->image;
}

Image boxes_view(const Scene& scene, const Pipeline& pipeline, const Execution& execution,
                 std::span<const NamedImage> planes) {
  const Scene boxes = pipeline.view == ImageView::light_boxes ? light_boxes(scene) : light_box_edges(scene);
  const Image boxed = overlay(boxes, pipeline, execution, plane_named(planes, "depth"));
  return boxes_image(boxes, boxed, execution.threads, planes);
}

// The frame drawn at the size of its samples, and the chain upon that.
Image finished_from_samples(const PreparedScene& prepared, const Pipeline& pipeline, const Execution& execution,
                            double mean, const Progress& progress) {
  std::vector<std::string> planes;
  if (pipeline.post.marker_radius > 0.0f) planes.emplace_back("depth");
  const Frame large = draw_frame(prepared, pipeline_before_post(pipeline, execution.region),
                                 execution_before_post(pipeline, execution), planes, true, progress);
  return finished_image(prepared.scene(), pipeline, execution, large.color, depth_of(large.aovs), mean);
}

// The image that a view other than `lit` shows.
void show_view(const Scene& scene, const Pipeline& pipeline, const Execution& execution,
               const std::optional<PictureConstants>& of_picture, std::span<const NamedImage> planes, Frame& frame) {
  if (const std::string_view counts = heat_plane(pipeline.view); !counts.empty()) {
    const Image& counted = plane_named(planes, counts);
    frame.view_scale = of_picture ? of_picture->view_scale : heat_scale(counted);
    frame.color = heat_image(counted, frame.view_scale, execution.threads);
  } else if (shows_boxes(pipeline.view)) {
    frame.color = boxes_view(scene, pipeline, execution, planes);
  } else {
    frame.color = of_picture ? view_image(pipeline.view, execution.threads, planes, of_picture->extents)
                             : view_image(pipeline.view, execution.threads, planes);
  }
}

// What a region needs to know of the picture: as given, or measured. Nothing where the frame itself tells it.
std::optional<PictureConstants> constants_of(const PreparedScene& prepared, const Pipeline& pipeline,
                                             const Execution& execution, const PictureConstants* given) {
  if (execution.region.whole() || !has_constants(pipeline)) return std::nullopt;
  return given != nullptr ? *given : picture_constants(prepared, pipeline, execution);
}

}  // namespace

std::span<const std::string_view> aov_names() { return kAovNames; }

bool is_aov_name(std::string_view name) { return is_plane(name); }

Frame render_frame(const PreparedScene& prepared, const Pipeline& pipeline, const Execution& asked,
                   std::span<const std::string> aovs, const Progress& progress, const PictureConstants* given) {
  const FpScope fp;
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  validate(pipeline);
  validate(asked);
  validate_region(pipeline, asked.region);
  validate_drawn_size(pipeline, asked.region);
  check_planes(aovs, prepared.scene());
  const std::vector<std::string> needed = planes_needed(pipeline, aovs);
  const std::optional<PictureConstants> constants = constants_of(prepared, pipeline, asked, given);
  const double mean = constants ? constants->logarithmic_mean : 0.0;
  Execution execution = asked;
  execution.region = region_to_draw(pipeline, asked.region, needed);
  const bool lit = pipeline.view == ImageView::lit || execution.count_as_gl ||
                   std::any_of(needed.begin(), needed.end(), shows_light);
  Frame frame = draw_frame(prepared, pipeline, execution, planes_to_draw(needed), lit, progress);
  const bool post = pipeline.view == ImageView::lit && pipeline.post.active();
  Image finished;
  if (post)
    finished = pipeline.post.samples > 1
                   ? finished_from_samples(prepared, pipeline, execution, mean, progress)
                   : finished_image(prepared.scene(), pipeline, execution, frame.color, depth_of(frame.aovs), mean);
  std::vector<NamedImage> drawn = std::move(frame.aovs), planes;
  const auto place = [&](const std::string& name) { return std::find_if(drawn.begin(), drawn.end(), named(name)); };
  for (const std::string& name : needed) {
    const bool derived = place(name) == drawn.end();
    planes.push_back(
        {name, derived ? derived_plane(name, prepared.scene(), pipeline, execution, frame.color, drawn) : Image()});
  }
  for (NamedImage& plane : planes) {  // what planes are derived from is taken when all are
    const auto there = place(plane.name);
    if (there == drawn.end()) continue;
    const bool again = std::count_if(planes.begin(), planes.end(), named(plane.name)) > 1;
    plane.image = again ? there->image : std::move(there->image);
  }
  if (pipeline.view != ImageView::lit) show_view(prepared.scene(), pipeline, execution, constants, planes, frame);
  if (post) frame.color = std::move(finished);
  planes.resize(aovs.size());
  frame.color = part_of(std::move(frame.color), execution.region, asked.region);
  for (NamedImage& plane : planes) plane.image = part_of(std::move(plane.image), execution.region, asked.region);
  frame.aovs = std::move(planes);
  frame.stats.total_ms = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
  return frame;
}

Frame render_frame(const Scene& scene, const Pipeline& pipeline, const Execution& execution,
                   std::span<const std::string> aovs, const Progress& progress) {
  return render_frame(PreparedScene(scene), pipeline, execution, aovs, progress);
}

}  // namespace trueshade
