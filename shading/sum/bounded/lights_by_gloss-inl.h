// Sorts the lights of a region by whether their specular terms may matter to its pixels, by bounds over all of these
// (docs/proofs.md section 16). Pixels that face one way are brought together before, so that the bounds are narrow.
// Included once per SIMD target.
#if defined(TRUESHADE_SHADING_SUM_BOUNDED_LIGHTS_BY_GLOSS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_SHADING_SUM_BOUNDED_LIGHTS_BY_GLOSS_INL_H_
#undef TRUESHADE_SHADING_SUM_BOUNDED_LIGHTS_BY_GLOSS_INL_H_
#else
#define TRUESHADE_SHADING_SUM_BOUNDED_LIGHTS_BY_GLOSS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "shading/light/light_term-inl.h"
#include "shading/light/lists/light_lists-inl.h"
#include "shading/sum/bounded/bounded_lights.h"

HWY_BEFORE_NAMESPACE();
namespace trueshade::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// A ball about all vectors of a box.
struct Ball {
  float center[3], radius, farthest;  ///< `farthest` from the origin

  explicit Ball(const Box& box) {
    float reach2 = 0.0f, center2 = 0.0f;
    for (int c = 0; c < 3; ++c) {
      center[c] = box.low[c] + (box.high[c] - box.low[c]) * 0.5f;
      const float reach = std::max(box.high[c] - center[c], center[c] - box.low[c]);
      reach2 += reach * reach, center2 += center[c] * center[c];
    }
    radius = std::sqrt(reach2) * (1.0f + 0x1p-20f);
    farthest = std::sqrt(center2) * (1.0f + 0x1p-20f) + radius;
  }
};

/// The direction that a surface faces, as one of kFacings.
constexpr size_t kFacings = 125;
inline size_t facing_of(const SurfaceTile& s, int i) {
  const auto side = [](float n) { return n > 0.75f ? 4u : n > 0.25f ? 3u : n > -0.25f ? 2u : n > -0.75f ? 1u : 0u; };
  return side(s.plane[kNormal][i]) * 25 + side(s.plane[kNormal + 1][i]) * 5 + side(s.plane[kNormal + 2][i]);
}

/// Sorts numbers by a key below kKeys; those of one key keep their order and begin at first[key].
template <size_t kKeys, class Key>
void sort_by_key(std::span<const uint16_t> in, const Key& key, uint16_t* out, std::array<uint16_t, kKeys + 1>& first) {
  first = {};
  for (const uint16_t i : in) ++first[key(i) + 1];
  for (size_t k = 0; k < kKeys; ++k) first[k + 1] = uint16_t(first[k + 1] + first[k]);
  std::array<uint16_t, kKeys> next;
  std::copy_n(first.begin(), kKeys, next.begin());
  for (const uint16_t i : in) out[next[key(i)]++] = i;
}

/// Divides the covered pixels of a tile into groups that face one way. In a group the pixels of an object lie together.
inline void group_pixels(const SurfaceTile& s, const TileRegions& regions, int blocks, PixelGroups& out) {
  uint16_t pixels[kMaxTilePixels], by_object[kMaxTilePixels];
  size_t count = 0;
  for (int k = 0; k < regions.count; ++k) {
    const Region& r = regions.region[k];
    for (int b = 0; b < r.wide * r.tall; ++b) {
      const int first = ((r.by + b / r.wide) * blocks + r.bx + b % r.wide) * kBlockPixels;
      for (int i = first; i < first + kBlockPixels; ++i) {
        pixels[count] = uint16_t(i);
        count += s.covered[i] != 0;
      }
    }
  }
  std::array<uint16_t, 257> objects;
  std::array<uint16_t, kFacings + 1> facings;
  sort_by_key<256>(
      {pixels, count}, [&](uint16_t i) { return s.object[i] & 255; }, by_object, objects);
  sort_by_key<kFacings>(
      {by_object, count}, [&](uint16_t i) { return facing_of(s, i); }, out.pixel, facings);
  out.first.clear();
  for (size_t f = 0; f < kFacings; ++f)
    for (uint16_t at = facings[f]; at < facings[f + 1]; at = uint16_t(at + PixelGroups::kMost)) out.first.push_back(at);
  out.first.push_back(uint16_t(count));
}

