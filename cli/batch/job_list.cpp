// The format of files of jobs.
#include <fnmatch.h>

#include <algorithm>
#include <unordered_map>

#include "cli/batch/job.h"
#include "core/likeliest_name.h"
#include "core/memory_cap.h"

namespace trueshade::batch {
namespace {

constexpr std::string_view kRootKeys[] = {"$schema", "version", "jobs"};
constexpr std::string_view kJobKeys[] = {"name", "for", "run", "after", "timeout", "expect"};
constexpr std::string_view kExpectKeys[] = {"exit", "hash"};
constexpr json::ObjectKeys kObjects[] = {{"", kRootKeys}, {"job", kJobKeys}, {"expect", kExpectKeys}};
enum ObjectIndex : uint8_t { kRoot, kJob, kExpect };

constexpr size_t kMostWords = 10000;
constexpr double kLeastTimeout = 0.001, kLongestTimeout = 1e7;  // seconds

/// A word of `for` and what it stands for in one job.
using Meanings = std::vector<std::pair<std::string, std::string>>;

/// The text with every {WORD} replaced; other braces stay.
std::string filled(const std::string& text, const Meanings& meanings) {
  std::string result;
  for (size_t at = 0; at < text.size();) {
    const auto meaning = std::find_if(meanings.begin(), meanings.end(), [&](const auto& word) {
      return text[at] == '{' && text.compare(at + 1, word.first.size(), word.first) == 0 &&
             at + 1 + word.first.size() < text.size() && text[at + 1 + word.first.size()] == '}';
    });
    if (meaning == meanings.end()) {
      result += text[at++];
    } else {
      result += meaning->second;
      at += meaning->first.size() + 2;
    }
  }
  return result;
}

bool is_hash(const std::string& text) {
  constexpr std::string_view kBefore = "sha256:";
  return text.starts_with(kBefore) && text.size() == kBefore.size() + 64 &&
         text.find_first_not_of("0123456789abcdef", kBefore.size()) == std::string::npos;
}

/// A job of the file with its names of other jobs, which are looked up when all are known.
struct NamedJob {
  Job job;
  std::vector<std::string> after;
};

class ListReader {
 public:
  ListReader(const json::Node& root, const std::string& file) : root_(root) { list_.file = file; }

  JobList read() {
    root_.check_keys(kObjects[kRoot]);
    if (const auto schema = root_.find("$schema")) schema->string();
    if (const auto version = root_.find("version")) version->integer(1, 1);
    const json::Node jobs = root_.member("jobs");
    const size_t count = jobs.array(1, kMostJobs).size();
    for (size_t i = 0; i < count; ++i) read_job(jobs.element(i));
    for (size_t i = 0; i < list_.jobs.size(); ++i) find_after(int(i));
    refuse_circles();
    return std::move(list_);
  }

 private:
  void read_job(const json::Node& node) {
    node.check_keys(kObjects[kJob]);
    Meanings meanings;
    const auto words = node.find("for");
    const json::Members* lists = nullptr;
    if (words) {
      const auto* object = std::get_if<std::unique_ptr<json::Members>>(&words->value().is);
      if (object == nullptr) words->fail("this is no object", "an object of words, each with a list of strings");
      lists = object->get();
      check_count(*words, *lists);
    }
    read_for(node, words ? &*words : nullptr, lists, 0, meanings);
  }

  /// Before jobs are made for all choices of all words.
  void check_count(const json::Node& words, const json::Members& lists) const {
    size_t made = 1;
    for (const auto& [word, value] : lists) {
      made *= json::Node(value, words, std::string_view(word)).array(1, kMostJobsOfOne).size();
      if (made > kMostJobsOfOne)
        words.fail("this makes more jobs than the limit", "at most " + std::to_string(kMostJobsOfOne),
                   ErrorKind::limit);
    }
  }

