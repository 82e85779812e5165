// --light-shader as users meet it: what it draws, what it says, what it refuses.
#include <nlohmann/json.hpp>

#include "core/sha256.h"
#include "scenes/pipeline/shipped_models.h"
#include "tests/catch.hpp"
#include "tests/cli/run_command.h"
#include "tests/scratch_folder.h"
#include "tests/text_parts.h"

namespace trueshade {
namespace {

const ScratchFolder& shaders() {
  static const ScratchFolder made;
  return made;
}

Outcome run(std::vector<std::string> arguments) { return run_command(arguments, shaders().path("")); }

}  // namespace

TEST_CASE("A light program draws, and the picture says which and with what parameters") {
  shaders().write("dim.glsl", R"(layout(std140) uniform Parameters { float gain; vec3 tint; };
vec3 light(Surface s, Light l, View v) { return gain * tint * s.albedo.rgb * l.color / 100.0; })");
  const std::vector<std::string> given{"render",
                                       "builtin:cornell",
                                       "--size",
                                       "32x24",
                                       "--light-shader",
                                       "dim.glsl",
                                       "--light-parameter",
                                       "gain=2",
                                       "--light-parameter",
                                       "tint=1,0.5,0.25",
                                       "--json",
                                       "-o",
                                       "dim.png"};
  const Outcome drawn = run(given);
  CHECK(drawn.exit_code == 0);
  CHECK(has(drawn.out, R"("light_program":{"file":"dim.glsl","sha256":")"));
  CHECK(has(drawn.out, R"({"name":"tint","value":[1,0.5,0.25]})"));
  CHECK(has(drawn.err, "end at their range"));  // it has no window
  CHECK(run({"render", "builtin:cornell", "--size", "32x24", "-o", "preset.png", "-q"}).exit_code == 0);
  const Outcome compared = run({"compare", "dim.png", "preset.png"});
  CHECK(compared.exit_code == 1);
  CHECK(has(compared.out + compared.err, "light program"));
}

TEST_CASE("A model's light by a program that goes into a PNG as codes is told of, unless an option asks for it") {
  shaders().write("tri.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1\n");
  const auto told = [](std::vector<std::string> more) {
    more.insert(more.begin(), {"render", "tri.obj", "--size", "16x12", "--light-shader", "gltf"});
    const Outcome outcome = run(more);
    CHECK(outcome.exit_code == 0);
    return has(outcome.err, "is shown as codes of rgba8");
  };
  CHECK(told({"-o", "t.png"}));
  CHECK_FALSE(told({"-o", "t.png", "--target", "rgba8"}));
  CHECK_FALSE(told({"-o", "t.png", "--target", "rgba16f"}));
  CHECK_FALSE(told({"--hash"}));
}

TEST_CASE("What is wrong with a light program is said with its place or its option") {
  shaders().write("wrong.glsl", "vec3 light(Surface s, Light l, View v) {\n  return s.normals;\n}\n");
  const std::vector<std::string> frame{"render", "builtin:cornell", "--size", "32x24", "--hash"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), frame.begin(), frame.end());
    return run(more);
  };
  const Outcome wrong = with({"--light-shader", "wrong.glsl"});
  CHECK(wrong.exit_code == 3);
  CHECK(has(wrong.err, "wrong.glsl:2"));
  shaders().write("needs.glsl",
                  "layout(std140) uniform Parameters { float gain; };\n"
                  "vec3 light(Surface s, Light l, View v) { return vec3(gain); }\n");
  const Outcome needs = with({"--light-shader", "needs.glsl"});
  CHECK(needs.exit_code == 2);
  CHECK(has(needs.err, "parameters.gain"));
  CHECK(with({"--light-shader", "needs.glsl", "--light-parameter", "gain=much"}).exit_code == 2);
  CHECK(with({"--light-parameter", "gain=1"}).exit_code == 2);
  shaders().write("empty.glsl", "");
  CHECK(with({"--light-shader", "empty.glsl"}).exit_code == 3);
  CHECK(with({"--light-shader", "absent.glsl"}).exit_code == 5);
  shaders().write("version.glsl", "#version 450\nvec3 light(Surface s, Light l, View v) { return vec3(1); }\n");
  shaders().write("marked.glsl", "\xEF\xBB\xBFvec3 light(Surface s, Light l, View v) { return vec3(1); }\n");
  const auto drawn_by = [](const std::string& command, const std::string& file) {
    std::vector<std::string> words{command, "builtin:cornell", "--light-shader", file};
    if (command == "explain") words.insert(words.end(), {"--pixel", "9,9"});
    if (command == "render" || command == "glsl") words.insert(words.end(), {"-o", command + ".png"});
    return run(words);
  };
  for (const char* const command : {"render", "glsl"}) {
    const Outcome version = drawn_by(command, "version.glsl");
    CHECK(version.exit_code == 3);
    CHECK(has(version.err, "version.glsl:1:"));
    CHECK(has(version.err, "leave the line out"));
    const Outcome marked = drawn_by(command, "marked.glsl");
    CHECK(marked.exit_code == 3);
    CHECK(has(marked.err, "marked.glsl:1:1: begins with a byte order mark"));
  }
  shaders().write("taken.glsl",
                  "\nconst float base = 0.5;\nvec3 light(Surface s, Light l, View v) { return vec3(base); }\n");
  for (const char* const command : {"render", "glsl", "validate", "explain"}) {
    const Outcome taken = drawn_by(command, "taken.glsl");
    INFO(command << taken.err);
    CHECK(taken.exit_code == 3);
    CHECK(has(taken.err, "taken.glsl:2"));
  }
  const Outcome outside = with({"--light-shader", "toon", "--light-parameter", "steps=0.5"});
  CHECK(outside.exit_code == 2);
  CHECK(has(outside.err, "(from 1)"));
  CHECK(with({"--light-shader", "toon", "--hash"}).out ==
        with({"--light-shader", "toon", "--light-parameter", "steps=4", "--hash"}).out);
  shaders().write("zeros.spv", std::string("\x03\x02\x23\x07", 4) + std::string(64, '\0'));
  CHECK(with({"--light-shader", "zeros.spv"}).exit_code == 3);
}

