// Pipelines and frames: what is drawn, by which rules, and its planes without a copy.
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <map>
#include <mutex>
#include <thread>

#include "python/binding/bindings.h"
#include "scenes/pipeline/fit_lights.h"
#include "scenes/pipeline/presets.h"
#include "shading/frame.h"
#include "shading/given_surfaces.h"

namespace trueshade::python {
namespace {

/// A frame whose images outlive it as long as arrays show them.
struct PythonFrame {
  std::shared_ptr<const Image> color;
  std::map<std::string, std::shared_ptr<const Image>> planes;
  FrameStats stats;
};

struct Cancelled {};

/// Runs work on a thread of its own while the interpreter's lock is released, and looks for signals meanwhile, so that
/// Ctrl-C ends a long frame. `work` is given what it calls now and then, which throws once the work is to end.
template <class Work>
void run_interruptible(const Work& work) {
  std::atomic<bool> cancelled = false;
  std::exception_ptr failure;
  std::mutex mutex;
  std::condition_variable changed;
  bool is_done = false;
  const Progress watch = [&](int, int) {
    if (cancelled) throw Cancelled{};
  };
  std::thread worker([&] {
    try {
      work(watch);
    } catch (const Cancelled&) {
    } catch (...) {
      failure = std::current_exception();
    }
    const std::lock_guard lock(mutex);
    is_done = true;
    changed.notify_one();
  });
  bool is_interrupted = false;
  {
    const py::gil_scoped_release release;
    std::unique_lock lock(mutex);
    while (!changed.wait_for(lock, std::chrono::milliseconds(50), [&] { return is_done; })) {
      lock.unlock();
      {
        const py::gil_scoped_acquire acquire;
        is_interrupted = is_interrupted || PyErr_CheckSignals() != 0;
      }
      if (is_interrupted) cancelled = true;
      lock.lock();
    }
    lock.unlock();
    worker.join();
  }
  if (is_interrupted) throw py::error_already_set();
  if (failure) std::rethrow_exception(failure);
}

PythonFrame shared(Frame frame) {
  PythonFrame out;
  out.color = std::make_shared<const Image>(std::move(frame.color));
  for (NamedImage& plane : frame.aovs) out.planes[plane.name] = std::make_shared<const Image>(std::move(plane.image));
  out.stats = std::move(frame.stats);
  return out;
}

Execution execution_of(int threads, const std::string& simd) {
  Execution execution;
  execution.threads = threads;
  execution.simd = simd;
  validate(execution);
  return execution;
}

PythonFrame render(const Scene& scene, const py::object& pipeline, const std::vector<std::string>& planes, int threads,
                   const std::string& simd) {
  const Pipeline p = pipeline_for(scene, pipeline);
  const Execution execution = execution_of(threads, simd);
  Frame frame;
  run_interruptible([&](const Progress& watch) {
    validate(scene);
    if (scene.lights_of_ours) {
      Scene fitted = scene;
      fit_lights_of_ours(fitted, p.light_model);
      frame = render_frame(fitted, p, execution, planes, watch);
    } else {
      frame = render_frame(scene, p, execution, planes, watch);
    }
  });
  return shared(std::move(frame));
}

PythonFrame shade(const Scene& scene, const std::map<std::string, py::array>& planes, const py::object& pipeline,
                  int threads, const std::string& simd) {
  Pipeline p = pipeline_for(scene, pipeline);
  std::map<std::string, Image> images;
  for (const auto& [name, array] : planes) images[name] = image_of(array, name);
  const auto plane = [&](const char* name) -> const Image* {
    const auto found = images.find(name);
    return found == images.end() ? nullptr : &found->second;
  };
  GivenSurfaces given;
  given.depth = plane("depth"), given.object = plane("id.object");
  given.position = plane("position"), given.normal = plane("normal"), given.albedo = plane("albedo");
  given.specular = plane("specular"), given.emission = plane("emission");
  given.clear_depth = p.geometry.clear_depth;
  if (given.normal == nullptr) throw bad_argument("planes", "there is no plane normal", "give normal and albedo");
  p.width = given.normal->width, p.height = given.normal->height;
  const Execution execution = execution_of(threads, simd);
  Frame frame;
  run_interruptible([&](const Progress& watch) { frame = light_surfaces(scene, p, execution, given, watch); });
  return shared(std::move(frame));
}

Pipeline make_pipeline(const py::object& preset, const py::object& size, const py::object& strategy,
                       const py::object& target, const py::object& values, const py::object& scene) {
  Pipeline p;
  if (!preset.is_none()) {
    const std::string name = preset.cast<std::string>();
    const auto found = preset_pipeline(name);
    if (!found) {
      std::string names;
      for (const Preset& known : presets()) names += (names.empty() ? "" : ", ") + std::string(known.name);
      throw bad_argument("preset", "there is no preset '" + name + "'", "one of: " + names);
    }
    p = *found;
  } else if (!scene.is_none()) {
    p = pipeline_for(scene.cast<const Scene&>(), py::none());
  } else {
    p = presets().front().pipeline;
  }
  if (!values.is_none()) {
    const std::string text = py::isinstance<py::str>(values)
                                 ? values.cast<std::string>()
                                 : py::module_::import("json").attr("dumps")(values).cast<std::string>();
    p = pipeline_from_json(text, "values", p);
  }
  py::dict given;
  if (!strategy.is_none()) given["strategy"] = strategy;
  if (!target.is_none()) given["target"] = target;
  if (given.size() > 0)
    p = pipeline_from_json(py::module_::import("json").attr("dumps")(given).cast<std::string>(), "pipeline", p);
  if (!size.is_none()) {
    const std::vector<double> wh = numbers_of(size, "size", 2);
    for (const double side : wh)
      if (!(side >= 1 && side <= 65536) || side != double(int(side)))
        throw bad_argument("size", "a side is no whole number from 1 to 65536", "(width, height) in pixels");
    p.width = int(wh[0]), p.height = int(wh[1]);
  }
  validate(p);
  return p;
}

py::dict stats_of(const PythonFrame& frame) {
  const FrameStats& s = frame.stats;
  py::dict out;
  out["pixels"] = s.pixels, out["covered_pixels"] = s.covered_pixels, out["lit_pixel_lights"] = s.lit_pixel_lights;
  out["triangles"] = s.triangles, out["lights"] = s.lights, out["fragments"] = s.fragments;
  out["total_ms"] = s.total_ms;
  return out;
}

py::dict planes_of(const PythonFrame& frame) {
  py::dict out;
  for (const auto& [name, image] : frame.planes) out[py::str(name)] = array_of(image);
  return out;
}

}  // namespace

Pipeline pipeline_for(const Scene& scene, const py::object& pipeline) {
  if (!pipeline.is_none()) return pipeline.cast<Pipeline>();
  Pipeline p = default_pipeline(scene);
  if (!scene.pipeline_text.empty()) p = pipeline_from_json(scene.pipeline_text, scene.spec + ": /pipeline", p);
  return p;
}

void add_pipeline(py::module_& module) {
  using namespace py::literals;
  py::class_<Pipeline>(module, "Pipeline")
      .def(py::init(&make_pipeline), "preset"_a = py::none(), py::kw_only(), "size"_a = py::none(),
           "strategy"_a = py::none(), "target"_a = py::none(), "values"_a = py::none(), "scene"_a = py::none())
      .def_property_readonly("size", [](const Pipeline& p) { return py::make_tuple(p.width, p.height); })
      .def_property_readonly("preset", [](const Pipeline& p) { return p.preset; })
      .def_property_readonly("strategy", [](const Pipeline& p) { return std::string(name_of(p.strategy)); })
      .def_property_readonly("target", [](const Pipeline& p) { return std::string(info(p.target).name); })
      .def("to_json", [](const Pipeline& p) { return pipeline_json(p); })
      .def("to_dict", [](const Pipeline& p) { return from_json(pipeline_json(p)); })
      .def("__eq__", [](const Pipeline& a, const Pipeline& b) { return a == b; })
      .def("__repr__", [](const Pipeline& p) {
        return "<trueshade.Pipeline " + p.preset + ", " + std::string(name_of(p.strategy)) + ", " +
               std::to_string(p.width) + "x" + std::to_string(p.height) + ", " + std::string(info(p.target).name) + ">";
      });
  module.def("presets", [] {
    std::vector<std::string> names;
    for (const Preset& preset : presets()) names.emplace_back(preset.name);
    return names;
  });
  module.def("strategies",
             [] { return std::vector<std::string>(std::begin(kStrategyNames), std::end(kStrategyNames)); });
}

void add_frame(py::module_& module) {
  using namespace py::literals;
  py::class_<PythonFrame>(module, "Frame")
      .def_property_readonly("color", [](const PythonFrame& f) { return array_of(f.color); })
      .def_property_readonly("planes", &planes_of)
      .def_property_readonly("format", [](const PythonFrame& f) { return std::string(info(f.color->format).name); })
      .def_property_readonly("hash", [](const PythonFrame& f) { return "sha256:" + image_hash(*f.color); })
      .def_property_readonly("stats", &stats_of)
      .def("__repr__", [](const PythonFrame& f) {
        return "<trueshade.Frame " + std::to_string(f.color->width) + "x" + std::to_string(f.color->height) + " " +
               std::string(info(f.color->format).name) + ">";
      });
  module.def("render", &render, "scene"_a, "pipeline"_a = py::none(), py::kw_only(),
             "planes"_a = std::vector<std::string>{}, "threads"_a = 0, "simd"_a = "best");
  module.def("shade", &shade, "scene"_a, "planes"_a, "pipeline"_a = py::none(), py::kw_only(), "threads"_a = 0,
             "simd"_a = "best");
  module.def(
      "image_hash",
      [](const py::array& image, const std::string& format) {
        return "sha256:" + image_hash(image_of(image, "image", format));
      },
      "image"_a, "format"_a = "");
}

}  // namespace trueshade::python