  /// A job for every choice of the words from `place` on; the last word changes first.
  void read_for(const json::Node& node, const json::Node* words, const json::Members* lists, size_t place,
                Meanings& meanings) {
    if (lists == nullptr || place == lists->size()) return add_job(node, meanings);
    const auto& [word, value] = (*lists)[place];
    const json::Node choices(value, *words, std::string_view(word));
    if (word.empty() || word.find_first_of("{}") != std::string::npos)
      choices.fail("the word is empty or has braces", "a word of letters");
    const size_t count = choices.array(1, kMostJobsOfOne).size();
    for (size_t i = 0; i < count; ++i) {
      meanings.emplace_back(word, choices.element(i).string());
      read_for(node, words, lists, place + 1, meanings);
      meanings.pop_back();
    }
  }

  void add_job(const json::Node& node, const Meanings& meanings) {
    if (list_.jobs.size() == kMostJobs)
      node.fail("there are more jobs than the limit", "at most " + std::to_string(kMostJobs), ErrorKind::limit);
    Job job;
    job.pointer = node.pointer();
    const json::Node name = node.member("name"), run = node.member("run");
    job.name = filled(name.string(), meanings);
    if (job.name.empty() || job.name.size() > 1000 || job.name.find_first_of("*?[") != std::string::npos)
      name.fail("the name is empty, too long, or has one of *?[", "up to 1000 other characters");
    if (!indices_.emplace(job.name, int(list_.jobs.size())).second)
      name.fail("two jobs have the name '" + job.name + "'",
                meanings.empty() ? "another name" : "a name with every word of `for` in braces");
    const size_t words = run.array(1, kMostWords).size();
    for (size_t i = 0; i < words; ++i) job.run.push_back(filled(run.element(i).string(), meanings));
    if (const auto timeout = node.find("timeout")) job.timeout = timeout->number(kLeastTimeout, kLongestTimeout);
    if (const auto expect = node.find("expect")) job.expected = expectation(*expect, meanings);
    std::vector<std::string> after;
    if (const auto names = node.find("after")) {
      const size_t count = names->array(0, kMostJobs).size();
      for (size_t i = 0; i < count; ++i) after.push_back(filled(names->element(i).string(), meanings));
    }
    require_memory(bytes_of(job, after), list_.file + ": " + job.pointer, "the jobs");
    list_.jobs.push_back(std::move(job));
    after_.push_back(std::move(after));
  }

  static uint64_t bytes_of(const Job& job, const std::vector<std::string>& after) {
    uint64_t bytes = sizeof(Job) + 2 * job.name.size();  // a name is a key, too
    for (const auto* texts : {&job.run, &after, &job.expected.hashes})
      for (const std::string& text : *texts) bytes += sizeof text + text.size();
    return bytes;
  }

  static Expectation expectation(const json::Node& node, const Meanings& meanings) {
    node.check_keys(kObjects[kExpect]);
    Expectation expected;
    if (const auto exit = node.find("exit")) expected.exit_code = int(exit->integer(0, 255));
    const auto hash = node.find("hash");
    if (!hash) return expected;
    const auto add = [&](const json::Node& one) {
      const std::string text = filled(one.string(), meanings);
      if (!is_hash(text)) one.fail("'" + text.substr(0, 100) + "' is no hash", "sha256: and 64 hexadecimal digits");
      expected.hashes.push_back(text);
    };
    if (!hash->is_array()) {
      add(*hash);
      return expected;
    }
    const size_t count = hash->array(1, kMostJobs).size();
    for (size_t i = 0; i < count; ++i) add(hash->element(i));
    return expected;
  }

  [[noreturn]] void fail(const Job& job, const std::string& place, const std::string& reason, const std::string& remedy,
                         ErrorKind kind = ErrorKind::bad_input) const {
    throw Error(kind, list_.file + ": " + job.pointer + place, reason, remedy);
  }

  std::vector<std::string_view> names() const {
    std::vector<std::string_view> all;
    for (const Job& job : list_.jobs) all.push_back(job.name);
    return all;
  }

