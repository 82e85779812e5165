// What the command says of a picture that shows less than its maker may expect, and refusals that once were riddles.
#include <nlohmann/json.hpp>

#include "core/image_files/image_io.h"
#include "tests/catch.hpp"
#include "tests/cli/refused.h"
#include "tests/cli/run_command.h"
#include "tests/file_contents.h"
#include "tests/scratch_folder.h"
#include "tests/text_parts.h"

namespace trueshade {
namespace {

/// What is said of a scene that consists of a cube, these members, and more options.
std::string said_of(const std::string& members, const Arguments& more = {}) {
  const ScratchFolder folder;
  folder.write("s.json", R"({"version": 1, "objects": [{"mesh": "cube"}], )" + members + "}");
  Arguments arguments{"render", "s.json", "--size", "16x12", "--hash"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const Outcome outcome = run_command(arguments, folder.path(""));
  INFO(outcome.err);
  REQUIRE(outcome.exit_code == 0);
  return outcome.err;
}

const std::string kLamp =
    R"("lights": [{"type": "point", "position": [0, 2, 4], "range": 9, "color": [0.5, 0.5, 0.5]}])";

TEST_CASE("A black picture says why: no lights, none that reaches, nothing in view, a singular matrix") {
  CHECK(said_of(kLamp).empty());
  CHECK(has(said_of(R"("lights": [])"), "note: The picture is black: The scene has no lights"));
  CHECK(has(said_of(R"("lights": [{"type": "point", "position": [0, 90, 0], "range": 1}])"),
            "note: The picture is black: None of its 1 lights brightens a surface"));
  CHECK(has(said_of(R"("lights": [{"type": "rectangle", "position": [0, 3, 0], "right": [1, 0, 0], "up": [0, 0, 1],
                        "range": 9}])"),
            "rectangles and disks shine to one side, cross(up, right)"));
  CHECK(has(said_of(kLamp + R"(, "camera": {"eye": [0, 0, 5], "target": [0, 0, 10]})"),
            "note: Nothing is drawn: None of 12 triangles covers a pixel"));
  for (const char* singular : {"[0,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]", "[1,1,0,0, 1,1,0,0, 0,0,1,0, 0,0,0,1]"})
    CHECK(has(said_of(kLamp + R"(, "camera": {"eye": [0, 0, 5], "clip_from_world": )" + singular + "}"),
              "The matrix clip_from_world of the camera is singular, or nearly"));
  // An orthographic matrix that looks past the cube is regular, and small elements alone are no reason.
  const std::string past = said_of(
      kLamp + R"(, "camera": {"eye": [0, 0, 5], "clip_from_world": [1e-4,0,0,0, 0,1e-4,0,0, 0,0,1e-4,0, 9,0,0,1]})");
  CHECK(has(past, "None of 12 triangles covers a pixel"));
}

TEST_CASE("A black picture says why in JSON and on the page too, and views that show no light do not") {
  const ScratchFolder folder;
  folder.write("s.json", R"({"version": 1, "objects": [{"mesh": "cube"}], "lights": []})");
  const Outcome outcome =
      run_command({"render", "s.json", "--size", "16x12", "--json", "-o", "x.html"}, folder.path(""));
  REQUIRE(outcome.exit_code == 0);
  CHECK(has(nlohmann::json::parse(outcome.out)["notes"].dump(), "The scene has no lights"));
  CHECK(has(contents(folder.path("x.html")), "The scene has no lights"));
  CHECK(said_of(R"("lights": [])", {"--view", "albedo"}).empty());
}

TEST_CASE("Pixels at the largest value of the target are counted, and of a float target those that a PNG cuts off") {
  const std::string bright =
      R"("lights": [{"type": "point", "position": [0, 2, 4], "range": 9, "color": [90, 90, 90]}])";
  const std::string said = said_of(bright, {"--target", "rgba8"});
  CHECK(has(said, " pixels with a surface have a channel at 1, the largest value of rgba8: Brighter light is cut off"));
  CHECK(has(said, "--target rgba16f"));
  CHECK(has(said_of(bright, {"--target", "rgb10_a2"}), "the largest value of rgb10_a2"));
  CHECK(said_of(bright, {"--target", "rgba16f"}).empty());
  CHECK_FALSE(has(said_of(bright, {"--target", "rgba16f", "-o", "x.exr"}), "largest value"));
  CHECK(has(said_of(bright, {"--target", "rgba16f", "-o", "x.png"}),
            " pixels with a surface have a channel above 1, the "));
  CHECK_FALSE(has(said_of(kLamp, {"--target", "rgba16f", "-o", "x.png"}), "largest value"));
  CHECK_FALSE(has(said_of(kLamp), "largest value"));
}

TEST_CASE("A white background is not counted among the pixels that are cut off") {
  const std::string bright =
      R"("lights": [{"type": "point", "position": [0, 2, 4], "range": 9, "color": [90, 90, 90]}])";
  const std::string small = R"(, "camera": {"eye": [0, 0, 9], "target": [0, 0, 0]})";
  const auto noted = [](const std::string& said) {
    const size_t end = said.find(" pixels with a surface have a channel");
    return end == std::string::npos ? "" : said.substr(said.rfind(": ", end) + 2, end - said.rfind(": ", end) - 2);
  };
  for (const char* target : {"rgba8", "srgb8_a8", "rgb10_a2"})
    for (const char* samples : {"1", "4"}) {
      INFO(target << ' ' << samples);
      const Arguments dark{"--target", target, "--samples", samples};
      Arguments white = dark;
      white.insert(white.end(), {"--background", "white"});
      CHECK_FALSE(has(said_of(kLamp + small, white), "largest value"));
      const std::string counted = noted(said_of(bright + small, dark));
      CHECK_FALSE(counted.empty());
      if (std::string(samples) == "1") CHECK(counted == noted(said_of(bright + small, white)));
    }
}

TEST_CASE("Averaged samples that are cut off are counted too") {
  const std::string bright =
      R"("lights": [{"type": "point", "position": [0, 2, 4], "range": 9, "color": [90, 90, 90]}])";
  CHECK(has(said_of(bright, {"--target", "rgba8", "--samples", "4"}), "the largest value of rgba8"));
  CHECK(has(said_of(bright, {"--target", "rgba16f", "--samples", "4", "-o", "x.png"}), "have a channel above 1"));
}

TEST_CASE("A model's camera that sees next to nothing, or has another shape than the picture, is told of") {
  const ScratchFolder folder;
  const auto said = [&folder](const std::string& camera, const std::string& size, const std::string& away) {
    folder.write("m.gltf", R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
      "nodes": [{"mesh": 0}, {"camera": 0, "translation": [0, 0, )" +
                               away + R"(]}],
      "cameras": [)" + camera +
                               R"(],
      "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
      "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                     "min": [0, 0, 0], "max": [1, 1, 0]}],
      "bufferViews": [{"buffer": 0, "byteLength": 36}],
      "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,)"
                               R"(AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})");
    const Outcome outcome = run_command({"render", "m.gltf", "--size", size, "--hash"}, folder.path(""));
    INFO(outcome.err);
    REQUIRE(outcome.exit_code == 0);
    return outcome.err;
  };
  const std::string perspective = R"({"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1}})",
                    wide =
                        R"({"type": "orthographic", "orthographic": {"xmag": 2, "ymag": 1, "znear": 0, "zfar": 99}})";
  CHECK(has(said(perspective, "160x120", "60"), "note: The camera sees next to nothing: "));
  CHECK_FALSE(has(said(perspective, "160x120", "3"), "next to nothing"));
  CHECK(has(said(wide, "160x160", "3"),
            "orthographic camera has another shape than the picture, so that all is stretched (--size 160x80 has"));
  CHECK(has(said(wide, "160x40", "3"), "(--size 160x80 has"));
  CHECK_FALSE(has(said(wide, "160x80", "3"), "stretched"));
  CHECK_FALSE(has(said(perspective, "160x40", "3"), "stretched"));
}

