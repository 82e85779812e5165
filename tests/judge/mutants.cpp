// Fifty-seven wrong renderers: each must be rejected wherever it leaves a legal set.
#include "tests/judge/mutants/mutants.h"

#include "tests/catch.hpp"
#include "tests/judge/captured.h"
#include "tests/judge/wrong_renderers.h"

using namespace trueshade;
using namespace trueshade::oracle;

namespace {

void try_our_frames(testing::Tries tries) {
  std::vector<Profile> profiles;
  for (const char* name : {"ideal", "d3d-class", "unknown"}) {
    profiles.push_back(*profile_named(name));
    profiles.back().subpixel_bits = 8;
  }
  const Renderer renderer = [](const Scene& s, const Pipeline& p) { return testing::captured(s, p); };
  testing::try_mutants(profiles, renderer, 2, {}, {}, tries);
  CHECK(mutants().size() == 57);
}

}  // namespace

TEST_CASE("Wrong renderers are rejected wherever they leave the legal sets") { try_our_frames(testing::Tries::half); }
TEST_CASE("Wrong renderers are rejected on every picture where they leave the legal sets", "[long]") {
  try_our_frames(testing::Tries::all);
}
