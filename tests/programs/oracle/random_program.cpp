#include "tests/programs/oracle/random_program.h"

#include <algorithm>
#include <utility>

#include "tests/programs/oracle/random_expressions.h"

namespace trueshade::testing {

namespace {

constexpr GlslType kFloat{'f', 1, 1}, kInt{'i', 1, 1}, kBool{'b', 1, 1}, kVec3{'f', 1, 3}, kVec4{'f', 1, 4};

struct Structure {
  std::string name;
  std::vector<GlslVariable> members;  ///< paths are the members' names
};

class Writer {
 public:
  explicit Writer(uint64_t seed) : make_(seed) {}

  RandomProgram program() {
    make_.most_cost = pick({500, 2000, 2000, 6000, 12000});
    depth_ = int(pick({2, 3, 3, 4}));
    RandomProgram made;
    constants();
    if (make_.one_in(4)) parameters(made);
    if ((mark_of_file_ = make_.one_in(2))) line("uint mark = 2166136261u;");
    marked_ = mark_of_file_;
    for (uint32_t count = below(3); count > 0; --count) structure();
    for (uint32_t count = below(4); count > 0; --count) helper();
    entry("light", kVec3, {{"s", 'S'}, {"l", 'L'}, {"v", 'V'}});
    make_.most_cost = make_.cost + 1000;
    if ((made.has_reaches = make_.one_in(3))) entry("reaches", kBool, {{"s", 'S'}, {"l", 'L'}, {"v", 'V'}});
    if ((made.has_start = make_.one_in(4))) entry("start", kVec3, {{"s", 'S'}, {"v", 'V'}});
    if ((made.has_finish = make_.one_in(4))) entry("finish", kVec4, {{"s", 'S'}, {"v", 'V'}, {"sum", 'f'}});
    made.text = text_;
    return made;
  }

 private:
  uint32_t below(uint32_t count) { return make_.random().below(count); }
  double pick(std::initializer_list<double> values) { return values.begin()[below(uint32_t(values.size()))]; }
  std::string name(const char* prefix) { return prefix + std::to_string(++names_); }
  std::string expression(const GlslType& type) { return make_.expression(type, 1 + int(below(uint32_t(depth_)))); }
  void line(const std::string& text) { text_ += std::string(size_t(indent_) * 2, ' ') + text + "\n"; }
  void open(const std::string& text) { line(text.empty() ? "{" : text + " {"), ++indent_; }
  void close(const std::string& after = "") { --indent_, line("}" + after); }

  /// What is declared until this ends is out of scope afterwards.
  struct Block {
    explicit Block(Writer& writer)
        : writer_(writer), size_(writer.make_.scope.size()), structs_(writer.structs_in_scope_) {}
    ~Block() { writer_.make_.scope.resize(size_), writer_.structs_in_scope_ = structs_; }
    Block(const Block&) = delete;
    Block& operator=(const Block&) = delete;
    Writer& writer_;
    size_t size_;
    std::vector<std::pair<std::string, size_t>> structs_;
  };

  void declare(const std::string& path, const GlslType& type, bool writable, int elements = 0, bool constant = false) {
    make_.scope.push_back({path, type, elements, writable, constant});
  }

  /// Constants and variables of the whole file; they stay in scope.
  void constants() {
    for (uint32_t count = below(3); count > 0; --count) {
      const GlslType type = make_.any_type();
      const std::string made = name("c");
      if (make_.one_in(2)) {
        const int elements = 2 + int(below(4));
        std::string text = "const " + type.name() + " " + made + "[" + std::to_string(elements) + "] = ";
        text += type.name() + "[](";
        for (int i = 0; i < elements; ++i) text += (i > 0 ? ", " : "") + make_.literal(type);
        line(text + ");");
        declare(made, type, false, elements, true);
      } else {
        line("const " + type.name() + " " + made + " = " + make_.literal(type) + ";");
        declare(made, type, false, 0, true);
      }
    }
    if (make_.one_in(4)) {
      const GlslType type = make_.any_type();
      const std::string made = name("g");
      line(type.name() + " " + made + (make_.one_in(2) ? ";" : " = " + make_.literal(type) + ";"));
      declare(made, type, true);
    }
  }

  void parameters(RandomProgram& program) {
    open("layout(std140, set = 0, binding = 5) uniform Parameters");
    for (uint32_t count = 1 + below(4); count > 0; --count) {
      GlslType type = make_.any_type();
      if (type.base == 'b') type.base = 'u';
      const std::string made = name("p");
      const int elements = make_.one_in(4) ? 2 + int(below(3)) : 0;
      line(type.name() + " " + made + (elements > 0 ? "[" + std::to_string(elements) + "]" : "") + ";");
      declare(made, type, false, elements);
      program.parameters.push_back({"Parameters." + made, type.base, type.scalars() * std::max(1, elements),
                                    type.base == 'f'   ? "position"
                                    : type.base == 'i' ? "index"
                                                       : "count"});
    }
    close(";");
  }

