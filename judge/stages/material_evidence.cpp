#include "judge/stages/material_evidence.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "judge/legal/texel_changes.h"
#include "judge/stages/tally.h"
#include "judge/stages/texture_deviations.h"

namespace trueshade::oracle {

namespace {

/// A cause as it is tested.
struct TestedCause {
  std::string_view name;  ///< empty: an implementation's choice, which the others are estimated beside
  CauseBounds legal;      ///< of implementations that are known
  double tolerance = 0;   ///< what the linear model may be off
};

/// The tests of maps, in the order of TexelCause. Levels: log2 as drivers have it is 0.045 off. Shifts: weights have at
/// least 7 bits (VK-GL-CTS). Steps: from floor to ceil. Rho: as far beside the picture's way as from one limit to the
/// middle. An order is one of two.
constexpr TestedCause kTexelTests[kTexelCauses] = {{"gain", {0, 0}, 0.003}, {"level", {-0.06, 0.06}, 0.08},
                                                   {"", {-1, 1}},           {"", {-0x1p-6, 0x1p-6}},
                                                   {"", {-0x1p-6, 0x1p-6}}, {"", {-0.6, 0.6}},
                                                   {"order", {0, 0}, 0.5}};
constexpr TestedCause kScale{"scale", {0, 0}, 0.02};  // in place of a normal map's gain
constexpr TestedCause kSwitch{"", {-0.6, 0.6}};  // in place of a level, where the nearest is read: a pixel tells all or
                                                 // nothing

constexpr double kCode = 1.0 / 255;  // what rounding alpha and 1 - alpha to codes may be off together

/// The tests of glass, in the order of GlassCause. A blend has a source, two products and a sum, each of which may be
/// cut.
constexpr TestedCause kGlassTests[kGlassCauses] = {
    {"alpha", {-kCode, kCode}, 0.001}, {"", {-2, 2}}, {"", {-2, 2}}, {"", {-2, 2}}};

/// Deviations that are tested together.
struct Tested {
  MaterialEvidence of;  ///< stage, material and plane
  std::vector<TestedCause> causes;
  std::vector<std::string_view> maps;  ///< of each cause
  std::vector<Deviation> list;
};

enum class Tolerances : uint8_t { apart, included };

std::vector<CauseBounds> bounds_of(const Tested& t, Tolerances tolerances) {
  std::vector<CauseBounds> bounds;
  for (const TestedCause& c : t.causes) {
    const double more = tolerances == Tolerances::included ? c.tolerance : 0;
    bounds.push_back({c.legal.low - more, c.legal.high + more});
  }
  return bounds;
}

size_t clusters_in(const std::vector<Deviation>& list) {
  std::vector<uint64_t> clusters;
  for (const Deviation& d : list) clusters.push_back(d.cluster);
  std::sort(clusters.begin(), clusters.end());
  return size_t(std::unique(clusters.begin(), clusters.end()) - clusters.begin());
}

void add_tests(const Tested& t, double deviations, bool gains_alone, std::vector<MaterialEvidence>& found) {
  constexpr size_t kLeast = 64, kLeastClusters = 48;
  if (t.list.size() < kLeast || clusters_in(t.list) < kLeastClusters) return;
  const std::vector<CauseBounds> bounds = bounds_of(t, Tolerances::included);
  const std::vector<CauseEstimate> estimates = estimate_causes(t.list, bounds);
  for (size_t i = 0; i < estimates.size(); ++i) {
    const TestedCause& cause = t.causes[i];
    const double error = estimates[i].error_at(deviations);
    if (cause.name.empty() || !std::isfinite(error) || (gains_alone && cause.name != "gain")) continue;
    MaterialEvidence e = t.of;
    e.map = t.maps[i], e.cause = cause.name, e.value = estimates[i].value, e.error = error;
    e.least = bounds[i].high + deviations * e.error;
    e.against = estimates[i].beyond > deviations * e.error && std::fabs(e.value) > e.least;
    found.push_back(std::move(e));
  }
}

/// All channels together, and each of several by itself, for what is wrong with one colour.
void add_all_tests(const Tested& t, double deviations, std::vector<MaterialEvidence>& found) {
  add_tests(t, deviations, false, found);
  const bool has_gains = std::any_of(t.causes.begin(), t.causes.end(), [](const auto& c) { return c.name == "gain"; });
  if (!has_gains || t.of.plane == "normal" || t.of.plane.find('.') != std::string::npos) return;
  for (int k = 0; k < 3; ++k) {
    Tested one{t.of, t.causes, t.maps, {}};
    one.of.plane = channel_of(t.of.plane, k), one.of.is_of_channel = true;
    std::copy_if(t.list.begin(), t.list.end(), std::back_inserter(one.list),
                 [k](const Deviation& d) { return int(d.cluster & 3) == k; });
    add_tests(one, deviations, true, found);
  }
}

Tested tested_maps(const Scene& scene, const std::string& stage, TextureDeviations&& d) {
  Tested t{{stage, d.material, scene.materials[d.material].name, std::string(d.plane)}, {}, {}, std::move(d.list)};
  for (const MaterialMap map : d.maps)
    for (size_t cause = 0; cause < kTexelCauses; ++cause) {
      const bool is_scale = map == kNormalMap && TexelCause(cause) == TexelCause::gain;
      const Sampler& sampler = maps_of(scene.materials[d.material])[map]->sampler;
      const bool is_nearest = sampler.mip_filter == MipFilter::nearest || sampler.min_filter == Filter::nearest;
      const bool is_switch = TexelCause(cause) == TexelCause::level && is_nearest;
      t.causes.push_back(is_scale ? kScale : is_switch ? kSwitch : kTexelTests[cause]);
      t.maps.push_back(kMaterialMapKeys[map]);
    }
  return t;
}

/// The maps of a picture, read the way that leaves least of what was given.
class MapsByWay {
 public:
  MapsByWay(const Scene& scene, const Pipeline& pipeline, const Profile& profile, const Capture& capture,
            const StageVerdict& stage)
      : scene_(scene),
        pipeline_(pipeline),
        profile_(profile),
        capture_(capture),
        stage_(stage),
        has_srgb_(std::any_of(scene.textures.begin(), scene.textures.end(),
                              [](const Texture& t) { return t.format == TextureFormat::srgb8_a8; })) {
    constexpr size_t kMost = 1024;  // pixels, of those that tell the way
    const size_t stride = (stage.textured.size() + kMost - 1) / kMost;
    for (size_t i = 0; i < stage.textured.size(); i += stride) some_.push_back(stage.textured[i]);
    if (some_.empty()) return;
    best_ = best_of_order(false);
    if (has_srgb_) other_ = best_of_order(true);
    if (other_.left < best_.left) std::swap(best_, other_);
    tested_ = by(best_.way);
  }

