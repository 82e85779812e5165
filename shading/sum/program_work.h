#pragma once
#include <memory>

#include "scenes/pipeline/light_model.h"
#include "shading/program/program_frame.h"

namespace trueshade {

/// Scratch of a thread for the tiles of one program; kept between tiles to save allocation.
struct ProgramWork {
  ProgramWork(std::shared_ptr<const programs::Executable> of, size_t pixels)
      : executable(std::move(of)), registers(*executable), surfaces(executable->at(programs::Rate::surface), pixels) {}

  std::shared_ptr<const programs::Executable> executable;
  programs::Registers registers;
  programs::LaneValues surfaces;
  alignas(64) uint32_t pixel[2][kMaxTilePixels];
  alignas(64) float sum[3][kMaxTilePixels];
  alignas(64) float finished[4][kMaxTilePixels];
};

/// The scratch in `kept`, made anew where it is another program's or of tiles of another side.
ProgramWork& program_work(const ProgramFrame& program, int tile, std::shared_ptr<ProgramWork>& kept);

/// Gives the program the surfaces of a tile. start: three planes for what sums start from, or null.
void give_surfaces(const ProgramFrame& program, const SurfaceTile& surface, int tile, float* const* start,
                   ProgramWork& work);

/// Makes of sums, three planes of a tile, what is stored of a surface: work.finished. Surfaces that are unlit have
/// their albedo; alpha is the albedo's where the model says so and the program defines no `finish`.
void finish_surfaces(const ProgramFrame& program, const SurfaceTile& surface, int tile, const LightModel& model,
                     const float* const sum[3], ProgramWork& work);

/// Whether alpha is the albedo's.
bool takes_albedo(const ProgramFrame& program, const LightModel& model);

}  // namespace trueshade
