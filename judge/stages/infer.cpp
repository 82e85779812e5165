#include "judge/stages/infer.h"

#include <algorithm>

#include "judge/legal/allows.h"
#include "judge/stages/tally.h"

namespace trueshade::oracle {

namespace {

constexpr const char* kNamed = "profile";  // the knob that named profiles are guesses of
constexpr int kLeastBands = 3, kTellingBands = 1, kSampledPixels = 1 << 16, kMostBegins = 6;

using Bands = std::vector<uint8_t>;  ///< of JudgedRows

/// Adds to `bands` those in which a stage has a violation, `most` of them at most that were not there. Returns how
/// many.
int add_violating(const StageVerdict& v, int most, Bands& bands) {
  int added = 0;
  for (int y = 0; y < v.height && added < most; ++y) {
    uint8_t& band = bands[size_t(y / JudgedRows::kBand)];
    const auto row = v.classes.begin() + int64_t(y) * v.width;
    if (band != 0 || std::find(row, row + v.width, PixelClass::violation) == row + v.width) continue;
    band = 1, ++added;
  }
  return added;
}

/// Adds the bands whose float channels come nearest to their bounds: these tell tighter profiles apart.
void add_telling(const StageVerdict& v, int most, Bands& bands) {
  std::vector<std::pair<double, size_t>> errors(bands.size());
  for (size_t y = 0; y < v.row_errors.size(); ++y) {
    auto& [error, band] = errors[y / JudgedRows::kBand];
    error = std::max(error, v.row_errors[y]), band = y / JudgedRows::kBand;
  }
  std::sort(errors.rbegin(), errors.rend());
  for (size_t i = 0; i < errors.size() && int(i) < most; ++i)
    if (errors[i].first > 0) bands[errors[i].second] = 1;
}

/// All bands in three portions: every fourth band, those behind these, and the rest.
std::vector<Bands> portions_of(size_t bands) {
  std::vector<Bands> portions(3, Bands(bands, 0));
  for (size_t i = 0; i < bands; ++i) portions[std::min<size_t>(i % 4, 2)][i] = 1;
  return portions;
}

/// What a guess bears on. The target is judged by the capture's own surfaces, which no grid changes.
enum class Bears : uint8_t { on_surfaces, on_all_stages };

struct Guess {
  Profile profile;
  Bears bears = Bears::on_surfaces;
};

bool is_same(const Guess& a, const Guess& b) {
  return a.bears == b.bears && allows_all_of(a.profile, b.profile) && allows_all_of(b.profile, a.profile);
}

/// What inquiries on earlier samples have found out about guesses.
struct Knowledge {
  /// A guess, the bands in which it was judged, and what was found there.
  struct Judged {
    Guess guess;
    Bands bands;
    uint64_t surfaces = 0, lights = 0;  ///< violations in these
  };
  std::vector<Judged> judged;
  std::vector<Guess> confirmed;  ///< on the whole image
};

/// Infers a profile from the rows of one sample.
class Inquiry {
 public:
  Inquiry(const Scene& scene, const Pipeline& pipeline, const Capture& capture, const JudgedRows& rows,
          const JudgedBefore* before, Knowledge& known)
      : scene_(scene), pipeline_(pipeline), capture_(capture), rows_(rows), before_(before), known_(known) {
    const auto look = [&](const Image& image) {
      if (image.width == 0) return;
      const FormatInfo f = info(image.format);
      unorm_ = unorm_ || f.number_class == NumberClass::unorm;
      half_ = half_ || f.small_float();
    };
    look(capture.color);
    for (const NamedImage& p : capture.planes) look(p.image);
    lit_ = capture.color.width > 0 && capture.plane("normal") != nullptr && capture.plane("albedo") != nullptr &&
           capture.plane(pipeline.gbuffer.position_from_depth ? "depth" : "position") != nullptr;
    loose_.subpixel_bits = 8;
  }

  Inference run() {
    find_grid();
    find_origin();
    find_stores();
    find_name();
    rank();
    for (int y = 0; y < pipeline_.height && !rows_.all(); ++y) result_.sampled_rows += rows_.has(y) ? 1 : 0;
    result_.tightest = loose_;
    result_.tightest.name = result_.known_as.empty() ? "inferred" : result_.known_as;
    if (const auto known = profile_named(result_.known_as)) result_.tightest = *known;
    return result_;
  }

