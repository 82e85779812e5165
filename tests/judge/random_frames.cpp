#include "tests/judge/random_frames.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <numeric>

#include "core/error.h"
#include "judge/bounds/profile_file.h"
#include "judge/stages/validate.h"
#include "scenes/pipeline/transparency.h"
#include "tests/catch.hpp"
#include "tests/file_contents.h"

namespace trueshade::testing {

using namespace oracle;

namespace {

LightSteps shown(const std::vector<std::pair<int, Image>>& steps) {
  return [&steps](const StepSink& sink) {
    for (const auto& [index, target] : steps) sink(index, target);
  };
}

/// The first pixel in no legal set, or the evidence against the whole image.
std::string reason_of(const Verdict& v) {
  for (const StageVerdict& stage : v.stages) {
    if (stage.passes()) continue;
    const WorstPixel& w = stage.worst.front();
    char text[256];
    std::snprintf(text, sizeof text, "%s: %llu violations, at (%d, %d) %s is %.9g, legal [%.9g, %.9g], %s",
                  stage.stage.c_str(), static_cast<unsigned long long>(stage.count(PixelClass::violation)), w.x, w.y,
                  w.plane.c_str(), w.given, w.low, w.high, w.note.c_str());
    return text;
  }
  return v.evidence_line();
}

class FrameTrial {
 public:
  explicit FrameTrial(const RandomFrames& asked) : asked_(asked), profile_(asked.profile) {
    if (const char* const file = std::getenv("LEGAL_PROFILE"); file != nullptr && *file != '\0')
      profile_ = profile_from_json(contents(file), file);
  }

  void judge(uint64_t seed, const FrameDrawer& drawer) {
    const RandomFrame frame = random_frame(seed, asked_.theme);
    DrawnFrame drawn;
    try {
      drawn = drawer(frame);
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::no_gl_driver && error.kind() != ErrorKind::limit) throw;
      const std::string why = error.what();
      ++refused_[why.substr(0, why.rfind(" ("))];  // without the remedy
      return;
    }
    if (asked_.left_out)
      if (const std::string why = asked_.left_out(frame, drawn); !why.empty()) {
        ++refused_[why];
        return;
      }
    profile_.subpixel_bits = drawn.subpixel_bits;
    try {
      hold(seed, frame, drawn);
    } catch (const Error& error) {
      alarm(seed, frame, "cannot be judged", error.what());
    }
  }

  void tell() const {
    int refused = 0;
    for (const auto& [why, count] : refused_) refused += count;
    const auto share = [](uint64_t part, uint64_t of) {
      return 100 * double(part) / double(std::max<uint64_t>(1, of));
    };
    std::printf(
        "random frames by %s under %s, theme %d: %d, not drawn %d, alarms %d; %.3f %% of the pixels exact, %.3f %% "
        "of the lit ones undefined\n",
        asked_.drawer.c_str(), profile_.name.c_str(), int(asked_.theme), asked_.count, refused, alarms_,
        share(exact_, judged_), share(undefined_, covered_));
    for (const auto& [why, count] : refused_) std::printf("  not drawn %d: %s\n", count, why.c_str());
    std::fflush(stdout);
    CHECK(alarms_ == 0);
    if (asked_.theme == FrameTheme::light_program) CHECK(undefined_ * 10 <= covered_);
    CHECK(refused <= int(asked_.most_refused * asked_.count));
  }

 private:
  /// As a capture from files, and draw by draw.
  void hold(uint64_t seed, const RandomFrame& frame, const DrawnFrame& drawn) {
    hold(seed, frame, drawn, {profile_, false, {}, {}});
    if (!drawn.shows_steps) return;
    ValidateOptions options{profile_, false, {}, {}};
    if (blends_lights(frame.pipeline.strategy)) options.steps = shown(drawn.lights);
    if (draws_transparent(frame.scene, frame.pipeline)) options.objects = shown(drawn.objects);
    if (options.steps || options.objects) hold(seed, frame, drawn, options);
  }

  void hold(uint64_t seed, const RandomFrame& frame, const DrawnFrame& drawn, const ValidateOptions& options) {
    const Verdict v = validate_capture(frame.scene, frame.pipeline, drawn.capture, options);
    for (const StageVerdict& stage : v.stages)
      if (stage.stage == "lighting") {
        covered_ += stage.covered, undefined_ += stage.count(PixelClass::undefined);
        exact_ += stage.count(PixelClass::exact);
        judged_ += std::accumulate(stage.counts.begin(), stage.counts.end(), uint64_t(0));
      }
    if (v.violations() == 0 && !v.convicted()) return;
    alarm(seed, frame, options.steps || options.objects ? "draw by draw" : "as a file", reason_of(v));
  }

  void alarm(uint64_t seed, const RandomFrame& frame, const char* how, const std::string& reason) {
    ++alarms_;
    WARN(asked_.drawer << ", frame " << seed << " of theme " << int(asked_.theme) << " " << how << ", "
                       << name_of(frame.pipeline.strategy) << " " << info(frame.pipeline.target).name << ": "
                       << reason);
  }

  const RandomFrames& asked_;
  Profile profile_;
  std::map<std::string, int> refused_;  ///< by what is in the way
  int alarms_ = 0;
  uint64_t covered_ = 0, undefined_ = 0, exact_ = 0, judged_ = 0;  ///< pixels of the stage of the lights
};

}  // namespace

void check_random_frames(const RandomFrames& asked, const FrameDrawer& drawer) {
  FrameTrial trial(asked);
  for (int i = 0; i < asked.count; ++i) trial.judge(asked.first + uint64_t(i), drawer);
  trial.tell();
}

int long_count(int usual) {
  const char* const asked = std::getenv("LEGAL_FRAMES");
  return asked != nullptr ? std::max(1, std::atoi(asked)) : usual;
}

uint64_t long_first(uint64_t usual) {
  const char* const asked = std::getenv("LEGAL_FIRST");
  return asked != nullptr ? std::strtoull(asked, nullptr, 10) : usual;
}

}  // namespace trueshade::testing
