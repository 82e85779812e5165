// `trueshade explain`: the last line is the pixel that render stores; what it refuses.
#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "core/image_files/image_io.h"
#include "tests/cli/drawn_capture.h"
#include "tests/cli/refused.h"
#include "tests/file_contents.h"
#include "tests/text_parts.h"

namespace trueshade {
namespace {

/// The last line of a text, without its line feed.
std::string last_line(const std::string& text) {
  const size_t end = text.size() - 1, begin = text.rfind('\n', end - 1);
  return text.substr(begin + 1, end - begin - 1);
}

/// What a PNG that render wrote holds at a pixel.
std::string codes_at(const std::string& path, int x, int y) {
  const Image image = read_planes(path).front().image;
  std::string text;
  for (int c = 0; c < 4; ++c) text += (c == 0 ? "" : ", ") + std::to_string(image.code(x, y, c));
  return text;
}

TEST_CASE("the last line of explain is the pixel that render stores, as text and as JSON") {
  const ScratchFolder folder;
  const Arguments how = {"builtin:lecture", "--preset", "redsdk", "--size", "80x60"};
  Arguments render = {"render"}, explain = {"explain"};
  render.insert(render.end(), how.begin(), how.end()), explain.insert(explain.end(), how.begin(), how.end());
  for (const char* word : {"-o", "a.png", "-q"}) render.emplace_back(word);
  REQUIRE(run_command(render, folder.path("")).exit_code == 0);
  for (const auto& [x, y] : {std::pair{0, 0}, {40, 30}, {79, 59}, {13, 44}}) {
    Arguments words = explain;
    words.insert(words.end(), {"--pixel", std::to_string(x) + ',' + std::to_string(y)});
    const Outcome told = run_command(words, folder.path(""));
    const std::string codes = codes_at(folder.path("a.png"), x, y);
    CHECK(told.exit_code == 0);
    CHECK(last_line(told.out) == "stored  " + codes + "  rgba8, R, G, B, A");
    words.emplace_back("--json");
    const auto document = nlohmann::json::parse(run_command(words, folder.path("")).out);
    const auto stored = document["values"]["stored"].get<std::vector<int>>();
    std::string in_json;
    for (const int code : stored) in_json += (in_json.empty() ? "" : ", ") + std::to_string(code);
    CHECK(in_json == codes);
  }
}

/// What is wrong with an explanation's own arithmetic: a sum that is not that of its terms, a draw that does not begin
/// where the one before ended.
std::string contradiction(const nlohmann::json& document) {
  std::vector<double> before;
  for (const auto& part : document["parts"]) {
    const std::string step = part["step"];
    if (step == "lights") {
      std::array<float, 3> sum{};
      for (size_t k = 0; k < 3; ++k) sum[k] = part["values"]["start"][k].get<float>();
      for (const auto& light : part["parts"]) {
        if (light["step"] == "light" && light["values"]["fate"] == "adds")
          for (size_t k = 0; k < 3; ++k) sum[k] += light["values"]["term"][k].get<float>();
        if (light["step"] == "sum" && light["values"]["sum"][1].get<float>() != sum[1]) return "a sum";
      }
    }
    if (step != "target") continue;
    for (const auto& draw : part["parts"]) {
      const auto& values = draw["values"];
      if (values.contains("before") && values["before"].get<std::vector<double>>() != before) return "a draw";
      before = values["after"].get<std::vector<double>>();
    }
  }
  return before == document["values"]["stored"].get<std::vector<double>>() ? "" : "the last draw";
}

TEST_CASE("what explain prints adds up: terms to the sum, draws one after the other to the stored pixel") {
  for (const char* strategy : {"forward-multipass", "forward-loop", "deferred-volumes", "deferred-loop"})
    for (const char* pixel : {"30,30", "50,41", "20,40"}) {
      const Outcome told =
          run_command({"explain", "builtin:cornell", "--preset", "light-volumes", "--strategy", strategy, "--target",
                       "rgba32f", "--size", "64x64", "--pixel", pixel, "--all", "--json"});
      INFO(strategy << ' ' << pixel << told.err);
      REQUIRE(told.exit_code == 0);
      CHECK(contradiction(nlohmann::json::parse(told.out)) == "");
    }
}

/// A program of six lines, and the words of a frame that it lights.
constexpr const char* kProgram = R"(layout(std140) uniform Parameters { float gain; };
vec3 light(Surface s, Light l, View v) {
  vec3 d = l.position - s.position;
  if (dot(d, s.normal) <= 0.0) return vec3(0.0);
  return s.albedo.rgb * l.color * (gain / (1.0 + dot(d, d)));
})";
Arguments lit_by_program(const char* command) {
  return {command,  "builtin:cornell",   "--size",   "64x64",    "--light-shader",
          "p.glsl", "--light-parameter", "gain=0.5", "--target", "rgba32f"};
}

TEST_CASE("explain says of a pixel that is no number where it became none, and what is stored") {
  const ScratchFolder folder;
  const struct {
    const char *what, *text, *target, *strategy;
    std::vector<const char*> said;
  } rows[] = {
      {"a root of a negative number",
       "vec3 light(Surface s, Light l, View v) {\n  float bad = -1.0 - s.albedo.a;\n  float root = sqrt(bad);\n"
       "  return vec3(0.5, root * 2.0, 0.25);\n}\n",
       "rgba8",
       "forward-loop",
       {"nonfinite  0.5, NaN, 0.25", "is light() of light 0; stored is 255, 0, 255, 255",
        "line       3: float root = sqrt(bad);", "operation  sqrt(-2) is NaN"}},
      {"the same, light by light",
       "vec3 light(Surface s, Light l, View v) {\n  return vec3(sqrt(-2.0 - 0.0 * s.albedo.a));\n}\n",
       "rgba16f",
       "deferred-volumes",
       {"nonfinite  NaN, NaN, NaN", "stored is NaN, NaN, NaN", "line       2: return vec3(sqrt(",
        "operation  sqrt(-2) is NaN"}},
      {"a quotient by 0 before the NaN",
       "vec3 light(Surface s, Light l, View v) {\n  float z = s.albedo.a - 1.0;\n  float q = 2.0 / z;\n"
       "  float w = q - q;\n  return vec3(w);\n}\n",
       "rgba32f",
       "deferred-loop",
       {"nonfinite  NaN, NaN, NaN", "line       3: float q = 2.0 / z;", "operation  2 / 0 is inf"}},
      {"an infinity that ends the sum",
       "vec3 light(Surface s, Light l, View v) { return vec3(3e38); }\n",
       "rgba32f",
       "forward-loop",
       {"nonfinite  inf, inf, inf", "is the sum of the lights; stored is inf, inf, inf, 1"}},
      {"what finish() makes of it",
       "vec3 light(Surface s, Light l, View v) { return vec3(1); }\nvec4 finish(Surface s, View v, vec3 sum) {\n"
       "  return vec4(log(-sum), 1);\n}\n",
       "rgba32f",
       "forward-loop",
       {"is finish(); stored is NaN, NaN, NaN, 1", "line       3: return vec4(log(-sum), 1);"}},
      {"more than the target holds, light by light",
       "vec3 light(Surface s, Light l, View v) { return vec3(3e38, 0, 0); }\n",
       "rgba32f",
       "deferred-volumes",
       {"nonfinite  inf, 0, 0", "is the target after light 1; stored is inf, 0, 0"}},
      {"more than the format holds, which takes its largest number",
       "vec3 light(Surface s, Light l, View v) { return vec3(1e5, 0, 0); }\n",
       "rgba16f",
       "forward-loop",
       {}},
      {"a choice that was not taken",
       "vec3 light(Surface s, Light l, View v) {\n  float x = s.albedo.a < 9.0 ? 0.5 : sqrt(-1.0 - s.albedo.a);\n"
       "  return vec3(x);\n}\n",
       "rgba32f",
       "forward-loop",
       {}},
      {"an infinity that does not come through",
       "vec3 light(Surface s, Light l, View v) { return vec3(1.0 / (1.0 / (s.albedo.a - 1.0))); }\n",
       "rgba32f",
       "forward-loop",
       {}},
  };
  for (const auto& row : rows) {
    INFO(row.what);
    folder.write("n.glsl", row.text);
    const Arguments words{"explain",    "builtin:cornell", "--size", "64x64",    "--pixel",
                          "30,40",      "--light-shader",  "n.glsl", "--target", row.target,
                          "--strategy", row.strategy,      "-q"};
    const Outcome told = run_command(words, folder.path(""));
    INFO(told.err << told.out.substr(0, 1500));
    REQUIRE(told.exit_code == 0);
    for (const char* const said : row.said) CHECK_THAT(told.out, Catch::Contains(said));
    if (row.said.empty()) CHECK_THAT(told.out, !Catch::Contains("nonfinite"));
  }
}

TEST_CASE("explain tells each line of a light program that the strongest light comes from, and all lights with --all") {
  const ScratchFolder folder;
  folder.write("p.glsl", kProgram);
  for (const bool all : {false, true}) {
    Arguments words = lit_by_program("explain");
    words.insert(words.end(), {"--pixel", "30,40", "--json", "-q"});
    if (all) words.emplace_back("--all");
    const Outcome told = run_command(words, folder.path(""));
    INFO(told.err);
    REQUIRE(told.exit_code == 0);
    const auto document = nlohmann::json::parse(told.out);
    CHECK(contradiction(document) == "");
    int traced = 0, adding = 0;
    for (const auto& part : document["parts"]) {
      if (part["step"] != "lights") continue;
      for (const auto& light : part["parts"]) {
        if (light["step"] != "light") continue;
        const bool adds = light["values"]["fate"] == "adds";
        adding += adds;
        if (!light.contains("parts")) continue;
        ++traced;
        std::vector<int> lines;
        nlohmann::json last;
        for (const auto& line : light["parts"][0]["parts"]) {
          if (line["step"] != "line") continue;
          last = line["parts"].back()["values"];
          lines.push_back(last["line"].get<int>());
        }
        INFO(light.dump(1));
        CHECK(lines.size() >= 2);
        if (!adds) continue;
        CHECK(lines == std::vector{3, 4, 5});
        CHECK(last["value"] == light["values"]["term"]);
      }
    }
    CHECK(adding > 1);
    CHECK((all ? traced > adding : traced == 1));
  }
  Arguments words = lit_by_program("explain");
  words.insert(words.end(), {"--pixel", "30,40", "-q"});
  const Outcome told = run_command(words, folder.path(""));
  INFO(told.out);
  CHECK(told.out.find("line 3: vec3 d = l.position - s.position;") != std::string::npos);
  CHECK(told.out.find("light.position.xyz - surface.position.xyz") != std::string::npos);
}

TEST_CASE("explain tells the extents of a light with an area, and which surfaces lie behind one that is flat") {
  const ScratchFolder folder;
  const auto told = [&](const char* up) {
    folder.write("s.json", std::string(R"({"version": 1, "camera": {"eye": [0, 1, 4], "target": [0, 0.5, 0]},
      "objects": [{"mesh": "plane", "scale": 6}],
      "lights": [{"type": "rectangle", "position": [0, 2, 1], "right": [0.6, 0, 0], "up": )") +
                               up + R"(, "range": 10}]})");
    const Outcome outcome =
        run_command({"explain", "s.json", "--size", "64x48", "--pixel", "32,40", "--all"}, folder.path(""));
    INFO(outcome.err);
    REQUIRE(outcome.exit_code == 0);
    return outcome.out;
  };
  const auto has = [](const std::string& text, const char* part) { return text.find(part) != std::string::npos; };
  const std::string lit = told("[0, 0, -0.3]"), behind = told("[0, 0, 0.3]");
  CHECK(has(lit, "light 0, rectangle: adds"));
  CHECK(has(lit, "up         0, 0, -0.3"));
  CHECK(has(lit, "direction  0, -1, 0"));
  CHECK(has(behind, "behind_light  0"));
  CHECK(has(behind, "light 0, rectangle: behind the light, which shines to one side"));
}

TEST_CASE("explain tells where another picture's value comes from under a light program") {
  const ScratchFolder folder;
  folder.write("p.glsl", kProgram);
  Arguments render = lit_by_program("render"), explain = lit_by_program("explain");
  render.insert(render.end(), {"-o", "same.exr", "-q"});
  REQUIRE(run_command(render, folder.path("")).exit_code == 0);
  REQUIRE(run_command({"render", "builtin:cornell", "--size", "64x64", "--target", "rgba32f", "--preset",
                       "light-volumes", "--strategy", "deferred-loop", "-o", "other.exr", "-q"},
                      folder.path(""))
              .exit_code == 0);
  explain.insert(explain.end(), {"--pixel", "30,40", "-q", "--against"});
  Arguments same = explain, other = explain;
  same.emplace_back("same.exr"), other.emplace_back("other.exr");
  const Outcome of_same = run_command(same, folder.path("")), of_other = run_command(other, folder.path(""));
  INFO(of_same.err << of_other.err << of_same.out.substr(of_same.out.find("same.exr")) << of_other.out);
  CHECK(of_same.out.find("the same as here") != std::string::npos);
  CHECK(of_same.out.find("EXACT") != std::string::npos);
  CHECK(of_other.out.find("VIOLATION") != std::string::npos);
  CHECK(of_other.out.find("the preset light-volumes: exactly what the picture has") != std::string::npos);
}

TEST_CASE("explain follows time and profile as render does") {
  const ScratchFolder folder;
  const Arguments how = {"builtin:circle",     "--size",     "64x48",           "--time", "1.5", "--profile",
                         "mesa-llvmpipe-22.3", "--strategy", "deferred-volumes"};
  Arguments render = {"render"}, explain = {"explain"};
  render.insert(render.end(), how.begin(), how.end()), explain.insert(explain.end(), how.begin(), how.end());
  for (const char* word : {"-o", "a.png", "-q"}) render.emplace_back(word);
  for (const char* word : {"--pixel", "32,20", "-q"}) explain.emplace_back(word);
  REQUIRE(run_command(render, folder.path("")).exit_code == 0);
  const Outcome told = run_command(explain, folder.path(""));
  CHECK(last_line(told.out) == "stored  " + codes_at(folder.path("a.png"), 32, 20) + "  rgba8, R, G, B, A");
  CHECK(told.err.empty());
}

TEST_CASE("explain ends in the picture's value where a post chain follows the target") {
  const ScratchFolder folder;
  folder.write("p.json", R"({"post": {"samples": 2, "tone_map": "reinhard", "encode": "srgb", "output": "rgba8"}})");
  const Arguments how = {"builtin:cornell", "--pipeline", "p.json", "--size", "40x30"};
  Arguments render = {"render"}, explain = {"explain"};
  render.insert(render.end(), how.begin(), how.end()), explain.insert(explain.end(), how.begin(), how.end());
  for (const char* word : {"-o", "a.png", "-q"}) render.emplace_back(word);
  for (const char* word : {"--pixel", "20,15"}) explain.emplace_back(word);
  REQUIRE(run_command(render, folder.path("")).exit_code == 0);
  const Outcome told = run_command(explain, folder.path(""));
  INFO(told.err);
  CHECK(last_line(told.out).starts_with("stored  " + codes_at(folder.path("a.png"), 20, 15) + "  "));
  CHECK(told.out.find("samples, ") != std::string::npos);
  explain.insert(explain.end(), {"--against", "a.png"});
  const Outcome against = run_command(explain, folder.path(""));
  INFO(against.err);
  CHECK(against.out.find("the same as here") != std::string::npos);
  CHECK(against.out.find("VIOLATION") == std::string::npos);
}

TEST_CASE("explain says whether another picture's value is legal, and what makes it") {
  const DrawnCapture c;
  Arguments dull = {"render", kScene, "--size", "120x90", "--preset", "light-volumes", "-o", "dull.png", "-q"};
  REQUIRE(run_command(dull, c.path("")).exit_code == 0);
  const Arguments explain = {"explain", kScene, "--size", "120x90", "--pixel", "60,45", "--against"};
  Arguments same = explain, other = explain;
  same.emplace_back("c.exr"), other.emplace_back("dull.png");
  const Outcome of_same = run_command(same, c.path("")), of_other = run_command(other, c.path(""));
  INFO(of_same.err << of_other.err << of_other.out);
  CHECK(of_same.out.find("the same as here") != std::string::npos);
  CHECK(of_same.out.find("EXACT") != std::string::npos);
  CHECK(of_other.out.find("no specular term: exactly what the picture has") != std::string::npos);
  CHECK(of_other.out.find("drawn_by   preset light-volumes") != std::string::npos);
}

/// A light whose window is a square of d / range, or of its square.
std::string windowed_light(const std::string& square) {
  return "vec3 light(Surface s, Light l, View v) {\n"
         "  vec3 d = l.position - s.position;\n"
         "  float part = dot(d, d) / (l.range * l.range), window = clamp(1.0 - " +
         square +
         ", 0.0, 1.0);\n  return l.color * s.albedo.rgb * window * max(dot(s.normal, normalize(d)), 0.0);\n}\n";
}

TEST_CASE(
    "explain names the line of a light program that another picture was drawn by, in brief with the causes alone") {
  const ScratchFolder folder;
  folder.write("ours.glsl", windowed_light("part * part")), folder.write("theirs.glsl", windowed_light("part"));
  const auto with = [&](Arguments words, const char* program) {
    words.insert(words.end(), {"builtin:cornell", "--size", "64x48", "--light-shader", program, "--target", "rgba16f"});
    return run_command(words, folder.path(""));
  };
  REQUIRE(with({"render", "-q", "-o", "theirs.exr"}, "theirs.glsl").exit_code == 0);
  const Arguments asked = {"explain", "--pixel", "30,30", "--against", "theirs.exr"};
  const auto also = [&](std::initializer_list<const char*> options) {
    Arguments words = asked;
    words.insert(words.end(), options.begin(), options.end());
    return with(words, "ours.glsl");
  };
  const Outcome whole = also({}), brief = also({"--brief"});
  const std::string reads =
                        "float part = dot(d, d) / (l.range * l.range), window = clamp(1.0 - part * part, 0.0, 1.0);",
                    drawn = "float part = dot(d, d) / (l.range * l.range), window = clamp(1.0 - part, 0.0, 1.0);";
  for (const Outcome& told : {whole, brief}) {
    INFO(told.out << told.err);
    CHECK(
        has(told.out, "line 3 of ours.glsl has a value where it should have its square: exactly what the picture has"));
    CHECK(has(told.out, "it_reads   " + reads + "\n"));
    CHECK(has(told.out, "drawn_as   " + drawn + "\n"));
    CHECK(has(told.out, "  class      VIOLATION"));
    CHECK(has(told.out, "  legal_R    "));
    CHECK(has(told.out, "  seen       "));
    CHECK(has(told.out, " edits of lines that were tried"));
  }
  CHECK(has(whole.out, "\n  Triangles"));
  CHECK_FALSE(has(brief.out, "\n  Triangles"));
  CHECK(std::count(brief.out.begin(), brief.out.end(), '\n') < 35);
  CHECK(last_line(brief.out) == last_line(whole.out));
  const auto document = nlohmann::json::parse(also({"--brief", "--json"}).out);
  CHECK(document["values"].contains("seen"));
  CHECK(document["values"].contains("stored"));
  REQUIRE(document["parts"].size() == 1);
  CHECK(document["parts"][0]["step"] == "against");
  const auto& causes = document["parts"][0]["parts"];
  CHECK(std::any_of(causes.begin(), causes.end(), [&](const auto& cause) {
    return cause["step"] == "edit" && cause["values"]["drawn_as"] == drawn && cause["values"]["it_reads"] == reads;
  }));
  check_refused(also({"--brief", "--all"}), 2, "--brief and --all exclude each other");
}

TEST_CASE("explain refuses what names no pixel and what is no picture, in one line") {
  const DrawnCapture c;
  const auto refused = [&](const Arguments& words, int code, const std::string& about) {
    Arguments all = {"explain"};
    all.insert(all.end(), words.begin(), words.end());
    check_refused(run_command(all, c.path("")), code, about);
  };
  refused({kScene}, 2, "no pixel is named");
  refused({kScene, "--pixel", "3"}, 2, "'3' is not a pixel");
  refused({kScene, "--pixel", "-1,4"}, 2, "'-1,4' is not a pixel");
  refused({kScene, "--pixel", "1,2,3"}, 2, "'1,2,3' is not a pixel");
  refused({kScene, "--pixel", "800,0"}, 2, "is not in the picture, which is 800x800");
  refused({"no.json", "--pixel", "0,0"}, 5, "no.json");
  const Arguments against = {kScene, "--size", "120x90", "--pixel", "1,2", "--against"};
  const auto refused_image = [&](const std::string& file, int code, const std::string& about) {
    Arguments words = against;
    words.push_back(file);
    refused(words, code, about);
  };
  c.folder.write("text.png", "this is no picture\n");
  c.folder.write("empty.exr", "");
  const std::string cut = contents(c.path("c.exr"));
  c.folder.write("cut.exr", cut.substr(0, cut.size() / 2));
  refused_image("text.png", 3, "text.png");
  refused_image("empty.exr", 3, "empty.exr");
  refused_image("cut.exr", 3, "cut.exr");
  refused_image("missing.exr", 5, "missing.exr");
  refused_image(".", 3, "no regular file");
  Arguments small = {"render", kScene, "--size", "12x9", "-o", "small.png", "-q"};
  REQUIRE(run_command(small, c.path("")).exit_code == 0);
  refused_image("small.png", 3, "it is 12x9, and the frame 120x90");
}

}  // namespace
}  // namespace trueshade
