// What a glTF file is drawn by where nothing is said, as users meet it.
#include <nlohmann/json.hpp>

#include "tests/catch.hpp"
#include "tests/cli/run_command.h"
#include "tests/scratch_folder.h"
#include "tests/text_parts.h"

namespace trueshade {
namespace {

using nlohmann::json;

/// Two triangles, rough and half metal, without lights and without a camera.
constexpr const char* kHalfMetal = R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
  "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
  "materials": [{"doubleSided": true, "pbrMetallicRoughness":
                 {"baseColorFactor": [0.9, 0.6, 0.3, 1], "metallicFactor": 0.5, "roughnessFactor": 0.6}}],
  "accessors": [{"bufferView": 0, "componentType": 5126, "count": 6, "type": "VEC3",
                 "min": [-1, 0, 0], "max": [1, 1.5, 1]}],
  "bufferViews": [{"buffer": 0, "byteLength": 72}],
  "buffers": [{"byteLength": 72, "uri": "data:application/octet-stream;base64,AACAvwAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAA)"
                                   R"(wD8AAAAAAACAvwAAAAAAAAA/AAAAAAAAwD8AAAAAAAAAP83MTD4AAIA/"}]})";

class Model {
 public:
  Model() { folder_.write("model.gltf", kHalfMetal); }
  void write(const std::string& name, const std::string& text) const { folder_.write(name, text); }
  Outcome run(const std::vector<std::string>& arguments) const { return run_command(arguments, folder_.path("")); }
  Outcome render(const std::vector<std::string>& more) const {
    std::vector<std::string> all{"render", "model.gltf", "--size", "48x36"};
    all.insert(all.end(), more.begin(), more.end());
    const Outcome outcome = run(all);
    INFO(outcome.err);
    REQUIRE(outcome.exit_code == 0);
    return outcome;
  }
  std::string hash(const std::vector<std::string>& more) const {
    std::vector<std::string> all{"--hash", "-q"};
    all.insert(all.end(), more.begin(), more.end());
    return render(all).out;
  }

 private:
  ScratchFolder folder_;
};

}  // namespace

TEST_CASE("A glTF file without a preset is drawn by gltf, and by punctual where that is named") {
  const Model model;
  const json pipeline = json::parse(model.render({"--json"}).out)["pipeline"];
  CHECK(pipeline["preset"] == "gltf");
  CHECK(pipeline["light_program"]["file"] == "gltf");
  CHECK(pipeline["geometry"]["cull_face"] == "back");
  const std::string drawn = model.hash({"--samples", "1"});
  CHECK(model.hash({"--preset", "gltf"}) == drawn);
  CHECK(model.hash({"--light-shader", "gltf", "--samples", "1"}) == drawn);
  model.write("same.json", pipeline.dump());
  CHECK(model.hash({"--pipeline", "same.json"}) == model.hash({}));
  model.write("named.json", R"({"preset": "gltf", "geometry": {"cull_face": "back"}})");
  CHECK(model.hash({"--pipeline", "named.json"}) == drawn);
  const std::string punctual = model.hash({"--preset", "punctual"});
  CHECK(punctual != drawn);
  model.write("punctual.json", R"({"preset": "punctual"})");
  CHECK(model.hash({"--pipeline", "punctual.json"}) == punctual);
  CHECK(model.hash({"--light-shader", "ue4"}) != drawn);
}

TEST_CASE("A light_model that a pipeline states draws a glTF file in place of the program, and a note says so") {
  const Model model;
  model.write("half.json", R"({"light_model": {"damping": 0.5}})");
  const Outcome stated = model.render({"--hash", "--pipeline", "half.json"});
  CHECK(has(stated.err, "in place of the light program of the preset gltf"));
  CHECK(stated.out == model.hash({"--preset", "punctual", "--pipeline", "half.json"}));
}

TEST_CASE("A picture that the preset gltf lit is judged by the scene that it names") {
  const Model model;
  for (const char* way : {"toward_zero", "nearest"}) {
    model.write("pipeline.json", std::string(R"({"gbuffer": {"half_round": ")") + way + "\"}}");
    model.render({"--pipeline", "pipeline.json", "-q", "-o", std::string(way) + ".exr", "--aov",
                  "depth,position,normal,albedo,specular,emission,id.object,id.material"});
  }
  CHECK(model.run({"compare", "toward_zero.exr", "nearest.exr", "--no-judge"}).exit_code == 1);
  const Outcome judged = model.run({"compare", "toward_zero.exr", "nearest.exr"});
  INFO(judged.out << judged.err);
  CHECK(judged.exit_code == 0);
  CHECK(has(judged.out, "verdict     judged by the reference's scene: every pixel is explained; "));
}

}  // namespace trueshade
