// What `trueshade bench` says and writes. No time is a verdict here.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/catch.hpp"
#include "tests/cli/refused.h"
#include "tests/cli/run_command.h"
#include "tests/scratch_folder.h"

namespace trueshade {
namespace {

std::string contents(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

TEST_CASE("bench times the frame that render draws, beside Embree, and writes it as JSON") {
  const ScratchFolder folder;
  const Outcome bench =
      run_command({"bench", "builtin:circle,lights=3", "--size", "64x48", "--against", "embree", "--json", "b.json"},
                  folder.path(""));
  INFO(bench.err);
  REQUIRE(bench.exit_code == 0);
  CHECK(bench.out.find("embree primary-rays") != std::string::npos);
  const auto json = nlohmann::json::parse(contents(folder.path("b.json")));
  REQUIRE(json["scenes"].size() == 1);
  const auto& scene = json["scenes"][0];
  CHECK(scene["scene"] == "builtin:circle,lights=3");
  CHECK(scene["size"] == "64x48");
  CHECK(scene["ms"].get<double>() > 0.0);
  CHECK(scene["floor_ms"].get<double>() > 0.0);
  CHECK(scene["lights"] == 3);
  CHECK(scene["frames"] == 15);
  REQUIRE(scene["peers"].size() == 1);
  const auto& peer = scene["peers"][0];
  CHECK(peer["name"] == "embree");
  CHECK(peer["ratio"].get<double>() == Approx(peer["ms"].get<double>() / scene["ms"].get<double>()));
  const Outcome render = run_command({"render", "builtin:circle,lights=3", "--size", "64x48", "--hash"});
  CHECK(render.out.substr(0, render.out.find(' ')) == scene["hash"].get<std::string>());
  CHECK(json["machine"]["clock_ghz"].get<double>() > 0.0);
}

TEST_CASE("bench --moving times each frame of a sequence against itself drawn again") {
  const Outcome bench = run_command({"bench", "builtin:circle,lights=3", "--size", "64x48", "--moving", "--json", "-"});
  INFO(bench.err);
  REQUIRE(bench.exit_code == 0);
  const auto scene = nlohmann::json::parse(bench.out)["scenes"][0];
  const auto& moving = scene["moving"];
  CHECK(moving["frames"].get<int>() > 1);
  CHECK(moving["ratio"].get<double>() == Approx(moving["ms"].get<double>() / moving["again_ms"].get<double>()));
  const Outcome text = run_command({"bench", "builtin:circle,lights=3", "--size", "64x48", "--moving"});
  CHECK(text.out.find("moving, the same again") != std::string::npos);
  CHECK(text.out.substr(0, text.out.find("  visibility")).find("x the same again") != std::string::npos);
}

TEST_CASE("bench --json - prints the document and nothing else") {
  const ScratchFolder folder;
  const Outcome bench = run_command({"bench", "builtin:cornell", "builtin:circle,lights=3", "--preset", "many-lights",
                                     "--size", "32x24", "--json", "-"},
                                    folder.path(""));
  INFO(bench.err);
  REQUIRE(bench.exit_code == 0);
  CHECK(bench.err.empty());
  const auto json = nlohmann::json::parse(bench.out);  // throws unless this is one document
  REQUIRE(json["scenes"].size() == 2);
  CHECK(json["scenes"][1]["scene"] == "builtin:circle,lights=3");
  CHECK(std::filesystem::is_empty(folder.path("")));
  check_refused(run_command({"bench", "builtin:cornell", "--json", "-", "-o", "-"}), 2, "'-'");
}

TEST_CASE("bench times OpenGL under presets that draw lights as geometry, and says which picture each design draws") {
  const ScratchFolder folder;
  for (const char* preset : {"light-volumes", "redsdk"}) {
    const Outcome bench = run_command({"bench", "builtin:city,objects=60,lights=5", "--size", "64x48", "--preset",
                                       preset, "--against", "gl", "--json", "b.json"},
                                      folder.path(""));
    if (bench.exit_code == 7) {
      WARN("SKIPPED: " << bench.err);
      return;
    }
    INFO(preset << bench.err);
    REQUIRE(bench.exit_code == 0);
    CHECK(bench.out.find("fastest peer of this picture: gl ") != std::string::npos);
    const auto json = nlohmann::json::parse(contents(folder.path("b.json")));
    int blended = 0, same = 0;
    for (const auto& peer : json["scenes"][0]["peers"]) {
      CAPTURE(peer["strategy"].get<std::string>());
      CHECK(peer["right_picture"] == true);
      const bool per_light = peer["rounding"] == "per light";
      blended += per_light ? 1 : 0;
      same += peer["same_picture"] == true ? 1 : 0;
      CHECK((per_light || peer["same_picture"] == false));  // what is timed is blended light by light
      CHECK(peer["pixels_off"].get<int>() <= 64 * 48 / 100);
    }
    const auto& peers = json["scenes"][0]["peers"];
    const auto fastest = std::min_element(peers.begin(), peers.end(), [](const auto& a, const auto& b) {
      return a["ratio"].template get<double>() < b["ratio"].template get<double>();
    });
    CHECK(json["scenes"][0]["best_peer"]["strategy"] == (*fastest)["strategy"]);
    CHECK(json["scenes"][0]["best_peer"]["ratio"] == (*fastest)["ratio"]);
    CHECK(bench.out.find("fastest peer of all: gl " + (*fastest)["strategy"].get<std::string>()) != std::string::npos);
    CHECK(blended == 2);
    CHECK(same >= 1);
    CHECK(json["scenes"][0]["peers"].size() == 7);
  }
}

TEST_CASE("bench draws the designs of OpenGL that are named, and no other") {
  const ScratchFolder folder;
  const Outcome bench = run_command(
      {"bench", "builtin:circle,lights=3", "--size", "64x48", "--against", "gl=tiled+forward-plus", "--json", "b.json"},
      folder.path(""));
  if (bench.exit_code == 7) {
    WARN("SKIPPED: " << bench.err);
    return;
  }
  INFO(bench.err);
  REQUIRE(bench.exit_code == 0);
  const auto peers = nlohmann::json::parse(contents(folder.path("b.json")))["scenes"][0]["peers"];
  REQUIRE(peers.size() == 2);
  CHECK(peers[0]["strategy"] == "tiled");
  CHECK(peers[1]["strategy"] == "forward-plus");
  CHECK(peers[0]["right_picture"] == true);
}

TEST_CASE("The times of stages are those of the tiles, each the least that a tile took") {
  const ScratchFolder folder;
  const Outcome bench = run_command(
      {"bench", "builtin:city,objects=60,lights=5", "--size", "256x192", "--json", "b.json"}, folder.path(""));
  INFO(bench.err);
  REQUIRE(bench.exit_code == 0);
  const auto scene = nlohmann::json::parse(contents(folder.path("b.json")))["scenes"][0];
  double tiles = 0.0, stages = 0.0;
  for (const auto& tile : scene["tile_ms"]) tiles += tile.get<double>();
  for (const char* stage : {"visibility_ms", "surfaces_ms", "light_ms", "store_ms"})
    stages += scene[stage].get<double>();
  CHECK(tiles == Approx(stages).margin(1e-4 * double(scene["tile_ms"].size())));
  CHECK(stages <= scene["least_ms"].get<double>() * 1024);  // of at most so many threads
  CHECK(scene["clusters_drawn"].get<int>() > 0);
}

TEST_CASE("bench's report shows peers, tiles' costs on more cores, and how frames scale") {
  const ScratchFolder folder;
  const Outcome bench = run_command({"bench", "builtin:cornell", "--preset", "many-lights", "--size", "32x24",
                                     "--against", "tile=8", "--json", "b.json", "-o", "b.html"},
                                    folder.path(""));
  INFO(bench.err);
  REQUIRE(bench.exit_code == 0);
  const std::string page = contents(folder.path("b.html"));
  const auto scaling = nlohmann::json::parse(contents(folder.path("b.json")))["scaling"];
  REQUIRE(scaling.size() == 4);
  for (const auto& curve : scaling) {
    CAPTURE(curve["title"].get<std::string>());
    CHECK(page.find("<b>" + curve["title"].get<std::string>() + "</b>\n<p>") != std::string::npos);
    CHECK(curve["points"].size() >= 1);
    for (const auto& point : curve["points"]) {
      CHECK(point["ms"].get<double>() > 0.0);
      CHECK(page.find('>' + point["label"].get<std::string>() + "</text>") != std::string::npos);
    }
  }
  CHECK(scaling[0]["title"] == "Lights, builtin:cornell");
  CHECK(scaling[0]["points"].back()["label"] == "1000000");
  CHECK(scaling[1]["title"] == "Pixels, builtin:cornell");
  CHECK(scaling[1]["points"].size() == 4);
  CHECK(page.find("ms a frame</text>") != std::string::npos);
  CHECK(page.find("trueshade tile=8</text>") != std::string::npos);
  CHECK(page.find("scheduled on more cores") != std::string::npos);
  CHECK(page.find("64 cores</text>") != std::string::npos);
  CHECK(page.find("times as fast as on one core</text>") != std::string::npos);
}

TEST_CASE("What scales in bench's report is the scene that was measured, but for what is varied") {
  const ScratchFolder folder;
  const Outcome bench = run_command({"bench", "builtin:city,lights=3,objects=7,radius=constant", "--size", "32x24",
                                     "--json", "b.json", "-o", "b.html"},
                                    folder.path(""));
  INFO(bench.err);
  REQUIRE(bench.exit_code == 0);
  const auto scaling = nlohmann::json::parse(contents(folder.path("b.json")))["scaling"];
  REQUIRE(scaling.size() == 6);
  const char* titles[] = {"Lights, builtin:city,objects=7,radius=constant",
                          "Lights at constant overlap, builtin:city,objects=7",
                          "Triangles, builtin:city,lights=3,radius=constant",
                          "Pixels, builtin:city,lights=3,objects=7,radius=constant",
                          "Threads, builtin:city,lights=3,objects=7,radius=constant",
                          "SIMD targets, builtin:city,lights=3,objects=7,radius=constant"};
  for (size_t i = 0; i < 6; ++i) CHECK(scaling[i]["title"] == titles[i]);
  CHECK(scaling[0]["points"][0]["label"] == "3");  // the scene's own number of lights
}

TEST_CASE("bench times ours drawn otherwise in the same run: other targets, views, planes, threads and tiles") {
  const ScratchFolder folder;
  const std::string variants =
      "simd=scalar,target=rgba16f,view=normal,aov=depth+normal,threads=3,tile=8,strategy=forward-loop";
  const Outcome bench = run_command(
      {"bench", "builtin:city,objects=20,lights=7", "--size", "64x48", "--against", variants, "--json", "b.json"},
      folder.path(""));
  INFO(bench.err);
  REQUIRE(bench.exit_code == 0);
  CHECK(bench.out.find("trueshade aov=depth+normal") != std::string::npos);
  const auto json = nlohmann::json::parse(contents(folder.path("b.json")));
  const auto& scene = json["scenes"][0];
  REQUIRE(scene["peers"].size() == 7);
  for (const auto& peer : scene["peers"]) {
    CHECK(peer["name"] == "trueshade");
    CHECK(variants.find(peer["strategy"].get<std::string>()) != std::string::npos);
    CHECK(peer["ratio"].get<double>() > 0.0);
  }
  CHECK(scene["bytes_stored"] == 64 * 48 * 4);
  CHECK(scene["bytes_of_clusters"].get<int>() > 0);
  CHECK(scene["bytes_per_pixel"].get<double>() ==
        Approx(scene["peak_mib"].get<double>() * 1048576.0 / (64 * 48)).epsilon(1e-6));
  REQUIRE(scene["scheduled"].size() == 6);
  for (const auto& row : scene["scheduled"]) {
    CHECK(row["speedup"].get<double>() <= row["cores"].get<int>() + 1e-9);
    CHECK(row["tile"] == 32);  // one tile of 64 pixels is fewer than eight
  }
}

TEST_CASE("The whole command stays below the memory that five and eight million triangles were given") {
  const auto most_mb = [](const std::string& scene) {
    const Outcome render =
        run_command({}, ".", "exec " PEAK_MEMORY " " TRUESHADE_COMMAND " render " + scene + " --hash");
    INFO(render.err);
    REQUIRE(render.exit_code == 0);
    return 1024e-6 * std::stod(render.out.substr(render.out.rfind(' ')));
  };
  CHECK(most_mb("builtin:rabbits") < 300.0);
  CHECK(most_mb("builtin:red") < 600.0);
}

TEST_CASE("bench --ranks measures the bands of the picture that render draws, and models machines by them") {
  const ScratchFolder folder;
  const std::vector<std::string> picture{"builtin:circle,lights=3", "--size", "200x333"};
  for (const std::vector<std::string>& more : {std::vector<std::string>{}, {"--frames", "2-4"}}) {
    std::vector<std::string> bench{"bench", "--ranks", "--json", "b.json"}, render{"render", "--hash"};
    for (const auto* words : {&picture, &more}) {
      bench.insert(bench.end(), words->begin(), words->end());
      render.insert(render.end(), words->begin(), words->end());
    }
    const Outcome outcome = run_command(bench, folder.path(""), "export TMPDIR=$PWD");
    INFO(outcome.err);
    REQUIRE(outcome.exit_code == 0);
    const auto scene = nlohmann::json::parse(contents(folder.path("b.json")))["scenes"][0];
    CHECK(scene["hash"] == run_command(render, folder.path("")).out);
    CHECK(scene["unit"] == (more.empty() ? "band" : "frame"));
    CHECK(scene["costs"]["tasks"].size() == (more.empty() ? 4 : 3));  // bands of at least 16 rows
    CHECK(scene["costs_of_finest"]["tasks"].size() == (more.empty() ? 21 : 3));
    REQUIRE(scene["here"].size() == 1);
    CHECK(scene["here"][0]["ranks"] == 1);
    CHECK(scene["here"][0]["seconds"] > 0.0);
    REQUIRE(scene["machines"].size() == 6);
    CHECK(scene["machines"][0]["machines"] == 1);
    CHECK(scene["machines"][5]["machines"] == 1024);
    for (const auto& row : scene["machines"]) CHECK(row["seconds"] >= row["serial_s"]);
    CHECK(std::distance(std::filesystem::directory_iterator(folder.path("")), {}) == 1);  // b.json
  }
}

TEST_CASE("bench refuses what it cannot do, in one line") {
  const ScratchFolder folder;
  check_refused(run_command({"bench", "--ranks", "--against", "gl"}), 2, "--against");
  check_refused(run_command({"bench", "--ranks", "--moving"}), 2, "--moving");
  check_refused(run_command({"bench", "--ranks", "-o", "x.html"}), 2, "-o");
  check_refused(run_command({"bench", "--frames", "0-3"}), 2, "--frames");
  check_refused(run_command({"bench", "--ranks", "--frames", "3-0"}), 2, "--frames");
  check_refused(run_command({"bench", "--ranks", "--frames", "0-1", "--size", "17000x16", "builtin:red"}), 2,
                "--frames");
  check_refused(run_command({"bench", "--ranks", "builtin:red"}, folder.path(""), "export TMPDIR=$PWD/none"), 5,
                "TMPDIR");
  check_refused(run_command({"bench", "--against", "vulkan"}), 2, "no peer");
  check_refused(run_command({"bench", "--against", "gl,"}), 2, "no peer");
  check_refused(run_command({"bench", "--against", "gl,gl"}), 2, "twice");
  check_refused(run_command({"bench", "--against", "gl=tiled+fast"}), 2, "'fast'");
  check_refused(run_command({"bench", "--against", "gl="}), 2, "not drawn by ''");
  check_refused(run_command({"bench", "--against", "simd="}), 2, "simd");
  check_refused(run_command({"bench", "--against", "simd=neon"}), 2, "--against simd");
  check_refused(run_command({"bench", "--against", "target=rgb"}), 2, "--against target");
  check_refused(run_command({"bench", "--against", "view=nothing"}), 2, "--against view");
  check_refused(run_command({"bench", "--against", "tile=7"}), 2, "--against tile");
  check_refused(run_command({"bench", "--against", "threads=-1"}), 2, "--against threads");
  check_refused(run_command({"bench", "--against", "aov=depth+"}), 2, "--against aov");
  check_refused(run_command({"bench", "--against", "strategy=best"}), 2, "--against strategy");
  check_refused(run_command({"bench", "--against", "=avx2"}), 2, "chosen by ''");
  check_refused(run_command({"bench", "city"}), 3, "builtin:city");
  check_refused(run_command({"bench", "builtin:nowhere"}), 3, "nowhere");
  check_refused(run_command({"bench", "--simd", "neon"}), 2, "neon");
  check_refused(run_command({"bench", "--size", "0x1"}), 2, "size");
  check_refused(run_command({"bench", "-o", "x.png"}), 2, ".html");
  check_refused(run_command({"bench", "builtin:cornell", "--json", folder.path("absent/x.json")}), 5, "folder");
  check_refused(run_command({"bench", "builtin:cornell", "--json", ""}), 5, "name");
  check_refused(run_command({"bench", "builtin:cornell", "--json", folder.path("")}), 5, "folder");
  check_refused(run_command({"bench", "builtin:cornell", "--json", folder.path(std::string(256, 'n'))}), 5, "shorter");
  check_refused(run_command({"bench", "builtin:cornell", "--json", "x.html", "-o", "x.html"}), 2, "'x.html' is named");
}

TEST_CASE("What a scene takes of memory is its own, whatever was timed before it") {
  const ScratchFolder folder;
  const auto mib = [&](const std::vector<std::string>& scenes) {
    std::vector<std::string> arguments{"bench", "--size", "64x48", "--json", "m.json"};
    arguments.insert(arguments.begin() + 1, scenes.begin(), scenes.end());
    const Outcome bench = run_command(arguments, folder.path(""));
    INFO(bench.err);
    REQUIRE(bench.exit_code == 0);
    return nlohmann::json::parse(contents(folder.path("m.json")))["scenes"].back()["peak_mib"].get<double>();
  };
  // Scratch of threads, some 4 MiB, is the first scene's; rabbits takes 7 MiB more than cornell.
  const double alone = mib({"builtin:cornell"}), after = mib({"builtin:rabbits", "builtin:cornell"});
  CHECK(after <= alone + 2.0);
  CHECK(after >= alone - 7.0);
}

}  // namespace trueshade
