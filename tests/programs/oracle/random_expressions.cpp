#include "tests/programs/oracle/random_expressions.h"

#include <algorithm>
#include <iterator>
#include <span>

namespace trueshade::testing {

namespace {

using Patterns = std::span<const char* const>;

// Of floats of any number of components; what is common stands more than once.
constexpr const char* kFloats[] = {"($F + $F)",
                                   "($F + $F)",
                                   "($F - $F)",
                                   "($F - $F)",
                                   "($F * $F)",
                                   "($F * $F)",
                                   "($F * $F)",
                                   "($F / $F)",
                                   "(-$F)",
                                   "sin($F)",
                                   "cos($F)",
                                   "tan($F)",
                                   "asin($F)",
                                   "acos($F)",
                                   "asin(sin($F))",
                                   "acos(cos($F))",
                                   "atan($F)",
                                   "sinh($F)",
                                   "cosh($F)",
                                   "tanh($F)",
                                   "asinh($F)",
                                   "acosh($F)",
                                   "acosh(1.0 + abs($F))",
                                   "atanh($F)",
                                   "atanh(fract($F))",
                                   "exp($F)",
                                   "log($F)",
                                   "log(abs($F))",
                                   "exp2($F)",
                                   "log2($F)",
                                   "log2(abs($F))",
                                   "pow($F, $F)",
                                   "pow(abs($F), $F)",
                                   "pow($F, $T(5.0))",
                                   "pow($F, floor($F))",
                                   "pow(max($F, $T(0.0)), $F)",
                                   "sqrt($F)",
                                   "sqrt(abs($F))",
                                   "inversesqrt($F)",
                                   "abs($F)",
                                   "sign($F)",
                                   "floor($F)",
                                   "trunc($F)",
                                   "round($F)",
                                   "roundEven($F)",
                                   "ceil($F)",
                                   "fract($F)",
                                   "fract($F)",
                                   "mod($F, $F)",
                                   "min($F, $F)",
                                   "max($F, $F)",
                                   "clamp($F, $F, $F)",
                                   "clamp($F, $T(0.0), $T(1.0))",
                                   "clamp($F, $T(-4.0), $T(4.0))",
                                   "mix($F, $F, $F)",
                                   "mix($F, $F, $B)",
                                   "step($F, $F)",
                                   "smoothstep($F, $F, $F)",
                                   "fma($F, $F, $F)",
                                   "intBitsToFloat($I)",
                                   "uintBitsToFloat($U)",
                                   "ldexp($F, $I)",
                                   "radians($F)",
                                   "degrees($F)",
                                   "normalize($F)",
                                   "faceforward($F, $F, $F)",
                                   "reflect($F, $F)",
                                   "refract($F, $F, $f)",
                                   "atan($F, $F)",
                                   "atan($F, $F)",
                                   "$T($I)",
                                   "$T($U)",
                                   "$T($B)",
                                   "($b ? $F : $F)",
                                   "($b ? $F : $F)",
                                   "(+$F)"};
// Of two components or more.
constexpr const char* kFloatVectors[] = {"($F * $f)",
                                         "($F * $f)",
                                         "($f * $F)",
                                         "($F / $f)",
                                         "($F + $f)",
                                         "($f - $F)",
                                         "mod($F, $f)",
                                         "min($F, $f)",
                                         "max($F, $f)",
                                         "clamp($F, $f, $f)",
                                         "mix($F, $F, $f)",
                                         "step($f, $F)",
                                         "smoothstep($f, $f, $F)",
                                         "$T($f)"};
// Scalars made of vectors of `rows` components.
constexpr const char* kFloatsOfVectors[] = {"dot($F, $F)", "dot($F, $F)", "length($F)", "distance($F, $F)",
                                            "(abs(dot($F, $F)) + 1.0)"};
constexpr const char* kOfTwo[] = {"unpackSnorm2x16($u)", "unpackUnorm2x16($u)", "unpackHalf2x16($u)"};
constexpr const char* kOfThree[] = {"cross($F, $F)"};
constexpr const char* kOfFour[] = {"unpackSnorm4x8($u)", "unpackUnorm4x8($u)", "$T($2, $2)", "$T($3, $f)"};
// What divides starts with a variable, so that glslang does not divide the least integer by -1 itself.
constexpr const char* kInts[] = {"($I + $I)",
                                 "($I - $I)",
                                 "($I * $I)",
                                 "(($I ^ $T($k)) / $I)",
                                 "(($I ^ $T($k)) % $I)",
                                 "($I & $I)",
                                 "($I | $I)",
                                 "($I ^ $I)",
                                 "(~$I)",
                                 "(-$I)",
                                 "abs($I)",
                                 "sign($I)",
                                 "min($I, $I)",
                                 "max($I, $I)",
                                 "clamp($I, $I, $I)",
                                 "mix($I, $I, $B)",
                                 "(($I ^ $T($k)) << $I)",
                                 "(($I ^ $T($k)) >> $I)",
                                 "(($I ^ $T($k)) << $U)",
                                 "bitfieldExtract($I, $i, $i)",
                                 "bitfieldInsert($I, $I, $i, $i)",
                                 "bitfieldReverse($I)",
                                 "bitCount($I)",
                                 "bitCount($U)",
                                 "findLSB($I)",
                                 "findLSB($U)",
                                 "findMSB($I)",
                                 "findMSB($U)",
                                 "floatBitsToInt($F)",
                                 "$T($F)",
                                 "$T($F)",
                                 "$T($U)",
                                 "$T($B)",
                                 "($b ? $I : $I)"};
constexpr const char* kIntVectors[] = {"($I + $i)", "($i * $I)", "min($I, $i)", "clamp($I, $i, $i)", "$T($i)"};
constexpr const char* kUints[] = {"($U + $U)",
                                  "($U - $U)",
                                  "($U * $U)",
                                  "(($U ^ $T($k)) / $U)",
                                  "(($U ^ $T($k)) % $U)",
                                  "($U & $U)",
                                  "($U | $U)",
                                  "($U ^ $U)",
                                  "(~$U)",
                                  "(-$U)",
                                  "min($U, $U)",
                                  "max($U, $U)",
                                  "clamp($U, $U, $U)",
                                  "mix($U, $U, $B)",
                                  "(($U ^ $T($k)) << $U)",
                                  "(($U ^ $T($k)) >> $U)",
                                  "(($U ^ $T($k)) >> $I)",
                                  "bitfieldExtract($U, $i, $i)",
                                  "bitfieldInsert($U, $U, $i, $i)",
                                  "bitfieldReverse($U)",
                                  "floatBitsToUint($F)",
                                  "$T($F)",
                                  "$T($I)",
                                  "$T($B)",
                                  "($b ? $U : $U)"};
constexpr const char* kUintVectors[] = {"($U + $u)", "($u * $U)", "max($U, $u)", "$T($u)"};
constexpr const char* kPacks[] = {"packSnorm2x16($2)", "packUnorm2x16($2)", "packHalf2x16($2)", "packSnorm4x8($4)",
                                  "packUnorm4x8($4)"};
constexpr const char* kBools[] = {"($f < $f)",  "($f > $f)",  "($f <= $f)", "($f >= $f)", "($F == $F)",    "($F != $F)",
                                  "($i < $i)",  "($i > $i)",  "($i <= $i)", "($i >= $i)", "($I == $I)",    "($I != $I)",
                                  "($u < $u)",  "($u >= $u)", "($u > $u)",  "($u <= $u)", "($U == $U)",    "($U != $U)",
                                  "($b && $b)", "($b || $b)", "($b ^^ $b)", "(!$b)",      "isnan($f)",     "isinf($f)",
                                  "bool($f)",   "bool($i)",   "bool($u)",   "($b == $b)", "($b ? $b : $b)"};
constexpr const char* kBoolsOfVectors[] = {"any($B)", "all($B)", "($B == $B)", "any(lessThan($F, $F))"};
constexpr const char* kBoolVectors[] = {"lessThan($F, $F)",
                                        "lessThanEqual($F, $F)",
                                        "greaterThan($F, $F)",
                                        "greaterThanEqual($F, $F)",
                                        "equal($F, $F)",
                                        "notEqual($F, $F)",
                                        "lessThan($I, $I)",
                                        "lessThanEqual($U, $U)",
                                        "greaterThan($I, $I)",
                                        "greaterThanEqual($U, $U)",
                                        "equal($I, $I)",
                                        "notEqual($U, $U)",
                                        "equal($B, $B)",
                                        "notEqual($B, $B)",
                                        "not($B)",
                                        "isnan($F)",
                                        "isinf($F)",
                                        "$T($F)",
                                        "$T($I)",
                                        "$T($U)",
                                        "$T($b)"};
constexpr const char* kMatrices[] = {"($M + $M)", "($M - $M)", "matrixCompMult($M, $M)",
                                     "($M / $M)", "($M * $f)", "($f * $M)",
                                     "($M / $f)", "($M + $f)", "($f - $M)",
                                     "(-$M)",     "$T($f)",    "($b ? $M : $M)"};

constexpr const char* kNumbers[] = {"0.0", "1.0",        "2.0",   "0.5",        "(-1.0)", "3.0",
                                    "0.1", "3.14159274", "0.001", "(-2.5)",     "100.0",  "0.75",
                                    "1.5", "(-0.3)",     "10.0",  "0.33333334", "7.0",    "(-0.0)"};
constexpr const char* kOddNumbers[] = {"(0.0 / 0.0)", "(1.0 / 0.0)", "(-1.0 / 0.0)", "1e-40",        "(-1e-42)",
                                       "1.4e-45",     "3.4e38",      "(-3.0e38)",    "1e-20",        "16777216.0",
                                       "8388609.0",   "1e6",         "4294967296.0", "2147483648.0", "1.17549435e-38",
                                       "0.99999994",  "1.0000001",   "(-0.0)"};
constexpr const char* kIntegers[] = {"0", "1", "2", "3", "4", "5", "7", "(-1)", "8", "(-3)", "16", "31", "255", "100"};
constexpr const char* kOddIntegers[] = {"32", "33", "65535", "2147483647", "(-2147483647)", "1000000007", "(-32)"};
constexpr const char* kUnsigned[] = {"0u", "1u", "2u", "3u", "5u", "8u", "16u", "31u", "255u"};
constexpr const char* kOddUnsigned[] = {"32u", "4294967295u", "2147483648u", "2147483647u", "0xFFFFu", "0x7FC00001u"};

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
