// What a new user runs into in the first hour: each case is something that once went wrong without a word.
#include <chrono>
#include <nlohmann/json.hpp>

#include "tests/catch.hpp"
#include "tests/cli/refused.h"
#include "tests/cli/run_command.h"
#include "tests/file_contents.h"
#include "tests/scratch_folder.h"
#include "tests/text_parts.h"

namespace trueshade {
namespace {

/// Draws s.json of a folder, small, with more arguments.
Outcome drawn(const ScratchFolder& folder, const Arguments& more) {
  Arguments arguments{"render", "s.json", "--size", "16x12"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  Outcome outcome = run_command(arguments, folder.path(""));
  INFO(outcome.err);
  REQUIRE(outcome.exit_code == 0);
  return outcome;
}

constexpr const char* kStatesMuch = R"({"version": 1, "camera": {"eye": [0, 1, 5]},
  "textures": [{"name": "t", "pattern": {"type": "checker"}}],
  "materials": [{"name": "m", "color": [1, 1, 1, 0.5], "emission": [1, 0, 0], "shininess": 8, "metallic": 0.5,
                 "roughness": 0.5, "specular_color": [1, 1, 1], "specular_map": {"texture": "t"}, "normal_scale": 2}],
  "objects": [{"mesh": "cube", "material": "m"}],
  "lights": [{"type": "spot", "position": [0, 3, 0], "direction": [0, -1, 0], "cone_deg": 20, "range": 9},
             {"type": "spot", "position": [1, 3, 0], "direction": [0, -1, 0], "cone_deg": 30, "spot_exponent": 2,
              "ambient": [1, 1, 1], "attenuation": [1, 0.5, 0]}]})";

}  // namespace

TEST_CASE("What lights and materials state and the pipeline ignores is named once, on standard error and in JSON") {
  const ScratchFolder folder;
  folder.write("s.json", kStatesMuch);
  const Outcome outcome = drawn(folder, {"--json", "--target", "rgba16f"});  // which clips no light
  const auto json = nlohmann::json::parse(outcome.out);
  std::string fields;
  for (const auto& field : json["ignored"]) {
    fields += field["of"].get<std::string>() + '.' + field["field"].get<std::string>() + '=' +
              std::to_string(field["count"].get<int>()) + ' ';
    CHECK(field["reason"].get<std::string>().size() > 20);
  }
  CHECK(fields ==
        "light.cone_deg=2 light.spot_exponent=1 light.attenuation=1 light.ambient=1 material.specular_color=1 "
        "material.shininess=1 material.specular_map=1 material.emission=1 material.metallic=1 material.roughness=1 "
        "material.normal_scale=1 material.color=1 ");
  CHECK(json["notes"].size() == json["ignored"].size());
  CHECK(count_of(outcome.err, "trueshade: note: ") == json["ignored"].size());
  CHECK(has(outcome.err, "note: 2 lights state cone_deg, which is ignored: The light model has no cone"));
}

