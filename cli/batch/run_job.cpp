// Runs one job: what it is told, and what is made of how it ended.
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <tuple>
#include <utility>

#include "cli/batch/child.h"
#include "cli/batch/job_result.h"

namespace trueshade::batch {
namespace {

/// The first line of a text that begins with `begin`, without that.
std::string line_behind(const std::string& text, std::string_view begin) {
  for (size_t at = 0; at < text.size();) {
    const size_t end = std::min(text.find('\n', at), text.size());
    if (text.compare(at, begin.size(), begin) == 0) return text.substr(at + begin.size(), end - at - begin.size());
    at = end + 1;
  }
  return {};
}

/// The reason why a job failed, from what its command printed: the line of its error, or the verdict of a judge.
std::string words_of_failure(const ChildEnd& end) {
  const std::string error = line_behind(end.err, "trueshade: error: ");
  if (!error.empty()) return error;
  const std::string verdict = line_behind(end.out, "verdict ");
  return verdict.substr(std::min(verdict.find_first_not_of(' '), verdict.size()));
}

std::string wrong_exit(const ChildEnd& end, int expected) {
  const std::string words = words_of_failure(end);
  if (expected == 0 && !words.empty()) return words;
  return "exit code " + std::to_string(end.exit_code) +
         (expected == 0 ? std::string() : ", and " + std::to_string(expected) + " is expected") +
         (words.empty() ? std::string() : ": " + words);
}

std::string wrong_hashes(const std::vector<std::string>& found, const std::vector<std::string>& expected) {
  if (found.empty()) return "it prints no hash, and one is expected (add --hash to its run)";
  if (found.size() != expected.size())
    return "it prints " + std::to_string(found.size()) + " hashes, and " + std::to_string(expected.size()) +
           (expected.size() == 1 ? " is expected" : " are expected");
  const auto at = std::mismatch(found.begin(), found.end(), expected.begin());
  const std::string which = found.size() == 1 ? "" : " " + std::to_string(at.first - found.begin() + 1);
  return "hash" + which + " is " + *at.first + ", and " + *at.second + " is expected";
}

/// Nothing where the job passes.
std::string why_not(const ChildEnd& end, const Job& job) {
  if (end.timed_out) {
    char text[80];
    std::snprintf(text, sizeof text, "it took longer than its timeout of %g s", *job.timeout);
    return text;
  }
  if (end.signal != 0) return "ended by signal " + std::to_string(end.signal) + " (" + strsignal(end.signal) + ")";
  if (end.exit_code != job.expected.exit_code) return wrong_exit(end, job.expected.exit_code);
  if (!job.expected.hashes.empty() && end.hashes != job.expected.hashes)
    return wrong_hashes(end.hashes, job.expected.hashes);
  return {};
}

/// Of a line that is torn, as the child was ended, nothing is kept.
std::vector<FileNote> notes_from_lines(const std::string& lines) {
  std::vector<FileNote> notes;
  for (size_t at = 0; at < lines.size();) {
    const size_t end = lines.find('\n', at);
    if (end == std::string::npos) break;
    const json::Value value = json::parse(std::string_view(lines).substr(at, end - at), "notes of a job");
    const json::Node note(value, "notes of a job");
    const std::string hash = note.member("sha256").string();
    using Kind = FileNote::Kind;
    for (const auto& [key, kind] : {std::pair{"read", Kind::read}, {"listed", Kind::listed}, {"wrote", Kind::wrote}})
      if (const auto path = note.find(key)) notes.push_back({kind, path->string(), hash});
    at = end + 1;
  }
  return notes;
}

/// Of a file that was written several times the last counts; what was read counts once for each content.
void put_in_order(std::vector<FileNote>& notes) {
  std::reverse(notes.begin(), notes.end());
  std::stable_sort(notes.begin(), notes.end(), [](const FileNote& a, const FileNote& b) {
    return std::tie(a.kind, a.path) < std::tie(b.kind, b.path);
  });
  const auto is_covered = [](const FileNote& first, const FileNote& next) {
    return first == next || (first.kind == FileNote::Kind::wrote && next.kind == first.kind && next.path == first.path);
  };
  notes.erase(std::unique(notes.begin(), notes.end(), is_covered), notes.end());
}

}  // namespace

JobResult run_job(const Job& job, const JobPlace& place) {
  ChildEnd end = run_child({job.run, place.folder, job.timeout, place.threads, place.memory});
  JobResult result;
  if (end.interrupted) return result;
  result.reason = why_not(end, job);
  result.state = result.reason.empty() ? JobState::passed : JobState::failed;
  result.exit_code = end.exit_code, result.signal = end.signal;
  result.seconds = end.seconds, result.core_seconds = end.core_seconds;
  result.hashes = std::move(end.hashes);
  result.out = std::move(end.out), result.err = std::move(end.err);
  result.files = notes_from_lines(end.notes);
  put_in_order(result.files);
  return result;
}

}  // namespace trueshade::batch