TEST_CASE("A pipeline that names a light program is drawn by that text alone") {
  shaders().write("one.glsl", "vec3 light(Surface s, Light l, View v) { return vec3(0.25); }\n");
  shaders().write("other.glsl", "vec3 light(Surface s, Light l, View v) { return vec3(0.5); }\n");
  shaders().write("named.json", R"({"light_program":{"file":"one.glsl","sha256":"00"}})");
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"render", "builtin:cornell", "--size", "32x24", "--hash", "--pipeline", "named.json"});
    return run(more);
  };
  CHECK(with({}).exit_code == 2);
  const Outcome other = with({"--light-shader", "other.glsl"});
  CHECK(other.exit_code == 3);
  CHECK(has(other.err, "SHA-256"));
}

TEST_CASE(
    "A light ends at its range under a program, wherever its preset is named, unless light_volumes says otherwise") {
  shaders().write("endless.glsl", "vec3 light(Surface s, Light l, View v) { return vec3(0.25); }\n");
  const auto hash = [&](const std::string& pipeline, std::vector<std::string> more = {}) {
    shaders().write(
        "near.json",
        R"({"version": 1, "camera": {"eye": [0, 1, 4], "target": [0, 0, 0]}, "objects": [{"mesh": "sphere"}],
      "lights": [{"type": "point", "position": [0, 2, 2], "range": 2.2}])" +
            pipeline + "}");
    more.insert(more.begin(), {"render", "near.json", "--size", "32x24", "--hash", "--light-shader", "endless.glsl"});
    return run(more).out;
  };
  const std::string ended = hash("");
  CHECK_FALSE(ended.empty());
  CHECK(hash(R"(, "pipeline": {"preset": "many-lights"})") == ended);
  CHECK(hash("", {"--preset", "many-lights"}) == ended);
  const std::string stated = R"({"preset": "many-lights", "light_volumes": {"point": "unbounded"}})";
  CHECK(hash(", \"pipeline\": " + stated) != ended);
  shaders().write("stated.json", stated);
  CHECK(hash("", {"--pipeline", "stated.json"}) == hash(", \"pipeline\": " + stated));
}

