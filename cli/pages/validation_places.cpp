#include "cli/pages/validation_places.h"

#include <algorithm>
#include <cstdio>
#include <set>
#include <utility>

#include "cli/pages/page.h"
#include "explain/explain.h"
#include "judge/stages/legal_pixel.h"

namespace trueshade {
namespace {

using oracle::PixelClass;
using oracle::StageVerdict;
using oracle::WorstPixel;

constexpr size_t kMostViolations = 2000, kSamples = 20;  // to go through; samples are spread over the image
constexpr size_t kMostExplained = 160;                   // whose accounts are in the page
constexpr uint64_t kWork = 20'000'000;                   // triangles and lights looked at for all accounts

std::string digits_of(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

std::string text_of_worst(const WorstPixel& w) {
  std::string text;
  if (!w.plane.empty())
    text = w.plane + " is " + digits_of(w.given) + ";\nlegal is " + digits_of(w.low) + " to " + digits_of(w.high) +
           ",\nnominal " + digits_of(w.nominal) + ".";
  if (!w.note.empty()) text += (text.empty() ? "" : "\n") + std::string("Surface: ") + w.note + ".";
  return text;
}

Places violations_of(const Validation& v) {
  Places places{"Violations", "Pixels in no legal set, the worst of each stage first.", {}, true, {255, 40, 80}};
  for (const StageVerdict& s : v.verdict.stages) {
    std::vector<Places::Pixel> found;
    for (const WorstPixel& w : s.worst)
      if (w.pixel_class == PixelClass::violation) found.push_back({w.x, w.y, "classes-" + s.stage});
    const size_t worst = found.size();
    for (size_t i = 0; i < s.classes.size() && found.size() < kMostViolations; ++i) {
      if (s.classes[i] != PixelClass::violation) continue;
      const int x = int(i % size_t(s.width)), y = int(i / size_t(s.width));
      if (std::none_of(found.begin(), found.begin() + int64_t(worst),
                       [&](const auto& p) { return p.x == x && p.y == y; }))
        found.push_back({x, y, "classes-" + s.stage});
    }
    places.pixels.insert(places.pixels.end(), found.begin(), found.end());
  }
  const uint64_t all = v.verdict.violations();
  if (places.pixels.size() < all)
    places.about =
        "The first of " + grouped(std::to_string(all)) + " pixels in no legal set, the worst of each stage first.";
  return places;
}

/// Some pixels of a class in each stage, evenly spread over those that there are.
Places samples_of(const Validation& v, PixelClass c) {
  const std::string name(text(c));
  Places places{"Samples of " + name, "Some of the pixels that are " + name + ".", {}};
  for (const StageVerdict& s : v.verdict.stages) {
    const uint64_t step = std::max<uint64_t>(1, s.count(c) / kSamples);
    uint64_t seen = 0;
    for (size_t i = 0; i < s.classes.size(); ++i)
      if (s.classes[i] == c && seen++ % step == 0 && places.pixels.size() < 2 * kSamples)
        places.pixels.push_back({int(i % size_t(s.width)), int(i / size_t(s.width))});
  }
  return places;
}

/// The pixels to explain: of each list its first ones, in turn, so that every class has some.
std::vector<std::pair<int, int>> chosen_pixels(const std::vector<Places>& places, size_t most) {
  std::vector<std::pair<int, int>> chosen;
  std::set<std::pair<int, int>> known;
  size_t longest = 0;
  for (const Places& p : places) longest = std::max(longest, p.pixels.size());
  for (size_t i = 0; i < longest && chosen.size() < most; ++i)
    for (const Places& p : places)
      if (i < p.pixels.size() && chosen.size() < most && known.insert({p.pixels[i].x, p.pixels[i].y}).second)
        chosen.push_back({p.pixels[i].x, p.pixels[i].y});
  return chosen;
}

const StageVerdict* stage_named(const Validation& v, std::string_view name) {
  for (const StageVerdict& s : v.verdict.stages)
    if (s.stage == name) return &s;
  return nullptr;
}

/// What each channel of the target may hold on the captured surface. Nothing where that surface is not legal itself, or
/// where lights were judged one by one.
std::vector<std::array<double, 2>> legal_ranges(const Scene& scene, const Validation& v, int x, int y) {
  const StageVerdict *surfaces = stage_named(v, "gbuffer"), *lighting = stage_named(v, "lighting");
  if (lighting == nullptr || v.reference->color.format != v.capture.color.format) return {};
  if (surfaces != nullptr &&
      surfaces->classes[size_t(y) * size_t(surfaces->width) + size_t(x)] == PixelClass::violation)
    return {};
  Pipeline pipeline = v.pipeline;
  pipeline.gbuffer = surface_planes(v.pipeline);  // as the judge has it
  const oracle::LegalPixel legal = oracle::legal_pixel(scene, pipeline, v.profile, v.capture, v.reference->color, x, y);
  std::vector<std::array<double, 2>> ranges;
  for (int k = 0; k < legal.channels; ++k) {
    const oracle::LegalChannel& c = legal.channel[size_t(k)];
    if (!c.is_bounded) return {};
    ranges.push_back({c.low, c.high});
  }
  return ranges;
}

uint64_t triangles_of(const Scene& scene) {
  uint64_t count = 0;
  for (const Instance& instance : scene.instances) count += scene.meshes[instance.mesh].triangle_count();
  return count;
}

}  // namespace

std::vector<Places> places_of(const Validation& v) {
  std::vector<Places> places{violations_of(v)};
  for (const PixelClass c : {PixelClass::edge, PixelClass::depth_tie, PixelClass::clip, PixelClass::branch,
                             PixelClass::tex, PixelClass::undefined, PixelClass::store_2, PixelClass::exact})
    places.push_back(samples_of(v, c));
  return places;
}

std::vector<PixelExplanation> worst_pixels_of(const Validation& v) {
  std::vector<PixelExplanation> all;
  for (const StageVerdict& s : v.verdict.stages)
    for (const WorstPixel& w : s.worst)
      if (!w.plane.empty() || !w.note.empty())
        all.push_back({w.x, w.y, "Stage " + s.stage + ": " + std::string(text(w.pixel_class)), text_of_worst(w), {}});
  return all;
}

void add_accounts(const Scene& scene, const Validation& v, PageViewer& viewer) {
  if (!v.reference) return;
  Pipeline pipeline = v.pipeline;
  pipeline.post = {}, pipeline.view = ImageView::lit;
  const ExplainedFrame frame(scene, pipeline);
  const uint64_t work = triangles_of(scene) + 10 * scene.lights.size();
  const size_t most = std::clamp<uint64_t>(kWork / (work + 1), 8, kMostExplained);
  for (const auto& [x, y] : chosen_pixels(viewer.places, most))
    viewer.explanations.push_back({x, y, "How the reference gets its value",
                                   account_text(account_of(frame, history_of(frame, x, y))),
                                   legal_ranges(scene, v, x, y)});
}

}  // namespace trueshade
