#include "programs/front/macro_growth.h"

#include <algorithm>
#include <map>
#include <string>
#include <vector>

namespace trueshade::programs {
namespace {

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Tokens of a text: names, numbers, and single characters. Comments are blanks, and a line goes on behind a backslash.
class Tokens {
 public:
  explicit Tokens(std::string_view text) : rest_(text) {}

  /// The next token of this line; empty at its end.
  std::string_view in_line() {
    for (;;) {
      if (rest_.starts_with("\\\n")) {
        rest_.remove_prefix(2);
      } else if (rest_.starts_with("\\\r\n")) {
        rest_.remove_prefix(3);
      } else if (rest_.starts_with("//")) {
        while (!rest_.empty() && rest_[0] != '\n') rest_.remove_prefix(rest_[0] == '\\' && rest_.size() > 1 ? 2 : 1);
      } else if (rest_.starts_with("/*")) {
        rest_.remove_prefix(std::min(rest_.find("*/", 2), rest_.size() - 2) + 2);
      } else if (!rest_.empty() && (rest_[0] == ' ' || rest_[0] == '\t' || rest_[0] == '\r')) {
        rest_.remove_prefix(1);
      } else {
        break;
      }
    }
    if (rest_.empty() || rest_[0] == '\n') return {};
    size_t size = 1;
    if (is_letter(rest_[0]) || is_digit(rest_[0]))
      while (size < rest_.size() && (is_letter(rest_[size]) || is_digit(rest_[size]))) ++size;
    const std::string_view token = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return token;
  }
  /// Whether there is another line, whose tokens come then.
  bool next_line() {
    if (rest_.empty()) return false;
    rest_.remove_prefix(1);
    return true;
  }
  /// Of a macro's name: whether parameters follow at once.
  bool stands_before_parenthesis() const { return rest_.starts_with('('); }

 private:
  std::string_view rest_;
};

/// A number of tokens that is `fixed`, and `each` more for a token of the arguments.
struct Growth {
  uint64_t fixed = 0, each = 0;
};
uint64_t sum(uint64_t a, uint64_t b) { return std::min(a + b, kEndlessGrowth); }
uint64_t product(uint64_t a, uint64_t b) {
  return a != 0 && b > kEndlessGrowth / a ? kEndlessGrowth : std::min(a * b, kEndlessGrowth);
}
Growth operator+(const Growth& a, const Growth& b) { return {sum(a.fixed, b.fixed), sum(a.each, b.each)}; }
Growth larger(const Growth& a, const Growth& b) { return {std::max(a.fixed, b.fixed), std::max(a.each, b.each)}; }
constexpr Growth kEndless{kEndlessGrowth, kEndlessGrowth};

using TokenList = std::vector<std::string_view>;

struct Macro {
  bool has_parameters = false;
  TokenList parameters, body;
};

/// Whatever a name may stand for: a text may define it more than once.
struct Macros {
  std::vector<Macro> ways;
  enum class State : uint8_t { not_known, in_work, known } state = State::not_known;
  Growth growth;
};

class GrowthFinder {
 public:
  explicit GrowthFinder(std::string_view text) {
    Tokens tokens(text);
    TokenList expanded;
    do {
      TokenList line;
      for (std::string_view token; !(token = tokens.in_line()).empty();) {
        line.push_back(token);
        if (line.size() == 3 && line[0] == "#" && line[1] == "define" && is_letter(token[0]))
          takes_parameters_ = tokens.stands_before_parenthesis();
      }
      if (!line.empty() && line[0] == "#")
        directive(line, expanded);
      else
        expanded.insert(expanded.end(), line.begin(), line.end());
    } while (tokens.next_line());
    text_ = std::move(expanded);
  }

  uint64_t run() {
    find_unapplied();
    size_t at = 0;
    Growth all;
    while (at < text_.size()) all = all + of_list(text_, at, {}, false);
    return all.fixed;
  }

