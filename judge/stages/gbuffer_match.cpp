#include <algorithm>
#include <cmath>
#include <type_traits>

#include "core/error.h"
#include "judge/stages/gbuffer_judge.h"
#include "judge/stages/judge_transparency.h"
#include "scenes/pipeline/transparency.h"

namespace trueshade::oracle {

namespace {

/// A stand-in for Match, with its members, that finds out only whether a pixel is legal.
struct Legality {
  bool legal = true;
  static constexpr double excess = HUGE_VAL;

  void channel_is(const PlaneView& view, const char*, int channel, const Range& range, double stored, uint32_t,
                  const Profile& profile) {
    if (view.quantised())
      legal = legal && legal_texel(range, view.image->format, channel, profile).contains(stored);
    else
      legal = legal && ((stored >= range.low && stored <= range.high) || legal_float(range).contains(stored));
  }
  void lookup_is(const PlaneView& view, const char* name, int channel, const Range& range, double stored,
                 uint32_t pixel, const Profile& profile) {
    channel_is(view, name, channel, range, stored, pixel, profile);
  }
  void texel_is(const PlaneView&, const char*, int, const LegalTexel& texel, double, double stored, uint32_t,
                const Profile&) {
    legal = legal && texel.contains(stored);
  }
  void note(const char*, int, const LegalTexel&, double, double) { legal = false; }
};

/// The profile with lookups that are off by nothing but roundings of floats.
Profile with_exact_filters(const Profile& profile) {
  Profile p = profile;
  p.sampling = profile_named("ideal")->sampling;
  p.sampling.lod_error = 0x1p-10, p.sampling.relative = Sampling{}.relative;
  return p;
}

/// Adds the verdict on a legal albedo under transparent surfaces to a match.
void take_layers(const LayeredVerdict& v, Match& m) {
  m.second = m.second || v.match.second, m.tex = m.tex || v.pixel_class == PixelClass::tex;
  m.worst_error = std::max(m.worst_error, v.match.worst_error);
  if (worse(v.pixel_class, PixelClass::tex)) m.layered = v.pixel_class;
}

}  // namespace

GBufferJudge::GBufferJudge(const Scene& scene, const Pipeline& pipeline, const Profile& profile, const Capture& capture,
                           const JudgedRows& rows, Asked asked, const PossibleSurfaces* wider,
                           std::shared_ptr<LevelHulls> hulls)
    : projector_(scene, pipeline, profile, capture.drawn_at, std::move(hulls)),
      pipeline_(pipeline),
      profile_(profile),
      asked_(asked),
      mask_(capture.mask),
      wider_(wider),
      depth_(plane_of(capture, pipeline, "depth")),
      object_(plane_of(capture, pipeline, "id.object")),
      material_(plane_of(capture, pipeline, "id.material")),
      specular_(reads_specular_plane(pipeline.light_model) ? plane_of(capture, pipeline, "specular") : PlaneView{}),
      emission_(pipeline.light_model.emission ? plane_of(capture, pipeline, "emission") : PlaneView{}) {
  if (pipeline.light_model.keeps_metals)
    metallic_ = plane_of(capture, pipeline, "metallic"), roughness_ = plane_of(capture, pipeline, "roughness");
  const GBufferState& g = pipeline.gbuffer;
  const AttributePlane all[] = {
      {"position", plane_of(capture, pipeline, "position"), kPosition, 3, {0, 1}, g.position.interpolation},
      {"normal", plane_of(capture, pipeline, "normal"), kNormal, 3, {0, 1}, g.normal.interpolation},
      {"albedo", plane_of(capture, pipeline, "albedo"), kAlbedo, 4, {0, 0}, g.albedo.interpolation},
      {"uv", plane_of(capture, pipeline, "uv"), kUv, 2, {0, 1}, g.uv.interpolation}};
  for (const AttributePlane& p : all)
    if (p.view && !(g.position_from_depth && p.first == kPosition)) planes_.push_back(p);
  if (planes_.empty() && !depth_ && !object_ && !material_)
    throw Error(ErrorKind::bad_input, capture.name, "has no G-buffer plane",
                "capture depth, position, normal, albedo, uv or ids");
  const bool is_textured =
      std::any_of(scene.materials.begin(), scene.materials.end(), [](const Material& m) { return m.textured(); });
  if (is_textured && asked == Asked::classes)
    exact_filters_.emplace(scene, pipeline, with_exact_filters(profile), capture.drawn_at, projector_.level_hulls());
  if (wider_ == nullptr) possible_ = possible_surfaces(projector_, rows);
  if (draws_transparent(scene, pipeline) && pipeline.transparency.mode == TransparencyMode::into_albedo &&
      capture.plane("albedo") != nullptr)
    layers_.emplace(scene, pipeline, profile, capture, rows);
}

bool GBufferJudge::is_clear(int x, int y) const {
  if (object_ && object_.stored(x, y, 0) != 0) return false;
  if (material_ && material_.stored(x, y, 0) != 0) return false;
  if (depth_ && !is_clear_depth(pipeline_.geometry, depth_.stored(x, y, 0))) return false;
  for (const AttributePlane& p : planes_)
    for (int c = 0; c < p.view.channels; ++c)
      if (p.view.stored(x, y, c) != 0 && !(p.first == kAlbedo && is_layered(p.view, x, y))) return false;
  return true;
}

bool GBufferJudge::is_layered(const PlaneView& view, int x, int y) const {
  if (!layers_ || !layers_->any(x, y)) return false;
  return judge_ways(layers_->ways(layers_->at(x, y), Texel{}), view, "albedo", x, y, profile_).pixel_class !=
         PixelClass::violation;
}

template <typename Found>
void GBufferJudge::judge_layered(const AttributePlane& plane, const SurfaceValues& surface, int x, int y_top,
                                 Found& m) const {
  Texel stored;
  for (int k = 0; k < plane.view.channels; ++k) {
    const Range base = surface.base_color(k, plane.interpolation);
    stored[size_t(k)] = legal_texel(k < 3 ? surface.albedo(base) : base, plane.view.image->format, k, profile_);
  }
  const TransparentPixel pixel = layers_->at(x, y_top);
  std::vector<LayeredTexel> ways{LayeredTexel{PixelClass::exact, stored, {}, false, false}};
  if (!pixel.layers.empty()) ways = layers_->ways(pixel, stored);
  for (LayeredTexel& way : ways) way.looked_up = way.looked_up || surface.textured();
  const LayeredVerdict v = judge_ways(ways, plane.view, "albedo", x, y_top, profile_);
  if (v.pixel_class == PixelClass::violation)
    return m.note("albedo", v.match.channel, v.match.legal_value, v.match.given, 1);
  if constexpr (std::is_same_v<Found, Match>) take_layers(v, m);
}

Range GBufferJudge::held_normal(const AttributePlane& plane, const SurfaceValues& surface, int k, int x,
                                int y_top) const {
  const Range n = surface.normal(k, plane.interpolation);
  if (plane.view.unorm()) return halved_normal(n, profile_);
  if (plane.view.decoded == nullptr || !plane.view.decoded->unit_length) return widened(n, plane.view, x, y_top);
  const auto component = [&](int c) { return surface.normal(c, plane.interpolation); };
  return widened(normalized(component(0), component(1), component(2), k, profile_), plane.view, x, y_top);
}

template <typename Found>
void GBufferJudge::judge_shininess(const Range& range, double stored, uint32_t pixel, bool looked_up, Found& m) const {
  if (!looked_up) return m.channel_is(specular_, "specular", 3, range, stored, pixel, profile_);
  m.lookup_is(specular_, "specular", 3, range, stored, pixel, profile_);
  if (stored != std::nearbyint(stored)) m.note("specular", 3, {range.value, range.low, range.high}, stored, 1);
}

/// A plane that no pipeline has a format for: an engine may hold it in codes of 8 bits, and hand it out as floats; or
/// in coarser codes, which its file tells.
template <typename Found>
void GBufferJudge::judge_own_plane(const PlaneView& view, const char* name, const Range& range, int x, int y_top,
                                   Found& m) const {
  const double half_code = std::max(0.504 / 255, view.packing_error(x, y_top));
  const double largest = view.unorm() ? double(view.layout.largest_code(0)) : 1.0,
               stored = view.stored(x, y_top, 0) / largest;
  if (stored >= range.low - half_code && stored <= range.high + half_code) return;
  m.note(name, 0, {range.value, range.low - half_code, range.high + half_code}, stored, 1);
}

template <typename Found>
bool GBufferJudge::compare(const Projector& projector, const PossibleSurface& c, int x, int y_top,
                           GBufferMemory& memory, SurfacePoint::Within within, Found& m) const {
  std::array<LastTexel, 4>& constants = memory.constants;
  const uint32_t pixel = uint32_t(y_top) * uint32_t(pipeline_.width) + uint32_t(x);
  const double sx = x + 0.5, sy = pipeline_.height - 1 - y_top + 0.5;
  const Instance& instance = projector_.scene().instances[c.instance];
  const auto identifier = [&](const PlaneView& view, const char* name, double expected) {
    if (view && view.stored(x, y_top, 0) != expected)
      m.note(name, 0, {expected, expected, expected}, view.stored(x, y_top, 0), 1);
  };
  identifier(object_, "id.object", c.instance + 1.0);
  identifier(material_, "id.material", instance.material + 1.0);
  if (!m.legal && object_) return true;
  const SurfaceValues surface(projector, memory.forms.of(c.instance, c.triangle), c, sx, sy, within);
  const bool bounded = surface.bounded();
  if (depth_)
    m.channel_is(depth_, "depth", 0, widened(surface.depth(), depth_, x, y_top),
                 depth_in_buffer(pipeline_.geometry, depth_.stored(x, y_top, 0)), pixel, profile_);
  if (!m.legal && m.excess > 1e3) return bounded;  // another surface altogether
  const auto judge_channel = [&](const PlaneView& view, const char* name, int k, const Range& range, double stored,
                                 bool looked_up) {
    if (looked_up)
      m.lookup_is(view, name, k, range, stored, pixel, profile_);
    else
      m.channel_is(view, name, k, range, stored, pixel, profile_);
  };
  const bool layered = layers_ && layers_->any(x, y_top);
  for (const AttributePlane& p : planes_) {
    if (layered && p.first == kAlbedo) judge_layered(p, surface, x, y_top, m);
    for (int k = 0; k < p.view.channels; ++k) {
      const double stored = p.view.stored(x, y_top, k);
      if (k >= p.count) {
        const double rest = p.view.constant(p.rest[k - 2], k);
        if (stored != rest) m.note(p.name, k, {rest, rest, rest}, stored, 1);
        continue;
      }
      if (p.first == kNormal) {
        judge_channel(p.view, p.name, k, held_normal(p, surface, k, x, y_top), stored, surface.bumpy());
        continue;
      }
      if (p.first != kAlbedo) {
        const Range range = surface.attribute(p.first + size_t(k), p.interpolation);
        m.channel_is(p.view, p.name, k, widened(range, p.view, x, y_top), stored, pixel, profile_);
        continue;
      }
      const Range base = surface.base_color(k, p.interpolation);
      if (specular_ && k < 3)
        judge_channel(specular_, "specular", k, surface.specular(base, k), specular_.stored(x, y_top, k),
                      surface.glossy());
      if (layered) continue;
      const Range held = k < 3 ? surface.albedo(base) : base;
      if (surface.textured() || !p.view.quantised())
        judge_channel(p.view, p.name, k, held, stored, surface.textured());
      else
        m.texel_is(p.view, p.name, k, constants[size_t(k)].of(held, p.view, k, profile_), held.value, stored, pixel,
                   profile_);
    }
  }
  if (metallic_ && !surface.material().unlit)
    judge_own_plane(metallic_, "metallic", surface.specular({}, 0), x, y_top, m);
  if (roughness_ && !surface.material().unlit)
    judge_own_plane(roughness_, "roughness", surface.specular({}, 1), x, y_top, m);
  if (specular_ && specular_.channels > 3)
    judge_shininess(surface.shininess(), specular_.stored(x, y_top, 3), pixel, surface.rough(), m);
  for (int k = 0; k < 4 && emission_; ++k) {
    if (k >= emission_.channels) continue;
    const Range range = k < 3 ? surface.emission(surface.base_color(k, pipeline_.gbuffer.albedo.interpolation), k)
                        : info(pipeline_.gbuffer.emission).channels > 3 ? surface.ambient_share()
                                                                        : Range{1, 1, 1};  // another format stands in
    judge_channel(emission_, "emission", k, range, emission_.stored(x, y_top, k),
                  k < 3 ? surface.glowing() : surface.shaded());
  }
  return bounded;
}

Match GBufferJudge::match(const PossibleSurface& c, int x, int y_top, GBufferMemory& memory, bool& bounded,
                          double worst_error) const {
  Match m;
  m.worst_error = worst_error;
  bounded = compare(projector_, c, x, y_top, memory, SurfacePoint::Within::box, m);
  if (!m.legal || !m.off_lookup || m.tex || !exact_filters_) return m;
  Legality exact;
  compare(*exact_filters_, c, x, y_top, memory, SurfacePoint::Within::box, exact);
  m.tex = !exact.legal;
  return m;
}

bool GBufferJudge::fits_middle(const PossibleSurface& c, int x, int y_top, GBufferMemory& memory) const {
  Legality found;
  compare(projector_, c, x, y_top, memory, SurfacePoint::Within::middle, found);
  return found.legal;
}

}  // namespace trueshade::oracle
