// Judging and explaining.
#include <optional>

#include "cli/capture/stored_planes.h"
#include "cli/judged_mask.h"
#include "explain/explain.h"
#include "judge/bounds/profile_names.h"
#include "judge/stages/validate.h"
#include "python/binding/bindings.h"
#include "python/binding/interruptible.h"
#include "python/binding/python_pipeline.h"
#include "python/binding/python_scene.h"
#include "shading/frame.h"

namespace trueshade::python {
namespace {

oracle::Profile profile_of(const std::string& name, const std::optional<int>& subpixel_bits) {
  auto profile = oracle::profile_named(name);
  if (!profile) {
    std::string names;
    for (const std::string_view known : oracle::kDriverProfileNames)
      names += (names.empty() ? "" : ", ") + std::string(known);
    throw bad_argument("profile", "there is no profile '" + name + "'", "one of: " + names);
  }
  if (subpixel_bits) profile->subpixel_bits = int(number_within(*subpixel_bits, "subpixel_bits", 4, 16));
  return *profile;
}

oracle::Capture capture_of(const py::object& image, const py::dict& planes, const Pipeline& pipeline) {
  oracle::Capture capture;
  capture.driver = "python", capture.name = "capture";
  if (!image.is_none()) {
    const py::array array = array_from(image, "image");
    const bool is_packed = info(pipeline.target).packed();
    capture.color = image_of(array, "image", is_packed ? std::string(info(pipeline.target).name) : std::string(),
                             ImageUse::picture);
    capture.has_alpha = is_packed || channels_of(array) == 4;
  }
  for (const auto& [name, array] : planes) {
    const std::string key = py::str(name);
    if (!is_aov_name(key))
      throw bad_argument("planes", "there is no plane '" + key + "'", "names as render() has them");
    capture.planes.push_back({key, image_of(array, key)});
  }
  if (capture.color.width == 0 && capture.planes.empty())
    throw bad_argument("image", "there is neither an image nor a plane", "pass what is to be judged");
  return capture;
}

py::object validate_image(PythonScene& scene, const py::object& image, const py::dict& planes,
                          const py::object& pipeline, const std::string& profile,
                          const std::optional<int>& subpixel_bits, double significance, const py::object& mask,
                          bool allow_mask) {
  Pipeline p = pipeline_for(scene.values(), pipeline);
  oracle::Capture capture = capture_of(image, planes, p);
  const Image& first = capture.color.width > 0 ? capture.color : capture.planes.front().image;
  p.width = first.width, p.height = first.height;
  oracle::ValidateOptions options;
  options.profile = profile_of(profile, subpixel_bits);
  options.significance = number_within(significance, "significance", 0, 1);
  const std::optional<PictureFile> mask_file = mask_picture(mask);
  const PythonScene::Reading reading(scene);
  std::string verdict;
  run_interruptible([&](const auto& watch) {
    options.begins = [&](const char*) { watch(); };
    validate(scene.values());
    store_as(p, capture);
    const FittedScene fitted(scene.values(), p);
    if (mask_file)
      capture.mask = judged_mask({mask_file->path, {}, "pass allow_mask=True", allow_mask}, &*mask_file,
                                 fitted.values(), p, capture);
    verdict = oracle::verdict_json(oracle::validate_capture(fitted.values(), p, capture, options));
  });
  return from_json(verdict);
}

py::object explain_pixel(PythonScene& scene, int x, int y, const py::object& pipeline, bool everything) {
  const Pipeline p = pipeline_for(scene.values(), pipeline);
  const PythonScene::Reading reading(scene);
  std::string account;
  run_interruptible([&](const auto&) {
    validate(scene.values());
    const FittedScene fitted(scene.values(), p);
    const ExplainedFrame frame(fitted.values(), p);
    account = account_json(account_of(frame, history_of(frame, x, y), everything ? Detail::all : Detail::usual));
  });
  return from_json(account);
}

}  // namespace

void add_judge(py::module_& module) {
  using namespace py::literals;
  module.def("validate", &validate_image, doc_of("validate"), "scene"_a.none(false), "image"_a, "planes"_a,
             "pipeline"_a = py::none(), py::kw_only(), "profile"_a = "unknown", "subpixel_bits"_a = py::none(),
             "significance"_a = 1e-6, "mask"_a = py::none(), "allow_mask"_a = false);
  module.def("explain", &explain_pixel, doc_of("explain"), "scene"_a.none(false), "x"_a, "y"_a,
             "pipeline"_a = py::none(), py::kw_only(), "everything"_a = false);
}

}  // namespace trueshade::python
