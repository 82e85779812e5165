#include "programs/edits/line_pieces.h"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <optional>

namespace trueshade::programs {

namespace {

enum class LineTokenKind : uint8_t { name, number, mark };

struct LineToken {
  LineTokenKind kind;
  size_t begin, end;
};

bool is_of_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }
bool is_numeral(char c) { return c >= '0' && c <= '9'; }

/// Where a number ends that begins there: digits, a point, an exponent with its sign, a suffix.
size_t end_of_number(std::string_view line, size_t at) {
  while (at < line.size()) {
    const char c = line[at], before = line[at - (at > 0 ? 1 : 0)];
    const bool is_sign = (c == '-' || c == '+') && (before == 'e' || before == 'E');
    if (!is_of_name(c) && c != '.' && !is_sign) break;
    ++at;
  }
  return at;
}

/// The operator or other mark that begins there, the longest.
size_t length_of_mark(std::string_view rest) {
  constexpr std::string_view kLong[] = {
      "<<=", ">>=", "&&", "||", "^^", "==", "!=", "<=", ">=", "+=", "-=", "*=", "/=", "%=", "++", "--", "<<", ">>"};
  for (const std::string_view mark : kLong)
    if (rest.starts_with(mark)) return mark.size();
  return 1;
}

std::vector<LineToken> line_tokens(std::string_view line) {
  std::vector<LineToken> tokens;
  for (size_t at = 0; at < line.size();) {
    const char c = line[at];
    if (std::isspace(static_cast<unsigned char>(c)) != 0) {
      ++at;
    } else if (line.substr(at).starts_with("//")) {
      break;
    } else if (line.substr(at).starts_with("/*")) {
      const size_t end = line.find("*/", at + 2);
      at = end == std::string_view::npos ? line.size() : end + 2;
    } else {
      const bool is_number = is_numeral(c) || (c == '.' && at + 1 < line.size() && is_numeral(line[at + 1]));
      size_t end = at;
      if (is_number)
        end = end_of_number(line, at);
      else if (is_of_name(c))
        while (end < line.size() && is_of_name(line[end])) ++end;
      else
        end = at + length_of_mark(line.substr(at));
      tokens.push_back({is_number       ? LineTokenKind::number
                        : is_of_name(c) ? LineTokenKind::name
                                        : LineTokenKind::mark,
                        at, end});
      at = end;
    }
  }
  return tokens;
}

/// The precedence of an operator between two operands; 0: it is none.
int binds_of(std::string_view mark) {
  constexpr struct {
    std::string_view mark;
    int binds;
  } kBinds[] = {{"=", kBindsAssignment},
                {"+=", kBindsAssignment},
                {"-=", kBindsAssignment},
                {"*=", kBindsAssignment},
                {"/=", kBindsAssignment},
                {"||", 3},
                {"^^", 4},
                {"&&", 5},
                {"|", 6},
                {"^", 7},
                {"&", 8},
                {"==", 9},
                {"!=", 9},
                {"<", 10},
                {">", 10},
                {"<=", 10},
                {">=", 10},
                {"<<", 11},
                {">>", 11},
                {"+", kBindsSum},
                {"-", kBindsSum},
                {"*", kBindsProduct},
                {"/", kBindsProduct},
                {"%", kBindsProduct}};
  const auto* const found =
      std::find_if(std::begin(kBinds), std::end(kBinds), [&](const auto& b) { return b.mark == mark; });
  return found == std::end(kBinds) ? 0 : found->binds;
}

/// Climbs precedences. Where the line does not go on as GLSL does, the expression that was begun is given up; its whole
/// parts stay.
class LineReader {
 public:
  explicit LineReader(std::string_view line) : line_(line), tokens_(line_tokens(line)) {}

  std::vector<Piece> all() {
    while (at_ < tokens_.size()) {
      const size_t before = at_;
      (void)expression(0, 0);
      if (at_ == before) ++at_;
    }
    return std::move(pieces_);
  }

 private:
  using Found = std::optional<size_t>;

  std::string_view word(size_t token) const {
    return token < tokens_.size() ? line_.substr(tokens_[token].begin, tokens_[token].end - tokens_[token].begin)
                                  : std::string_view();
  }
  bool is_name(size_t token) const { return token < tokens_.size() && tokens_[token].kind == LineTokenKind::name; }
  bool take(std::string_view mark) {
    if (word(at_) != mark) return false;
    ++at_;
    return true;
  }

  size_t add(PieceKind kind, size_t begin, int binds, std::vector<size_t> children, std::string_view word = {}) {
    for (const size_t child : children) pieces_[child].parent = pieces_.size();
    pieces_.push_back({kind, begin, tokens_[at_ - 1].end, word, binds, 0, false, kNoPiece, std::move(children)});
    return pieces_.size() - 1;
  }

