#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/fp_env.h"
#include "oracle/exact_coverage.h"
#include "oracle/intervals/judge.h"
#include "oracle/intervals/shading.h"
#include "oracle/intervals/surface.h"
#include "oracle/intervals/tally.h"
#include "oracle/scalar_renderer.h"

namespace trueshade::oracle {

namespace {

constexpr size_t kMostBranches = 8;  // 256 sums; beyond that the hull of all of them

class LightingJudge {
 public:
  LightingJudge(const Scene& scene, const Pipeline& pipeline, const Profile& profile, const Capture& capture)
      : scene_(scene),
        pipeline_(pipeline),
        profile_(profile),
        color_(required(capture, "color")),
        normal_(required(capture, "normal")),
        albedo_(required(capture, "albedo")),
        object_(plane_of(capture, pipeline, "id.object")),
        count_(plane_of(capture, pipeline, "light.count")),
        specular_(reads_specular_plane(pipeline.light_model) ? required(capture, "specular") : PlaneView{}),
        emission_(pipeline.light_model.emission ? required(capture, "emission") : PlaneView{}),
        viewport_(resolved_viewport(pipeline.geometry, pipeline.width, pipeline.height)),
        lights_(scene, pipeline.light_model,
                view_axis(projection_of(scene.camera, pipeline.geometry, pipeline.width, pipeline.height)),
                profile.arithmetic, profile.exact_planes, pipeline.light_volumes) {
    if (pipeline.gbuffer.position_from_depth) {
      depth_ = required(capture, "depth");
      invert();
    } else {
      position_ = required(capture, "position");
      depth_ = plane_of(capture, pipeline, "depth");
    }
    if (!object_ && !depth_)
      throw Error(ErrorKind::bad_input, "capture", "does not say where a surface is", "capture id.object or depth");
  }

  void judge_row(int y, RowTally& row) const {
    for (int x = 0; x < pipeline_.width; ++x) judge_pixel(x, y, row);
  }

 private:
  PlaneView required(const Capture& capture, std::string_view name) const {
    const PlaneView view = plane_of(capture, pipeline_, name);
    if (!view)
      throw Error(ErrorKind::bad_input, "capture", "has no plane " + std::string(name), "lighting is judged from it");
    return view;
  }

  bool covered(int x, int y) const {
    return object_ ? object_.stored(x, y, 0) != 0 : !is_clear_depth(pipeline_.geometry, depth_.stored(x, y, 0));
  }

  /// A channel as the shader reads it; unorm codes k as k / largest with the profile's fetch error.
  Bounded fetched(const PlaneView& view, int x, int y, int channel) const {
    const double stored = view.stored(x, y, channel);
    if (!view.unorm()) return {stored, 0};
    const double largest = view.layout.largest_code(channel), value = stored / largest;
    return {value, stored == 0 || stored == largest ? 0 : value * profile_.fetch_error};
  }

  ShadedSurface surface_at(int x, int y) const {
    ShadedSurface s;
    for (int k = 0; k < 3; ++k) {
      if (position_) s.position[size_t(k)] = {position_.stored(x, y, k), 0};
      s.normal[size_t(k)] = fetched(normal_, x, y, k);
    }
    for (int k = 0; k < 4; ++k) s.albedo[size_t(k)] = k < albedo_.channels ? fetched(albedo_, x, y, k) : Bounded{1, 0};
    for (int k = 0; k < 3; ++k) {
      if (specular_) s.specular[size_t(k)] = fetched(specular_, x, y, k);
      if (emission_) s.emission[size_t(k)] = fetched(emission_, x, y, k);
    }
    if (specular_) s.shininess = specular_.stored(x, y, 3);
    if (!position_) s.position = position_from_depth(x, y);
    return s;
  }

  void invert();
  Bounded3 position_from_depth(int x, int y) const;
  bool fits(const LitRange& lit, const std::array<double, 3>& change, int x, int y, Match& m) const;
  void judge_pixel(int x, int y, RowTally& row) const;
  void judge_uncovered(int x, int y, RowTally& row) const;

