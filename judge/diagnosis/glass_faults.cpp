#include "judge/diagnosis/glass_faults.h"

#include <algorithm>
#include <cmath>

#include "core/threads/parallel_for.h"
#include "judge/diagnosis/predicted_store.h"
#include "judge/stages/transparent_layers.h"

namespace trueshade::oracle {

namespace {

constexpr double kSameCodes = 1.5;  ///< steps, of pixels that are blended several times
constexpr double kGlassRival = 0.06, kGlassParameterCost = 0.002;
constexpr std::array<size_t, 4> kGlassSample = {300, 60, 150, 0};

// --- the table

void leave_out(GlassPixel& p, double) { p.layers.clear(); }
void leave_one_out(GlassPixel& p, double object) {
  std::erase_if(p.layers, [object](const GlassLayer& l) { return l.instance == uint32_t(object); });
}
/// Turns the order of the objects round; triangles of one object stay in their order.
void turn_order(GlassPixel& p, double) {
  std::stable_sort(p.layers.begin(), p.layers.end(),
                   [](const GlassLayer& a, const GlassLayer& b) { return a.instance > b.instance; });
}
void near_first(GlassPixel& p, double) {
  std::stable_sort(p.layers.begin(), p.layers.end(),
                   [](const GlassLayer& a, const GlassLayer& b) { return a.distance < b.distance; });
}
void far_first(GlassPixel& p, double) {
  std::stable_sort(p.layers.begin(), p.layers.end(),
                   [](const GlassLayer& a, const GlassLayer& b) { return a.distance > b.distance; });
}
void draw_twice(GlassPixel& p, double) {
  const std::vector<GlassLayer> once = p.layers;
  p.layers.insert(p.layers.end(), once.begin(), once.end());
}
void last_alone(GlassPixel& p, double) {
  if (p.layers.size() > 1) p.layers.erase(p.layers.begin(), p.layers.end() - 1);
}
void first_alone(GlassPixel& p, double) {
  if (p.layers.size() > 1) p.layers.resize(1);
}
void take_as_premultiplied(GlassPixel& p, double) { p.blend.rgb.src = BlendFactor::one; }
void multiply_again(GlassPixel& p, double) {
  for (GlassLayer& l : p.layers)
    for (size_t k = 0; k < 3; ++k) l.color[k] *= l.color[3];
}
void add(GlassPixel& p, double) { p.blend.rgb.dst = BlendFactor::one; }
void draw_opaque(GlassPixel& p, double) { p.blend.enabled = false; }
void turn_alpha(GlassPixel& p, double) {
  for (GlassLayer& l : p.layers) l.color[3] = 1 - l.color[3];
}
void encode_alpha(GlassPixel& p, double) {
  const auto encoded = [](double v) { return v <= 0.0031308 ? v * 12.92 : 1.055 * std::pow(v, 1 / 2.4) - 0.055; };
  for (GlassLayer& l : p.layers) l.color[3] = encoded(l.color[3]);
}
void decode_alpha(GlassPixel& p, double) {
  const auto decoded = [](double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); };
  for (GlassLayer& l : p.layers) l.color[3] = decoded(l.color[3]);
}

constexpr GlassFault kGlassFaults[] = {
    {"glass-missing", "the transparent surfaces are not drawn", leave_out},
    {"glass-object-missing", "transparent object %s is not drawn", leave_one_out, true},
    {"glass-reversed", "the transparent surfaces are drawn in the opposite order", turn_order},
    {"glass-near-first", "the transparent objects are drawn from the nearest to the farthest", near_first},
    {"glass-far-first", "the transparent objects are drawn from the farthest to the nearest", far_first},
    {"glass-twice", "the transparent surfaces are drawn twice", draw_twice},
    {"glass-last-alone", "of transparent surfaces the one drawn last is alone", last_alone},
    {"glass-first-alone", "of transparent surfaces the one drawn first is alone", first_alone},
    {"glass-unmultiplied", "the transparent surfaces' colours are not multiplied by their alpha",
     take_as_premultiplied},
    {"glass-premultiplied", "the transparent surfaces' colours are multiplied by their alpha once too often",
     multiply_again},
    {"glass-added", "the transparent surfaces are added to what is behind them", add},
    {"glass-opaque", "the transparent surfaces are not blended", draw_opaque},
    {"glass-alpha-inverted", "the transparent surfaces' alpha is 1 - alpha", turn_alpha},
    {"glass-alpha-srgb-encoded", "the transparent surfaces' alpha is sRGB-encoded", encode_alpha},
    {"glass-alpha-srgb-decoded", "the transparent surfaces' alpha is decoded as if it were sRGB", decode_alpha},
};

// --- the search

struct GlassCandidate {
  NamedGlassFault fault;
  double cost = 0, explained = 0, contradicted = 0;
};

/// Compares the pixels under glass with what faults make of them. Borrows the pipeline and the picture.
class GlassCase {
 public:
  GlassCase(const Scene& scene, const Pipeline& pipeline, const Profile& profile, const Capture& capture,
            const StageVerdict& stage, const PictureCase& picture);

