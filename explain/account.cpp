#include "explain/account.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>
#include <type_traits>

#include "core/json_number.h"
#include "core/json_string.h"
#include "core/printable_text.h"

namespace trueshade {
namespace {

/// The fewest digits that give a number back.
template <class Number>
std::string digits_of(Number value) {
  char digits[64];
  return {digits, std::to_chars(digits, digits + sizeof digits, value).ptr};
}

/// All digits of a whole number.
std::string digits_of(__int128 value) {
  const bool negative = value < 0;
  std::string digits;
  for (auto rest = negative ? -static_cast<unsigned __int128>(value) : static_cast<unsigned __int128>(value);
       rest != 0 || digits.empty(); rest /= 10)
    digits += char('0' + int(rest % 10));
  if (negative) digits += '-';
  std::reverse(digits.begin(), digits.end());
  return digits;
}

/// A value as account_json() has it.
std::string value_json(const AccountValue& value) {
  constexpr __int128 kExact = __int128(1) << 53;
  const std::string text = value_text(value);
  if (const auto* number = std::get_if<float>(&value))
    return std::isfinite(*number) ? text : std::string(json_of_nonfinite(double(*number)));
  if (const auto* number = std::get_if<double>(&value))
    return std::isfinite(*number) ? text : std::string(json_of_nonfinite(*number));
  if (const auto* number = std::get_if<__int128>(&value))
    return *number >= -kExact && *number <= kExact ? text : json_string(text);
  return std::holds_alternative<std::string>(value) ? json_string(text) : text;
}

/// The texts of values, with a comma and a space between two.
std::string joined(const std::vector<AccountValue>& values, std::string (*text)(const AccountValue&)) {
  std::string all;
  for (const AccountValue& value : values) {
    if (!all.empty()) all += ", ";
    all += text(value);
  }
  return all;
}

/// Appends the lines of a step that is so deep in the account, and those of its smaller steps.
void write(const Account& account, size_t depth, std::string& out) {
  constexpr size_t kName = 11, kValues = 42;  // characters; a longer one pushes the next column
  const std::string indent(2 * depth, ' ');
  if (depth == 1) out += '\n';
  if (!account.shown.empty()) {
    out += indent + printable(account.shown, Lines::one) + '\n';
    return;
  }
  out += indent + printable(account.title, Lines::one) + '\n';
  for (const Quantity& quantity : account.quantities) {
    std::string line = indent + "  " + quantity.name;
    const auto column = [&](size_t at) { line.resize(std::max(line.size() + 2, indent.size() + 2 + at), ' '); };
    column(kName);
    line += quantity.shown.empty() ? values_text(quantity.values) : quantity.shown;
    if (!quantity.meaning.empty()) {
      column(kName + kValues);
      line += quantity.meaning;
    }
    out += printable(line, Lines::one) + '\n';
  }
  for (const Account& part : account.parts) write(part, depth + 1, out);
}

}  // namespace

std::string value_text(const AccountValue& value) {
  return std::visit(
      [](const auto& v) -> std::string {
        using T = std::decay_t<decltype(v)>;
        if constexpr (std::is_same_v<T, std::string>)
          return v;
        else if constexpr (std::is_same_v<T, bool>)
          return v ? "true" : "false";
        else
          return digits_of(v);
      },
      value);
}

std::string values_text(const std::vector<AccountValue>& values) { return joined(values, value_text); }

std::string index_ranges(std::span<const int64_t> indices) {
  std::string out;
  for (size_t i = 0; i < indices.size();) {
    size_t end = i + 1;
    while (end < indices.size() && indices[end] == indices[end - 1] + 1) ++end;
    if (!out.empty()) out += ", ";
    out += std::to_string(indices[i]);
    if (end - i > 1) out += '-' + std::to_string(indices[end - 1]);
    i = end;
  }
  return out;
}

std::string account_text(const Account& account) {
  std::string out;
  write(account, 0, out);
  return out;
}

namespace {

/// Appends one step as account_json() has it. `told`: names whose meaning is written already; receives this step's.
void write_json(const Account& account, std::set<std::string>& told, std::string& out) {
  out += "{\"step\": " + json_string(account.key) + ", \"title\": " + json_string(account.title);
  std::string values, meanings;
  for (const Quantity& quantity : account.quantities) {
    const std::string text = joined(quantity.values, value_json), name = json_string(quantity.name);
    values += (values.empty() ? "" : ", ") + name + ": " + (quantity.is_list ? '[' + text + ']' : text);
    if (!quantity.meaning.empty() && told.insert(quantity.name).second)
      meanings += (meanings.empty() ? "" : ", ") + name + ": " + json_string(quantity.meaning);
  }
  if (!values.empty()) out += ", \"values\": {" + values + '}';
  if (!meanings.empty()) out += ", \"meanings\": {" + meanings + '}';
  if (!account.parts.empty()) {
    out += ", \"parts\": [";
    for (const Account& part : account.parts) {
      if (&part != &account.parts.front()) out += ", ";
      write_json(part, told, out);
    }
    out += ']';
  }
  out += '}';
}

}  // namespace

std::string account_json(const Account& account) {
  std::string out;
  std::set<std::string> told;
  write_json(account, told, out);
  return out;
}

}  // namespace trueshade
