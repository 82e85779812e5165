// Sums of many lights that are only wanted as codes of a fixed-point target: computed more cheaply, with a bound of the
// error; where all of an interval has one code that is the code (Ziv, Fast evaluation of elementary mathematical
// functions with correctly rounded last bit, 1991). The proof is docs/proofs.md section 16. Included once per SIMD
// target.
#if defined(TRUESHADE_SHADING_SUM_BOUNDED_BOUNDED_QUADRATIC_SUM_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRUESHADE_SHADING_SUM_BOUNDED_BOUNDED_QUADRATIC_SUM_INL_H_
#undef TRUESHADE_SHADING_SUM_BOUNDED_BOUNDED_QUADRATIC_SUM_INL_H_
#else
#define TRUESHADE_SHADING_SUM_BOUNDED_BOUNDED_QUADRATIC_SUM_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "core/simd/store-inl.h"
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

/// Which way a surface faces, roughly.
constexpr size_t kFacings = 125;
inline size_t facing_of(const SurfaceTile& s, int i) {
  const auto side = [](float n) { return n > 0.75f ? 4u : n > 0.25f ? 3u : n > -0.25f ? 2u : n > -0.75f ? 1u : 0u; };
  return side(s.plane[kNormal][i]) * 25 + side(s.plane[kNormal + 1][i]) * 5 + side(s.plane[kNormal + 2][i]);
}

/// Sorts by a key below kKeys, equal ones as they were; first[key]: where those of each begin.
template <size_t kKeys, class Key>
void sort_by_key(std::span<const uint16_t> in, const Key& key, uint16_t* out, std::array<uint16_t, kKeys + 1>& first) {
  first = {};
  for (const uint16_t i : in) ++first[key(i) + 1];
  for (size_t k = 0; k < kKeys; ++k) first[k + 1] = uint16_t(first[k + 1] + first[k]);
  std::array<uint16_t, kKeys> next;
  std::copy_n(first.begin(), kKeys, next.begin());
  for (const uint16_t i : in) out[next[key(i)]++] = i;
}

/// Covered pixels of a tile in groups that face one way, in each those of an object together.
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

/// What the surfaces of a region have in common: where they are, their N and V.
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

/// Sums of a vector of pixels before the surface's colours multiply them.
struct QuadraticSum {
  VF diffuse[3], shine[3];
  hn::Vec<DI> lights;  ///< that light each pixel: exact

  QuadraticSum() : lights(hn::Zero(DI())) {
    for (int c = 0; c < 3; ++c) diffuse[c] = shine[c] = hn::Zero(DF());
  }
};

/// kMany lights, a step of each after the other.
template <size_t kMany, bool kShines>
HWY_INLINE void add_quadratic(const PixelVector& px, const QuadraticLight* lights, const uint32_t* index,
                              QuadraticSum& sum) {
  const DF d;
  const DI di;
  using Shape = QuadraticBlinn;
  const VF one = hn::Set(d, 1.0f), zero = hn::Zero(d);
  VF to_light[kMany][3], nl[kMany], d2[kMany], weaker[kMany], distance[kMany], weight[kMany], shine[kMany];
  MF lit[kMany];
  for (size_t k = 0; k < kMany; ++k) {
    for (int c = 0; c < 3; ++c) to_light[k][c] = hn::Sub(hn::Set(d, lights[index[k]].position[c]), px.p[c]);
    nl[k] = dot3(px.n, to_light[k]);
    d2[k] = dot3(to_light[k], to_light[k]);
    lit[k] = hn::Gt(nl[k], zero);
    sum.lights = hn::Add(sum.lights, hn::IfThenElseZero(hn::RebindMask(di, lit[k]), hn::Set(di, 1)));
  }
  for (size_t k = 0; k < kMany; ++k) {
    distance[k] = hn::Sqrt(d2[k]);
    const VF linear = hn::Add(one, hn::Mul(hn::Set(d, lights[index[k]].k1), distance[k]));
    weaker[k] = hn::Add(linear, hn::Mul(hn::Mul(hn::Set(d, lights[index[k]].k2), distance[k]), distance[k]));
  }
  if constexpr (!kShines) {
    for (size_t k = 0; k < kMany; ++k)
      weight[k] = hn::IfThenElseZero(lit[k], hn::Div(nl[k], hn::Mul(distance[k], weaker[k])));
  } else {
    VF half2[kMany], along[kMany];
    for (size_t k = 0; k < kMany; ++k) {
      const VF inverse = hn::Div(one, distance[k]);
      VF half[3];
      for (int c = 0; c < 3; ++c) half[c] = hn::Add(hn::Mul(to_light[k][c], inverse), px.v[c]);
      half2[k] = dot3(half, half);
      along[k] = dot3(px.n, half);
      nl[k] = hn::IfThenElseZero(lit[k], hn::Mul(nl[k], inverse));
    }
    for (size_t k = 0; k < kMany; ++k) {
      const VF quotient = hn::Div(one, hn::Mul(half2[k], weaker[k])), strength = hn::Mul(quotient, half2[k]);
      const VF t = hn::IfThenElseZero(hn::Gt(along[k], zero), along[k]);
      VF x = hn::Mul(hn::Mul(t, t), hn::Mul(quotient, weaker[k]));
      if (Shape::shape.renormalize) x = at_most(x, 1.0f);
      const VF power = integer_power<Shape::shape.power>(x);
      weight[k] = hn::Mul(nl[k], strength);
      shine[k] = hn::Mul(power, strength);
      if (Shape::shape.specular_masked) shine[k] = hn::IfThenElseZero(lit[k], shine[k]);
    }
  }
  for (size_t k = 0; k < kMany; ++k)
    for (int c = 0; c < 3; ++c) {
      const VF color = hn::Set(d, lights[index[k]].color[c]);
      sum.diffuse[c] = hn::Add(sum.diffuse[c], hn::Mul(color, weight[k]));
      if constexpr (kShines) sum.shine[c] = hn::Add(sum.shine[c], hn::Mul(color, shine[k]));
    }
}

