#include <algorithm>
#include <cstdio>
#include <iterator>

#include "bench/schedule.h"
#include "cli/bench.h"
#include "cli/json_text.h"
#include "cli/version.h"

namespace trueshade {
namespace {

std::string size_text(const Pipeline& p) { return std::to_string(p.width) + 'x' + std::to_string(p.height); }

double floor_ms(const SceneTime& s, const BenchResult& bench) {
  return s.floor.ms(bench.machine.clock_ghz, bench.threads);
}

double per(double value, uint64_t count) { return count == 0 ? 0.0 : value / double(count); }

/// What precedes the tiles, on as many cores as have anything to do.
double alone_ms(const FrameStats& f) { return scheduled_frame_ms(f, {}, 1 << 20); }

std::string schedule_text(const SceneTime& s) {
  const FrameStats& f = s.stats;
  std::string text = "  before the tiles " + formatted(f.before_tiles_ms, "%.2f") + " ms, " +
                     formatted(alone_ms(f), "%.2f") + " on any number of cores; ";
  for (const auto& [tile, ms] : s.tile_costs)
    text += std::to_string(ms.size()) + " tiles of " + std::to_string(tile) + " pixels, the dearest " +
            formatted(ms.empty() ? 0.0 : *std::max_element(ms.begin(), ms.end()), "%.2f") + " ms; ";
  text += "scheduled by these costs:";
  for (const int cores : kMoreCores)
    text += ' ' + std::to_string(cores) + " cores " + formatted(s.scheduled_speedup(cores), "%.1fx");
  return text + '\n';
}

std::string time_row(const std::string& who, const Timing& t, const std::string& ratio) {
  char line[256];
  const std::string spread = t.ms.size() < 2 ? "   -  " : formatted(100.0 * t.spread(), "%4.1f %%");
  std::snprintf(line, sizeof line, "  %-26s %9.2f ms  least %9.2f  spread %s  of %2zu  %s\n", who.c_str(), t.median(),
                t.least(), spread.c_str(), t.ms.size(), ratio.c_str());
  return line;
}

std::string picture_text(const PeerTime& peer) {
  if (!peer.picture) return {};
  const PictureCheck& p = *peer.picture;
  const auto far = [&p](uint64_t n) {
    return ", " + std::to_string(n) + " px over " + formatted(p.codes, "%.3g") + " codes";
  };
  if (!p.right()) return "  ANOTHER PICTURE" + far(p.off_ours);
  const std::string rounding = blends_lights(p.strategy) ? "blended light by light" : "summed, stored once";
  if (p.same()) return "  same picture: " + rounding + far(p.off_timed);
  if (p.same_shading()) return "  same shading: " + rounding + far(p.off_timed);
  return "  picture of " + std::string(name_of(p.strategy)) + ": " + rounding + far(p.off_ours);
}

/// Which pictures beside the one that is timed a peer may draw: as it says it does, rounded elsewhere, or any.
constexpr std::pair<const char*, bool (*)(const PictureCheck&)> kFastestOf[] = {
    {"this picture", [](const PictureCheck& p) { return p.same(); }},
    {"this shading, wherever it rounds", [](const PictureCheck& p) { return p.same_shading(); }},
    {"all", [](const PictureCheck&) { return true; }}};

/// The fastest of the peers that draw what they say and that `counts` admits; null where there is none.
const PeerTime* fastest_peer(const SceneTime& s, bool (*counts)(const PictureCheck&)) {
  const PeerTime* fastest = nullptr;
  for (const PeerTime& peer : s.peers)
    if (peer.picture && peer.picture->right() && counts(*peer.picture) &&
        (fastest == nullptr || s.ratio(peer) < s.ratio(*fastest)))
      fastest = &peer;
  return fastest;
}

std::string fastest_text(const SceneTime& s) {
  std::string text;
  for (const auto& [what, counts] : kFastestOf)
    if (const PeerTime* peer = fastest_peer(s, counts))
      text += std::string("  fastest peer of ") + what + ": " + peer->name + ' ' + peer->strategy + ", " +
              formatted(s.ratio(*peer), "%.2fx ours\n");
  return text;
}

std::string moving_text(const MovingTime& moving) {
  return time_row("moving, next frame", moving.next, formatted(moving.ratio(), "%.2fx the same again")) +
         time_row("moving, the same again", moving.again, "");
}

/// What JSON says of a time.
void put_timing(JsonObject& json, const Timing& t) {
  json.put("ms", t.median()).put("least_ms", t.least()).put("lower_quartile_ms", t.lower_quartile());
  json.put("upper_quartile_ms", t.upper_quartile()).put("spread", t.spread()).put("frames", uint64_t(t.ms.size()));
  JsonArray frames;
  for (const double ms : t.ms) frames.add_raw(formatted(ms, "%.6g"));
  json.put_raw("frame_ms", frames.text());
}

std::string moving_json(const MovingTime& moving) {
  JsonObject json;
  json.put("ms", moving.next.median()).put("again_ms", moving.again.median()).put("ratio", moving.ratio());
  json.put("least_ms", moving.next.least()).put("again_least_ms", moving.again.least());
  return json.put("frames", uint64_t(moving.next.ms.size())).text();
}

std::string scene_json(const SceneTime& s, const BenchResult& bench) {
  JsonArray peers;
  for (const PeerTime& peer : s.peers) {
    JsonObject row;
    row.put("name", peer.name).put("strategy", peer.strategy).put("ratio", s.ratio(peer));
    put_timing(row, peer.timing);
    if (peer.picture) {
      const PictureCheck& p = *peer.picture;
      row.put("picture_of", name_of(p.strategy)).put("rounding", blends_lights(p.strategy) ? "per light" : "once");
      row.put("right_picture", p.right()).put("same_picture", p.same()).put("same_shading", p.same_shading());
      row.put("codes", p.codes).put("pixels_off", p.off_ours).put("pixels_off_timed", p.off_timed);
    }
    peers.add_raw(row.text());
  }
  const FrameStats& f = s.stats;
  JsonObject json =
      JsonObject().put("scene", s.scene).put("size", size_text(s.pipeline)).put("preset", s.pipeline.preset);
  json.put("strategy", name_of(s.pipeline.strategy)).put("tile", s.stats.tile);
  json.put("hash", "sha256:" + s.hash);
  put_timing(json, s.timing);
  json.put_raw("not_to_be_quoted", reasons_json(s.reasons)).put_raw("load", load_json(s.load));
  json.put("clock_ghz", s.clock_ghz);
  json.put("geometry_ms", f.core_ms.geometry()).put("visibility_ms", f.core_ms.visibility);
  json.put("surfaces_ms", f.core_ms.surfaces);
  json.put("light_ms", f.core_ms.light).put("store_ms", f.core_ms.store).put("lights_tested", f.lights_tested);
  json.put("triangles", f.triangles).put("triangles_tested", f.triangles_tested).put("fragments", f.fragments);
  json.put("clusters_drawn", f.clusters_drawn);
  json.put("covered_pixels", f.covered_pixels).put("lights", f.lights).put("lit_pixel_lights", f.lit_pixel_lights);
  json.put("evaluated_pixel_lights", f.evaluated_pixel_lights).put("tile_pixel_lights", f.tile_pixel_lights);
  json.put("ns_per_pixel_light", ns_per_pixel_light(s)).put("million_triangles_per_s", million_triangles_per_s(s));
  json.put("floor_ms", floor_ms(s, bench)).put("share_of_floor", floor_ms(s, bench) / s.timing.median());
  json.put("million_pixels_per_s", million_pixels_per_s(s));
  json.put("bytes_stored", s.bytes.stored).put("bytes_of_clusters", s.bytes.clusters);
  json.put("peak_mib", s.peak_mib).put("bytes_per_triangle", per(s.peak_mib * 1048576.0, f.triangles));
  json.put("bytes_per_pixel", per(s.peak_mib * 1048576.0, f.pixels));
  json.put("before_tiles_ms", f.before_tiles_ms).put("before_tiles_alone_ms", alone_ms(f));
  JsonArray tiles, speedups;
  for (const StageTimes& tile : f.tile_ms) tiles.add_raw(formatted(tile.sum(), "%.4f"));
  for (const int cores : kMoreCores)
    speedups.add_raw(JsonObject()
                         .put("cores", cores)
                         .put("tile", s.scheduled_tile(cores))
                         .put("speedup", s.scheduled_speedup(cores))
                         .text());
  json.put_raw("tile_ms", tiles.text()).put_raw("scheduled", speedups.text());
  if (const PeerTime* best = fastest_peer(s, kFastestOf[std::size(kFastestOf) - 1].second))
    json.put_raw(
        "best_peer",
        JsonObject().put("name", best->name).put("strategy", best->strategy).put("ratio", s.ratio(*best)).text());
  if (s.moving) json.put_raw("moving", moving_json(*s.moving));
  json.put_raw("ignored", ignored_json(s.notes)).put_raw("notes", lines_json(s.notes));
  return json.put_raw("peers", peers.text()).text();
}

std::string point_json(const ScalingCurve::Point& point) {
  JsonObject json;
  json.put("label", point.label).put("x", point.x);
  put_timing(json, point.timing);
  return json.text();
}

}  // namespace

std::string formatted(double value, const char* format) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

double ns_per_pixel_light(const SceneTime& s) {
  return per(s.stats.core_ms.light * 1e6, s.stats.evaluated_pixel_lights);
}
double million_triangles_per_s(const SceneTime& s) { return double(s.stats.triangles) * 1e-3 / s.timing.median(); }
double million_pixels_per_s(const SceneTime& s) { return double(s.stats.pixels) * 1e-3 / s.timing.median(); }

std::string rate_text(const SceneTime& s) {
  const auto rate = [](double value) { return formatted(value, value < 10.0 ? "%.2f" : "%.0f"); };
  return rate(million_triangles_per_s(s)) + " million triangles submitted a second and " +
         rate(million_pixels_per_s(s)) + " million pixels a second";
}

int SceneTime::scheduled_tile(int cores) const {
  return tile_costs.size() == 1 ? tile_costs.begin()->first : tile_for(pipeline.width, pipeline.height, cores);
}

double SceneTime::scheduled_speedup(int cores) const {
  const auto ms_on = [this](int n) { return scheduled_frame_ms(stats, tile_costs.at(scheduled_tile(n)), n); };
  return ms_on(1) / ms_on(cores);
}

std::string bench_text(const SceneTime& s, const BenchResult& bench, bool is_short) {
  const FrameStats& f = s.stats;
  std::string text = "\n" + s.scene + "  " + s.pipeline.preset + "  " + size_text(s.pipeline) +
                     "  sha256:" + s.hash.substr(0, 16) + "\n";
  text += time_row("trueshade", s.timing, "");
  for (const PeerTime& peer : s.peers)
    text += time_row(peer.name + ' ' + peer.strategy, peer.timing,
                     formatted(s.ratio(peer), "%.2fx ours") + picture_text(peer));
  text += reasons_text(s.reasons, "  ") + fastest_text(s);
  if (s.moving) text += moving_text(*s.moving);
  if (is_short) return text;
  text += "  visibility " + formatted(f.core_ms.visibility, "%.2f") + " ms, surfaces " +
          formatted(f.core_ms.surfaces, "%.2f") + " ms, light " + formatted(f.core_ms.light, "%.2f") + " ms, store " +
          formatted(f.core_ms.store, "%.2f") + " ms of core time; " + formatted(ns_per_pixel_light(s), "%.2f") +
          " ns a pixel-light, " + rate_text(s) + "; modelled floor " + formatted(floor_ms(s, bench), "%.2f") + " ms, " +
          formatted(100.0 * floor_ms(s, bench) / s.timing.median(), "%.0f") + " % of the time\n";
  text += "  " + std::to_string(f.triangles) + " triangles submitted, " + std::to_string(f.triangles_tested) +
          " set up over all tiles, " + std::to_string(f.fragments) + " fragments, " + std::to_string(f.covered_pixels) +
          " pixels covered; " + std::to_string(f.lights_tested) + " lights tested, " +
          std::to_string(f.tile_pixel_lights) + " pixel-lights left by tiles, " +
          std::to_string(f.evaluated_pixel_lights) + " computed, " + std::to_string(f.lit_pixel_lights) + " lit; " +
          formatted(s.peak_mib, "%.0f") + " MiB of memory at most\n";
  text += "  " + formatted(double(s.bytes.stored) * 1e-6, "%.1f") + " MB stored, " +
          formatted(double(s.bytes.clusters) * 1e-6, "%.1f") + " MB of clusters drawn\n";
  text += schedule_text(s);
  for (const std::string& about : s.peers_about) text += "  " + about + "\n";
  return text;
}

std::string bench_json(const BenchResult& bench) {
  JsonArray scenes, scaling;
  for (const SceneTime& s : bench.scenes) scenes.add_raw(scene_json(s, bench));
  for (const ScalingCurve& curve : bench.scaling) {
    JsonArray points;
    for (const auto& p : curve.points) points.add_raw(point_json(p));
    scaling.add_raw(
        JsonObject().put("title", curve.title).put("axis", curve.axis).put_raw("points", points.text()).text());
  }
  JsonObject json;
  json.put("version", kVersion).put("commit", kCommit).put_raw("machine", machine_json(bench.machine));
  json.put("threads", bench.threads).put("simd", bench.simd);
  json.put_raw("not_to_be_quoted", reasons_json(bench.all_reasons())).put("quick", bench.quick);
  if (bench.standard) json.put_raw("standard", scores_json(bench));
  json.put_raw("scenes", scenes.text());
  return json.put_raw("scaling", scaling.text()).text() + '\n';
}

}  // namespace trueshade
