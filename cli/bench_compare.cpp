// `bench A.json B.json`: two results of bench, of two machines or two commits. `bench A1.json B1.json A2.json B2.json
// ...`: several runs of each, in turn.
#include <algorithm>
#include <filesystem>
#include <map>
#include <tuple>

#include "bench/comparison.h"
#include "cli/bench.h"
#include "cli/commands.h"
#include "cli/json_text.h"
#include "cli/option_values.h"
#include "cli/written_files.h"
#include "core/error.h"
#include "core/image_files/image_io.h"
#include "scenes/files/content/scene_files.h"
#include "scenes/json/json_value.h"

namespace trueshade {
namespace {

constexpr uint64_t kMostBytes = uint64_t(64) << 20;
constexpr size_t kMostFrames = 500;   ///< of a row
constexpr size_t kLeastTimes = 5;     ///< of a row, frames of one run or medians of several
constexpr double kConfidence = 0.99;  ///< of each row's interval
/// Runs of one program differ too, by where memory lies and what the machine does, which frames of one run do not show:
/// 24 of city on an idle guest took 7.4 to 7.7 ms, or 8.3 to 8.6. Where there is one run a side, smaller differences
/// are called none.
constexpr double kBetweenRuns = 1.15;

/// Who drew what.
struct RowName {
  std::string scene, who;
  auto operator<=>(const RowName&) const = default;
};

struct Row {
  RowName name;
  std::string hash;  ///< of the scene's picture
  std::vector<double> ms;

