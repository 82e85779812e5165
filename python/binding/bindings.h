#pragma once
#include "python/binding/arrays.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade::python {

// Each adds its part of the module.
void add_errors(py::module_& module);
void add_scene(py::module_& module);
void add_pipeline(py::module_& module);
void add_frame(py::module_& module);
void add_judge(py::module_& module);
void add_compare(py::module_& module);

/// The pipeline of a call: the one given, or what the scene starts from.
Pipeline pipeline_for(const Scene& scene, const py::object& pipeline);

/// A dict of JSON text.
py::object from_json(const std::string& text);

}  // namespace trueshade::python
