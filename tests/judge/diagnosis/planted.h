#pragma once
// Faults planted in captures of our own frames, and what becomes of each: convicted, named first, named at all.
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "oracle/capture.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade::testing {

/// A fault as somebody may have it. Nothing here knows how it is found.
struct Plant {
  std::string_view name;
  std::vector<std::string_view> names;  ///< of the findings that say so
  std::string_view plane;               ///< the one that must be blamed
  std::vector<std::string_view> presets = {"many-lights"};
  int variants = 3;  ///< sizes of the fault
  /// What the wrong renderer is given; false: the fault changes nothing here.
  std::function<bool(Scene&, Pipeline&, int variant)> input = nullptr;
  /// What is done to what it drew.
  std::function<void(const Scene&, const Pipeline&, oracle::Capture&, int variant)> output = nullptr;
  bool loops_only = false;
  bool lights_again = false;  ///< `output` lights the picture anew from its planes: before any other
  /// What right and wrong renderer are both given.
  void (*base)(Scene&, Pipeline&) = nullptr;
  std::vector<std::string_view> scenes = {"city,lights=60,objects=300", "cornell", "circle,lights=24"};
};
std::span<const Plant> plants();

/// One capture to plant in.
struct Ground {
  std::string scene, preset;
  Strategy strategy = Strategy::deferred_loop;
  Format target = Format::rgba8;
  int view = 0;  ///< the camera, moved a little
};
/// The plant's scenes, two targets, loops and volumes.
std::vector<Ground> grounds(const Plant& plant, std::string_view preset, int views);
std::vector<Ground> grounds(std::string_view preset, int views);  ///< of most plants

struct PlantedTry {
  uint64_t changed = 0;  ///< pixels of the blamed plane by a step of its format
  bool convicted = false, first = false, named = false, blamed = false;
  uint64_t beyond = 0;       ///< of `changed`, those that the nearest picture of a right renderer has otherwise, too
  bool second = false;       ///< of two faults, the other one is named too
  uint64_t both_matter = 0;  ///< pixels that the lesser of the two changes beside the other
  double ms = 0;             ///< that the diagnosis took
  std::string found;         ///< names, ranked
};

/// Two faults that can be in one capture.
struct PlantedPair {
  const Plant *one = nullptr, *other = nullptr;
  Ground ground;
};
/// So many of them, every fault about as often as the others.
std::vector<PlantedPair> pairs_of_plants(int count);

/// Plants and judges; `other` may be null.
PlantedTry planted_try(const Ground& ground, const Plant& plant, int variant, const Plant* other = nullptr);

}  // namespace trueshade::testing