  double median() const { return ms[ms.size() / 2]; }
};

/// Something that may differ between two machines or builds, in a word, and what it is.
struct MachineFact {
  std::string name, value;
};

struct Result {
  std::string file, about;
  std::vector<MachineFact> facts;
  std::vector<std::string> reasons;
  std::vector<Row> rows;
  std::optional<std::pair<int, double>> score;  ///< of which standard
  int runs = 1;                                 ///< of several, the times of a row are the medians of each
};

enum class Verdict { none, slower, faster, too_few, busy };
constexpr std::string_view kVerdicts[] = {"no difference beyond noise", "slower", "faster", "too few frames to tell",
                                          "not to be quoted"};

struct ComparedRow {
  RowName name;
  double before_ms, after_ms;
  RatioInterval ratio;
  Verdict verdict;
  bool is_same_picture;
};

/// The ratio beyond which rows differ, where the interval holds it whole.
double least_difference(const Result& before, const Result& after) {
  return before.runs > 1 && after.runs > 1 ? 1.0 : kBetweenRuns;
}

Verdict verdict_of(const RatioInterval& r, double least) {
  if (r.low == 0) return Verdict::too_few;
  if (r.low > least) return Verdict::slower;
  return r.high < 1 / least ? Verdict::faster : Verdict::none;
}

std::vector<double> times_of(const json::Node& row, const std::string& file) {
  const auto frames = row.find("frame_ms");
  if (!frames)
    throw Error(ErrorKind::bad_input, file + ": " + row.pointer(), "the times of single frames are missing",
                "write it again by this version's `trueshade bench --json FILE`");
  std::vector<double> ms;
  for (size_t i = 0, count = frames->array(1, kMostFrames).size(); i < count; ++i)
    ms.push_back(frames->element(i).number(json::kSmallest, json::kLargest));
  std::sort(ms.begin(), ms.end());
  return ms;
}

std::string text_in(const json::Node& node, std::string_view key) { return node.member(key).string(); }

Result result_of(const json::Value& value, const std::string& file) {
  const json::Node root(value, file);
  const json::Node machine = root.member("machine"), scenes = root.member("scenes");
  Result result;
  result.file = file;
  result.about = text_in(machine, "cpu") + ", " + std::to_string(machine.member("cores").integer(1, 1 << 20)) +
                 (machine.member("cores").integer(1, 1 << 20) == 1 ? " core at " : " cores at ") +
                 formatted(machine.member("clock_ghz").number(0, 1e3), "%.2f") + " GHz; Trueshade " +
                 text_in(root, "version") + " (" + text_in(root, "commit") + "), " + text_in(root, "simd") + ", " +
                 std::to_string(root.member("threads").integer(1, 1 << 20)) +
                 (root.member("threads").integer(1, 1 << 20) == 1 ? " thread" : " threads");
  if (const auto date = machine.find("date")) result.about += "; " + date->string();
  result.facts = {{"the CPU", text_in(machine, "cpu")},
                  {"cores", std::to_string(machine.member("cores").integer(1, 1 << 20))},
                  {"threads", std::to_string(root.member("threads").integer(1, 1 << 20))},
                  {"the SIMD target", text_in(root, "simd")}};
  for (const std::string_view key : {"os", "compiler", "opengl"})
    if (const auto found = machine.find(key)) result.facts.push_back({std::string(key), found->string()});
  result.facts.push_back({"the commit", text_in(root, "commit")});
  if (const auto reasons = root.find("not_to_be_quoted"))
    for (size_t i = 0, count = reasons->array(0, 1000).size(); i < count; ++i)
      result.reasons.push_back(reasons->element(i).string());
  if (const auto standard = root.find("standard"))
    result.score = {int(standard->member("version").integer(1, 1 << 20)),
                    standard->member("score").number(json::kSmallest, json::kLargest)};
  for (size_t i = 0, count = scenes.array(1, 10000).size(); i < count; ++i) {
    const json::Node scene = scenes.element(i);
    const std::string name = text_in(scene, "scene") + "  " + text_in(scene, "preset") + "  " + text_in(scene, "size") +
                             "  " + text_in(scene, "strategy");
    const std::string hash = text_in(scene, "hash");
    result.rows.push_back({{name, "trueshade"}, hash, times_of(scene, file)});
    const json::Node peers = scene.member("peers");
    for (size_t k = 0, most = peers.array(0, 10000).size(); k < most; ++k) {
      const json::Node peer = peers.element(k);
      result.rows.push_back(
          {{name, text_in(peer, "name") + ' ' + text_in(peer, "strategy")}, hash, times_of(peer, file)});
    }
  }
  return result;
}

/// What a file is, if it has what every result of bench has; a scene has neither member.
std::optional<json::Value> bench_result(const std::string& file) {
  std::error_code error;
  if (!file.ends_with(".json") || !std::filesystem::is_regular_file(file, error)) return {};
  if (std::filesystem::file_size(file, error) > kMostBytes || error) return {};
  const Bytes bytes = read_user_file(file, kMostBytes, "");
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (text.find("\"machine\"") == std::string_view::npos || text.find("\"scenes\"") == std::string_view::npos)
    return {};
  json::Value value = json::parse(text, file);
  const auto* members = std::get_if<std::unique_ptr<json::Members>>(&value.is);
  const auto has = [&](std::string_view key) {
    return std::any_of((*members)->begin(), (*members)->end(), [key](const auto& m) { return m.first == key; });
  };
  if (members == nullptr || !has("machine") || !has("scenes") || !has("simd")) return {};
  return value;
}

/// "cores (1 and 2), threads (1 and 2)": in what two results differ besides their times; empty: in nothing that is
/// known.
std::string differing_facts(const Result& before, const Result& after) {
  std::string text;
  for (const MachineFact& fact : before.facts)
    for (const MachineFact& other : after.facts)
      if (other.name == fact.name && other.value != fact.value)
        text += (text.empty() ? "" : ", ") + fact.name + " (" + fact.value + " and " + other.value + ")";
  return text;
}

/// Several runs as one result: of each row that all have, the medians. Error(bad_input) where they are of several
/// machines or programs.
Result of_runs(const std::vector<Result>& runs) {
  Result all = runs.front();
  if (runs.size() == 1) return all;
  all.rows.clear(), all.score.reset();
  all.runs = int(runs.size());
  for (size_t i = 1; i < runs.size(); ++i) {
    if (const std::string differing = differing_facts(runs.front(), runs[i]); !differing.empty())
      throw Error(ErrorKind::bad_input, runs[i].file,
                  "as a run of the same side as " + runs.front().file + " it differs in " + differing,
                  "name runs of A and B in turn: A1.json B1.json A2.json B2.json");
    all.file += ", " + runs[i].file;
    all.reasons.insert(all.reasons.end(), runs[i].reasons.begin(), runs[i].reasons.end());
  }
  for (const Row& row : runs.front().rows) {
    Row medians{row.name, row.hash, {}};
    for (const Result& run : runs)
      for (const Row& other : run.rows)
        if (other.name == row.name && other.hash == row.hash) medians.ms.push_back(other.median());
    std::sort(medians.ms.begin(), medians.ms.end());
    if (medians.ms.size() == runs.size()) all.rows.push_back(std::move(medians));
  }
  return all;
}

struct Comparison {
  Result before, after;
  std::vector<ComparedRow> rows;
  std::vector<std::pair<std::string, RowName>> lonely;  ///< rows that one file alone has
};

Comparison compared(Result before, Result after) {
  Comparison c{std::move(before), std::move(after), {}, {}};
  std::map<RowName, const Row*> others;
  for (const Row& row : c.after.rows) others[row.name] = &row;
  for (const Row& row : c.before.rows) {
    const auto other = others.find(row.name);
    if (other == others.end()) {
      c.lonely.emplace_back(c.before.file, row.name);
      continue;
    }
    const Row& now = *other->second;
    const RatioInterval ratio = ratio_interval(row.ms, now.ms, kConfidence);
    Verdict verdict = std::min(row.ms.size(), now.ms.size()) < kLeastTimes
                          ? Verdict::too_few
                          : verdict_of(ratio, least_difference(c.before, c.after));
    const bool differs = verdict == Verdict::slower || verdict == Verdict::faster;
    if (differs && !(c.before.reasons.empty() && c.after.reasons.empty())) verdict = Verdict::busy;
    c.rows.push_back({row.name, row.median(), now.median(), ratio, verdict, row.hash == now.hash});
    others.erase(other);
  }
  for (const Row& row : c.after.rows)
    if (others.contains(row.name)) c.lonely.emplace_back(c.after.file, row.name);
  if (c.rows.empty())
    throw Error(ErrorKind::bad_input, c.before.file + " and " + c.after.file, "no row is in both of them",
                "compare results of the same scenes, sizes and presets");
  return c;
}

bool have_scores(const Comparison& c) {
  return c.before.score && c.after.score && c.before.score->first == c.after.score->first;
}

std::string result_text(const char* letter, const Result& result) {
  return std::string(letter) + "  " + result.file + ": " + result.about + '\n' + reasons_text(result.reasons, "   ");
}

std::string comparison_text(const Comparison& c) {
  std::string text = result_text("A", c.before) + result_text("B", c.after), scene;
  if (const std::string differences = differing_facts(c.before, c.after); !differences.empty())
    text += "A and B differ in " + differences + '\n';
  size_t differing = 0;
  for (const ComparedRow& row : c.rows) {
    if (row.name.scene != scene) {
      scene = row.name.scene;
      text += '\n' + scene + (row.is_same_picture ? "" : "  (two pictures: their hashes differ)") + '\n';
    }
    std::string who = row.name.who;
    who.resize(std::max(who.size(), size_t(26)), ' ');
    text += "  " + who + formatted(row.before_ms, " %9.2f ms ") + formatted(row.after_ms, "%9.2f ms  ") +
            formatted(row.ratio.ratio, "B takes %.3f times as long") +
            (row.verdict == Verdict::too_few
                 ? ""
                 : formatted(row.ratio.low, " (%.3f to ") + formatted(row.ratio.high, "%.3f)")) +
            ": " + std::string(kVerdicts[size_t(row.verdict)]) + '\n';
    differing += row.verdict == Verdict::slower || row.verdict == Verdict::faster || row.verdict == Verdict::busy;
  }
  for (const auto& [file, row] : c.lonely) text += "  only " + file + " has " + row.scene + ", " + row.who + '\n';
  if (have_scores(c))
    text += "\nstandard " + std::to_string(c.before.score->first) + ": scores " +
            formatted(c.before.score->second, "%.1f and ") + formatted(c.after.score->second, "%.1f, ") +
            formatted(c.after.score->second / c.before.score->second, "B's is %.3f times A's\n");
  else if (c.before.score && c.after.score)
    text += "\nscores are not compared: A's is of standard " + std::to_string(c.before.score->first) +
            ", B's of standard " + std::to_string(c.after.score->first) + '\n';
  const double least = least_difference(c.before, c.after);
  text += '\n' + std::to_string(differing) + " of " + std::to_string(c.rows.size()) +
          " rows differ beyond noise: with " + formatted(100 * kConfidence, "%.0f") + " % confidence" +
          (least > 1 ? formatted(100 * (least - 1), " by more than %.0f %%") : " from run to run") + '\n';
  if (!c.before.reasons.empty() || !c.after.reasons.empty())
    return text +
           "which tells nothing of the programs: what else the machines did may be the cause (not to be quoted, "
           "above)\n";
  return text + (least > 1 ? "Frames of one run a side do not show how runs differ: five runs a side, in turn, do "
                             "(bench A1.json B1.json A2.json B2.json ...)\n"
                           : "");
}

std::string result_json(const Result& result) {
  return JsonObject()
      .put("file", result.file)
      .put("about", result.about)
      .put_raw("not_to_be_quoted", reasons_json(result.reasons))
      .text();
}

std::string comparison_json(const Comparison& c) {
  JsonArray rows, lonely;
  for (const ComparedRow& row : c.rows) {
    JsonObject json;
    json.put("scene", row.name.scene).put("who", row.name.who);
    json.put("ms_a", row.before_ms).put("ms_b", row.after_ms).put("ratio", row.ratio.ratio);
    json.put("low", row.ratio.low).put("high", row.ratio.high).put("same_picture", row.is_same_picture);
    rows.add_raw(json.put("verdict", kVerdicts[size_t(row.verdict)]).text());
  }
  for (const auto& [file, row] : c.lonely)
    lonely.add_raw(JsonObject().put("file", file).put("scene", row.scene).put("who", row.who).text());
  JsonObject json;
  json.put_raw("a", result_json(c.before)).put_raw("b", result_json(c.after));
  json.put("confidence", kConfidence).put("between_runs", least_difference(c.before, c.after));
  json.put("runs_a", c.before.runs).put("runs_b", c.after.runs).put("differ_in", differing_facts(c.before, c.after));
  json.put_raw("rows", rows.text());
  if (have_scores(c)) json.put("score_ratio", c.after.score->second / c.before.score->second);
  return json.put_raw("only_one_has", lonely.text()).text() + '\n';
}

}  // namespace

bool compared_results(const BenchOptions& options) {
  std::vector<std::pair<std::string, json::Value>> results;
  std::string other;
  for (const std::string& file : options.scenes) {
    if (auto value = bench_result(file))
      results.emplace_back(file, std::move(*value));
    else
      other = file;
  }
  if (results.empty()) return false;
  if (!other.empty() && !other.starts_with("builtin:") && !std::filesystem::exists(other))
    throw Error(ErrorKind::io, other, "No such file or directory",
                "name a file that `trueshade bench --json FILE` wrote");
  if (!other.empty())
    throw Error(ErrorKind::bad_input, other, "this is no result of bench, and " + results.front().first + " is one",
                "name two files that `trueshade bench --json FILE` wrote");
  if (results.size() % 2 != 0)
    throw usage("SCENE", "results of bench are compared by twos, and here are " + std::to_string(results.size()),
                "name files that `trueshade bench --json FILE` wrote: A.json B.json, or runs of each in turn");
  for (const auto& [name, is_given] : {std::pair{"-o", options.report.has_value()},
                                       {"--against", !options.against.empty()},
                                       {"--moving", options.moving},
                                       {"--quick", options.quick},
                                       {"--size", options.size.has_value()},
                                       {"--preset", options.preset.has_value()},
                                       {"--strategy", options.strategy.has_value()},
                                       {"--simd", options.simd != "best"}})
    if (is_given) throw usage(name, "two results are compared, and nothing is drawn", "leave it out");
  std::vector<Result> sides[2];
  for (size_t i = 0; i < results.size(); ++i) sides[i % 2].push_back(result_of(results[i].second, results[i].first));
  const Comparison c = compared(of_runs(sides[0]), of_runs(sides[1]));
  if (options.json_file != "-") print(comparison_text(c));
  if (!options.json_file) return true;
  const std::string json = comparison_json(c);
  if (*options.json_file == "-") {
    print(json);
  } else {
    write_file(*options.json_file, {reinterpret_cast<const uint8_t*>(json.data()), json.size()});
    say_written(*options.json_file, "JSON", StandardOutput::files);
  }
  return true;
}

}  // namespace trueshade
