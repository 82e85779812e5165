#include <utility>

#include "cli/bench.h"
#include "cli/pages/page.h"
#include "cli/pages/svg_chart.h"
#include "cli/version.h"

namespace trueshade {
namespace {

std::string card(const std::string& title, const std::string& sentence, const std::string& chart) {
  return "<figure class=chart><b>" + escaped(title) + "</b>\n<p>" + escaped(sentence) + "</p>\n" + chart +
         "</figure>\n";
}

constexpr const char* kWhiskers =
    " Whiskers go from the least time to the upper quartile, with an end at the lower one.";

std::string about(const SceneTime& s) {
  return s.pipeline.preset + ", " + std::to_string(s.pipeline.width) + " x " + std::to_string(s.pipeline.height);
}

Whisker whisker(const Timing& t) { return {t.least(), t.lower_quartile(), t.upper_quartile()}; }

std::string time_text(const Timing& t) {
  const char* const format = t.median() < 100 ? "%.2f" : "%.1f";
  return formatted(t.median(), format) + " ms, least " + formatted(t.least(), format);
}

std::string against_peers(const SceneTime& s) {
  std::vector<Bar> bars{{"trueshade", s.timing.median(), time_text(s.timing), true, whisker(s.timing)}};
  for (const PeerTime& peer : s.peers)
    bars.push_back({peer.name + ' ' + peer.strategy, peer.timing.median(),
                    time_text(peer.timing) + formatted(s.ratio(peer), ", %.1fx") +
                        (peer.picture && !peer.picture->right() ? ", another picture" : ""),
                    false, whisker(peer.timing)});
  const std::string title = s.scene + ", " + about(s);
  return card(title,
              (s.peers.empty() ? "The median of " + std::to_string(s.timing.ms.size()) + " frames."
                               : "Medians; x is how many times our time a peer takes.") +
                  kWhiskers,
              bar_chart(bars, "ms a frame", "Time a frame of " + title));
}

/// How much faster than by one core the frame would be by what its tiles cost.
std::string scheduled(const SceneTime& s) {
  std::vector<Bar> bars;
  for (const int cores : kMoreCores)
    bars.push_back({std::to_string(cores) + " cores", s.scheduled_speedup(cores),
                    formatted(s.scheduled_speedup(cores), "%.1fx"), false});
  const std::string title = s.scene + ", " + about(s) + ": scheduled on more cores by its tiles' costs";
  return card(title, "Computed, not timed: the tiles' measured costs dealt to so many cores.",
              bar_chart(bars, "times as fast as on one core", title));
}

std::string scaling(const ScalingCurve& curve) {
  std::vector<ChartPoint> points;
  std::vector<Bar> bars;
  for (const auto& p : curve.points) {
    points.push_back({p.x, p.timing.median(), p.label, whisker(p.timing)});
    bars.push_back({p.label, p.timing.median(), time_text(p.timing), false, whisker(p.timing)});
  }
  return card(curve.title, curve.about,
              curve.axis.empty() ? bar_chart(bars, "ms a frame", curve.title)
                                 : line_chart(points, curve.axis, curve.log_axis, curve.title));
}

std::string row(const std::string& name, const std::string& value, const std::string& meaning) {
  return "<tr><td>" + escaped(name) + "<td class=number>" + escaped(value) + "<td class=meaning>" + escaped(meaning) +
         '\n';
}

std::string machine_table(const BenchResult& bench) {
  const Machine& m = bench.machine;
  std::string html = "<div class=scroll><table>\n";
  const auto used = [](const Load& load) {
    return load.is_known ? formatted(load.others, "%.2f of ") + std::to_string(load.cpus) : std::string("not known");
  };
  html += row("machine", "", machine_text(m));
  if (!m.opengl.empty()) html += row("OpenGL", "", m.opengl);
  html +=
      row("cores used by others, before", used(m.load_before), "In a fifth of a second in which nothing was drawn.");
  for (const SceneTime& s : bench.scenes)
    html += row("cores used by others, " + s.scene, used(s.load),
                "Until its last timed frame; " + formatted(s.load.own, "%.2f") + " were used by this process, " +
                    formatted(s.load.stolen, "%.2f") + " by the host of a virtual machine; then " +
                    formatted(s.clock_ghz, "%.2f") + " GHz.");
  return html + "</table></div>\n";
}

struct CountRow {
  const char *name, *meaning;
  uint64_t count;
};

std::string times(const SceneTime& s, const BenchResult& bench) {
  const FrameStats& f = s.stats;
  const StageTimes& core = f.core_ms;
  const double floor = s.floor.ms(bench.machine.clock_ghz, bench.threads);
  std::string html =
      row("median", formatted(s.timing.median(), "%.3f ms"), "Half of the frames took longer.") +
      row("least", formatted(s.timing.least(), "%.3f ms"), "The fastest frame, which others disturbed least.") +
      row("spread of the middle half", formatted(100 * s.timing.spread(), "%.1f %%"),
          "How far the middle half of the frames lies apart, of the median; large where the machine was busy.");
  html += row("visibility, core time", formatted(core.visibility, "%.3f ms"),
              "Which triangle each sample sees; summed over threads, as the three below are.") +
          row("surfaces, core time", formatted(core.surfaces, "%.3f ms"), "Attributes and textures of what is seen.") +
          row("light, core time", formatted(core.light, "%.3f ms"), "The light of all pixels.") +
          row("store, core time", formatted(core.store, "%.3f ms"), "Rounding to the target's format, and writing.");
  return html +
         row("modelled floor",
             formatted(floor, "%.3f ms, ") + formatted(100 * floor / s.timing.median(), "%.0f %% of the time"),
             "What the counts would cost if nothing ever waited (docs/performance.md).") +
         row("light, of a core", formatted(ns_per_pixel_light(s), "%.2f ns"), "Per pair of pixel and light computed.") +
         row("rate", rate_text(s), "Small triangles bound the first rate, pixels the second.") +
         row("most memory", formatted(s.peak_mib, "%.0f MiB"), "Of the process while it prepared and drew the scene.");
}

std::string counts(const SceneTime& s, const BenchResult& bench) {
  const FrameStats& f = s.stats;
  std::string html = "<details><summary>" + escaped(s.scene) + "</summary>\n<div class=scroll><table>\n" +
                     row("image", "sha256:" + s.hash.substr(0, 16) + "\xe2\x80\xa6",
                         "Every frame that was timed has this hash: all are the same picture.") +
                     times(s, bench);
  for (const CountRow& r :
       {CountRow{"triangles submitted", "Over all instances, those out of sight among them.", f.triangles},
        {"triangles set up", "Those that a tile had to look at, once a tile.", f.triangles_tested},
        {"fragments", "Samples covered, before the depth test.", f.fragments},
        {"pixels covered", "Pixels that show a surface.", f.covered_pixels},
        {"lights tested", "Tests of a light against a tile or a region of it.", f.lights_tested},
        {"pixel-lights left by tiles", "Pairs of a pixel and a light that its tile's list holds.", f.tile_pixel_lights},
        {"pixel-lights computed", "Pairs whose light was computed.", f.evaluated_pixel_lights},
        {"pixel-lights lit", "Pairs that are in range and face each other.", f.lit_pixel_lights},
        {"bytes stored", "Texels of the target.", s.bytes.stored},
        {"bytes of clusters drawn", "Geometry that tiles read.", s.bytes.clusters}})
    html += row(r.name, grouped(std::to_string(r.count)), r.meaning);
  for (const std::string& about : s.peers_about) html += row("peer", "", about);
  return html + "</table></div></details>\n";
}

}  // namespace

std::string bench_page(const BenchResult& bench) {
  std::string html = page_head("Benchmark") + heading_part("Benchmark") + "<p class=quiet>" +
                     escaped(bench_heading(bench.machine, bench.simd, bench.threads)) + "</p>\n";
  for (const std::string& reason : bench.all_reasons())
    html += "<p class=note>Not to be quoted: " + escaped(reason) + ".</p>\n";
  if (bench.standard) html += "<pre>" + escaped(scores_text(bench)) + "</pre>\n";
  html +=
      "<h2>Time a frame</h2>\n<p class=quiet>All that is in a chart was drawn in turn in one run, after the picture "
      "was checked.</p>\n<div class=charts>\n";
  for (const SceneTime& s : bench.scenes) html += against_peers(s);
  html +=
      "</div>\n<h2>Scaling</h2>\n<p class=quiet>The first scene with one of its values varied, all points of a chart "
      "drawn in turn.</p>\n<div class=charts>\n";
  for (const ScalingCurve& curve : bench.scaling) html += scaling(curve);
  for (const SceneTime& s : bench.scenes) html += scheduled(s);
  html += "</div>\n<h2>The machine</h2>\n" + machine_table(bench) + "<h2>Counts and times</h2>\n";
  for (const SceneTime& s : bench.scenes) html += counts(s, bench);
  return html + reproduce_part(bench.command) + page_end();
}

}  // namespace trueshade
