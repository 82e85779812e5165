#include <algorithm>
#include <fstream>
#include <sstream>

#include "cli/batch/job.h"
#include "expect_error.h"
#include "scenes/files/scene_json.h"
#include "scenes/json/json_value.h"
#include "scenes/light_fields.h"
#include "scenes/material_fields.h"
#include "scenes/pipeline/pipeline_json.h"
#include "scenes/pipeline/presets.h"
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
  check_agreement("schemas/pipeline.schema.json", pipeline_object_keys());
  check_agreement("schemas/scene.schema.json", scene_object_keys());
  check_agreement("../cli/batch/jobs.schema.json", batch::job_object_keys());
}

/// The bounds that a schema states of a key are those of the field's row.
void check_bounds(const json::Node& definition, std::string_view key, double least, double most) {
  const json::Node properties = definition.member("properties");
  const auto property = properties.find(key);
  REQUIRE(property);
  INFO(definition.pointer() << " " << key);
  const auto items = property->find("items");
  const json::Node& number = items ? *items : *property;
  if (const auto minimum = number.find("minimum")) CHECK(minimum->number(-1e300, 1e300) == least);
  if (const auto above = number.find("exclusiveMinimum"))
    CHECK((above->number(-1e300, 1e300) == 0.0 && least == kAboveZero));
  if (const auto maximum = number.find("maximum")) CHECK(maximum->number(-1e300, 1e300) == most);
}

TEST_CASE("the schema's bounds are those of the fields of lights and materials") {
  const json::Value value = schema("schemas/scene.schema.json");
  const json::Node root(value, "schema"), definitions = root.member("$defs");
  for (const LightTypeRow& type : kLightTypes)
    for (const LightField& field : kLightFields)
      for (const char* suffix : {"", "_step"})
        if (contains(field.types, LightType(&type - kLightTypes)))
          check_bounds(definitions.member(std::string(type.name) + suffix), field.key, field.least, field.most);
  for (const MaterialField& field : kMaterialFields)
    check_bounds(definitions.member("material"), field.key, field.least, field.most);
}

/// Every key of every object has a description of its own: a sentence.
void check_descriptions(const std::string& name, size_t least) {
  const json::Value value = schema(name);
  const json::Node root(value, name);
  const json::Node definitions = root.member("$defs");
  size_t keys = 0;
  const auto check_object = [&](const json::Node& object) {
    const json::Node properties = object.member("properties");
    for (const std::string& key : keys_of(properties)) {
      const json::Node property = properties.member(key);
      INFO(name << property.pointer());
      const auto description = property.find("description");
      REQUIRE(description);
      const std::string& text = description->string();
      CHECK(text.size() > 20);
      CHECK(((text[0] >= 'A' && text[0] <= 'Z') || text[0] == '1'));
      CHECK(text.back() == '.');
      if (property.find("default")) CHECK(text.find("Default: ") != std::string::npos);
      ++keys;
    }
  };
  check_object(root);
  for (const std::string& object : keys_of(definitions)) check_object(definitions.member(object));
  CHECK(keys >= least);
}

TEST_CASE("every key of a schema has a description, with the default where there is one") {
  check_descriptions("schemas/pipeline.schema.json", 91);
  check_descriptions("schemas/scene.schema.json", 180);
  check_descriptions("../cli/batch/jobs.schema.json", 11);
}

TEST_CASE("scene and pipeline files may name their schema, by a string") {
  CHECK(pipeline_from_json(R"({"$schema": "pipeline.schema.json", "width": 7})", "p.json", Pipeline{}).width == 7);
  CHECK(scene_from_json(R"({"$schema": "https://example.org/scene.schema.json", "version": 1})", "s.json", {})
            .lights.empty());
  CHECK_STARTS_WITH(
      error_of(ErrorKind::bad_input, [] { pipeline_from_json(R"({"$schema": 7})", "p.json", Pipeline{}); }),
      "p.json: /$schema: ");
  CHECK_STARTS_WITH(error_of(ErrorKind::bad_input, [] { scene_from_json(R"({"$schema": {}})", "s.json", {}); }),
                    "s.json: /$schema: ");
}

TEST_CASE("a schema names the other beside it") {
  const json::Value value = schema("schemas/scene.schema.json");
  const json::Node root(value, "scene.schema.json"), properties = root.member("properties");
  const std::string file = properties.member("pipeline").member("$ref").string();
  CHECK(schema("schemas/" + file).is.index() != 0);
}

TEST_CASE("the pipeline schema lists the presets that exist") {
  const json::Value value = schema("schemas/pipeline.schema.json");
  const json::Node root(value, "pipeline.schema.json"),
      properties = root.member("properties"), preset = properties.member("preset"), names = preset.member("enum");
  REQUIRE(names.array(1, 100).size() == presets().size());
  for (size_t i = 0; i < presets().size(); ++i) CHECK(names.element(i).string() == std::string(presets()[i].name));
}

}  // namespace
}  // namespace trueshade