  /// Judges the guesses that hold on the sample on the whole image, the last first, as these allow the least. Returns
  /// some bands in which one of them fails; empty where all hold.
  Bands refuted() {
    bool is_first = true;
    for (auto guess = held_.rbegin(); guess != held_.rend() && !rows_.all(); ++guess) {
      const bool is_implied = std::any_of(known_.confirmed.begin(), known_.confirmed.end(), [&](const Guess& g) {
        return (g.bears == guess->bears || guess->bears == Bears::on_surfaces) &&
               allows_all_of(guess->profile, g.profile);
      });
      if (is_implied) continue;
      const auto bands = size_t(JudgedRows::bands_of(pipeline_.height));
      // The one that allows the least is expected to hold; of the others a part may do.
      const std::vector<Bands> portions = is_first ? std::vector<Bands>{Bands(bands, 1)} : portions_of(bands);
      for (const Bands& portion : portions)
        if (const Bands failing = failing_in(*guess, JudgedRows(portion)); !failing.empty()) return failing;
      known_.confirmed.push_back(*guess);
      is_first = false;
    }
    return {};
  }

 private:
  Bands failing_in(const Guess& guess, const JudgedRows& rows) const {
    Bands bands(size_t(JudgedRows::bands_of(pipeline_.height)), 0);
    int failing = add_violating(gbuffer_violations(scene_, pipeline_, guess.profile, capture_, rows, before_),
                                kLeastBands, bands);
    if (guess.bears == Bears::on_all_stages && lit_)
      failing += add_violating(lighting_violations(scene_, pipeline_, guess.profile, capture_, rows, before_),
                               kLeastBands, bands);
    return failing > 0 ? bands : Bands{};
  }

  /// Judges one guess on the sample, adds it to the `tried` ones, and returns how many pixels speak against it. Counts
  /// those of all stages, also where the first one fails, so that guesses can be ranked.
  uint64_t against(const Profile& profile, Bears bears, const char* knob, const std::string& value) {
    const bool with_lights = bears == Bears::on_all_stages && lit_;
    const Knowledge::Judged& judged = judged_on_sample({profile, bears}, with_lights);
    result_.tried.push_back({knob, value, judged.surfaces, with_lights ? std::optional(judged.lights) : std::nullopt});
    const uint64_t violations = judged.surfaces + judged.lights;
    if (violations == 0) held_.push_back({profile, bears});
    return violations;
  }

  /// A guess judged on all bands of the sample. Bands in which it was judged for an earlier sample are not judged
  /// again.
  const Knowledge::Judged& judged_on_sample(const Guess& guess, bool with_lights) {
    auto known = std::find_if(known_.judged.begin(), known_.judged.end(),
                              [&](const Knowledge::Judged& j) { return is_same(j.guess, guess); });
    const auto count = size_t(JudgedRows::bands_of(pipeline_.height));
    if (known == known_.judged.end()) known = known_.judged.insert(known, {guess, Bands(count, 0)});
    Bands more(count, 0);
    for (size_t i = 0; i < count; ++i) more[i] = rows_.has_band(int(i)) && known->bands[i] == 0 ? 1 : 0;
    if (std::find(more.begin(), more.end(), 1) == more.end()) return *known;
    for (size_t i = 0; i < count; ++i) known->bands[i] |= more[i];
    const JudgedRows rows(std::move(more));
    const auto violations = [](const StageVerdict& v) { return v.count(PixelClass::violation); };
    known->surfaces += violations(gbuffer_violations(scene_, pipeline_, guess.profile, capture_, rows, before_));
    if (with_lights)
      known->lights += violations(lighting_violations(scene_, pipeline_, guess.profile, capture_, rows, before_));
    return *known;
  }

  /// Sorts the guesses of each knob; of guesses that are equally good, the likelier one, tried first, stays first.
  void rank() {
    auto& tried = result_.tried;
    for (auto first = tried.begin(); first != tried.end();) {
      const auto end = std::find_if(first, tried.end(), [&](const Hypothesis& h) { return h.knob != first->knob; });
      std::stable_sort(first, end, [](const auto& a, const auto& b) { return a.violations() < b.violations(); });
      if (first->knob == kNamed && result_.known_as.empty()) result_.nearest = first->value;
      first = end;
    }
  }

  void find_grid() {
    struct Grid {
      int bits;
      SnapRule rule;
    };
    // The likeliest first: of those that explain the image, the first is taken.
    constexpr Grid grids[] = {{8, SnapRule::nearest},    {8, SnapRule::toward_zero}, {4, SnapRule::nearest},
                              {6, SnapRule::nearest},    {10, SnapRule::nearest},    {12, SnapRule::nearest},
                              {8, SnapRule::nearest_0_6}};
    for (const Grid& grid : grids) {
      Profile p = loose_;
      p.subpixel_bits = grid.bits;
      p.snap = grid.rule;
      if (against(p, Bears::on_surfaces, "snap", std::to_string(grid.bits) + " bits, " + text(grid.rule)) > 0) continue;
      result_.subpixel_bits = grid.bits;
      result_.snap = grid.rule;
      loose_ = p;
      return;
    }
  }

