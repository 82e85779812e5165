#include <fstream>
#include <sstream>

#include "core/simd/simd_target.h"
#include "programs/front/light_program.h"
#include "tests/catch.hpp"
#include "tests/programs/random_words.h"
#include "tests/programs/run_program.h"
#include "tests/shading/naive_lights.h"

namespace trueshade::programs {
namespace {

constexpr size_t kCount = 4 * kBatchLanes;  // of pixels; and a light for each block of them

std::string text_of_model(const std::string& name) {
  std::ifstream file(std::string(TRUESHADE_SOURCE_DIR) + "/tests/programs/models/" + name);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

float model_number(RandomWords& random, float low, float high) {
  return random() % 64 == 0 ? 0.0f : float_between(random, low, high);
}

/// Pixels and lights about each other, and planes of them by the names of a program's inputs.
struct Sample {
  std::vector<Pixel> pixels{kCount};
  Scene scene;
  std::map<std::string, std::vector<LaneBlock>> planes;

  explicit Sample(uint32_t seed) {
    RandomWords random(seed);
    for (Pixel& p : pixels) {
      p = {};
      p.position = {model_number(random, -3, 3), model_number(random, -3, 3), model_number(random, -3, 3)};
      p.normal = {model_number(random, -1, 1), model_number(random, -1, 1), model_number(random, -1, 1)};
      for (float& a : p.albedo) a = model_number(random, 0, 1);
    }
    scene.camera.eye = {0.5f, 1.0f, 4.0f};
    for (size_t i = 0; i < kCount / kBlockLanes; ++i) {
      Light light;
      light.type = LightType::point;
      light.position = {model_number(random, -3, 3), model_number(random, -3, 3), model_number(random, -3, 3)};
      light.color = {model_number(random, 0, 2), model_number(random, 0, 2), model_number(random, 0, 2)};
      light.range = model_number(random, 0.5f, 8);
      scene.lights.push_back(light);
    }
    const auto plane = [&](const std::string& name, size_t lanes, auto value) {
      auto& blocks = planes[name];
      blocks.resize((lanes + kBlockLanes - 1) / kBlockLanes);
      for (size_t i = 0; i < lanes; ++i) blocks[i / kBlockLanes].lane[i % kBlockLanes] = value(i);
    };
    for (int c = 0; c < 3; ++c) {
      const std::string end = std::string(".") + "xyz"[c];
      plane("surface.position" + end, kCount, [&](size_t i) { return (&pixels[i].position.x)[c]; });
      plane("surface.normal" + end, kCount, [&](size_t i) { return (&pixels[i].normal.x)[c]; });
      plane("surface.albedo" + end, kCount, [&](size_t i) { return pixels[i].albedo[c]; });
      plane("light.position" + end, scene.lights.size(), [&](size_t i) { return scene.lights[i].position[c]; });
      plane("light.color" + end, scene.lights.size(), [&](size_t i) { return scene.lights[i].color[c]; });
    }
    plane("light.range", scene.lights.size(), [&](size_t i) { return scene.lights[i].range; });
  }

  void bind(const Executable& executable, Rate rate, LaneValues& values) const {
    const auto& inputs = executable.at(rate).inputs;
    for (size_t i = 0; i < inputs.size(); ++i)
      values.set_input(i, planes.at(executable.program.inputs[inputs[i]].name)[0].lane);
  }
};

/// Holds what the program adds at every pixel, under the light of each block, to the naive loop's sum from +0.
void check_model(const std::string& name, const LightModel& model) {
  const Executable executable = executable_of(program_from_glsl(name, text_of_model(name)));
  const Sample sample(21);
  Registers registers(executable);
  ConstantValues constants(executable);
  const auto& inputs = executable.at(Rate::constant).inputs;
  for (size_t i = 0; i < inputs.size(); ++i)
    constants.set_input(i,
                        bits_of((&sample.scene.camera.eye.x)[executable.program.inputs[inputs[i]].name.back() - 'x']));
  run_constants(executable, constants, registers);
  LaneValues lights(executable.at(Rate::light), sample.scene.lights.size()),
      surfaces(executable.at(Rate::surface), kCount);
  sample.bind(executable, Rate::light, lights);
  sample.bind(executable, Rate::surface, surfaces);
  run_lights(executable, constants, lights, registers);
  run_surfaces(executable, constants, surfaces, nullptr, registers);
  int lit = 0;
  for (uint32_t turn = 0; turn < 8; ++turn)
    for (uint32_t first = 0; first < kCount; first += kBatchLanes) {
      PairBlock pairs[kBatchBlocks];
      for (uint32_t k = 0; k < kBatchBlocks; ++k)
        pairs[k] = {first + k * uint32_t(kBlockLanes), (k * 5 + turn * 3) % uint32_t(sample.scene.lights.size())};
      const PairResults out = run_pairs(executable, constants, lights, surfaces, pairs, registers);
      for (size_t lane = 0; lane < kBatchLanes; ++lane) {
        Scene one;
        one.camera = sample.scene.camera;
        one.lights = {sample.scene.lights[pairs[lane / kBlockLanes].light]};
        const auto wanted = naive_sum(one, model, sample.pixels[first + lane]);
        for (size_t c = 0; c < 3; ++c) {
          const float made = out.light[c][lane];
          REQUIRE(bits_of(0.0f + made) == bits_of(wanted[c]));
          lit += made > 0;
        }
      }
    }
  CHECK(lit > 1000);
}

}  // namespace

TEST_CASE("Presets written as GLSL have the bits of the naive light sum, on every SIMD target") {
  LightModel volumes;
  volumes.renormalize = false;
  volumes.specular = Specular::none;
  for (const std::string_view target : simd_targets()) {
    const SimdScope scope(target);
    check_model("many_lights.glsl", LightModel());
    check_model("light_volumes.glsl", volumes);
  }
}

}  // namespace trueshade::programs
