#include "judge/diagnosis/program_samples.h"

#include <algorithm>
#include <cmath>

#include "judge/diagnosis/disagreement.h"
#include "scenes/pipeline/light_mesh.h"

namespace trueshade::oracle {

namespace {

constexpr int kSide = 8;  // of a square, pixels
constexpr size_t kWrongSquares = 8, kRightSquares = 3;

}  // namespace

ProgramSamples::ProgramSamples(const Scene& scene, const Pipeline& pipeline, const Profile& profile,
                               const Capture& capture, const StageVerdict& lighting)
    : scene_(scene),
      pipeline_(pipeline),
      lighting_(lighting),
      surfaces_(scene, pipeline, profile, capture),
      color_(target_of(capture, pipeline)) {
  choose_squares();
  choose_few();
}

bool ProgramSamples::is_wrong(int x, int y) const {
  return lighting_.classes[size_t(y) * size_t(pipeline_.width) + size_t(x)] == PixelClass::violation;
}

/// Squares with the most wrong pixels, from all over the picture, and some of those where a light is and nothing is
/// wrong.
void ProgramSamples::choose_squares() {
  struct Place {
    int x, y, wrong, covered;
  };
  std::vector<Place> wrong, right;
  for (int y = 0; y < pipeline_.height; y += kSide)
    for (int x = 0; x < pipeline_.width; x += kSide) {
      Place place{x, y, 0, 0};
      for (int v = y; v < std::min(y + kSide, pipeline_.height); ++v)
        for (int u = x; u < std::min(x + kSide, pipeline_.width); ++u)
          if (surfaces_.covered(u, v)) ++place.covered, place.wrong += is_wrong(u, v);
      if (place.wrong > 0) wrong.push_back(place);
      if (place.wrong == 0 && place.covered > 0) right.push_back(place);
    }
  std::stable_sort(wrong.begin(), wrong.end(), [](const Place& a, const Place& b) { return a.wrong > b.wrong; });
  wrong.resize((wrong.size() + 1) / 2);
  const auto take = [&](const std::vector<Place>& places, size_t count) {
    for (size_t i = 0; i < std::min(count, places.size()); ++i) {
      const Place& place = places[i * places.size() / std::min(count, places.size())];
      ProgramSamples::add_square(place.x, place.y);
    }
  };
  if (wrong.empty()) return;
  take(wrong, kWrongSquares), take(right, kRightSquares);
}

void ProgramSamples::add_square(int left, int top) {
  SampleSquare& square = squares_.emplace_back();
  for (int y = top; y < std::min(top + kSide, pipeline_.height); ++y)
    for (int x = left; x < std::min(left + kSide, pipeline_.width); ++x) {
      if (!surfaces_.covered(x, y)) continue;
      ProgramSample& s = square.samples.emplace_back();
      s.x = x, s.y = y, s.wrong = is_wrong(x, y), s.surface = surfaces_.at(x, y);
      for (int k = 0; k < 3; ++k) s.stored[size_t(k)] = color_.stored(x, y, k);
    }
}

/// Whether the light has an extent that leaves the surface out.
bool ProgramSamples::ends_before(const Light& light, const ShadedSurface& surface) const {
  if (drawn_extent(light, pipeline_.light_volumes) == LightExtent::unbounded) return false;
  double square = 0;
  for (size_t k = 0; k < 3; ++k) {
    const double off = double(light.position[int(k)]) - surface.position[k].value;
    square += off * off;
  }
  return !(std::sqrt(square) < double(light.range));
}

/// What a program stores of a sample, in doubles and so without bounds: 50 times as fast.
std::array<double, 3> ProgramSamples::plainly_made(const PlainProgram& program, const ProgramSample& sample) const {
  thread_local PlainProgram::Values values;
  program.look_at(sample.surface, scene_.camera, values);
  Triple3 sum = program.start(values);
  for (uint32_t i = 0; i < scene_.lights.size(); ++i)
    if (!ends_before(scene_.lights[i], sample.surface)) sum = plus(sum, program.term(scene_.lights[i], i, values));
  const std::array<double, 4> color = program.finish(sum, values);
  std::array<double, 3> out;
  for (int k = 0; k < 3; ++k) out[size_t(k)] = stored_value(pipeline_, LightFault::Store::right, color[size_t(k)], k);
  return out;
}

/// What a float of the target may be off by, relative, where it is stored as its other neighbour.
double ProgramSamples::step_of_target(size_t channel) const {
  const FormatInfo layout = info(color_.image->format);
  if (layout.number_class == NumberClass::unorm || layout.bits[channel] >= 32) return 0;
  return std::ldexp(1.0, layout.bits[channel] == 16 ? -10 : 5 - layout.bits[channel]);  // five bits of exponent
}

/// Whether a program stores about what is stored of a sample: within two codes, or a step of floats, and 1 part in
/// 200, where a color that is known to 1 part in 512 is off by no more. Of unlit surfaces it is not known.
bool ProgramSamples::is_near(const PlainProgram& program, const ProgramSample& sample) const {
  if (sample.surface.material > 0 && scene_.materials[sample.surface.material - 1].unlit) return true;
  return ProgramSamples::is_near(plainly_made(program, sample), sample);
}
bool ProgramSamples::is_near(const std::array<double, 3>& made, const ProgramSample& sample) const {
  const bool has_codes = info(color_.image->format).number_class == NumberClass::unorm;
  for (size_t k = 0; k < 3; ++k) {
    const double stored = sample.stored[k];
    const double least = has_codes ? 2.0 : 1e-6, part = 0.005 + step_of_target(k);
    if (!(std::fabs(made[k] - stored) <= part * std::fabs(stored) + least)) return false;
  }
  return true;
}

/// Whether a try with bounds could find that the edit explains enough of the squares, by programs in doubles.
bool ProgramSamples::may_explain(const programs::Program& changed, std::span<const SampleSquare> squares) const {
  const PlainProgram program(scene_, pipeline_, changed);
  if (std::none_of(few_.begin(), few_.end(), [&](const ProgramSample* s) { return is_near(program, *s); }))
    return false;
  size_t wrong = 0, near = 0;
  for (const SampleSquare& square : squares)
    for (const ProgramSample& s : square.samples)
      if (s.wrong) ++wrong, near += is_near(program, s);
  return double(near) >= kLeastExplained / 2 * double(wrong);
}

/// How far a program's picture is off, of the first of a few samples that are wrong: a part of the values, at most 1
/// each.
double ProgramSamples::distance(const programs::Program& changed, size_t samples) const {
  const PlainProgram program(scene_, pipeline_, changed);
  double sum = 0;
  for (const ProgramSample* sample : std::span(few_).first(samples)) {
    const std::array<double, 3> made = plainly_made(program, *sample);
    for (size_t k = 0; k < 3; ++k) {
      const double given = sample->stored[k], off = std::fabs(given - made[k]);
      const double size = std::fabs(given) + std::fabs(made[k]);
      sum += std::isfinite(off) && size > 0 ? off / size : off == 0 ? 0 : 1;
    }
  }
  return sum;
}

/// Pixels that are wrong, some of every square, and the first square's first.
std::vector<const ProgramSample*> ProgramSamples::wrong_everywhere() const {
  constexpr size_t kOfSquare = 4;
  std::vector<const ProgramSample*> out;
  for (const SampleSquare& square : squares_) {
    std::vector<const ProgramSample*> wrong;
    for (const ProgramSample& sample : square.samples)
      if (sample.wrong) wrong.push_back(&sample);
    const size_t count = std::min(kOfSquare, wrong.size());
    for (size_t i = 0; i < count; ++i) out.push_back(wrong[i * wrong.size() / count]);
  }
  return out;
}

/// The lights that add most to some samples, the strongest first.
std::vector<uint32_t> ProgramSamples::strongest_at(std::span<const ProgramSample* const> samples) const {
  constexpr size_t kMost = 12;
  const PlainProgram program(scene_, pipeline_);
  PlainProgram::Values values;
  std::vector<double> strength(scene_.lights.size());
  for (const ProgramSample* sample : samples) {
    program.look_at(sample->surface, scene_.camera, values);
    for (uint32_t i = 0; i < strength.size(); ++i) {
      if (ends_before(scene_.lights[i], sample->surface)) continue;
      const Triple3 term = program.term(scene_.lights[i], i, values);
      strength[i] += std::fabs(term[0]) + std::fabs(term[1]) + std::fabs(term[2]);
    }
  }
  std::vector<uint32_t> lights;
  for (uint32_t i = 0; i < strength.size(); ++i)
    if (strength[i] > 0) lights.push_back(i);
  std::stable_sort(lights.begin(), lights.end(), [&](uint32_t a, uint32_t b) { return strength[a] > strength[b]; });
  lights.resize(std::min(lights.size(), kMost));
  return lights;
}

std::vector<size_t> ProgramSamples::near_without(const programs::Program& changed,
                                                 std::span<const ProgramSample* const> samples,
                                                 std::span<const uint32_t> lights) const {
  constexpr size_t kFirst = 6;
  const PlainProgram program(scene_, pipeline_, changed);
  PlainProgram::Values values;
  std::vector<size_t> near(lights.size());
  std::vector<Triple3> terms(scene_.lights.size());
  for (size_t i = 0; i < samples.size(); ++i) {
    if (i == kFirst && std::all_of(near.begin(), near.end(), [](size_t n) { return n == 0; })) return {};
    const ProgramSample& sample = *samples[i];
    program.look_at(sample.surface, scene_.camera, values);
    Triple3 all = program.start(values);
    for (uint32_t k = 0; k < terms.size(); ++k) {
      terms[k] = ends_before(scene_.lights[k], sample.surface) ? Triple3{} : program.term(scene_.lights[k], k, values);
      all = plus(all, terms[k]);
    }
    for (size_t k = 0; k < lights.size(); ++k) {
      const std::array<double, 4> color = program.finish(minus(all, terms[lights[k]]), values);
      std::array<double, 3> made;
      for (int c = 0; c < 3; ++c)
        made[size_t(c)] = stored_value(pipeline_, LightFault::Store::right, color[size_t(c)], c);
      near[k] += is_near(made, sample);
    }
  }
  return near;
}

/// Some of the first square's that are wrong.
void ProgramSamples::choose_few() {
  constexpr size_t kFew = 16;
  if (squares_.empty()) return;
  std::vector<const ProgramSample*> wrong;
  for (const ProgramSample& sample : squares_[0].samples)
    if (sample.wrong) wrong.push_back(&sample);
  const size_t count = std::min(kFew, wrong.size());
  for (size_t i = 0; i < count; ++i) few_.push_back(wrong[i * wrong.size() / count]);
}

}  // namespace trueshade::oracle
