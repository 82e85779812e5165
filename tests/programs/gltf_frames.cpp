// Frames of the preset gltf against the oracle's interpreter of SPIR-V: the planes of a frame and the scene's lights go
// through the model's text, and the sum is taken in f32 in the order of the lights.
#include <bit>
#include <string>
#include <vector>

#include "core/half.h"
#include "oracle/spirv_interpreter.h"
#include "scenes/builtin/builtin.h"
#include "scenes/light_cone.h"
#include "scenes/pipeline/presets.h"
#include "shading/frame.h"
#include "tests/catch.hpp"
#include "tests/programs/oracle/compiled_light.h"
#include "tests/programs/oracle/program_inputs.h"

using namespace trueshade;

namespace {

using Words = std::vector<uint32_t>;

uint32_t bits_of(float value) { return std::bit_cast<uint32_t>(value); }
Words words_of(const glm::vec3& v) { return {bits_of(v.x), bits_of(v.y), bits_of(v.z)}; }

/// What the programs are given: 0 where the model reads nothing.
oracle::SpirvScalars no_inputs() {
  oracle::SpirvScalars inputs;
  for (const testing::ProgramInput& input : testing::interface_inputs())
    inputs[input.name] = Words(size_t(input.scalars), 0);
  return inputs;
}

void set_surface(const Frame& frame, int x, int y, oracle::SpirvScalars& inputs) {
  const auto texel = [&](size_t plane, int first, int count) {
    Words words;
    for (int c = first; c < first + count; ++c) words.push_back(bits_of(float(frame.aovs[plane].image.value(x, y, c))));
    return words;
  };
  const std::string surface = "TsSurface.ts_surface.";
  inputs[surface + "position"] = texel(0, 0, 3);
  inputs[surface + "normal"] = texel(1, 0, 3);
  inputs[surface + "albedo"] = texel(2, 0, 4);
  inputs[surface + "metallic"] = texel(3, 0, 1);
  inputs[surface + "roughness"] = texel(3, 1, 1);
  inputs[surface + "emission"] = texel(4, 0, 3);
  inputs[surface + "occlusion"] = texel(4, 3, 1);
}

void set_light(const Light& light, oracle::SpirvScalars& inputs) {
  const std::string name = "TsLight.ts_light.";
  const LightCone cone(light);
  inputs[name + "type"] = {uint32_t(light.type)};
  inputs[name + "position"] = words_of(light.position);
  inputs[name + "range"] = {bits_of(light.range)};
  inputs[name + "direction"] = words_of(light.direction);
  inputs[name + "color"] = words_of(light.color);
  inputs[name + "cone_scale"] = {bits_of(cone.scale)};
  inputs[name + "cone_offset"] = {bits_of(cone.offset)};
}

glm::vec3 result_of(const oracle::SpirvScalars& outputs, const char* name) {
  const Words& words = outputs.at(std::string("TsResult.") + name);
  return {std::bit_cast<float>(words[0]), std::bit_cast<float>(words[1]), std::bit_cast<float>(words[2])};
}

/// The colour of a pixel that shows a surface.
glm::vec3 expected_at(const oracle::SpirvModule& module, const Scene& scene, oracle::SpirvScalars& inputs) {
  glm::vec3 sum(0.0f);
  for (size_t i = 0; i < scene.lights.size(); ++i) {
    set_light(scene.lights[i], inputs);
    const oracle::SpirvScalars outputs = run_spirv(module, inputs);
    if (i == 0) sum = result_of(outputs, "start");
    const glm::vec3 term = result_of(outputs, "light");
    if (term != glm::vec3(0.0f)) sum += term;
  }
  return sum;
}

}  // namespace

TEST_CASE("Frames of the preset gltf have the oracle's bits at pixels all over each built-in scene") {
  Pipeline pipeline = *preset_pipeline("gltf");
  pipeline.width = 200, pipeline.height = 150;
  const oracle::SpirvModule module = oracle::spirv_module(
      testing::compiled_shader(testing::whole_shader(pipeline.light_program.text, false, true, false)));
  for (const char* name : {"city", "rabbits", "sphere", "red", "cornell", "circle", "atrium", "lecture"}) {
    const Scene scene = builtin_scene(name);
    const PreparedScene prepared(scene);
    const std::vector<std::string> planes{"position", "normal", "albedo", "specular", "emission", "id.object"};
    const Frame stored = render_frame(prepared, pipeline, {}, planes);
    pipeline.target = Format::rgba32f;
    const Frame frame = render_frame(prepared, pipeline);
    pipeline.target = Format::rgba16f;
    oracle::SpirvScalars inputs = no_inputs();
    inputs["TsView.ts_view.eye"] = words_of(scene.camera.eye);
    const int step = scene.lights.size() > 100 ? 29 : 11;
    int compared = 0, lit = 0, apart = 0, rounded = 0;
    for (int y = 3; y < pipeline.height; y += step)
      for (int x = 3; x < pipeline.width; x += step) {
        if (stored.aovs[5].image.code(x, y, 0) == 0) continue;
        set_surface(stored, x, y, inputs);
        const glm::vec3 expected = expected_at(module, scene, inputs);
        ++compared, lit += expected.y > 0.0f;
        for (int c = 0; c < 3; ++c) {
          apart += bits_of(float(frame.color.value(x, y, c))) != bits_of(expected[c]);
          rounded += stored.color.code(x, y, c) != half_from_float(expected[c], pipeline.gbuffer.half_round);
        }
      }
    CAPTURE(name, compared, lit);
    CHECK(compared > 10);
    CHECK(lit > compared / 2);
    CHECK(apart == 0);
    CHECK(rounded == 0);
  }
}