  /// An expression of operators that bind at least as tight as `least`.
  Found expression(int least, int depth) {
    Found left = operand(depth);
    while (left && at_ < tokens_.size()) {
      const std::string_view mark = word(at_);
      const size_t begin = pieces_[*left].begin;
      if (mark == "?" && least <= kBindsChoice) {
        ++at_;
        const Found yes = expression(kBindsAssignment, depth + 1);
        if (!yes || !take(":")) return std::nullopt;
        const Found no = expression(kBindsChoice, depth + 1);
        if (!no) return std::nullopt;
        pieces_[*left].needs = kBindsChoice + 1, pieces_[*yes].needs = kBindsAssignment;
        pieces_[*no].needs = kBindsChoice;
        left = add(PieceKind::choice, begin, kBindsChoice, {*left, *yes, *no});
        continue;
      }
      const int binds = binds_of(mark);
      if (binds == 0 || binds < least) break;
      ++at_;
      const bool assigns = binds == kBindsAssignment;
      const Found right = expression(assigns ? kBindsAssignment : binds + 1, depth + 1);
      if (!right) return std::nullopt;
      pieces_[*left].needs = binds, pieces_[*left].is_target = assigns;
      pieces_[*right].needs = assigns ? kBindsAssignment : binds + 1;
      left = add(PieceKind::binary, begin, binds, {*left, *right}, mark);
    }
    return left;
  }

  static constexpr int kMostDepth = 100;  ///< of brackets and signs before an operand

  Found operand(int depth) {
    if (depth > kMostDepth) return std::nullopt;
    // A type or a keyword stands before a name: `const float x`, `return x`.
    while (is_name(at_) && (is_name(at_ + 1) || is_keyword(word(at_)))) ++at_;
    if (at_ >= tokens_.size()) return std::nullopt;
    const size_t begin = tokens_[at_].begin;
    const std::string_view mark = word(at_);
    if (mark == "-" || mark == "+" || mark == "!" || mark == "~") {
      ++at_;
      const Found of = operand(depth + 1);
      if (!of) return std::nullopt;
      pieces_[*of].needs = kBindsUnary;
      return add(PieceKind::unary, begin, kBindsUnary, {*of}, mark);
    }
    Found base;
    if (mark == "(") {
      ++at_;
      const Found inner = expression(0, depth + 1);
      if (!inner || !take(")")) return std::nullopt;
      base = add(PieceKind::group, begin, kBindsTight, {*inner});
    } else if (tokens_[at_].kind == LineTokenKind::mark) {
      return std::nullopt;
    } else if (is_name(at_) && word(at_ + 1) == "(") {
      base = call(begin, depth);
    } else {
      const bool is_number = tokens_[at_++].kind == LineTokenKind::number;
      base = add(is_number ? PieceKind::number : PieceKind::name, begin, kBindsTight, {});
    }
    return base ? members_of(*base, begin, depth) : std::nullopt;
  }
  static bool is_keyword(std::string_view name) {
    return name == "return" || name == "if" || name == "while" || name == "for" || name == "else" || name == "do";
  }

  Found call(size_t begin, int depth) {
    const std::string_view function = word(at_);
    at_ += 2;
    std::vector<size_t> arguments;
    while (!take(")")) {
      const Found argument = expression(kBindsAssignment, depth + 1);
      if (!argument) return std::nullopt;
      pieces_[*argument].needs = kBindsAssignment;
      arguments.push_back(*argument);
      if (!take(",") && word(at_) != ")") return std::nullopt;
    }
    return add(PieceKind::call, begin, kBindsTight, std::move(arguments), function);
  }

  /// Components and elements of what has been read.
  Found members_of(size_t base, size_t begin, int depth) {
    for (;;) {
      if (word(at_) == "." && is_name(at_ + 1)) {
        at_ += 2;
      } else if (take("[")) {
        if (!expression(0, depth + 1) || !take("]")) return std::nullopt;
      } else {
        return base;
      }
      pieces_[base].needs = kBindsTight;
      base = add(PieceKind::member, begin, kBindsTight, {base});
    }
  }

  std::string_view line_;
  std::vector<LineToken> tokens_;
  std::vector<Piece> pieces_;
  size_t at_ = 0;
};

}  // namespace

std::vector<Piece> pieces_of(std::string_view line) {
  const size_t first = line.find_first_not_of(" \t");
  if (first == std::string_view::npos || line[first] == '#') return {};
  return LineReader(line).all();
}

}  // namespace trueshade::programs