  /// How many pixels under glass are wrong, estimated.
  double changed() const { return changed_; }
  /// How well a fault explains the sampled pixels.
  GlassCandidate judged(const NamedGlassFault& fault) const;
  /// The finding about a candidate, with its proof; the proof's plane is empty where no pixel shows the fault.
  Finding finding(const GlassCandidate& c) const;
  std::vector<NamedGlassFault> all() const;

 private:
  struct Seen {
    SampledPixel at;
    Color lit;  ///< as it is stored
    GlassPixel glass;
    double off = 0;
  };
  Color shown(const Seen& seen, const NamedGlassFault* fault) const;
  double off(const Seen& seen, const Color& shown) const;
  /// The difference of one channel in steps; 0 or 1000 where the captured one is not finite.
  double channel_off(const Seen& seen, const Color& shown, int k) const {
    const double given = picture_.given(seen.at.x, seen.at.y, k);
    if (!std::isfinite(given)) return given == shown[size_t(k)] ? 0 : 1e3;
    const bool codes = info(pipeline_.target).number_class == NumberClass::unorm;
    return std::fabs(given - shown[size_t(k)]) / (codes ? 1 : picture_.step_at(given, k));
  }

  const Pipeline& pipeline_;
  const PictureCase& picture_;
  std::vector<Seen> seen_;
  double changed_ = 0, same_ = 0;
};

GlassCase::GlassCase(const Scene& scene, const Pipeline& pipeline, const Profile& profile, const Capture& capture,
                     const StageVerdict& stage, const PictureCase& picture)
    : pipeline_(pipeline), picture_(picture) {
  const TransparentLayers layers(scene, pipeline, resolved(profile, pipeline), capture);
  std::vector<PixelUse> uses(stage.classes.size());
  for (int y = 0; y < stage.height; ++y)
    for (int x = 0; x < stage.width; ++x)
      if (!layers.any(x, y)) uses[size_t(y) * size_t(stage.width) + size_t(x)] = PixelUse::left_out;
  std::vector<double> distances(scene.instances.size());
  for (size_t i = 0; i < distances.size(); ++i) {
    const Instance& object = scene.instances[i];
    const Triple3 d = minus(triple(object.world_from_object[3]), triple(scene.camera.eye));
    distances[i] = inner(d, d);
  }
  for (const SampledPixel& p : sampled_pixels(stage, kGlassSample, uses)) seen_.push_back({p, {}, {}, 0});
  parallel_for(int(seen_.size()), 0, [&](int i) {
    Seen& s = seen_[size_t(i)];
    s.lit = picture.predicted(picture.right(), s.at.x, s.at.y).stored;
    s.glass.blend = pipeline.transparency.blend;
    for (const TransparentLayer& layer : layers.at(s.at.x, s.at.y).layers) {
      if (!layer.drawn && !layer.certain) continue;
      GlassLayer& l = s.glass.layers.emplace_back(GlassLayer{layer.instance, distances[layer.instance], {}});
      for (size_t k = 0; k < 4; ++k) l.color[k] = layer.nominal[k].value;
    }
    s.off = off(s, shown(s, nullptr));
  });
  // Where what was stored is legal and another is predicted, the prediction is what is wrong.
  std::erase_if(seen_, [&](const Seen& s) {
    const PixelClass c = stage.classes[size_t(s.at.y) * size_t(stage.width) + size_t(s.at.x)];
    return c != PixelClass::violation && s.off >= kSameCodes;
  });
  for (const Seen& s : seen_) (s.off >= kSameCodes ? changed_ : same_) += s.at.weight;
}

/// What the pixel holds once its glass is blended, right or with a fault (null: right).
Color GlassCase::shown(const Seen& seen, const NamedGlassFault* fault) const {
  GlassPixel glass = seen.glass;
  if (fault != nullptr) fault->fault->change(glass, fault->parameter.number);
  const PredictedStore texels(pipeline_, LightFault::Store::right);
  Color texel = seen.lit;
  for (const GlassLayer& l : glass.layers)
    texels.blend({l.color[0], l.color[1], l.color[2]}, l.color[3], glass.blend, texel);
  return texel;
}

/// The largest difference of a channel between what was captured and `shown`, in steps of the format.
double GlassCase::off(const Seen& seen, const Color& shown) const {
  double most = 0;
  for (int k = 0; k < picture_.channels(); ++k) most = std::max(most, channel_off(seen, shown, k));
  return most;
}

/// Every fault that may be supposed; a fault of one object for each object, of 64 at most, at a wrong pixel.
std::vector<NamedGlassFault> GlassCase::all() const {
  std::vector<uint32_t> objects;
  for (const Seen& s : seen_)
    for (const GlassLayer& l : s.glass.layers)
      if (s.off >= kSameCodes && std::find(objects.begin(), objects.end(), l.instance) == objects.end())
        objects.push_back(l.instance);
  std::vector<NamedGlassFault> named;
  for (const GlassFault& fault : kGlassFaults) {
    if (!fault.of_object) named.push_back({&fault, 0});
    for (size_t i = 0; fault.of_object && i < std::min<size_t>(64, objects.size()); ++i)
      named.push_back({&fault, double(objects[i])});
  }
  return named;
}

GlassCandidate GlassCase::judged(const NamedGlassFault& fault) const {
  GlassCandidate c{fault};
  for (const Seen& s : seen_) {
    const double now = off(s, shown(s, &fault));
    const bool was = s.off >= kSameCodes, is = now >= kSameCodes;
    c.cost += is ? s.at.weight * cost_of(now) : 0;
    if (was && !is) c.explained += s.at.weight;
    if (!was && is) c.contradicted += s.at.weight;
  }
  c.cost = c.cost / changed_ + kGlassParameterCost * fault.fault->form().count();
  return c;
}

Finding GlassCase::finding(const GlassCandidate& c) const {
  Finding f;
  f.name = fault_name(*c.fault.fault, c.fault.parameter), f.text = fault_text(*c.fault.fault, c.fault.parameter);
  f.plane = "picture", f.changed = uint64_t(std::llround(changed_));
  f.explained = f.alone = c.explained / changed_, f.contradicted = same_ > 0 ? c.contradicted / same_ : 0;
  double farthest = 0;
  for (const Seen& s : seen_) {
    const Color right = shown(s, nullptr), now = shown(s, &c.fault);
    if (s.off < kSameCodes || s.off <= farthest || off(s, now) >= kSameCodes) continue;
    farthest = s.off;
    for (int k = 0; k < picture_.channels(); ++k)
      if (channel_off(s, right, k) == s.off)
        f.proof = {s.at.x,           s.at.y,        channel_of("color", k), picture_.given(s.at.x, s.at.y, k),
                   right[size_t(k)], now[size_t(k)]};
  }
  return f;
}

}  // namespace

