#include "explain/against.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>

#include "core/fp_env.h"
#include "core/srgb.h"
#include "scenes/pipeline/presets.h"
#include "shading/light/power.h"

namespace trueshade {
namespace {

constexpr size_t kMostLights = 256;  // the strongest, which are left out or doubled one after the other

/// Whether two pixels have the same bits.
bool is_same(const StoredPixel& a, const StoredPixel& b) {
  for (size_t c = 0; c < 4; ++c)
    if (std::bit_cast<uint32_t>(a[c]) != std::bit_cast<uint32_t>(b[c])) return false;
  return true;
}

/// A linear value, clamped to [0, 1], encoded as sRGB (IEC 61966-2-1). NaN stays NaN.
float srgb_of(float linear) {
  const double x = double(std::clamp(linear, 0.0f, 1.0f));
  return float(x <= 0.0031308 ? 12.92 * x : 1.055 * power(x, 1.0 / 2.4) - 0.055);
}

/// Collects candidates_for() one pixel: each try_ function adds those of its kind of change.
class Search {
 public:
  Search(const ExplainedFrame& frame, const PixelHistory& history, const Image& reference, const StoredPixel& given)
      : frame_(frame), history_(history), reference_(reference), given_(given) {
    surfaces_ = surfaces_to_light(frame, history);
  }

  std::vector<Candidate> run(size_t most) {
    try_surfaces();
    try_lights();
    try_models();
    try_pipelines();
    try_stores();
    try_places();
    // An answer that is far off answers nothing.
    const double here = stored_difference(frame_.target, history_.stored, given_);
    std::erase_if(found_, [here](const Candidate& c) { return !(c.difference <= 0.25 * here); });
    std::stable_sort(found_.begin(), found_.end(),
                     [](const Candidate& a, const Candidate& b) { return a.difference < b.difference; });
    if (found_.size() > most) found_.resize(most);
    return std::move(found_);
  }

 private:
  /// Adds a candidate, unless it stores what the frame stores, bit for bit.
  void add(std::string what, const StoredPixel& stored) {
    if (is_same(stored, history_.stored)) return;
    found_.push_back({std::move(what), stored, stored_difference(frame_.target, stored, given_)});
  }

  /// What the target holds once these surfaces are lit and drawn.
  StoredPixel drawn(const PixelSurfaces& surfaces) const {
    return drawn_target(frame_, lit_surfaces(frame_, surfaces, history_.lit.geometry));
  }

  /// Adds what is stored where this fragment is the visible surface, with no tied one beside it.
  void try_surface(const PixelFragment& fragment, const std::string& how) {
    PixelSurfaces surfaces = surfaces_;
    surfaces.covered = true;
    surfaces.tied.clear();
    surfaces.visible = surface_of(frame_, fragment, surface_planes(frame_.pipeline), history_.pixel).read;
    add("object " + std::to_string(fragment.instance) + ", triangle " + std::to_string(fragment.triangle) + how,
        drawn(surfaces));
  }

  void try_surfaces() {
    constexpr size_t kMostSurfaces = 64;
    const std::vector<CoveringTriangle>& covering = history_.opaque.covering;
    for (size_t i = covering.size(), tried = 0; i-- > 0 && tried < kMostSurfaces; ++tried)
      if (history_.visible != i) try_surface(fragment_of(frame_, covering[i], history_.pixel), " seen instead");
    for (const PixelFragment& fragment : history_.opaque.culled) try_surface(fragment, " not culled, and seen");
    for (const PixelFragment& fragment : history_.opaque.nearest)
      try_surface(fragment, ", which lies beside the sample, seen instead");
    PixelSurfaces none = surfaces_;
    none.covered = false, none.tied.clear();
    add("no surface there", drawn(none));
    if (surfaces_.glass.empty()) return;
    PixelSurfaces opaque = surfaces_;
    opaque.glass.clear();
    add("transparent surfaces left out", drawn(opaque));
  }

  /// The indices of the lights that add something to the visible surface, the strongest first, kMostLights at most.
  std::vector<size_t> strongest() const {
    const std::vector<LightAtPixel>& lights = history_.lit.visible.lights;
    std::vector<size_t> out;
    for (size_t i = 0; i < lights.size(); ++i)
      if (lights[i].fate == LightFate::adds) out.push_back(i);
    std::stable_sort(out.begin(), out.end(),
                     [&](size_t a, size_t b) { return strength(lights[a]) > strength(lights[b]); });
    out.resize(std::min(out.size(), kMostLights));
    return out;
  }

