#pragma once
// A light program in double: what a light pass that is right makes of a surface, for the diagnosis, which changes the
// lights and the surface and asks again.
#include <array>
#include <iterator>
#include <vector>

#include "judge/bounds/program_fields.h"
#include "judge/diagnosis/light_pass.h"
#include "judge/diagnosis/triple.h"
#include "programs/values/program.h"

namespace trueshade::oracle {

/// A light program of one frame. Where an operation is not defined, a value is NaN or infinite as double arithmetic has
/// it.
class PlainProgram {
 public:
  /// The pipeline's program.
  PlainProgram(const Scene& scene, const Pipeline& pipeline);
  /// Another program for the same frame.
  PlainProgram(const Scene& scene, const Pipeline& pipeline, programs::Program program);

  /// Whether the program has a finish(); without one finish() is not called.
  bool defines_finish() const { return program_.defines_finish; }

  /// The values of one surface, for the functions below. Not while others use them.
  using Values = std::vector<double>;
  /// Sets `values` to those of a surface, from the eye of `camera`.
  void look_at(const PlainSurface& surface, const Camera& camera, Values& values) const;
  /// The same; the surface's errors are not read.
  void look_at(const ShadedSurface& surface, const Camera& camera, Values& values) const;
  /// What start() returns.
  Triple3 start(const Values& values) const { return three(programs::kStartOutput, values); }
  /// What light() returns of a light, whatever its extent. Writes the light's values into `values`.
  Triple3 term(const Light& light, uint32_t index, Values& values) const;
  /// What finish() returns of a sum. Writes the sum's values into `values`.
  std::array<double, 4> finish(const Triple3& sum, Values& values) const;

 private:
  Triple3 three(int output, const Values& values) const;
  void find_needed(LightType type);
  void run(const std::vector<programs::NodeId>& nodes, Values& values) const;
  double computed(const programs::ProgramNode& node, const Values& values) const;

  programs::Program program_;
  Values first_;  ///< constants, and what holds for the frame
  std::vector<programs::NodeId> of_frame_, of_surface_, of_light_, of_sum_;
  /// The nodes of of_light_ that lights of each type need: choices that go by the type leave the rest out. All of a
  /// type that the scene does not have.
  std::array<std::vector<programs::NodeId>, std::size(kLightTypes)> of_type_;
  std::vector<std::pair<programs::NodeId, SurfaceField>> surface_inputs_;
  std::vector<std::pair<programs::NodeId, LightField>> light_inputs_;
  std::vector<std::pair<programs::NodeId, size_t>> sum_inputs_, eye_inputs_;
};

}  // namespace trueshade::oracle
