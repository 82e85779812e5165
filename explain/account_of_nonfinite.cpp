// Why a pixel is NaN or infinite: the operation of the light program, or the step behind it, where a value first became
// so.
#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

#include "explain/account_parts.h"
#include "explain/step_operations.h"

namespace trueshade {
namespace {

using programs::NodeId;
using programs::Op;
using programs::Program;
using programs::ProgramNode;

float float_of(uint32_t bits) { return std::bit_cast<float>(bits); }

/// A number in words; NaN without a sign, since the renderer leaves its sign open.
std::string number_text(float value) { return std::isnan(value) ? "NaN" : value_text(value); }

/// Numbers with a comma and a space between two.
std::string numbers_text(std::span<const float> values) {
  std::string out;
  for (const float value : values) out += (out.empty() ? "" : ", ") + number_text(value);
  return out;
}

/// Whether no value is NaN or infinite.
bool is_finite(std::span<const float> values) {
  return std::all_of(values.begin(), values.end(), [](float x) { return std::isfinite(x); });
}

/// Finds the node of a program at which its values stop being finite.
class Origins {
 public:
  Origins(const Program& program, const NodeBits& bits) : program_(program), bits_(bits) {}

  /// The first operation, in the order of computation, that makes a value that is not finite of finite operands;
  /// infinite inputs and constants count as finite. Or an input that is NaN. Looks at what `count` outputs from number
  /// `first` on come from; nothing where these are finite.
  std::optional<NodeId> of(int first, int count) const {
    std::vector<bool> seen(program_.nodes.size());
    std::vector<NodeId> left;
    const auto visit = [&](NodeId id) {
      if (seen[id] || !is_lost(id)) return false;
      seen[id] = true;
      left.push_back(id);
      return true;
    };
    for (int k = 0; k < count; ++k) visit(program_.output[size_t(first + k)]);
    std::optional<NodeId> earliest;
    while (!left.empty()) {
      const NodeId id = left.back();
      left.pop_back();
      bool is_origin = true;
      for (const NodeId operand : followed(id)) {
        const ProgramNode& of = program_.nodes[operand];
        const bool is_given = of.op == Op::constant || (of.op == Op::input && !std::isnan(float_of(bits_[operand])));
        if (is_given || !is_lost(operand)) continue;  // a light may have no end
        is_origin = false;
        visit(operand);
      }
      if (is_origin && (!earliest || id < *earliest)) earliest = id;
    }
    return earliest;
  }

  /// What a node makes of its operands, `sqrt(-1) is NaN`; of an input its name, `light.range is NaN`; of a constant
  /// `a constant is inf`; of a choice the same of what it took.
  std::string text(NodeId id) const {
    const ProgramNode& node = program_.nodes[id];
    const std::string is = " is " + number_text(float_of(bits_[id]));
    if (node.op == Op::input) return program_.inputs[node.bits].name + is;
    if (node.op == Op::select) return text(followed(id).front());
    if (node.op == Op::constant) return "a constant" + is;
    std::vector<Expression> operands;
    for (const NodeId operand : node.operands()) {
      const bool is_float = program_.nodes[operand].type == programs::Type::f32;
      operands.push_back(
          {is_float ? number_text(float_of(bits_[operand])) : std::to_string(int32_t(bits_[operand])), Binding::whole});
    }
    return written(node.op, operands).text + is;
  }

 private:
  bool is_lost(NodeId id) const {
    return program_.nodes[id].type == programs::Type::f32 && !std::isfinite(float_of(bits_[id]));
  }
  /// The operands that a node's value comes from: all of them; for a choice, the side that was taken.
  std::vector<NodeId> followed(NodeId id) const {
    const ProgramNode& node = program_.nodes[id];
    if (node.op == Op::select) return {node.operand[bits_[node.operand[0]] != 0 ? 1 : 2]};
    return {node.operands().begin(), node.operands().end()};
  }

  const Program& program_;
  const NodeBits& bits_;
};

/// Where the light of a pixel stops being finite.
struct Loss {
  std::string of;  ///< which step made it
  std::vector<float> values;
  std::string line, operation;  ///< of a program's step
};

/// Finds where the light of one surface stops being finite. Borrows the frame and the lights.
class LossFinder {
 public:
  LossFinder(const ExplainedFrame& frame, const LightTotal& total) : frame_(frame), total_(total) {}

