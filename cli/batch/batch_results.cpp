// A run in words, as JSON and as JUnit XML.
#include "cli/batch/batch_results.h"

#include <algorithm>
#include <cstdio>

#include "cli/json_text.h"
#include "cli/junit.h"
#include "cli/version.h"
#include "core/printable_text.h"

namespace trueshade::batch {
namespace {

std::string seconds_text(double seconds, const char* format) {
  char text[40];
  std::snprintf(text, sizeof text, format, seconds);
  return text;
}

/// The first hash in twelve digits, and how many more there are.
std::string short_hash(const JobResult& result) {
  if (result.hashes.empty()) return "-";
  const std::string digits = result.hashes.front().substr(std::string_view("sha256:").size(), 12);
  return result.hashes.size() == 1 ? digits : digits + " +" + std::to_string(result.hashes.size() - 1);
}

std::string row(const Job& job, const JobResult& result, size_t name_width) {
  char line[80];
  const bool ran = result.state != JobState::skipped;
  std::snprintf(line, sizeof line, "%-9s  %8s  %-14s  ", std::string(name_of(result.state)).c_str(),
                ran ? seconds_text(result.seconds, "%.2f").c_str() : "-", short_hash(result).c_str());
  const std::string name = printable(job.name, Lines::one);
  if (result.reason.empty()) return line + name + '\n';
  return line + name + std::string(name_width + 2 - name.size(), ' ') + printable(result.reason, Lines::one) + '\n';
}

std::string json_of_files(const JobResult& result, FileNote::Kind kind) {
  JsonArray files;
  for (const FileNote& file : result.files)
    if (file.kind == kind) files.add_raw(JsonObject().put("path", file.path).put("sha256", file.hash).text());
  return files.text();
}

std::string json_of_texts(const std::vector<std::string>& texts) {
  JsonArray array;
  for (const std::string& text : texts) array.add_raw(json_string(text));
  return array.text();
}

std::string json_of_job(const Job& job, const JobResult& result) {
  return JsonObject()
      .put("name", job.name)
      .put_raw("run", json_of_texts(job.run))
      .put("state", name_of(result.state))
      .put("reason", result.reason)
      .put("exit", result.exit_code)
      .put("signal", result.signal)
      .put("seconds", result.seconds)
      .put("core_seconds", result.core_seconds)
      .put("host", result.host)
      .put_raw("hashes", json_of_texts(result.hashes))
      .put_raw("read", json_of_files(result, FileNote::Kind::read))
      .put_raw("wrote", json_of_files(result, FileNote::Kind::wrote))
      .put("out", result.out)
      .put("err", result.err)
      .text();
}

JUnitCase junit_case(const Job& job, const JobResult& result) {
  if (result.passed()) return {job.name, result.seconds, JUnitOutcome::passed, {}, {}, {}};
  if (result.state == JobState::skipped)
    return {job.name, result.seconds, JUnitOutcome::skipped, {}, result.reason, {}};
  return {job.name, result.seconds, JUnitOutcome::failure, "failed", result.reason, result.out + result.err};
}

}  // namespace

int BatchResults::count(JobState state) const {
  int sum = 0;
  for (size_t i = 0; i < results.size(); ++i) sum += chosen[i] && results[i].state == state ? 1 : 0;
  return sum;
}

int BatchResults::count() const { return int(std::count(chosen.begin(), chosen.end(), true)); }

std::string BatchResults::verdict() const {
  const int all = count(), unchanged = count(JobState::unchanged), good = count(JobState::passed) + unchanged;
  std::string text = good == all ? (all == 1 ? "the job passed" : "all " + std::to_string(all) + " jobs passed")
                                 : std::to_string(good) + " of " + std::to_string(all) + " jobs passed";
  if (unchanged > 0) text += ", " + std::to_string(unchanged) + " of them unchanged";
  for (const JobState state : {JobState::failed, JobState::skipped})
    if (count(state) > 0) text += ", " + std::to_string(count(state)) + ' ' + std::string(name_of(state));
  return text;
}

std::string results_text(const BatchResults& batch) {
  size_t name_width = 3;
  for (size_t i = 0; i < batch.results.size(); ++i)
    if (batch.chosen[i] && !batch.results[i].reason.empty())
      name_width = std::max(name_width, printable(batch.list.jobs[i].name, Lines::one).size());
  std::string text = "verdict     " + batch.verdict() + "\n\noutcome     seconds  hash            job" +
                     std::string(name_width - 1, ' ') + "why\n";
  for (size_t i = 0; i < batch.results.size(); ++i)
    if (batch.chosen[i]) text += row(batch.list.jobs[i], batch.results[i], name_width);
  return text;
}

std::string results_json(const BatchResults& batch) {
  JsonArray jobs;
  for (size_t i = 0; i < batch.results.size(); ++i)
    if (batch.chosen[i]) jobs.add_raw('\n' + json_of_job(batch.list.jobs[i], batch.results[i]));
  JsonObject counts;
  for (const JobState state : {JobState::passed, JobState::unchanged, JobState::failed, JobState::skipped})
    counts.put(name_of(state), batch.count(state));
  return JsonObject()
             .put("file", batch.list.file)
             .put("version", kVersion)
             .put("commit", kCommit)
             .put("passed", batch.passed())
             .put("verdict", batch.verdict())
             .put_raw("counts", counts.text())
             .put("seconds", batch.seconds)
             .put_raw("jobs", jobs.text())
             .text() +
         '\n';
}

std::string results_junit(const BatchResults& batch) {
  std::vector<JUnitCase> cases;
  for (size_t i = 0; i < batch.results.size(); ++i)
    if (batch.chosen[i]) cases.push_back(junit_case(batch.list.jobs[i], batch.results[i]));
  return junit_xml("trueshade batch", batch.list.file, cases, batch.seconds);
}

}  // namespace trueshade::batch
