// What `trueshade bench` says and writes. No time is a verdict here.

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <thread>

#include "tests/catch.hpp"
#include "tests/cli/refused.h"
#include "tests/cli/run_command.h"
#include "tests/file_contents.h"
#include "tests/scratch_folder.h"

namespace trueshade {
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
  CHECK(scene["frames"] == 100);
  REQUIRE(scene["peers"].size() == 1);
  const auto& peer = scene["peers"][0];
  CHECK(peer["name"] == "embree");
  CHECK(peer["ratio"].get<double>() == Approx(peer["ms"].get<double>() / scene["ms"].get<double>()));
  const Outcome render = run_command({"render", "builtin:circle,lights=3", "--size", "64x48", "--hash"});
  CHECK(render.out.substr(0, render.out.find(' ')) == scene["hash"].get<std::string>());
  CHECK(json["machine"]["clock_ghz"].get<double>() > 0.0);
  // A short text has the times and no more.
  CHECK(bench.out.find("pixel-lights left by tiles") != std::string::npos);
  const Outcome quiet = run_command({"bench", "builtin:circle,lights=3", "--size", "64x48", "--quick", "-q"});
  CHECK(quiet.out.find("  trueshade  ") != std::string::npos);
  CHECK(quiet.out.find("pixel-lights left by tiles") == std::string::npos);
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
                                     "--quick", "--json", "b.json", "-o", "b.html"},
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

TEST_CASE("Beside programs that keep every core busy bench says, in text, JSON and page, that it is not to be quoted") {
  const ScratchFolder folder;
  std::atomic<bool> stop{false};
  std::vector<std::thread> spinning;
  for (unsigned i = 0; i < std::max(1u, std::thread::hardware_concurrency()); ++i)
    spinning.emplace_back([&stop] {
      while (!stop) {
      }
    });
  const Outcome bench = run_command(
      {"bench", "builtin:circle,lights=3", "--size", "64x48", "--quick", "--json", "b.json", "-o", "b.html"},
      folder.path(""));
  stop = true;
  for (std::thread& thread : spinning) thread.join();
  INFO(bench.err);
  REQUIRE(bench.exit_code == 0);
  const std::string before = "other programs used ";
  CHECK(bench.out.find("\nnot to be quoted: " + before) != std::string::npos);
  CHECK(contents(folder.path("b.html")).find("<p class=note>Not to be quoted: " + before) != std::string::npos);
  const auto json = nlohmann::json::parse(contents(folder.path("b.json")));
  REQUIRE(json["not_to_be_quoted"].size() >= 1);
  CHECK(json["not_to_be_quoted"][0].get<std::string>().starts_with(before));
  CHECK(json["not_to_be_quoted"][0].get<std::string>().ends_with("before this ran"));
  const auto& load = json["machine"]["load_before"];
  CHECK(load["others"].get<double>() > 0.5 * load["cores"].get<double>());
  CHECK(json["scenes"][0]["load"]["others"].get<double>() > 0.0);
}

TEST_CASE("On one pinned core bench draws by one thread, and measures what others use of that core") {
  const Outcome bench = run_command({"bench", "builtin:circle,lights=3", "--size", "64x48", "--quick", "--json", "-"},
                                    ".", "taskset -cp $(taskset -cp $$ | sed 's/.*: //; s/[-,].*//') $$ >/dev/null");
  INFO(bench.err);
  REQUIRE(bench.exit_code == 0);
  CHECK(bench.err.empty());
  const auto json = nlohmann::json::parse(bench.out);
  CHECK(json["threads"] == 1);
  CHECK(json["machine"]["cores"] == 1);
  CHECK(json["machine"]["load_before"]["cores"] == 1);
  CHECK(json["machine"]["load_before"]["others"].get<double>() < 1.05);
}

