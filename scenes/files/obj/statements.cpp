#include "scenes/files/obj/statements.h"

#include <charconv>
#include <cmath>

#include "core/printable_text.h"

namespace trueshade::obj {
namespace {

constexpr double kMostReach = 1e18;

bool is_blank(char c) { return c == ' ' || c == '\t'; }

struct Parsed {
  float value = 0.0f;
  const char* end = nullptr;  ///< none: no number
};

/// A number that float cannot hold: one below its smallest is rounded, one above its largest is none.
Parsed number_beyond_float(const char* first, const char* last) {
  double wide = 0.0;
  const auto [end, code] = std::from_chars(first, last, wide);
  if (code == std::errc()) return {float(wide), std::fabs(wide) < 1.0 ? end : nullptr};
  const std::string_view text(first, size_t(end - first));
  const size_t exponent = text.find_first_of("eE");
  const bool tiny = exponent != std::string_view::npos && exponent + 1 < text.size() && text[exponent + 1] == '-';
  return {0.0f, tiny ? end : nullptr};
}

Parsed number_at(const char* first, const char* last) {
  if (first != last && *first == '+') {
    ++first;
    if (first != last && *first == '-') return {};
  }
  Parsed out;
  const auto [end, code] = std::from_chars(first, last, out.value);
  if (code == std::errc::result_out_of_range) return number_beyond_float(first, last);
  out.end = code == std::errc() && std::fabs(double(out.value)) <= kMostReach ? end : nullptr;  // false for NaN
  return out;
}

}  // namespace

std::string shown_word(std::string_view word) { return printable(word.substr(0, 40), Lines::one); }

Statements::Statements(std::span<const uint8_t> file, std::string_view where)
    : next_(reinterpret_cast<const char*>(file.data())), end_(next_ + file.size()), where_(where) {
  if (std::string_view(next_, file.size()).starts_with("\xef\xbb\xbf")) next_ += 3;  // a byte order mark
}

void Statements::fail(const std::string& reason, const std::string& remedy, ErrorKind kind) const {
  fail_at(line_, reason, remedy, kind);
}

void Statements::fail_at(uint32_t line, const std::string& reason, const std::string& remedy, ErrorKind kind) const {
  throw Error(kind, std::string(where_) + ": line " + std::to_string(line), reason, remedy);
}

bool Statements::joins_next_line() const {
  return *next_ == '\\' && end_ - next_ >= 2 && (next_[1] == '\n' || next_[1] == '\r');
}

void Statements::skip_line_end() {
  const bool carriage = *next_ == '\r';
  ++next_;
  if (carriage && next_ != end_ && *next_ == '\n') ++next_;
}

void Statements::skip_blanks() {
  for (; next_ != end_; ++next_) {
    if (is_blank(*next_)) continue;
    if (!joins_next_line()) return;
    ++next_;
    skip_line_end();
    ++line_;
    --next_;
  }
}

bool Statements::next() {
  for (;;) {
    if (!line_ended_) {
      while (!at_line_end()) ++next_;
      if (next_ == end_) return false;
      skip_line_end();
    }
    if (next_ == end_) return false;
    line_ended_ = false;
    ++line_;
    if (at_end()) continue;
    keyword_ = word();
    return true;
  }
}

bool Statements::at_end() {
  skip_blanks();
  return at_line_end() || *next_ == '#';
}

std::string_view Statements::word() {
  if (at_end()) return {};
  const char* first = next_;
  while (!at_line_end() && !is_blank(*next_) && !joins_next_line()) ++next_;
  return {first, size_t(next_ - first)};
}

float Statements::number(const char* what) {
  if (at_end()) fail(std::string(what) + " is missing", "a number");
  const Parsed parsed = number_at(next_, end_);
  const char* end = parsed.end;
  if (!end || !(end == end_ || is_blank(*end) || *end == '\n' || *end == '\r' || *end == '\\'))
    fail(std::string(what) + " is '" + shown_word(word()) + "'", "a number from -1e18 to 1e18");
  next_ = end;
  return parsed.value;
}

std::optional<float> Statements::number_if_any() {
  if (at_end()) return std::nullopt;
  const char* first = next_;
  const uint32_t line = line_;
  const std::string_view text = word();
  const Parsed parsed = number_at(text.data(), text.data() + text.size());
  if (parsed.end == text.data() + text.size()) return parsed.value;
  next_ = first;
  line_ = line;
  return std::nullopt;
}

std::string Statements::rest() {
  std::string text;
  skip_blanks();
  while (!at_line_end()) {
    if (joins_next_line()) {
      skip_blanks();
      text += ' ';
    } else {
      text += *next_++;
    }
  }
  while (!text.empty() && is_blank(text.back())) text.pop_back();
  return text;
}

void Statements::finish() {
  if (!at_end())
    fail("'" + shown_word(word()) + "' is one word too many for '" + shown_word(keyword_) + "'",
         "what the statement takes");
}

}  // namespace trueshade::obj
