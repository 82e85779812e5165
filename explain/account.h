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

/// A number of an explanation. Floats and doubles are written in the fewest digits that give them back; integers, edge
/// functions among them, whole.
using AccountValue = std::variant<float, double, int64_t, __int128, bool, std::string>;

/// One named quantity with its numbers.
struct Quantity {
  std::string name;     ///< as docs/arithmetic.md has it where it has one
  std::string meaning;  ///< with space and unit
  std::vector<AccountValue> values;
  bool is_list = false;    ///< in JSON a list, whatever the number of values
  std::string shown = {};  ///< for people, in place of the values
};

/// What happened at one step: a heading, quantities, and smaller steps, each in order.
struct Account {
  std::string key;    ///< what kind of step this is, for programs: `triangle`, `light`, ...
  std::string title;  ///< for people
  std::vector<Quantity> quantities;
  std::vector<Account> parts;
  std::string shown = {};  ///< for people, one line in place of title, quantities and parts

  /// A step without a name.
  Account() = default;
  /// A step without quantities and parts.
  Account(std::string of_key, std::string of_title) : key(std::move(of_key)), title(std::move(of_title)) {}

  /// Adds a quantity of one number at the end. Returns this account, as all add() do.
  template <class T>
  Account& add(std::string_view name, const T& value, std::string_view meaning) {
    quantities.push_back({std::string(name), std::string(meaning), {AccountValue(value)}, false, {}});
    return *this;
  }
  /// Adds a quantity of one word at the end.
  Account& add(std::string_view name, const char* value, std::string_view meaning) {
    return add(name, std::string(value), meaning);
  }
  /// Adds a list at the end, of any number of values.
  template <class T>
  Account& add(std::string_view name, std::span<const T> values, std::string_view meaning) {
    quantities.push_back({std::string(name), std::string(meaning), {values.begin(), values.end()}, true, {}});
    return *this;
  }
  /// Adds a list at the end.
  template <class T>
  Account& add(std::string_view name, const std::vector<T>& values, std::string_view meaning) {
    return add(name, std::span<const T>(values), meaning);
  }
  /// Adds a list at the end.
  template <class T, size_t n>
  Account& add(std::string_view name, const T (&values)[n], std::string_view meaning) {
    return add(name, std::span<const T>(values), meaning);
  }
  /// Adds a list at the end.
  template <class T, size_t n>
  Account& add(std::string_view name, const std::array<T, n>& values, std::string_view meaning) {
    return add(name, std::span<const T>(values), meaning);
  }
  /// Adds an empty smaller step at the end and returns it. The reference is valid until the next call.
  Account& part(std::string of_key, std::string of_title) {
    return parts.emplace_back(std::move(of_key), std::move(of_title));
  }
};

/// Indices as a reader writes them, with a hyphen from two consecutive ones on: `0-3, 7, 9-10`. They are ascending;
/// none give an empty text.
std::string index_ranges(std::span<const int64_t> indices);

/// One value: its digits, `inf`, `-inf` or `nan` (a NaN keeps its sign), `true` or `false`, or the word itself.
std::string value_text(const AccountValue& value);

/// Several values, with a comma and a space between two; empty of none.
std::string values_text(const std::vector<AccountValue>& values);

/// Lines for people: a heading, then a line a quantity, `name  values  meaning`, then the smaller steps, indented. It
/// ends in a line feed. Names of files and meshes in it have no line breaks and nothing that a terminal obeys.
std::string account_text(const Account& account);

/// The account as JSON:
/// {"step": key, "title": ..., "values": {name: number or list, ...}, "meanings": {name: text, ...}, "parts": [...]};
/// empty members are left out, and a meaning is given where a name first occurs.
/// Integers beyond 2^53 are strings of digits, and so are numbers that are not finite: "inf", "-inf", "nan".
std::string account_json(const Account& account);

}  // namespace trueshade