TEST_CASE("bench's JSON says what the machine is, and keeps the time of every frame") {
  const Outcome bench =
      run_command({"bench", "builtin:circle,lights=3", "--size", "64x48", "--against", "threads=1", "--json", "-"});
  INFO(bench.err);
  REQUIRE(bench.exit_code == 0);
  const auto json = nlohmann::json::parse(bench.out);
  const auto& machine = json["machine"];
  for (const char* key : {"cpu", "vendor", "os", "kernel", "compiler", "c_library", "date"}) {
    CAPTURE(key);
    CHECK_FALSE(machine[key].get<std::string>().empty());
  }
  CHECK(machine["hardware_threads"].get<int>() >= machine["cores"].get<int>());
  CHECK(machine["memory_mib"].get<double>() > 100.0);
  CHECK(machine["virtual"].is_boolean());
  CHECK(machine["caches"].is_array());
  CHECK(std::regex_match(machine["date"].get<std::string>(),
                         std::regex("\\d{4}-\\d\\d-\\d\\dT\\d\\d:\\d\\d:\\d\\d[-+]\\d{4}")));
  const auto& scene = json["scenes"][0];
  for (const auto* row : {&scene, &scene["peers"][0]}) {
    const auto frames = (*row)["frame_ms"].get<std::vector<double>>();
    CHECK(frames.size() == (*row)["frames"].get<size_t>());
    CHECK(std::is_sorted(frames.begin(), frames.end()));
    CHECK(frames.front() == Approx((*row)["least_ms"].get<double>()));
    CHECK(frames[frames.size() / 2] == Approx((*row)["ms"].get<double>()));
    CHECK((*row)["lower_quartile_ms"].get<double>() <= (*row)["upper_quartile_ms"].get<double>());
  }
}