TEST_CASE("Lights whose volumes hold the eye are counted where back faces are culled, and nowhere else") {
  const auto said = [](const Arguments& more) {
    Arguments arguments{"render", "builtin:sphere", "--size", "16x12", "--hash"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_command(arguments).err;
  };
  CHECK(has(said({"--preset", "redsdk"}), "note: 33 lights are not drawn: The eye is inside the volume of each"));
  CHECK_FALSE(has(said({"--preset", "redsdk", "--strategy", "deferred-loop"}), "not drawn"));
  CHECK_FALSE(has(said({"--preset", "light-volumes"}), "not drawn"));
  const ScratchFolder folder;
  folder.write("front.json", R"({"light_volumes": {"cull_face": "front"}})");
  CHECK_FALSE(has(said({"--preset", "redsdk", "--pipeline", folder.path("front.json")}), "not drawn"));
}

TEST_CASE("A view of boxes says how many boxes hold the eye") {
  const std::string about = R"("lights": [{"type": "point", "position": [0, 0, 4], "range": 9}],
      "camera": {"eye": [0, 0, 5]})";
  CHECK(has(said_of(about, {"--view", "light-boxes"}), "note: 1 box is not shown: The eye is inside"));
  CHECK_FALSE(has(said_of(about, {"--view", "normal"}), "not shown"));
  const std::string far = R"("lights": [{"type": "point", "position": [0, 0, 4], "range": 0.5}],
      "camera": {"eye": [0, 0, 5]})";
  CHECK_FALSE(has(said_of(far, {"--view", "light-boxes"}), "not shown"));
}

