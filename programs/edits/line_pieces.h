#pragma once
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace trueshade::programs {

enum class PieceKind : uint8_t { name, number, member, call, group, unary, binary, choice };

/// An expression in a line of GLSL. Precedences are GLSL's (4.60, section 5.1) turned round: the larger binds tighter.
struct Piece {
  PieceKind kind = PieceKind::name;
  size_t begin = 0, end = 0;          ///< characters of the line
  std::string_view word;              ///< of a call its function, of unary and binary pieces the operator
  int binds = 0;                      ///< the precedence of its operator
  int needs = 0;                      ///< the least precedence that may stand in its place without parentheses
  bool is_target = false;             ///< is assigned
  size_t parent = size_t(-1);         ///< the piece that it is a part of
  std::vector<size_t> children = {};  ///< in their order
};

inline constexpr size_t kNoPiece = size_t(-1);
inline constexpr int kBindsAssignment = 1, kBindsChoice = 2, kBindsSum = 12, kBindsProduct = 13, kBindsUnary = 14,
                     kBindsTight = 15;

/// The expressions of a line, each behind its parts, as far as they begin and end in it. Types and keywords before an
/// expression are passed over, and so are comments. Of a line for the preprocessor there are none. Borrows the line.
std::vector<Piece> pieces_of(std::string_view line);

}  // namespace trueshade::programs