TEST_CASE("Two results of bench are compared: rows that were made slower or faster are found, and no other") {
  const ScratchFolder folder;
  const Outcome bench = run_command({"bench", "builtin:circle,lights=3", "--size", "64x48", "--against",
                                     "threads=1,tile=8,simd=scalar", "--json", "run.json"},
                                    folder.path(""));
  INFO(bench.err);
  REQUIRE(bench.exit_code == 0);
  const auto written = nlohmann::json::parse(contents(folder.path("run.json")));
  // Frames of 10 ms and a little more, times a factor a row.
  const auto planted = [&](const char* name, double shift, std::vector<double> factors,
                           const std::vector<std::string>& reasons = {}) {
    auto json = written;
    auto& scene = json["scenes"][0];
    const auto set = [&](nlohmann::json& row, double factor) {
      row["frame_ms"] = nlohmann::json::array();
      for (int i = 0; i < 15; ++i) row["frame_ms"].push_back(factor * (10 + 0.1 * i + shift));
    };
    set(scene, factors[0]);
    for (size_t i = 0; i < 3; ++i) set(scene["peers"][i], factors[i + 1]);
    json["not_to_be_quoted"] = reasons;
    std::ofstream(folder.path(name)) << json;
  };
  planted("a.json", 0.0, {1, 1, 1, 1});
  planted("b.json", 0.05, {1, 1.3, 0.7, 1.02});
  const Outcome text = run_command({"bench", "a.json", "b.json", "--json", "c.json"}, folder.path(""));
  INFO(text.err);
  REQUIRE(text.exit_code == 0);
  CHECK(text.out.find("\n2 of 4 rows differ beyond noise") != std::string::npos);
  const auto rows = nlohmann::json::parse(contents(folder.path("c.json")))["rows"];
  REQUIRE(rows.size() == 4);
  const char* verdicts[] = {"no difference beyond noise", "slower", "faster", "no difference beyond noise"};
  const double ratios[] = {1, 1.3, 0.7, 1.02};
  for (size_t i = 0; i < 4; ++i) {
    CAPTURE(rows[i]);
    CHECK(rows[i]["verdict"] == verdicts[i]);
    CHECK(rows[i]["ratio"].get<double>() == Approx(ratios[i]).epsilon(0.01));
    CHECK(rows[i]["low"].get<double>() < ratios[i]);
    CHECK(rows[i]["high"].get<double>() > ratios[i]);
    CHECK(rows[i]["same_picture"] == true);
  }
  planted("noisy.json", 0.05, {1, 1.3, 0.7, 1.02}, {"it was busy"});
  REQUIRE(run_command({"bench", "a.json", "noisy.json", "--json", "c.json"}, folder.path("")).exit_code == 0);
  const auto noisy = nlohmann::json::parse(contents(folder.path("c.json")))["rows"];
  CHECK(noisy[0]["verdict"] == "no difference beyond noise");
  for (const size_t i : {1u, 2u}) CHECK(noisy[i]["verdict"] == "not to be quoted");
  const Outcome lost = run_command({"bench", "a.json", "lost.json"}, folder.path(""));
  CHECK(lost.exit_code == 5);
  CHECK(lost.err.find("lost.json: No such file or directory") != std::string::npos);
  const Outcome same = run_command({"bench", "a.json", "a.json"}, folder.path(""));
  CHECK(same.out.find("\n0 of 4 rows differ beyond noise") != std::string::npos);
  for (const bool busy : {false, true}) {
    auto run = written;
    run["not_to_be_quoted"] = nlohmann::json::array();
    if (busy) run["not_to_be_quoted"].push_back("it was busy");
    std::ofstream(folder.path("busy.json")) << run;
    const Outcome said = run_command({"bench", "busy.json", "busy.json"}, folder.path(""));
    CHECK((said.out.find("   not to be quoted: it was busy\n") != std::string::npos) == busy);
    CHECK((said.out.find("what else the machines did may be the cause") != std::string::npos) == busy);
  }

  // Five runs a side, in turn, each 5 % slower: frames of one run a side do not show that, the medians of five do.
  std::vector<std::string> runs{"bench"};
  for (int i = 0; i < 5; ++i)
    for (const char* side : {"a", "b"}) {
      runs.push_back(side + std::to_string(i) + ".json");
      planted(runs.back().c_str(), 0.02 * i, std::vector<double>(4, *side == 'a' ? 1.0 : 1.05));
    }
  const Outcome one_each = run_command({"bench", runs[1], runs[2]}, folder.path(""));
  CHECK(one_each.out.find("\n0 of 4 rows differ beyond noise: with 99 % confidence by more than 15 %\n") !=
        std::string::npos);
  CHECK(one_each.out.find("five runs a side, in turn, do") != std::string::npos);
  const Outcome in_turn = run_command(runs, folder.path(""));
  CHECK(in_turn.out.find("\n4 of 4 rows differ beyond noise: with 99 % confidence from run to run\n") !=
        std::string::npos);
  CHECK(in_turn.out.find("B takes 1.050 times as long") != std::string::npos);

  // What differs besides times is said; scores of two standards are not compared.
  auto elsewhere = written;
  elsewhere["machine"]["cores"] = 77;
  elsewhere["not_to_be_quoted"] = nlohmann::json::array();
  elsewhere["standard"] = {{"version", 1}, {"score", 5.0}};
  std::ofstream(folder.path("elsewhere.json")) << elsewhere;
  elsewhere["machine"] = written["machine"];
  elsewhere["standard"]["version"] = 2;
  std::ofstream(folder.path("here.json")) << elsewhere;
  const Outcome differing = run_command({"bench", "elsewhere.json", "here.json"}, folder.path(""));
  CHECK(differing.out.find("A and B differ in cores (77 and ") != std::string::npos);
  CHECK(differing.out.find("scores are not compared: A's is of standard 1, B's of standard 2") != std::string::npos);

  auto few = written, other = written;
  few["scenes"][0]["frame_ms"] = {1.0, 2.0};
  few["scenes"][0]["hash"] = "sha256:0";
  few["scenes"][0]["peers"].erase(0);
  std::ofstream(folder.path("few.json")) << few;
  const Outcome unlike = run_command({"bench", "run.json", "few.json"}, folder.path(""));
  CHECK(unlike.out.find("too few frames to tell") != std::string::npos);
  CHECK(unlike.out.find("their hashes differ") != std::string::npos);
  CHECK(unlike.out.find("only run.json has builtin:circle,lights=3") != std::string::npos);

  other["scenes"][0].erase("frame_ms");
  std::ofstream(folder.path("older.json")) << other;
  std::ofstream(folder.path("scene.json")) << R"({"machine": 1})";
  const auto refused = [&](std::vector<std::string> files, int code, const char* about) {
    files.insert(files.begin(), "bench");
    check_refused(run_command(files, folder.path("")), code, about);
  };
  refused({"run.json", "older.json"}, 3, "older.json: /scenes/0: the times of single frames are missing");
  refused({"run.json", "scene.json"}, 3, "scene.json: this is no result of bench, and run.json is one");
  refused({"run.json", "builtin:city"}, 3, "builtin:city: this is no result of bench");
  refused({"run.json"}, 2, "compared by twos");
  refused({"run.json", "run.json", "run.json"}, 2, "compared by twos, and here are 3");
  auto alone = written;
  alone["scenes"][0]["scene"] = "builtin:red";
  std::ofstream(folder.path("alone.json")) << alone;
  refused({"run.json", "alone.json"}, 3, "no row is in both of them");
  refused({"run.json", "run.json", "--size", "3x3"}, 2, "--size");
  refused({"run.json", "run.json", "-o", "x.html"}, 2, "-o");
  refused({"scene.json"}, 3, "scene.json");
}

