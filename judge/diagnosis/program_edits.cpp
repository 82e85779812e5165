#include "judge/diagnosis/program_edits.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <tuple>

namespace trueshade::oracle {

namespace {

using programs::kNoNode;
using programs::NodeId;
using programs::Op;
using programs::Program;
using programs::ProgramNode;
using programs::Rate;
using programs::Type;

constexpr size_t kMostSteps = 300;  // of a program whose operands are tried: they are the square of these

/// The steps that light() depends on.
std::vector<bool> needed_by_light(const Program& program) {
  std::vector<bool> needed(program.nodes.size(), false);
  for (int i = programs::kLightOutput; i < programs::kReachesOutput; ++i) needed[program.output[size_t(i)]] = true;
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
        other(Op::f_sub, "subtracts where it should add");
        alone(0, "leaves out the second term of a sum");
        return alone(1, "leaves out the first term of a sum");
      case Op::f_sub:
        other(Op::f_add, "adds where it should subtract");
        add(ProgramChange::swapped, "subtracts the other way round");
        alone(0, "leaves out what it should subtract");
        return alone(1, "leaves out what it should subtract from");
      case Op::f_mul:
        if (a == b) return alone(0, "takes a value for its square");
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

  void of_value() {
    if (first().type != Type::f32 || first().op == Op::select || nodes_.size() > 1) return;
    add(ProgramChange::square, "has the square of a value where it should have the value");
    add(ProgramChange::root, "has the root of a value where it should have the value");
    for (size_t k = 0; k < first().operands().size(); ++k) {
      if (at(first().operand[k]).op == Op::constant || first().operand[0] == first().operand[1]) continue;
      if (info(first().op).operand[k] != Type::f32) continue;
      add(ProgramChange::square_of_operand, "has the square of a value where it should have the value").operand = k;
      add(ProgramChange::root_of_operand, "has the root of a value where it should have the value").operand = k;
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

  /// Albedo that is encoded once too often or once too few, by sRGB or by the power of 2.2 that stands for it.
  void of_albedo() {
    nodes_.clear();
    for (NodeId id = 0; id < p_.nodes.size(); ++id)
      if (at(id).op == Op::input && p_.inputs[at(id).bits].name.starts_with("surface.albedo.") &&
          !p_.inputs[at(id).bits].name.ends_with(".w"))
        nodes_.push_back(id);
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

  /// A cosine, say, as one factor more.
  void of_further_factors() {
    if (first().type != Type::f32 || (first().op != Op::f_mul && first().op != Op::f_div && first().op != Op::pow))
      return;
    for (const auto& step : steps_) {
      const Op op = at(step[0]).op;
      if (step.size() != 1 || (op != Op::f_max && op != Op::f_min && op != Op::f_mul)) continue;
      if (step[0] >= nodes_[0] || at(step[0]).type != Type::f32 || !keeps_rate(nodes_[0], step[0])) continue;
      ProgramEdit& edit = add(ProgramChange::times_other, "has the value of line " + std::to_string(at(step[0]).line) +
                                                              " as a factor that it should not have");
      edit.others.assign(nodes_.size(), step[0]);
    }
  }

  void of_factor() {
    if (first().type != Type::f32 || first().op == Op::select) return;
    ProgramEdit& edit = add(ProgramChange::scaled, "");
    edit.number = 1, edit.fitted = true;
  }

  /// A value of the same kind: a scalar that is bounded or a product of vectors, or a vector of unit length.
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

Program edited(const Program& program, const ProgramEdit& edit) {
  Program out = program;
  out.nodes.clear();
  std::vector<NodeId> now(program.nodes.size());
  const auto push = [&](const ProgramNode& node) {
    out.nodes.push_back(node);
    return NodeId(out.nodes.size() - 1);
  };
  const auto constant = [&](double x) {
    ProgramNode node;
    node.bits = std::bit_cast<uint32_t>(float(x));
    return push(node);
  };
  const auto made = [&](Op op, Type type, NodeId a, NodeId b, NodeId c) {
    ProgramNode node;
    node.op = op, node.type = type, node.operand = {a, b, c};
    return push(node);
  };
  const auto made_of_two = [&](Op op, NodeId a, NodeId b) { return made(op, Type::f32, a, b, kNoNode); };
  // IEC 61966-2-1, or a power in its place.
  const auto encoded = [&](NodeId x, double power) {
    if (power != 0) return made_of_two(Op::pow, x, constant(power));
    const NodeId low = made_of_two(Op::f_mul, x, constant(12.92)), root = made_of_two(Op::pow, x, constant(1 / 2.4)),
                 high = made_of_two(Op::f_sub, made_of_two(Op::f_mul, root, constant(1.055)), constant(0.055));
    const NodeId is_low = made(Op::f_lt, Type::boolean, x, constant(0.0031308), kNoNode);
    return made(Op::select, Type::f32, is_low, low, high);
  };
  const auto decoded = [&](NodeId x, double power) {
    if (power != 0) return made_of_two(Op::pow, x, constant(power));
    const NodeId low = made_of_two(Op::f_mul, x, constant(1 / 12.92)),
                 base = made_of_two(Op::f_mul, made_of_two(Op::f_add, x, constant(0.055)), constant(1 / 1.055)),
                 high = made_of_two(Op::pow, base, constant(2.4));
    const NodeId is_low = made(Op::f_lt, Type::boolean, x, constant(0.04045), kNoNode);
    return made(Op::select, Type::f32, is_low, low, high);
  };
  const auto powered = [&](NodeId value, Op op) {
    ProgramNode node;
    node.op = op, node.operand = {value, op == Op::f_mul ? value : kNoNode, kNoNode};
    return push(node);
  };
  for (NodeId id = 0; id < program.nodes.size(); ++id) {
    ProgramNode node = program.nodes[id];
    for (size_t k = 0; k < node.operands().size(); ++k) node.operand[k] = now[node.operand[k]];
    const auto place = std::lower_bound(edit.nodes.begin(), edit.nodes.end(), id);
    if (place == edit.nodes.end() || *place != id) {
      now[id] = push(node);
      continue;
    }
    switch (edit.change) {
      case ProgramChange::other_operation:
        node.op = edit.op;
        break;
      case ProgramChange::operand_alone:
        now[id] = node.operand[edit.operand];
        continue;
      case ProgramChange::swapped:
        std::swap(node.operand[0], node.operand[1]);
        break;
      case ProgramChange::number:
        now[id] = constant(edit.number);
        continue;
      case ProgramChange::constant_operand:
        node.operand[edit.operand] = constant(edit.number);
        break;
      case ProgramChange::other_operand:
        node.operand[edit.operand] = now[edit.others[size_t(place - edit.nodes.begin())]];
        break;
      case ProgramChange::scaled: {
        ProgramNode product;
        product.op = Op::f_mul, product.operand = {push(node), constant(edit.number), kNoNode};
        now[id] = push(product);
        continue;
      }
      case ProgramChange::times_other:
        now[id] = made_of_two(Op::f_mul, push(node), now[edit.others[size_t(place - edit.nodes.begin())]]);
        continue;
      case ProgramChange::srgb_encoded:
        now[id] = encoded(push(node), edit.number);
        continue;
      case ProgramChange::srgb_decoded:
        now[id] = decoded(push(node), edit.number);
        continue;
      case ProgramChange::square_of_operand:
        node.operand[edit.operand] = powered(node.operand[edit.operand], Op::f_mul);
        break;
      case ProgramChange::root_of_operand:
        node.operand[edit.operand] = powered(node.operand[edit.operand], Op::f_sqrt);
        break;
      case ProgramChange::square:
      case ProgramChange::root:
        now[id] = powered(push(node), edit.change == ProgramChange::square ? Op::f_mul : Op::f_sqrt);
        continue;
    }
    now[id] = push(node);
  }
  for (NodeId& id : out.output) id = now[id];
  set_rates(out);
  return out;
}

}  // namespace trueshade::oracle
