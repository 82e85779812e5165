// Faults planted in captures are convicted and named; legal captures have no finding.
#include <cstdio>
#include <limits>
#include <map>

#include "core/error.h"
#include "judge/diagnosis/finding.h"
#include "judge/stages/validate.h"
#include "scenes/builtin/builtin.h"
#include "scenes/pipeline/presets.h"
#include "tests/catch.hpp"
#include "tests/judge/captured.h"
#include "tests/judge/diagnosis/planted.h"
#include "tests/stated_presets.h"

namespace trueshade::testing {

using namespace trueshade::oracle;

namespace {

struct Score {
  int tries = 0, convicted = 0, first = 0, named = 0, blamed = 0;
  int beyond = 0;  ///< tries whose picture differs from a legal one in 100 pixels
  int beyond_convicted = 0;
  int unjust = 0;  ///< convicted although a right renderer may draw the picture
};

void add_try(const Ground& ground, const Plant& plant, int variant, std::map<std::string_view, Score>& all) {
  const PlantedTry t = planted_try(ground, plant, variant);
  if (t.changed < 100) return;
  Score& s = all[plant.name];
  const bool beyond = t.beyond >= 100;
  s.beyond += beyond, s.beyond_convicted += beyond && t.convicted, s.unjust += t.convicted && t.beyond == 0;
  ++s.tries, s.convicted += t.convicted, s.first += t.first, s.named += t.named, s.blamed += t.blamed;
  UNSCOPED_INFO(plant.name << ", " << ground.scene << ", " << ground.preset << ", " << name_of(ground.strategy) << ", "
                           << info(ground.target).name << ": " << t.found);
}

/// Each fault of those chosen on one ground, on the next where it changes too little; grounds and variants in turn.
std::map<std::string_view, Score> one_try_each(std::span<const Plant* const> chosen) {
  std::map<std::string_view, Score> all;
  for (size_t i = 0; i < chosen.size(); ++i) {
    const Plant& plant = *chosen[i];
    const std::vector<Ground> on = grounds(plant, plant.presets[i % plant.presets.size()], 1);
    for (size_t next = 0; next < on.size() && all.count(plant.name) == 0; ++next) {
      const Ground& ground = on[(5 * i + next) % on.size()];
      if (!plant.loops_only || !blends_lights(ground.strategy)) add_try(ground, plant, int(i) % plant.variants, all);
    }
  }
  return all;
}

/// Each fault of those chosen on one ground in `step`, variants in turn.
std::map<std::string_view, Score> scores(std::span<const Plant* const> chosen, int views, int step) {
  std::map<std::string_view, Score> all;
  int at = 0;
  for (const Plant* plant : chosen)
    for (const std::string_view preset : plant->presets)
      for (const Ground& ground : grounds(*plant, preset, views)) {
        if (plant->loops_only && blends_lights(ground.strategy)) continue;
        if (at++ % step != 0) continue;
        add_try(ground, *plant, at / step % plant->variants, all);
      }
  return all;
}

std::vector<const Plant*> plants_named(std::initializer_list<std::string_view> names) {
  std::vector<const Plant*> chosen;
  for (const std::string_view name : names)
    for (const Plant& p : plants())
      if (p.name == name) chosen.push_back(&p);
  REQUIRE(chosen.size() == names.size());
  return chosen;
}

Score sum(const std::map<std::string_view, Score>& scores) {
  Score all;
  for (const auto& [name, s] : scores) {
    all.tries += s.tries, all.convicted += s.convicted, all.first += s.first, all.named += s.named;
    all.blamed += s.blamed, all.beyond += s.beyond, all.beyond_convicted += s.beyond_convicted;
    all.unjust += s.unjust;
  }
  return all;
}

}  // namespace

TEST_CASE("Ten faults planted in three scenes are convicted and named first, by the plane that is wrong", "[slow]") {
  const std::vector<const Plant*> ten =
      plants_named({"picture upside down", "picture one pixel to the side", "channels as BGRA", "sRGB once too often",
                    "intensity a little off", "range a little off", "half vector without the viewer's sign",
                    "a light missing", "normals in view space in the G-buffer", "front faces culled"});
  const std::map<std::string_view, Score> found = one_try_each(ten);
  CHECK(found.size() == ten.size());
  const Score all = sum(found);
  CHECK(all.beyond_convicted == all.beyond);
  CHECK(all.unjust == 0);
  CHECK(10 * all.first >= 9 * all.tries);
  CHECK(all.blamed == all.named);
}

TEST_CASE("Lights that are one to five thousandths too bright or reach too far are named in planes of halves") {
  for (const char* spec : {"cornell", "circle,lights=24"})
    for (const float factor : {0.995f, 0.997f, 0.999f, 1.001f, 1.003f, 1.005f})
      for (const bool range : {false, true}) {
        const Scene scene = builtin_scene(spec);
        Pipeline pipeline = *preset_pipeline("many-lights");
        pipeline.width = 96, pipeline.height = 72, pipeline.target = Format::rgba16f;
        Scene wrong = scene;
        for (Light& l : wrong.lights)
          if (range)
            l.range *= factor;
          else
            l.color *= factor;
        const Capture capture = captured(wrong, pipeline);
        Profile profile;
        profile.subpixel_bits = 8;
        const Verdict verdict = validate_capture(scene, pipeline, capture, {profile, false, {}, {}});
        const std::vector<Finding> found = diagnose(scene, pipeline, profile, capture, verdict.stages);
        CAPTURE(spec, factor, range, verdict.violations(), findings_json(found));
        REQUIRE(found.size() >= 1);
        const std::string name = found[0].name;
        CHECK((name.starts_with(range ? "light-range=" : "light-intensity=") ||
               (!range && name.starts_with("picture-exposure="))));
        CHECK(std::stof(name.substr(name.find('=') + 1)) == Approx(factor).epsilon(0.0003));
        CHECK(found[0].explained > 0.9);
      }
}

TEST_CASE("Every fault planted in three scenes is convicted in 98 of 100 and named first in 90", "[long]") {
  std::vector<const Plant*> every;
  for (const Plant& p : plants()) every.push_back(&p);
  const std::map<std::string_view, Score> found = scores(every, 1, 5);
  for (const auto& [name, s] : found) {
    CAPTURE(name, s.tries, s.convicted, s.first);
    CHECK(100 * s.first >= 75 * s.tries);
  }
  const Score all = sum(found);
  CHECK(100 * all.beyond_convicted >= 98 * all.beyond);
  CHECK(all.unjust == 0);
  CHECK(100 * all.first >= 90 * all.tries);
}

TEST_CASE("Of two faults at once both are named in 70 of 100", "[long]") {
  int tries = 0, both = 0, variant = 0;
  for (const PlantedPair& pair : pairs_of_plants(60)) {
    const PlantedTry t = planted_try(pair.ground, *pair.one, variant++, pair.other);
    if (t.changed < 100 || t.both_matter < 100) continue;
    ++tries, both += t.named && t.second ? 1 : 0;
    UNSCOPED_INFO(pair.one->name << " + " << pair.other->name << ": " << t.found);
  }
  CHECK(tries >= 45);
  CHECK(100 * both >= 70 * tries);
}

TEST_CASE("Legal captures have no finding") {
  for (const char* spec : {"city,lights=60,objects=300", "cornell", "circle,lights=24"})
    for (const Preset& preset : stated_presets())
      for (const Strategy strategy : {Strategy::deferred_loop, Strategy::deferred_volumes}) {
        const Scene scene = builtin_scene(spec);
        Pipeline pipeline = preset.pipeline;
        pipeline.width = 64, pipeline.height = 48, pipeline.strategy = strategy;
        const Capture capture = captured(scene, pipeline);
        Profile profile;
        profile.subpixel_bits = 8;
        const Verdict verdict = validate_capture(scene, pipeline, capture, {profile, false, {}, {}});
        CAPTURE(spec, preset.name, name_of(strategy));
        CHECK(findings_json(diagnose(scene, pipeline, profile, capture, verdict.stages)) == "[]");
      }
}

TEST_CASE("What is supposed is tried alone, and names that are no fault's are refused") {
  const Scene scene = builtin_scene("cornell");
  Pipeline pipeline;
  pipeline.width = 64, pipeline.height = 48;
  Scene dim = scene;
  for (Light& l : dim.lights) l.color *= 0.9f;
  const Capture capture = captured(dim, pipeline);
  Profile profile;
  profile.subpixel_bits = 8;
  const Verdict verdict = validate_capture(scene, pipeline, capture, {profile, false, {}, {}});
  const auto supposed = [&](const std::string& name) {
    return diagnose(scene, pipeline, profile, capture, verdict.stages, {&name, 1});
  };
  const std::vector<Finding> right = supposed("light-intensity=0.9"), wrong = supposed("light-intensity=1.5");
  REQUIRE(right.size() == 1);
  REQUIRE(wrong.size() == 1);
  CHECK(right[0].explained > 0.98);
  CHECK(wrong[0].explained < 0.1);
  CHECK(right[0].proof.predicted == right[0].proof.given);
  CHECK(right[0].proof.right != right[0].proof.given);
  for (const std::string name : {"picture-flip-y", "falloff-other=quadratic"}) {
    const std::vector<Finding> other = supposed(name);
    REQUIRE(other.size() == 1);
    CHECK(other[0].name == name);
    CHECK(other[0].explained < 0.5);
  }
  for (const Finding& f : supposed("cull-face=front")) CHECK(f.explained < 0.5);  // of a few pixels at edges
  for (const char* name :
       {"light-intensity", "light-intensity=", "light-intensity=much", "picture-flip-y=1", "no-fault"}) {
    CAPTURE(name);
    CHECK_THROWS_AS(supposed(name), Error);
  }
}

TEST_CASE("A parameter that a fault does not take is refused in a line that says what it takes") {
  const Scene scene = builtin_scene("cornell");
  REQUIRE(scene.lights.size() < 100);
  Pipeline pipeline;
  pipeline.width = 32, pipeline.height = 24;
  Scene wrong = scene;
  for (Light& l : wrong.lights) l.color *= 0.5f;
  Pipeline culled = pipeline;
  culled.geometry.cull_face = CullFace::front;
  const Capture capture = captured(wrong, culled);
  Profile profile;
  profile.subpixel_bits = 8;
  const Verdict verdict = validate_capture(scene, pipeline, capture, {profile, false, {}, {}});
  REQUIRE(verdict.violations() > 100);
  // Empty where the name is taken.
  const auto refusal = [&](const std::string& name) -> std::string {
    try {
      diagnose(scene, pipeline, profile, capture, verdict.stages, {&name, 1});
    } catch (const Error& e) {
      CHECK(e.kind() == ErrorKind::usage);
      return e.what();
    }
    return {};
  };
  for (const KnownFault& fault : known_faults()) {
    const std::string bare = fault.name.substr(0, fault.name.find('='));
    const bool has_parameter = bare != fault.name;
    CAPTURE(bare);
    CHECK(refusal(bare).empty() != has_parameter);
    for (const char* garbage : {"", "nan", "-nan", "inf", "-inf", "1e10", "-1e300", "2147483648", "much", "1x"}) {
      CAPTURE(garbage);
      const std::string line = refusal(bare + "=" + garbage);
      CHECK(line.find(bare + " takes ") != std::string::npos);
      CHECK(line.find('\n') == std::string::npos);
    }
    for (const char* odd : {"-1", "0.5", "0", "1", "3", "7", "8"}) {
      CAPTURE(odd);
      const std::string line = refusal(bare + "=" + odd);
      CHECK((line.empty() || line.find(bare + " takes ") != std::string::npos));
    }
  }
  const std::string first_beyond = std::to_string(scene.lights.size());
  CHECK(refusal("light-missing=0").empty());
  CHECK(refusal("light-count=" + first_beyond).empty());
  CHECK(refusal("light-missing=" + first_beyond).find("light-missing takes a whole number from 0 to ") !=
        std::string::npos);
  CHECK(refusal("light-missing").find("'light-missing' needs its parameter after `=`") != std::string::npos);
  CHECK(refusal("object-missing=" + std::to_string(scene.instances.size())) != "");
  CHECK(refusal("tile-lists-16=0.5").find("tile-lists-16 takes 0, 1, 2, 3, 4, 5, 6, 7") != std::string::npos);
  CHECK(refusal("cull-face=sideways").find("cull-face takes none, front, back") != std::string::npos);
}

TEST_CASE("Findings are JSON whatever a file is called and whatever a number is") {
  Finding finding;
  finding.command = "trueshade validate 'a\n\"b\"\\.obj'";
  finding.proof.given = std::numeric_limits<double>::infinity();
  finding.proof.right = std::numeric_limits<double>::quiet_NaN();
  const std::string json = findings_json({&finding, 1});
  CAPTURE(json);
  CHECK(json.find(R"("command":"trueshade validate 'a\n\"b\"\\.obj'")") != std::string::npos);
  CHECK(json.find(R"("given":"inf","right":"nan","predicted":0)") != std::string::npos);
}

TEST_CASE("Every fault that is known has a name and a sentence of its own") {
  std::map<std::string, int> names, texts;
  for (const KnownFault& f : known_faults()) {
    CAPTURE(f.name, f.text);
    CHECK(++names[f.name] == 1);
    CHECK(++texts[f.text] == 1);
    CHECK(f.text.find('%') == std::string::npos);
    CHECK_FALSE(f.text.ends_with('.'));
  }
  CHECK(names.size() > 100);
}

}  // namespace trueshade::testing
