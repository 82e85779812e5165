// A run as a page of HTML.
#include <algorithm>
#include <cstdio>

#include "cli/batch/batch_results.h"
#include "cli/pages/page.h"
#include "cli/shell_words.h"
#include "cli/version.h"
#include "core/error.h"
#include "core/file_ending.h"
#include "core/image_files/image_io.h"

namespace trueshade::batch {
namespace {

constexpr int kMostPictures = 200;
constexpr int kPictureSide = 320;  // pixels

std::string shell_command_of(const Job& job) {
  std::string command = "trueshade";
  for (const std::string& word : job.run) command += ' ' + for_shell(word);
  return command;
}

std::string printed(const JobResult& result) {
  const std::string text = result.out + result.err;
  return text.empty() ? "" : "<pre>" + escaped(text) + "</pre>";
}

std::string state_cell(const JobResult& result) {
  return std::string("<td class=\"") + (result.passed() ? "good" : "bad") + "\">" + std::string(name_of(result.state));
}

std::string row_of(const Job& job, const JobResult& result) {
  char seconds[40] = "-";
  if (result.state != JobState::skipped) std::snprintf(seconds, sizeof seconds, "%.2f", result.seconds);
  std::string hashes;
  for (size_t i = 0; i < std::min<size_t>(result.hashes.size(), 3); ++i)
    hashes +=
        "<code title=\"" + escaped(result.hashes[i]) + "\">" + escaped(result.hashes[i].substr(7, 12)) + "</code> ";
  if (result.hashes.size() > 3) hashes += "and " + std::to_string(result.hashes.size() - 3) + " more";
  return "<tr>" + state_cell(result) + "<td><details" + (result.state == JobState::failed ? " open" : "") +
         "><summary>" + escaped(job.name) + "</summary><code>" + escaped(shell_command_of(job)) + "</code>" +
         printed(result) + "</details><td class=number>" + seconds + "<td>" + hashes + "<td>" + escaped(result.reason) +
         '\n';
}

std::string facts_of_run(const BatchResults& batch) {
  char seconds[40];
  std::snprintf(seconds, sizeof seconds, "%.1f s", batch.seconds);
  const auto number = [&batch](JobState state) { return grouped(std::to_string(batch.count(state))); };
  return "<div class=facts>" + fact(number(JobState::passed), "passed", "Ran, and came to what is expected of them.") +
         fact(number(JobState::unchanged), "unchanged",
              "Passed in an earlier run; neither their calls nor their files have changed since.") +
         fact(number(JobState::failed), "failed", "Came to something else, crashed, or took too long.") +
         fact(number(JobState::skipped), "skipped", "Are after a job that did not pass.") +
         fact(seconds, "wall time", "Of the whole run.") + "</div>\n";
}

/// Nothing where the file is no picture any more.
std::string picture_part(const Job& job, const std::string& path, const std::string& name) {
  try {
    for (const NamedImage& plane : read_planes(path))
      if (plane.name == "color") return figure(reduced_picture(plane.image, kPictureSide), job.name, escaped(name));
  } catch (const Error&) {
    // The table says what became of the job.
  }
  return {};
}

std::string pictures_part(const BatchResults& batch) {
  std::string html;
  int shown = 0, all = 0;
  for (size_t i = 0; i < batch.results.size(); ++i) {
    if (!batch.chosen[i]) continue;
    for (const FileNote& file : batch.results[i].files) {
      if (file.kind != FileNote::Kind::wrote || !has_ending(file.path, ".png")) continue;
      if (++all > kMostPictures) continue;
      const std::string picture = picture_part(
          batch.list.jobs[i], file.path.starts_with('/') ? file.path : batch.folder + '/' + file.path, file.path);
      shown += picture.empty() ? 0 : 1;
      html += picture;
    }
  }
  if (shown == 0) return {};
  return "<h2>Pictures</h2>\n<p class=quiet>" + std::to_string(shown) + " of " + std::to_string(all) +
         " PNG files that jobs wrote, reduced.</p>\n<div class=pictures>\n" + html + "</div>\n";
}

}  // namespace

std::string results_page(const BatchResults& batch) {
  std::string html = page_head("Batch") + heading_part("Batch of " + batch.list.file) + "<p class=\"verdict " +
                     (batch.passed() ? "good" : "bad") + "\">Verdict: " + escaped(batch.verdict()) + ".</p>\n" +
                     facts_of_run(batch) +
                     "<h2>Jobs</h2>\n<p class=quiet>A job opens to its command and what it printed.</p>\n<div "
                     "class=scroll><table><thead><tr><th>outcome<th>job<th "
                     "class=number>seconds<th>hash<th>why</thead>\n";
  for (size_t i = 0; i < batch.results.size(); ++i)
    if (batch.chosen[i]) html += row_of(batch.list.jobs[i], batch.results[i]);
  return html + "</table></div>\n" + pictures_part(batch) + "<p class=quiet>trueshade " + kVersion + "</p>\n" +
         reproduce_part(batch.command) + page_end();
}

}  // namespace trueshade::batch
