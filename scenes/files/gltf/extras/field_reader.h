#pragma once
#include <array>
#include <glm/mat4x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "scenes/json/json_value.h"

namespace trueshade::gltf {

/// Takes from a number or "infinity", within float's or double's range. Fails at the node for anything else.
void take_json(const json::Node& node, double& value);
void take_json(const json::Node& node, float& value);
void take_json(const json::Node& node, uint32_t& value);
void take_json(const json::Node& node, bool& value);
void take_json(const json::Node& node, std::string& value);

/// Reads the fields of one value from a JSON object, as FieldWriter writes them. What is absent keeps its default. A
/// text of `{}` may stand for a large value: lists take from `left` bytes before they take memory, Error(limit) beyond.
class FieldReader {
 public:
  FieldReader(const trueshade::json::Node& node, uint64_t& left) : node_(node), left_(left) {}

  /// Fails for a key that no field has.
  void finish() const { node_.check_keys({"", keys_}); }

  template <typename T>
  void operator()(std::string_view key, T& value, const T& absent) {
    value = absent;
    if (const auto node = found(key)) take(*node, value);
  }

  void json(std::string_view key, std::string& text) {
    if (const auto node = found(key)) text = trueshade::json::text_of(node->value());
  }

  template <typename T>
  void named(std::string_view key, T& value, const T& absent, std::span<const std::string_view> names) {
    const auto node = found(key);
    value = node ? T(node->choice(names)) : absent;
  }

  template <typename T, typename Fields>
  void object(std::string_view key, T& value, const Fields& fields) {
    keys_.push_back(key);
    read(node_.member(key), value, fields);
  }

  template <typename T, typename Fields>
  void optional(std::string_view key, std::optional<T>& value, const Fields& fields) {
    if (const auto node = found(key)) read(*node, value.emplace(), fields);
  }

  template <typename T, typename Fields>
  void list(std::string_view key, std::vector<T>& values, const Fields& fields) {
    const auto node = found(key);
    if (!node) return;
    const uint64_t count = node->array(1, SIZE_MAX).size();
    if (count > left_ / sizeof(T))
      node->fail("the list is over the limit of memory", "fewer elements", ErrorKind::limit);
    left_ -= count * sizeof(T);
    values.resize(size_t(count));
    for (size_t i = 0; i < values.size(); ++i) read(node->element(i), values[i], fields);
  }

 private:
  std::optional<trueshade::json::Node> found(std::string_view key) {
    keys_.push_back(key);
    return node_.find(key);
  }

  template <typename T, typename Fields>
  void read(const trueshade::json::Node& node, T& value, const Fields& fields) {
    FieldReader inner(node, left_);
    fields(inner, value);
    inner.finish();
  }

  template <typename T>
  static void take_all(const trueshade::json::Node& node, std::span<T> values) {
    node.array(values.size(), values.size());
    for (size_t i = 0; i < values.size(); ++i) take_json(node.element(i), values[i]);
  }

  template <typename T>
  static void take(const trueshade::json::Node& node, T& value) {
    take_json(node, value);
  }
  static void take(const trueshade::json::Node& node, glm::vec2& v) { take_all(node, std::span<float>(&v.x, 2)); }
  static void take(const trueshade::json::Node& node, glm::vec3& v) { take_all(node, std::span<float>(&v.x, 3)); }
  static void take(const trueshade::json::Node& node, glm::vec4& v) { take_all(node, std::span<float>(&v.x, 4)); }
  static void take(const trueshade::json::Node& node, glm::dvec3& v) { take_all(node, std::span<double>(&v.x, 3)); }
  static void take(const trueshade::json::Node& node, glm::dvec4& v) { take_all(node, std::span<double>(&v.x, 4)); }
  static void take(const trueshade::json::Node& node, glm::dmat4x3& m) {
    take_all(node, std::span<double>(&m[0].x, 12));
  }
  template <typename Number>
  requires std::is_floating_point_v<Number>
  static void take(const trueshade::json::Node& node, std::optional<Number>& v) { take_json(node, v.emplace()); }
  template <typename T>
  static void take(const trueshade::json::Node& node, std::optional<std::array<T, 16>>& v) {
    take_all(node, std::span<T>(v.emplace()));
  }
  template <typename T>
  static void take(const trueshade::json::Node& node, std::vector<T>& v) {
    v.resize(node.array(1, SIZE_MAX).size());
    take_all(node, std::span<T>(v));
  }
  static void take(const trueshade::json::Node& node, std::vector<glm::dvec4>& v);

  const trueshade::json::Node& node_;
  uint64_t& left_;
  std::vector<std::string_view> keys_;
};

}  // namespace trueshade::gltf