TEST_CASE("The note about cones names a preset and a value that have one") {
  const std::string said = said_of(
      R"("lights": [{"type": "spot", "position": [0, 3, 0], "direction": [0, -1, 0], "cone_deg": 20, "range": 9}])");
  CHECK(has(said, "presets without this note: "));
  CHECK(has(said, "; or light_model.cone smooth_penumbra in a pipeline file)"));
}

TEST_CASE("The remedies that notes name leave nothing to note") {
  const ScratchFolder folder;
  folder.write("cone.json", R"({"light_model": {"cone": "smooth_penumbra"}})");
  CHECK_FALSE(has(said_of(R"("lights": [{"type": "spot", "position": [0, 3, 4], "direction": [0, -1, 0], "cone_deg": 80,
                             "range": 9}])",
                          {"--pipeline", folder.path("cone.json")}),
                  "cone_deg"));
}

TEST_CASE("Names of frames that would be written twice are refused before anything is loaded") {
  const ScratchFolder folder;
  const auto refused = [&](const Arguments& names, const std::string& about) {
    Arguments arguments{"render", "absent.json", "--frames", "0-20"};
    for (const std::string& name : names) arguments.insert(arguments.end(), {"-o", name});
    check_refused(run_command(arguments, folder.path("")), 2, about);
  };
  refused({"a.png", "a.####.png"}, "two frames or two outputs would be written to 'a.0000.png'");
  refused({"1%d.png", "%d.png"}, "would be written to '10.png'");
  check_refused(
      run_command({"render", "absent.json", "--frames", "0-20", "-o", "a.png", "-o", "b.png"}, folder.path("")), 5,
      "absent.json");
}

TEST_CASE("An encoding without a PNG is refused by a text about the outputs that are there") {
  check_refused(run_command({"render", "absent.json", "--encode", "srgb", "-o", "x.html"}), 2,
                "no -o names a PNG: an EXR holds the target's values, and a report shows them");
}

TEST_CASE("A scene without a name is refused by its option") {
  check_refused(run_command({"render", "", "--hash"}), 2, "SCENE: its name is empty");
  for (const char* command : {"info", "validate", "bench"})
    check_refused(run_command({command, ""}), 2, "SCENE: its name is empty");
}

TEST_CASE("Quiet, the command says neither notes nor files, and errors all the same") {
  const ScratchFolder folder;
  const Outcome quiet = run_command(
      {"render", "builtin:sphere", "--preset", "redsdk", "--size", "16x12", "-o", "x.png", "--quiet"}, folder.path(""));
  CHECK(quiet.exit_code == 0);
  CHECK((quiet.out + quiet.err).empty());
  CHECK(read_planes(folder.path("x.png"))[0].image.width == 16);
  check_refused(run_command({"render", "absent.json", "-o", "x.png", "-q"}, folder.path("")), 5, "absent.json");
}

