#include "programs/edits/line_variants.h"

#include <algorithm>

#include "programs/edits/line_pieces.h"

namespace trueshade::programs {

namespace {

/// Writes a line otherwise at one piece after the other.
class LineWriter {
 public:
  LineWriter(std::string_view line, const ProgramEdit& edit, const std::string& number,
             std::span<const std::string> factors)
      : line_(line), edit_(edit), number_(number), factors_(factors), pieces_(pieces_of(line)) {}

  std::vector<std::string> all() {
    for (const Piece& piece : pieces_)
      if (!piece.is_target) write(piece);
    return std::move(out_);
  }

 private:
  const Piece& child(const Piece& piece, size_t i) const { return pieces_[piece.children[i]]; }
  std::string text_of(const Piece& piece) const {
    return std::string(line_.substr(piece.begin, piece.end - piece.begin));
  }
  /// A piece's text where nothing may stand that binds less than `needs`.
  std::string in_place(const Piece& piece, int needs) const {
    return piece.binds < needs ? '(' + text_of(piece) + ')' : text_of(piece);
  }

  /// Adds the line with another text in the piece's place, whose operators bind so. Parentheses about the piece that
  /// are not needed any more go.
  void replace(const Piece& piece, const std::string& text, int binds) {
    const Piece* place = &piece;
    while (place->parent != kNoPiece && pieces_[place->parent].kind == PieceKind::group &&
           pieces_[place->parent].needs <= binds)
      place = &pieces_[place->parent];
    const std::string now = place->needs <= binds ? text : '(' + text + ')';
    std::string line = std::string(line_.substr(0, place->begin)) + now + std::string(line_.substr(place->end));
    if (std::find(out_.begin(), out_.end(), line) == out_.end()) out_.push_back(std::move(line));
  }
  void replace(const Piece& piece, const Piece& by) { replace(piece, text_of(by), by.binds); }

  bool is_call(const Piece& piece, std::initializer_list<std::string_view> functions) const {
    return piece.kind == PieceKind::call && !piece.children.empty() &&
           std::find(functions.begin(), functions.end(), piece.word) != functions.end();
  }

  void write(const Piece& piece) {
    switch (edit_.change) {
      case ProgramChange::other_operation:
        return write_operation(piece);
      case ProgramChange::operand_alone:
      case ProgramChange::mixed_alone:
        return write_alone(piece);
      case ProgramChange::swapped:
        if (piece.kind == PieceKind::binary && piece.binds > kBindsAssignment)
          replace(piece,
                  in_place(child(piece, 1), piece.binds) + ' ' + std::string(piece.word) + ' ' +
                      in_place(child(piece, 0), piece.binds + 1),
                  piece.binds);
        return;
      case ProgramChange::number:
        if (is_call(piece, {"normalize"})) write_unnormalized(piece);
        return;
      case ProgramChange::constant_operand:
        if (piece.kind == PieceKind::number || piece.kind == PieceKind::name)
          replace(piece, number_, number_[0] == '-' ? kBindsUnary : kBindsTight);
        return;
      case ProgramChange::scaled:
        return replace(piece, number_ + " * " + in_place(piece, kBindsProduct + 1), kBindsProduct);
      case ProgramChange::other_operand:
        for (const std::string& other : factors_) replace(piece, other, kBindsTight);
        return;
      case ProgramChange::times_other:
      case ProgramChange::over_other:
        for (const std::string& other : factors_)
          replace(piece,
                  in_place(piece, kBindsProduct) + (edit_.change == ProgramChange::times_other ? " * " : " / ") + other,
                  kBindsProduct);
        return;
      case ProgramChange::factor_of_one_term:
        return write_factor_of_term(piece);
      case ProgramChange::square:
      case ProgramChange::square_of_operand:
        return replace(piece, in_place(piece, kBindsProduct) + " * " + in_place(piece, kBindsProduct + 1),
                       kBindsProduct);
      case ProgramChange::root:
      case ProgramChange::root_of_operand:
        return replace(piece, "sqrt(" + text_of(piece) + ')', kBindsTight);
      case ProgramChange::srgb_encoded:
      case ProgramChange::srgb_decoded:
        if (piece.kind == PieceKind::member && edit_.number != 0)
          replace(piece, "pow(" + text_of(piece) + (edit_.number < 1 ? ", vec3(1.0 / 2.2))" : ", vec3(2.2))"),
                  kBindsTight);
        return;
    }
  }

