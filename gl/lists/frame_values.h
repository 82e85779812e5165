#pragma once
#include <string>
#include <vector>

#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade::oracle {

/// A uniform's name and value: the numbers, floats or integers, in the order of memory.
struct NamedValue {
  std::string name;
  std::vector<double> numbers;
};

/// Each uniform of gl/emit that is the same for a whole frame, whether a shader reads it or not: eye, view_axis,
/// clip_from_world, picture_place, those of a position rebuilt from depth (docs/arithmetic.md section 7), and those of
/// a light program.
///   shift_x, shift_y: by how many pixels the picture is moved
std::vector<NamedValue> frame_values(const Scene& scene, const Pipeline& pipeline, int shift_x = 0, int shift_y = 0);

}  // namespace trueshade::oracle