std::span<const GlassFault> glass_faults() { return kGlassFaults; }

std::vector<Finding> glass_findings(const Scene& scene, const Pipeline& pipeline, const Profile& profile,
                                    const Capture& capture, const StageVerdict& stage, const PictureCase& picture,
                                    std::span<const NamedGlassFault> only) {
  const GlassCase glass(scene, pipeline, profile, capture, stage, picture);
  std::vector<Finding> findings;
  if (glass.changed() < kLeastChanged) return findings;
  std::vector<GlassCandidate> candidates;
  if (!only.empty()) {
    for (const NamedGlassFault& fault : only) findings.push_back(glass.finding(glass.judged(fault)));
    return findings;
  }
  for (const NamedGlassFault& fault : glass.all()) candidates.push_back(glass.judged(fault));
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const GlassCandidate& a, const GlassCandidate& b) { return a.cost < b.cost; });
  for (const GlassCandidate& c : candidates) {
    const bool explains = c.explained - c.contradicted >= kLeastExplained * glass.changed();
    if (!explains || c.cost > candidates.front().cost + kGlassRival) continue;
    Finding f = glass.finding(c);
    if (!f.proof.plane.empty()) findings.push_back(std::move(f));
  }
  return findings;
}

}  // namespace trueshade::oracle
