#pragma once
#include <string>
#include <vector>

#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade::oracle {

/// A uniform's value, its numbers in the order of memory: floats, or whole numbers.
struct NamedValue {
  std::string name;
  std::vector<double> numbers;
};

/// Every uniform of gl/emit that is the same for a whole frame, whether a shader reads it or not: eye, view_axis,
/// clip_from_world, picture_place, those of a position rebuilt from depth (docs/arithmetic.md section 7), and of a
/// light program. `shift`: the picture is drawn moved by whole pixels.
std::vector<NamedValue> frame_values(const Scene& scene, const Pipeline& pipeline, int shift_x = 0, int shift_y = 0);

}  // namespace trueshade::oracle
