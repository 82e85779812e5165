#include "cli/resolved_arrays.h"

#include <charconv>
#include <cmath>
#include <cstring>
#include <utility>

#include "core/json_number.h"

namespace trueshade {
namespace {

void append_float(std::string& out, float value) {
  if (!std::isfinite(value)) {
    out += json_of_nonfinite(double(value));
  } else if (value == 0.0f) {
    out += std::signbit(value) ? "-0.0" : "0";  // a reader of JSON may take -0 for an integer, which has no sign
  } else {
    char digits[32];
    out.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
  }
}

/// Nested lists of `shape` over numbers that `append(out, i)` writes.
template <typename Append>
std::string nested(std::span<const size_t> shape, const Append& append) {
  std::string out;
  size_t next = 0;
  const auto list = [&](const auto& self, size_t axis) -> void {
    out += '[';
    for (size_t i = 0; i < shape[axis]; ++i) {
      if (i > 0) out += ',';
      if (axis + 1 == shape.size())
        append(out, next++);
      else
        self(self, axis + 1);
    }
    out += ']';
  };
  list(list, 0);
  return out;
}

template <typename T>
std::span<const uint8_t> bytes_of(std::span<const T> values) {
  return {reinterpret_cast<const uint8_t*>(values.data()), values.size_bytes()};
}

template <typename T>
T value_at(std::span<const uint8_t> bytes, size_t index) {
  T value;
  std::memcpy(&value, bytes.data() + index * sizeof value, sizeof value);
  return value;
}

}  // namespace

std::string json_of_float(float value) {
  std::string out;
  append_float(out, value);
  return out;
}

std::string json_of_floats(std::span<const float> values) {
  const size_t shape[] = {values.size()};
  return nested(shape, [&](std::string& out, size_t i) { append_float(out, values[i]); });
}

void ResolvedArrays::add_piece(std::span<const uint8_t> bytes) {
  if (bytes.empty()) return;
  pieces_.push_back(bytes);
  bytes_ += bytes.size();
}

std::string ResolvedArrays::in_file(std::string_view type, std::span<const size_t> shape) {
  const size_t axes[] = {shape.size()};
  const std::string lengths = nested(axes, [&](std::string& out, size_t i) { out += std::to_string(shape[i]); });
  return "{\"type\": \"" + std::string(type) + "\", \"shape\": " + lengths + ", \"offset\": " + std::to_string(bytes_) +
         "}";
}

std::string ResolvedArrays::streams(std::span<const FloatStream> streams) {
  const size_t shape[] = {streams.size(), streams[0].size()};
  if (place_ == Place::document)
    return nested(shape, [&](std::string& out, size_t i) { append_float(out, streams[i / shape[1]][i % shape[1]]); });
  const std::string place = in_file("float32", shape);
  for (const FloatStream& stream : streams) add_piece(bytes_of(std::span(stream)));
  return place;
}

std::string ResolvedArrays::triangles(std::span<const uint32_t> indices) {
  const size_t shape[] = {indices.size() / 3, 3};
  if (place_ == Place::document)
    return nested(shape, [&](std::string& out, size_t i) { out += std::to_string(indices[i]); });
  const std::string place = in_file("uint32", shape);
  add_piece(bytes_of(indices));
  return place;
}

std::string ResolvedArrays::points(std::vector<glm::vec3> points) {
  static_assert(sizeof(glm::vec3) == 3 * sizeof(float));
  const size_t shape[] = {points.size(), 3};
  if (place_ == Place::document)
    return nested(shape, [&](std::string& out, size_t i) { append_float(out, points[i / 3][int(i % 3)]); });
  const std::string place = in_file("float32", shape);
  kept_.push_back(std::move(points));
  add_piece(bytes_of(std::span<const glm::vec3>(kept_.back())));
  return place;
}

std::string ResolvedArrays::texels(std::span<const uint8_t> bytes, int width, int height, int bytes_a_channel) {
  const size_t shape[] = {size_t(height), size_t(width), 4};
  if (place_ == Place::document)
    return nested(shape, [&](std::string& out, size_t i) {
      if (bytes_a_channel == 4)
        append_float(out, value_at<float>(bytes, i));
      else
        out += std::to_string(bytes_a_channel == 1 ? bytes[i] : value_at<uint16_t>(bytes, i));
    });
  const char* type = bytes_a_channel == 1 ? "uint8" : bytes_a_channel == 2 ? "uint16" : "float32";
  const std::string place = in_file(type, shape);
  add_piece(bytes);
  return place;
}

}  // namespace trueshade
