#include "scenes/files/gltf/extras/field_reader.h"

#include <limits>

namespace trueshade::gltf {
namespace {

template <typename T>
void take_real(const json::Node& node, T& value) {
  constexpr std::string_view kInfinity[] = {"infinity"};
  if (std::holds_alternative<std::unique_ptr<std::string>>(node.value().is)) {
    node.choice(kInfinity);
    value = std::numeric_limits<T>::infinity();
    return;
  }
  constexpr double kMost = double(std::numeric_limits<T>::max());
  value = T(node.number(-kMost, kMost));
}

}  // namespace

void take_json(const json::Node& node, double& value) { take_real(node, value); }
void take_json(const json::Node& node, float& value) { take_real(node, value); }
void take_json(const json::Node& node, uint32_t& value) { value = uint32_t(node.integer(0, UINT32_MAX)); }
void take_json(const json::Node& node, bool& value) { value = node.boolean(); }
void take_json(const json::Node& node, std::string& value) { value = node.string(); }

void FieldReader::take(const json::Node& node, std::vector<glm::dvec4>& v) {
  const size_t count = node.array(4, SIZE_MAX).size();
  if (count % 4 != 0) node.fail("found an array of " + std::to_string(count), "four numbers a step");
  v.resize(count / 4);
  take_all(node, std::span<double>(&v[0].x, count));
}

}  // namespace trueshade::gltf