  void find_after(int index) {
    Job& job = list_.jobs[size_t(index)];
    for (size_t i = 0; i < after_[size_t(index)].size(); ++i) {
      const std::string &name = after_[size_t(index)][i], place = "/after/" + std::to_string(i);
      const size_t before = job.after.size();
      if (name.find_first_of("*?[") == std::string::npos) {
        if (const auto found = indices_.find(name); found != indices_.end()) job.after.push_back(found->second);
      } else {
        for (int k = 0; k < int(list_.jobs.size()); ++k)
          if (k != index && fnmatch(name.c_str(), list_.jobs[size_t(k)].name.c_str(), 0) == 0) job.after.push_back(k);
      }
      if (job.after.size() == before)
        fail(job, place, "there is no job '" + name.substr(0, 100) + "'",
             did_you_mean(name, names()) + "the name of a job, or a pattern of names");
      if (job.after.size() == before + 1 && job.after.back() == index)
        fail(job, place, "the job is after itself", "the name of another job");
    }
    std::sort(job.after.begin(), job.after.end());
    job.after.erase(std::unique(job.after.begin(), job.after.end()), job.after.end());
    dependences_ += job.after.size();
    if (dependences_ > kMostDependences)
      fail(job, "/after", "jobs are after more jobs than the limit",
           "at most " + std::to_string(kMostDependences) + " together", ErrorKind::limit);
  }

  /// Takes away jobs that are after none that is left, until none is left or all are in circles or behind them.
  void refuse_circles() const {
    const size_t count = list_.jobs.size();
    std::vector<std::vector<int>> before(count);
    std::vector<size_t> waits_for(count);
    std::vector<int> free;
    for (size_t i = 0; i < count; ++i) {
      waits_for[i] = list_.jobs[i].after.size();
      if (waits_for[i] == 0) free.push_back(int(i));
      for (const int other : list_.jobs[i].after) before[size_t(other)].push_back(int(i));
    }
    for (size_t next = 0; next < free.size(); ++next)
      for (const int waiting : before[size_t(free[next])])
        if (--waits_for[size_t(waiting)] == 0) free.push_back(waiting);
    if (free.size() == count) return;
    const auto stuck = [&](int job) { return waits_for[size_t(job)] > 0; };
    int at = 0;
    while (!stuck(at)) ++at;
    std::vector<int> way;  // each after the next; it comes to a job that it has been at
    std::vector<bool> seen(count);
    while (!seen[size_t(at)]) {
      seen[size_t(at)] = true;
      way.push_back(at);
      const std::vector<int>& after = list_.jobs[size_t(at)].after;
      at = *std::find_if(after.begin(), after.end(), stuck);
    }
    way.erase(way.begin(), std::find(way.begin(), way.end(), at));
    std::string circle;
    for (size_t i = 0; i < std::min<size_t>(way.size(), 8); ++i) circle += list_.jobs[size_t(way[i])].name + " after ";
    if (way.size() > 8) circle += "... after ";
    fail(list_.jobs[size_t(at)], "/after", "jobs wait for each other: " + circle + list_.jobs[size_t(at)].name,
         "leave one of them out");
  }

  const json::Node& root_;
  JobList list_;
  std::vector<std::vector<std::string>> after_;  // a row a job, names as the file has them
  std::unordered_map<std::string, int> indices_;
  size_t dependences_ = 0;
};

}  // namespace

JobList job_list_from_json(std::string_view text, const std::string& file) {
  const json::Value value = json::parse(text, file);
  return ListReader(json::Node(value, file), file).read();
}

std::vector<bool> chosen_jobs(const JobList& list, const std::string& pattern) {
  std::vector<bool> chosen(list.jobs.size(), false);
  std::vector<int> to_see;
  const auto choose = [&](int job) {
    if (!chosen[size_t(job)]) to_see.push_back(job);
    chosen[size_t(job)] = true;
  };
  for (int i = 0; i < int(list.jobs.size()); ++i)
    if (fnmatch(pattern.c_str(), list.jobs[size_t(i)].name.c_str(), 0) == 0) choose(i);
  while (!to_see.empty()) {
    const int job = to_see.back();
    to_see.pop_back();
    for (const int other : list.jobs[size_t(job)].after) choose(other);
  }
  return chosen;
}

std::span<const json::ObjectKeys> job_object_keys() { return kObjects; }

}  // namespace trueshade::batch
