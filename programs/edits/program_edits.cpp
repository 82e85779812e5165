#include "programs/edits/program_edits.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <tuple>

namespace trueshade::programs {

namespace {

constexpr size_t kMostSteps = 300;  // of a program whose operands are tried: they are the square of these

/// The steps that light() depends on.
std::vector<bool> needed_by_light(const Program& program) {
  std::vector<bool> needed(program.nodes.size(), false);
  for (int i = kLightOutput; i < kReachesOutput; ++i) needed[program.output[size_t(i)]] = true;
  for (NodeId id = NodeId(needed.size()); id-- > 0;)
    if (needed[id])
      for (const NodeId operand : program.nodes[id].operands()) needed[operand] = true;
  return needed;
}

class EditList {
 public:
  explicit EditList(const Program& program) : p_(program) {
    const std::vector<bool> needed = needed_by_light(program);
    std::map<std::tuple<uint32_t, uint32_t, Op>, std::vector<NodeId>> steps;
    for (NodeId id = 0; id < program.nodes.size(); ++id) {
      const ProgramNode& node = program.nodes[id];
      if (!needed[id] || node.line == 0 || node.op == Op::constant || node.op == Op::input) continue;
      steps[{node.origin, node.line, node.op}].push_back(id);
    }
    for (auto& [key, nodes] : steps) steps_.push_back(std::move(nodes));
    std::sort(steps_.begin(), steps_.end());
  }

  std::vector<ProgramEdit> all() {
    for (const auto& step : steps_) nodes_ = step, of_operation();
    of_parameters();
    for (const auto& step : steps_) nodes_ = step, of_constants();
    for (const auto& step : steps_) nodes_ = step, of_value();
    of_albedo();
    for (const auto& step : steps_) nodes_ = step, of_terms();
    for (const auto& step : steps_) nodes_ = step, of_further_factors();
    for (const auto& step : steps_) nodes_ = step, of_factor();
    for (const auto& step : steps_) nodes_ = step, of_operands();
    return std::move(edits_);
  }

 private:
  const ProgramNode& at(NodeId id) const { return p_.nodes[id]; }
  const ProgramNode& first() const { return at(nodes_[0]); }
  bool is_number(NodeId id, float x) const {
    return at(id).op == Op::constant && at(id).type == Type::f32 && at(id).bits == std::bit_cast<uint32_t>(x);
  }

  ProgramEdit& add(ProgramChange change, std::string text) {
    ProgramEdit& edit = edits_.emplace_back();
    edit.change = change, edit.nodes = nodes_, edit.line = first().line, edit.text = std::move(text);
    return edit;
  }
  void other(Op op, const char* text) { add(ProgramChange::other_operation, text).op = op; }
  void alone(size_t operand, const char* text) { add(ProgramChange::operand_alone, text).operand = operand; }
  void number(double x, const char* text) { add(ProgramChange::number, text).number = x; }

  /// The choice of normalize(): 0 < l2 ? inversesqrt(l2) : 0.
  bool normalizes() const {
    return first().op == Op::select && at(first().operand[1]).op == Op::f_inverse_sqrt &&
           is_number(first().operand[2], 0);
  }

