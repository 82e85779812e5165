#include "explain/line_edits.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/fp_env.h"
#include "core/threads/parallel_for.h"
#include "explain/against.h"
#include "programs/edits/edit_text.h"
#include "programs/edits/fitted_number.h"

namespace trueshade {
namespace {

using programs::ProgramChange;
using programs::ProgramEdit;

constexpr double kMostWork = 1e9;    // steps of the program, times lights, in all edits together
constexpr double kWorkOfLight = 8;   // steps that a light takes besides those of the program
constexpr double kWorkOfEdit = 3e4;  // steps that an edit takes besides those of lights
constexpr double kMostLeft = 0.25;   // of the difference

/// An edit with what the pixel holds under it.
struct TriedEdit {
  ProgramEdit edit;
  StoredPixel stored{};
  double difference = HUGE_VAL;
  bool is_tried = false;
};

class LineSearch {
 public:
  LineSearch(const ExplainedFrame& frame, const PixelHistory& history, const StoredPixel& given)
      : frame_(frame),
        history_(history),
        given_(given),
        program_(history.lit.visible.program->program()),
        given_values_(values_of(frame.target, given)) {
    size_t reaching = 0;
    for (const LightAtPixel& light : history.lit.visible.lights) reaching += light.fate != LightFate::out_of_reach;
    work_of_try_ = double(reaching) * (double(program_.nodes.size()) + kWorkOfLight) + kWorkOfEdit;
  }

  LineEdits run(size_t most) {
    std::vector<ProgramEdit> edits = programs::program_edits(program_);
    std::erase_if(edits, [](const ProgramEdit& e) { return e.change == ProgramChange::scaled && !e.is_parameter; });
    constexpr size_t kTogether = 32;
    constexpr double kTriesOfFit = 54;
    LineEdits out;
    double work = 0;
    bool is_made = false;  // the given value, by an edit without a number
    const auto is_wanted = [&is_made](const ProgramEdit& edit) {
      return !is_made || !(edit.fitted || edit.change == ProgramChange::other_operand);
    };
    std::vector<TriedEdit> tried;
    for (size_t from = 0; from < edits.size(); from += kTogether) {
      if (work > kMostWork) {
        out.left_out = size_t(std::count_if(edits.begin() + ptrdiff_t(from), edits.end(), is_wanted));
        break;
      }
      std::vector<TriedEdit> some(std::min(kTogether, edits.size() - from));
      parallel_for(int(some.size()), 0, [&](int i) {
        some[size_t(i)].edit = std::move(edits[from + size_t(i)]);
        if (is_wanted(some[size_t(i)].edit)) try_edit(some[size_t(i)]);
      });
      for (TriedEdit& one : some) {
        work += work_of_try_ * (!one.is_tried ? 0 : one.edit.fitted ? kTriesOfFit : 1);
        is_made = is_made || (one.difference == 0 && !one.edit.fitted);
        out.tried += one.is_tried;
        if (counts(one)) tried.push_back(std::move(one));
      }
    }
    rank(tried);
    tell(tried, most, out);
    return out;
  }

 private:
  /// What the pixel holds under an edit.
  StoredPixel under(const ProgramEdit& edit) const {
    return drawn_target(frame_, relit(history_.lit, programs::edited(program_, edit)));
  }

  /// What is compared with the given pixel as a number: where lights are summed, the sum before its store.
  std::array<float, 4> value_under(const ProgramEdit& edit) const {
    const LitSurfaces lit = relit(history_.lit, programs::edited(program_, edit));
    const StoredPixel stored = drawn_target(frame_, lit);
    if (stored == given_) return given_values_;
    if (blends_lights(frame_.pipeline.strategy) || !lit.glass.empty()) return values_of(frame_.target, stored);
    std::array<float, 4> sum = lit.visible.sum;
    if (info(frame_.target.format).number_class == NumberClass::unorm)
      for (float& value : sum) value = std::clamp(value, 0.0f, 1.0f);
    return sum;
  }

