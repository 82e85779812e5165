#include "tests/programs/oracle/random_expressions.h"

#include <algorithm>

#include "tests/programs/oracle/random_patterns.h"

namespace trueshade::testing {

namespace {

using namespace patterns;

const char* pick(Pcg32& random, Patterns patterns) { return patterns[random.below(uint32_t(patterns.size()))]; }

Patterns same_size(char base) {
  if (base == 'f') return kFloats;
  if (base == 'i') return kInts;
  if (base == 'u') return kUints;
  return kBoolVectors;
}

Patterns with_scalars(char base) {
  if (base == 'f') return kFloatVectors;
  if (base == 'i') return kIntVectors;
  if (base == 'u') return kUintVectors;
  return kBoolVectors;
}

}  // namespace

std::string GlslType::name() const {
  if (columns > 1) return "mat" + std::to_string(columns) + (columns == rows ? "" : "x" + std::to_string(rows));
  if (rows > 1) return (base == 'f' ? "" : std::string(1, base)) + "vec" + std::to_string(rows);
  return base == 'f' ? "float" : base == 'i' ? "int" : base == 'u' ? "uint" : "bool";
}

GlslType RandomExpressions::any_type() {
  const uint32_t draw = random_.below(20);
  if (draw < 11) return {'f', 1, 1 + int(random_.below(4))};
  if (draw < 14) return {'i', 1, one_in(2) ? 1 : 1 + int(random_.below(4))};
  if (draw < 16) return {'u', 1, one_in(2) ? 1 : 1 + int(random_.below(4))};
  if (draw < 18) return {'b', 1, one_in(2) ? 1 : 1 + int(random_.below(4))};
  const int columns = 2 + int(random_.below(3));
  return {'f', columns, one_in(2) ? columns : 2 + int(random_.below(3))};
}

std::string RandomExpressions::number(char base) {
  const bool odd = one_in(25);
  if (base == 'f') {
    if (one_in(3)) {
      std::string text = std::to_string(random_.below(1000)) + ".";
      text += std::to_string(random_.below(1000));
      return text + (one_in(2) ? "e-3" : "");
    }
    return pick(random_, odd ? Patterns(kOddNumbers) : Patterns(kNumbers));
  }
  if (base == 'i') return pick(random_, odd ? Patterns(kOddIntegers) : Patterns(kIntegers));
  if (base == 'u') return pick(random_, odd ? Patterns(kOddUnsigned) : Patterns(kUnsigned));
  return one_in(2) ? "true" : "false";
}

std::string RandomExpressions::literal(const GlslType& type) {
  if (type.scalars() == 1) return number(type.base);
  std::string text = type.name() + "(";
  const int count = one_in(4) ? 1 : type.scalars();
  for (int i = 0; i < count; ++i) text += (i > 0 ? ", " : "") + number(type.base);
  return text + ")";
}

std::string RandomExpressions::integer_variable() {
  std::vector<const GlslVariable*> found;
  for (const GlslVariable& variable : scope)
    if (variable.type == GlslType{'i', 1, 1} && variable.elements == 0 && !variable.constant)
      found.push_back(&variable);
  return found.empty() ? "1" : found[random_.below(uint32_t(found.size()))]->path;
}

std::string RandomExpressions::index(int count) {
  if (one_in(2)) return std::to_string(random_.below(uint32_t(count)));
  const std::string variable = integer_variable();
  if (variable == "1") return "0";  // a constant beyond the end would be refused
  switch (random_.below(4)) {
    case 0:
      return variable;
    case 1:
      return variable + " + 1";
    case 2:
      return "uint(" + variable + ") % " + std::to_string(count) + "u";
    default:
      return variable + " & " + std::to_string(count == 3 ? 1 : count - 1);
  }
}

std::string RandomExpressions::swizzle(int from, int count, bool distinct) {
  const std::string names = one_in(3) ? "rgba" : "xyzw";
  std::string chosen = ".";
  while (int(chosen.size()) <= count) {
    const char c = names[random_.below(uint32_t(from))];
    if (!distinct || chosen.find(c) == std::string::npos) chosen += c;
  }
  return chosen;
}

/// A part of a variable that has a type, or nothing.
std::string RandomExpressions::part(const GlslVariable& variable, const GlslType& type, bool write) {
  const GlslType& has = variable.type;
  if (has.base != type.base) return "";
  std::string path = variable.path;
  if (variable.elements > 0) path += "[" + index(variable.elements) + "]";
  if (has == type) return path;
  if (type.columns > 1) return "";
  if (has.columns > 1) {
    if (type.rows != has.rows && type.rows != 1) return "";
    path += "[" + index(has.columns) + "]";
    return type.rows == has.rows ? path : path + "[" + index(has.rows) + "]";
  }
  if (has.rows == 1 || (write && type.rows > has.rows)) return "";
  if (type.rows == 1 && one_in(3)) return path + "[" + index(has.rows) + "]";
  return path + swizzle(has.rows, type.rows, write);
}

std::string RandomExpressions::variable_part(const GlslType& type, bool write) {
  for (int tries = 0; tries < 12 && !scope.empty(); ++tries) {
    // What was declared last is taken more often.
    const auto size = uint32_t(scope.size());
    const uint32_t at = one_in(2) ? size - 1 - random_.below(std::min(size, 8u)) : random_.below(size);
    const GlslVariable variable = scope[at];
    if (write && !variable.writable) continue;
    const std::string found = part(variable, type, write);
    if (!found.empty()) return found;
  }
  return "";
}

std::string RandomExpressions::writable_part(const GlslType& type) { return variable_part(type, true); }

std::string RandomExpressions::leaf(const GlslType& type) {
  if (!one_in(5)) {
    const std::string found = variable_part(type, false);
    if (!found.empty()) return found;
    const std::string other = type.columns == 1 ? variable_part({'f', 1, 1}, false) : "";
    if (!other.empty() && !one_in(4)) return type.name() + "(" + other + ")";
  }
  return literal(type);
}

std::string RandomExpressions::filled(std::string_view pattern, const GlslType& result, int rows, int depth) {
  std::string text;
  for (size_t i = 0; i < pattern.size(); ++i) {
    if (pattern[i] != '$') {
      text += pattern[i];
      continue;
    }
    const char token = pattern[++i];
    if (token == 'T') text += result.name();
    if (token == 'k') text += integer_variable();
    if (token == 'M') text += expression(result, depth);
    if (token >= '2' && token <= '4') text += expression({'f', 1, token - '0'}, depth);
    if (std::string_view("FIUB").find(token) != std::string_view::npos)
      text += expression({char(token - 'A' + 'a'), 1, rows}, depth);
    if (std::string_view("fiub").find(token) != std::string_view::npos) text += expression({token, 1, 1}, depth);
  }
  return text;
}

std::string RandomExpressions::helper_call(const GlslType& type, int depth) {
  std::vector<GlslHelper> fit;
  for (const GlslHelper& helper : helpers)
    if (helper.result == type && helper.directions.find_first_of("ox") == std::string::npos &&
        cost + repeats * helper.cost < most_cost)
      fit.push_back(helper);
  if (fit.empty()) return "";
  const GlslHelper helper = fit[random_.below(uint32_t(fit.size()))];
  cost += repeats * helper.cost;
  std::string text = helper.name + "(";
  for (size_t i = 0; i < helper.parameters.size(); ++i) {
    if (i > 0) text += ", ";
    text += expression(helper.parameters[i], depth - 1);
  }
  return text + ")";
}

/// A product in which a matrix takes part.
std::string RandomExpressions::product(const GlslType& type, int depth) {
  const int inner = 2 + int(random_.below(3));
  GlslType left{'f', inner, type.rows}, right{'f', type.columns, inner};
  if (type.columns == 1 && one_in(2)) left = {'f', 1, inner}, right = {'f', type.rows, inner};  // a row times a matrix
  std::string text = "(" + expression(left, depth) + " * ";
  text += expression(right, depth);
  return text + ")";
}

std::string RandomExpressions::matrix_expression(const GlslType& type, int depth) {
  const GlslType column{'f', 1, type.rows};
  std::string text;
  switch (random_.below(type.columns == type.rows ? 8 : 6)) {
    case 0:
      return product(type, depth);
    case 1:
      text = "outerProduct(" + expression(column, depth) + ", ";
      text += expression({'f', 1, type.columns}, depth);
      return text + ")";
    case 2:
      return "transpose(" + expression({'f', type.rows, type.columns}, depth) + ")";
    case 3:
      text = type.name() + "(";
      for (int c = 0; c < type.columns; ++c) text += (c > 0 ? ", " : "") + expression(column, depth);
      return text + ")";
    case 4: {
      const int columns = 2 + int(random_.below(3)), rows = 2 + int(random_.below(3));
      if (columns == type.columns && rows == type.rows) return expression(type, depth);
      return type.name() + "(" + expression({'f', columns, rows}, depth) + ")";
    }
    case 6:
    case 7:
      cost += repeats * 20 * type.rows;
      return "inverse(" + expression(type, depth) + ")";
    default:
      return filled(pick(random_, kMatrices), type, 1, depth);
  }
}

std::string RandomExpressions::expression(const GlslType& type, int depth) {
  if (depth <= 0 || cost > most_cost || one_in(6)) return leaf(type);
  cost += repeats * type.scalars() * (type.columns > 1 ? 4 : 1);
  if (type.columns > 1) return matrix_expression(type, depth - 1);
  if (!helpers.empty() && one_in(12)) {
    const std::string call = helper_call(type, depth);
    if (!call.empty()) return call;
  }
  const int below = depth - 1, rows = 2 + int(random_.below(3));
  if (type.rows == 1) {
    if (type.base == 'f' && one_in(12)) return "determinant(" + expression({'f', rows, rows}, below) + ")";
    if (type.base == 'f' && one_in(6)) return filled(pick(random_, kFloatsOfVectors), type, rows, below);
    if (type.base == 'u' && one_in(4)) return filled(pick(random_, kPacks), type, 1, below);
    if (type.base == 'b' && one_in(5)) return filled(pick(random_, kBoolsOfVectors), type, rows, below);
    if (type.base == 'b') return filled(pick(random_, kBools), type, rows, below);
    return filled(pick(random_, same_size(type.base)), type, 1, below);
  }
  if (type.base == 'f' && one_in(8)) return product(type, below);
  if (type.base == 'f' && one_in(8)) {
    const Patterns own = type.rows == 2 ? Patterns(kOfTwo) : type.rows == 3 ? Patterns(kOfThree) : Patterns(kOfFour);
    return filled(pick(random_, own), type, type.rows, below);
  }
  if (one_in(4)) return filled(pick(random_, with_scalars(type.base)), type, type.rows, below);
  if (one_in(8)) {
    std::string text = type.name() + "(";
    for (int i = 0; i < type.rows; ++i) text += (i > 0 ? ", " : "") + expression({type.base, 1, 1}, below);
    return text + ")";
  }
  return filled(pick(random_, same_size(type.base)), type, type.rows, below);
}

}  // namespace trueshade::testing
