#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "core/json_string.h"

namespace trueshade {

/// Numbers as JSON: integers whole, a double in the fewest digits that give it back, and what is not finite as the
/// string "inf", "-inf" or "nan".
std::string json_number(uint64_t value);
std::string json_number(double value);

/// An object put together member by member, in order. Values of put_raw() are JSON already.
class JsonObject {
 public:
  JsonObject& put_raw(std::string_view key, std::string_view json);
  JsonObject& put(std::string_view key, std::string_view text) { return put_raw(key, json_string(text)); }
  JsonObject& put(std::string_view key, const char* text) { return put(key, std::string_view(text)); }
  JsonObject& put(std::string_view key, bool value) { return put_raw(key, value ? "true" : "false"); }
  JsonObject& put(std::string_view key, int value) { return put_raw(key, std::to_string(value)); }
  JsonObject& put(std::string_view key, uint64_t value) { return put_raw(key, json_number(value)); }
  JsonObject& put(std::string_view key, double value) { return put_raw(key, json_number(value)); }
  std::string text() const { return '{' + members_ + '}'; }

 private:
  std::string members_;
};

/// An array of values that are JSON already.
class JsonArray {
 public:
  JsonArray& add_raw(std::string_view json) {
    if (!values_.empty()) values_ += ", ";
    values_ += json;
    return *this;
  }
  std::string text() const { return '[' + values_ + ']'; }

 private:
  std::string values_;
};

/// An array of texts.
template <typename Strings>
std::string strings_json(const Strings& strings) {
  JsonArray array;
  for (const std::string& text : strings) array.add_raw(json_string(text));
  return array.text();
}

}  // namespace trueshade
