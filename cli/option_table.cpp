#include "cli/option_table.h"

#include <algorithm>

namespace trueshade {

std::vector<std::string> OptionRow::spellings() const {
  std::vector<std::string> spelled;
  for (size_t begin = 0; begin <= names.size();) {
    const size_t end = std::min(names.find(',', begin), names.size());
    spelled.push_back(names.substr(begin, end - begin));
    begin = end + 1;
  }
  return spelled;
}

OptionRow& CommandTable::add(OptionRow row) {
  if (row.group.empty()) row.group = row.is_argument() ? "Arguments" : open_group;
  return rows.emplace_back(std::move(row));
}

std::vector<std::string> CommandTable::groups() const {
  std::vector<std::string> headings;
  for (const OptionRow& row : rows)
    if (!row.is_argument() && std::find(headings.begin(), headings.end(), row.group) == headings.end())
      headings.push_back(row.group);
  return headings;
}

bool CommandTable::has_limits() const {
  return std::any_of(rows.begin(), rows.end(), [](const OptionRow& row) { return row.group == kLimitsGroup; });
}

std::vector<std::string> CommandTable::option_spellings() const {
  std::vector<std::string> all{"-h", "--help"};
  if (has_limits()) all.emplace_back("--help-limits");
  for (const OptionRow& row : rows)
    if (!row.is_argument())
      for (std::string& name : row.spellings()) all.push_back(std::move(name));
  return all;
}

OptionRow& add_values(CommandTable& table, const char* names, const char* value_name, std::vector<std::string>& texts,
                      std::string help) {
  OptionRow row{.names = names, .value_name = value_name, .help = std::move(help), .is_repeated = true};
  row.take = [&texts](const std::vector<std::string>& given) { texts = given; };
  return table.add(std::move(row));
}

OptionRow& add_switch(CommandTable& table, const char* names, bool& on, std::string help) {
  OptionRow row{.names = names, .value_name = "", .help = std::move(help)};
  row.take = [&on](const std::vector<std::string>&) { on = true; };
  return table.add(std::move(row));
}

void add_limits(CommandTable& table, Limits& limits) {
  add_value(table, "--cache", "FOLDER", limits.cache,
            "Keep the scene in a file of this folder, from where it comes in parts as they are needed the next time "
            "(docs/cache.md)")
      .group = "Reading";
  for (const LimitOption& limit : limit_options()) {
    OptionRow row{.names = limit.name, .value_name = value_name(limit), .help = help_of(limit), .group = kLimitsGroup};
    row.take = [&limits, &limit](const std::vector<std::string>& given) {
      limits.*limit.limit = limit_from_text(limit, given.back());
    };
    table.add(std::move(row));
  }
}

namespace {

constexpr const char* kReading = "Scene files of others";

}  // namespace

void add_trust(CommandTable& table, Limits& limits) {
  OptionRow row{.names = "--trust-paths",
                .value_name = "",
                .help = "Let the scene name files anywhere, by absolute paths and links out of its folder, too",
                .group = kReading};
  row.take = [&limits](const std::vector<std::string>&) { limits.named_paths = NamedPaths::any; };
  table.add(std::move(row));
}

void add_lenient(CommandTable& table, Limits& limits) {
  limits.leniency = Leniency::offered;
  OptionRow row{.names = "--lenient",
                .value_name = "",
                .help =
                    "Show a file that has faults all the same, grey where its pictures are missing; the picture is no "
                    "reference, and says so",
                .group = kReading};
  row.take = [&limits](const std::vector<std::string>&) { limits.leniency = Leniency::asked; };
  table.add(std::move(row));
}

void add_quiet(CommandTable& table, CommonOptions& options, std::string help) {
  add_switch(table, "-q,--quiet", options.quiet, std::move(help)).group = "Output";
}

}  // namespace trueshade