TEST_CASE("bench --standard draws fixed scenes on every SIMD target, and a score is the mean that it says", "[slow]") {
  const Outcome bench = run_command({"bench", "--standard", "--quick", "--json", "-"});
  INFO(bench.err);
  REQUIRE(bench.exit_code == 0);
  const auto json = nlohmann::json::parse(bench.out);
  const auto& standard = json["standard"];
  CHECK(standard["version"] == 2);
  REQUIRE(json["scenes"].size() == 7);
  CHECK(json["scenes"][6]["size"] == "1920x1080");
  const auto& reasons = json["not_to_be_quoted"];
  CHECK(std::find(reasons.begin(), reasons.end(), "--quick draws few frames") != reasons.end());
  REQUIRE(standard["targets"].size() == json["scenes"][0]["peers"].size() + 1);
  CHECK(standard["targets"][0]["simd"] == json["simd"]);
  CHECK(standard["score"] == standard["targets"][0]["score"]);
  for (size_t target = 0; target < standard["targets"].size(); ++target) {
    double product = 1;
    for (const auto& scene : json["scenes"])
      product *= 1000 / (target == 0 ? scene : scene["peers"][target - 1])["least_ms"].get<double>();
    CHECK(standard["targets"][target]["score"].get<double>() == Approx(std::pow(product, 1.0 / 7)));
    if (target > 0)
      CHECK(json["scenes"][0]["peers"][target - 1]["strategy"] ==
            "simd=" + standard["targets"][target]["simd"].get<std::string>());
  }
}

TEST_CASE("Of a SIMD target that cannot be had it is said whether the build lacks it or the CPU") {
  const auto simd = nlohmann::json::parse(run_command({"--version", "--json"}).out)["simd"];
  const auto has = [](const nlohmann::json& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  for (const std::string name : {"avx512", "avx2", "sse4", "scalar"}) {
    CAPTURE(name, simd);
    const Outcome outcome = run_command({"render", "builtin:cornell", "--size", "8x8", "--hash", "--simd", name});
    if (has(simd["runs_here"], name))
      CHECK(outcome.exit_code == 0);
    else
      check_refused(outcome, 2,
                    has(simd["built"], name) ? "this machine's CPU does not run '" + name + "'"
                                             : "this build has no kernels for '" + name + "'");
  }
}

TEST_CASE("bench refuses what it cannot do, in one line") {
  const ScratchFolder folder;
  check_refused(run_command({"bench", "--standard", "builtin:city"}), 2, "SCENE");
  check_refused(run_command({"bench", "--standard", "--size", "64x64"}), 2, "--size");
  check_refused(run_command({"bench", "--standard", "--simd", "scalar"}), 2, "--simd");
  check_refused(run_command({"bench", "--standard", "--ranks"}), 2, "--ranks");
  check_refused(run_command({"bench", "--ranks", "--quick"}), 2, "--quick");
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
  check_refused(run_command({"bench", "--simd", "neon"}), 2, "no SIMD target 'neon'");
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
