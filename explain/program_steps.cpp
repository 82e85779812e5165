#include "explain/program_steps.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "explain/step_operations.h"

namespace trueshade {
namespace {

using programs::NodeId;
using programs::Op;
using programs::Program;
using programs::ProgramNode;
using programs::Type;

constexpr size_t kMostComponents = 4;
constexpr char kName = '\1';     // in the text of an expression: where the name of an operand stands
constexpr int kMostInside = 12;  // operations of an expression beside its last
constexpr std::string_view kNotTaken = "...";

/// How a value is named where others are made of it: `surface.normal` and 2, `#12` and 0.
struct ValueName {
  std::string name;
  int component = -1;  ///< -1: the whole
  int of = 0;          ///< components of a step; 0: of something else
  bool operator==(const ValueName&) const = default;
};

std::string text_of(const ValueName& name) {
  if (name.component < 0 || name.of == 1) return name.name;
  return name.name + '.' + "xyzw"[name.component];
}

/// The names of the components of an operand in one: `surface.normal.xyz`, `#3`, `(#3.x, 0, 1)`.
std::string operand_name(std::span<const ValueName> names) {
  const ValueName& first = names.front();
  const auto all = [&](auto holds) { return std::all_of(names.begin(), names.end(), holds); };
  if (all([&](const ValueName& n) { return n == first; })) return text_of(first);
  std::string out;
  if (first.component >= 0 && all([&](const ValueName& n) { return n.name == first.name && n.component >= 0; })) {
    bool whole = int(names.size()) == first.of;
    for (size_t k = 0; k < names.size(); ++k) {
      whole = whole && names[k].component == int(k);
      out += "xyzw"[names[k].component];
    }
    return whole ? first.name : first.name + '.' + out;
  }
  for (const ValueName& name : names) out += (out.empty() ? "(" : ", ") + text_of(name);
  return out + ')';
}

AccountValue value_of(Type type, uint32_t bits) {
  switch (type) {
    case Type::f32: {
      const float value = std::bit_cast<float>(bits);
      return value == value ? value : std::numeric_limits<float>::quiet_NaN();  // its sign is none of the renderer's
    }
    case Type::i32:
      return int64_t(int32_t(bits));
    case Type::u32:
      return int64_t(bits);
    case Type::boolean:
      break;
  }
  return bits != 0;
}

double number_of(Type type, uint32_t bits) {
  if (type == Type::f32) return double(std::bit_cast<float>(bits));
  return type == Type::i32 ? double(int32_t(bits)) : double(bits);
}

/// How far a number is from a float, in the float's last place.
double in_ulp(double exact, float value) {
  if (!std::isfinite(exact) || !std::isfinite(value)) return std::numeric_limits<double>::quiet_NaN();
  const float size = std::fabs(value);
  int exponent = -126;
  if (size >= 0x1p-126f) exponent = std::ilogb(size);
  return std::ldexp(exact - double(value), 23 - exponent);
}

class Tracer {
 public:
  Tracer(const Program& program, const NodeBits& bits, std::span<const NodeId> wanted, StepSize of_step)
      : program_(program),
        bits_(bits),
        wanted_(wanted),
        of_step_(of_step),
        uses_(size()),
        inside_(size()),
        step_(size()) {}

  ProgramTrace run() {
    count_uses();
    find_inside();
    for (NodeId id = 0; id < size(); ++id)
      if (is_step(id)) add(id);
    for (ProgramStep& step : out_.steps) finish(step);
    std::vector<ValueName> names;
    for (const NodeId id : wanted_) names.push_back(name_of(id));
    out_.result = operand_name(names);
    return std::move(out_);
  }

 private:
  /// A node's expression; its operands' names stand apart, so that those of all components can be joined.
  struct Named {
    Expression words;
    std::vector<ValueName> names;
    double exact = 0;
    bool rounds = false;
  };
  struct Place {
    size_t step = 0;  ///< counted from 1; 0: none
    int component = 0;
  };

