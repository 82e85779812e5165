// The commands man and completion.
#include <filesystem>

#include "cli/commands.h"
#include "cli/completion.h"
#include "cli/man_page.h"
#include "core/error.h"
#include "core/image_files/image_io.h"

namespace trueshade {

void write_man_pages(const ManOptions& options) {
  const CommandTables tables;
  std::error_code error;
  std::filesystem::create_directories(options.folder, error);
  if (error) throw Error(ErrorKind::io, options.folder, "cannot make the folder: " + error.message(), "choose another");
  const auto write = [&options](const std::string& name, const std::string& page) {
    const std::string path = options.folder + '/' + name + ".1";
    write_file(path, {reinterpret_cast<const uint8_t*>(page.data()), page.size()});
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