  void of_operation() {
    const auto& [a, b, c] = first().operand;
    switch (first().op) {
      case Op::f_add:
        if (mixes()) {
          add(ProgramChange::mixed_alone, "takes the first of two values where it should mix them").operand = 0;
          add(ProgramChange::mixed_alone, "takes the second of two values where it should mix them").operand = 1;
        }
        other(Op::f_sub, "subtracts where it should add");
        alone(0, "leaves out the second term of a sum");
        return alone(1, "leaves out the first term of a sum");
      case Op::f_sub:
        other(Op::f_add, "adds where it should subtract");
        add(ProgramChange::swapped, "subtracts the other way round");
        alone(0, "leaves out what it should subtract");
        return alone(1, "leaves out what it should subtract from");
      case Op::f_mul:
        if (a == b) return alone(0, "has a value where it should have its square");
        alone(0, "leaves out the second factor of a product");
        alone(1, "leaves out the first factor of a product");
        return other(Op::f_div, "divides where it should multiply");
      case Op::f_div:
        other(Op::f_mul, "multiplies where it should divide");
        add(ProgramChange::swapped, "divides the other way round");
        return alone(0, "leaves out a division");
      case Op::f_min:
      case Op::f_max:
        alone(0, "leaves out a bound (min, max or clamp)");
        if (first().op == Op::f_max) other(Op::f_abs, "takes the size of a value where it should bound it from below");
        return other(first().op == Op::f_min ? Op::f_max : Op::f_min, "takes the wrong one of min and max");
      case Op::f_neg:
        return alone(0, "leaves out a minus");
      case Op::f_abs:
        return alone(0, "leaves out abs()");
      case Op::f_sqrt:
        return alone(0, "leaves out a root");
      case Op::f_floor:
        return alone(0, "leaves out floor()");
      case Op::pow:
        return alone(0, "leaves out a power");
      case Op::select:
        if (normalizes()) {
          number(1, "leaves a vector as long as it is, where it should normalize it");
          return number(0.5, "halves a vector where it should normalize it");
        }
        alone(1, "takes a condition for always true");
        return alone(2, "takes a condition for never true");
      default:
        return;
    }
  }

  /// Each constant of the step is fitted: they are one number of all components.
  void of_constants() {
    if (p_.nodes[nodes_[0]].op == Op::select && normalizes()) return;
    for (size_t k = 0; k < first().operands().size(); ++k) {
      std::vector<NodeId> constants;
      for (const NodeId n : nodes_) constants.push_back(at(n).operand[k]);
      std::sort(constants.begin(), constants.end());
      constants.erase(std::unique(constants.begin(), constants.end()), constants.end());
      for (const NodeId constant : constants) {
        const double x = double(std::bit_cast<float>(at(constant).bits));
        if (at(constant).op != Op::constant || at(constant).type != Type::f32 || !std::isfinite(x)) continue;
        ProgramEdit& edit = add(ProgramChange::constant_operand, "");
        std::erase_if(edit.nodes, [&](NodeId n) { return at(n).operand[k] != constant; });
        edit.operand = k, edit.number = x, edit.fitted = true;
      }
    }
  }

  /// A product of a value with itself, whose root says nothing new.
  bool is_square(NodeId id) const { return at(id).op == Op::f_mul && at(id).operand[0] == at(id).operand[1]; }

  void of_value() {
    constexpr const char *kSquare = "has the square of a value where it should have the value",
                         *kRoot = "has the root of a value where it should have the value";
    if (first().type != Type::f32 || first().op == Op::select || nodes_.size() > 1) return;
    if (first().op != Op::f_sqrt) add(ProgramChange::square, kSquare);
    if (!is_square(nodes_[0])) add(ProgramChange::root, kRoot);
    for (size_t k = 0; k < first().operands().size(); ++k) {
      const NodeId operand = first().operand[k];
      if (at(operand).op == Op::constant || first().operand[0] == first().operand[1]) continue;
      if (info(first().op).operand[k] != Type::f32) continue;
      if (at(operand).op != Op::f_sqrt) add(ProgramChange::square_of_operand, kSquare).operand = k;
      if (!is_square(operand)) add(ProgramChange::root_of_operand, kRoot).operand = k;
    }
  }

  /// Parameters whose values are others than those that the picture was drawn with.
  void of_parameters() {
    for (NodeId id = 0; id < p_.nodes.size(); ++id) {
      if (at(id).op != Op::input || at(id).type != Type::f32) continue;
      const std::string& name = p_.inputs[at(id).bits].name;
      if (!name.starts_with("parameters.")) continue;
      nodes_ = {id};
      ProgramEdit& edit = add(ProgramChange::scaled, name.substr(name.find('.') + 1));
      edit.number = 1, edit.fitted = true, edit.is_parameter = true;
    }
  }