  size_t size() const { return program_.nodes.size(); }
  const ProgramNode& node(NodeId id) const { return program_.nodes[id]; }
  bool is_named(NodeId id) const { return node(id).op == Op::constant || node(id).op == Op::input; }
  bool is_step(NodeId id) const { return uses_[id] > 0 && !is_named(id) && !inside_[id]; }

  /// The operands that a value comes from: of a choice the condition and the side that is taken, of `and` and `or`
  /// those up to the first that decides.
  std::vector<NodeId> followed(NodeId id) const {
    const ProgramNode& n = node(id);
    if (n.op == Op::select) return {n.operand[0], n.operand[bits_[n.operand[0]] != 0 ? 1 : 2]};
    const bool decided =
        (n.op == Op::b_and && bits_[n.operand[0]] == 0) || (n.op == Op::b_or && bits_[n.operand[0]] != 0);
    if (decided) return {n.operand[0]};
    return {n.operands().begin(), n.operands().end()};
  }

  void count_uses() {
    for (const NodeId id : wanted_) ++uses_[id];
    for (NodeId id = NodeId(size()); id-- > 0;) {
      if (uses_[id] == 0) continue;
      for (const NodeId operand : followed(id)) ++uses_[operand];
    }
  }

  void find_inside() {
    std::vector<int> count(size());  // of operations inside each
    for (NodeId id = 0; id < size(); ++id) {
      if (uses_[id] == 0 || is_named(id)) continue;
      for (const NodeId operand : followed(id)) {
        const ProgramNode& of = node(operand);
        if (uses_[operand] != 1 || is_named(operand) || is_wanted(operand) || of.line != node(id).line) continue;
        const bool same_step = of.origin != 0 && of.origin == node(id).origin;
        if ((of_step_ == StepSize::instruction && !same_step && rounds(of.op)) ||
            count[id] + count[operand] + 1 > kMostInside)
          continue;
        inside_[operand] = true;
        count[id] += count[operand] + 1;
      }
    }
  }
  bool is_wanted(NodeId id) const { return std::find(wanted_.begin(), wanted_.end(), id) != wanted_.end(); }

  ValueName name_of(NodeId id) const {
    const ProgramNode& n = node(id);
    if (n.op == Op::constant) return {value_text(value_of(n.type, n.bits))};
    if (n.op == Op::input) {
      const std::string& name = program_.inputs[n.bits].name;
      const size_t dot = name.size() - 2, component = std::string_view("xyzw").find(name.back());
      if (name[dot] != '.' || component == std::string_view::npos) return {name};
      return {name.substr(0, dot), int(component)};
    }
    if (step_[id].step == 0) return {std::string(kNotTaken)};
    const int of = int(out_.steps[step_[id].step - 1].nodes.size());
    return {'#' + std::to_string(step_[id].step), step_[id].component, of};
  }

  Named leaf(NodeId id) const {
    return {{std::string(1, kName), Binding::whole}, {name_of(id)}, number_of(node(id).type, bits_[id]), false};
  }
  Named operand(NodeId id) const { return inside_[id] ? expression(id) : leaf(id); }

  Named choice(NodeId id) const {
    const ProgramNode& n = node(id);
    const bool first = bits_[n.operand[0]] != 0;
    const Named condition = operand(n.operand[0]), taken = operand(n.operand[first ? 1 : 2]);
    const Named other = leaf(n.operand[first ? 2 : 1]);
    const Named &a = first ? taken : other, &b = first ? other : taken;
    Named out = condition;
    out.words = {operand_text(condition.words, Binding::comparison) + " (" + kName + ") ? " +
                     operand_text(a.words, Binding::comparison) + " : " + operand_text(b.words, Binding::comparison),
                 Binding::choice};
    out.names.push_back({first ? "true" : "false"});
    for (const Named* side : {&a, &b}) out.names.insert(out.names.end(), side->names.begin(), side->names.end());
    out.exact = taken.exact, out.rounds = taken.rounds;
    return out;
  }