  void try_lights() {
    std::vector<uint8_t> times(frame_.scene.lights.size(), 1);
    const auto with = [&](const std::string& what) { add(what, drawn_target(frame_, history_.lit, times)); };
    for (const size_t i : strongest()) {
      times[i] = 0, with("light " + std::to_string(i) + " left out");
      times[i] = 2, with("light " + std::to_string(i) + " counted twice");
      times[i] = 1;
    }
    std::fill(times.begin(), times.end(), uint8_t(0));
    with("no light counted");
  }

  /// Lights the same surfaces by a changed pipeline, and adds what is stored then; for changes of the light model and
  /// of lights' extents. Adds nothing where `change` changes nothing.
  void try_model(const std::string& what, const std::function<void(Pipeline&)>& change) {
    Pipeline changed = frame_.pipeline;
    change(changed);
    if (changed == frame_.pipeline) return;
    const ExplainedFrame frame(frame_.scene, changed);
    add(what, drawn_target(frame, lit_surfaces(frame, surfaces_, geometry_at(frame, history_.pixel))));
  }

  void try_models() {
    if (!surfaces_.covered) return;
    try_model("light extents not applied",
              [](Pipeline& p) { p.light_volumes.point = p.light_volumes.spot = LightExtent::unbounded; });
    if (frame_.pipeline.light_program.used()) return;
    const LightModel& model = frame_.pipeline.light_model;
    try_model(model.renormalize ? "the normal used as it is stored" : "the normal made unit",
              [](Pipeline& p) { p.light_model.renormalize = !p.light_model.renormalize; });
    try_model("no specular term", [](Pipeline& p) { p.light_model.specular = Specular::none; });
    try_model(model.specular_masked ? "specular where N.L is not above 0 too" : "specular only where N.L is above 0",
              [](Pipeline& p) { p.light_model.specular_masked = !p.light_model.specular_masked; });
    try_model(model.viewer == Viewer::local ? "the viewer at infinity" : "the viewer at the eye", [](Pipeline& p) {
      p.light_model.viewer = p.light_model.viewer == Viewer::local ? Viewer::infinite : Viewer::local;
    });
    try_model("spot lights without their cones", [](Pipeline& p) { p.light_model.cone = Cone::none; });
    try_model("lights without falloff", [](Pipeline& p) { p.light_model.falloff = Falloff::none; });
    try_model("falloff inverse_square", [](Pipeline& p) { p.light_model.falloff = Falloff::inverse_square; });
  }

  /// Draws the whole pixel again by another pipeline, at the frame's size, viewport and target format, and adds what is
  /// stored then. Adds nothing where that pipeline is the frame's own, or stores the same.
  void try_pipeline(const std::string& what, Pipeline changed) {
    changed.width = frame_.pipeline.width, changed.height = frame_.pipeline.height;
    changed.target = frame_.pipeline.target;
    changed.geometry.viewport = frame_.pipeline.geometry.viewport;
    changed.preset = frame_.pipeline.preset;
    if (changed == frame_.pipeline) return;
    const ExplainedFrame frame(frame_.scene, changed);
    add(what, history_of(frame, history_.pixel.x, frame_.pipeline.height - 1 - history_.pixel.y).stored);
  }

  void try_pipelines() {
    for (size_t i = 0; i < std::size(kStrategyNames); ++i) {
      Pipeline changed = frame_.pipeline;
      changed.strategy = Strategy(i);
      try_pipeline("the strategy " + std::string(kStrategyNames[i]), changed);
    }
    for (const Preset& preset : presets()) try_pipeline("the preset " + std::string(preset.name), preset.pipeline);
    Pipeline changed = frame_.pipeline;
    changed.profile =
        changed.profile == NumericProfile::ideal ? NumericProfile::mesa_llvmpipe_22_3 : NumericProfile::ideal;
    try_pipeline("the profile " + std::string(profile_name(changed.profile)), changed);
    changed = frame_.pipeline;
    const bool nearest = changed.gbuffer.half_round == HalfRound::nearest;
    changed.gbuffer.half_round = nearest ? HalfRound::toward_zero : HalfRound::nearest;
    try_pipeline(nearest ? "halves rounded toward zero" : "halves rounded to nearest", changed);
  }