  /// The deviations by the way that leaves least.
  const std::vector<Tested>& tested() const { return tested_; }

  /// The deviations by the other decoder of sRGB, none where no map is sRGB: which of them it was shows less than what
  /// a decoder does to a gain.
  std::vector<std::vector<Tested>> by_other_decoder() const {
    if (!has_srgb_) return {};
    return {by(with_other_decoder(best_.way))};
  }

  /// The deviations by the other order of decoding and filtering, by both decoders; none where no map is sRGB.
  std::vector<std::vector<Tested>> by_other_order() const {
    if (!has_srgb_) return {};
    return {by(other_.way), by(with_other_decoder(other_.way))};
  }

  /// Whether that order may be the picture's.
  bool is_order_open() const { return other_.left < 1.5 * best_.left; }

 private:
  std::vector<Tested> by(const TexelWay& way) const { return by(way, stage_.textured); }
  std::vector<Tested> by(const TexelWay& way, std::span<const TexturedPixel> pixels) const {
    std::vector<Tested> tested;
    for (TextureDeviations& d : texture_deviations(scene_, pipeline_, profile_, capture_, pixels, way))
      tested.push_back(tested_maps(scene_, stage_.stage, std::move(d)));
    return tested;
  }

  static TexelWay with_other_decoder(const TexelWay& way) { return {way.rho, way.late, !way.mesa}; }

  struct TriedWay {
    TexelWay way;
    double left = HUGE_VAL;  ///< of some pixels
  };

  TriedWay best_of_order(bool late) const {
    TriedWay best;
    const auto try_way = [&](const TexelWay& way) {
      double left = 0;
      for (const Tested& t : by(way, some_)) left += left_within(t.list, bounds_of(t, Tolerances::apart));
      if (left < best.left) best = {way, left};
    };
    for (const double rho : {0.0, -1.0, -0.5, 0.5, 1.0}) try_way({rho, late, false});
    if (has_srgb_) try_way({best.way.rho, late, true});
    for (double step = 0.25; step > 0.05; step /= 2)
      for (const double to : {best.way.rho - step, best.way.rho + step})
        if (std::fabs(to) <= 1) try_way({to, late, best.way.mesa});
    return best;
  }

