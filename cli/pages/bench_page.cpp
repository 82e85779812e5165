#include <utility>

#include "cli/bench.h"
#include "cli/pages/page.h"
#include "cli/pages/svg_chart.h"
#include "cli/version.h"

namespace trueshade {
namespace {

std::string card(const std::string& title, const std::string& chart) {
  return "<figure class=chart><b>" + escaped(title) + "</b>\n" + chart + "</figure>\n";
}

std::string about(const SceneTime& s) {
  return s.pipeline.preset + ", " + std::to_string(s.pipeline.width) + " x " + std::to_string(s.pipeline.height);
}

std::string against_peers(const SceneTime& s) {
  std::vector<Bar> bars{{"trueshade", s.timing.median(), formatted(s.timing.median(), "%.2f ms"), true}};
  for (const PeerTime& peer : s.peers)
    bars.push_back({peer.name + ' ' + peer.strategy, peer.timing.median(),
                    formatted(peer.timing.median(), "%.1f ms") + formatted(s.ratio(peer), ", %.1fx") +
                        (peer.picture && !peer.picture->right() ? ", another picture" : ""),
                    false});
  return card(s.scene + ", " + about(s), bar_chart(bars));
}

/// How much faster than by one core the frame would be by what its tiles cost.
std::string scheduled(const SceneTime& s) {
  std::vector<Bar> bars;
  for (const int cores : kMoreCores)
    bars.push_back({std::to_string(cores) + " cores", s.scheduled_speedup(cores),
                    formatted(s.scheduled_speedup(cores), "%.1fx"), false});
  return card(s.scene + ", " + about(s) + ": scheduled on more cores by its tiles' costs", bar_chart(bars));
}

std::string row(const std::string& name, const std::string& value) {
  return "<tr><td>" + escaped(name) + "<td>" + escaped(value) + '\n';
}

std::string counts(const SceneTime& s, const BenchResult& bench) {
  const FrameStats& f = s.stats;
  const double floor = s.floor.ms(bench.machine.clock_ghz, bench.threads);
  std::string html = "<details><summary>" + escaped(s.scene) + "</summary>\n<table>\n";
  html += row("image", "sha256:" + s.hash) +
          row("median, least", formatted(s.timing.median(), "%.3f ms, ") + formatted(s.timing.least(), "%.3f ms"));
  html += row("spread of the middle half", formatted(100 * s.timing.spread(), "%.1f %%"));
  const StageTimes& core = f.core_ms;
  for (const auto& [stage, ms] : {std::pair("visibility", core.visibility), std::pair("surfaces", core.surfaces),
                                  std::pair("light", core.light), std::pair("store", core.store)})
    html += row(stage + std::string(", core time"), formatted(ms, "%.3f ms"));
  html += row("modelled floor",
              formatted(floor, "%.3f ms, ") + formatted(100 * floor / s.timing.median(), "%.0f %% of the time"));
  html += row("light, of a core", formatted(ns_per_pixel_light(s), "%.2f ns a pixel-light computed"));
  html += row("rate", rate_text(s));
  for (const auto& [what, count] :
       {std::pair("triangles submitted", f.triangles), std::pair("triangles set up", f.triangles_tested),
        std::pair("fragments", f.fragments), std::pair("pixels covered", f.covered_pixels),
        std::pair("lights tested", f.lights_tested), std::pair("pixel-lights left by tiles", f.tile_pixel_lights),
        std::pair("pixel-lights computed", f.evaluated_pixel_lights), std::pair("pixel-lights lit", f.lit_pixel_lights),
        std::pair("bytes stored", s.bytes.stored), std::pair("bytes of clusters drawn", s.bytes.clusters)})
    html += row(what, grouped(std::to_string(count)));
  html += row("most memory", formatted(s.peak_mib, "%.0f MiB"));
  for (const std::string& about : s.peers_about) html += row("peer", about);
  return html + "</table></details>\n";
}

}  // namespace

std::string bench_page(const BenchResult& bench) {
  std::string html =
      page_head("Benchmark") + "<h1>Benchmark</h1>\n<p class=quiet>" + escaped(bench_heading(bench)) + "</p>\n";
  html += "<h2>Time a frame, all drawn in turn in one run; median</h2>\n<div class=charts>\n";
  for (const SceneTime& s : bench.scenes) html += against_peers(s);
  html += "</div>\n<h2>Scaling</h2>\n<div class=charts>\n";
  for (const ScalingCurve& curve : bench.scaling) {
    std::vector<ChartPoint> points;
    std::vector<Bar> bars;
    for (const auto& p : curve.points) {
      points.push_back({p.x, p.ms, p.label});
      bars.push_back({p.label, p.ms, formatted(p.ms, "%.2f ms"), false});
    }
    html += card(curve.title, curve.axis.empty() ? bar_chart(bars) : line_chart(points, curve.axis, curve.log_axis));
  }
  for (const SceneTime& s : bench.scenes) html += scheduled(s);
  html += "</div>\n<h2>Counts</h2>\n";
  for (const SceneTime& s : bench.scenes) html += counts(s, bench);
  return html + page_end();
}

}  // namespace trueshade
