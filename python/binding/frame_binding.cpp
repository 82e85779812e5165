// Frames: drawn or lit, and their planes without a copy.
#include <map>
#include <utility>

#include "cli/json_text.h"
#include "cli/version.h"
#include "core/image_files/image_io.h"
#include "core/memory_cap.h"
#include "python/binding/bindings.h"
#include "python/binding/interruptible.h"
#include "python/binding/python_pipeline.h"
#include "python/binding/python_scene.h"
#include "scenes/files/content/faults.h"
#include "shading/frame_memory.h"
#include "shading/given_surfaces.h"

namespace trueshade::python {
namespace {

/// A frame whose images outlive it as long as arrays show them.
struct PythonFrame {
  std::shared_ptr<const Image> color;
  std::vector<std::pair<std::string, std::shared_ptr<const Image>>> planes;  ///< in the order asked for
  FrameStats stats;
  Pipeline pipeline;
  uint32_t view_scale = 0;
  std::shared_ptr<PythonScene> scene;
  uint64_t scene_version = 0;
};

PythonFrame shared(Frame frame, Pipeline pipeline, std::shared_ptr<PythonScene> scene, uint64_t scene_version) {
  PythonFrame out;
  out.color = std::make_shared<const Image>(std::move(frame.color));
  for (NamedImage& plane : frame.aovs)
    out.planes.emplace_back(plane.name, std::make_shared<const Image>(std::move(plane.image)));
  out.stats = std::move(frame.stats);
  out.pipeline = std::move(pipeline);
  out.view_scale = frame.view_scale;
  out.scene = std::move(scene), out.scene_version = scene_version;
  return out;
}

Execution execution_of(int threads, const std::string& simd) {
  Execution execution;
  execution.threads = threads;
  execution.simd = simd;
  validate(execution);
  return execution;
}

/// Error(out_of_memory) before the system ends the process for a frame that the machine cannot hold.
void check_memory(const Scene& scene, const Pipeline& pipeline, const Execution& execution,
                  const std::vector<std::string>& planes) {
  const uint64_t needed = predicted_memory(scene, pipeline, execution, planes);
  if (resident_memory() + needed > available_memory())
    throw Error(ErrorKind::out_of_memory, "memory",
                "the frame takes " + std::to_string(needed >> 20) + " MiB, and this process may have " +
                    std::to_string(available_memory() >> 20) + " MiB",
                "draw a smaller one, or fewer planes");
}

std::vector<std::string> plane_names(const py::object& planes) {
  if (py::isinstance<py::str>(planes))
    throw bad_argument("planes", "it is a str", "pass a list of names, such as ['depth', 'normal']");
  std::vector<std::string> names;
  try {
    names = planes.cast<std::vector<std::string>>();
  } catch (const py::cast_error&) {
    throw bad_argument("planes", "it is no list of names", "such as ['depth', 'normal']");
  }
  for (const std::string& name : names)
    if (!is_aov_name(name)) {
      std::string known;
      for (const std::string_view plane : aov_names()) known += std::string(plane) + ", ";
      throw bad_argument("planes", "there is no plane '" + name + "'", "one of: " + known + "light.0, light.1, ...");
    }
  return names;
}

PythonFrame render(const std::shared_ptr<PythonScene>& scene, const py::object& pipeline, const py::object& planes,
                   int threads, const std::string& simd) {
  const std::vector<std::string> names = plane_names(planes);
  const Pipeline p = pipeline_for(scene->values(), pipeline);
  const Execution execution = execution_of(threads, simd);
  check_memory(scene->values(), p, execution, names);
  const PythonScene::Reading reading(*scene);
  Frame frame;
  run_interruptible([&](const auto& watch) {
    const auto prepared = scene->prepared(p);
    frame = render_frame(*prepared, p, execution, names, [&](int, int) { watch(); });
  });
  return shared(std::move(frame), p, scene, scene->version());
}

/// The planes of a G-buffer that light_surfaces() reads, by their names.
GivenSurfaces surfaces_of(const std::map<std::string, Image>& images) {
  GivenSurfaces given;
  for (const auto& [name, image] : images) {
    if (name == "depth") given.depth = &image;
    if (name == "id.object") given.object = &image;
    if (name == "position") given.position = &image;
    if (name == "normal") given.normal = &image;
    if (name == "albedo") given.albedo = &image;
    if (name == "specular") given.specular = &image;
    if (name == "emission") given.emission = &image;
    if (name == "metallic") given.metallic = &image;
    if (name == "roughness") given.roughness = &image;
    if (name == "occlusion") given.occlusion = &image;
    if (name == "id.material") given.material = &image;
    if (name == "uv") given.uv = &image;
    if (name == "uv1") given.uv1 = &image;
    if (name == "tangent") given.tangent = &image;
    for (size_t i = 0; i < 4; ++i)
      if (name == "user" + std::to_string(i)) given.user[i] = &image;
  }
  if (given.normal == nullptr)
    throw bad_argument("planes", "there is no plane normal", "give normal and albedo, and position or depth");
  return given;
}

PythonFrame shade(const std::shared_ptr<PythonScene>& scene, const py::dict& planes, const py::object& pipeline,
                  int threads, const std::string& simd) {
  Pipeline p = pipeline_for(scene->values(), pipeline);
  std::map<std::string, Image> images;
  for (const auto& [name, array] : planes) {
    const std::string key = py::str(name);
    images[key] = image_of(array, key);
  }
  GivenSurfaces given = surfaces_of(images);
  given.clear_depth = p.geometry.clear_depth;
  p.width = given.normal->width, p.height = given.normal->height;
  const Execution execution = execution_of(threads, simd);
  check_memory(scene->values(), p, execution, {});
  const PythonScene::Reading reading(*scene);
  Frame frame;
  run_interruptible([&](const auto& watch) {
    validate(scene->values());
    const FittedScene fitted(scene->values(), p);
    frame = light_surfaces(fitted.values(), p, execution, given, [&](int, int) { watch(); });
  });
  return shared(std::move(frame), p, scene, scene->version());
}

/// What files of the command carry, so that a file of this frame is the command's byte by byte. A scene that was
/// changed after the frame is not named.
Metadata metadata_of(const PythonFrame& frame) {
  Metadata metadata = {{"trueshade:imageHash", "sha256:" + image_hash(*frame.color)},
                       {"trueshade:pipeline", pipeline_json(frame.pipeline)}};
  if (frame.scene->version() == frame.scene_version) {
    const Scene& scene = frame.scene->values();
    metadata.emplace_back("trueshade:scene", scene.spec);
    metadata.emplace_back("trueshade:sceneHash", frame.scene->hash());
    if (!scene.timeline.empty()) metadata.emplace_back("trueshade:time", json_number(frame.scene->time()));
  }
  if (std::string text = lenient_text(frame.scene->values()); !text.empty())
    metadata.emplace_back(kLenientKey, std::move(text));
  metadata.emplace_back("trueshade:version", kVersion);
  if (frame.view_scale > 0) metadata.emplace_back("trueshade:viewScale", std::to_string(frame.view_scale));
  return metadata;
}

void save(const PythonFrame& frame, const py::object& path) {
  const std::string to = path_of(path);
  const PythonScene::Reading reading(*frame.scene);
  const py::gil_scoped_release release;
  std::vector<NamedImage> planes;
  for (const auto& [name, image] : frame.planes) planes.push_back({name, *image});
  ImageFileOptions options;
  if (frame.pipeline.view != ImageView::lit || frame.pipeline.post.encode == PostChain::Encode::srgb)
    options.values = PictureValues::display_codes;
  write_image(to, *frame.color, planes, metadata_of(frame), options);
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

std::string described(const PythonFrame& frame) {
  return "<trueshade.Frame " + std::to_string(frame.color->width) + "x" + std::to_string(frame.color->height) + " " +
         std::string(info(frame.color->format).name) + ">";
}

std::string hash_of(const Image& image) {
  const py::gil_scoped_release release;
  return "sha256:" + image_hash(image);
}

}  // namespace

void add_frame(py::module_& module) {
  using namespace py::literals;
  py::class_<PythonFrame>(module, "Frame", doc_of("Frame"))
      .def_property_readonly(
          "color", [](const PythonFrame& f) { return array_of(f.color); }, doc_of("Frame.color"))
      .def_property_readonly("planes", &planes_of, doc_of("Frame.planes"))
      .def_property_readonly(
          "format", [](const PythonFrame& f) { return std::string(info(f.color->format).name); },
          doc_of("Frame.format"))
      .def_property_readonly(
          "hash", [](const PythonFrame& f) { return hash_of(*f.color); }, doc_of("Frame.hash"))
      .def_property_readonly("stats", &stats_of, doc_of("Frame.stats"))
      .def_property_readonly(
          "pipeline",
          [](const PythonFrame& f) {
            PythonPipeline pipeline;
            pipeline.whole = f.pipeline;
            return pipeline;
          },
          doc_of("Frame.pipeline"))
      .def("save", &save, doc_of("Frame.save"), "path"_a)
      .def("__repr__", &described);
  module.def("render", &render, doc_of("render"), "scene"_a.none(false), "pipeline"_a = py::none(), py::kw_only(),
             "planes"_a = py::tuple(), "threads"_a = 0, "simd"_a = "best");
  module.def("shade", &shade, doc_of("shade"), "scene"_a.none(false), "planes"_a, "pipeline"_a = py::none(),
             py::kw_only(), "threads"_a = 0, "simd"_a = "best");
  module.def(
      "image_hash",
      [](const py::object& image, const std::string& format) { return hash_of(image_of(image, "image", format)); },
      doc_of("image_hash"), "image"_a, "format"_a = "");
}

}  // namespace trueshade::python
