// `bench --standard`: what is drawn for a score, and the score.
#include <algorithm>
#include <cmath>

#include "cli/bench.h"
#include "cli/json_text.h"

namespace trueshade {
namespace {

/// Large and small triangles, lights summed and blended, textures, ambient and cones, and a larger picture.
constexpr struct {
  const char *scene, *preset;
  Size size;
} kRows[] = {{"builtin:city", "many-lights", {800, 800}},
             {"builtin:city", "light-volumes", {800, 800}},
             {"builtin:rabbits", "light-volumes", {800, 800}},
             {"builtin:sphere", "light-volumes", {800, 800}},
             {"builtin:red", "redsdk", {800, 800}},
             {"builtin:atrium", "punctual", {800, 800}},
             {"builtin:city", "many-lights", {1920, 1080}}};

constexpr const char* kFormula = "geometric mean of 1000 / least ms over the scenes";

/// Of one SIMD target, that a row has been drawn on.
const Timing& timing_on(const SceneTime& scene, const std::string& simd, const std::string& own) {
  if (simd == own) return scene.timing;
  return std::find_if(scene.peers.begin(), scene.peers.end(),
                      [&simd](const PeerTime& peer) { return peer.strategy == "simd=" + simd; })
      ->timing;
}

}  // namespace

std::vector<BenchOptions> standard_rows(const BenchOptions& options) {
  BenchOptions common = options;
  const std::vector<std::string_view> targets = simd_targets();
  for (size_t i = 1; i < targets.size(); ++i) common.against.push_back("simd=" + std::string(targets[i]));
  std::vector<BenchOptions> rows;
  for (const auto& row : kRows) {
    BenchOptions& added = rows.emplace_back(common);
    added.scenes = {row.scene};
    added.preset = row.preset;
    added.size = row.size;
  }
  return rows;
}

std::vector<Score> scores(const BenchResult& bench) {
  std::vector<Score> all;
  for (const std::string_view target : simd_targets()) {
    const std::string simd(target);
    double logarithms = 0;
    for (const SceneTime& scene : bench.scenes)
      logarithms += std::log(1000.0 / timing_on(scene, simd, bench.simd).least());
    all.push_back({simd, std::exp(logarithms / double(bench.scenes.size()))});
  }
  return all;
}

std::string scores_text(const BenchResult& bench) {
  std::string text =
      "\nstandard " + std::to_string(kStandard) + (bench.quick ? ", quick" : "") + ": " + kFormula + '\n';
  const std::vector<Score> all = scores(bench);
  for (const Score& score : all) {
    std::string name = score.simd;
    name.resize(std::max(name.size(), size_t(8)), ' ');
    text += "  " + name + formatted(score.value, "%8.1f") + '\n';
  }
  const size_t reasons = bench.all_reasons().size();
  const std::string quoted = reasons == 0 ? ""
                             : reasons == 1
                                 ? " (not to be quoted: a reason is above or below)"
                                 : " (not to be quoted: " + std::to_string(reasons) + " reasons are above or below)";
  return text + "  score   " + formatted(all.front().value, "%8.1f") + ", that of " + all.front().simd + quoted + '\n';
}

std::string scores_json(const BenchResult& bench) {
  JsonArray targets;
  const std::vector<Score> all = scores(bench);
  for (const Score& score : all) targets.add_raw(JsonObject().put("simd", score.simd).put("score", score.value).text());
  return JsonObject()
      .put("version", kStandard)
      .put("formula", kFormula)
      .put("score", all.front().value)
      .put_raw("targets", targets.text())
      .text();
}

}  // namespace trueshade
