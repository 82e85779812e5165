#include "programs/front/light_program.h"

#include "core/error.h"
#include "tests/catch.hpp"
#include "tests/programs/run_program.h"

namespace trueshade::programs {

TEST_CASE("A light program of few lines adds what its formula says") {
  const Program program = program_of_light("  return l.color * dot(s.normal, l.position - s.position);");
  const std::vector<float> light = light_of(program, {{"light.color.x", 2.0f}, {"light.color.y", 3.0f},
                                                      {"surface.normal.z", 1.0f}, {"light.position.z", 5.0f},
                                                      {"surface.position.z", 1.0f}});
  CHECK(light == std::vector<float>{8.0f, 12.0f, 0.0f});
  INFO(text_of(program));
  CHECK(program.nodes.size() < 40);
}

}  // namespace trueshade::programs