TEST_CASE("A light model that ships is drawn by its name, and the picture says which text that was") {
  const std::vector<std::string> frame{"render", "builtin:cornell", "--size", "32x24"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), frame.begin(), frame.end());
    return run(more);
  };
  const ShippedModel& gltf = shipped_model("gltf");
  shaders().write("copy.glsl", std::string(gltf.text));
  const Outcome named = with({"--light-shader", "gltf", "--json", "-o", "named.png"});
  CHECK(named.exit_code == 0);
  CHECK(has(named.out, R"("light_program":{"file":"gltf","sha256":")" + sha256_of(gltf.text) + '"'));
  CHECK(with({"--light-shader", "copy.glsl", "-o", "copy.png"}).exit_code == 0);
  CHECK(run({"compare", "named.png", "copy.png"}).exit_code == 0);
  shaders().write("gltf", "vec3 light(Surface s, Light l, View v) { return vec3(0.25); }\n");
  const Outcome shipped = with({"--light-shader", "gltf", "--hash"});
  CHECK(shipped.out == with({"--light-shader", "copy.glsl", "--hash"}).out);  // a name without a dot is no file's
  CHECK(shipped.out != with({"--light-shader", "./gltf", "--hash"}).out);
  shaders().write("of_name.json",
                  R"({"light_program":{"file":"gltf"},"light_volumes":{"point":"range","spot":"range"}})");
  CHECK(with({"--pipeline", "of_name.json", "--hash"}).out == shipped.out);
  const Outcome unknown = with({"--light-shader", "glft", "--hash"});
  CHECK(unknown.exit_code == 2);
  CHECK(has(unknown.err, "did you mean gltf?"));
  for (const ShippedModel& model : shipped_models()) CHECK(has(unknown.err, " " + std::string(model.name)));
  shaders().write("lacking.glsl",
                  "layout(std140) uniform Parameters { float steps; };  // from 1\n"
                  "vec3 light(Surface s, Light l, View v) { return s.albedo.rgb * steps; }\n");
  const Outcome lacking = with({"--light-shader", "lacking.glsl", "--hash"});
  CHECK(lacking.exit_code == 2);
  CHECK(has(lacking.err, "parameters.steps"));
}

TEST_CASE("list names the models that ship, and says of one what it reads, as it says of a file") {
  using nlohmann::json;
  const std::string names = run({"list"}).out;
  const json all = json::parse(run({"list", "--json"}).out);
  REQUIRE(all.at("light_models").size() == shipped_models().size());
  for (size_t i = 0; i < shipped_models().size(); ++i) {
    const ShippedModel& model = shipped_models()[i];
    CHECK(has(names, "  " + std::string(model.name) + ' '));
    CHECK(all.at("light_models")[i].at("name") == std::string(model.name));
    CHECK(all.at("light_models")[i].at("description") == std::string(model.about));
  }
  const auto facts = [](const std::string& name) { return json::parse(run({"list", name, "--json"}).out); };
  const json gltf = facts("gltf"), toon = facts("toon");
  CHECK(run({"list", "toon", "--text"}).out == std::string(shipped_model("toon").text));
  CHECK(run({"list", "many-lights", "--text"}).out == facts("many-lights").at("text").get<std::string>());
  CHECK(has(run({"render", "builtin:cornell", "--light-shader", "many-lights", "--hash"}).err, "--preset many-lights"));
  CHECK(gltf.at("sha256") == sha256_of(shipped_model("gltf").text));
  CHECK(gltf.at("parameters").empty());
  CHECK(gltf.at("defines") == json::array({"light", "start"}));
  CHECK(toon.at("parameters") == json::parse(R"([{"name": "steps", "type": "float", "range": "from 1", "usual": 4}])"));
  CHECK(toon.at("defines") == json::array({"light"}));
  const auto reads = [](const json& of, const char* field) {
    return std::count(of.at("reads").begin(), of.at("reads").end(), field) == 1;
  };
  for (const char* field : {"surface.position", "surface.normal", "surface.albedo", "light.type", "light.color"}) {
    INFO(field);
    CHECK(reads(gltf, field));
    CHECK(reads(toon, field));
  }
  CHECK(reads(gltf, "surface.roughness"));
  CHECK(reads(gltf, "view.eye"));
  CHECK_FALSE(reads(toon, "surface.roughness"));
  CHECK_FALSE(reads(toon, "view.eye"));
  for (const json& field : gltf.at("reads")) {  // fields of the three structures, without components
    const std::string name = field;
    CHECK((name.starts_with("surface.") || name.starts_with("light.") || name.starts_with("view.")));
    CHECK(std::count(name.begin(), name.end(), '.') == 1);
  }
  const std::string text = run({"list", "toon"}).out;
  for (const char* line :
       {"toon: Cartoons", "\n  steps           float, from 1, usually 4\n", "\n  surface.normal\n", "\n  light\n"})
    CHECK(has(text, line));
  shaders().write("tinted.glsl",
                  "layout(std140) uniform Parameters { float x; vec3 tint; };\n"
                  "vec3 light(Surface s, Light l, View v) { return x * tint * s.albedo.rgb; }\n");
  CHECK(facts("tinted.glsl").at("parameters") ==
        json::parse(R"([{"name": "x", "type": "float"}, {"name": "tint", "type": "vec3"}])"));
  CHECK(facts("tinted.glsl").at("reads") == json::array({"surface.albedo"}));
  CHECK(run({"list", "glft"}).exit_code == 2);
}

