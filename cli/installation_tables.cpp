// The tables of commands that packages and installations call: man and completion.
#include <algorithm>

#include "cli/command_tables.h"
#include "cli/option_values.h"

namespace trueshade {

CommandTable man_table(ManOptions& options) {
  CommandTable table{"man", "Write manual pages, made of what --help is made of"};
  add_value(table, "FOLDER", "FOLDER", options.folder,
            "Folder for trueshade.1 and a page of each command; made if it is "
            "not there")
      .is_required = true;
  add_quiet(table, options, "Say not which files were written");
  table.examples = {{"trueshade man man1", "The pages of this version."}};
  table.see_also = {"completion"};
  table.finished = [&options]() -> Command {
    if (options.folder.empty()) throw usage("FOLDER", "'' is no name of a folder", "name one");
    return options;
  };
  return table;
}

CommandTable completion_table(CompletionOptions& options) {
  CommandTable table{"completion", "Print a script by which a shell completes the command line"};
  OptionRow& shell = add_choice(table, "SHELL", "SHELL", options.shell, "Which shell:", kShellNames);
  shell.is_required = true;
  add_quiet(table, options, "Changes nothing; what is printed is the answer");
  table.examples = {{"source <(trueshade completion bash)", "Completions in this shell."}};
  table.see_also = {"man"};
  table.finished = [&options]() -> Command {
    if (std::find(std::begin(kShellNames), std::end(kShellNames), options.shell) == std::end(kShellNames))
      throw unknown_name("SHELL", "there are no completions for", options.shell, kShellNames);
    return options;
  };
  return table;
}

}  // namespace trueshade
