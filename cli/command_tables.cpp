#include "cli/command_tables.h"

namespace trueshade {

CommandTables::CommandTables() {
  tables_.push_back(render_table(render_));
  tables_.push_back(info_table(info_));
  tables_.push_back(list_table(list_));
  tables_.push_back(glsl_table(glsl_));
  tables_.push_back(export_table(export_));
  tables_.push_back(validate_table(validation_));
  tables_.push_back(probe_table(probe_));
  tables_.push_back(shade_table(shade_));
  tables_.push_back(explain_table(explain_));
  tables_.push_back(view_table(view_));
  tables_.push_back(bench_table(bench_));
  tables_.push_back(compare_table(compare_));
  tables_.push_back(batch_table(batch_));
  CommandTable completion = completion_table(completion_);
  std::vector<std::string> commands = names();
  commands.insert(commands.end(), {"man", completion.name});
  tables_.push_back(man_table(man_, commands));
  tables_.push_back(std::move(completion));
}

std::vector<std::string> CommandTables::names() const {
  std::vector<std::string> all;
  for (const CommandTable& table : tables_) all.push_back(table.name);
  return all;
}

const CommandTable* CommandTables::named(const std::string& name) const {
  for (const CommandTable& table : tables_)
    if (table.name == name) return &table;
  return nullptr;
}

}  // namespace trueshade
