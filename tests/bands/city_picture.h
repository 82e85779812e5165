#pragma once
#include "bands/large_picture.h"
#include "scenes/builtin/builtin.h"
#include "scenes/pipeline/presets.h"

namespace trueshade::testing {

/// A picture of city that is drawn as if it were large.
inline LargePicture city_picture(const PreparedScene& scene, int width, int height) {
  LargePicture picture{scene, default_pipeline(scene.scene()), {}, {}, {}, {{"trueshade:scene", "builtin:city"}}, {},
                       {}};
  picture.pipeline.width = width, picture.pipeline.height = height;
  return picture;
}

}  // namespace trueshade::testing