  /// Adds the values of other pixels: of the mirrored ones, and of the two within three pixels of this one whose values
  /// are nearest to `given`.
  void try_places() {
    constexpr int kRadius = 3;
    constexpr size_t kMostBeside = 2;
    const int w = reference_.width, h = reference_.height;
    const int x = history_.pixel.x, y = h - 1 - history_.pixel.y;
    const auto place = [&](int px, int py, const std::string& why) {
      if (px < 0 || py < 0 || px >= w || py >= h || (px == x && py == y)) return;
      add("the value of the pixel " + std::to_string(px) + ',' + std::to_string(py) + why,
          stored_in(reference_, px, py));
    };
    place(x, h - 1 - y, ": the picture upside down");
    place(w - 1 - x, y, ": left and right exchanged");
    place(w - 1 - x, h - 1 - y, ": the picture turned round");
    const size_t before = found_.size();
    for (int dy = -kRadius; dy <= kRadius; ++dy)
      for (int dx = -kRadius; dx <= kRadius; ++dx) {
        const bool mirrored = (x + dx == w - 1 - x && dy == 0) || (y + dy == h - 1 - y && dx == 0);
        if (!mirrored) place(x + dx, y + dy, "");
      }
    std::stable_sort(found_.begin() + std::ptrdiff_t(before), found_.end(),
                     [](const Candidate& a, const Candidate& b) { return a.difference < b.difference; });
    found_.resize(std::min(found_.size(), before + kMostBeside));
  }

  /// Adds stores of changed values, or by another rule. The values are the sum of the lights or, where lights or
  /// transparent surfaces are blended, what a shader reads from the target.
  void try_stores() {
    const FormatInfo layout = info(frame_.target.format);
    const bool sums = !blends_lights(frame_.pipeline.strategy) && surfaces_.covered && surfaces_.glass.empty();
    const std::array<float, 4> values = sums ? history_.lit.visible.sum : values_of(frame_.target, history_.stored);
    const auto with = [&](const std::string& what, std::array<float, 4> source) {
      add(what, stored_alone(frame_.target, source));
    };
    std::array<float, 4> encoded = values, decoded = values, swapped = values, multiplied = values;
    for (size_t c = 0; c < 3; ++c) {
      encoded[c] = srgb_of(values[c]);
      decoded[c] = float(linear_from_srgb(double(std::clamp(values[c], 0.0f, 1.0f))));
      multiplied[c] = values[c] * values[3];
    }
    std::swap(swapped[0], swapped[2]);
    with("values encoded as sRGB before they are stored", encoded);
    with("values decoded from sRGB before they are stored", decoded);
    with("red and blue exchanged", swapped);
    with("colour multiplied by alpha", multiplied);
    with("alpha 0", {values[0], values[1], values[2], 0.0f});
    with("alpha 1", {values[0], values[1], values[2], 1.0f});
    with("twice as bright", {2 * values[0], 2 * values[1], 2 * values[2], values[3]});
    with("half as bright", {0.5f * values[0], 0.5f * values[1], 0.5f * values[2], values[3]});
    if (!sums || layout.number_class != NumberClass::unorm || layout.srgb) return;
    StoredPixel truncated;
    for (size_t c = 0; c < 4; ++c)
      truncated[c] = std::floor(std::clamp(values[c], 0.0f, 1.0f) * float(layout.largest_code(int(c))));
    add("codes truncated instead of rounded", truncated);
  }

  const ExplainedFrame& frame_;
  const PixelHistory& history_;
  const Image& reference_;
  const StoredPixel given_;
  PixelSurfaces surfaces_;
  std::vector<Candidate> found_;
};

}  // namespace

StoredPixel stored_in(const Image& image, int x, int y) {
  const FormatInfo layout = info(image.format);
  StoredPixel out{};
  for (int c = 0; c < layout.channels; ++c)
    out[size_t(c)] =
        layout.number_class == NumberClass::unorm ? float(image.code(x, y, c)) : float(image.value(x, y, c));
  return out;
}

double stored_difference(const BlendTarget& target, const StoredPixel& a, const StoredPixel& b) {
  const FormatInfo layout = info(target.format);
  constexpr double kSmall = 0x1p-14;
  double most = 0.0;
  for (size_t c = 0; c < size_t(layout.channels); ++c) {
    const double u = double(a[c]), v = double(b[c]);
    if (std::bit_cast<uint32_t>(a[c]) == std::bit_cast<uint32_t>(b[c])) continue;
    const double apart = layout.number_class == NumberClass::unorm
                             ? std::fabs(u - v)
                             : std::fabs(u - v) / std::max({std::fabs(u), std::fabs(v), kSmall});
    most = std::max(most, apart == apart ? apart : HUGE_VAL);
  }
  return most;
}

std::vector<Candidate> candidates_for(const ExplainedFrame& frame, const PixelHistory& history, const Image& reference,
                                      const StoredPixel& given, size_t most) {
  const FpScope fp;
  return Search(frame, history, reference, given).run(most);
}

}  // namespace trueshade
