// What drivers draw under lights with an area is explained, and what is planted there is found.
#include <algorithm>
#include <glm/geometric.hpp>

#include "core/error.h"
#include "gl/driver/renderer.h"
#include "judge/diagnosis/finding.h"
#include "judge/stages/validate.h"
#include "tests/area_scenes.h"
#include "tests/catch.hpp"
#include "tests/judge/captured.h"
#include "tests/judge/drivers.h"

using namespace trueshade;
using namespace trueshade::oracle;
using namespace trueshade::testing;

namespace {

using Drawer = std::function<Capture(const Scene&, const Pipeline&)>;

void check_five_scenes(const Drawer& drawn, const char* profile) {
  for (const std::string_view name : kAreaScenes)
    for (const char* const model : {"area", "area-lambert"}) {
      const Scene scene = area_scene(name);
      const Pipeline pipeline = area_pipeline(model, 72, 54);
      ValidateOptions options;
      options.profile = *profile_named(profile);
      options.profile.subpixel_bits = 8;
      const Verdict verdict = validate_capture(scene, pipeline, drawn(scene, pipeline), options);
      uint64_t lit = 0;
      for (const StageVerdict& stage : verdict.stages) lit = std::max(lit, stage.covered);
      INFO(name << ", " << model << ": " << verdict.violations() << " violations");
      CHECK(verdict.violations() == 0);
      CHECK(lit > 1000);
    }
}

/// What an engine does otherwise: to the scene's lights, or in the program's text.
struct Planted {
  const char* scene;
  const char* name;  ///< of the finding; "line": that of the text
  void (*change)(Scene& scene) = nullptr;
  const char* right = nullptr;
  const char* wrong = nullptr;
};

template <class Change>
void each(Scene& scene, const Change& change) {
  for (Light& l : scene.lights) change(l);
}

const Planted kPlanted[] = {
    {"box", "light-extents=2", [](Scene& s) { each(s, [](Light& l) { l.right *= 2.0f, l.up *= 2.0f; }); }},
    {"box", "light-extents=0.5", [](Scene& s) { each(s, [](Light& l) { l.right *= 0.5f, l.up *= 0.5f; }); }},
    {"box", "light-extents-swapped",
     [](Scene& s) {
       each(s, [](Light& l) {
         const glm::vec3 right = l.right;
         if (l.type == LightType::rectangle)
           l.right *= glm::length(l.up) / glm::length(right), l.up *= glm::length(right) / glm::length(l.up);
       });
     }},
    {"box", "light-directions-turned",
     [](Scene& s) {
       each(s, [](Light& l) {
         if (row_of(l.type).is_aimed) l.right = -l.right, l.direction = -l.direction;
       });
     }},
    {"box", "light-both-sides",
     [](Scene& s) {
       const std::vector<Light> all = s.lights;
       for (Light l : all)
         if (row_of(l.type).is_aimed) l.right = -l.right, l.direction = -l.direction, s.lights.push_back(l);
     }},
    {"box", "light-power",
     [](Scene& s) {
       each(s, [](Light& l) {
         const float right = glm::length(l.right), up = glm::length(l.up);
         const float area = l.type == LightType::sphere ? 3.14159265f * right * right
                            : l.type == LightType::disk ? 3.14159265f * right * up
                                                        : 4 * right * up;
         l.color /= area;
       });
     }},
    {"box", "light-missing=2", [](Scene& s) { s.lights[2].color = glm::vec3(0); }},
    {"box", "line", nullptr, "return max(sum + edge(leaves, enters, n), 0.0) / (2.0 * pi);",
     "return max(sum, 0.0) / (2.0 * pi);"},
    {"box", "line", nullptr, "if (za < 0.0) from = enters = between;", "if (za < 0.0) enters = between;"},
    {"mixed", "line", nullptr, "return clamp(1.0 - part * part, 0.0, 1.0);\n}\n\n// What", "return 1.0;\n}\n\n// What"},
    {"columns", "line", nullptr, "  d *= a2 * inversesqrt((a2 + w * k) * (a2 + w / k));\n", ""},
    {"columns", "line", nullptr, "float a = max(s.roughness * s.roughness, 0.001), a2",
     "float a = max(s.roughness, 0.001), a2"},
};

struct Found {
  int convicted = 0, named = 0;
};

Found found() {
  Found out;
  const Pipeline pipeline = area_pipeline("area", 48, 36);
  for (const Planted& planted : kPlanted) {
    const Scene scene = area_scene(planted.scene);
    Scene wrong = scene;
    Pipeline drawn = pipeline;
    std::string name = planted.name;
    if (planted.change != nullptr) planted.change(wrong);
    if (planted.right != nullptr) {
      std::string& text = drawn.light_program.text;
      const size_t at = text.find(planted.right);
      REQUIRE(at != std::string::npos);
      name = "light-shader-line-" + std::to_string(1 + std::count(text.begin(), text.begin() + ptrdiff_t(at), '\n'));
      text.replace(at, std::string(planted.right).size(), planted.wrong);
      drawn.light_program.file = "engine.glsl", drawn.light_program.sha256.clear();
    }
    const Capture capture = captured(wrong, drawn);
    const Verdict verdict = validate_capture(scene, pipeline, capture);
    out.convicted += verdict.violations() > 0;
    std::string said;
    const std::vector<Finding> findings = diagnose(scene, pipeline, Profile{}, capture, verdict.stages);
    for (const Finding& f : findings) said += "\n    " + f.name + ", " + std::to_string(f.explained) + ": " + f.text;
    const bool is_named = !findings.empty() && findings[0].name.starts_with(name);
    out.named += is_named;
    if (!is_named || verdict.violations() == 0)
      WARN(planted.scene << ", " << name << ": " << verdict.violations() << " violations" << said);
  }
  return out;
}

}  // namespace

TEST_CASE("What engines do otherwise under lights with an area is convicted, and nearly all of it named", "[long]") {
  const Found all = found();
  CHECK(all.convicted == int(std::size(kPlanted)));
  CHECK(all.named >= 10);  // of 12
}

TEST_CASE("Five scenes under lights with an area, drawn by llvmpipe, are explained pixel by pixel", "[long]") {
  const GlContext* const context = opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  check_five_scenes([&](const Scene& scene, const Pipeline& p) { return GlRenderer(*context, scene).draw(p).capture; },
                    "unknown");
}
