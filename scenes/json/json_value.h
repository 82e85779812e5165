#pragma once
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "core/error.h"

// JSON (RFC 8259) as we read it: strict, and every error names the place by a JSON pointer (RFC 6901).
namespace trueshade::json {

/// What numbers of our files stay within unless they say less, in double (1e18f is a little less), and the least length
/// where it must be above 0.
inline constexpr double kLargest = 1e18, kSmallest = 1e-30;

struct Value;
using Array = std::vector<Value>;
using Members = std::vector<std::pair<std::string, Value>>;  ///< in the order of the text; names are unique

/// One value of a text. Numbers are doubles: whole numbers are exact up to 2^53.
struct Value {
  std::variant<std::monostate, bool, double, std::unique_ptr<std::string>, std::unique_ptr<Array>,
               std::unique_ptr<Members>>
      is;
};

inline constexpr int kMaxDepth = 64;  ///< of arrays and objects inside each other

/// Reads a whole text. Error(bad_input) behind `where`: for what is not JSON with line and column; for a key given
/// twice or deeper nesting than kMaxDepth with the pointer; for a byte order mark.
Value parse(std::string_view text, std::string_view where);

/// The keys an object may have; a reader and its schema list the same (tests/scenes/schemas.cpp).
struct ObjectKeys {
  std::string_view object;  ///< the object's name under `$defs` in the schema; empty for the root
  std::span<const std::string_view> keys;
};

/// A value and the way to it, for reading with errors that say where. Lives on the stack beside its parent.
class Node {
 public:
  Node(const Value& value, std::string_view where) : value_(&value), where_(where) {}
  Node(const Value& value, const Node& parent, std::string_view key)
      : value_(&value), parent_(&parent), where_(parent.where_), key_(key) {}
  Node(const Value& value, const Node& parent, size_t index)
      : value_(&value), parent_(&parent), where_(parent.where_), index_(index) {}

  /// Throws `WHERE: POINTER: reason (remedy)`.
  [[noreturn]] void fail(const std::string& reason, const std::string& remedy,
                         ErrorKind kind = ErrorKind::bad_input) const;

  bool boolean() const;
  double number(double least, double most) const;      ///< both ends included
  float real(double least, double most) const;         ///< number(), rounded to float
  int64_t integer(int64_t least, int64_t most) const;  ///< a number without a fraction
  const std::string& string() const;
  glm::vec3 vec3(double least, double most) const;  ///< an array of 3
  glm::vec4 color() const;                          ///< 3 or 4 numbers, RGB in [0, 1e18], alpha in [0, 1], 1 if absent
  const Array& array(size_t least, size_t most) const;
  bool is_array() const { return std::holds_alternative<std::unique_ptr<Array>>(value_->is); }

  /// The place of a string in `names`; for enumerators in the order of their values.
  size_t choice(std::span<const std::string_view> names) const;

  /// Fails unless this is an object with no other keys than these.
  void check_keys(const ObjectKeys& allowed) const;
  std::optional<Node> find(std::string_view key) const;  ///< of an object
  Node member(std::string_view key) const;               ///< fails if it is absent
  Node element(size_t index) const {
    return Node((*std::get<std::unique_ptr<Array>>(value_->is))[index], *this, index);
  }
  const Value& value() const { return *value_; }

  std::string pointer() const;

 private:
  const Members& members() const;
  const Value* value_;
  const Node* parent_ = nullptr;
  std::string_view where_, key_;
  size_t index_ = 0;
};

/// Text of a value in canonical form: no white space, members in order, shortest numbers that read back the same.
std::string text_of(const Value& value);

/// Appends `/key` as RFC 6901 escapes it; control characters become '?' and a long key is cut, since an error is one
/// line.
void append_pointer(std::string& pointer, std::string_view key);

/// Appends a string in quotes, escaped.
void append_string(std::string& out, std::string_view text);

/// The shortest text that reads back as the same number.
std::string number_text(double value);

/// Appends the shortest number that reads back as the same float. Zero has no sign.
void append_number(std::string& out, float value);

}  // namespace trueshade::json