  const Scene& scene_;
  const Pipeline& pipeline_;
  const Profile& profile_;
  const Capture& capture_;
  const StageVerdict& stage_;
  std::vector<TexturedPixel> some_;
  const bool has_srgb_;
  TriedWay best_, other_;  ///< of one order, and of the other
  std::vector<Tested> tested_;
};

/// The deviations under glass of a stage that judges a whole picture: draw by draw llvmpipe's blends lean by more than
/// these causes say (two of 2,000 random frames).
std::vector<Tested> tested_glass(const Scene& scene, const StageVerdict& stage) {
  std::map<uint32_t, Tested> by_material;
  for (const GlassDeviation& g : stage.glass) {
    const auto [at, is_new] = by_material.try_emplace(g.material);
    if (is_new)
      at->second = {
          {stage.stage, g.material, scene.materials[g.material].name, stage.stage == "gbuffer" ? "albedo" : "color"},
          {std::begin(kGlassTests), std::end(kGlassTests)},
          std::vector<std::string_view>(kGlassCauses),
          {}};
    at->second.list.push_back(g.deviation);
  }
  std::vector<Tested> out;
  for (auto& [material, t] : by_material) out.push_back(std::move(t));
  return out;
}

std::vector<MaterialEvidence> tests_of(const std::vector<Tested>& tested, double deviations) {
  std::vector<MaterialEvidence> found;
  for (const Tested& t : tested) add_all_tests(t, deviations, found);
  return found;
}

bool has_order(const std::vector<MaterialEvidence>& found) {
  return std::any_of(found.begin(), found.end(), [](const auto& e) { return e.against && e.cause == "order"; });
}

/// What stands against maps by one way must do so by the others that may be the picture's. Orders are mixed where some
/// map is against either of them: of a picture of one order none is against that one.
void doubt(const MapsByWay& maps, double deviations, std::vector<MaterialEvidence>& found) {
  if (std::none_of(found.begin(), found.end(), [](const auto& e) { return e.against; })) return;
  const auto keep = [&](const std::vector<Tested>& tested, bool same_order) {
    const std::vector<MaterialEvidence> others = tests_of(tested, deviations);
    for (MaterialEvidence& e : found) {
      const bool is_order = e.cause == "order";
      if (!e.against || (!same_order && !is_order && !maps.is_order_open())) continue;
      e.against =
          (is_order && !same_order) ? has_order(others) : std::any_of(others.begin(), others.end(), [&](const auto& o) {
            return o.against && o.cause == e.cause && o.material == e.material && o.plane == e.plane && o.map == e.map;
          });
    }
  };
  for (const std::vector<Tested>& tested : maps.by_other_decoder()) keep(tested, true);
  if (!maps.is_order_open() && !has_order(found)) return;
  for (const std::vector<Tested>& tested : maps.by_other_order()) keep(tested, false);
}

}  // namespace

std::string MaterialEvidence::subject() const {
  return "material " + std::to_string(material) + (name.empty() ? "" : " (" + name + ")");
}

std::string MaterialEvidence::text() const {
  char line[160];
  const std::string read = map.empty() ? "glass" : map;
  if (cause == "gain" || cause == "scale")
    std::snprintf(line, sizeof line, "%s has a %s of %.4g in %s, where %.4g to %.4g are expected", read.c_str(),
                  cause.c_str(), 1 + value, plane.c_str(), 1 - least, 1 + least);
  else if (cause == "alpha")
    std::snprintf(line, sizeof line, "%s has an alpha %+.3g off in %s, where at most %.2g is expected", read.c_str(),
                  value, plane.c_str(), least);
  else if (cause == "order")
    std::snprintf(line, sizeof line, "%s is filtered and decoded in another order than other maps in %s", read.c_str(),
                  plane.c_str());
  else
    std::snprintf(line, sizeof line, "%s is read %+.3g levels off in %s, where at most %.2g is expected", read.c_str(),
                  value, plane.c_str(), least);
  return line;
}

std::vector<MaterialEvidence> material_evidence(const Scene& scene, const Pipeline& pipeline, const Profile& profile,
                                                const Capture& capture, std::span<const StageVerdict> stages,
                                                double significance) {
  const Profile by = resolved(profile, pipeline);
  std::vector<MapsByWay> maps;
  std::vector<Tested> glass;
  size_t count = 0;
  for (const StageVerdict& stage : stages) {
    count += maps.emplace_back(scene, pipeline, by, capture, stage).tested().size();
    for (Tested& t : tested_glass(scene, stage)) glass.push_back(std::move(t));
  }
  constexpr double kTestsEach = 8;
  const double tests = kTestsEach * double(std::max<size_t>(count + glass.size(), 1));
  const double deviations = std::sqrt(2 * std::log(2 * tests / significance));  // a normal distribution's, at most
  std::vector<MaterialEvidence> all;
  for (const MapsByWay& m : maps) {
    std::vector<MaterialEvidence> found = tests_of(m.tested(), deviations);
    doubt(m, deviations, found);
    std::move(found.begin(), found.end(), std::back_inserter(all));
  }
  for (const Tested& t : glass) add_all_tests(t, deviations, all);
  return all;
}

}  // namespace trueshade::oracle
