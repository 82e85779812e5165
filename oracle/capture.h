#pragma once
#include <array>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/image.h"

namespace trueshade::oracle {

/// What a renderer drew, from wherever it came: a real driver on this machine, a file captured elsewhere, our own
/// frame, or a mutant made to be rejected. Images have rows top first, values as they read back from the stored
/// formats.
struct Capture {
  std::string driver;              ///< vendor, renderer and version in one line
  Image color;                     ///< the target; empty if none was captured
  std::vector<NamedImage> planes;  ///< named as `--aov` names them; any subset
  std::array<int, 2> drawn_at{};   ///< where its lower left pixel was in the driver's window: floats round there
  bool has_alpha = true;           ///< false: the file had R, G and B alone; the alpha of `color` is then not judged
  std::string name = "capture";    ///< what errors call it: the file it is from

  const Image* plane(std::string_view name) const {
    for (const NamedImage& p : planes)
      if (p.name == name) return &p.image;
    return nullptr;
  }
};

/// Looks at the target after one light's draw: its index; before the first -1, the target as it was cleared or as the
/// draw before the lights left it (forward-multipass without lights: as its one draw left it).
using StepSink = std::function<void(int light, const Image& target)>;

/// Draws the lights of a capture again and shows the target after each, in order. The same of surfaces transparent
/// after the lights, by instance.
using LightSteps = std::function<void(const StepSink&)>;

}  // namespace trueshade::oracle
