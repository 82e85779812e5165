#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/builtin/pcg32.h"

namespace trueshade::testing {

/// A scalar (one column, one row), vector (one column) or matrix of GLSL.
struct GlslType {
  char base = 'f';  ///< f, i, u or b
  int columns = 1, rows = 1;
  bool operator==(const GlslType&) const = default;
  int scalars() const { return columns * rows; }
  std::string name() const;
};
inline constexpr GlslType kFloat{'f', 1, 1}, kInt{'i', 1, 1}, kBool{'b', 1, 1};

/// What an expression may read, and a statement write where it is `writable`.
struct GlslVariable {
  std::string path;  ///< "s.position", "v3", "r1.a"
  GlslType type;
  int elements = 0;  ///< of an array; 0: none
  bool writable = false, constant = false;
};

/// A function of the file that has been defined: its parameters' directions are i (in), o (out) and x (inout).
struct GlslHelper {
  std::string name;
  GlslType result;
  std::vector<GlslType> parameters;
  std::string directions;
  int cost = 0;
};

/// Makes expressions of any type from what is in scope. Every draw is made in the order of the text, so a seed makes
/// the same text wherever it is compiled.
class RandomExpressions {
 public:
  explicit RandomExpressions(uint64_t seed) : random_(seed) {}

  Pcg32& random() { return random_; }
  bool one_in(uint32_t count) { return random_.below(count) == 0; }

  GlslType any_type();
  /// An expression of that type, up to `depth` operations deep; shallow where the program's cost is used up.
  std::string expression(const GlslType& type, int depth);
  std::string literal(const GlslType& type);
  /// A pattern with expressions filled in: $F $I $U $B of `rows` components, $f $i $u $b scalars, $2 $3 $4 vectors of
  /// floats, $T the name of the result's type, $k an integer variable.
  std::string filled(std::string_view pattern, const GlslType& result, int rows, int depth);
  /// Something of exactly that type that may be written; empty where the scope has none.
  std::string writable_part(const GlslType& type);
  /// An index below `count`, a number or an expression; the latter at times beyond.
  std::string index(int count);

  std::vector<GlslVariable> scope;
  std::vector<GlslHelper> helpers;
  double repeats = 1;  ///< how often what is written now runs: the product of the trips of the loops around it
  double cost = 0;     ///< about how many scalar operations the program has with its loops unrolled
  double most_cost = 8000;

 private:
  std::string leaf(const GlslType& type);
  std::string part(const GlslVariable& variable, const GlslType& type, bool write);
  std::string variable_part(const GlslType& type, bool write);
  std::string matrix_expression(const GlslType& type, int depth);
  std::string product(const GlslType& type, int depth);
  std::string helper_call(const GlslType& type, int depth);
  std::string swizzle(int from, int count, bool distinct);
  std::string integer_variable();
  std::string number(char base);

  Pcg32 random_;
};

}  // namespace trueshade::testing
