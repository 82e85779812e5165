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

/// `12.3 s`, `230 ms`
std::string time_text(double seconds) {
  return seconds >= 0.9995 ? line("%.4g s", seconds) : line("%.3g ms", 1e3 * seconds);
}

/// `230 ms to draw (110 ms to 1.4 s)`
std::string drawn_in(const std::vector<TaskCost>& tasks, double draw_s) {
  const auto [least, most] = std::minmax_element(
      tasks.begin(), tasks.end(), [](const TaskCost& a, const TaskCost& b) { return a.draw_s < b.draw_s; });
  return time_text(draw_s / double(tasks.size())) + " to draw (" + time_text(least->draw_s) + " to " +
         time_text(most->draw_s) + ')';
}

std::string costs_text(const TaskCosts& costs, const char* unit) {
  double bytes = 0;
  for (const TaskCost& task : costs.tasks) bytes += double(task.bytes);
  const double count = double(costs.tasks.size());
  return line("  %5zu %-7s ", costs.tasks.size(), unit) + drawn_in(costs.tasks, costs.draw_s()) + ", " +
         line("%.3g MB to send, ", 1e-6 * bytes / count) + time_text(costs.take_s() / count) + " to take\n";
}

std::string threads_text(int threads) {
  return ", each of " + std::to_string(threads) + (threads == 1 ? " thread" : " threads");
}

std::string here_text(const RanksTime& scene) {
  std::string text =
      "  processes" + threads_text(scene.threads_of_rank) + '\n' + "   count       time  speedup      model\n";
  for (const RanksTime::Measured& measured : scene.here)
    text += line("  %6d %10s %7.2fx %10s\n", measured.ranks, time_text(measured.seconds).c_str(),
                 scene.here.front().seconds / measured.seconds, time_text(measured.model_s).c_str());
  return text;
}

std::string table_text(const RanksTime& scene, const char* unit) {
  std::string text = line("   count       time   speedup  efficiency     rank 0  of time  receiving  %6s\n", unit);
  for (const RanksTime::Row& row : scene.table) {
    const double speedup = scene.table.front().seconds / row.seconds;
    text += line("  %6d %10s %8.1fx %9.1f %% %10s %6.0f %% %10s  %6d\n", row.machines, time_text(row.seconds).c_str(),
                 speedup, 100 * speedup / row.machines, time_text(row.serial_s).c_str(),
                 100 * row.serial_s / row.seconds, time_text(row.estimate.receiving_s).c_str(), row.tasks);
  }
  return text;
}

std::string scene_text(const RanksTime& scene, const RanksResult& result) {
  const char* const unit = scene.by_bands ? "bands" : "frames";
  std::string text = '\n' + scene.scene + "  " + scene.picture + '\n';
  text += "  once          " + time_text(scene.start_s()) + " to start, " + time_text(scene.coarse.finish_s) +
          " to end the file\n";
  text += costs_text(scene.coarse, unit);
  if (scene.fine.tasks.size() != scene.coarse.tasks.size())
    text += costs_text(scene.fine, unit) + "  a band        " + time_text(scene.band_s) + " however few its rows\n";
  text += here_text(scene) + "  machines like this one" + threads_text(result.threads) +
          line(", by the model: %g Gbit/s, %g us\n", 8e-9 * result.network.bytes_per_s, 1e6 * result.network.latency_s);
  return text + table_text(scene, unit);
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
  network.put("look_s", result.network.look_s);
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
