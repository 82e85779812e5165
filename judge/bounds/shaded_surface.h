#pragma once
// A surface as lights see it, and what they may add up to there.
#include <array>
#include <cstdint>
#include <vector>

#include "judge/bounds/bounded.h"

namespace trueshade::oracle {

/// A pixel's surface as the light pass reads it from the G-buffer, with bounds on what a shader fetches.
struct ShadedSurface {
  Bounded3 position, normal;
  std::array<Bounded, 4> albedo;
  Bounded3 specular{}, emission{};            ///< where the model reads them
  double shininess = 0, shininess_error = 0;  ///< an integer; any one within the error, where a map leaves several
  Bounded ambient_share{1, 0};                ///< what arrives of ambient light, where the model reads emission
  std::array<Bounded, 2> uv{};                ///< the rest where a light program reads it
  std::array<Bounded, 2> uv1{};
  std::array<Bounded, 4> tangent{};
  std::array<Bounded, 16> user{};     ///< four vectors
  uint32_t object = 0, material = 0;  ///< from 1 on
  std::array<int, 2> pixel{};         ///< column and row from the lower left
};

/// A comparison of one light that may go either way: how the sum of the lights, RGB, changes if it goes the other way.
struct OtherBranch {
  std::array<double, 3> change{};
};

/// What the lights may add up to at a surface: the nominal sum with its error, and what branches may change.
struct LitRange {
  Bounded3 color;  ///< the nominal branches, all lights summed
  std::vector<OtherBranch> branches;
  bool undefined = false;               ///< normalize(0), 0^0: any value is legal
  int lights_low = 0, lights_high = 0;  ///< lights in range and facing: light.count may be any number between
};

}  // namespace trueshade::oracle