  void structure() {
    Structure made{name("T"), {}};
    open("struct " + made.name);
    for (uint32_t count = 1 + below(4); count > 0; --count) {
      GlslVariable member{name("m"), make_.any_type(), make_.one_in(4) ? 2 + int(below(3)) : 0, true, false};
      line(member.type.name() + " " + member.path +
           (member.elements > 0 ? "[" + std::to_string(member.elements) + "]" : "") + ";");
      made.members.push_back(member);
    }
    close(";");
    structures_.push_back(made);
  }

  void declare_members(const std::string& path, const Structure& of, bool writable) {
    for (const GlslVariable& member : of.members)
      declare(path + "." + member.path, member.type, writable, member.elements);
  }

  std::string array_of(const GlslType& type, int elements) {
    std::string text = type.name() + "[" + std::to_string(elements) + "](";
    for (int i = 0; i < elements; ++i) text += (i > 0 ? ", " : "") + make_.expression(type, 1);
    return text + ")";
  }

  std::string value_of(const Structure& of) {
    std::string text = of.name + "(";
    for (size_t i = 0; i < of.members.size(); ++i) {
      const GlslVariable& member = of.members[i];
      if (i > 0) text += ", ";
      text += member.elements > 0 ? array_of(member.type, member.elements) : make_.expression(member.type, 1);
    }
    return text + ")";
  }

  void helper() {
    GlslHelper made{name("h"), make_.any_type(), {}, "", 0};
    Block block(*this);
    const double cost_before = make_.cost;
    std::string head = made.result.name() + " " + made.name + "(";
    for (uint32_t count = below(4); count > 0; --count) {
      const GlslType type = make_.any_type();
      const char direction = "iiiox"[below(5)];
      const std::string parameter = name("a");
      if (!made.parameters.empty()) head += ", ";
      head += (direction == 'i' ? "" : direction == 'o' ? "out " : "inout ") + type.name() + " " + parameter;
      declare(parameter, type, true);
      made.parameters.push_back(type), made.directions += direction;
    }
    open(head + ")");
    result_ = made.result;
    own_integer();
    for (size_t i = 0; i < made.parameters.size(); ++i)  // what is not written stays what it was, or 0: at times
      if (made.directions[i] == 'o' && !make_.one_in(8)) {
        const GlslVariable out = make_.scope[block.size_ + i];
        line(out.path + " = " + make_.expression(out.type, 1) + ";");
      }
    statements(1 + below(4), 1);
    line("return " + expression(made.result) + ";");
    close();
    made.cost = int(make_.cost - cost_before) + 4;
    make_.cost = cost_before;
    make_.helpers.push_back(made);
  }

  void own_integer() {
    const std::string made = name("k");
    line("int " + made + " = " +
         (make_.one_in(2) ? "int(" + make_.expression({'u', 1, 1}, 0) + ")" : make_.expression(kInt, 1)) + ";");
    declare(made, kInt, true);
  }

  struct Parameter {
    const char* name;
    char kind;  ///< S, L, V: one of the interface's structures; f: vec3
  };

  void entry(const std::string& function, const GlslType& result, std::initializer_list<Parameter> parameters) {
    Block block(*this);
    std::string head = result.name() + " " + function + "(";
    for (const Parameter& parameter : parameters) {
      if (head.back() != '(') head += ", ";
      head += (parameter.kind == 'S'   ? "Surface "
               : parameter.kind == 'L' ? "Light "
               : parameter.kind == 'V' ? "View "
                                       : "vec3 ");
      head += parameter.name;
      if (parameter.kind == 'f') declare(parameter.name, kVec3, true);
      // A structure comes by value, and may be written like any other.
      for (const ProgramInput& input : interface_inputs()) {
        const char of = input.name[2];
        const std::string member = input.name.substr(input.name.rfind('.') + 1);
        if (of != parameter.kind || input.name.starts_with("TsSum")) continue;
        const std::string path = std::string(parameter.name) + "." + member;
        if (member == "user")
          declare(path, kVec4, true, 4);
        else if (input.scalars == 16)
          declare(path, {'f', 4, 4}, true);
        else
          declare(path, {input.base, 1, input.scalars}, true);
      }
    }
    open(head + ")");
    result_ = result;
    own_integer();
    if (!mark_of_file_) line("uint mark = 2166136261u;");
    marked_ = true;
    const bool main_one = function == "light";
    if (main_one && make_.one_in(2)) surface_terms();
    statements(main_one ? 2 + below(10) : below(3), 0);
    if (main_one && !make_.one_in(4))
      line("return vec3(float(mark >> 9), (" + returned() + ").xy);");
    else
      line("return " + returned() + ";");
    close();
    marked_ = mark_of_file_;
  }