  void write_operation(const Piece& piece) {
    constexpr std::string_view kExchanged[][2] = {{"+", "-"}, {"-", "+"}, {"*", "/"}, {"/", "*"}};
    if (piece.kind == PieceKind::binary)
      for (const auto& [from, to] : kExchanged) {
        const bool assigns = piece.word.size() == 2 && piece.word.starts_with(from) && piece.word[1] == '=';
        if (piece.word != from && !assigns) continue;
        const int needs = piece.binds + (assigns ? 0 : 1);
        replace(piece,
                in_place(child(piece, 0), piece.binds) + ' ' + std::string(to) + (assigns ? "= " : " ") +
                    in_place(child(piece, 1), needs),
                piece.binds);
      }
    if (is_call(piece, {"max", "min"}) && piece.children.size() == 2) {
      const std::string a = text_of(child(piece, 0)), b = text_of(child(piece, 1));
      replace(piece, (piece.word == "max" ? "min(" : "max(") + a + ", " + b + ')', kBindsTight);
      replace(piece, "abs(" + a + ')', kBindsTight), replace(piece, "abs(" + b + ')', kBindsTight);
    }
    if (is_call(piece, {"clamp"}) && piece.children.size() == 3) {
      const std::string x = text_of(child(piece, 0)), low = text_of(child(piece, 1)), high = text_of(child(piece, 2));
      replace(piece, "min(abs(" + x + "), " + high + ')', kBindsTight);
      replace(piece, "min(min(" + x + ", " + low + "), " + high + ')', kBindsTight);
      replace(piece, "max(max(" + x + ", " + low + "), " + high + ')', kBindsTight);
    }
  }

  /// One part of the piece without the rest.
  void write_alone(const Piece& piece) {
    if (piece.kind == PieceKind::call) {
      if (is_call(piece, {"clamp"}) && piece.children.size() == 3) {
        const std::string x = text_of(child(piece, 0));
        replace(piece, "max(" + x + ", " + text_of(child(piece, 1)) + ')', kBindsTight);
        replace(piece, "min(" + x + ", " + text_of(child(piece, 2)) + ')', kBindsTight);
      }
      if (is_call(piece, {"length"}))
        replace(piece, "dot(" + text_of(child(piece, 0)) + ", " + text_of(child(piece, 0)) + ')', kBindsTight);
      if (is_call(piece, {"distance"}) && piece.children.size() == 2) {
        const std::string way = in_place(child(piece, 0), kBindsSum) + " - " + in_place(child(piece, 1), kBindsSum + 1);
        replace(piece, "dot(" + way + ", " + way + ')', kBindsTight);
      }
      if (is_call(piece, {"mix"}) && piece.children.size() == 3) {
        const Piece &x = child(piece, 0), &y = child(piece, 1), &a = child(piece, 2);
        replace(piece, in_place(x, kBindsProduct) + " * (1.0 - " + in_place(a, kBindsSum + 1) + ')', kBindsProduct);
        replace(piece, in_place(y, kBindsProduct) + " * " + in_place(a, kBindsProduct + 1), kBindsProduct);
      }
    }
    if (piece.kind == PieceKind::binary && piece.binds == kBindsAssignment) return;
    if (piece.kind == PieceKind::group || piece.kind == PieceKind::member) return;
    for (size_t i = 0; i < piece.children.size(); ++i) replace(piece, child(piece, i));
  }

  void write_unnormalized(const Piece& piece) {
    if (edit_.number == 1) return replace(piece, child(piece, 0));
    replace(piece, "0.5 * " + in_place(child(piece, 0), kBindsProduct + 1), kBindsProduct);
  }

  /// Of a product that has a sum in parentheses: one factor taken from the product, and put to one term of the sum.
  void write_factor_of_term(const Piece& product) {
    if (product.kind != PieceKind::binary || product.word != "*" || edit_.gates) return;
    for (size_t side = 0; side < 2; ++side) {
      const std::string factor = in_place(child(product, side), kBindsProduct + 1);
      const Piece& rest = child(product, 1 - side);
      for (const Piece& sum : pieces_) {
        const bool is_inside = sum.begin >= rest.begin && sum.end <= rest.end;
        if (!is_inside || sum.kind != PieceKind::binary || sum.word != "+") continue;
        const std::string before(line_.substr(rest.begin, sum.begin - rest.begin)),
            after(line_.substr(sum.end, rest.end - sum.end));
        const Piece &a = child(sum, 0), &b = child(sum, 1);
        replace(product, before + in_place(a, kBindsProduct) + " * " + factor + " + " + text_of(b) + after, rest.binds);
        replace(product, before + text_of(a) + " + " + in_place(b, kBindsProduct) + " * " + factor + after, rest.binds);
      }
    }
  }

  const std::string_view line_;
  const ProgramEdit& edit_;
  const std::string& number_;
  const std::span<const std::string> factors_;
  const std::vector<Piece> pieces_;
  std::vector<std::string> out_;
};

}  // namespace

std::vector<std::string> line_variants(std::string_view line, const ProgramEdit& edit, const std::string& number,
                                       std::span<const std::string> factors) {
  return LineWriter(line, edit, number, factors).all();
}

std::vector<std::string> assigned_names(std::string_view line) {
  std::vector<std::string> names;
  for (const Piece& piece : pieces_of(line))
    if (piece.is_target) names.emplace_back(line.substr(piece.begin, piece.end - piece.begin));
  return names;
}

}  // namespace trueshade::programs
