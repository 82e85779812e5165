#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "explain/account_parts.h"
#include "explain/program_steps.h"
#include "programs/edits/edit_text.h"

namespace trueshade {
namespace {

constexpr size_t kMostSteps = 60;

/// The roundings of a step's components in words: `exact`, or two digits each, which tell how near to half a unit of
/// the last place the rounding was; `-` for NaN.
std::string rounding_text(const std::vector<double>& rounding) {
  if (rounding.empty()) return {};
  if (std::all_of(rounding.begin(), rounding.end(), [](double r) { return r == 0.0; })) return "exact";
  std::string out;
  for (const double r : rounding) {
    char text[32];
    std::snprintf(text, sizeof text, r == 0.0 ? "%.0f" : "%+.2g", r);
    out += (out.empty() ? "" : ", ") + std::string(r == r ? text : "-");
  }
  return out;
}

/// Adds a part with one step: its numbers for programs, and a line of columns for people.
void add_step(const ProgramStep& step, size_t number, Account& to) {
  constexpr size_t kValues = 6, kRounding = 42, kExpression = 64;  // columns
  Account& part = to.part("operation", step.expression);
  part.add("number", int64_t(number), "of the step: others are made of #number");
  part.add("line", int64_t(step.line), "of the program's text");
  part.quantities.push_back({"value", "a component each", step.values, true, {}});
  if (!step.rounding.empty())
    part.add("rounding", step.rounding, "the exact result minus the value, in units of the value's last place");
  std::string& line = part.shown;
  const auto column = [&line](size_t at) { line.resize(std::max(line.size() + 2, at), ' '); };
  line = '#' + std::to_string(number);
  column(kValues);
  line += values_text(step.values);
  column(kRounding);
  line += rounding_text(step.rounding);
  column(kExpression);
  line += step.expression;
}

/// The steps that the wanted nodes come from: a step an instruction or, where these are more than kMostSteps and
/// `detail` is `usual`, a step an expression.
ProgramTrace trace_for(Detail detail, const ProgramAtSurface& at, const NodeBits& bits,
                       std::span<const programs::NodeId> wanted) {
  ProgramTrace trace = trace_of(at.program(), bits, wanted);
  if (detail == Detail::all || trace.steps.size() <= kMostSteps) return trace;
  return trace_of(at.program(), bits, wanted, StepSize::expression);
}

/// The indices of the steps to print: all, if few or if `detail` asks for them; else those that another line reads, and
/// of these the last kMostSteps.
std::vector<size_t> told(const ProgramTrace& trace, Detail detail) {
  std::vector<size_t> out(trace.steps.size());
  std::iota(out.begin(), out.end(), size_t(0));
  if (detail == Detail::all || out.size() <= kMostSteps) return out;
  std::erase_if(out, [&](size_t i) { return !trace.steps[i].read_elsewhere; });
  if (out.size() > kMostSteps) out.erase(out.begin(), out.end() - kMostSteps);
  return out;
}

/// Adds a part with the program's lines that `count` outputs from number `first` on come from, in the order in which
/// they are computed, each with its steps.
///   function: the name of the function that returns these outputs, for titles
void add_lines(const ExplainedFrame& frame, const ProgramAtSurface& at, const NodeBits& bits, const char* function,
               int first, int count, Detail detail, Account& to) {
  const programs::Program& program = at.program();
  const ProgramTrace trace =
      trace_for(detail, at, bits, std::span(program.output).subspan(size_t(first), size_t(count)));
  Account& lines = to.part("lines", std::string("Lines that ") + function + "() comes from: steps, values, and what " +
                                        "rounding left, in units of the last place");
  const std::vector<size_t> steps = told(trace, detail);
  if (steps.size() < trace.steps.size())
    lines.add("left_out", int64_t(trace.steps.size() - steps.size()), "steps; --all prints all");
  const bool has_lines =
      std::any_of(program.nodes.begin(), program.nodes.end(), [](const auto& node) { return node.line != 0; });
  std::string ours;  // steps that are no line of the user's
  Account* line = nullptr;
  uint32_t number = 0;
  for (const size_t i : steps) {
    const ProgramStep& step = trace.steps[i];
    if (step.line == 0 && has_lines) {
      ours += (ours.empty() ? "#" : "; #") + std::to_string(i + 1) + " is " + values_text(step.values);
      continue;
    }
    if (line == nullptr || step.line != number) {
      number = step.line;
      const std::string text = source_line(frame.light_program, number);
      line = &lines.part("line", number == 0 ? "of lines that the file does not tell"
                                             : "line " + std::to_string(number) + (text.empty() ? "" : ": " + text));
    }
    add_step(step, i + 1, *line);
  }
  if (!ours.empty()) {
    Account& part = lines.part("ours", "steps that are no line of the text: " + ours);
    part.shown = part.title;
  }
  Account& returned = lines.part("returned", trace.result);
  returned.shown = std::string(function) + "() is " + trace.result;
}

}  // namespace

std::string source_line(const LightProgram& program, uint32_t line) {
  return std::string(programs::source_line(program.text, line));
}

void add_program(const ExplainedFrame& frame, const LightTotal& total, Detail detail, Account& to) {
  const ProgramAtSurface& at = *total.program;
  to.add("program", at.program().name, "SHA-256 of its SPIR-V: " + at.program().sha256);
  to.add("start", total.start, "what the sum starts from: R, G, B");
  if (at.program().defines_start) add_lines(frame, at, at.at_sum({}), "start", programs::kStartOutput, 3, detail, to);
}

void add_program_light(const ExplainedFrame& frame, const LightTotal& total, size_t light, ProgramLines lines,
                       Detail detail, Account& to) {
  const LightAtPixel& at = total.lights[light];
  const LightRow& row = total.table->row[light];
  const bool placed = is_placed(row.type);
  to.add("color", row.color, "colour times intensity");
  if (placed && std::isfinite(row.range)) to.add("range", row.range, "scene units");
  if (has_area(row.type)) {
    const Light& own = frame.scene.lights[light];
    const auto three = [](const glm::vec3& v) { return std::array{v.x, v.y, v.z}; };
    const bool is_ball = own.up == glm::vec3(0);
    if (!is_ball) to.add("right", three(own.right), "from the centre to an end or an edge, scene units");
    if (row_of(row.type).is_aimed) {
      to.add("up", three(own.up), "to another edge");
      to.add("direction", three(own.direction), "the side to which it shines");
    } else {
      to.add("radius", is_ball ? own.right.x : own.up.x, "scene units");
    }
  }
  if (placed) to.add("d", at.d, "distance, scene units");
  if (at.fate == LightFate::out_of_reach) {
    to.add("end", std::sqrt(row.cut2), "distance from which this light adds nothing");
    return;
  }
  to.add("term", at.term, "what light() gives: R, G, B");
  const ProgramAtSurface& program = *total.program;
  const bool counts = program.program().defines_reaches;
  if (!counts && lines == ProgramLines::left_out) return;
  const NodeBits bits = program.at_light(light);
  if (counts)
    to.add("reaches", bits[program.program().output[programs::kReachesOutput]] != 0, "counted by light.count");
  if (lines == ProgramLines::left_out) return;
  add_lines(frame, program, bits, "light", programs::kLightOutput, 3, detail, to);
  if (counts && detail == Detail::all)
    add_lines(frame, program, bits, "reaches", programs::kReachesOutput, 1, detail, to);
}

void add_program_sum(const ExplainedFrame& frame, const LightTotal& total, Detail detail, Account& to) {
  const ProgramAtSurface& at = *total.program;
  std::array<float, 3> sum = total.start;
  for (const LightAtPixel& light : total.lights)
    for (size_t k = 0; k < 3 && light.fate == LightFate::adds; ++k) sum[k] = sum[k] + light.term[k];
  if (!at.program().defines_finish) return;
  to.add("lit", sum, "R, G, B that finish() is given");
  add_lines(frame, at, at.at_sum(sum), "finish", programs::kFinishOutput, 4, detail, to);
}

}  // namespace trueshade
