// What `bench --ranks` has measured, in words and as JSON.
#include <algorithm>
#include <cstdio>

#include "cli/bench.h"
#include "cli/bench_ranks.h"
#include "cli/json_text.h"
#include "cli/version.h"

namespace trueshade {
namespace {

template <typename... Values>
std::string line(const char* format, Values... values) {
  char text[256];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

/// `230 ms (110 to 400)`
std::string drawn_in(const std::vector<TaskCost>& tasks, double draw_s) {
  const auto [least, most] = std::minmax_element(
      tasks.begin(), tasks.end(), [](const TaskCost& a, const TaskCost& b) { return a.draw_s < b.draw_s; });
  return line("%.3g ms to draw (%.3g to %.3g)", 1e3 * draw_s / double(tasks.size()), 1e3 * least->draw_s,
              1e3 * most->draw_s);
}

std::string costs_text(const TaskCosts& costs, const char* unit) {
  double bytes = 0;
  for (const TaskCost& task : costs.tasks) bytes += double(task.bytes);
  const double count = double(costs.tasks.size());
  return line("  %5zu %-7s %s, %.3g MB to send, %.3g ms to take\n", costs.tasks.size(), unit,
              drawn_in(costs.tasks, costs.draw_s()).c_str(), 1e-6 * bytes / count, 1e3 * costs.take_s() / count);
}

std::string here_text(const RanksTime& scene) {
  std::string text =
      line("  processes here, each of %d thread%s\n", scene.threads_of_rank, scene.threads_of_rank == 1 ? "" : "s") +
      "   count      time   speedup     model\n";
  for (const RanksTime::Measured& measured : scene.here)
    text += line("  %6d %7.4g s %8.2fx %7.4g s\n", measured.ranks, measured.seconds,
                 scene.here.front().seconds / measured.seconds, measured.model_s);
  return text;
}

std::string table_text(const RanksTime& scene) {
  std::string text = "   count      time   speedup  efficiency    serial   of time  receiving  tasks\n";
  for (const RanksTime::Row& row : scene.table) {
    const double speedup = scene.table.front().seconds / row.seconds;
    text += line("  %6d %7.4g s %8.1fx %9.0f %% %7.3g s %7.0f %% %8.2g s %6d\n", row.machines, row.seconds, speedup,
                 100 * speedup / row.machines, row.serial_s, 100 * row.serial_s / row.seconds, row.estimate.receiving_s,
                 row.tasks);
  }
  return text;
}

std::string scene_text(const RanksTime& scene, const RanksResult& result) {
  const char* const unit = scene.by_bands ? "bands" : "frames";
  std::string text = '\n' + scene.scene + "  " + scene.picture + '\n';
  text += line("  once          %.3g ms to start, %.3g ms to end the file\n", 1e3 * scene.coarse.start_s,
               1e3 * scene.coarse.finish_s);
  text += costs_text(scene.coarse, unit);
  if (scene.fine.tasks.size() != scene.coarse.tasks.size()) {
    text += costs_text(scene.fine, unit);
    text += line("  a band        %.3g ms by itself\n", 1e3 * scene.band_s);
  }
  text += here_text(scene);
  text += line("  machines like this one, each of %d thread%s, by the model: %g Gbit/s, %g us\n", result.threads,
               result.threads == 1 ? "" : "s", 8e-9 * result.network.bytes_per_s, 1e6 * result.network.latency_s);
  return text + table_text(scene);
}

std::string json_of(const TaskCosts& costs) {
  JsonArray tasks;
  for (const TaskCost& task : costs.tasks)
    tasks.add_raw(JsonObject().put("draw_s", task.draw_s).put("bytes", task.bytes).put("take_s", task.take_s).text());
  return JsonObject()
      .put("start_s", costs.start_s)
      .put("finish_s", costs.finish_s)
      .put_raw("tasks", tasks.text())
      .text();
}

std::string json_of(const RanksTime& scene) {
  JsonArray here, table;
  for (const RanksTime::Measured& measured : scene.here)
    here.add_raw(JsonObject()
                     .put("ranks", measured.ranks)
                     .put("seconds", measured.seconds)
                     .put("model_s", measured.model_s)
                     .text());
  for (const RanksTime::Row& row : scene.table)
    table.add_raw(JsonObject()
                      .put("machines", row.machines)
                      .put("tasks", row.tasks)
                      .put("seconds", row.seconds)
                      .put("serial_s", row.serial_s)
                      .put("receiving_s", row.estimate.receiving_s)
                      .put("drawing_s", row.estimate.busiest_s)
                      .text());
  return JsonObject()
      .put("scene", scene.scene)
      .put("picture", scene.picture)
      .put("hash", scene.coarse.hash)
      .put("unit", scene.by_bands ? "band" : "frame")
      .put("band_s", scene.band_s)
      .put("threads_of_rank", scene.threads_of_rank)
      .put_raw("costs", json_of(scene.coarse))
      .put_raw("costs_of_finest", json_of(scene.fine))
      .put_raw("here", here.text())
      .put_raw("machines", table.text())
      .text();
}

}  // namespace

std::string ranks_text(const RanksResult& result) {
  std::string text = bench_heading(result.machine, result.simd, result.threads);
  for (const RanksTime& scene : result.scenes) text += scene_text(scene, result);
  return text;
}

std::string ranks_json(const RanksResult& result) {
  JsonArray scenes;
  for (const RanksTime& scene : result.scenes) scenes.add_raw(json_of(scene));
  JsonObject network;
  network.put("bytes_per_s", result.network.bytes_per_s).put("latency_s", result.network.latency_s);
  return JsonObject()
             .put("version", kVersion)
             .put("commit", kCommit)
             .put_raw("machine", machine_json(result.machine))
             .put("threads", result.threads)
             .put("simd", result.simd)
             .put_raw("network", network.text())
             .put_raw("scenes", scenes.text())
             .text() +
         '\n';
}

}  // namespace trueshade
