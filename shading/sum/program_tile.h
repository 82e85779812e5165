#pragma once
#include "shading/sum/light_pass.h"
#include "shading/sum/program_work.h"

namespace trueshade {

/// What a tile of sums is made of, as light_tile() takes it.
struct ProgramTile {
  const SurfaceTile& surface;
  int tile;
  const LightTable& lights;  ///< with a program
  const LightModel& model;
  const float* clear;
  const LightShortcuts& shortcuts;
  LightLists& work;
  ColorTile& out;
  LightCounts& counts;
};

/// Lights one tile by the program of the table: the sum starts from `start`, adds what `light` gives for every light
/// whose extent has the pixel, in index order, and becomes what `finish` makes of it. What is 0 in all channels is not
/// added, so that lights may be left out that are known to give it. light_count has those of which `reaches` is true.
/// Pixels that are not covered get `clear`, those of unlit materials their albedo. NaN is 7FC00000.
void program_tile(const ProgramTile& in);

}  // namespace trueshade
