// Judging and explaining.
#include <map>

#include "explain/explain.h"
#include "judge/bounds/profile_names.h"
#include "judge/stages/validate.h"
#include "python/binding/bindings.h"

namespace trueshade::python {
namespace {

oracle::Profile profile_of(const std::string& name) {
  if (const auto profile = oracle::profile_named(name)) return *profile;
  std::string names;
  for (const std::string_view known : oracle::kDriverProfileNames)
    names += (names.empty() ? "" : ", ") + std::string(known);
  throw bad_argument("profile", "there is no profile '" + name + "'", "one of: " + names);
}

py::object validate_image(const Scene& scene, const py::array& image, const std::map<std::string, py::array>& planes,
                          const py::object& pipeline, const std::string& profile, double significance) {
  Pipeline p = pipeline_for(scene, pipeline);
  oracle::Capture capture;
  capture.driver = "python";
  capture.color = image_of(image, "image", std::string(info(p.target).name));
  for (const auto& [name, array] : planes) capture.planes.push_back({name, image_of(array, name)});
  p.width = capture.color.width, p.height = capture.color.height;
  oracle::ValidateOptions options;
  options.profile = profile_of(profile);
  options.significance = significance;
  std::string verdict;
  {
    const py::gil_scoped_release release;
    verdict = oracle::verdict_json(oracle::validate_capture(scene, p, capture, options));
  }
  return from_json(verdict);
}

py::object explain_pixel(const Scene& scene, int x, int y, const py::object& pipeline, bool everything) {
  const Pipeline p = pipeline_for(scene, pipeline);
  std::string account;
  {
    const py::gil_scoped_release release;
    const ExplainedFrame frame(scene, p);
    account = account_json(account_of(frame, history_of(frame, x, y), everything ? Detail::all : Detail::usual));
  }
  return from_json(account);
}

}  // namespace

void add_judge(py::module_& module) {
  using namespace py::literals;
  module.def("validate", &validate_image, "scene"_a, "image"_a, "planes"_a, "pipeline"_a = py::none(), py::kw_only(),
             "profile"_a = "unknown", "significance"_a = 1e-6);
  module.def("explain", &explain_pixel, "scene"_a, "x"_a, "y"_a, "pipeline"_a = py::none(), py::kw_only(),
             "everything"_a = false);
}

}  // namespace trueshade::python