 private:
  void directive(const TokenList& line, TokenList& expanded) {
    if (line.size() < 2) return;
    if (line[1] == "if" || line[1] == "elif") expanded.insert(expanded.end(), line.begin() + 2, line.end());
    if (line[1] != "define" || line.size() < 3) return;
    Macro macro;
    size_t at = 3;
    macro.has_parameters = takes_parameters_ && line.size() > 3;
    if (macro.has_parameters) {
      while (at < line.size() && line[at] != ")") {
        if (is_letter(line[at][0])) macro.parameters.push_back(line[at]);
        ++at;
      }
      at = std::min(at + 1, line.size());
    }
    macro.body.assign(line.begin() + ptrdiff_t(at), line.end());
    macros_[line[2]].ways.push_back(std::move(macro));
  }

  bool takes_arguments(const Macros& macros) const {
    return std::any_of(macros.ways.begin(), macros.ways.end(), [](const Macro& m) { return m.has_parameters; });
  }

  /// Macros with parameters that stand without arguments somewhere: what they are handed to may apply them.
  void find_unapplied() {
    const auto look = [&](const TokenList& list) {
      for (size_t i = 0; i < list.size(); ++i) {
        const auto macro = macros_.find(list[i]);
        if (macro != macros_.end() && takes_arguments(macro->second) && (i + 1 == list.size() || list[i + 1] != "("))
          unapplied_.push_back(list[i]);
      }
    };
    look(text_);
    for (const auto& [name, macros] : macros_)
      for (const Macro& way : macros.ways) look(way.body);
    std::sort(unapplied_.begin(), unapplied_.end());
    unapplied_.erase(std::unique(unapplied_.begin(), unapplied_.end()), unapplied_.end());
  }

  /// Of what a parenthesis follows that is no macro with parameters, but may become one.
  Growth of_unapplied() {
    Growth out;
    for (const std::string_view name : unapplied_) out = larger(out, of_macro(name, macros_.at(name)));
    return out;
  }

  const Growth& of_macro(std::string_view name, Macros& macros) {
    if (macros.state == Macros::State::known) return macros.growth;
    if (macros.state == Macros::State::in_work) return kEndless;
    macros.state = Macros::State::in_work;
    Growth out;
    for (const Macro& way : macros.ways) {
      TokenList others = way.body;  // a macro's own name within it stays as it is
      std::replace(others.begin(), others.end(), name, std::string_view("0"));
      Growth one{1, 0};
      for (size_t at = 0; at < others.size();) one = one + of_list(others, at, way.parameters, false);
      out = larger(out, one);
    }
    macros.state = Macros::State::known;
    return macros.growth = out;
  }

  /// The tokens from `at` on; of arguments to the parenthesis that closes them.
  Growth of_list(const TokenList& list, size_t& at, const TokenList& parameters, bool are_arguments) {
    Growth out;
    for (int open = 0; at < list.size();) {
      const std::string_view token = list[at++];
      if (token == ")" && are_arguments && open == 0) return out;
      open += token == "(" ? 1 : token == ")" ? -1 : 0;
      const bool is_applied = at < list.size() && list[at] == "(";
      const bool is_parameter = std::find(parameters.begin(), parameters.end(), token) != parameters.end();
      const auto macro = macros_.find(token);
      if (is_parameter || macro == macros_.end()) {
        out = out + (is_parameter ? Growth{0, 1} : Growth{1, 0});
        if (is_parameter && is_applied && !unapplied_.empty())
          out = out + applied(of_unapplied(), list, at, parameters);
        continue;
      }
      const bool takes = takes_arguments(macro->second);
      if (takes && !is_applied) {
        out.fixed = sum(out.fixed, 1);
        continue;
      }
      const Growth& growth = of_macro(token, macro->second);
      if (takes) {
        out = out + applied(growth, list, at, parameters);
        continue;
      }
      out = out + growth;
      if (is_applied && !unapplied_.empty()) out = out + applied(of_unapplied(), list, at, parameters);
    }
    return out;
  }

  /// A macro with the arguments whose parenthesis opens at `at`, which are expanded once before.
  Growth applied(const Growth& macro, const TokenList& list, size_t& at, const TokenList& parameters) {
    const Growth given = of_list(list, ++at, parameters, true);
    const uint64_t times = sum(macro.each, 1);
    return {sum(macro.fixed, product(given.fixed, times)), product(given.each, times)};
  }

  std::map<std::string_view, Macros> macros_;
  TokenList text_, unapplied_;
  bool takes_parameters_ = false;
};

}  // namespace

uint64_t tokens_with_macros(std::string_view text) { return GrowthFinder(text).run(); }

}  // namespace trueshade::programs
