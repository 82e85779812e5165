#include "view/session.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
#include <thread>

#include "cli/preparation.h"
#include "core/sha256.h"
#include "scenes/camera_changes.h"
#include "scenes/pipeline/presets.h"
#include "tests/catch.hpp"
#include "tests/scratch_folder.h"
#include "tests/view/opened.h"

namespace trueshade::viewer {
namespace {

/// A session without a window, whose time passes by hand.
struct Run {
  std::vector<std::string> files;
  SceneSource source;
  Session session;

  explicit Run(const std::string& spec) : Run(source_of(spec)) {}
  explicit Run(SceneSource from) : source(std::move(from)), session(source, opened_scene(source, files), {}, [] {}) {}

  /// Lets time pass until something holds; fails after 20 s.
  void until(const std::function<bool()>& holds) {
    for (int i = 0; i < 4000 && !holds(); ++i) {
      session.pass({}, 0.005);
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    REQUIRE(holds());
  }
  void until_still() {
    until([this] {
      return !session.waits() && session.picture() && session.picture()->state.revision == session.state().revision &&
             !session.hash().empty();
    });
  }
  std::string rendered() const {
    Scene scene = load_scene(source.spec);
    const Pipeline pipeline = drawn_pipeline(session.state());
    const ChangedCamera camera(scene, {}, double(pipeline.width) / double(pipeline.height));
    set_time(scene, session.state().time);
    camera.see(scene);
    return image_hash(render_frame(scene, pipeline).color);
  }
};

constexpr const char* kScene = R"({"version": 1, "objects": [{"mesh": "knot", "color": [0.5, 0.6, 0.7]}],
  "lights": [{"type": "point", "position": [2, 2, 2], "range": 9}, {"type": "ambient", "color": [0.1, 0.1, 0.1]}]})";

TEST_CASE("What is shown has the hash of render, under presets, views, sizes and home after a flight") {
  Run run("builtin:cornell");
  run.until_still();
  CHECK(run.session.hash() == run.rendered());
  run.session.act(Action::next_preset);
  CHECK(run.session.state().pipeline.preset == presets()[1].name);
  run.session.act(Action::next_view);
  run.session.set_size(77, 55);
  run.until_still();
  CHECK(run.session.hash() == run.rendered());
  const std::string at_home = run.session.hash();
  for (int i = 0; i < 20; ++i) run.session.pass({.fly = {0, 0, 1}}, 0.01);
  run.until([&run] { return !run.session.moves(); });
  run.until_still();
  CHECK(run.session.hash() != at_home);
  run.session.act(Action::home);
  run.until_still();
  CHECK(run.session.hash() == at_home);
}

TEST_CASE("A click gives the pixel's card, with its lights in order of strength, and outside there is none") {
  Run run("builtin:cornell");
  run.until_still();
  run.session.click(48, 40);
  run.until([&run] { return run.session.card().has_value(); });
  const PixelCard& card = *run.session.card();
  CHECK(card.text.find("pixel      48, 40") != std::string::npos);
  CHECK(card.text.rfind("\nstored  ") != std::string::npos);
  REQUIRE(card.lights.size() > 1);
  const auto sum = [](const glm::vec3& v) { return v.x + v.y + v.z; };
  for (size_t i = 1; i < card.lights.size(); ++i) CHECK(sum(card.lights[i - 1].term) >= sum(card.lights[i].term));
  // 8-bit codes of the sum of all terms, as the target stores them.
  glm::vec3 all(0.0f);
  for (const AddedLight& light : card.lights) all += light.term;
  CHECK(float(card.word >> 16 & 255) == Approx(255.0f * std::min(all.x, 1.0f)).margin(1.0));
  run.session.click(96, 0);
  run.until([&run] { return run.session.notice() && run.session.notice()->problem; });
  CHECK(run.session.notice()->text.find("96,0 is not in the picture") != std::string::npos);
}

TEST_CASE("A file that changes is loaded anew, and one that is broken leaves the last good scene and says why") {
  const ScratchFolder folder;
  Run run(folder.write("scene.json", kScene));
  run.until_still();
  const std::string first = run.session.hash();
  std::string brighter = kScene;
  brighter.replace(brighter.find("0.5, 0.6"), 8, "0.9, 0.9");
  folder.write("scene.json", brighter);
  run.until([&] { return run.session.notice() && run.session.notice()->text.find("anew") != std::string::npos; });
  run.until_still();
  const std::string second = run.session.hash();
  CHECK(second != first);
  CHECK(second == run.rendered());

  folder.write("scene.json", "{\"version\": 1, \"lights\": [{\"type\": \"lamp\"}]}");
  run.until([&] { return run.session.notice() && run.session.notice()->problem; });
  CHECK(run.session.notice()->text.find("/lights/0/type") != std::string::npos);
  CHECK(run.session.take_problems().size() == 1);
  run.session.set_exposure(1.0);
  run.until_still();
  run.session.set_exposure(0.0);
  run.until_still();
  CHECK(run.session.hash() == second);
  CHECK_FALSE(run.session.notice()->text.find("anew") != std::string::npos);

  folder.write("scene.json", kScene);  // repaired
  run.until([&] { return run.session.notice() && run.session.notice()->text.find("anew") != std::string::npos; });
  run.until_still();
  CHECK(run.session.hash() == first);
}

TEST_CASE("A change of a file that the scene refers to loads it anew, with changes of lights that are left dropped") {
  const ScratchFolder folder;
  folder.write(
      "model.ply",
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
      "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  const std::string model = R"({"version": 1, "objects": [{"geometry": "model.ply"}], "lights": [)";
  const std::string light = R"({"type": "ambient", "color": [0.2, 0.2, 0.2]})";
  Run run(folder.write("scene.json", model + light + "," + light + "]}"));
  CHECK(run.session.facts().files.size() == 2);
  run.session.change_light({1, false});
  run.session.change_light({0, true, glm::vec3(1, 1, 1)});
  run.until_still();
  const std::string first = run.session.hash();
  folder.write(
      "model.ply",
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
      "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 2 0\n3 0 1 2\n");
  run.until([&] { return run.session.notice() && run.session.notice()->text.find("anew") != std::string::npos; });
  run.until_still();
  CHECK(run.session.hash() != first);
  CHECK(run.session.state().changes.size() == 2);
  folder.write("scene.json", model + light + "]}");
  run.until([&] { return run.session.facts().lights.size() == 1; });
  CHECK(run.session.state().changes.size() == 1);
  run.until_still();
}

/// Drawn by a file of GLSL.
SceneSource by_model(const std::string& spec, const std::string& file) {
  SceneSource source = source_of(spec);
  source.pipeline = [file, plain = source.pipeline](const Scene& scene) {
    Pipeline pipeline = plain(scene);
    pipeline.light_program = light_program_of(file);
    pipeline.light_volumes.point = pipeline.light_volumes.spot = LightExtent::range;
    return pipeline;
  };
  return source;
}

std::string model_text(const std::string& members, const std::string& value) {
  return "layout(std140) uniform Parameters {\n  " + members + "\n};\n" +
         "vec3 light(Surface s, Light l, View v) {\n  return " + value + " * s.albedo.rgb;\n}\n";
}

/// As an editor saves: another file takes the place.
void replace(const ScratchFolder& folder, const std::string& text) {
  folder.write("saved.tmp", text);
  std::filesystem::rename(folder.path("saved.tmp"), folder.path("live.glsl"));
}

TEST_CASE("A light model's file that is saved is drawn anew, and while it is broken the last that compiled is drawn") {
  const ScratchFolder folder;
  Run run(by_model("builtin:cornell", folder.write("live.glsl", model_text("float gain;  // 0 to 1", "gain"))));
  Session& session = run.session;
  run.until_still();
  REQUIRE(session.parameters().size() == 1);
  CHECK(session.state().pipeline.light_program.parameters == std::vector<ProgramParameter>{{"gain", {0.5f}}});
  CHECK(session.hash() == run.rendered());
  session.set_parameter("gain", {0.25f});
  run.until_still();
  const std::string first = session.hash();
  CHECK(first == run.rendered());
  CHECK_THROWS_WITH(session.set_parameter("gain", {2.0f}), Catch::Contains("(0 to 1)"));
  CHECK_THROWS_WITH(session.set_parameter("gian", {1.0f}), Catch::Contains("no 'gian'"));

  replace(folder, model_text("float gain;  // 0 to 1", "gian"));
  run.until([&] { return session.broken_model().has_value(); });
  CHECK(session.broken_model()->reason.find("live.glsl:5:10: 'gian'") != std::string::npos);
  CHECK(session.broken_model()->line == "return gian * s.albedo.rgb;");
  CHECK(session.take_problems().size() == 1);
  session.set_parameter("gain", {0.75f});
  run.until_still();
  CHECK(session.hash() != first);
  CHECK(session.hash() == run.rendered());
  CHECK(session.broken_model());  // until the file is another one

  replace(folder, model_text("float other; vec2 gain;", "gain.y * other"));
  run.until([&] { return !session.broken_model(); });
  run.until_still();
  CHECK(session.hash() == run.rendered());
  CHECK(session.state().pipeline.light_program.parameters ==
        std::vector<ProgramParameter>{{"other", {1.0f}}, {"gain", {0.75f, 1.0f}}});
  CHECK(session.state().pipeline.light_program.sha256 ==
        sha256_of(model_text("float other; vec2 gain;", "gain.y * other")));

  std::filesystem::remove(folder.path("live.glsl"));
  run.until([&] { return session.broken_model().has_value(); });
  CHECK(session.broken_model()->line.empty());
  session.set_model("");
  run.until_still();
  CHECK_FALSE(session.broken_model());
  CHECK(session.parameters().empty());
  CHECK(session.hash() == run.rendered());
  session.set_model("toon");
  run.until_still();
  CHECK(session.hash() == run.rendered());
  CHECK_THROWS_WITH(session.set_model("tune"), Catch::Contains("toon"));
}

TEST_CASE("A preset that is chosen keeps the light model, time passes where it reads it, and exposure has no part") {
  const ScratchFolder folder;
  Run run(by_model("builtin:lecture",
                   folder.write("live.glsl", model_text("float gain;", "0.01 * gain * (1.0 + v.time)"))));
  Session& session = run.session;
  run.until_still();
  const std::string first = session.hash();
  session.act(Action::next_preset);
  CHECK(session.state().pipeline.light_program.used());
  session.set_exposure(2.0);
  CHECK(session.state().exposure == 0.0);
  CHECK(session.has_time());
  session.act(Action::play);
  session.pass({}, 0.25);
  session.act(Action::play);
  run.until_still();
  CHECK(session.state().time == 0.25);
  CHECK(session.hash() != first);
}

TEST_CASE(
    "A preset that draws by a light program brings it along and takes it away, and a model that is chosen stays") {
  Run run("builtin:cornell");
  Session& session = run.session;
  const auto program = [&session] { return session.state().pipeline.light_program.file; };
  session.set_preset("gltf");
  CHECK(program() == "gltf");
  CHECK(session.state().pipeline.light_program == preset_pipeline("gltf")->light_program);
  run.until_still();
  CHECK(session.hash() == run.rendered());
  const std::string by_gltf = session.hash();
  session.set_preset("punctual");
  CHECK(program().empty());
  session.set_preset("gltf");
  session.set_model("ue4");
  CHECK(program() == "ue4");
  session.set_preset("punctual");
  CHECK(program() == "ue4");
  session.set_preset("gltf");
  CHECK(program() == "ue4");
  session.set_model("");  // what the preset draws by
  CHECK(program() == "gltf");
  run.until_still();
  CHECK(session.hash() == by_gltf);
}

TEST_CASE("Saved pictures and scenes are named by the hash, and a folder that is not there is a problem of its own") {
  const ScratchFolder folder;
  Run run(folder.write("scene.json", kScene));
  run.until_still();
  const std::string hash = run.session.hash();
  run.session.save_scene();
  run.session.save_picture(folder.path("shown.png"));
  run.until([&] { return std::filesystem::exists(folder.path("shown.png")); });
  run.until_still();
  CHECK(std::filesystem::exists(folder.path("scene-" + hash.substr(0, 12) + ".json")));
  const ImageFileInfo info = read_image_info(folder.path("shown.png"));
  CHECK(std::find(info.metadata.begin(), info.metadata.end(),
                  std::pair<std::string, std::string>("trueshade:imageHash", "sha256:" + hash)) != info.metadata.end());
  run.session.save_picture(folder.path("nowhere/shown.png"));
  run.until([&] { return run.session.failed_save().has_value(); });
  CHECK(run.session.failed_save()->kind() == ErrorKind::io);
}

TEST_CASE("Time plays, comes round, and stops, and a light that is not there is refused") {
  Run run("builtin:circle,lights=5");
  REQUIRE(run.session.facts().moves);
  const double end = run.session.facts().last_time;
  CHECK(end > 0.0);
  run.session.act(Action::play);
  run.session.set_time(end - 0.01);
  run.session.pass({}, 0.005);
  CHECK(run.session.state().time == Approx(end - 0.005));
  run.session.pass({}, 0.02);
  CHECK(run.session.state().time == 0.0);
  run.session.act(Action::play);
  run.session.pass({}, 0.5);
  CHECK(run.session.state().time == 0.0);
  run.session.act(Action::step_ahead);
  CHECK(run.session.state().time == Approx(1.0 / run.session.facts().fps));
  CHECK_THROWS_WITH(run.session.change_light({5}), Catch::Contains("there is no light 5"));
}

}  // namespace
}  // namespace trueshade::viewer