  std::vector<NodeId> albedo_inputs() const {
    std::vector<NodeId> found;
    for (NodeId id = 0; id < p_.nodes.size(); ++id)
      if (at(id).op == Op::input && input_name(id).starts_with("surface.albedo.") && !input_name(id).ends_with(".w"))
        found.push_back(id);
    return found;
  }
  const std::string& input_name(NodeId id) const { return p_.inputs[at(id).bits].name; }

  /// Albedo that is encoded once too often or once too few, by sRGB or by the power of 2.2 that stands for it.
  void of_albedo() {
    nodes_ = albedo_inputs();
    if (nodes_.empty()) return;
    uint32_t line = 0;  // that reads it
    for (NodeId id = NodeId(p_.nodes.size()); id-- > 0;)
      for (const NodeId operand : at(id).operands())
        if (at(id).line != 0 && std::find(nodes_.begin(), nodes_.end(), operand) != nodes_.end()) line = at(id).line;
    if (line == 0) return;
    const auto changed = [&](ProgramChange change, double power, const char* text) {
      ProgramEdit& edit = add(change, text);
      edit.number = power, edit.line = line;
    };
    changed(ProgramChange::srgb_encoded, 0, "has albedo sRGB-encoded where it should have linear light");
    changed(ProgramChange::srgb_encoded, 1 / 2.2, "has albedo to the power of 1/2.2 where it should have linear light");
    changed(ProgramChange::srgb_decoded, 0, "decodes albedo from sRGB once too often");
    changed(ProgramChange::srgb_decoded, 2.2, "has albedo to the power of 2.2 once too often");
  }

  /// Adds products and quotients of the step and the value of an earlier one (a cosine, say), and for a colour its
  /// product with albedo: a factor too many or too few. The step is a product, a quotient or a power, the earlier one a
  /// minimum, a maximum or a product. Adds nothing in programs of more than kMostSteps steps.
  void of_further_factors() {
    if (first().type != Type::f32 || (first().op != Op::f_mul && first().op != Op::f_div && first().op != Op::pow))
      return;
    if (steps_.size() > kMostSteps) return;
    for (const auto& step : steps_) {
      const Op op = at(step[0]).op;
      if (step.size() != 1 || (op != Op::f_max && op != Op::f_min && op != Op::f_mul)) continue;
      if (step[0] >= nodes_[0] || at(step[0]).type != Type::f32 || !keeps_rate(nodes_[0], step[0])) continue;
      const std::string value = "the value of line " + std::to_string(at(step[0]).line);
      add(ProgramChange::times_other, "has " + value + " as a factor that it should not have")
          .others.assign(nodes_.size(), step[0]);
      if (op != Op::f_mul)
        add(ProgramChange::over_other, "lacks " + value + " as a factor").others.assign(nodes_.size(), step[0]);
    }
    std::vector<NodeId> albedo = albedo_inputs();
    if (nodes_.size() != 3 || albedo.size() != 3 || *std::max_element(albedo.begin(), albedo.end()) >= nodes_[0])
      return;
    std::sort(albedo.begin(), albedo.end(), [this](NodeId a, NodeId b) { return input_name(a) < input_name(b); });
    add(ProgramChange::times_other, "has albedo as a factor that it should not have").others = albedo;
  }

