#pragma once
#include <cstdint>
#include <glm/vec4.hpp>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"
#include "shading/blend/blend.h"
#include "shading/program/program_frame.h"
#include "shading/sum/light_pass.h"

namespace trueshade {

/// How lights come to the pixels of a tile.
enum class LightPass : uint8_t {
  none,    ///< nothing that shows light is wanted: there is no target
  sums,    ///< lights are added up in float32, and each sum is stored once
  blends,  ///< each light is blended into the target and rounded before the next
};

/// What a plane beside the target is made of.
enum class PlaneSource : uint8_t {
  tile,             ///< depths, attributes, numbers and light counts that the stages leave in a tile
  material,         ///< specular, emission
  fragment_counts,  ///< overdraw
  view_distance,    ///< Z
  one_light,        ///< light.<i>
};

/// What a frame needs, resolved from scene, pipeline and execution once. The stages that carry it out (frame_tile.cpp)
/// ask the pipeline for values, never again for what is to be done.
struct FramePlan {
  Execution execution;            ///< with a side of tiles that is not 0
  LightPass light_pass;           ///< none, or what the strategy does
  TransparencyMode transparency;  ///< `none` too where the scene has no transparent surface
  bool tied_fragments;  ///< every light but the first draws all fragments at the stored depth: forward-multipass
  UvPlanes uv_planes;   ///< filled where plane `uv` is asked for
  bool encodes;         ///< a tile is brought to the target's stored form before it is written
  bool light_geometry;  ///< pixels under light geometry are counted, as GlCounts::light_pixels
  GBufferState surface_planes;  ///< the planes that lights read surfaces from
  BlendTarget target;
  glm::vec4 clear;                              ///< the colour that a draw stores as what a clear leaves
  LightShortcuts shortcuts;                     ///< of the pass that sums
  std::vector<PlaneSource> planes;              ///< of each plane asked for, in order
  std::shared_ptr<const ProgramFrame> program;  ///< what lights add in place of a light model; null: none

  bool lit() const { return light_pass != LightPass::none; }
  bool blends() const { return light_pass == LightPass::blends; }
  bool sums() const { return light_pass == LightPass::sums; }
};

/// The pipeline without the plane of emission where no material fills it: the same bits, and less memory to go through.
Pipeline without_idle_emission(const Scene& scene, const Pipeline& pipeline);

/// `planes`: as planes_to_draw() gives them. `lit`: whether the target or a plane that shows light is wanted. `there`:
/// what surfaces of a capture have besides.
FramePlan plan_frame(const Scene& scene, const Pipeline& pipeline, const Execution& execution,
                     std::span<const std::string> planes, bool lit, const CapturedFields& there);

}  // namespace trueshade
