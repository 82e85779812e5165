// Draws built-in scenes under every preset and some strategies with a driver of this machine (llvmpipe, softpipe, or
// lavapipe of Vulkan), each frame once, and judges it by several profiles: one line a stage, appended to a file. A
// frame whose lines are there already is not drawn again, so a long run may be broken off and gone on with. Made
// into tables by scripts/validation_table.sh.
//
//   validation_rows DRIVER SUBPIXEL-BITS SIZE PROFILE,... STRATEGY,... FILE SCENE...
//
// Tab-separated: scene, strategy, preset, profile, driver, size, stage, pixels with a surface, the classes' counts,
// pixels of other surfaces or branches, how many were predicted, 1 where no known rounding makes the stage, s that
// judging took.
#include <chrono>
#include <cstdio>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <sstream>

#include "core/error.h"
#include "gl/driver/renderer.h"
#include "judge/stages/validate.h"
#include "scenes/builtin/builtin.h"
#include "scenes/pipeline/presets.h"
#include "tests/judge/row_drawer.h"
#include "tests/stated_presets.h"

using namespace trueshade;
using namespace trueshade::oracle;

namespace {

std::vector<std::string> listed(const std::string& text) {
  std::vector<std::string> out;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, ',');) out.push_back(part);
  return out;
}

struct Request {
  GlDriver driver = GlDriver::any;
  std::string driver_name, size;
  int width = 0, height = 0;
  std::vector<Profile> profiles;
  std::vector<Strategy> strategies;
  std::string file;
};

/// What a line begins with, up to its stage.
std::string key_of(const Request& r, const std::string& scene, const Pipeline& p, const Profile& profile) {
  return scene + '\t' + std::string(name_of(p.strategy)) + '\t' + p.preset + '\t' + profile.name + '\t' +
         r.driver_name + '\t' + r.size;
}

/// Of frames whose target is judged: the last of their lines.
std::set<std::string> keys_in(const std::string& file) {
  std::set<std::string> keys;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    size_t end = 0;
    for (int tab = 0; tab < 6 && end != std::string::npos; ++tab) end = line.find('\t', end + 1);
    if (end != std::string::npos && line.compare(end + 1, 8, "gbuffer\t") != 0) keys.insert(line.substr(0, end));
  }
  return keys;
}

using Judge = std::function<StageVerdict(const Profile&)>;

void append(const Request& r, const std::string& key, const StageVerdict& v, double seconds, const Profile& profile,
            const Judge& judge) {
  constexpr double kStages = 2, kLeastChance = 1e-6 / (kStages * double(kAggregateTests));
  const Evidence evidence = evidence_of(v, judge, profile, kLeastChance);
  if (evidence.against) {
    const AggregateTest& t = evidence.least_likely();
    std::printf("  %s: %g where %g to %g are expected, %s\n", t.name.c_str(), t.observed, t.low, t.high,
                t.where.c_str());
  }
  std::ostringstream line;
  line << key << '\t' << v.stage << '\t' << v.covered;
  for (const uint64_t count : v.counts) line << '\t' << count;
  line << '\t' << v.explained() << '\t' << v.predicted_other << '\t' << evidence.against << '\t' << seconds << '\n';
  std::ofstream(r.file, std::ios::app) << line.str();
  std::fputs(line.str().c_str(), stdout);
  std::fflush(stdout);
  if (!v.worst.empty() && v.worst.front().pixel_class == PixelClass::violation) {
    const WorstPixel& w = v.worst.front();
    std::printf("  %d,%d %s %.9g to %.9g given %.9g: %s\n", w.x, w.y, w.plane.c_str(), w.low, w.high, w.given,
                w.note.c_str());
  }
}

/// A scene on the driver, and the G-buffers of it that were judged.
class Table {
 public:
  /// `context`: null for lavapipe.
  Table(const Request& request, const GlContext* context, std::string name)
      : r_(request), name_(std::move(name)), scene_(builtin_scene(name_)) {
    if (context == nullptr) {
      draw_ = testing::lavapipe_drawer(scene_);
      return;
    }
    renderer_ = std::make_unique<GlRenderer>(*context, scene_);
    draw_ = [this](const Pipeline& pipeline, const StepSink& sink) {
      GlDraw draw;
      draw.after_light = sink;
      return renderer_->draw(pipeline, draw).capture;
    };
  }

  void add(const Pipeline& asked, std::vector<Profile> profiles) {
    const Capture capture = draw_(asked, {});
    Pipeline pipeline = asked;
    pipeline.gbuffer = surface_planes(asked);
    for (const Profile& profile : profiles) {
      const std::string key = key_of(r_, name_, asked, profile);
      const auto [geometry, seconds] = judged_geometry(asked, capture, profile);
      append(r_, key, geometry, seconds, profile,
             [&](const Profile& p) { return judge_gbuffer(scene_, pipeline, p, capture); });
    }
    if (blends_lights(asked.strategy)) return add_blending(asked, pipeline, capture, profiles);
    for (const Profile& profile : profiles) add_lighting(asked, pipeline, capture, profile);
  }