  /// The first loss of start(), of light() of a light, of the sum, and of finish(), in this order; nothing where all of
  /// them are finite, and where the surface is unlit.
  std::optional<Loss> run() const {
    const ProgramAtSurface& at = *total_.program;
    if (at.is_unlit()) return std::nullopt;
    if (auto loss = in_outputs(at.at_sum({}), "start()", programs::kStartOutput, 3)) return loss;
    for (size_t i = 0; i < total_.lights.size(); ++i) {
      const LightAtPixel& light = total_.lights[i];
      if (light.fate != LightFate::adds || is_finite(light.term)) continue;
      return in_outputs(at.at_light(i), "light() of light " + std::to_string(i), programs::kLightOutput, 3);
    }
    return blends_lights(frame_.pipeline.strategy) ? in_finish_of_each() : in_finish_of_sum();
  }

 private:
  std::optional<Loss> in_outputs(const NodeBits& bits, const std::string& of, int first, int count) const {
    const Program& program = total_.program->program();
    const Origins origins(program, bits);
    const std::optional<NodeId> origin = origins.of(first, count);
    if (!origin) return std::nullopt;
    Loss loss{of, {}, {}, origins.text(*origin)};
    for (int k = 0; k < count; ++k) loss.values.push_back(float_of(bits[program.output[size_t(first + k)]]));
    if (const uint32_t line = program.nodes[*origin].line; line != 0) {
      const std::string text = source_line(frame_.light_program, line);
      loss.line = std::to_string(line) + (text.empty() ? "" : ": " + text);
    }
    return loss;
  }
  std::optional<Loss> in_finish(const std::array<float, 3>& sum) const {
    return in_outputs(total_.program->at_sum(sum), "finish()", programs::kFinishOutput, 4);
  }
  std::optional<Loss> in_finish_of_each() const {
    if (auto loss = in_finish(total_.start)) return loss;
    for (const LightAtPixel& light : total_.lights)
      if (light.fate == LightFate::adds)
        if (auto loss = in_finish(light.term)) return loss;
    return std::nullopt;
  }
  std::optional<Loss> in_finish_of_sum() const {
    std::array<float, 3> sum = total_.start;
    for (const LightAtPixel& light : total_.lights)
      for (size_t k = 0; k < 3 && light.fate == LightFate::adds; ++k) sum[k] = sum[k] + light.term[k];
    if (!is_finite(sum)) return Loss{"the sum of the lights", {sum.begin(), sum.end()}, {}, {}};
    return in_finish(sum);
  }

  const ExplainedFrame& frame_;
  const LightTotal& total_;
};

/// The first draw of a finite color after which the target holds a value that is not finite; nothing for unorm targets.
std::optional<Loss> in_target(const ExplainedFrame& frame, const PixelHistory& history) {
  if (info(frame.target.format).number_class == NumberClass::unorm) return std::nullopt;
  for (const TargetDraw& draw : history.draws) {
    const auto held = values_of(frame.target, draw.after);
    if (is_finite(draw.source) && !is_finite(held))
      return Loss{"the target after " + draw.what, {held.begin(), held.end()}, {}, {}};
  }
  return std::nullopt;
}

/// The first loss at the visible surface, the tied ones, the glass and the target, in this order; nothing where all is
/// finite.
std::optional<Loss> found(const ExplainedFrame& frame, const PixelHistory& history) {
  std::vector<const LightTotal*> totals;
  if (history.lit.covered) totals.push_back(&history.lit.visible);
  for (const LightTotal& tied : history.lit.tied) totals.push_back(&tied);
  for (const LightTotal& glass : history.lit.glass) totals.push_back(&glass);
  for (const LightTotal* const total : totals)
    if (auto loss = LossFinder(frame, *total).run()) return loss;
  return in_target(frame, history);
}

}  // namespace

void add_nonfinite(const ExplainedFrame& frame, const PixelHistory& history, Account& to) {
  const std::optional<Loss> loss = found(frame, history);
  if (!loss) return;
  std::string stored;
  for (const AccountValue& value : values_in_format(frame.target.format, history.stored))
    stored += (stored.empty() ? "" : ", ") +
              (std::holds_alternative<float>(value) ? number_text(std::get<float>(value)) : value_text(value));
  to.add("nonfinite", numbers_text(loss->values), "is " + loss->of + "; stored is " + stored);
  if (!loss->line.empty()) to.add("line", loss->line, "of the light program, where a value first is not finite");
  if (!loss->operation.empty()) to.add("operation", loss->operation, "");
}

}  // namespace trueshade