TEST_CASE("Maps of materials and unlit surfaces that a pipeline does not read are named with the reason") {
  const ScratchFolder folder;
  const auto scene = [](const char* light) {
    return std::string(R"({"version": 1, "camera": {"eye": [0, 1, 5]},
      "textures": [{"name": "t", "pattern": {"type": "checker", "format": "rgba8"}}],
      "materials": [{"name": "m", "color": [1, 1, 1], "metallic_roughness_map": {"texture": "t"},
                     "emission_map": {"texture": "t"}, "occlusion_map": {"texture": "t"}},
                    {"name": "u", "color": [1, 1, 1], "unlit": true, "occlusion_strength": 0.5}],
      "objects": [{"mesh": "plane", "material": "m"}, {"mesh": "plane", "material": "u"}], "lights": [)") +
           light + "]}";
  };
  const auto ignored = [&](const char* light, const char* preset) {
    folder.write("s.json", scene(light));
    std::string fields;
    const Outcome outcome = drawn(folder, {"--json", "--preset", preset});
    const auto json = nlohmann::json::parse(outcome.out);
    for (const auto& field : json["ignored"]) fields += field["field"].get<std::string>() + ' ';
    return fields;
  };
  const char *lamp = R"({"type": "point", "position": [0, 3, 0]})", *sky = R"({"type": "ambient", "color": [1, 1, 1]})";
  CHECK(ignored(lamp, "many-lights") == "metallic_roughness_map emission_map occlusion_map occlusion_strength unlit ");
  CHECK(ignored(lamp, "punctual") == "occlusion_strength occlusion_map ");  // glTF has no ambient light
  CHECK(ignored(sky, "punctual") == "occlusion_strength ");
  CHECK(ignored(lamp, "gltf") == "occlusion_strength occlusion_map ");
  CHECK(ignored(sky, "gltf") == "occlusion_strength ");
  CHECK(ignored(sky, "gl-fixed") == "metallic_roughness_map occlusion_strength ");
}

TEST_CASE("A pipeline that reads what a scene states leaves nothing to note, and built-in scenes are quiet") {
  const ScratchFolder folder;
  folder.write("s.json", R"({"version": 1, "objects": [{"mesh": "cube"}],
    "lights": [{"type": "spot", "position": [0, 3, 0], "direction": [0, -1, 0], "cone_deg": 20, "range": 9}]})");
  CHECK(has(drawn(folder, {"--hash"}).err, "cone_deg"));
  CHECK_FALSE(has(drawn(folder, {"--hash"}).err, "range"));
  CHECK(drawn(folder, {"--hash", "--preset", "punctual"}).err.empty());
  CHECK(has(drawn(folder, {"--hash", "--preset", "gl-fixed"}).err, "1 light states range"));
  CHECK_FALSE(
      has(drawn(folder, {"--hash", "--preset", "redsdk"}).err, "ignored"));  // the extents of the lights read the range
  for (const char* preset : {"many-lights", "touchdesigner", "gl-fixed", "punctual", "gltf", "light-volumes"}) {
    INFO(preset);
    CHECK(run_command({"render", "builtin:circle", "--size", "8x8", "--hash", "--preset", preset}).err.empty());
  }
}

TEST_CASE("Maps of a mesh without texture coordinates draw a note") {
  const ScratchFolder folder;
  folder.write("s.json", R"({"version": 1, "textures": [{"name": "t", "pattern": {"type": "checker"}}],
    "materials": [{"name": "m", "color": [1, 1, 1], "color_map": {"texture": "t"}}],
    "objects": [{"mesh": "cube", "material": "m"}, {"mesh": "knot", "material": "m"}], "lights": []})");
  CHECK(has(drawn(folder, {"--hash"}).err,
            "1 material states maps, which is ignored: A mesh has no texture coordinates"));
}

TEST_CASE("A note is said once for all frames, and a validated scene has its notes too") {
  const ScratchFolder folder;
  folder.write("s.json", kStatesMuch);
  CHECK(count_of(drawn(folder, {"--frames", "0-3", "--hash"}).err, "cone_deg") == 1);
  drawn(folder, {"-o", "c.exr", "--aov", "depth,position,normal,albedo,id.object"});
  const Outcome judged =
      run_command({"validate", "s.json", "--gbuffer", "c.exr", "--quick", "--json"}, folder.path(""));
  INFO(judged.out << judged.err);
  CHECK(has(judged.err, "note: 2 lights state cone_deg"));
  CHECK(nlohmann::json::parse(judged.out)["ignored"].size() == 12);
}

TEST_CASE("A reflectance of 255 draws a note, one of 2 does not, and neither does a bright light") {
  const ScratchFolder folder;
  const auto said = [&](const std::string& color) {
    folder.write("s.json", R"({"version": 1, "materials": [{"name": "m", "color": )" + color +
                               R"(}], "objects": [{"mesh": "cube", "material": "m"}],
      "lights": [{"type": "point", "position": [0, 3, 0], "color": [255, 200, 100], "range": 9}]})");
    return drawn(folder, {"--hash", "--target", "rgba16f"}).err;
  };
  CHECK(has(said("[255, 200, 100]"), "note: 1 material has a colour above 16: Colours of scenes are linear"));
  CHECK(said("[2, 1, 1]").empty());
}

TEST_CASE("Views that show little say why, on standard error and in the report") {
  const ScratchFolder folder;
  const auto said = [&](const char* scene, const char* view) {
    return run_command({"render", scene, "--size", "40x30", "--view", view, "-o", "v.html"}, folder.path("")).err;
  };
  CHECK(has(said("builtin:cornell", "uv"), "note: The view uv shows 7 of 7 objects in black"));
  CHECK(has(contents(folder.path("v.html")), "The view uv shows 7 of 7 objects in black"));
  CHECK(has(said("builtin:city", "light-boxes"), "note: The view light-boxes is black on 100 % of what is drawn"));
  CHECK(has(contents(folder.path("v.html")), "--view light-edges shows their edges alone"));
  CHECK(has(said("builtin:lecture", "light-edges"), "shows the boxes of 14 of 15 lights"));
  CHECK(said("builtin:city", "light-edges").empty());
}

