#pragma once
#include <array>
#include <optional>
#include <string>

#include "python/binding/arrays.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade::python {

/// A pipeline as Python has it: layers over what a scene starts from, as the options of the command are. Which scene
/// that is shows when a frame is drawn, unless the pipeline was made for one.
struct PythonPipeline {
  std::optional<std::string> preset;
  std::string values;  ///< JSON; empty without
  std::string named;   ///< strategy and target as JSON; empty without
  std::optional<std::array<int, 2>> size;
  LightProgram light_program;  ///< with its text; of no file where there is none
  std::optional<Pipeline> whole;  ///< of one that was made for a scene, or of a frame: all of it

  /// Error(bad_input) as pipeline_from_json() has it, Error(usage) for values that do not go together.
  Pipeline over(const Scene& scene) const;
};

/// The pipeline of a call: the one given over what the scene starts from, or that alone for None.
Pipeline pipeline_for(const Scene& scene, const py::object& pipeline);

}  // namespace trueshade::python
