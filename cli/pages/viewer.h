#pragma once
#include <optional>
#include <string>
#include <vector>

#include "cli/pages/layer.h"
#include "cli/pixel_explanation.h"

namespace trueshade {

inline constexpr int kTileSide = 512;  ///< pixels of a tile of a layer

/// Pixels to go through one after the other.
struct Places {
  struct Pixel {
    int x, y;
    std::string layer = {};  ///< of the class map that it is marked on
  };
  std::string name, about;
  std::vector<Pixel> pixels;
  bool are_violations = false;  ///< each is marked on its map at every zoom
  Rgb color{};                  ///< of the marks
};

/// Two layers that are compared channel by channel.
struct Compared {
  std::string reference, test;
  std::string about;  ///< a sentence on what the values are
};

/// The pictures of a page, of one size, and what is said of their pixels.
struct PageViewer {
  std::vector<PageLayer> layers;
  std::optional<Compared> compared;
  std::string opens;  ///< the map of classes that is shown first: of the stage that failed; empty: the first there is
  std::vector<Places> places;
  std::vector<PixelExplanation> explanations;
  std::string explain_command;  ///< with {x} and {y}; or empty
  int gain = 16;                ///< of differences at first; a power of two

  PageLayer& add(PageLayer layer) { return layers.emplace_back(std::move(layer)); }
};

/// The viewer, and all its layers, as HTML. `pictures` is shown in its place on paper and where no script runs.
std::string viewer_part(const PageViewer& viewer, const std::string& pictures, int threads);

}  // namespace trueshade
