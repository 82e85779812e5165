#include "judge/stages/tally.h"

#include <cmath>
#include <cstring>
#include <limits>

#include "core/error.h"
#include "core/image_rows.h"
#include "judge/legal/level_range.h"

namespace trueshade::oracle {

namespace {

constexpr size_t kWorst = 32;
constexpr size_t kMostChoices = size_t(1) << 14;  // of a row that are kept, whichever way they went
constexpr uint32_t kRun = 8;                      // records in a row that are kept together, or none of them

/// A number that looks like chance and is always the same.
uint32_t scrambled(uint32_t v) {
  v ^= v >> 16, v *= 0x7feb352du, v ^= v >> 15, v *= 0x846ca68bu;
  return v ^ v >> 16;
}

/// One unit in the last place of what the plane stores at `value`.
double unit_of(const PlaneView& view, int channel, double value) {
  if (view.layout.number_class != NumberClass::floating || !std::isfinite(value)) return 1;
  const int exponent = value == 0 ? -126 : std::max(std::ilogb(value), -126), bits = view.layout.bits[size_t(channel)];
  if (!view.layout.small_float()) return std::ldexp(1.0, exponent - 23);
  return std::ldexp(1.0, std::max(exponent, -14) - (bits == 16 ? 10 : bits - 5));
}

bool worse(const WorstPixel& a, const WorstPixel& b) {
  const bool va = a.pixel_class == PixelClass::violation, vb = b.pixel_class == PixelClass::violation;
  if (va != vb) return va;
  return a.excess > b.excess;
}

void keep_worst(std::vector<WorstPixel>& list) {
  std::stable_sort(list.begin(), list.end(), worse);
  if (list.size() > kWorst) list.resize(kWorst);
}

}  // namespace

std::string channel_of(std::string_view plane, int channel) {
  std::string_view letters = "RGBA";
  if (plane == "position" || plane == "normal") letters = "XYZW";
  if (plane == "uv") letters = "UV";
  if (plane == "depth") letters = "Z";
  const bool is_count = plane.starts_with("id.") || plane == "light.count";
  if (plane.empty() || is_count || size_t(channel) >= letters.size()) return std::string(plane);
  return std::string(plane) + '.' + letters[size_t(channel)];
}

PlaneView::PlaneView(const Image* i) : image(i) {
  if (i == nullptr) return;
  layout = info(i->format);
  channels = layout.channels;
  is_words_ = layout.bytes_per_channel == 4 && layout.number_class != NumberClass::unorm;
}

double PlaneView::stored_otherwise(int x, int y, int channel) const {
  const uint32_t code = image->code(layout, x, y, channel);
  return unorm() ? double(code) : value_of_code(layout, channel, code);
}

double PlaneView::held(double value, int channel) const {
  if (!unorm()) return value;
  return layout.largest_code(channel) * (layout.srgb_channel(channel) ? srgb_encoded(value) : value);
}

std::optional<Deviation> PlaneView::deviation(int x, int y, int channel, double expected) const {
  constexpr double kRounding = 0.3;  // standard deviation of what rounding to steps leaves
  const double given = stored(x, y, channel);
  if (layout.small_float() && layout.bits[size_t(channel)] < 16) return std::nullopt;  // steps of a part in 32 and more
  const bool is_open = !unorm() || (expected > 1 && expected < layout.largest_code(channel) - 1.0);
  if (!is_open || !std::isfinite(given) || !std::isfinite(expected)) return std::nullopt;
  const double parts = unorm() ? 16 : 4096;  // of a step, or in floats of 1: values that near round alike
  const auto value = uint64_t(int64_t(std::floor(std::clamp(expected, -1e9, 1e9) * parts)) + (int64_t(1) << 50));
  constexpr int kPlace = 8;  // pixels
  const auto place = uint32_t(y / kPlace) << 16 | uint32_t(x / kPlace);
  return Deviation{
      given - expected, {}, value << 2 | uint64_t(channel & 3), place, kRounding * unit_of(*this, channel, expected)};
}

PlaneView plane_of(const Capture& capture, const Pipeline& pipeline, std::string_view name) {
  const bool is_target = name == "color";
  PlaneView view(is_target ? (capture.color.width > 0 ? &capture.color : nullptr) : capture.plane(name));
  view.decoded = capture.decoding(name);
  if (view.decoded != nullptr && !view.decoded->has_alpha) view.channels = std::min(view.channels, 3);
  if (is_target && !capture.has_alpha) view.channels = std::min(view.channels, 3);
  if (view && (view.image->width != pipeline.width || view.image->height != pipeline.height))
    throw Error(ErrorKind::bad_input, capture.file_of(name) + ": plane " + std::string(name),
                "is " + std::to_string(view.image->width) + "x" + std::to_string(view.image->height) + ", not " +
                    std::to_string(pipeline.width) + "x" + std::to_string(pipeline.height),
                "capture it at the pipeline's size, or set the size");
  return view;
}

PlaneView target_of(const Capture& capture, const Pipeline& pipeline) {
  const PlaneView view = plane_of(capture, pipeline, "color");
  if (!view)
    throw Error(ErrorKind::bad_input, capture.name + ": plane color", "is missing", "lighting is judged from it");
  return view;
}

void Match::lookup_is(const PlaneView& view, const char* name, int at, const Range& range, double stored,
                      uint32_t pixel, const Profile& profile) {
  const bool before = second;
  const size_t count = choices.size();
  const uint64_t values = stored_values;
  const size_t seen = store_count;
  second = false;
  channel_is(view, name, at, range, stored, pixel, profile);
  tex = tex || second;
  constexpr double kRoundings = 0x1p-18;
  off_lookup = off_lookup || (!view.quantised() &&
                              std::fabs(stored - range.value) > kRoundings * (std::fabs(range.value) + kSmallestFloat));
  second = before, stored_values = values, store_count = seen;
  choices.erase(choices.begin() + int64_t(count), choices.end());
}

void Match::note(const char* name, int at, const LegalTexel& value, double stored, double unit) {
  legal = false;
  const double width = std::isfinite(value.high - value.low) ? value.high - value.low : 0;
  double outside =
      std::isnan(stored) ? HUGE_VAL : std::max(value.low - stored, stored - value.high) / std::max(unit, width);
  if (!(outside > excess)) return;
  excess = outside, plane = name, channel = at, legal_value = value, given = stored;
}

void Match::channel_is(const PlaneView& view, const char* name, int at, const Range& range, double stored,
                       uint32_t pixel, const Profile& profile) {
  if (view.quantised())
    return texel_is(view, name, at, legal_texel(range, view.image->format, at, profile), range.value, stored, pixel,
                    profile);
  // A float within the range whose error is none to be told: what the range is widened by to floats does not matter.
  const double least_bound = std::max(range.high - range.value, range.value - range.low);
  const bool is_within = stored >= range.low && stored <= range.high;
  if (is_within && std::fabs(stored - range.value) * (1 + 0x1p-40) < worst_error * least_bound) return;
  texel_is(view, name, at, legal_float(range), range.value, stored, pixel, profile);
}

void Match::texel_is(const PlaneView& view, const char* name, int at, const LegalTexel& texel, double value,
                     double stored, uint32_t pixel, const Profile& profile) {
  if (!texel.contains(stored)) return note(name, at, texel, stored, unit_of(view, at, texel.nominal));
  if (texel.is_open()) return;
  if (!view.quantised()) {
    const double bound = std::max(texel.high - value, value - texel.low);
    if (bound > 0) worst_error = std::max(worst_error, std::fabs(stored - value) / bound);
    return;
  }
  ++stored_values;
  const auto taken = int8_t(stored < texel.nominal ? -1 : stored > texel.nominal ? 1 : 0);
  second = second || taken != 0;
  if (store_count < kMostStores) stores[store_count++] = {float(value), !(texel.second_chance > 0), taken};
  if (taken == 0 && !(texel.second_chance > 0)) return;
  choices.push_back(choice_of(view, at, pixel, value, texel, stored, profile));
}

StoreChoice choice_of(const PlaneView& view, int channel, uint32_t pixel, double value, const LegalTexel& likely,
                      double stored, const Profile& profile) {
  StoreChoice c{pixel, float(value), float(likely.second_chance), int8_t(likely.second_side),
                int8_t(stored < likely.nominal   ? -1
                       : stored > likely.nominal ? 1
                                                 : 0)};
  const bool is_second = c.taken == 0 || (c.chance > 0 && (c.taken == c.side || likely.either_side || c.chance > 0.5f));
  if (!is_second) c.chance = 0, c.side = c.taken;
  if (view.unorm() && profile.likely.code_reach > 0.5) {  // errors of such a size are alike where values are
    constexpr double kAlike = 16;                         // parts of a code
    const double step = kAlike * view.layout.largest_code(channel);
    c.value = float(std::floor(value * step) / step);
  }
  return c;
}

bool is_sampled(uint32_t pixel, int width, int height) {
  constexpr uint64_t kEnough = 24576;  // pixels
  return uint64_t(scrambled(pixel)) * uint64_t(width) * uint64_t(height) < kEnough << 32;
}

void RowTally::may_be_other(uint32_t pixel, uint64_t surface, double chance) {
  ++ambiguous;
  predicted_other += chance;
  surface_choices.push_back({surface, pixel, float(chance)});
}

void RowTally::take(int x, int y, PixelClass c, const Match& match, const std::string& surface) {
  if (c == PixelClass::undefined && match.stored_values > 0) {  // whatever was stored says nothing of rounding
    Match unknown = match;
    unknown.choices.clear(), unknown.near_thresholds.clear();
    unknown.store_count = 0, unknown.stored_values = 0;
    return take(x, y, c, unknown, surface);
  }
  classes.push_back(c);
  compare(x, match);
  record(x, y, c, match, surface);
}

void RowTally::compare(int x, const Match& match) {
  if (x == before_x + 1 && match.store_count == before_count)
    for (size_t i = 0; i < before_count; ++i) {
      const SeenStore &a = before[i], &b = match.stores[i];
      stored_apart += a.value == b.value && a.is_sure && b.is_sure && a.taken != b.taken ? 1 : 0;
    }
  std::copy_n(match.stores.begin(), match.store_count, before.begin());
  before_count = match.legal ? match.store_count : 0, before_x = x;
}

void RowTally::record(int x, int y, PixelClass c, const Match& match, const std::string& surface) {
  stored_values += match.stored_values;
  worst_error = std::max(worst_error, match.worst_error);
  keep_choices(y, match);
  if (!is_told(c)) return;
  if (c == PixelClass::violation) keep_excess(x, match.excess);
  worst.push_back({x, y, c, channel_of(match.plane, match.channel), match.legal_value.low, match.legal_value.high,
                   match.legal_value.nominal, match.given, match.excess, surface});
  if (worst.size() > 4 * kWorst) keep_worst(worst);
}

void RowTally::keep_excess(int x, double outside) {
  if (excess.size() <= size_t(x)) excess.resize(size_t(x) + 1);
  excess[size_t(x)] = std::max(excess[size_t(x)], float(outside));
}

/// Runs of records are kept by a number that looks like chance, so that what is kept is from all over the row.
void RowTally::keep_choices(int y, const Match& match) {
  near_thresholds.insert(near_thresholds.end(), match.near_thresholds.begin(), match.near_thresholds.end());
  if (match.choices.empty()) return;
  const uint32_t run = scrambled(uint32_t(y) * 0x9e3779b1u ^ records_++ / kRun);
  if (run % one_in_ != 0) return;
  // Of a value that is not a number no code is the nominal one.
  std::copy_if(match.choices.begin(), match.choices.end(), std::back_inserter(choices),
               [](const StoreChoice& c) { return !std::isnan(c.value); });
  runs_.resize(choices.size(), run);
  while (choices.size() > kMostChoices && one_in_ < 1u << 31) {
    one_in_ *= 2;
    size_t kept = 0;
    for (size_t i = 0; i < choices.size(); ++i)
      if (runs_[i] % one_in_ == 0) choices[kept] = choices[i], runs_[kept++] = runs_[i];
    choices.erase(choices.begin() + int64_t(kept), choices.end());
    runs_.resize(kept);
  }
}

Profile resolved(const Profile& profile, const Pipeline& pipeline) {
  Profile p = profile;
  const HalfStore stated =
      pipeline.gbuffer.half_round == HalfRound::nearest ? HalfStore::nearest : HalfStore::toward_zero;
  if (p.exact_planes) p.half = stated;
  if (p.likely.half != HalfStore::either) return p;
  p.likely = {std::min(p.unorm_reach, 0.6), p.blend == BlendRule::mesa_codes, false,
              p.half == HalfStore::either ? stated : p.half};
  if (p.unorm_reach == 1.0) p.likely.code_reach = 0.5;
  return p;
}

StageVerdict verdict_of(std::string_view stage, const Profile& profile, int width, int height,
                        std::vector<RowTally>& rows) {
  StageVerdict v;
  v.stage = stage;
  v.profile = profile.name;
  v.rule = profile.likely;
  v.width = width, v.height = height;
  for (RowTally& row : rows) {
    v.classes.insert(v.classes.end(), row.classes.begin(), row.classes.end());
    for (const PixelClass c : row.classes) ++(c == PixelClass::left_out ? v.left_out : v.counts[size_t(c)]);
    if (!row.excess.empty()) {
      v.excess.resize(size_t(width) * size_t(height));
      const auto y = size_t(&row - rows.data());
      std::copy(row.excess.begin(), row.excess.end(), v.excess.begin() + int64_t(y) * width);
    }
    if (row.classes.empty()) v.classes.resize(v.classes.size() + size_t(width), PixelClass::exact);
    v.covered += row.covered, v.ambiguous += row.ambiguous, v.stored_values += row.stored_values;
    v.stored_apart += row.stored_apart;
    v.predicted_other += row.predicted_other;
    v.worst_error = std::max(v.worst_error, row.worst_error);
    v.row_errors.push_back(row.worst_error);
    v.surface_choices.insert(v.surface_choices.end(), row.surface_choices.begin(), row.surface_choices.end());
    v.choices.insert(v.choices.end(), row.choices.begin(), row.choices.end());
    v.near_thresholds.insert(v.near_thresholds.end(), row.near_thresholds.begin(), row.near_thresholds.end());
    v.textured.insert(v.textured.end(), row.textured.begin(), row.textured.end());
    v.glass.insert(v.glass.end(), row.glass.begin(), row.glass.end());
    v.worst.insert(v.worst.end(), row.worst.begin(), row.worst.end());
  }
  keep_worst(v.worst);
  std::vector<float> shown;
  for (const RowTally& row : rows) shown.insert(shown.end(), row.shown.begin(), row.shown.end());
  if (!shown.empty()) {
    std::nth_element(shown.begin(), shown.begin() + int64_t(shown.size() / 2), shown.end());
    v.power = double(shown[shown.size() / 2]);
  }
  return v;
}

std::vector<LocalWindow> worst_windows(const StageVerdict& v) {
  std::vector<LocalWindow> worst;
  for (const int side : kWindowSides) {
    LocalWindows windows(v.width, v.height, side);
    for (size_t i = 0; i < v.classes.size(); ++i) {
      const int x = int(i % size_t(v.width)), y = int(i / size_t(v.width));
      const PixelClass c = v.classes[i];
      if (c == PixelClass::left_out)
        windows.leave_out(x, y);
      else if (c == PixelClass::violation)
        windows.add(x, y, true, false, v.excess.empty() ? 0.0 : double(v.excess[i]));
      else if (shows_another(c))
        windows.add(x, y, false, true, 0.0);
    }
    if (const auto found = windows.worst()) worst.push_back(*found);
  }
  return worst;
}

}  // namespace trueshade::oracle
