#include "judge/diagnosis/program_search.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/threads/parallel_for.h"
#include "judge/bounds/program_bounds.h"
#include "judge/diagnosis/disagreement.h"
#include "judge/diagnosis/plain_program.h"
#include "judge/diagnosis/program_edits.h"
#include "judge/stages/captured_surface.h"
#include "scenes/pipeline/light_mesh.h"

namespace trueshade::oracle {

namespace {

constexpr int kSide = 8;  // of a square, pixels
constexpr size_t kWrongSquares = 8, kRightSquares = 3;
constexpr size_t kMostTries = 20'000;  // with bounds; a try takes some 0.1 ms of a program of 100 operations
constexpr double kExplanation = 0.9;   // above it, operands are not tried: they are many
constexpr double kKnown = 1.0 / 512;   // a color that is known no better explains nothing

struct Sample {
  int x = 0, y = 0;
  bool wrong = false;
  ShadedSurface surface;
  std::array<double, 3> stored{};
};

/// Pixels that are judged together.
struct Square {
  std::vector<Sample> samples;
};

/// What a program makes of the samples, beside what is stored.
struct ProgramMatch {
  double explained = 0, contradicted = 0;  ///< shares of the samples that are wrong, and of those that are right
  double score() const { return explained - contradicted; }
};

class ProgramSearch {
 public:
  ProgramSearch(const Scene& scene, const Pipeline& pipeline, const Profile& profile, const Capture& capture,
                const StageVerdict& lighting)
      : scene_(scene),
        pipeline_(pipeline),
        profile_(resolved(profile, pipeline)),
        lighting_(lighting),
        surfaces_(scene, pipeline, profile_, capture),
        color_(target_of(capture, pipeline)),
        right_(scene, pipeline, profile_.arithmetic) {
    choose_squares();
  }

  std::vector<Finding> findings(size_t most) {
    if (squares_.empty()) return {};
    std::vector<std::pair<ProgramMatch, ProgramEdit>> found;
    const std::span<const Square> first(squares_.data(), 1);
    choose_few();
    double best = 0;
    std::vector<ProgramEdit> edits = program_edits(right_.program());
    std::vector<uint8_t> likely(edits.size());
    constexpr size_t kTogether = 32;
    for (size_t i = 0; i < edits.size(); ++i) {
      ProgramEdit& edit = edits[i];
      const bool is_last_resort =
          (edit.change == ProgramChange::scaled && !edit.is_parameter) || edit.change == ProgramChange::other_operand;
      if ((is_last_resort && best > kExplanation) || tries_ > kMostTries) break;
      if (i % kTogether == 0)
        parallel_for(int(std::min(kTogether, edits.size() - i)), 0, [&](int k) {
          ProgramEdit& one = edits[i + size_t(k)];
          likely[i + size_t(k)] = (!one.fitted || fit(one)) && may_explain(one, first);
        });
      if (!likely[i] || match_of(edited(right_.program(), edit), first).explained < kLeastExplained / 2 ||
          !may_explain(edit, squares_))
        continue;
      const ProgramMatch match = match_of(edited(right_.program(), edit), squares_);
      best = std::max(best, match.score());
      if (match.explained >= kLeastExplained) found.emplace_back(match, std::move(edit));
    }
    // Of what explains as much a normalize() that was left out comes first: it is forgotten more often than the rest.
    std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) {
      const auto forgets_length = [](const ProgramEdit& edit) { return edit.change == ProgramChange::number; };
      if (a.first.score() != b.first.score()) return a.first.score() > b.first.score();
      return forgets_length(a.second) && !forgets_length(b.second);
    });
    std::vector<Finding> out;
    for (const auto& [match, edit] : found) {
      if (out.size() == most) break;
      const std::string text = text_of(edit);
      if (std::none_of(out.begin(), out.end(), [&](const Finding& f) { return f.text == text; }))
        out.push_back(finding(match, edit));
    }
    for (size_t i = 1; i < out.size(); ++i)
      out[i].tied = out[i].explained == out[0].explained && out[i].contradicted == out[0].contradicted;
    return out;
  }

 private:
  bool is_wrong(int x, int y) const {
    return lighting_.classes[size_t(y) * size_t(pipeline_.width) + size_t(x)] == PixelClass::violation;
  }

