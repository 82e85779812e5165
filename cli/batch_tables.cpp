// The table of the command that runs other commands: batch.
#include <filesystem>

#include "cli/command_tables.h"
#include "cli/option_values.h"
#include "core/file_ending.h"

namespace trueshade {

CommandTable batch_table(BatchOptions& options) {
  CommandTable table{"batch", "Run many renders, validations and comparisons, and say what became of each"};
  add_value(table, "JOBS", "FILE", options.file, "Jobs, .json (docs/batch.md); their paths are relative to its folder")
      .is_required = true;
  table.open_group = "Jobs";
  add_switch(table, "--resume", options.resumes,
             "Leave out jobs that passed in an earlier run and whose calls, input and output files are as they were");
  add_value(table, "--only", "PATTERN", options.only,
            "Run jobs with names like this, with * and ?, and those that they are after");
  add_value(table, "--state", "FILE", options.state,
            "Where finished jobs are noted for --resume; without it JOBS with .state behind it");
  table.open_group = "Output";
  add_value(table, "--json", "FILE", options.json_file, "JSON document to write; - prints it instead of the table");
  add_value(table, "--junit", "FILE", options.junit, "JUnit XML to write, .xml, for CI services");
  add_value(table, "-o,--report", "FILE", options.report, "Report to write, .html");
  add_quiet(table, options, "Print the verdict alone; say neither progress nor which files were written");
  table.open_group = "Execution";
  constexpr int kMostJobs = 1024;
  const auto read_jobs = [](const std::string& text) { return integer_in("--jobs", text, 0, kMostJobs); };
  add_read(table, "--jobs", "COUNT", options.jobs, read_jobs,
           "Jobs at once, of each process that MPI has started; 0 for as many as there are cores for their threads");
  add_threads(table, options.threads,
              "Threads of a job that does not say its own, 0 for the cores shared evenly; never changes a pixel");
  add_sharing(table, options.sharing);
  table.details =
      "Every job is a process of its own; one that fails ends no other, but those that are after it are skipped.\n"
      "Exit codes: 0 all jobs passed, 1 some did not; others as for trueshade.";
  table.examples = {{"trueshade batch jobs.json --resume --report jobs.html", "What is not done yet, and a page."}};
  table.see_also = {"render", "validate", "compare"};
  table.finished = [&options]() -> Command { return finished(std::move(options)); };
  return table;
}

BatchOptions finished(BatchOptions options) {
  if (options.file.empty()) throw usage("JOBS", "'' is no name of a file", "name one");
  if (options.json_file && *options.json_file != "-" && !has_ending(*options.json_file, ".json"))
    throw usage("--json", "'" + *options.json_file + "' does not end like JSON",
                "end the name in .json, or - prints it");
  if (options.state && (options.state->empty() || is_picture_name(*options.state)))
    throw usage("--state", "'" + *options.state + "' is no name of a state", "end the name in .state, say");
  if (options.junit && !has_ending(*options.junit, ".xml"))
    throw usage("--junit", "'" + *options.junit + "' does not end like XML", "end the name in .xml");
  if (options.report && !has_ending(*options.report, ".html"))
    throw usage("--report", "'" + *options.report + "' does not end like a page", "end the name in .html");
  std::vector<std::string> files{options.file};
  for (const auto& [option, file] : {std::pair{"--state", options.state},
                                     {"--json", options.json_file},
                                     {"--junit", options.junit},
                                     {"--report", options.report}}) {
    if (!file || *file == "-") continue;
    files.push_back(*file);
    check_named_once(option, files);
    std::error_code unknown;
    if (std::filesystem::equivalent(*file, options.file, unknown))
      throw usage(option, "'" + *file + "' is the file of jobs", "give it another name");
  }
  return options;
}

}  // namespace trueshade