  const Scene& scene_;
  const Pipeline pipeline_;
  const Profile profile_;
  PlaneView color_, normal_, albedo_, object_, count_, specular_, emission_, position_, depth_;
  Viewport viewport_;
  LightBounds lights_;
  Matrix4 world_from_clip_{};
};

/// Gauss-Jordan with pivots, in long double: no matrix code of the renderer's.
void LightingJudge::invert() {
  const Matrix4 m = projection_of(scene_.camera, pipeline_.geometry, pipeline_.width, pipeline_.height);
  long double a[4][8] = {};
  for (size_t r = 0; r < 4; ++r)
    for (size_t c = 0; c < 4; ++c) a[r][c] = static_cast<long double>(m[4 * c + r]), a[r][4 + c] = r == c ? 1 : 0;
  for (size_t c = 0; c < 4; ++c) {
    size_t pivot = c;
    for (size_t r = c + 1; r < 4; ++r)
      if (std::fabs(a[r][c]) > std::fabs(a[pivot][c])) pivot = r;
    if (a[pivot][c] == 0)
      throw Error(ErrorKind::bad_input, "camera", "its matrix has no inverse", "position from depth needs one");
    std::swap(a[c], a[pivot]);
    for (size_t k = 8; k-- > c;) a[c][k] /= a[c][c];
    for (size_t r = 0; r < 4; ++r) {
      const long double factor = a[r][c];
      for (size_t k = c; k < 8 && r != c; ++k) a[r][k] -= factor * a[c][k];
    }
  }
  for (size_t r = 0; r < 4; ++r)
    for (size_t c = 0; c < 4; ++c) world_from_clip_[4 * c + r] = double(a[r][4 + c]);
}

/// docs/arithmetic.md section 7. Each product of a row passes the matrix element's rounding, its own and three sums.
Bounded3 LightingJudge::position_from_depth(int x, int y) const {
  const Arithmetic& a = profile_.arithmetic;
  const double v = a.roundoff, near = double(pipeline_.geometry.depth_near), far = double(pipeline_.geometry.depth_far);
  const bool zero_to_one = pipeline_.geometry.clip_depth == ClipDepth::zero_to_one;
  const double scale = zero_to_one ? far - near : (far - near) / 2, offset = zero_to_one ? near : (near + far) / 2;
  const auto ndc = [&](double centre, int corner, int size) {
    const double at = (centre - corner) * 2 / size;
    return Bounded{at - 1, 3 * v * (std::fabs(at) + 1)};
  };
  const double z = depth_.stored(x, y, 0);
  const bool codes = pipeline_.geometry.depth_format != Format::d32f;
  const double fetch = codes && z != 1 ? z * profile_.fetch_error : 0;  // a code is read as a float
  std::array<Bounded, 4> p = {
      ndc(x + 0.5, viewport_.x, viewport_.width), ndc(pipeline_.height - 1 - y + 0.5, viewport_.y, viewport_.height),
      Bounded{(z - offset) / scale, (4 * v * (std::fabs(z) + std::fabs(offset)) + fetch) / std::fabs(scale)},
      Bounded{1, 0}};
  if (pipeline_.geometry.clip_origin == ClipOrigin::upper_left) p[1].value = -p[1].value;
  std::array<Bounded, 4> h;
  for (size_t r = 0; r < 4; ++r)
    for (size_t c = 0; c < 4; ++c) {
      const double m = world_from_clip_[4 * c + r];
      h[r].value += m * p[c].value;
      h[r].error += std::fabs(m) * p[c].error + 5 * v * std::fabs(m) * (std::fabs(p[c].value) + p[c].error);
    }
  const Bounded one_over_w = quotient(a, {1, 0}, h[3]);
  return {product(a, h[0], one_over_w), product(a, h[1], one_over_w), product(a, h[2], one_over_w)};
}

bool LightingJudge::fits(const LitRange& lit, const std::array<double, 3>& change, int x, int y, Match& m) const {
  const uint32_t pixel = uint32_t(y) * uint32_t(pipeline_.width) + uint32_t(x);
  for (int k = 0; k < 3; ++k) {
    Bounded c = lit.color[size_t(k)];
    c.value += change[size_t(k)];
    Range range = range_of(c);
    if (pipeline_.light_model.clamp_result)
      range = {std::clamp(range.value, 0.0, 1.0), std::clamp(range.low, 0.0, 1.0), std::clamp(range.high, 0.0, 1.0)};
    m.channel_is(color_, "color", k, range, color_.stored(x, y, k), pixel, profile_);
  }
  return m.legal;
}

void LightingJudge::judge_uncovered(int x, int y, RowTally& row) const {
  Match m;
  const uint32_t pixel = uint32_t(y) * uint32_t(pipeline_.width) + uint32_t(x);
  for (int k = 0; k < color_.channels; ++k) {
    const double c = double(scene_.clear[k]);
    m.channel_is(color_, "color", k, {c, c, c}, color_.stored(x, y, k), pixel, profile_);
  }
  row.take(x, y,
           !m.legal   ? PixelClass::violation
           : m.second ? PixelClass::store_2
                      : PixelClass::exact,
           m, "nothing drawn");
}

void LightingJudge::judge_pixel(int x, int y, RowTally& row) const {
  if (!covered(x, y)) return judge_uncovered(x, y, row);
  ++row.covered;
  const ShadedSurface surface = surface_at(x, y);
  const LitRange lit = lights_.at(surface);
  if (lit.undefined) return row.take(x, y, PixelClass::undefined, {}, "");
  if (!lit.branches.empty()) row.may_be_other(uint64_t(y) << 32 | uint64_t(x), 0.5);
  Match nominal;
  const auto others = [&](Match& m) {
    if (color_.channels > 3) {
      const Bounded alpha = pipeline_.light_model.alpha_from_albedo ? surface.albedo[3] : Bounded{1, 0};
      m.channel_is(color_, "color", 3, range_of(alpha), color_.stored(x, y, 3),
                   uint32_t(y) * uint32_t(pipeline_.width) + uint32_t(x), profile_);
    }
    const double lights = count_ ? count_.stored(x, y, 0) : 0;
    if (count_ && (lights < lit.lights_low || lights > lit.lights_high))
      m.note("light.count", 0, {double(lit.lights_low), double(lit.lights_low), double(lit.lights_high)}, lights, 1);
  };
  fits(lit, {}, x, y, nominal);
  others(nominal);
  if (nominal.legal) return row.take(x, y, nominal.second ? PixelClass::store_2 : PixelClass::exact, nominal, "");
  const size_t count = lit.branches.size();
  if (count > 0 && count <= kMostBranches) {
    for (size_t set = 1; set < size_t(1) << count; ++set) {
      std::array<double, 3> change{};
      for (size_t i = 0; i < count; ++i)
        for (size_t k = 0; k < 3 && (set >> i & 1) != 0; ++k) change[k] += lit.branches[i].change[k];
      Match m;
      fits(lit, change, x, y, m);
      others(m);
      if (m.legal) return row.take(x, y, PixelClass::branch, m, std::to_string(count) + " lights at their threshold");
    }
  } else if (count > kMostBranches) {
    LitRange hull = lit;
    for (const OtherBranch& b : lit.branches)
      for (size_t k = 0; k < 3; ++k) hull.color[k].error += std::fabs(b.change[k]);
    Match m;
    fits(hull, {}, x, y, m);
    others(m);
    if (m.legal) return row.take(x, y, PixelClass::branch, m, std::to_string(count) + " lights at their threshold");
  }
  nominal.choices.clear();
  nominal.stored_values = 0;
  row.take(x, y, PixelClass::violation, nominal, "");
}

}  // namespace

StageVerdict judge_lighting(const Scene& scene, const Pipeline& pipeline, const Profile& profile,
                            const Capture& capture) {
  if (blends_lights(pipeline.strategy))
    throw Error(ErrorKind::usage, "strategy",
                std::string(name_of(pipeline.strategy)) + " is not judged: its lights are blended draw by draw",
                "forward-loop or deferred-loop");
  const Profile p = resolved(profile, pipeline);
  const LightingJudge judge(scene, pipeline, p, capture);
  std::vector<RowTally> rows(size_t(pipeline.height));
  parallel_for(pipeline.height, 0, [&](int y) { judge.judge_row(y, rows[size_t(y)]); });
  return verdict_of("lighting", p, pipeline.width, pipeline.height, rows);
}

}  // namespace trueshade::oracle