TEST_CASE("The command help names commands and their options") {
  CHECK(run_command({"help"}).out == run_command({"--help"}).out);
  CHECK(run_command({"help", "render"}).out == run_command({"render", "--help"}).out);
  // A line of help may be broken between any two words.
  const auto one_line = [](const char* command) {
    std::string text;
    for (const char c : run_command({"help", command}).out)
      if ((c != ' ' && c != '\n') || !text.ends_with(' ')) text += c == '\n' ? ' ' : c;
    return text;
  };
  CHECK(has(one_line("render"), "light.<i> (i counts lights from 0)"));
  for (const char* command : {"explain", "validate"}) CHECK(has(one_line(command), " counted from 0, in the scene's"));
  check_refused(run_command({"help", "rendr"}), 2, "there is no command 'rendr'");
}

TEST_CASE("info reads a PNG whole, and refuses one with a damaged byte anywhere in its picture") {
  const ScratchFolder folder;
  Image image(40, 30, Format::rgba8);
  for (size_t i = 0; i < image.texels.size(); ++i) image.texels[i] = uint8_t(i * i >> 5);
  const std::vector<uint8_t> png = encode_png(image, {});
  const auto about = [&](const std::vector<uint8_t>& bytes) {
    write_file(folder.path("x.png"), bytes);
    return run_command({"info", "x.png"}, folder.path(""));
  };
  CHECK(has(about(png).out, "pixels                read whole, all checksums right\n"));
  for (const size_t at : {png.size() / 2, png.size() / 3, png.size() - 30}) {
    std::vector<uint8_t> damaged = png;
    damaged[at] ^= 1;
    check_refused(about(damaged), 3, "x.png");
  }
}

TEST_CASE("What is so with every model file is said in docs, and what is so with this one in a note") {
  const ScratchFolder folder;
  folder.write("m.mtl", "newmtl m\nKa 1 1 1\nKd 0.5 0.5 0.5\nKs 1 1 1\nNs 10\nNi 1.5\nTf 1 1 1\nillum 2\n");
  folder.write("m.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n");
  folder.write("m.gltf", R"({"asset": {"version": "2.0"}, "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0],
                   "max": [1, 1, 0]}], "bufferViews": [{"buffer": 0, "byteLength": 36}],
    "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,)"
                         R"(AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})");
  folder.write(
      "s.json",
      R"({"version": 1, "objects": [{"geometry": "m.obj"}], "lights": [{"type": "ambient", "color": [0.2, 0.2, 0.2]}]})");
  const auto said = [&](const std::string& scene, Arguments more = {}) {
    more.insert(more.begin(), {"render", scene, "--size", "16x12", "-o", "a.png"});
    const Outcome outcome = run_command(more, folder.path(""));
    CHECK(outcome.exit_code == 0);
    return outcome;
  };
  for (const char* model : {"m.obj", "m.gltf"}) CHECK(!has(said(model).err, "note:"));
  CHECK(has(said("m.gltf", {"--target", "rgba16f"}).err, "note: The target rgba16f holds linear light"));
  CHECK(has(said("s.json").err, "note: 1 material states shininess, which is ignored"));
  CHECK(has(said("m.obj", {"--preset", "punctual"}).err, "note: The target rgba16f holds linear light"));
  const auto ignored = nlohmann::json::parse(said("m.obj", {"--json"}).out)["ignored"];
  CHECK(ignored.dump().find("shininess") != std::string::npos);
}

TEST_CASE("No note advises an exposure where one was given") {
  const std::string bright =
      R"("lights": [{"type": "point", "position": [0, 2, 4], "range": 9, "color": [50, 50, 50]}])";
  CHECK(has(said_of(bright), "--target rgba16f keeps it, and --exposure auto brings it into range)"));
  CHECK(has(said_of(bright, {"--exposure", "0"}), "--target rgba16f keeps it)"));
}

}  // namespace
}  // namespace trueshade
