#pragma once
#include <array>
#include <cstdint>
#include <cstring>
#include <glm/mat4x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace trueshade::gltf {

/// Appends the shortest number that reads back as the same bits, the sign of zero too; infinity is a string.
void append_json(std::string& out, double value);
void append_json(std::string& out, float value);
void append_json(std::string& out, uint32_t value);
void append_json(std::string& out, bool value);
void append_json(std::string& out, const std::string& value);
void append_json(std::string& out, std::span<const double> values);
void append_json(std::string& out, std::span<const float> values);

template <typename T>
struct IsOptional : std::false_type {};
template <typename T>
struct IsOptional<std::optional<T>> : std::true_type {};

/// Writes the fields of one value as a JSON object; fields that have their default are left out.
class FieldWriter {
 public:
  explicit FieldWriter(std::string& out) : out_(out) { out_ += '{'; }
  void finish() { out_ += '}'; }

  template <typename T>
  void operator()(std::string_view key, const T& value, const T& absent) {
    if (is_same(value, absent)) return;
    begin(key);
    put(value);
  }

  /// A value whose JSON is at hand; none where it is empty.
  void json(std::string_view key, const std::string& text) {
    if (text.empty()) return;
    begin(key);
    out_ += text;
  }

  template <typename T>
  void named(std::string_view key, const T& value, const T& absent, std::span<const std::string_view> names) {
    if (value == absent) return;
    begin(key);
    append_json(out_, std::string(names[size_t(value)]));
  }

  template <typename T, typename Fields>
  void object(std::string_view key, const T& value, const Fields& fields) {
    begin(key);
    write(value, fields);
  }

  template <typename T, typename Fields>
  void optional(std::string_view key, const std::optional<T>& value, const Fields& fields) {
    if (value) object(key, *value, fields);
  }

  template <typename T, typename Fields>
  void list(std::string_view key, const std::vector<T>& values, const Fields& fields) {
    if (values.empty()) return;
    begin(key);
    out_ += '[';
    for (size_t i = 0; i < values.size(); ++i) {
      if (i > 0) out_ += ',';
      write(values[i], fields);
    }
    out_ += ']';
  }

 private:
  void begin(std::string_view key);

  /// Numbers by their bits: -0 is not 0.
  template <typename T>
  static bool is_same(const T& a, const T& b) {
    if constexpr (std::is_trivially_copyable_v<T> && std::is_class_v<T> && !IsOptional<T>::value)
      return std::memcmp(&a, &b, sizeof(T)) == 0;
    else if constexpr (std::is_floating_point_v<T>)
      return std::memcmp(&a, &b, sizeof(T)) == 0;
    else
      return a == b;
  }

  template <typename T, typename Fields>
  void write(const T& value, const Fields& fields) {
    FieldWriter inner(out_);
    fields(inner, value);
    inner.finish();
  }

  template <typename T>
  void put(const T& value) {
    append_json(out_, value);
  }
  void put(const glm::vec2& v) { append_json(out_, std::span<const float>(&v.x, 2)); }
  void put(const glm::vec3& v) { append_json(out_, std::span<const float>(&v.x, 3)); }
  void put(const glm::vec4& v) { append_json(out_, std::span<const float>(&v.x, 4)); }
  void put(const glm::dvec3& v) { append_json(out_, std::span<const double>(&v.x, 3)); }
  void put(const glm::dvec4& v) { append_json(out_, std::span<const double>(&v.x, 4)); }
  void put(const glm::dmat4x3& m) { append_json(out_, std::span<const double>(&m[0].x, 12)); }
  void put(const std::optional<float>& v) { append_json(out_, *v); }
  void put(const std::optional<double>& v) { append_json(out_, *v); }
  void put(const std::optional<std::array<float, 16>>& v) { append_json(out_, std::span<const float>(*v)); }
  void put(const std::optional<std::array<double, 16>>& v) { append_json(out_, std::span<const double>(*v)); }
  void put(const std::vector<double>& v) { append_json(out_, std::span<const double>(v)); }
  void put(const std::vector<glm::dvec4>& v) { append_json(out_, std::span<const double>(&v[0].x, 4 * v.size())); }
  void put(const std::vector<uint32_t>& v);

  std::string& out_;
  bool has_fields_ = false;
};

}  // namespace trueshade::gltf