  /// A scalar of a variable.
  std::string scalar_of(const GlslVariable& variable) {
    std::string part = variable.path;
    if (variable.elements > 0) part += "[" + make_.index(variable.elements) + "]";
    if (variable.type.columns > 1) part += "[" + make_.index(variable.type.columns) + "]";
    if (variable.type.rows > 1) part += "[" + make_.index(variable.type.rows) + "]";
    return part;
  }

  GlslVariable late_variable() {
    return make_.scope[make_.scope.size() - 1 - below(uint32_t(std::min<size_t>(make_.scope.size(), 12)))];
  }

  /// The bits of a late variable go into a mark, so that no result is lost on the way to the pixel.
  void mark() {
    if (!marked_ || make_.scope.empty()) return;
    const GlslVariable variable = late_variable();
    const std::string bits = (variable.type.base == 'f' ? "floatBitsToUint(" : "uint(") + scalar_of(variable) + ")";
    line("mark = (mark ^ " + bits + ") * 16777619u;");
  }

  /// What nearly every light has, so that more than noise goes through what follows.
  void surface_terms() {
    line("vec3 to_light = l.position - s.position;");
    line("float n_dot_l = max(dot(normalize(s.normal), normalize(to_light)), 0.0);");
    line("float d = length(to_light);");
    declare("to_light", kVec3, true), declare("n_dot_l", kFloat, true), declare("d", kFloat, true);
  }

  /// An expression and, of a vector, much of what is in scope besides: clamped, so that a NaN or infinity of one
  /// variable does not hide the others, or as it is.
  std::string returned() {
    if (result_.rows == 1 || make_.one_in(3)) return expression(result_);
    const bool clamped = !make_.one_in(3);
    std::string text = result_.name() + "(";
    for (int i = 0; i < result_.rows; ++i) {
      text += i > 0 ? ", " : "";
      for (int term = 0; term < 3; ++term) {
        if (term > 0) text += make_.one_in(4) ? " * " : " + ";
        const GlslVariable variable = late_variable();
        std::string part = scalar_of(variable);
        if (variable.type.base == 'i') part = "(" + part + " & 1023)";
        if (variable.type.base == 'u') part = "(" + part + " % 1021u)";
        if (variable.type.base != 'f') part = "float(" + part + ")";
        text += clamped ? "clamp(" + part + ", -9000.0, 9000.0)" : part;
      }
    }
    return text + ")";
  }

  void statements(uint32_t count, int nesting) {
    Block block(*this);
    for (; count > 0 && make_.cost < make_.most_cost; --count) {
      statement(nesting);
      if (make_.one_in(2)) mark();
    }
  }

  void statement(int nesting) {
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

  void declaration() {
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

  void assignment() {
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

  /// Functions that return by a parameter as well.
  void two_results() {
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

  /// A call as a statement, with variables for what it writes.
  void call() {
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

  /// A structure of the file's own, a copy of one, or a comparison of two.
  void structured() {
    const size_t which = below(uint32_t(structures_.size()));
    const Structure& of = structures_[which];
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

  void leaving() {
    const uint32_t draw = below(in_loop_ ? 3 : 1);
    std::string text = "if (" + expression(kBool) + ") ";
    if (draw == 0) return line(text + "return " + expression(result_) + ";");
    line(text + (draw == 1 ? "break;" : "continue;"));
  }

  void branch(int nesting) {
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

  void choice(int nesting) {
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

  /// `break` within leaves the choice, so a loop's is not written there.
  void part_of_choice(int nesting, const std::string& end) {
    const bool in_loop = std::exchange(in_loop_, false);
    ++indent_;
    open("");
    statements(1 + below(2), nesting + 1);
    close();
    if (!end.empty()) line(end);
    --indent_;
    in_loop_ = in_loop;
  }

  void loop(int nesting) {
    const uint32_t trips = 1 + below(5);
    if (make_.repeats * trips > 40) return assignment();
    Block block(*this);
    const std::string counter = name("i"), bound = counter + " < " + std::to_string(trips);
    const bool of_data = make_.one_in(2);
    const std::string condition = of_data ? bound + " && " + expression(kBool) : bound;
    const uint32_t kind = below(5);
    if (kind >= 3) line("int " + counter + " = 0;");
    if (kind < 3)
      open(kind == 0 ? "for (int " + counter + " = " + std::to_string(trips - 1) + "; " + counter + " >= 0; --" +
                           counter + ")"
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

  static constexpr const char* kCompound[] = {"+", "-", "*", "/"};
  static constexpr const char* kIntegerCompound[] = {"+", "-", "*", "&", "|", "^", "<<"};

  RandomExpressions make_;
  std::string text_;
  int names_ = 0, indent_ = 0, depth_ = 3;
  bool in_loop_ = false, mark_of_file_ = false, marked_ = false;
  GlslType result_ = kVec3;
  std::vector<Structure> structures_;
  std::vector<std::pair<std::string, size_t>> structs_in_scope_;  ///< variables of structures_[second]
};

}  // namespace

RandomProgram random_program(uint64_t seed) { return Writer(seed).program(); }

}  // namespace trueshade::testing
