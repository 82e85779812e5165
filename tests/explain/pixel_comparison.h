#pragma once
// Frames beside the explanations of their pixels.
#include <array>
#include <bit>
#include <cmath>
#include <string>
#include <vector>

#include "explain/explain.h"
#include "scenes/builtin/pcg32.h"
#include "shading/frame.h"

namespace trueshade::testing {

inline bool same_bits(float a, float b) {
  return std::bit_cast<uint32_t>(a) == std::bit_cast<uint32_t>(b) || (a != a && b != b);
}

/// What a pixel's channel holds in the form of blend_pixels(): a code as a float, or the float.
inline float channel_in(const Image& image, int x, int y, int c) {
  return info(image.format).number_class == NumberClass::unorm ? float(image.code(x, y, c))
                                                               : float(image.value(x, y, c));
}

inline std::string number(float value) { return value_text(AccountValue(value)); }

/// A frame with every plane, and pixels of it explained.
class Comparison {
 public:
  Comparison(const Scene& scene, const Pipeline& pipeline) : explained_(scene, pipeline) {
    std::vector<std::string> planes = {"depth", "position", "normal", "albedo", "uv", "id.object"};
    if (reads_specular_plane(explained_.pipeline.light_model)) planes.push_back("specular");
    if (explained_.pipeline.light_model.emission) planes.push_back("emission");
    frame_ = render_frame(scene, explained_.pipeline, {}, planes);
  }

  /// What is wrong with the explanation of a pixel; empty if nothing is.
  std::string wrong_at(int x, int y) const {
    const PixelHistory history = history_of(explained_, x, y);
    const std::string at = "pixel " + std::to_string(x) + ',' + std::to_string(y) + ": ";
    for (int c = 0; c < info(frame_.color.format).channels; ++c) {
      const float there = channel_in(frame_.color, x, y, c), told = history.stored[size_t(c)];
      if (!same_bits(there, told))
        return at + "target channel " + std::to_string(c) + " is " + number(there) + ", explained as " + number(told) +
               '\n' + account_text(account_of(explained_, history));
    }
    for (const NamedImage& plane : frame_.aovs)
      if (const std::string wrong = wrong_plane(plane, history, x, y); !wrong.empty()) return at + wrong;
    return {};
  }

  /// Explains `count` pixels at random; the first fault, or nothing.
  std::string wrong_in(Pcg32& random, int count) const {
    for (int i = 0; i < count; ++i) {
      const int x = int(random.below(uint32_t(frame_.color.width))),
                y = int(random.below(uint32_t(frame_.color.height)));
      if (std::string wrong = wrong_at(x, y); !wrong.empty()) return wrong;
    }
    return {};
  }

  uint64_t covered() const { return frame_.stats.covered_pixels; }

 private:
  static std::vector<float> told_of(const std::string& plane, const SurfacePlanes& surface) {
    const auto all = [](const auto& values) { return std::vector<float>(values.begin(), values.end()); };
    if (plane == "position") return all(surface.position);
    if (plane == "normal") return all(surface.normal);
    if (plane == "albedo") return all(surface.albedo);
    if (plane == "uv") return all(surface.uv);
    if (plane == "specular") return all(surface.specular);
    return all(surface.emission);
  }

  std::string wrong_plane(const NamedImage& plane, const PixelHistory& history, int x, int y) const {
    if (plane.name == "depth") {
      const auto there = float(plane.image.value(x, y, 0));
      return same_bits(there, history.depth) ? ""
                                             : "depth is " + number(there) + ", explained as " + number(history.depth);
    }
    if (plane.name == "id.object") {
      const uint32_t told = history.visible ? history.opaque.covering[*history.visible].instance + 1 : 0;
      return plane.image.code(x, y, 0) == told ? "" : "another object is seen than explained";
    }
    if (!history.visible) return {};
    const std::vector<float> told = told_of(plane.name, history.surface.read);
    const bool halved = plane.name == "normal" && info(plane.image.format).number_class == NumberClass::unorm;
    for (size_t c = 0; c < std::min(told.size(), size_t(info(plane.image.format).channels)); ++c) {
      auto there = float(plane.image.value(x, y, int(c)));
      if (halved) there = (there + there) - 1.0f;
      if (!same_bits(there, told[c]))
        return plane.name + " channel " + std::to_string(c) + " is " + number(there) + ", explained as " +
               number(told[c]);
    }
    return {};
  }

  ExplainedFrame explained_;
  Frame frame_;
};

}  // namespace trueshade::testing
