#pragma once
#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "core/huge_pages.h"
#include "scenes/camera.h"
#include "scenes/light.h"
#include "scenes/pipeline/light_model.h"
#include "scenes/pipeline/pipeline.h"
#include "shading/light/power.h"

namespace trueshade {

class ProgramFrame;

/// What a kernel does with a light.
enum class LightKind : uint8_t {
  point,  ///< point, or a spot that the model gives no cone
  coned,  ///< a spot with a cone
  other,  ///< ambient, directional
};

/// A light as kernels read it, field by field: two cache lines.
struct alignas(64) LightRow {
  float position[3];  ///< directional: minus the direction the light travels
  float cut2;         ///< the least squared distance at which the falloff is 0; infinity if it never is
  float color[3];     ///< times the model's damping
  float range;
  // Cones (docs/arithmetic.md section 8); lights without one have numbers that give 1.
  float axis[3];      ///< minus the direction the light travels
  float edge, slope;  ///< smooth: e0 and w; exponent: e0; squared: offset and scale
  float dark_cosine;  ///< the cone is exactly 0 where the cosine is below; -2: nowhere
  LightType type;
  LightKind kind;
  float range2;  ///< range * range
  float k0, k1, k2;
  float ambient[3];
  float extent2;  ///< the least squared distance that the light's extent leaves out; infinity for none
  Exponent spot_exponent;
};

/// A frame's lights in scene order, and the viewer they have in common.
struct LightTable {
  HugeVector<LightRow> row;
  std::vector<float> position[3], cut2;  ///< copied from the rows; NaN for a light without a position; padded to full
                                         ///< vectors with lights that reach nothing
  bool cones = false;  ///< some light's kind is `coned`
  float eye[3], view_axis[3];
  const ProgramFrame* program = nullptr;  ///< what the lights add in place of a light model; null: none
  uint32_t first_light = 0;               ///< the number in the scene of the first light here
  uint64_t version = 0;  ///< tables of the process with different lights have different versions; 0: empty

  // What LightTableUpdate made the rows of.
  std::vector<Light> made_of;
  LightModel model;
  LightVolumes volumes;
  bool draws_meshes = false;

  size_t size() const { return row.size(); }
};

/// Bounds the lights by their extents, where these are not drawn: `cut2` is at most `extent2`.
void bound_by_extents(LightTable& table, std::span<const Light> lights, const LightVolumes& volumes, bool draws_meshes);

/// Whether a light with a cone leaves the whole box between two corners dark: its cone is exactly 0 there, in the
/// kernel's own operations. False for lights without one, and where it cannot tell.
bool dark_over(const LightRow& light, const float low[3], const float high[3]);

LightTable make_light_table(std::span<const Light> lights, const LightModel& model, const Camera& camera,
                            int threads = 1);
/// The same in the memory of any other table.
void make_light_table(std::span<const Light> lights, const LightModel& model, const Camera& camera, int threads,
                      LightTable& out);

/// Makes a table bounded by the lights' extents, in independent tasks. `table` may be one that this class made before:
/// the rows of lights that have not changed since, byte for byte, are kept.
class LightTableUpdate {
 public:
  LightTableUpdate(std::span<const Light> lights, const LightModel& model, const LightVolumes& volumes,
                   bool draws_meshes, const Camera& camera, LightTable& table);
  int tasks() const;
  void run(int task);
  void finish();  ///< after all tasks

 private:
  std::span<const Light> lights_;
  LightTable& table_;
  size_t kept_;       // rows of the table that may be kept
  uint64_t version_;  // of the table that they are in
  std::atomic<bool> changed_;
};

}  // namespace trueshade
