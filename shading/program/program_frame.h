#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "programs/run/execution.h"
#include "raster/surfaces/surfaces.h"
#include "scenes/pipeline/program_inputs.h"
#include "scenes/scene.h"

namespace trueshade {

/// The program of a pipeline, compiled once a process for each text. Error(bad_input) names the place in its file.
std::shared_ptr<const programs::Executable> executable_of(const LightProgram& program);

/// The same for lights of those types alone, which are the scene's: without what others would need.
std::shared_ptr<const programs::Executable> executable_of(const LightProgram& program, std::span<const Light> lights);

/// The same pipeline with the planes that its light program reads, and nothing of light_model that bounds a light or
/// changes what a program is given. Pipelines without a program stay as they are.
Pipeline with_planes_of_program(const Pipeline& pipeline);

/// How a surface of an unlit material gets its colour: the program is not asked, or its planes hold what any light
/// model makes that colour of.
enum class Unlit : uint8_t { shows_albedo, by_planes };

/// A light program with what holds for a frame: its parameters, the view, and what it makes of the lights alone.
class ProgramFrame {
 public:
  /// pipeline: with_planes_of_program(). `there`: what surfaces have besides, those of a capture. Error where the
  /// program reads what is not there, or a parameter is missing or there is none of its name.
  ProgramFrame(const Scene& scene, const Pipeline& pipeline, Unlit unlit = Unlit::shows_albedo,
               const CapturedFields& there = {});

  const programs::Executable& executable() const { return *executable_; }
  const std::shared_ptr<const programs::Executable>& shared_executable() const { return executable_; }
  const programs::ConstantValues& constants() const { return constants_; }
  const programs::LaneValues& lights() const { return *lights_; }
  const ProgramReads& reads() const { return reads_; }
  bool has_unlit() const { return has_unlit_; }  ///< some material is
  /// Shows its colour, whatever the lights. A capture's material may be none of the scene's.
  bool is_unlit(uint32_t material) const { return material < unlit_.size() && unlit_[material]; }

  /// Where a tile holds an input of the stage of surfaces; `pixels` has the numbers of columns and rows, a plane each.
  const void* plane_of(size_t input, const SurfaceTile& surface, const uint32_t* const pixels[2]) const;

 private:
  void set_constants(const Scene& scene, const Pipeline& pipeline);
  void set_lights(const Scene& scene);

  std::shared_ptr<const programs::Executable> executable_;
  ProgramReads reads_;
  programs::ConstantValues constants_;
  std::vector<programs::LaneBlock> light_planes_;
  std::unique_ptr<programs::LaneValues> lights_;
  std::vector<uint8_t> unlit_;
  bool has_unlit_ = false;
};

}  // namespace trueshade