 private:
  void add_lighting(const Pipeline& asked, const Pipeline& pipeline, const Capture& capture, const Profile& profile) {
    StageVerdict v;
    const Judge judge = [&](const Profile& p) { return judge_lighting(scene_, pipeline, p, capture); };
    const double seconds = timed([&] { v = judge(profile); });
    append(r_, key_of(r_, name_, asked, profile), v, seconds, profile, judge);
  }

  /// A target that looks at it change (softpipe's) is judged by its last state too.
  void add_blending(const Pipeline& asked, const Pipeline& pipeline, const Capture& capture,
                    const std::vector<Profile>& profiles) {
    bool same = true;
    const LightSteps steps = [&](const StepSink& sink) {
      draw_(asked, [&](int light, const Image& target) {
        if (light + 1 == int(scene_.lights.size())) same = target.texels == capture.color.texels;
        sink(light, target);
      });
    };
    std::vector<StageVerdict> verdicts;
    const double seconds = timed([&] { verdicts = judge_blending(scene_, pipeline, profiles, capture, steps); });
    for (size_t i = 0; i < profiles.size(); ++i)
      append(r_, key_of(r_, name_, asked, profiles[i]), verdicts[i], seconds, profiles[i],
             [&](const Profile& p) { return judge_blending(scene_, pipeline, p, capture, steps); });
    for (size_t i = 0; i < profiles.size() && !same; ++i) add_lighting(asked, pipeline, capture, profiles[i]);
  }

  /// Presets and strategies share G-buffers: what has the same bits in the same formats has the same verdict.
  std::pair<StageVerdict, double> judged_geometry(const Pipeline& asked, const Capture& capture,
                                                  const Profile& profile) {
    Capture planes = capture;
    planes.color = {};
    std::string bits;
    for (const NamedImage& plane : planes.planes)
      bits += plane.name + name_of_bits(plane.image) + (reads_specular_plane(asked.light_model) ? "s" : "") +
              (asked.light_model.emission ? "e" : "") + ' ';
    const auto found = judged_.find(profile.name + bits);
    if (found != judged_.end()) return found->second;
    Verdict v;
    const double seconds = timed([&] { v = validate_capture(scene_, asked, planes, {profile, false, {}}); });
    return judged_[profile.name + bits] = {v.stages.front(), seconds};
  }

  static std::string name_of_bits(const Image& image) {
    const std::string_view bytes(reinterpret_cast<const char*>(image.texels.data()), image.texels.size());
    return std::string(info(image.format).name) + std::to_string(std::hash<std::string_view>()(bytes));
  }

  template <class Job>
  static double timed(const Job& job) {
    const auto start = std::chrono::steady_clock::now();
    job();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }

  const Request& r_;
  const std::string name_;
  const Scene scene_;
  std::unique_ptr<GlRenderer> renderer_;  ///< of an OpenGL driver
  testing::RowDrawer draw_;
  std::map<std::string, std::pair<StageVerdict, double>> judged_;
};

Request request_of(char** argument) {
  Request r;
  r.driver_name = argument[1];
  r.driver = r.driver_name == "softpipe"   ? GlDriver::softpipe
             : r.driver_name == "llvmpipe" ? GlDriver::llvmpipe
                                           : GlDriver::any;
  r.size = argument[3];
  if (std::sscanf(argument[3], "%dx%d", &r.width, &r.height) != 2)
    throw Error(ErrorKind::usage, "size", "is not WxH", "say 400x300");
  for (const std::string& name : listed(argument[4])) {
    const std::optional<Profile> profile = profile_named(name);
    if (!profile) throw Error(ErrorKind::usage, name, "is no profile", "see trueshade list");
    r.profiles.push_back(*profile);
    r.profiles.back().subpixel_bits = std::max(profile->subpixel_bits, std::atoi(argument[2]));
  }
  for (const std::string& name : listed(argument[5]))
    for (size_t s = 0; s < std::size(kStrategyNames); ++s)
      if (name == kStrategyNames[s]) r.strategies.push_back(Strategy(s));
  r.file = argument[6];
  return r;
}

}  // namespace

int main(int count, char** argument) {
  try {
    if (count < 8) throw Error(ErrorKind::usage, "arguments", "are missing", "see the head of this file");
    const Request request = request_of(argument);
    std::optional<GlContext> context;
    if (request.driver_name != "lavapipe") context.emplace(request.driver);
    for (int i = 7; i < count; ++i) {
      std::optional<Table> table;
      const std::set<std::string> done = keys_in(request.file);
      for (const Strategy strategy : request.strategies)
        for (const Preset& preset : stated_presets()) {
          Pipeline pipeline = preset.pipeline;
          pipeline.preset = preset.name;
          pipeline.strategy = strategy;
          pipeline.width = request.width, pipeline.height = request.height;
          std::vector<Profile> left;
          for (const Profile& profile : request.profiles)
            if (!done.contains(key_of(request, argument[i], pipeline, profile))) left.push_back(profile);
          if (left.empty()) continue;
          if (!table) table.emplace(request, context ? &*context : nullptr, argument[i]);
          try {
            table->add(pipeline, left);
          } catch (const Error& error) {
            std::printf("%s %s %s: %s\n", argument[i], std::string(preset.name).c_str(),
                        std::string(name_of(strategy)).c_str(), error.what());
          }
        }
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "validation_rows: %s\n", error.what());
    return 1;
  }
}
