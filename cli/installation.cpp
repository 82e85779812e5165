// The commands man and completion.
#include <filesystem>

#include "cli/commands.h"
#include "cli/completion.h"
#include "cli/man_page.h"
#include "cli/option_values.h"
#include "cli/picture_output.h"
#include "cli/written_files.h"
#include "core/error.h"

namespace trueshade {

namespace {

void write_man_page(const ManOptions& options, const CommandTables& tables) {
  const std::string page =
      options.command ? man_page_of_command(*tables.named(*options.command)) : man_page_of_program(tables);
  if (is_standard_output(options.output)) return print(page);
  write_text(options.output, page);
  say_written(options.output, "manual page", StandardOutput::files);
}

}  // namespace

void write_man_pages(const ManOptions& options) {
  const CommandTables tables;
  if (is_one_page(options.output)) return write_man_page(options, tables);
  std::error_code error;
  std::filesystem::create_directories(options.output, error);
  if (error) throw Error(ErrorKind::io, options.output, "cannot make the folder: " + error.message(), "choose another");
  const auto write = [&options](const std::string& name, const std::string& page) {
    const std::string path = options.output + '/' + name + ".1";
    write_text(path, page);
    if (!options.quiet) print(path + '\n');
  };
  write("trueshade", man_page_of_program(tables));
  for (const CommandTable& table : tables.all()) write("trueshade-" + table.name, man_page_of_command(table));
}

void print_completion(const CompletionOptions& options) {
  const CommandTables tables;
  print(options.shell == "bash"  ? bash_completion(tables)
        : options.shell == "zsh" ? zsh_completion(tables)
                                 : fish_completion(tables));
}

}  // namespace trueshade