/// The lights of a list, part by part, so that the parts' roundings do not add up.
template <bool kShines>
HWY_NOINLINE void add_quadratic_lights(const PixelVector& px, const BoundedLights& bounded,
                                       std::span<const uint32_t> list, QuadraticSum& total) {
  constexpr size_t kTogether = 4;
  const QuadraticLight* const lights = bounded.quadratic.data();
  for (size_t from = 0; from < list.size(); from += kSumPart) {
    const size_t end = std::min(list.size(), from + kSumPart);
    QuadraticSum part;
    size_t i = from;
    for (; i + kTogether <= end; i += kTogether) add_quadratic<kTogether, kShines>(px, lights, &list[i], part);
    for (; i < end; ++i) add_quadratic<1, kShines>(px, lights, &list[i], part);
    for (int c = 0; c < 3; ++c) {
      total.diffuse[c] = hn::Add(total.diffuse[c], part.diffuse[c]);
      if constexpr (kShines) total.shine[c] = hn::Add(total.shine[c], part.shine[c]);
    }
    total.lights = hn::Add(total.lights, part.lights);
  }
}

/// Pixels whose numbers are in the ranges of section 16.
HWY_INLINE MF pixels_in_proof_range(const PixelVector& px) {
  const DF d;
  const VF zero = hn::Zero(d);
  MF holds = px.covered;
  for (int c = 0; c < 3; ++c) {
    const VF size = hn::Abs(px.p[c]);
    const MF sized = hn::And(hn::Ge(size, hn::Set(d, 0x1p-40f)), hn::Le(size, hn::Set(d, 0x1p30f)));
    holds = hn::And(holds, hn::Or(sized, hn::Eq(size, zero)));
    holds = hn::And(holds, hn::Le(hn::Abs(px.n[c]), hn::Set(d, kMostProvenNormal)));
    holds = hn::And(holds, hn::And(hn::Ge(px.albedo[c], zero), hn::Le(px.albedo[c], hn::Set(d, kMostProvenAlbedo))));
  }
  return holds;
}

/// Values of the pixels that have the right codes in the pixels returned, and mean nothing elsewhere.
HWY_INLINE MF bounded_colors(const PixelVector& px, const QuadraticSum& sum, float relative, float left_out,
                             Format format, VF color[3]) {
  const DF d;
  constexpr float kAbsolute = 0x1p-60f;  // covers what underflows
  MF proved = pixels_in_proof_range(px);
  for (int c = 0; c < 3; ++c) {
    const VF value = hn::Add(hn::Mul(sum.diffuse[c], px.albedo[c]), hn::Mul(sum.shine[c], px.specular[c]));
    const VF low = hn::Sub(hn::Mul(value, hn::Set(d, 1.0f - relative)), hn::Set(d, kAbsolute));
    const VF high = hn::Mul(hn::Add(value, hn::Set(d, left_out + kAbsolute)), hn::Set(d, 1.0f + relative));
    const MF same = hn::Eq(encoded(low, format, c, HalfRound::nearest), encoded(high, format, c, HalfRound::nearest));
    proved = hn::And(proved, hn::And(same, hn::Lt(low, high)));  // which no NaN is
    color[c] = low;
  }
  return proved;
}

}  // namespace trueshade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target include guard
