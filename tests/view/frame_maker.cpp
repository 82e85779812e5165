#include "view/frame_maker.h"

#include <atomic>
#include <chrono>
#include <functional>
#include <stdexcept>
#include <thread>

#include "tests/catch.hpp"
#include "tests/scratch_folder.h"
#include "tests/view/opened.h"

namespace trueshade::viewer {
namespace {

/// Waits until something holds; fails after 20 s.
void until(const std::function<bool()>& holds) {
  for (int i = 0; i < 4000 && !holds(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  REQUIRE(holds());
}

TEST_CASE("A job that was sent before another scene was loaded meets that scene with its own picture") {
  std::atomic<size_t> lights_of_scene{0}, lights_of_picture{0};
  OpenedScene first = opened("builtin:circle,lights=5");
  ViewState state;
  state.revision = 1;
  state.pipeline = first.facts.pipeline;
  FrameMaker maker(std::move(first.scene), {}, [] {});
  maker.ask(state);
  until([&] { return maker.newest() != nullptr; });
  maker.replace([&] {
    maker.send([&](EditedScene& scene, const DrawnPicture& picture) {
      lights_of_picture = picture.lights.size();
      lights_of_scene = scene.scene().lights.size();
    });
    return std::move(opened("builtin:circle,lights=7").scene);
  });
  until([&] { return lights_of_scene != 0; });
  CHECK(lights_of_scene == 7);
  CHECK(lights_of_picture == 7);
}

TEST_CASE("A state that cannot be drawn is refused with its jobs, and the next one is drawn") {
  const ScratchFolder folder;
  OpenedScene opened_file = opened(folder.write("scene.json", R"({"version": 1, "objects": [{"mesh": "cube"}],
    "camera": {"target": [0, 0, 0], "steps": [{"time": 0, "eye": [0, 0, 4]}, {"time": 2, "eye": [0, 0, 0]}]}})"));
  std::atomic<int> jobs{0};
  ViewState state;
  state.pipeline = opened_file.facts.pipeline;
  FrameMaker maker(std::move(opened_file.scene), {}, [] {});
  const auto show = [&](double time) {
    ++state.revision;
    state.time = time;
    maker.ask(state);
    maker.send([&](EditedScene&, const DrawnPicture&) { ++jobs; });
    until([&] { return !maker.busy(); });
  };
  show(0.0);
  CHECK(jobs == 1);
  CHECK_FALSE(maker.is_refused(1));
  show(2.0);
  CHECK(jobs == 1);
  CHECK(maker.is_refused(2));
  CHECK(maker.take_problem().value_or("").find("camera") != std::string::npos);
  maker.send([&](EditedScene&, const DrawnPicture&) { ++jobs; });
  until([&] { return !maker.busy(); });
  CHECK(maker.take_problem().value_or("").find("there is none of what is asked for") != std::string::npos);
  show(1.0);
  CHECK(jobs == 2);
  CHECK_FALSE(maker.is_refused(3));
  CHECK(maker.newest()->state.revision == 3);
}

TEST_CASE("A fault of a job's is told of, and the next job is done") {
  OpenedScene scene = opened("builtin:cornell");
  ViewState state;
  state.revision = 1;
  state.pipeline = scene.facts.pipeline;
  FrameMaker maker(std::move(scene.scene), {}, [] {});
  maker.ask(state);
  maker.send([](EditedScene&, const DrawnPicture&) { throw std::runtime_error("a fault"); });
  std::atomic<bool> done{false};
  maker.send([&](EditedScene&, const DrawnPicture&) { done = true; });
  until([&] { return bool(done); });
  CHECK(maker.take_problem() == std::optional<std::string>("internal: a fault (please report it)"));
}

}  // namespace
}  // namespace trueshade::viewer
