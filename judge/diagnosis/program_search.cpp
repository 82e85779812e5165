#include "judge/diagnosis/program_search.h"

#include <algorithm>
#include <cmath>

#include "core/threads/parallel_for.h"
#include "judge/bounds/program_bounds.h"
#include "judge/diagnosis/disagreement.h"
#include "judge/diagnosis/program_samples.h"
#include "programs/edits/edit_text.h"
#include "programs/edits/fitted_number.h"

namespace trueshade::oracle {

namespace {

using programs::edited;
using programs::ProgramChange;
using programs::ProgramEdit;

constexpr size_t kMostTries = 20'000;  // with bounds; a try takes some 0.1 ms of a program of 100 operations
constexpr double kExplanation = 0.9;   // above it, operands are not tried: they are many
constexpr double kNearlyAll = 0.97;    // above it, no light is supposed to be missing besides
constexpr double kKnown = 1.0 / 512;   // a color that is known no better explains nothing

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
        samples_(scene, pipeline, profile_, capture, lighting),
        right_(scene, pipeline, profile_.arithmetic) {}

  ProgramFindings findings(size_t most) {
    const std::span<const SampleSquare> squares = samples_.squares();
    if (squares.empty()) return {};
    std::vector<std::pair<ProgramMatch, ProgramEdit>> found;
    const std::span<const SampleSquare> first = squares.first(1);
    double best = 0;
    std::vector<ProgramEdit> edits = programs::program_edits(right_.program());
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
          likely[i + size_t(k)] =
              (!one.fitted || fit(one)) && samples_.may_explain(edited(right_.program(), one), first);
        });
      if (!likely[i] || match_of(edited(right_.program(), edit), first).explained < kLeastExplained / 2 ||
          !samples_.may_explain(edited(right_.program(), edit), squares))
        continue;
      const ProgramMatch match = match_of(edited(right_.program(), edit), squares);
      best = std::max(best, match.score());
      if (match.explained >= kLeastExplained) found.emplace_back(match, std::move(edit));
    }
    // Of what explains as much a normalize() that was left out comes first: it is forgotten more often than the rest.
    std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) {
      const auto forgets_length = [](const ProgramEdit& edit) { return edit.change == ProgramChange::number; };
      if (a.first.score() != b.first.score()) return a.first.score() > b.first.score();
      return forgets_length(a.second) && !forgets_length(b.second);
    });
    ProgramFindings made;
    std::vector<Finding>& out = made.findings;
    constexpr size_t kMostWritten = 8;  // whose lines are looked for
    for (size_t i = 0, written = 0; i < found.size() && out.size() < most && written < kMostWritten; ++i) {
      const auto& [match, edit] = found[i];
      const std::string text = text_of(edit);
      if (!out.empty() && is_beaten(match, out[0])) break;
      if (std::any_of(out.begin(), out.end(), [&](const Finding& f) { return f.text == text; })) continue;
      Finding one = finding(match, edit);
      ++written;
      const bool is_said = std::any_of(out.begin(), out.end(), [&](const Finding& f) {
        return f.drawn_as == one.drawn_as && !one.drawn_as.empty();
      });
      if (!is_said) out.push_back(std::move(one));
    }
    for (size_t i = 1; i < out.size(); ++i)
      out[i].tied = out[i].explained == out[0].explained && out[i].contradicted == out[0].contradicted;
    if (best < kNearlyAll) made.beside = beside_missing_lights();
    return made;
  }

 private:
  /// Whether the first finding explains all, and another match less.
  static bool is_beaten(const ProgramMatch& match, const Finding& first) {
    return first.explained == 1 && first.contradicted == 0 && match.score() < 1;
  }

  static std::vector<const ShadedSurface*> surfaces_of(const SampleSquare& square) {
    std::vector<const ShadedSurface*> out;
    for (const ProgramSample& s : square.samples) out.push_back(&s.surface);
    return out;
  }

  /// What is stored of a sample by a program; whether it is known so well that it could be another.
  struct Made {
    std::array<LegalTexel, 3> texel;
    bool known = true;
  };
  std::vector<Made> made_of(const ProgramBounds& bounds, const SampleSquare& square) {
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
        out[i].texel[k] = legal_texel(range_of(c), samples_.format(), int(k), profile_);
      }
    }
    return out;
  }

  static bool fits(const Made& made, const ProgramSample& sample) {
    for (size_t k = 0; k < 3; ++k)
      if (!made.texel[k].contains(sample.stored[k])) return false;
    return true;
  }

  ProgramMatch match_of(programs::Program program, std::span<const SampleSquare> squares) {
    ++tries_;
    const ProgramBounds bounds(scene_, pipeline_, profile_.arithmetic, std::move(program));
    size_t wrong = 0, right = 0, explained = 0, contradicted = 0;
    for (const SampleSquare& square : squares) {
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

  /// Edits without numbers, each with a light, that together are near most of the wrong samples: the two that are near
  /// most. None where finish() stands between the lights and the picture.
  std::vector<SlipBesideLight> beside_missing_lights() {
    constexpr double kLeastNear = 0.6;
    constexpr size_t kMost = 2;  // pairs that are looked at
    if (right_.program().defines_finish) return {};
    const std::vector<const ProgramSample*> samples = samples_.wrong_everywhere();
    const std::vector<uint32_t> lights = samples_.strongest_at(samples);
    std::vector<ProgramEdit> edits = programs::program_edits(right_.program());
    std::erase_if(edits, [](const ProgramEdit& e) { return e.fitted || e.change == ProgramChange::other_operand; });
    struct Pair {
      size_t near = 0, edit = 0;
      uint32_t light = 0;
    };
    std::vector<Pair> pairs(edits.size());
    parallel_for(int(edits.size()), 0, [&](int e) {
      const std::vector<size_t> near =
          samples_.near_without(edited(right_.program(), edits[size_t(e)]), samples, lights);
      if (near.empty()) return;
      const auto most = std::max_element(near.begin(), near.end());
      pairs[size_t(e)] = {*most, size_t(e), lights[size_t(most - near.begin())]};
    });
    std::erase_if(pairs, [&](const Pair& p) { return double(p.near) < kLeastNear * double(samples.size()); });
    std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.near > b.near; });
    pairs.resize(std::min(pairs.size(), kMost));
    std::vector<SlipBesideLight> out;
    for (const Pair& pair : pairs) {
      const ProgramEdit& edit = edits[pair.edit];
      programs::Program program = edited(right_.program(), edit);
      const ProgramMatch match = match_of(program, samples_.squares());
      out.push_back({finding(match, edit), std::move(program), pair.light});
    }
    return out;
  }

  /// programs::fit_number() by the few samples, a quarter of them first.
  bool fit(ProgramEdit& edit) const {
    const auto distance_of = [this](const ProgramEdit& tried, bool all) {
      const size_t few = samples_.few().size();
      return samples_.distance(edited(right_.program(), tried), all ? few : (few + 3) / 4);
    };
    return programs::fit_number(edit, distance_of, programs::Samples::many);
  }

  std::string text_of(const ProgramEdit& edit) const {
    const std::string words = programs::words_of(right_.program(), edit);
    if (edit.is_parameter) return words;
    return "line " + std::to_string(edit.line) + " of " + right_.program().name + ", as it drew this picture, " + words;
  }

  Finding finding(const ProgramMatch& match, const ProgramEdit& edit) {
    Finding f;
    f.name =
        edit.is_parameter ? "light-shader-parameter-" + edit.text : "light-shader-line-" + std::to_string(edit.line);
    f.plane = "picture", f.text = text_of(edit), f.fitted = edit.fitted && !edit.is_parameter;
    if (!edit.is_parameter) {
      f.line = edit.line, f.it_reads = programs::source_line(pipeline_.light_program.text, edit.line);
      f.drawn_as = programs::edited_line(right_.program(), pipeline_.light_program.text, edit).value_or("");
    }
    f.changed = lighting_.count(PixelClass::violation);
    f.explained = f.alone = match.explained, f.contradicted = match.contradicted;
    prove(edit, f.proof);
    return f;
  }

  /// The channel that is farthest off of those that are explained.
  void prove(const ProgramEdit& edit, Proof& proof) {
    const ProgramBounds bounds(scene_, pipeline_, profile_.arithmetic, edited(right_.program(), edit));
    double farthest = -1;
    for (const SampleSquare& square : samples_.squares()) {
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
  const ProgramSamples samples_;
  const ProgramBounds right_;
  ProgramBounds::Block block_;
  size_t tries_ = 0;
};

}  // namespace

ProgramFindings program_findings(const Scene& scene, const Pipeline& pipeline, const Profile& profile,
                                 const Capture& capture, const StageVerdict& lighting, size_t most) {
  if (lighting.count(PixelClass::violation) == 0) return {};
  return ProgramSearch(scene, pipeline, profile, capture, lighting).findings(most);
}

}  // namespace trueshade::oracle
