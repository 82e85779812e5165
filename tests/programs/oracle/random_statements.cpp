#include "tests/programs/oracle/random_statements.h"

#include <algorithm>

namespace trueshade::testing {

namespace {

constexpr const char* kCompound[] = {"+", "-", "*", "/"};
constexpr const char* kIntegerCompound[] = {"+", "-", "*", "&", "|", "^", "<<"};

}  // namespace

void RandomStatements::statements(uint32_t count, int nesting) {
  Block block(*this);
  for (; count > 0 && make_.cost < make_.most_cost; --count) {
    statement(nesting);
    if (marked_ && !make_.scope.empty() && make_.one_in(2)) mark(late_variable());
  }
}

void RandomStatements::own_integer() {
  const std::string made = name("k");
  line("int " + made + " = " +
       (make_.one_in(2) ? "int(" + make_.expression({'u', 1, 1}, 0) + ")" : make_.expression(kInt, 1)) + ";");
  declare(made, kInt, true);
}

std::string RandomStatements::array_of(const GlslType& type, int elements) {
  std::string text = type.name() + "[" + std::to_string(elements) + "](";
  for (int i = 0; i < elements; ++i) text += (i > 0 ? ", " : "") + make_.expression(type, 1);
  return text + ")";
}

std::string RandomStatements::value_of(const RandomStructure& of) {
  std::string text = of.name + "(";
  for (size_t i = 0; i < of.members.size(); ++i) {
    const GlslVariable& member = of.members[i];
    if (i > 0) text += ", ";
    text += member.elements > 0 ? array_of(member.type, member.elements) : make_.expression(member.type, 1);
  }
  return text + ")";
}

void RandomStatements::declare_members(const std::string& path, const RandomStructure& of, bool writable) {
  for (const GlslVariable& member : of.members)
    declare(path + "." + member.path, member.type, writable, member.elements);
}

std::string RandomStatements::scalar_of(const GlslVariable& variable) {
  std::string part = variable.path;
  if (variable.elements > 0) part += "[" + make_.index(variable.elements) + "]";
  if (variable.type.columns > 1) part += "[" + make_.index(variable.type.columns) + "]";
  if (variable.type.rows > 1) part += "[" + make_.index(variable.type.rows) + "]";
  return part;
}

GlslVariable RandomStatements::late_variable() {
  return make_.scope[make_.scope.size() - 1 - below(uint32_t(std::min<size_t>(make_.scope.size(), 12)))];
}

void RandomStatements::mark(const GlslVariable& variable) {
  const std::string bits = (variable.type.base == 'f' ? "floatBitsToUint(" : "uint(") + scalar_of(variable) + ")";
  line("mark = (mark ^ " + bits + ") * 16777619u;");
}

void RandomStatements::statement(int nesting) {
  const uint32_t draw = below(nesting < 3 ? 26 : 16);
  if (draw < 5) return declaration();
  if (draw < 11) return assignment();
  if (draw < 12) return two_results();
  if (draw < 14) return make_.helpers.empty() ? assignment() : call();
  if (draw < 15) return structures_.empty() ? declaration() : structured();
  if (draw < 16) return leaving();
  if (draw < 20) return branch(nesting);
  if (draw < 21) return choice(nesting);
  if (draw < 25) return loop(nesting);
  open("");
  statements(1 + below(3), nesting + 1);
  close();
}

void RandomStatements::declaration() {
  const GlslType type = make_.any_type();
  const std::string made = name("v");
  if (make_.one_in(6)) {
    const int elements = 2 + int(below(4));
    line(type.name() + " " + made + "[" + std::to_string(elements) + "] = " + array_of(type, elements) + ";");
    return declare(made, type, true, elements);
  }
  line(type.name() + " " + made + (make_.one_in(40) ? ";" : " = " + expression(type) + ";"));
  declare(made, type, true);
}

void RandomStatements::assignment() {
  const GlslType type = make_.any_type();
  const std::string to = make_.writable_part(type);
  if (to.empty()) return declaration();
  if (type.base == 'b' || make_.one_in(2)) return line(to + " = " + expression(type) + ";");
  if (make_.one_in(6)) return line(make_.one_in(2) ? to + "++;" : "--" + to + ";");
  if (type.base == 'f') {
    std::string operation = kCompound[below(4)];
    if (operation == "*" && type.columns > 1 && type.columns != type.rows) operation = "+";
    const std::string value = expression(make_.one_in(3) ? kFloat : type);
    return line(to + " " + operation + "= " + value + ";");
  }
  const std::string operation = kIntegerCompound[below(7)];
  line(to + " " + operation + "= " + expression(make_.one_in(3) ? GlslType{type.base, 1, 1} : type) + ";");
}

void RandomStatements::two_results() {
  const int rows = 1 + int(below(4));
  const GlslType real{'f', 1, rows}, whole{'i', 1, rows}, bits{'u', 1, rows};
  const std::string first = name("v"), second = name("v");
  switch (below(5)) {
    case 0:
      line(real.name() + " " + second + ";");
      line(real.name() + " " + first + " = modf(" + expression(real) + ", " + second + ");");
      return declare(first, real, true), declare(second, real, true);
    case 1:
      line(whole.name() + " " + second + ";");
      line(real.name() + " " + first + " = frexp(" + expression(real) + ", " + second + ");");
      return declare(first, real, true), declare(second, whole, true);
    case 2: {
      line(bits.name() + " " + second + ";");
      std::string text = bits.name() + " " + first + (make_.one_in(2) ? " = uaddCarry(" : " = usubBorrow(");
      text += expression(bits) + ", ";
      line(text + expression(bits) + ", " + second + ");");
      return declare(first, bits, true), declare(second, bits, true);
    }
    default: {
      const GlslType& type = make_.one_in(2) ? whole : bits;
      line(type.name() + " " + first + ", " + second + ";");
      std::string text = (type.base == 'u' ? "umulExtended(" : "imulExtended(") + expression(type) + ", ";
      line(text + expression(type) + ", " + first + ", " + second + ");");
      return declare(first, type, true), declare(second, type, true);
    }
  }
}

void RandomStatements::call() {
  const GlslHelper helper = make_.helpers[below(uint32_t(make_.helpers.size()))];
  if (make_.cost + make_.repeats * helper.cost > make_.most_cost) return assignment();
  make_.cost += make_.repeats * helper.cost;
  std::string arguments;
  for (size_t i = 0; i < helper.parameters.size(); ++i) {
    if (i > 0) arguments += ", ";
    const GlslType& type = helper.parameters[i];
    if (helper.directions[i] == 'i') {
      arguments += make_.expression(type, 1);
      continue;
    }
    std::string to = make_.one_in(3) ? make_.writable_part(type) : "";
    if (to.empty()) {
      to = name("v");
      line(type.name() + " " + to + " = " + make_.expression(type, 1) + ";");
      declare(to, type, true);
    }
    arguments += to;
  }
  const std::string made = name("v");
  line(helper.result.name() + " " + made + " = " + helper.name + "(" + arguments + ");");
  declare(made, helper.result, true);
}

void RandomStatements::structured() {
  const size_t which = below(uint32_t(structures_.size()));
  const RandomStructure& of = structures_[which];
  const std::string made = name("t");
  std::vector<std::string> others;
  for (const auto& [path, structure] : structs_in_scope_)
    if (structure == which) others.push_back(path);
  if (!others.empty() && make_.one_in(3)) {
    const std::string& other = others[below(uint32_t(others.size()))];
    const std::string text = "bool " + made + " = " + other + (make_.one_in(2) ? " == " : " != ");
    line(text + value_of(of) + ";");
    return declare(made, kBool, true);
  }
  if (make_.one_in(4)) {
    const int elements = 2 + int(below(2));
    std::string text = of.name + " " + made + "[" + std::to_string(elements) + "] = " + of.name + "[](";
    for (int i = 0; i < elements; ++i) text += (i > 0 ? ", " : "") + value_of(of);
    line(text + ");");
    declare_members(made + "[" + make_.index(elements) + "]", of, true);
    return declare_members(made + "[0]", of, true);
  }
  const std::string value = others.empty() || make_.one_in(2) ? value_of(of) : others[below(uint32_t(others.size()))];
  line(of.name + " " + made + " = " + value + ";");
  structs_in_scope_.emplace_back(made, which);
  declare_members(made, of, true);
}

void RandomStatements::leaving() {
  const uint32_t draw = below(in_loop_ ? 3 : 1);
  std::string text = "if (" + expression(kBool) + ") ";
  if (draw == 0) return line(text + "return " + expression(result_) + ";");
  line(text + (draw == 1 ? "break;" : "continue;"));
}

void RandomStatements::branch(int nesting) {
  open("if (" + expression(kBool) + ")");
  statements(1 + below(3), nesting + 1);
  close();
  if (make_.one_in(2)) {
    text_.pop_back();
    const bool condition = make_.one_in(3);
    text_ += condition ? " else if (" + expression(kBool) + ") {\n" : " else {\n";
    ++indent_;
    statements(1 + below(3), nesting + 1);
    close();
  }
}

void RandomStatements::choice(int nesting) {
  const char base = make_.one_in(2) ? 'i' : 'u';
  open("switch (" + expression({base, 1, 1}) + (base == 'i' ? " & 3)" : " % 5u)"));
  const uint32_t cases = 1 + below(4), without_default = below(2), first = below(2);
  for (uint32_t i = 0; i < cases; ++i) {
    line("case " + std::to_string(first + i) + (base == 'u' ? "u:" : ":"));
    part_of_choice(nesting, i + 1 < cases && make_.one_in(4) ? "" : "break;");
    if (i + 1 == cases && without_default != 0) break;
    if (i + 1 == cases) line("default:"), part_of_choice(nesting, "break;");
  }
  close();
}

void RandomStatements::part_of_choice(int nesting, const std::string& end) {
  const bool in_loop = std::exchange(in_loop_, false);
  ++indent_;
  open("");
  statements(1 + below(2), nesting + 1);
  close();
  if (!end.empty()) line(end);
  --indent_;
  in_loop_ = in_loop;
}

void RandomStatements::loop(int nesting) {
  const uint32_t trips = 1 + below(5);
  if (make_.repeats * trips > 40) return assignment();
  Block block(*this);
  const std::string counter = name("i"), bound = counter + " < " + std::to_string(trips);
  const bool of_data = make_.one_in(2);
  const std::string condition = of_data ? bound + " && " + expression(kBool) : bound;
  const uint32_t kind = below(5);
  if (kind >= 3) line("int " + counter + " = 0;");
  if (kind < 3)
    open(kind == 0
             ? "for (int " + counter + " = " + std::to_string(trips - 1) + "; " + counter + " >= 0; --" + counter + ")"
             : "for (int " + counter + " = 0; " + condition + "; " + counter + (kind == 1 ? "++)" : " += 1)"));
  if (kind == 3) open("while (" + condition + ")");
  if (kind == 4) open("do");
  if (kind >= 3) line(counter + "++;");
  declare(counter, kInt, false);
  const bool in_loop = std::exchange(in_loop_, true);
  make_.repeats *= trips;
  statements(1 + below(3), nesting + 1);
  make_.repeats /= trips;
  in_loop_ = in_loop;
  close(kind == 4 ? " while (" + condition + ");" : "");
}

}  // namespace trueshade::testing
