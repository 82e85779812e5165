#pragma once
// What the lights of a light program add, as real numbers with bounds on what legal float arithmetic makes of them.
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "judge/bounds/program_fields.h"
#include "judge/bounds/program_lanes.h"
#include "judge/bounds/shaded_surface.h"

namespace trueshade::oracle {

struct ProgramTotal;

/// The pipeline with the G-buffer planes added that its light program reads; without a light program, the pipeline as
/// it is. Throws as ProgramBounds does.
Pipeline with_planes_that_program_reads(const Pipeline& pipeline);

/// What each of several lights adds by itself to one surface, in the order in which the lights were given. The caller
/// keeps it from pixel to pixel, so that its memory is reused.
struct LitApart {
  std::vector<std::array<Bounded, 3>> color;
  /// 1 where `color` is the only outcome. 0 where a comparison may go either way or the value is undefined: then
  /// ProgramBounds::alone() tells the outcomes.
  std::vector<uint8_t> one_outcome;
  std::vector<uint8_t> surely_counts, may_count;  ///< whether the light counts as lit; only where Block::counts
};

/// A light program over the lights of a scene, ready for any surface. Borrows the scene, which must outlive it. Where
/// the pipeline has none, its light model is one (scenes/light_models).
///
/// A driver may add terms and multiply factors in any order, unless the source says `precise`. Where a comparison may
/// go either way, each way is followed: up to kMostForks comparisons of one light, beyond that what holds both results
/// of every choice.
class ProgramBounds {
 public:
  static constexpr size_t kMostForks = 4;

  /// One thread's working values: those of a surface, and those of a surface and a light together (a pair).
  struct Registers {
    std::array<std::vector<Interval>, programs::kRateCount> of;
    std::vector<int8_t> decided;  ///< of the pair's nodes: 0 false, 1 true, -1 not decided
    std::vector<uint32_t> open;   ///< comparisons of the pair that may go either way
    std::vector<Interval> terms;
    uint32_t light = 0;
  };

  /// Compiles the program, and computes what depends on the frame alone and on each light alone. Throws as
  /// programs::program_from_glsl() does; Error(usage) where a parameter has no value, Error(limit) for too many lights.
  ProgramBounds(const Scene& scene, const Pipeline& pipeline, const Arithmetic& arithmetic);
  /// Takes another program in place of the pipeline's; it must have the same inputs.
  ProgramBounds(const Scene& scene, const Pipeline& pipeline, const Arithmetic& arithmetic, programs::Program program);

  /// The program, which lives as long as this object.
  const programs::Program& program() const { return program_; }
  /// Whether the program is the pipeline's own light program. False where it stands for a light model.
  bool is_users() const { return is_users_; }

  /// What the sum starts from plus the terms of these lights, before finish(), and how many of the lights are counted.
  /// Lights end at their extents, where they have one. `undefined` where the start or a term may be NaN or beyond all
  /// floats. An unlit surface gives 0, as finished() ignores its sum.
  LitRange at(const ShadedSurface& surface, std::span<const uint32_t> lights, Registers& registers) const;

  /// The term of one light, without what the sum starts from; 0 for an unlit surface.
  ///   ends: the light ends at its extent, where it has one; false where fragments beyond the extent are not drawn,
  ///         which the caller judges
  LitRange alone(const ShadedSurface& surface, uint32_t light, bool ends, Registers& registers) const;

  /// One thread's working values for surfaces, or lights, that are computed together, one a SIMD lane.
  struct Block {
    std::array<std::vector<LaneInterval>, programs::kRateCount> of;
    std::array<uint8_t, kIntervalLanes> left{}, reached{};
    bool counts = true;  ///< whether lights_low and lights_high of results are wanted
    Registers registers;
  };

  /// Sets `near` to the indices of the lights that may matter to any of these surfaces, ascending. A light is left out
  /// only where intervals over all that the surfaces hold prove that its term is 0 and that it does not count as lit.
  void take_near(std::span<const ShadedSurface* const> surfaces, Block& block, std::vector<uint32_t>& near) const;

  /// Bounds what each of these lights adds to one surface by itself, a light a SIMD lane, and writes that to `lit`. The
  /// values are those of alone(); the bounds are as wide or wider, except perhaps where a number may be NaN.
  void apart(const ShadedSurface& surface, std::span<const uint32_t> lights, bool ends, Block& block,
             LitApart& lit) const;

  /// The terms of a block's lights at one surface, added up, without what the sum starts from.
  struct BlockSum {
    Bounded3 color;
    std::array<double, 3> magnitude{};
    int added = 0, lights_low = 0, lights_high = 0;
  };
  /// Bounds the sum of these lights at each of at most kIntervalLanes surfaces, and writes it to `lit`. Values,
  /// branches and counts are those that at() gives for one surface; the bounds are as wide or wider, except perhaps
  /// where a number may be NaN.
  void at(std::span<const ShadedSurface* const> surfaces, std::span<const uint32_t> lights, Block& block,
          std::span<LitRange> lit) const;

