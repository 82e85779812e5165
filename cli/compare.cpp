#include <algorithm>
#include <filesystem>
#include <system_error>

#include "cli/accepting.h"
#include "cli/activity.h"
#include "cli/commands.h"
#include "cli/compared_pictures.h"
#include "cli/junit.h"
#include "cli/notes.h"
#include "cli/option_values.h"
#include "cli/picture_output.h"
#include "cli/picture_rows.h"
#include "cli/progress_bar.h"
#include "cli/written_files.h"
#include "core/error.h"
#include "core/file_ending.h"
#include "core/image_files/image_io.h"
#include "core/standard_input.h"

namespace trueshade {
namespace {

namespace fs = std::filesystem;

bool is_folder(const std::string& path) {
  std::error_code unknown;
  return fs::is_directory(path, unknown);
}

bool lies_within(const std::string& path, const std::string& folder) {
  std::error_code unknown;
  const fs::path inner = fs::weakly_canonical(path, unknown), outer = fs::weakly_canonical(folder, unknown);
  return std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first == outer.end();
}

/// A picture compared with itself passes whatever it holds, so who asks for that has mistyped a name.
void check_names(const CompareOptions& options) {
  std::error_code unknown;
  if (options.reference == kStandardInputName && options.test == kStandardInputName)
    throw usage("TEST", "standard input is the reference already", "name a file for one of the two");
  if (options.accept && (options.reference == kStandardInputName || options.test == kStandardInputName))
    throw usage("--accept", "standard input is no file that could be copied or replaced", "name two files");
  if (fs::equivalent(options.reference, options.test, unknown))
    throw usage("TEST", "it is the same as the reference, " + options.reference, "name two different ones");
  const bool folder = is_folder(options.reference);
  if (folder != is_folder(options.test) && fs::exists(options.test, unknown) && fs::exists(options.reference, unknown))
    throw Error(ErrorKind::bad_input, folder ? options.test : options.reference,
                folder ? "it is a file, and the reference a folder" : "it is a file, and the test a folder",
                "name two pictures, or two folders");
  std::vector<std::string> outputs = options.outputs;
  if (options.junit) outputs.push_back(*options.junit);
  for (const std::string& path : outputs)
    if (fs::equivalent(path, options.reference, unknown) || fs::equivalent(path, options.test, unknown) ||
        fs::equivalent(path, options.mask.file, unknown))
      throw usage("-o", "'" + path + "' is one of the pictures that are compared, or their mask",
                  "give it another name");
}

bool is_page(const std::string& path) { return has_ending(path, ".html"); }

void check_picture_outputs(const CompareOptions& options) {
  for (const std::string& path : options.outputs) {
    if (!is_picture_name(path) && !is_page(path))
      throw usage("-o", "no format has the ending of '" + path + "'", "end the name in .png, .exr or .html");
    check_file_output(path);
  }
  if (options.junit) check_file_output(*options.junit);
}

StandardOutput answers(const CompareOptions& options) {
  return options.json ? StandardOutput::answer : StandardOutput::files;
}

/// One picture as a folder's row, for JUnit.
FolderComparison as_row(const CompareOptions& options, const ComparedPictures& pictures) {
  PictureRow row;
  row.name = options.test;
  row.state = passes(pictures)                                              ? RowState::same
              : pictures.comparison.outcome == compare::Outcome::mismatched ? RowState::mismatched
                                                                            : RowState::different;
  row.reason = verdict_line(pictures);
  row.left_out_pixels = pictures.comparison.differences.left_out;
  if (row.state != RowState::same) row.details = comparison_text(pictures);
  row.is_accepted = pictures.is_accepted;
  return {options.reference, options.test, {row}, {}, {}};
}

void write_junit(const std::string& file, const FolderComparison& folders) {
  write_text(file, junit_xml("trueshade compare", folders.reference, junit_cases(folders)));
}

bool accepted(const CompareOptions& options, const PictureFile& test) {
  const std::string refusal = why_not_acceptable(test, options.rules.allow_not_finite);
  if (!refusal.empty())
    throw Error(ErrorKind::bad_input, options.test, refusal, "correct the picture, or add --allow-nonfinite");
  accept_picture(options.test, options.reference);
  say("accepted " + options.test + " as " + options.reference);
  return true;
}

int compare_two_pictures(const CompareOptions& options) {
  if (options.criteria_file)
    throw usage("--criteria", "it is by names within two folders", "give the options themselves");
  check_picture_outputs(options);
  std::error_code unknown;
  if (options.accept && !fs::exists(options.reference, unknown)) {
    accepted(options, read_any_picture(options.test, options.limits.expansion));
    return 0;
  }
  ComparedPictures pictures;
  {
    const Activity activity("comparing");
    pictures = compared_pictures(options.reference, options.test, options, mask_file(options));
  }
  for (const std::string& path : options.outputs) {
    if (is_page(path))
      write_text(path, comparison_page(pictures, "trueshade" + options.command_line));
    else if (why_no_differences(pictures, path).empty())
      write_differences(pictures, path);
  }
  pictures.is_accepted = options.accept && !passes(pictures) && accepted(options, pictures.test);
  if (options.junit) write_junit(*options.junit, as_row(options, pictures));
  print(options.json ? comparison_json(pictures) + '\n' : shown_report(comparison_text(pictures)));
  for (const std::string& path : options.outputs) {
    const std::string why = is_page(path) ? "" : why_no_differences(pictures, path);
    if (why.empty())
      say_written(path, is_page(path) ? "HTML report" : "differences, " + kind_of_file(path), answers(options));
    else
      say_notes({path + " is not written: " + why});
  }
  if (options.junit) say_written(*options.junit, "JUnit", answers(options));
  return passes(pictures) || pictures.is_accepted ? 0 : 1;
}

int compare_two_folders(CompareOptions options) {
  const auto first_page = std::stable_partition(options.outputs.begin(), options.outputs.end(),
                                                [](const std::string& path) { return !is_page(path); });
  const std::vector<std::string> galleries(first_page, options.outputs.end());
  options.outputs.erase(first_page, options.outputs.end());
  if (options.outputs.size() > 1) throw usage("-o", "one folder takes all maps", "name one");
  for (const std::string& gallery : galleries) check_file_output(gallery);
  for (const std::string& folder : options.outputs) {
    std::error_code unknown;
    if (has_ending(folder, ".htm")) throw usage("-o", "'" + folder + "' is named like a page", "end its name in .html");
    for (const std::string& compared : {options.reference, options.test})
      if (lies_within(folder, compared))
        throw usage("-o", "'" + folder + "' lies in " + compared + ", whose pictures are compared: maps would be some",
                    "name a folder outside");
    if (is_picture_name(folder))
      throw usage("-o", "'" + folder + "' is named like a file, and of folders maps are written into a folder",
                  "name a folder, or a page that ends in .html");
    if (fs::exists(folder, unknown) && !is_folder(folder))
      throw usage("-o", "'" + folder + "' is no folder, and of folders maps are written into one", "name a folder");
    options.rules.wants_flip = true;
  }
  if (options.junit) check_file_output(*options.junit);
  FolderComparison folders;
  {
    ProgressBar bar("comparing", "pictures");
    folders = compared_folders(options, !galleries.empty(), [&bar](int done, int count) { bar.show(done, count); });
  }
  for (const std::string& gallery : galleries) {
    const Activity activity("making the page");
    make_folder_of(gallery);  // from which its links begin
    write_text(gallery, gallery_page(folders, options, gallery));
  }
  if (options.junit) write_junit(*options.junit, folders);
  print(options.json ? rows_json(folders) : shown_report(rows_text(folders)));
  for (const std::string& gallery : galleries) say_written(gallery, "HTML report", answers(options));
  if (options.junit) say_written(*options.junit, "JUnit", answers(options));
  return folders.exit_code();
}

}  // namespace

int compare_pictures(const CompareOptions& options) {
  check_names(options);
  std::error_code unknown;
  const bool is_first = options.accept && is_folder(options.test) && !fs::exists(options.reference, unknown);
  if (is_first) say_notes({options.reference + " is not there, so it is made of the pictures that are accepted"});
  try {
    return is_first || is_folder(options.reference) ? compare_two_folders(options) : compare_two_pictures(options);
  } catch (const Error& error) {
    if (options.junit) report_error(*options.junit, "trueshade compare", options.test, error);
    throw;
  }
}

}  // namespace trueshade
