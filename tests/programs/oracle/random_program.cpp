#include "tests/programs/oracle/random_program.h"

#include <algorithm>
#include <utility>

#include "tests/programs/oracle/random_statements.h"

namespace trueshade::testing {

namespace {

constexpr GlslType kVec3{'f', 1, 3}, kVec4{'f', 1, 4};

/// Writes a whole file.
class RandomFile : RandomStatements {
 public:
  using RandomStatements::RandomStatements;

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
  struct Parameter {
    const char* name;
    char kind;  ///< S, L, V: one of the interface's structures; f: vec3
  };

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
      globals_.emplace_back(made, type);
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
                                                       : "count",
                                    elements, type.columns});
    }
    close(";");
  }

  void structure() {
    RandomStructure made{name("T"), {}};
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
    const bool of_pixel = function == "start" || function == "finish";
    if (of_pixel) written_anew();
    own_integer();
    if (!mark_of_file_) line("uint mark = 2166136261u;");
    marked_ = true;
    const bool main_one = function == "light";
    if (main_one && make_.one_in(2)) surface_terms();
    if (main_one && make_.one_in(4))
      applications();
    else
      statements(main_one ? 2 + below(10) : below(3), 0);
    if (main_one && !make_.one_in(4))
      line("return vec3(float(mark >> 9), (" + returned() + ").xy);");
    else
      line("return " + returned() + ";");
    close();
    marked_ = mark_of_file_;
  }

  /// Variables of the whole file, where what `light` left in them would make a pixel depend on a light.
  void written_anew() {
    for (const auto& [variable, type] : globals_) line(variable + " = " + make_.literal(type) + ";");
    if (mark_of_file_) line("mark = 2166136261u;");
  }

  /// One operation after the other, mostly of what the program reads, each marked: more of them than among statements.
  void applications() {
    for (uint32_t count = 20 + below(60); count > 0 && make_.cost < make_.most_cost; --count) {
      const GlslType type = make_.any_type();
      const std::string made = name("v");
      line(type.name() + " " + made + " = " + make_.expression(type, 1) + ";");
      for (uint32_t marks = 1 + below(3); marks > 0; --marks) mark({made, type, 0, false, false});
    }
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

  std::vector<std::pair<std::string, GlslType>> globals_;
};

}  // namespace

RandomProgram random_program(uint64_t seed) { return RandomFile(seed).program(); }

}  // namespace trueshade::testing