TEST_CASE("A parameter that is given twice, or with too many numbers, is refused") {
  shaders().write("gain.glsl",
                  "layout(std140) uniform Parameters { float gain; };\n"
                  "vec3 light(Surface s, Light l, View v) { return gain * s.albedo.rgb; }\n");
  std::vector<std::string> given{"render",    "builtin:cornell",   "--size",   "8x8", "--light-shader",
                                 "gain.glsl", "--light-parameter", "gain=1,2", "-o",  "g.png"};
  const Outcome wide = run(given);
  CHECK(wide.exit_code == 2);
  CHECK(has(wide.err, "'gain' is a float, and 1,2 is given (give one number)"));
  given[7] = "gain=1";
  given.insert(given.end(), {"--light-parameter", "gain=2"});
  const Outcome twice = run(given);
  CHECK(twice.exit_code == 2);
  CHECK(has(twice.err, "'gain' is given twice"));
}

TEST_CASE("Parameters are held to their types, from options and from a pipeline's file") {
  shaders().write(
      "typed.glsl",
      "struct Lens { float near, far; };\n"
      "layout(std140) uniform Parameters { int count; uint seed; bool on; mat2 turn; float weight[2]; Lens lens; };\n"
      "vec3 light(Surface s, Light l, View v) {\n"
      "  vec2 t = turn * s.albedo.rg;\n"
      "  return on ? vec3(t, weight[0] + weight[1] * lens.far) * float(count + int(seed)) : vec3(0);\n}\n");
  const std::vector<std::pair<std::string, std::string>> right{
      {"count", "-2"},    {"seed", "3"},         {"on", "1"},        {"turn[0]", "1,0"},
      {"turn[1]", "0,1"}, {"weight[0]", "0.25"}, {"weight[1]", "2"}, {"lens.far", "0.5"}};
  const auto drawn = [&](const std::string& name, const std::string& value, bool by_file) {
    std::vector<std::string> words{"render", "builtin:cornell", "--size",    "16x12",
                                   "--hash", "--light-shader",  "typed.glsl"};
    std::string json;
    for (const auto& [own, number] : right) {
      const std::string given = own == name ? value : number;
      if (!by_file) words.insert(words.end(), {"--light-parameter", own + "=" + given});
      json += (json.empty() ? "" : ",") + (R"({"name":")" + own + R"(","value":[)" + given + "]}");
    }
    shaders().write("typed.json", R"({"light_program":{"file":"typed.glsl","parameters":[)" + json + "]}}");
    if (by_file) words.insert(words.end(), {"--pipeline", "typed.json"});
    return run(words);
  };
  const Outcome by_options = drawn("", "", false), by_file = drawn("", "", true);
  INFO(by_options.err << by_file.err);
  CHECK(by_options.exit_code == 0);
  CHECK(by_file.exit_code == 0);
  CHECK(by_options.out == by_file.out);
  for (const bool file : {false, true}) {
    const auto refused = [&](const std::string& name, const std::string& value, const std::string& type) {
      const Outcome outcome = drawn(name, value, file);
      INFO(outcome.err);
      CHECK(outcome.exit_code == 2);
      CHECK(has(outcome.err, "'" + name + "' is a" + type + ", and " + value + " is given"));
    };
    refused("count", "1.5", "n int");
    refused("seed", "-1", " uint");
    refused("on", "0.5", " uint");
    refused("turn[1]", "1,2,3", " vec2");
    refused("weight[1]", "1,2", " float");
    refused("lens.far", "1,2,3,4", " float");
  }
  const Outcome whole =
      run({"render", "builtin:cornell", "--hash", "--light-shader", "typed.glsl", "--light-parameter", "turn=1,0,0,1"});
  CHECK(whole.exit_code == 2);
  CHECK(has(whole.err, "'turn' of typed.glsl is given by its parts (vec2 turn[0], vec2 turn[1])"));
}

TEST_CASE("A verdict says of how many pixels nothing can be said") {
  shaders().write("lost.glsl", "vec3 light(Surface s, Light l, View v) { return vec3(sqrt(-1.0 - s.albedo.r)); }\n");
  const Outcome drawn = run({"render", "builtin:cornell", "--size", "16x12", "-o", "any.exr", "--aov",
                             "depth,position,normal,albedo,id.object"});
  CHECK(drawn.exit_code == 0);
  const Outcome judged = run({"validate", "builtin:cornell", "--size", "16x12", "--light-shader", "lost.glsl",
                              "--gbuffer", "any.exr", "--quick"});
  CHECK(has(judged.out, "UNDEFINED, of which nothing can be said"));
}

}  // namespace trueshade