  void find_origin() {
    Profile snapped = loose_, unsnapped = loose_;
    snapped.plane_origin = PlaneOrigin::snapped;
    unsnapped.plane_origin = PlaneOrigin::unsnapped;
    const bool a = against(snapped, Bears::on_surfaces, "plane origin", "snapped") == 0,
               b = against(unsnapped, Bears::on_surfaces, "plane origin", "unsnapped") == 0;
    if (a || b) result_.plane_origin = a && b ? PlaneOrigin::either : a ? PlaneOrigin::snapped : PlaneOrigin::unsnapped;
    if (a != b) loose_.plane_origin = *result_.plane_origin;
  }

  void find_stores() {
    if (half_) {
      Profile truncated = loose_, nearest = loose_;
      truncated.half = HalfStore::toward_zero;
      nearest.half = HalfStore::nearest;
      const bool a = against(truncated, Bears::on_all_stages, "half", text(truncated.half)) == 0,
                 b = against(nearest, Bears::on_all_stages, "half", text(nearest.half)) == 0;
      if (a || b) result_.half = a && b ? HalfStore::either : a ? HalfStore::toward_zero : HalfStore::nearest;
      if (a != b) loose_.half = *result_.half;
    }
    if (!unorm_) return;
    for (const double reach : {0.5, 0.6, 1.0}) {
      Profile p = loose_;
      p.unorm_reach = reach;
      if (against(p, Bears::on_all_stages, "unorm", "within " + std::to_string(reach).substr(0, 3)) > 0) continue;
      result_.unorm_reach = reach;
      loose_.unorm_reach = reach;
      return;
    }
  }

  void find_name() {
    for (const char* name : {"ideal", "mesa-llvmpipe-22.3", "d3d-class", "unknown"}) {
      if (against(*profile_named(name), Bears::on_all_stages, kNamed, name) > 0) continue;
      result_.known_as = name;
      return;
    }
  }

  const Scene& scene_;
  const Pipeline& pipeline_;
  const Capture& capture_;
  const JudgedRows& rows_;
  const JudgedBefore* before_;
  Knowledge& known_;
  std::vector<Guess> held_;  ///< guesses that explain the sample, in the order in which they were tried
  bool unorm_ = false, half_ = false, lit_ = false;
  Profile loose_;
  Inference result_;
};

}  // namespace

JudgedRows sampled_rows(int width, int height) {
  const int bands = JudgedRows::bands_of(height);
  const int taken = std::max(kLeastBands, kSampledPixels / (JudgedRows::kBand * std::max(width, 1)));
  if (2 * taken >= bands) return {};
  Bands chosen(size_t(bands), 0);
  for (int i = 0; i < taken; ++i) chosen[size_t((2 * i + 1) * bands / (2 * taken))] = 1;
  return JudgedRows(std::move(chosen));
}

Inference infer_profile(const Scene& scene, const Pipeline& pipeline, const Capture& capture,
                        std::span<const StageVerdict> judged, const JudgedBefore* before) {
  JudgedRows sample = sampled_rows(pipeline.width, pipeline.height);
  if (sample.all()) return infer_profile(scene, pipeline, capture, sample, before);
  Bands bands = sample.bands();
  for (const StageVerdict& stage : judged) {
    add_violating(stage, kLeastBands, bands);
    add_telling(stage, kTellingBands, bands);
  }
  return infer_profile(scene, pipeline, capture, JudgedRows(std::move(bands)), before);
}

Inference infer_profile(const Scene& scene, const Pipeline& pipeline, const Capture& capture, const JudgedRows& sample,
                        const JudgedBefore* before) {
  JudgedRows rows = sample;
  Knowledge known;
  for (int begin = 0;; ++begin) {
    Inquiry inquiry(scene, pipeline, capture, rows, before, known);
    Inference result = inquiry.run();
    const Bands refuted = inquiry.refuted();
    if (refuted.empty()) return result;
    Bands bands = rows.bands();
    for (size_t i = 0; i < bands.size(); ++i) bands[i] |= refuted[i];
    rows = begin < kMostBegins ? JudgedRows(std::move(bands)) : JudgedRows();
  }
}

std::string text(const Inference& i) {
  std::string line =
      i.subpixel_bits ? std::to_string(*i.subpixel_bits) + " bits, " + text(*i.snap) : "no grid explains it";
  line += std::string("; planes ") + (i.plane_origin ? text(*i.plane_origin) : "of neither origin");
  line += std::string("; half ") + (i.half ? text(*i.half) : "not told");
  line +=
      "; unorm " + (i.unorm_reach ? "within " + std::to_string(*i.unorm_reach).substr(0, 3) : std::string("not told"));
  return line;
}

}  // namespace trueshade::oracle
