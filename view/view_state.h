#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scenes/camera.h"
#include "scenes/light_change.h"
#include "scenes/pipeline/pipeline.h"

namespace trueshade::viewer {

/// All that the window shows of a scene, as its user has it.
struct ViewState {
  uint64_t revision = 0;             ///< another number with each change, so that pictures can be told apart
  Pipeline pipeline;                 ///< of the picture's size, without the exposure
  double exposure = 0.0;             ///< stops: twice the light each
  std::optional<Camera> camera;      ///< nothing: the scene's own, as it moves
  double time = 0.0;                 ///< seconds
  std::vector<LightChange> changes;  ///< of lights; at most one of each
  std::string looks = {};            ///< looks_text() of what the scene was brought to when it was loaded
};

/// The pipeline that the picture is drawn by. The exposure multiplies the colour of every light
/// (LightModel::damping), so that it is part of what is saved and hashed; light programs have none.
Pipeline drawn_pipeline(const ViewState& state);

}  // namespace trueshade::viewer
