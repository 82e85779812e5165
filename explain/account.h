#pragma once
#include <array>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace trueshade {

/// One value in an explanation. Floats and doubles are written with the fewest digits that give them back; integers, of
/// edge functions for instance, with all digits.
using AccountValue = std::variant<float, double, int64_t, __int128, bool, std::string>;

/// One named quantity of an explanation: a number, a word, or a list.
struct Quantity {
  std::string name;     ///< the name in docs/arithmetic.md, where it has one
  std::string meaning;  ///< what it is, with space and unit
  std::vector<AccountValue> values;
  bool is_list = false;    ///< in JSON a list, whatever the number of values
  std::string shown = {};  ///< the text that people read instead of the values; empty: none
};

/// What one step of drawing a pixel did: a heading, its quantities, and smaller steps (parts), each in order.
struct Account {
  std::string key;    ///< what kind of step this is, for programs: `triangle`, `light`, ...
  std::string title;  ///< for people
  std::vector<Quantity> quantities;
  std::vector<Account> parts;
  std::string shown = {};  ///< one line that people read instead of title, quantities and parts; empty: none

  /// An account with neither name nor content.
  Account() = default;
  /// An account without quantities and parts.
  Account(std::string of_key, std::string of_title) : key(std::move(of_key)), title(std::move(of_title)) {}

  /// Appends a quantity that is one number. Returns this account, as all add() do.
  template <class T>
  Account& add(std::string_view name, const T& value, std::string_view meaning) {
    quantities.push_back({std::string(name), std::string(meaning), {AccountValue(value)}, false, {}});
    return *this;
  }
  /// Appends a quantity that is one word.
  Account& add(std::string_view name, const char* value, std::string_view meaning) {
    return add(name, std::string(value), meaning);
  }
  /// Appends a quantity that is a list of numbers, also one of no or one number.
  template <class T>
  Account& add(std::string_view name, std::span<const T> values, std::string_view meaning) {
    quantities.push_back({std::string(name), std::string(meaning), {values.begin(), values.end()}, true, {}});
    return *this;
  }
  /// Appends a quantity that is a list of numbers.
  template <class T>
  Account& add(std::string_view name, const std::vector<T>& values, std::string_view meaning) {
    return add(name, std::span<const T>(values), meaning);
  }
  /// Appends a quantity that is a list of numbers.
  template <class T, size_t n>
  Account& add(std::string_view name, const T (&values)[n], std::string_view meaning) {
    return add(name, std::span<const T>(values), meaning);
  }
  /// Appends a quantity that is a list of numbers.
  template <class T, size_t n>
  Account& add(std::string_view name, const std::array<T, n>& values, std::string_view meaning) {
    return add(name, std::span<const T>(values), meaning);
  }
  /// Appends a part that is still empty, and returns it. The reference is valid until the next call.
  Account& part(std::string of_key, std::string of_title) {
    return parts.emplace_back(std::move(of_key), std::move(of_title));
  }
};

/// Ascending indices as a reader writes them, with a hyphen for consecutive ones: `0-3, 7, 9-10`. Empty for none.
std::string index_ranges(std::span<const int64_t> indices);

/// A value as text: its digits, `inf`, `-inf` or `nan` (with the NaN's sign), `true` or `false`, or the word itself.
std::string value_text(const AccountValue& value);

/// Values as text, with a comma and a space between two; empty for none.
std::string values_text(const std::vector<AccountValue>& values);

/// An account as lines for people: a heading, a line for each quantity, `name values meaning`, then the parts,
/// indented. Ends in a line feed. Names of files and meshes in it are cleared of line breaks and of whatever a terminal
/// obeys.
std::string account_text(const Account& account);

/// An account as JSON:
///{"step": key, "title": ..., "values": {name: number or list, ...}, "meanings": {name: text, ...}, "parts": [...]}.
/// Empty members are left out, and a meaning stands only where a name first occurs. Integers beyond 2^53 are strings of
/// digits, and numbers that are not finite are strings too: "inf", "-inf", "nan".
std::string account_json(const Account& account);

}  // namespace trueshade