  /// A sum with factors, of which one is of one term alone, as where a highlight is not multiplied by N.L.
  void of_terms() {
    if (first().op != Op::f_mul) return;
    for (size_t k = 0; k < 2; ++k) {
      const ProgramNode& factor = at(first().operand[k]);
      if (factor.op != Op::f_max && factor.op != Op::f_min) continue;
      std::vector<NodeId> sums;
      for (const NodeId node : nodes_)
        if (const NodeId sum = sum_in(at(node).operand[1 - k]);
            sum != kNoNode && at(node).operand[k] == first().operand[k])
          sums.push_back(sum);
      if (sums.size() != nodes_.size()) continue;
      for (const bool gates : {false, true})
        for (size_t term = 0; term < 2; ++term) {
          ProgramEdit& edit = add(ProgramChange::factor_of_one_term,
                                  "multiplies the " + std::string(term == 0 ? "second" : "first") +
                                      " term of a sum alone by the value of line " + std::to_string(factor.line) +
                                      (gates ? ", and has the other where that is above 0" : ""));
          edit.operand = k, edit.others = sums, edit.number = double(term), edit.gates = gates;
        }
    }
  }
  /// The sum that a product of few factors has as one.
  NodeId sum_in(NodeId id, int depth = kProductDepth) const {
    if (at(id).op == Op::f_add) return id;
    if (at(id).op != Op::f_mul || depth == 0) return kNoNode;
    const NodeId left = sum_in(at(id).operand[0], depth - 1);
    return left != kNoNode ? left : sum_in(at(id).operand[1], depth - 1);
  }

  /// x (1 - a) + y a
  bool mixes() const {
    const auto [x, y, none] = first().operand;
    return at(x).op == Op::f_mul && at(y).op == Op::f_mul && at(at(x).operand[1]).op == Op::f_sub &&
           is_number(at(at(x).operand[1]).operand[0], 1) && at(at(x).operand[1]).operand[1] == at(y).operand[1];
  }

  void of_factor() {
    if (first().type != Type::f32 || first().op == Op::select) return;
    ProgramEdit& edit = add(ProgramChange::scaled, "");
    edit.number = 1, edit.fitted = true;
  }

  /// Adds the step with one of its operands, unless that is a constant, replaced by the value of an earlier step: of a
  /// scalar step by a minimum, maximum, sum, root or product, of a vector step by a vector that was made unit length.
  /// Adds nothing for a select, nor in programs of more than kMostSteps steps.
  void of_operands() {
    if (first().type != Type::f32 || first().op == Op::select) return;
    if (steps_.size() > kMostSteps) return;
    for (size_t k = 0; k < first().operands().size(); ++k) {
      if (info(first().op).operand[k] != Type::f32) continue;
      if (nodes_.size() == 1) {
        for (const auto& step : steps_)
          if (step.size() == 1 && may_stand(step[0]) && at(step[0]).line <= first().line) take({step[0]}, k);
      } else if (nodes_.size() == 3) {
        for (const auto& step : steps_)
          if (step.size() == 3 && is_vector(step)) take(step, k);
      }
    }
  }
  bool may_stand(NodeId id) const {
    const Op op = at(id).op;
    return op == Op::f_min || op == Op::f_max || op == Op::f_add || op == Op::f_sqrt || op == Op::f_mul;
  }
  bool is_vector(const std::vector<NodeId>& step) const {
    return at(step[0]).op == Op::f_mul &&
           std::all_of(step.begin(), step.end(), [&](NodeId n) { return at(at(n).operand[1]).op == Op::select; });
  }
  /// So that what start() reads depends on no light.
  bool keeps_rate(NodeId node, NodeId other) const {
    return at(node).rate == Rate::pair || at(other).rate == Rate::constant || at(other).rate == at(node).rate;
  }
  void take(const std::vector<NodeId>& others, size_t operand) {
    for (size_t i = 0; i < nodes_.size(); ++i)
      if (others[i] >= nodes_[i] || !keeps_rate(nodes_[i], others[i]) || at(nodes_[i]).operand[operand] == others[i] ||
          at(at(nodes_[i]).operand[operand]).op == Op::constant)
        return;
    ProgramEdit& edit =
        add(ProgramChange::other_operand, "has the value of line " + std::to_string(at(others[0]).line) +
                                              " as an operand where it "
                                              "should have another");
    edit.operand = operand, edit.others = others;
  }

  const Program& p_;
  std::vector<std::vector<NodeId>> steps_;
  std::vector<NodeId> nodes_;
  std::vector<ProgramEdit> edits_;
};

}  // namespace

std::vector<ProgramEdit> program_edits(const Program& program) { return EditList(program).all(); }

}  // namespace trueshade::programs