  /// Squares with the most wrong pixels, from all over the picture, and some of those where a light is and nothing is
  /// wrong.
  void choose_squares() {
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
        add_square(place.x, place.y);
      }
    };
    if (wrong.empty()) return;
    take(wrong, kWrongSquares), take(right, kRightSquares);
  }

  void add_square(int left, int top) {
    Square& square = squares_.emplace_back();
    for (int y = top; y < std::min(top + kSide, pipeline_.height); ++y)
      for (int x = left; x < std::min(left + kSide, pipeline_.width); ++x) {
        if (!surfaces_.covered(x, y)) continue;
        Sample& s = square.samples.emplace_back();
        s.x = x, s.y = y, s.wrong = is_wrong(x, y), s.surface = surfaces_.at(x, y);
        for (int k = 0; k < 3; ++k) s.stored[size_t(k)] = color_.stored(x, y, k);
      }
  }

  static std::vector<const ShadedSurface*> surfaces_of(const Square& square) {
    std::vector<const ShadedSurface*> out;
    for (const Sample& s : square.samples) out.push_back(&s.surface);
    return out;
  }

  /// What is stored of a sample by a program; whether it is known so well that it could be another.
  struct Made {
    std::array<LegalTexel, 3> texel;
    bool known = true;
  };
  std::vector<Made> made_of(const ProgramBounds& bounds, const Square& square) {
    const std::vector<const ShadedSurface*> surfaces = surfaces_of(square);
    std::vector<LitRange> lit(surfaces.size());
    std::vector<uint32_t> near;
    bounds.take_near(surfaces, block_, near);
    bounds.at(surfaces, near, block_, lit);
    std::vector<Made> out(lit.size());
    for (size_t i = 0; i < lit.size(); ++i) {
      for (const OtherBranch& b : lit[i].branches)
        for (size_t k = 0; k < 3; ++k) lit[i].color[k].error += std::fabs(b.change[k]);
      const ProgramBounds::Finished color = bounds.finished(*surfaces[i], lit[i].color, block_.registers);
      out[i].known = !lit[i].undefined && !color.undefined;
      for (size_t k = 0; k < 3; ++k) {
        const Bounded& c = color.color[k];
        out[i].known = out[i].known && c.error <= kKnown * std::fabs(c.value) + 1e-9;
        out[i].texel[k] = legal_texel(range_of(c), color_.image->format, int(k), profile_);
      }
    }
    return out;
  }

  static bool fits(const Made& made, const Sample& sample) {
    for (size_t k = 0; k < 3; ++k)
      if (!made.texel[k].contains(sample.stored[k])) return false;
    return true;
  }

  ProgramMatch match_of(programs::Program program, std::span<const Square> squares) {
    ++tries_;
    const ProgramBounds bounds(scene_, pipeline_, profile_.arithmetic, std::move(program));
    size_t wrong = 0, right = 0, explained = 0, contradicted = 0;
    for (const Square& square : squares) {
      const std::vector<Made> made = made_of(bounds, square);
      for (size_t i = 0; i < made.size(); ++i) {
        const bool fit = fits(made[i], square.samples[i]);
        if (square.samples[i].wrong)
          ++wrong, explained += made[i].known && fit;
        else
          ++right, contradicted += !fit;
      }
    }
    return {wrong > 0 ? double(explained) / double(wrong) : 0, right > 0 ? double(contradicted) / double(right) : 0};
  }

  /// Whether the light has an extent that leaves the surface out.
  bool ends_before(const Light& light, const ShadedSurface& surface) const {
    if (drawn_extent(light, pipeline_.light_volumes) == LightExtent::unbounded) return false;
    double square = 0;
    for (size_t k = 0; k < 3; ++k) {
      const double off = double(light.position[int(k)]) - surface.position[k].value;
      square += off * off;
    }
    return !(std::sqrt(square) < double(light.range));
  }

  /// What a program stores of a sample, in doubles and so without bounds: 50 times as fast.
  std::array<double, 3> plainly_made(const PlainProgram& program, const Sample& sample) const {
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
  double step_of_target(size_t channel) const {
    const FormatInfo layout = info(color_.image->format);
    if (layout.number_class == NumberClass::unorm || layout.bits[channel] >= 32) return 0;
    return std::ldexp(1.0, layout.bits[channel] == 16 ? -10 : 5 - layout.bits[channel]);  // five bits of exponent
  }

  /// Whether a program stores about what is stored of a sample: within two codes, or a step of floats, and 1 part in
  /// 200, where a color that is known to 1 part in 512 is off by no more. Of unlit surfaces it is not known.
  bool is_near(const PlainProgram& program, const Sample& sample) const {
    if (sample.surface.material > 0 && scene_.materials[sample.surface.material - 1].unlit) return true;
    const bool has_codes = info(color_.image->format).number_class == NumberClass::unorm;
    const std::array<double, 3> made = plainly_made(program, sample);
    for (size_t k = 0; k < 3; ++k) {
      const double stored = sample.stored[k];
      const double least = has_codes ? 2.0 : 1e-6, part = 0.005 + step_of_target(k);
      if (!(std::fabs(made[k] - stored) <= part * std::fabs(stored) + least)) return false;
    }
    return true;
  }

  /// Whether a try with bounds could find that the edit explains enough of the squares, by programs in doubles.
  bool may_explain(const ProgramEdit& edit, std::span<const Square> squares) const {
    const PlainProgram program(scene_, pipeline_, edited(right_.program(), edit));
    if (std::none_of(few_.begin(), few_.end(), [&](const Sample* s) { return is_near(program, *s); })) return false;
    size_t wrong = 0, near = 0;
    for (const Square& square : squares)
      for (const Sample& s : square.samples)
        if (s.wrong) ++wrong, near += is_near(program, s);
    return double(near) >= kLeastExplained / 2 * double(wrong);
  }

  /// How far a program's picture is off, of the first of a few samples that are wrong: a part of the values, at most 1
  /// each.
  double distance(const ProgramEdit& edit, size_t samples) const {
    const PlainProgram program(scene_, pipeline_, edited(right_.program(), edit));
    double sum = 0;
    for (const Sample* sample : std::span(few_).first(samples)) {
      const std::array<double, 3> made = plainly_made(program, *sample);
      for (size_t k = 0; k < 3; ++k) {
        const double given = sample->stored[k], off = std::fabs(given - made[k]);
        const double size = std::fabs(given) + std::fabs(made[k]);
        sum += std::isfinite(off) && size > 0 ? off / size : off == 0 ? 0 : 1;
      }
    }
    return sum;
  }

  /// Some of the first square's that are wrong.
  void choose_few() {
    constexpr size_t kFew = 16;
    std::vector<const Sample*> wrong;
    for (const Sample& sample : squares_[0].samples)
      if (sample.wrong) wrong.push_back(&sample);
    const size_t count = std::min(kFew, wrong.size());
    for (size_t i = 0; i < count; ++i) few_.push_back(wrong[i * wrong.size() / count]);
  }

  /// Finds the number of a constant: a factor on a grid, and between its neighbours by golden section. False where the
  /// right number is as good: by a quarter of the samples first, since most edits are refused.
  bool fit(ProgramEdit& edit) const {
    constexpr double kGrid[] = {-1,   0,    0.05, 0.1,  0.2,   0.25,  0.3333, 0.5,   0.67, 0.8,
                                0.9,  0.95, 0.98, 0.99, 0.997, 0.999, 1.001,  1.003, 1.01, 1.02,
                                1.05, 1.1,  1.25, 1.5,  2,     3,     4,      5,     10,   20};
    const double given = edit.number, right = given != 0 ? given : 1;
    size_t samples = 0, best = 0;
    double least = 0;
    const auto at = [&](double factor) {
      edit.number = factor * right;
      return distance(edit, samples);
    };
    for (samples = (few_.size() + 3) / 4;; samples = few_.size()) {
      edit.number = given, least = HUGE_VAL;
      const double now = distance(edit, samples);
      for (size_t i = 0; i < std::size(kGrid); ++i)
        if (const double d = at(kGrid[i]); d < least) least = d, best = i;
      if (!(least < 0.6 * now)) return false;
      if (samples == few_.size()) break;
    }
    double low = kGrid[best == 0 ? 0 : best - 1], high = kGrid[std::min(best + 1, std::size(kGrid) - 1)];
    constexpr double kGolden = 0.6180339887498949;
    double p = high - kGolden * (high - low), q = low + kGolden * (high - low), at_p = at(p), at_q = at(q);
    for (int i = 0; i < 20; ++i) {
      if (at_p <= at_q) {
        high = q, q = p, at_q = at_p, p = high - kGolden * (high - low), at_p = at(p);
      } else {
        low = p, p = q, at_p = at_q, q = low + kGolden * (high - low), at_q = at(q);
      }
    }
    const double middle = at_p <= at_q ? p : q;
    edit.number = (at(middle) <= least ? middle : kGrid[best]) * right;
    return true;
  }

  std::string source_line(uint32_t number) const {
    const std::string& text = pipeline_.light_program.text;
    size_t from = 0;
    for (uint32_t i = 1; i < number && from != std::string::npos; ++i) from = text.find('\n', from) + 1;
    std::string line = text.substr(from, text.find('\n', from) - from);
    line.erase(0, line.find_first_not_of(" \t"));
    constexpr size_t kMost = 80;
    return line.size() > kMost ? line.substr(0, kMost - 3) + "..." : line;
  }

  static std::string number_text(double x) {
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", x);
    return text;
  }

  std::string text_of(const ProgramEdit& edit) const {
    if (edit.is_parameter)
      return "the parameter `" + edit.text + "` was " + number_text(edit.number) +
             " times the value that is given here";
    std::string text =
        "line " + std::to_string(edit.line) + " of " + right_.program().name + ", `" + source_line(edit.line) + "`, ";
    if (!edit.fitted) return text + edit.text;
    if (edit.change == ProgramChange::scaled)
      return text + "has " + number_text(edit.number) + " times the value that it should have";
    const programs::ProgramNode& node = right_.program().nodes[edit.nodes[0]];
    const uint32_t bits = right_.program().nodes[node.operand[edit.operand]].bits;
    return text + "has " + number_text(edit.number) + " where it should have " +
           number_text(double(std::bit_cast<float>(bits)));
  }

  Finding finding(const ProgramMatch& match, const ProgramEdit& edit) {
    Finding f;
    f.name =
        edit.is_parameter ? "light-shader-parameter-" + edit.text : "light-shader-line-" + std::to_string(edit.line);
    f.plane = "picture", f.text = text_of(edit), f.fitted = edit.fitted && !edit.is_parameter;
    f.changed = lighting_.count(PixelClass::violation);
    f.explained = f.alone = match.explained, f.contradicted = match.contradicted;
    prove(edit, f.proof);
    return f;
  }

  /// The channel that is farthest off of those that are explained.
  void prove(const ProgramEdit& edit, Proof& proof) {
    const ProgramBounds bounds(scene_, pipeline_, profile_.arithmetic, edited(right_.program(), edit));
    double farthest = -1;
    for (const Square& square : squares_) {
      const std::vector<Made> wrong = made_of(bounds, square), right = made_of(right_, square);
      for (size_t i = 0; i < wrong.size(); ++i)
        for (size_t k = 0; k < 3 && square.samples[i].wrong && fits(wrong[i], square.samples[i]); ++k) {
          const double given = square.samples[i].stored[k], off = std::fabs(given - right[i].texel[k].nominal);
          if (!(off > farthest)) continue;
          farthest = off;
          proof = {square.samples[i].x,       square.samples[i].y,      channel_of("color", int(k)), given,
                   right[i].texel[k].nominal, wrong[i].texel[k].nominal};
        }
    }
  }

  const Scene& scene_;
  const Pipeline& pipeline_;
  const Profile profile_;
  const StageVerdict& lighting_;
  const CapturedSurface surfaces_;
  const PlaneView color_;
  const ProgramBounds right_;
  std::vector<Square> squares_;
  std::vector<const Sample*> few_;
  ProgramBounds::Block block_;
  size_t tries_ = 0;
};

}  // namespace

std::vector<Finding> program_findings(const Scene& scene, const Pipeline& pipeline, const Profile& profile,
                                      const Capture& capture, const StageVerdict& lighting, size_t most) {
  if (lighting.count(PixelClass::violation) == 0) return {};
  return ProgramSearch(scene, pipeline, profile, capture, lighting).findings(most);
}

}  // namespace trueshade::oracle
