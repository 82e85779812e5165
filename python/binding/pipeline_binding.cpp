// Pipelines: by which rules frames are drawn.
#include <fstream>
#include <iterator>

#include "core/sha256.h"
#include "python/binding/bindings.h"
#include "python/binding/python_pipeline.h"
#include "python/binding/python_scene.h"
#include "scenes/pipeline/presets.h"
#include "scenes/pipeline/program_inputs.h"
#include "scenes/pipeline/shipped_models.h"

namespace trueshade::python {
namespace {

constexpr size_t kMostProgramBytes = 8'000'000;  // a file of SPIR-V has 4 MB at most, of GLSL 1 MB

std::optional<std::string> preset_named(const py::object& preset) {
  if (preset.is_none()) return std::nullopt;
  const std::string name = py::str(preset);
  if (preset_pipeline(name)) return name;
  std::string names;
  for (const Preset& known : presets()) names += (names.empty() ? "" : ", ") + std::string(known.name);
  throw bad_argument("preset", "there is no preset '" + name + "'", "one of: " + names);
}

std::array<int, 2> size_of(const py::object& size) {
  const std::vector<double> sides = numbers_of(size, "size", 2);
  for (const double side : sides)
    if (!(side >= 1 && side <= 65536) || side != double(int(side)))
      throw bad_argument("size", "a side is no whole number from 1 to 65536", "(width, height) in pixels");
  return {int(sides[0]), int(sides[1])};
}

/// A model that ships, by name, or the file of a user's program.
LightProgram light_program_of(const py::object& shader, const py::object& parameters) {
  if (shader.is_none() && parameters.is_none()) return {};
  if (shader.is_none()) throw bad_argument("light_parameters", "there is no light program", "pass light_shader too");
  const std::string name = path_of(shader);
  LightProgram program;
  if (names_shipped_model(name)) {
    program = shipped_program(name);
  } else {
    std::ifstream file(name, std::ios::binary);
    if (!file) throw bad_argument("light_shader", "'" + name + "' cannot be read", "a file of GLSL or SPIR-V");
    program.file = name;
    program.text.assign(std::istreambuf_iterator<char>(file), {});
    if (program.text.size() > kMostProgramBytes || program.text.empty())
      throw bad_argument("light_shader", "'" + name + "' is empty, or has more than 8 MB", "GLSL that defines light()");
    program.sha256 = sha256_of(program.text);
  }
  if (parameters.is_none()) return program;
  if (!py::isinstance<py::dict>(parameters))
    throw bad_argument("light_parameters", "it is a " + type_name(parameters), "pass a dict of numbers and sequences");
  for (const auto& [key, value] : parameters.cast<py::dict>()) {
    ProgramParameter parameter{py::str(key), {}};
    const auto given = py::reinterpret_borrow<py::object>(value);
    const bool is_number = PyNumber_Check(given.ptr()) != 0 && PySequence_Check(given.ptr()) == 0;
    const py::object list = is_number ? py::object(py::make_tuple(given)) : given;
    const size_t count = py::len(list);
    if (count < 1 || count > 4)
      throw bad_argument("light_parameters", "'" + parameter.name + "' has " + std::to_string(count) + " numbers",
                         "1 to 4");
    for (const double number : numbers_of(list, "light_parameters", count)) parameter.value.push_back(float(number));
    program.parameters.push_back(std::move(parameter));
  }
  return program;
}

PythonPipeline make_pipeline(const py::object& preset, const py::object& size, const py::object& strategy,
                             const py::object& target, const py::object& values, const py::object& light_shader,
                             const py::object& light_parameters, const PythonScene* scene) {
  PythonPipeline out;
  out.preset = preset_named(preset);
  out.light_program = light_program_of(light_shader, light_parameters);
  if (!values.is_none()) out.values = py::isinstance<py::str>(values) ? values.cast<std::string>() : to_json(values);
  py::dict named;
  if (!strategy.is_none()) named["strategy"] = strategy;
  if (!target.is_none()) named["target"] = target;
  if (!named.empty()) out.named = to_json(named);
  if (!size.is_none()) out.size = size_of(size);
  const Pipeline resolved = out.over(scene == nullptr ? Scene{} : scene->values());  // checks all of it
  if (scene != nullptr) out.whole = resolved;
  return out;
}

Pipeline alone(const PythonPipeline& pipeline) { return pipeline.over(Scene{}); }

std::string described(const PythonPipeline& pipeline) {
  const Pipeline p = alone(pipeline);
  return "<trueshade.Pipeline " + p.preset + ", " + std::string(name_of(p.strategy)) + ", " + std::to_string(p.width) +
         "x" + std::to_string(p.height) + ", " + std::string(info(p.target).name) + ">";
}

}  // namespace

Pipeline PythonPipeline::over(const Scene& scene) const {
  if (whole) return *whole;
  Pipeline p = preset ? *preset_pipeline(*preset) : default_pipeline(scene);
  if (light_program.used()) end_at_range(p.light_volumes);
  const auto add = [&](const std::string& text, const std::string& where) {
    if (text.empty()) return;
    p = pipeline_from_json(text, where, p);
    if (light_program.used()) end_at_range(text, p.light_volumes);
  };
  add(scene.pipeline_text, scene.spec + ": /pipeline");
  add(values, "values");
  add(named, "pipeline");
  if (size) p.width = (*size)[0], p.height = (*size)[1];
  if (light_program.used()) p.light_program = light_program;
  give_text(p.light_program);
  validate(p);
  return p;
}

Pipeline pipeline_for(const Scene& scene, const py::object& pipeline) {
  if (pipeline.is_none()) return PythonPipeline{}.over(scene);
  if (!py::isinstance<PythonPipeline>(pipeline))
    throw bad_argument("pipeline", "it is a " + type_name(pipeline), "pass trueshade.Pipeline(...), or nothing");
  return pipeline.cast<const PythonPipeline&>().over(scene);
}

void add_pipeline(py::module_& module) {
  using namespace py::literals;
  py::class_<PythonPipeline>(module, "Pipeline", doc_of("Pipeline"))
      .def(py::init(&make_pipeline), doc_of("Pipeline.__init__"), "preset"_a = py::none(), py::kw_only(),
           "size"_a = py::none(), "strategy"_a = py::none(), "target"_a = py::none(), "values"_a = py::none(),
           "light_shader"_a = py::none(), "light_parameters"_a = py::none(), "scene"_a = py::none())
      .def_property_readonly(
          "size",
          [](const PythonPipeline& p) {
            const Pipeline whole = alone(p);
            return py::make_tuple(whole.width, whole.height);
          },
          doc_of("Pipeline.size"))
      .def_property_readonly(
          "preset", [](const PythonPipeline& p) { return alone(p).preset; }, doc_of("Pipeline.preset"))
      .def_property_readonly(
          "strategy", [](const PythonPipeline& p) { return std::string(name_of(alone(p).strategy)); },
          doc_of("Pipeline.strategy"))
      .def_property_readonly(
          "target", [](const PythonPipeline& p) { return std::string(info(alone(p).target).name); },
          doc_of("Pipeline.target"))
      .def(
          "to_json", [](const PythonPipeline& p) { return pipeline_json(alone(p)); }, doc_of("Pipeline.to_json"))
      .def(
          "to_dict", [](const PythonPipeline& p) { return from_json(pipeline_json(alone(p))); },
          doc_of("Pipeline.to_dict"))
      .def("__eq__",
           [](const PythonPipeline& a, const py::object& b) {
             return py::isinstance<PythonPipeline>(b) && alone(a) == alone(b.cast<const PythonPipeline&>());
           })
      .def("__repr__", &described);
  module.def(
      "presets",
      [] {
        std::vector<std::string> names;
        for (const Preset& preset : presets()) names.emplace_back(preset.name);
        return names;
      },
      doc_of("presets"));
  module.def(
      "strategies", [] { return std::vector<std::string>(std::begin(kStrategyNames), std::end(kStrategyNames)); },
      doc_of("strategies"));
}

}  // namespace trueshade::python