TEST_CASE("Every file that is written is named on standard output") {
  const ScratchFolder folder;
  const Arguments draw{"render", "builtin:cornell", "--size", "40x30",  "-o",    "x.png",
                       "-o",     "x.exr",           "-o",     "x.html", "--aov", "normal,id.object"};
  const Outcome plain = run_command(draw, folder.path(""));
  INFO(plain.err);
  CHECK(plain.err.empty());
  CHECK(plain.out.starts_with("wrote x.png (40x30 rgba8, PNG, "));
  CHECK(has(plain.out, "\nwrote x.exr (40x30 rgba8, EXR with planes normal id.object, "));
  CHECK(has(plain.out, "\nwrote x.html (40x30 rgba8, HTML report, "));
  CHECK(count_of(plain.out, "\n") == 3);
}

TEST_CASE("Where standard output carries an answer for programs, names of files go to standard error") {
  const ScratchFolder folder;
  for (const char* option : {"--hash", "--stats", "--json"}) {
    INFO(option);
    const Outcome answer =
        run_command({"render", "builtin:cornell", "--size", "8x8", "-o", "x.png", option}, folder.path(""));
    const Outcome alone = run_command({"render", "builtin:cornell", "--size", "8x8", option}, folder.path(""));
    CHECK(answer.err.starts_with("wrote x.png (8x8 rgba8, PNG, "));
    CHECK(count_of(answer.out, "\n") == count_of(alone.out, "\n"));
    CHECK_FALSE(has(answer.out, "wrote"));
  }
  // A picture that is sent to standard output itself is not torn by its own name.
  const Outcome piped = run_command({"render", "builtin:cornell", "--size", "8x8", "-o", "link.png"}, folder.path(""),
                                    "ln -s /dev/stdout link.png");
  CHECK(piped.exit_code == 0);
  CHECK(piped.out.starts_with("\x89PNG"));
  CHECK_FALSE(has(piped.out, "wrote"));
}

TEST_CASE("A mistake on the command line is found before the scene is even looked for") {
  const ScratchFolder folder;
  const auto refused = [&](Arguments arguments, int exit_code, const std::string& about) {
    check_refused(run_command(arguments, folder.path("")), exit_code, about);
  };
  refused({"render", "absent.json"}, 2, "nothing would come of it");
  refused({"render", "absent.json", "-o", "x.png", "--aov", "depth"}, 2, "EXR");
  folder.write("file", "no folder");
  refused({"render", "absent.json", "-o", "file/x.png"}, 5, "file/x.png");
  folder.write("torn.json", R"({"width": )");
  refused({"render", "absent.json", "--hash", "--pipeline", "torn.json"}, 3, "torn.json");
  refused({"render", "absent.json", "--hash", "--pipeline", "none.json"}, 5, "none.json");
  refused({"validate", "absent.json", "--gbuffer", "none.exr"}, 5, "none.exr");
  refused({"validate", "absent.json", "--pipeline", "none.json"}, 5, "none.json");
  refused({"bench", "absent.json", "--pipeline", "none.json"}, 5, "none.json");
  // A built-in scene has no pipeline of its own, so that all layers are known; this one takes seconds to make.
  folder.write("p.json", R"({"transparency": {"mode": "into-albedo"}})");
  const auto start = std::chrono::steady_clock::now();
  refused({"render", "builtin:red", "--hash", "--pipeline", "p.json", "--strategy", "forward-loop"}, 2, "into-albedo");
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::milliseconds(500));
}

TEST_CASE("An option that does not exist is named alone, with the one that was meant") {
  check_refused(run_command({"render", "builtin:cornell", "--sizes", "10x10", "--hash"}), 2,
                "--sizes: there is no such option (did you mean --size?");
  check_refused(run_command({"render", "builtin:cornell", "--hahs"}), 2, "did you mean --hash?");
  check_refused(run_command({"bench", "--jsn=x.json"}), 2, "--jsn: there is no such option (did you mean --json?");
  check_refused(run_command({"--versio"}), 2, "did you mean --version?");
  const Outcome far = run_command({"render", "builtin:cornell", "--translucent", "--hash"});
  check_refused(far, 2, "--translucent: there is no such option (`trueshade render --help`");
  check_refused(run_command({"render", "builtin:cornell", "twice", "--hash"}), 2, "'twice' is one argument too many");
}

}  // namespace trueshade
