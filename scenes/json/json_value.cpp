#include "scenes/json/json_value.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/likeliest_name.h"

namespace trueshade::json {
std::string number_text(double value) {
  char buffer[32];
  const auto [end, code] = std::to_chars(buffer, buffer + sizeof buffer, value);
  (void)code;  // 32 characters hold any double
  return std::string(buffer, end);
}

namespace {

/// What a value is, for an error; a long string is cut.
std::string shown(const Value& value) {
  if (std::holds_alternative<std::monostate>(value.is)) return "null";
  if (const bool* b = std::get_if<bool>(&value.is)) return *b ? "true" : "false";
  if (const double* d = std::get_if<double>(&value.is)) return number_text(*d);
  if (const auto* s = std::get_if<std::unique_ptr<std::string>>(&value.is)) {
    std::string text;
    append_string(text, std::string_view(**s).substr(0, 40));
    return text;
  }
  return std::holds_alternative<std::unique_ptr<Array>>(value.is) ? "an array" : "an object";
}

}  // namespace

void append_pointer(std::string& pointer, std::string_view key) {
  pointer += '/';
  for (const char c : key.substr(0, 80)) {
    if (c == '~')
      pointer += "~0";
    else if (c == '/')
      pointer += "~1";
    else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
      pointer += '?';  // an error is one line
    else
      pointer += c;
  }
}

std::string Node::pointer() const {
  if (!parent_) return {};
  std::string text = parent_->pointer();
  append_pointer(text, key_.data() ? std::string(key_) : std::to_string(index_));
  return text;
}

void Node::fail(const std::string& reason, const std::string& remedy, ErrorKind kind) const {
  const std::string place = pointer();
  throw Error(kind, std::string(where_) + (place.empty() ? "" : ": " + place), reason, remedy);
}

bool Node::boolean() const {
  if (const bool* b = std::get_if<bool>(&value_->is)) return *b;
  fail("found " + shown(*value_), "true or false");
}

double Node::number(double least, double most) const {
  const double* d = std::get_if<double>(&value_->is);
  if (!d || !(*d >= least && *d <= most))
    fail("found " + shown(*value_), "a number from " + number_text(least) + " to " + number_text(most));
  return *d;
}

float Node::real(double least, double most) const { return float(number(least, most)); }

int64_t Node::integer(int64_t least, int64_t most) const {
  const double* d = std::get_if<double>(&value_->is);
  if (!d || !(*d >= double(least) && *d <= double(most)) || std::floor(*d) != *d)
    fail("found " + shown(*value_), "a whole number from " + std::to_string(least) + " to " + std::to_string(most));
  return int64_t(*d);
}

const std::string& Node::string() const {
  if (const auto* s = std::get_if<std::unique_ptr<std::string>>(&value_->is)) return **s;
  fail("found " + shown(*value_), "a string");
}

const Array& Node::array(size_t least, size_t most) const {
  const auto* a = std::get_if<std::unique_ptr<Array>>(&value_->is);
  if (!a || (*a)->size() < least || (*a)->size() > most) {
    const std::string found = a ? "an array of " + std::to_string((*a)->size()) : shown(*value_);
    if (least == 0 && most == SIZE_MAX) fail("found " + found, "an array");
    const std::string from = std::to_string(least);
    fail("found " + found, least == most      ? "an array of " + from
                           : most == SIZE_MAX ? "an array of " + from + " or more"
                                              : "an array of " + from + " to " + std::to_string(most));
  }
  return **a;
}

glm::vec3 Node::vec3(double least, double most) const {
  array(3, 3);
  return {element(0).real(least, most), element(1).real(least, most), element(2).real(least, most)};
}

glm::vec4 Node::color() const {
  const size_t count = array(3, 4).size();
  return {element(0).real(0.0, kLargest), element(1).real(0.0, kLargest), element(2).real(0.0, kLargest),
          count == 4 ? element(3).real(0.0, 1.0) : 1.0f};
}

size_t Node::choice(std::span<const std::string_view> names) const {
  if (const auto* s = std::get_if<std::unique_ptr<std::string>>(&value_->is)) {
    const auto found = std::find(names.begin(), names.end(), **s);
    if (found != names.end()) return size_t(found - names.begin());
  }
  std::string all;
  for (const std::string_view name : names) all += (all.empty() ? "" : " ") + std::string(name);
  const auto* text = std::get_if<std::unique_ptr<std::string>>(&value_->is);
  fail("found " + shown(*value_),
       (text != nullptr ? did_you_mean(**text, names) : std::string()) + (names.size() == 1 ? all : "one of " + all));
}

const Members& Node::members() const {
  if (const auto* m = std::get_if<std::unique_ptr<Members>>(&value_->is)) return **m;
  fail("found " + shown(*value_), "an object");
}

void Node::check_keys(const ObjectKeys& allowed) const {
  for (const auto& [key, value] : members()) {
    if (std::find(allowed.keys.begin(), allowed.keys.end(), key) != allowed.keys.end()) continue;
    std::string all;
    for (const std::string_view name : allowed.keys) all += (all.empty() ? "" : " ") + std::string(name);
    Node(value, *this, key).fail("this key is unknown", did_you_mean(key, allowed.keys) + "keys here are " + all);
  }
}

std::optional<Node> Node::find(std::string_view key) const {
  for (const auto& [name, value] : members())
    if (name == key) return Node(value, *this, std::string_view(name));
  return std::nullopt;
}

Node Node::member(std::string_view key) const {
  if (const std::optional<Node> found = find(key)) return *found;
  fail("'" + std::string(key) + "' is missing", "add it");
}

void append_string(std::string& out, std::string_view text) {
  constexpr char kHex[] = "0123456789abcdef";
  out += '"';
  for (const char c : text) {
    const unsigned char byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\')
      (out += '\\') += c;
    else if (byte < 0x20)
      ((out += "\\u00") += kHex[byte >> 4]) += kHex[byte & 15];
    else
      out += c;
  }
  out += '"';
}

void append_number(std::string& out, float value) {
  char buffer[32];
  const auto [end, code] = std::to_chars(buffer, buffer + sizeof buffer, value == 0.0f ? 0.0f : value);
  (void)code;
  out.append(buffer, end);
}

std::string text_of(const Value& value) {
  if (const auto* a = std::get_if<std::unique_ptr<Array>>(&value.is)) {
    std::string out = "[";
    for (const Value& element : **a) out += (out.size() > 1 ? "," : "") + text_of(element);
    return out + "]";
  }
  if (const auto* m = std::get_if<std::unique_ptr<Members>>(&value.is)) {
    std::string out = "{";
    for (const auto& [key, member] : **m) {
      if (out.size() > 1) out += ',';
      append_string(out, key);
      out += ":" + text_of(member);
    }
    return out + "}";
  }
  if (const auto* s = std::get_if<std::unique_ptr<std::string>>(&value.is)) {
    std::string out;
    append_string(out, **s);
    return out;
  }
  return shown(value);
}

}  // namespace trueshade::json
