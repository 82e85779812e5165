#pragma once
// A light program in double: what a right light pass makes of a surface. The diagnosis changes lights and surfaces and
// asks again.
#include <array>
#include <iterator>
#include <vector>

#include "judge/bounds/program_fields.h"
#include "judge/diagnosis/light_pass.h"
#include "judge/diagnosis/triple.h"
#include "programs/values/program.h"

namespace trueshade::oracle {

/// A light program prepared for one frame. Where an operation is not defined, the result is NaN or infinite, as in
/// double arithmetic.
class PlainProgram {
 public:
  /// Prepares the pipeline's light program.
  PlainProgram(const Scene& scene, const Pipeline& pipeline);
  /// Takes another program for the same frame.
  PlainProgram(const Scene& scene, const Pipeline& pipeline, programs::Program program);

  /// Whether the program has a finish(); if not, finish() must not be called.
  bool defines_finish() const { return program_.defines_finish; }

  /// The values of the program's nodes for one surface. The functions below read and write them: one thread at a time.
  using Values = std::vector<double>;
  /// Computes `values` for a surface that is seen from the eye of `camera`.
  void look_at(const PlainSurface& surface, const Camera& camera, Values& values) const;
  /// Computes `values` for a surface whose errors are ignored, seen from the eye of `camera`.
  void look_at(const ShadedSurface& surface, const Camera& camera, Values& values) const;
  /// What start() returns: R, G, B that the sum of the lights starts from.
  Triple3 start(const Values& values) const { return three(programs::kStartOutput, values); }
  /// What light() returns for a light: its term, whatever its extent. Changes the light's part of `values`.
  Triple3 term(const Light& light, uint32_t index, Values& values) const;
  /// What finish() returns for a sum: RGBA. Changes the sum's part of `values`.
  std::array<double, 4> finish(const Triple3& sum, Values& values) const;

 private:
  Triple3 three(int output, const Values& values) const;
  void find_needed(LightType type);
  void run(const std::vector<programs::NodeId>& nodes, Values& values) const;
  double computed(const programs::ProgramNode& node, const Values& values) const;

  programs::Program program_;
  Values first_;  ///< constants, and what holds for the frame
  std::vector<programs::NodeId> of_frame_, of_surface_, of_light_, of_sum_;
  /// For each type of light, the nodes of of_light_ that such a light needs: choices by the type leave the rest out.
  /// All nodes for a type that the scene does not have.
  std::array<std::vector<programs::NodeId>, std::size(kLightTypes)> of_type_;
  std::vector<std::pair<programs::NodeId, SurfaceField>> surface_inputs_;
  std::vector<std::pair<programs::NodeId, LightField>> light_inputs_;
  std::vector<std::pair<programs::NodeId, size_t>> sum_inputs_, eye_inputs_;
};

}  // namespace trueshade::oracle