/// Balls that hold the positions, the N and the V of all surfaces of a region.
struct RegionBalls {
  Ball position, normal;
  float viewer[3], viewer_radius;

  RegionBalls(const Box& position_box, const Box& normal_box, const LightTable& lights, const LightModel& model)
      : position(position_box), normal(normal_box) {
    if (model.renormalize) {  // unit vectors differ by at most twice the distance over the length of either
      const float length = std::sqrt((normal.center[0] * normal.center[0] + normal.center[1] * normal.center[1]) +
                                     normal.center[2] * normal.center[2]);
      for (float& n : normal.center) n = n / length;
      normal.radius = 2.0f * normal.radius / length;
      normal.farthest = 1.0f + 0x1p-18f;
    }
    float toward[3], length2 = 0.0f;
    for (int c = 0; c < 3; ++c) toward[c] = lights.eye[c] - position.center[c], length2 += toward[c] * toward[c];
    const float length = std::sqrt(length2);
    const bool local = model.viewer == Viewer::local;
    for (int c = 0; c < 3; ++c) viewer[c] = local ? toward[c] / length : lights.view_axis[c];
    const float share = position.radius / length;
    viewer_radius = local ? share < 0.25f ? 1.02f * share : 2.0f * share : 0.0f;
  }
};

inline void list_bits(std::span<const uint64_t> words, size_t count, std::vector<uint32_t>& out) {
  out.resize(count);
  uint32_t* next = out.data();
  for (size_t w = 0; w < words.size(); ++w)
    for_each_bit(words[w], 64 * w, count, [&](size_t i) { *next++ = uint32_t(i); });
  out.resize(size_t(next - out.data()));
}

/// Bounds over a region for a vector of lights.
struct LightBounds {
  static constexpr float kSlack = 0x1p-14f;  // more than the roundings of what is bounded and of the bounds
  VF length;                                 ///< from the region's centre to the light
  VF most_facing;                            ///< N . L
  VF most_toward;                            ///< N . H times the length of H
  VF least_half;                             ///< length of H

  HWY_INLINE LightBounds(const LightTable& table, const RegionBalls& at, size_t i) {
    const DF d;
    const VF zero = hn::Zero(d);
    const float size = at.normal.farthest;
    VF to_light[3], length2 = zero, facing = zero, half2 = zero;
    for (int c = 0; c < 3; ++c) {
      to_light[c] = hn::Sub(hn::LoadU(d, table.position[c].data() + i), hn::Set(d, at.position.center[c]));
      length2 = hn::Add(length2, hn::Mul(to_light[c], to_light[c]));
    }
    length = hn::Sqrt(length2);
    const VF inverse = hn::Div(hn::Set(d, 1.0f), length);
    VF spread = hn::Mul(inverse, hn::Set(d, at.position.radius));  // of L about the centre's
    spread =
        hn::IfThenElse(hn::Lt(spread, hn::Set(d, 0.25f)), hn::Mul(spread, hn::Set(d, 1.02f)), hn::Add(spread, spread));
    float toward_viewer = 0.0f;
    for (int c = 0; c < 3; ++c) {
      const VF l = hn::Mul(to_light[c], inverse), h = hn::Add(l, hn::Set(d, at.viewer[c]));
      facing = hn::Add(facing, hn::Mul(l, hn::Set(d, at.normal.center[c])));
      half2 = hn::Add(half2, hn::Mul(h, h));
      toward_viewer += at.viewer[c] * at.normal.center[c];
    }
    const VF loose = hn::Mul(spread, hn::Set(d, size));
    most_facing = hn::Add(hn::Add(facing, loose), hn::Set(d, at.normal.radius + kSlack * size));
    most_toward = hn::Add(hn::Add(facing, loose), hn::Set(d, toward_viewer + 2.0f * at.normal.radius +
                                                                 size * at.viewer_radius + 4.0f * kSlack * size));
    least_half = hn::Sub(hn::Sub(hn::Sqrt(half2), spread), hn::Set(d, at.viewer_radius + kSlack));
  }
};

