#include "scenes/files/gltf/extras/field_writer.h"

#include <charconv>
#include <cmath>

#include "scenes/json/json_value.h"

namespace trueshade::gltf {
namespace {

/// A float as the double that it is, so that readers of doubles find just its bits.
void append_real(std::string& out, double value) {
  if (std::isinf(value)) {
    out += "\"infinity\"";
  } else if (value == 0.0) {
    out += std::signbit(value) ? "-0.0" : "0";  // as a whole number it would lose its sign
  } else {
    char buffer[32];
    out.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
  }
}

template <typename T>
void append_list(std::string& out, std::span<const T> values) {
  out += '[';
  for (size_t i = 0; i < values.size(); ++i) {
    if (i > 0) out += ',';
    append_json(out, values[i]);
  }
  out += ']';
}

}  // namespace

void append_json(std::string& out, double value) { append_real(out, value); }
void append_json(std::string& out, float value) { append_real(out, double(value)); }
void append_json(std::string& out, uint32_t value) { out += std::to_string(value); }
void append_json(std::string& out, bool value) { out += value ? "true" : "false"; }
void append_json(std::string& out, const std::string& value) { json::append_string(out, value); }
void append_json(std::string& out, std::span<const double> values) { append_list(out, values); }
void append_json(std::string& out, std::span<const float> values) { append_list(out, values); }

void FieldWriter::begin(std::string_view key) {
  if (has_fields_) out_ += ',';
  has_fields_ = true;
  json::append_string(out_, key);
  out_ += ':';
}

void FieldWriter::put(const std::vector<uint32_t>& v) { append_list(out_, std::span<const uint32_t>(v)); }

}  // namespace trueshade::gltf
