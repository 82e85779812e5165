#include "cli/batch/job_result.h"

#include "cli/json_text.h"

namespace trueshade::batch {
namespace {

constexpr std::string_view kStates[] = {"passed", "failed", "skipped", "unchanged"};
constexpr std::string_view kKinds[] = {"read", "listed", "wrote"};

std::string json_of(const std::vector<std::string>& texts) {
  JsonArray array;
  for (const std::string& text : texts) array.add_raw(json_string(text));
  return array.text();
}

std::string json_of(const std::vector<FileNote>& files) {
  JsonArray array;
  for (const FileNote& file : files)
    array.add_raw(JsonArray()
                      .add_raw(json_string(kKinds[size_t(file.kind)]))
                      .add_raw(json_string(file.path))
                      .add_raw(json_string(file.hash))
                      .text());
  return array.text();
}

std::vector<std::string> texts_from(const json::Node& node) {
  std::vector<std::string> texts;
  const size_t count = node.array(0, SIZE_MAX).size();
  for (size_t i = 0; i < count; ++i) texts.push_back(node.element(i).string());
  return texts;
}

std::vector<FileNote> files_from(const json::Node& node) {
  std::vector<FileNote> files;
  const size_t count = node.array(0, SIZE_MAX).size();
  for (size_t i = 0; i < count; ++i) {
    const json::Node file = node.element(i);
    file.array(3, 3);
    files.push_back(
        {FileNote::Kind(file.element(0).choice(kKinds)), file.element(1).string(), file.element(2).string()});
  }
  return files;
}

}  // namespace

std::string_view name_of(JobState state) { return kStates[size_t(state)]; }

std::string identity_of(const Job& job, const std::string& program) {
  return JsonArray()
      .add_raw(json_of(job.run))
      .add_raw(std::to_string(job.expected.exit_code))
      .add_raw(json_of(job.expected.hashes))
      .add_raw(json_string(program))
      .text();
}

std::string line_of(const Job& job, const JobResult& result, const std::string& program) {
  return JsonObject()
      .put("name", job.name)
      .put("identity", identity_of(job, program))
      .put("state", name_of(result.state))
      .put("reason", result.reason)
      .put("exit", result.exit_code)
      .put("signal", result.signal)
      .put("seconds", result.seconds)
      .put("core_seconds", result.core_seconds)
      .put_raw("hashes", json_of(result.hashes))
      .put("out", result.out)
      .put("err", result.err)
      .put_raw("files", json_of(result.files))
      .put("host", result.host)
      .text();
}

ResultLine result_from_line(std::string_view line, std::string_view where) {
  const json::Value value = json::parse(line, where);
  const json::Node root(value, where);
  ResultLine read;
  read.name = root.member("name").string();
  read.identity = root.member("identity").string();
  JobResult& result = read.result;
  result.state = JobState(root.member("state").choice(kStates));
  result.reason = root.member("reason").string();
  result.exit_code = int(root.member("exit").integer(0, 255));
  result.signal = int(root.member("signal").integer(0, 255));
  result.seconds = root.member("seconds").number(0, json::kLargest);
  result.core_seconds = root.member("core_seconds").number(0, json::kLargest);
  result.hashes = texts_from(root.member("hashes"));
  result.out = root.member("out").string();
  result.err = root.member("err").string();
  result.files = files_from(root.member("files"));
  result.host = root.member("host").string();
  return read;
}

}  // namespace trueshade::batch