  Named expression(NodeId id) const {
    const ProgramNode& n = node(id);
    if (n.op == Op::select) return choice(id);
    std::vector<Expression> words;
    std::vector<double> numbers;
    Named out;
    out.rounds = rounds(n.op);
    bool of_numbers = n.type == Type::f32;
    for (const NodeId of : n.operands()) {
      Named part = operand(of);
      words.push_back(std::move(part.words));
      numbers.push_back(part.exact);
      out.names.insert(out.names.end(), part.names.begin(), part.names.end());
      out.rounds = out.rounds || part.rounds;
    }
    out.words = written(n.op, words);
    const double exact = of_numbers ? exact_result(n.op, numbers) : std::numeric_limits<double>::quiet_NaN();
    const bool known = rounds(n.op) || n.op == Op::f_neg || n.op == Op::f_abs || n.op == Op::f_min || n.op == Op::f_max;
    if (!of_numbers || !known) out.rounds = false;  // its own value is taken for exact
    out.exact = known ? exact : number_of(n.type, bits_[id]);
    return out;
  }

  bool reads(NodeId id, const std::vector<NodeId>& nodes) const {
    for (const NodeId operand : node(id).operands())
      if (std::find(nodes.begin(), nodes.end(), operand) != nodes.end() || (inside_[operand] && reads(operand, nodes)))
        return true;
    return false;
  }

  /// Whether a node is one more component of the last step.
  bool continues(NodeId id) const {
    if (out_.steps.empty()) return false;
    const std::vector<NodeId>& nodes = out_.steps.back().nodes;
    const ProgramNode &first = node(nodes.front()), &n = node(id);
    return nodes.size() < kMostComponents && (n.origin != 0 || n.op == Op::select) && n.origin == first.origin &&
           n.line == first.line && n.op == first.op && n.type == first.type && !reads(id, nodes) &&
           expression(id).words.text == expression(nodes.front()).words.text;
  }

  void add(NodeId id) {
    if (!continues(id)) {
      out_.steps.emplace_back();
      out_.steps.back().line = node(id).line;
    }
    ProgramStep& step = out_.steps.back();
    step_[id] = {out_.steps.size(), int(step.nodes.size())};
    step.nodes.push_back(id);
    step.values.push_back(value_of(node(id).type, bits_[id]));
    step.read_elsewhere = step.read_elsewhere || is_wanted(id);
  }

  /// The step's words, once it is known how many components those have that it reads.
  void finish(ProgramStep& step) {
    std::vector<Named> of;
    for (const NodeId id : step.nodes) of.push_back(expression(id));
    size_t place = 0;
    for (const char c : of.front().words.text) {
      if (c != kName) {
        step.expression += c;
        continue;
      }
      std::vector<ValueName> names;
      for (const Named& component : of) names.push_back(component.names[place]);
      step.expression += operand_name(names);
      ++place;
    }
    for (size_t k = 0; k < of.size(); ++k)
      if (of[k].rounds) step.rounding.push_back(in_ulp(of[k].exact, std::bit_cast<float>(bits_[step.nodes[k]])));
    for (const NodeId id : step.nodes) mark_read(id, step.line);
  }

  void mark_read(NodeId id, uint32_t line) {
    for (const NodeId operand : followed(id)) {
      if (inside_[operand]) mark_read(operand, line);
      if (step_[operand].step == 0) continue;
      ProgramStep& of = out_.steps[step_[operand].step - 1];
      of.read_elsewhere = of.read_elsewhere || of.line != line;
    }
  }

  const Program& program_;
  const NodeBits& bits_;
  const std::span<const NodeId> wanted_;
  const StepSize of_step_;
  std::vector<int> uses_;
  std::vector<bool> inside_;
  std::vector<Place> step_;
  ProgramTrace out_;
};

}  // namespace

ProgramTrace trace_of(const Program& program, const NodeBits& bits, std::span<const NodeId> wanted, StepSize size) {
  return Tracer(program, bits, wanted, size).run();
}

}  // namespace trueshade
