#include <algorithm>
#include <fstream>
#include <sstream>

#include "scenes/files/json_value.h"
#include "scenes/pipeline/pipeline_json.h"
#include "scenes/pipeline/presets.h"
#include "scenes/files/scene_json.h"
#include "tests/catch.hpp"

namespace trueshade {
namespace {

json::Value schema(const std::string& name) {
  std::ifstream file(TRUESHADE_SOURCE_DIR "/scenes/" + name);
  REQUIRE(file);
  std::ostringstream text;
  text << file.rdbuf();
  return json::parse(text.str(), name);
}

std::vector<std::string> keys_of(const json::Node& object) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : *std::get<std::unique_ptr<json::Members>>(object.value().is)) keys.push_back(key);
  return keys;
}

/// The schema's objects are those of the reader, with the same keys, all closed to others.
void check_agreement(const std::string& name, std::span<const json::ObjectKeys> objects) {
  const json::Value value = schema(name);
  const json::Node root(value, name);
  const json::Node definitions = root.member("$defs");
  CHECK(keys_of(definitions).size() == objects.size() - 1);
  for (const json::ObjectKeys& object : objects) {
    INFO(name << " " << object.object);
    const json::Node node = object.object.empty() ? root : definitions.member(object.object);
    std::vector<std::string> in_schema = keys_of(node.member("properties"));
    std::vector<std::string> in_reader(object.keys.begin(), object.keys.end());
    std::sort(in_schema.begin(), in_schema.end());
    std::sort(in_reader.begin(), in_reader.end());
    CHECK(in_schema == in_reader);
    CHECK_FALSE(node.member("additionalProperties").boolean());
  }
}

TEST_CASE("readers and schemas list the same keys") {
  check_agreement("pipeline/pipeline.schema.json", pipeline_object_keys());
  check_agreement("files/scene.schema.json", scene_object_keys());
}

TEST_CASE("the pipeline schema lists the presets that exist") {
  const json::Value value = schema("pipeline/pipeline.schema.json");
  const json::Node root(value, "pipeline.schema.json"),
      properties = root.member("properties"), preset = properties.member("preset"), names = preset.member("enum");
  REQUIRE(names.array(1, 100).size() == presets().size());
  for (size_t i = 0; i < presets().size(); ++i) CHECK(names.element(i).string() == std::string(presets()[i].name));
}

}  // namespace
}  // namespace trueshade