  /// How far the pixel's value under an edit is from the given one: a part of the values, at most 1 a channel.
  double distance_under(const ProgramEdit& edit) const {
    const std::array<float, 4> made = value_under(edit);
    double sum = 0;
    for (size_t k = 0; k < 3; ++k) {
      const double off = std::fabs(double(made[k]) - double(given_values_[k]));
      const double size = std::fabs(double(made[k])) + std::fabs(double(given_values_[k]));
      sum += std::isfinite(off) && size > 0 ? off / size : off == 0 ? 0 : 1;
    }
    return sum;
  }

  /// Sets what the pixel holds under one edit, whose number is found first.
  void try_edit(TriedEdit& one) const {
    const FpScope fp;
    const auto distance = [this](const ProgramEdit& edit, bool) { return distance_under(edit); };
    one.is_tried = true;
    if (one.edit.fitted && !programs::fit_number(one.edit, distance, programs::Samples::few)) return;
    one.stored = under(one.edit);
    one.difference = stored_difference(frame_.target, one.stored, given_);
  }

  bool counts(const TriedEdit& one) const {
    const double here = stored_difference(frame_.target, history_.stored, given_);
    return one.difference <= kMostLeft * here && stored_difference(frame_.target, one.stored, history_.stored) > 0;
  }

  /// The nearest first. Of equally near ones those whose number was looked for come last, and a normalize() that was
  /// left out comes first, as in the diagnosis; else they stay in the order of program_edits().
  static void rank(std::vector<TriedEdit>& tried) {
    const auto doubt = [](const ProgramEdit& edit) {
      return edit.fitted ? 2 : edit.change == ProgramChange::number ? 0 : 1;
    };
    std::stable_sort(tried.begin(), tried.end(), [&](const TriedEdit& a, const TriedEdit& b) {
      return a.difference != b.difference ? a.difference < b.difference : doubt(a.edit) < doubt(b.edit);
    });
  }

  /// Adds the edits that are as near as the first, at most `most`, each line that they make once.
  void tell(const std::vector<TriedEdit>& tried, size_t most, LineEdits& out) const {
    constexpr size_t kMostWritten = 8;  // lines that are compiled to be told
    size_t written = 0;
    for (size_t i = 0; i < tried.size() && tried[i].difference == tried[0].difference; ++i) {
      ++out.alike;
      if (out.nearest.size() >= most || written++ >= kMostWritten) continue;
      LineEdit edit = told(tried[i]);
      const bool is_told = std::any_of(out.nearest.begin(), out.nearest.end(), [&](const LineEdit& other) {
        return other.drawn_as == edit.drawn_as && (!edit.drawn_as.empty() || other.what == edit.what);
      });
      if (is_told)
        --out.alike;
      else
        out.nearest.push_back(std::move(edit));
    }
  }

  LineEdit told(const TriedEdit& one) const {
    LineEdit out;
    const std::string words = programs::words_of(program_, one.edit);
    const LightProgram& program = frame_.pipeline.light_program;
    out.stored = one.stored, out.difference = one.difference;
    if (one.edit.is_parameter) {
      out.what = words;
      return out;
    }
    out.line = one.edit.line;
    out.what = "line " + std::to_string(out.line) + " of " + program_.name + " " + words;
    out.it_reads = programs::source_line(program.text, out.line);
    std::set<uint32_t> types;
    for (const Light& light : frame_.scene.lights) types.insert(uint32_t(light.type));
    programs::KnownInputs known;
    if (!types.empty()) known["light.type"] = {types.begin(), types.end()};
    out.drawn_as = programs::edited_line(program_, program.text, one.edit, known).value_or("");
    return out;
  }

  const ExplainedFrame& frame_;
  const PixelHistory& history_;
  const StoredPixel given_;
  const programs::Program& program_;
  const std::array<float, 4> given_values_;
  double work_of_try_ = 0;
};

}  // namespace

LineEdits line_edits_for(const ExplainedFrame& frame, const PixelHistory& history, const StoredPixel& given,
                         size_t most) {
  if (!frame.pipeline.light_program.used() || !history.lit.covered || history.lit.visible.program->is_unlit())
    return {};
  const FpScope fp;
  return LineSearch(frame, history, given).run(most);
}

}  // namespace trueshade
