#pragma once
#include <array>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/image.h"
#include "core/pixel_mask.h"

namespace trueshade::oracle {

/// A plane that was unpacked from what an engine stores, such as a normal from two octahedral codes: how far its values
/// are from those that the engine's shaders have. Bounds on each component, one for all pixels or one a pixel.
struct DecodedPlane {
  std::string name;
  bool unit_length = false;          ///< what is packed is a direction of length 1
  std::vector<float> reading_error;  ///< |here - what a shader unpacks from the very same codes|
  std::vector<float> packing_error;  ///< |here - what was packed|
  bool has_alpha = true;  ///< false: there are three channels, and the fourth, which stands in, is not judged

  bool is_unpacked() const { return !packing_error.empty(); }
  static double at(const std::vector<float>& bounds, size_t pixel) {
    return bounds.empty() ? 0.0 : double(bounds[bounds.size() == 1 ? 0 : pixel]);
  }
};

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
  std::vector<std::pair<std::string, std::string>> files{};  ///< planes from another file than that, each with its file

  PixelMask mask{};  ///< pixels that are not judged; of the capture's size, or empty

  std::vector<DecodedPlane> decoded{};  ///< of the planes that are not as their renderer stored them

  const Image* plane(std::string_view name) const {
    for (const NamedImage& p : planes)
      if (p.name == name) return &p.image;
    return nullptr;
  }
  /// What errors call a plane's file. The target is `color`.
  const std::string& file_of(std::string_view plane) const {
    for (const auto& [of, file] : files)
      if (of == plane) return file;
    return name;
  }
  const DecodedPlane* decoding(std::string_view name) const {
    for (const DecodedPlane& p : decoded)
      if (p.name == name) return &p;
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
