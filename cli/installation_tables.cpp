// The tables of commands that packages and installations call: man and completion.
#include <algorithm>

#include "cli/command_tables.h"
#include "cli/option_values.h"

namespace trueshade {

namespace {

void take_output(ManOptions& options, const std::string& name) {
  if (name.empty()) throw usage("man", "'' is no name of a file or a folder", "name one");
  if (!options.output.empty()) throw usage("-o", "pages go to one place, and FOLDER is given too", "leave one out");
  options.output = name;
}

}  // namespace

CommandTable man_table(ManOptions& options, const std::vector<std::string>& commands) {
  CommandTable table{"man", "Write manual pages, made of what --help is made of"};
  OptionRow folder{.names = "FOLDER",
                   .value_name = "FOLDER",
                   .help = "Folder for trueshade.1 and a page of each command; made if it is not there"};
  folder.take = [&options](const std::vector<std::string>& given) { take_output(options, given.back()); };
  table.add(std::move(folder));
  table.open_group = "Output";
  OptionRow output{
      .names = "-o,--output",
      .value_name = "FILE",
      .help = "Write one page: a file that ends in .1, or - for standard output; any other name is FOLDER"};
  output.take = [&options](const std::vector<std::string>& given) { take_output(options, given.back()); };
  table.add(std::move(output));
  add_value(table, "--command", "NAME", options.command, "Whose page is written, without it that of trueshade itself")
      .known_values = commands;
  add_quiet(table, options, "Say not which files were written");
  table.examples = {{"trueshade man man1", "The pages of this version."},
                    {"trueshade man --command render -o render.1", "One page."}};
  table.see_also = {"completion"};
  table.finished = [&options, commands]() -> Command {
    if (options.output.empty()) throw usage("FOLDER", "it is required", "name one, or add -o FILE");
    if (options.command && std::find(commands.begin(), commands.end(), *options.command) == commands.end())
      throw unknown_name("--command", "there is no command", *options.command, commands);
    if (options.command && !is_one_page(options.output))
      throw usage("--command", "a folder takes the pages of all commands", "add -o with a name that ends in .1");
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