  /// What finish() returns: red, green, blue, alpha; undefined where any of the four may be NaN.
  struct Finished {
    std::array<Bounded, 4> color;
    bool undefined = false;
  };
  /// What finish() makes of a sum of lights. An unlit surface gives its albedo, whatever the sum.
  Finished finished(const ShadedSurface& surface, const Bounded3& sum, Registers& registers) const;

  /// Whether the program reads an input whose name begins with `field`: "surface.uv", or a part of it.
  bool reads(std::string_view field) const;

  /// Whether the surface shows its albedo, whatever the lights, because its material is unlit. Always false where the
  /// program stands for a light model.
  bool is_unlit(const ShadedSurface& surface) const;

 private:
  using Place = ProgramPlace;
  using Step = ProgramStep;
  enum class Reach : uint8_t { none, perhaps_not_nominally, perhaps, surely };
  using Values = std::array<const Interval*, programs::kRateCount>;
  using Outcome = std::array<Interval, 3>;

  ProgramBounds(const Scene& scene, const Pipeline& pipeline, const Arithmetic& arithmetic, programs::Program program,
                bool is_users);
  void make_steps();
  void find_slots_read();
  void renumber_light_slots(const std::vector<uint8_t>& is_read);
  using SumTerm = std::pair<programs::NodeId, bool>;  ///< true: negated
  std::vector<SumTerm> terms_of(programs::NodeId id) const;
  void gather(programs::NodeId id, bool negated, std::vector<SumTerm>& out, size_t depth, size_t& visits) const;
  void find_mixes(programs::NodeId id, size_t depth, size_t& visits, std::vector<ProgramMix>& out) const;
  void find_patterns(programs::NodeId id, Step& step);
  bool is_unit_component(const programs::ProgramNode& product) const;
  void set_constants(const Scene& scene, const Pipeline& pipeline);
  void set_lights();
  const Interval* values_of_light(uint32_t light) const { return &light_values_[size_t(light) * light_slots_read_]; }
  Values values_of(const Registers& registers) const;
  Interval evaluated(const Step& step, const Values& values, std::vector<Interval>& terms) const;
  void run(std::span<const Step> steps, std::vector<Interval>& out, const Values& values,
           std::vector<Interval>& terms) const;
  void run_pair(std::span<const Step> steps, Registers& registers, bool follow) const;
  Outcome outcome(Registers& registers) const;
  std::vector<Outcome> outcomes(Registers& registers, size_t& nominal, Interval& counted) const;
  void look_at(const ShadedSurface& surface, Registers& registers) const;
  ProgramLanes lanes_of(std::span<const Step> steps, programs::Rate rate, Block& block, uint32_t light,
                        uint8_t* left) const;
  ProgramLanes lanes_of_lights(std::span<const Step> steps, Block& block, size_t count, uint8_t* left) const;
  void look_at(std::span<const uint32_t> lights, Block& block) const;
  bool suits_lanes() const;
  struct Box;
  bool ends_before(const Light& light, const Box& box) const;
  void add(const ShadedSurface& surface, uint32_t light, bool ends, Registers& registers, ProgramTotal& total) const;
  void look_at(std::span<const ShadedSurface* const> surfaces, Block& block) const;
  bool find_reached(const Light& light, std::span<const ShadedSurface* const> surfaces, Block& block) const;
  void add(uint32_t light, size_t count, Block& block, std::span<BlockSum> sums) const;

  Reach reach_of(const Light& light, const ShadedSurface& surface) const;
  const Interval& output(int number, const Values& values) const;
  Interval result(const ProgramLanes& lanes, int number, size_t lane) const;

  const Scene& scene_;
  Arithmetic arithmetic_;
  IntervalArithmetic of_;
  programs::Program program_;
  LightVolumes volumes_;
  bool alpha_from_albedo_, is_users_;
  std::vector<Place> place_;  ///< of each node
  std::array<uint32_t, programs::kRateCount> slots_{};
  std::vector<Step> constants_, of_lights_, of_surfaces_, of_pairs_, of_reaches_, of_sums_;
  std::vector<std::pair<uint32_t, SurfaceField>> surface_inputs_;  ///< by slot
  std::vector<std::pair<uint32_t, size_t>> sum_inputs_;            ///< slot, and channel
  std::vector<ProgramTerm> terms_;
  std::vector<ProgramMix> mixes_;
  std::vector<uint32_t> surface_slots_read_;  ///< by what pairs compute, and outputs
  uint32_t light_slots_read_ = 0;             ///< the same of lights, which are the first of theirs
  std::vector<Interval> constant_values_;
  std::vector<Interval> light_values_;  ///< light_slots_read_ for each light
};

}  // namespace trueshade::oracle
