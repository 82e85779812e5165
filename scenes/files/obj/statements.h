#pragma once
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/error.h"

namespace trueshade::obj {

/// The statements of an OBJ or MTL file, one after another: a keyword and words on one line. A backslash at a line's
/// end joins the next line; a word that starts with '#' begins a comment; lines end in LF, CR LF or CR. Borrows the
/// file's bytes.
class Statements {
 public:
  Statements(std::span<const uint8_t> file, std::string_view where);

  /// Goes to the next statement; false at the end of the file. Words of the statement before that were not read are
  /// passed over.
  bool next();
  std::string_view keyword() const { return keyword_; }
  uint32_t line() const { return line_; }

  /// Whether the statement has no more words.
  bool at_end();

  /// The next word, empty where there is none. Words stand in the file.
  std::string_view word();

  /// The next word as a number with |x| <= 1e18; `what` says in an error what it would be.
  float number(const char* what);

  /// The next word as a number where it is one; otherwise the word stays.
  std::optional<float> number_if_any();

  /// All that is left of the line, '#' too, without blanks at either end.
  std::string rest();

  /// Fails unless all words were read.
  void finish();

  /// Throws `WHERE: line N: reason (remedy)`.
  [[noreturn]] void fail(const std::string& reason, const std::string& remedy,
                         ErrorKind kind = ErrorKind::bad_input) const;
  [[noreturn]] void fail_at(uint32_t line, const std::string& reason, const std::string& remedy,
                            ErrorKind kind = ErrorKind::bad_input) const;

 private:
  bool at_line_end() const { return next_ == end_ || *next_ == '\n' || *next_ == '\r'; }
  bool joins_next_line() const;
  void skip_blanks();
  void skip_line_end();

  const char *next_, *end_;
  uint32_t line_ = 0;
  bool line_ended_ = true;  ///< next_ stands where a line begins
  std::string_view where_, keyword_;
};

/// A word as errors show it: at most its first 40 bytes, printable().
std::string shown_word(std::string_view word);

}  // namespace trueshade::obj