/// The most that the specular terms of a vector of lights add to any pixel of a region.
HWY_INLINE VF most_shine(const BoundedLights& bounded, const LightBounds& bounds, const RegionBalls& at,
                         float most_specular, size_t i) {
  const DF d;
  const VF one = hn::Set(d, 1.0f), zero = hn::Zero(d);
  const VF toward =
      hn::IfThenElseZero(hn::Gt(bounds.most_toward, zero), hn::Div(bounds.most_toward, bounds.least_half));
  const VF cosine = hn::Add(toward, hn::Set(d, 64 * LightBounds::kSlack * at.normal.farthest));
  const VF power = integer_power<2 * QuadraticBlinn::shape.power>(cosine);
  const VF gap = hn::Mul(hn::Sub(bounds.length, hn::Set(d, at.position.radius)), hn::Set(d, 1.0f - 0x1p-18f));
  const VF distance = hn::IfThenElseZero(hn::Gt(gap, zero), gap);
  const VF weaker = hn::Add(one, hn::Mul(distance, hn::Add(hn::LoadU(d, bounded.k1.data() + i),
                                                           hn::Mul(distance, hn::LoadU(d, bounded.k2.data() + i)))));
  const VF strongest = hn::Mul(hn::LoadU(d, bounded.strongest.data() + i), hn::Set(d, most_specular));
  return hn::Div(hn::Mul(strongest, power), weaker);
}

/// Sorts the lights of a region into lists. A light's specular term is left out where it adds at most `least`.
inline void sort_lights(const LightTable& table, const BoundedLights& bounded, const LightModel& model,
                        const RegionBalls& at, float least, LightsByGloss& out) {
  const DF d;
  const VF zero = hn::Zero(d);
  const float most_specular =
      std::max({model.specular_color[0], model.specular_color[1], model.specular_color[2]}) * (1.0f + 0x1p-8f);
  const size_t words = (bounded.quadratic.size() + 63) / 64;
  out.matte_bits.assign(words, 0);
  out.shiny_bits.assign(words, 0);
  VF left_out = zero;
  for (size_t i = 0; i < bounded.quadratic.size(); i += hn::Lanes(d)) {
    const LightBounds bounds(table, at, i);
    const VF shine = most_shine(bounded, bounds, at, most_specular, i);
    // False where a side is no number.
    const MF away = hn::Lt(bounds.most_facing, zero);
    const MF dull = hn::And(hn::Gt(bounds.least_half, hn::Set(d, 0x1p-5f)), hn::Le(shine, hn::Set(d, least)));
    const MF unseen = QuadraticBlinn::shape.specular_masked ? away : hn::And(away, dull);
    left_out = hn::Add(left_out, hn::IfThenElseZero(dull, shine));
    out.matte_bits[i / 64] |= mask_bits(hn::AndNot(unseen, dull)) << i % 64;
    out.shiny_bits[i / 64] |= mask_bits(hn::Not(hn::Or(unseen, dull))) << i % 64;
  }
  alignas(64) float lane[HWY_MAX_BYTES / sizeof(float)];
  list_bits(out.matte_bits, bounded.quadratic.size(), out.matte);
  list_bits(out.shiny_bits, bounded.quadratic.size(), out.shiny);
  hn::Store(left_out, d, lane);
  out.left_out = 0.0f;
  for (size_t k = 0; k < hn::Lanes(d); ++k) out.left_out += lane[k];
  out.left_out *= 1.0f + 0x1p-8f;
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
