#include "cli/picture_rows.h"

#include <fnmatch.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <new>
#include <set>
#include <system_error>

#include "cli/accepting.h"
#include "cli/shell_words.h"
#include "cli/written_files.h"
#include "core/error.h"
#include "core/file_ending.h"
#include "core/file_notes.h"

namespace trueshade {
namespace {

namespace fs = std::filesystem;

constexpr const char *kMapEnding = ".flip.png", *kPageEnding = ".html";  // behind a picture's name, in the folder of -o
constexpr std::string_view kPictureEndings[] = {".exr",  ".png", ".hdr", ".pic", ".tif",
                                                ".tiff", ".dds", ".npy", ".jpg", ".jpeg"};

bool has_picture_ending(const fs::path& path) {
  std::string name = path.filename().string();
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return std::any_of(std::begin(kPictureEndings), std::end(kPictureEndings),
                     [&name](std::string_view ending) { return has_ending(name, ending); });
}

RowState state_of(compare::Outcome outcome) {
  switch (outcome) {
    case compare::Outcome::same:
      return RowState::same;
    case compare::Outcome::within:
      return RowState::within;
    case compare::Outcome::different:
      return RowState::different;
    case compare::Outcome::mismatched:
      return RowState::mismatched;
  }
  return RowState::same;  // unreachable: every enumerator returns above
}

/// `: R 12/255 against 14/255` of the channels that differ.
std::string values_text(const compare::PixelValues& pixel) {
  std::string text;
  for (const auto& value : pixel.values)
    if (!value.numbers.equal)
      text += (text.empty() ? ": " : ", ") + value.channel + ' ' + value.reference + " against " + value.test;
  return text;
}

class FolderComparer {
 public:
  FolderComparer(const CompareOptions& options, bool pages)
      : options_(options), pages_(pages), mask_(mask_file(options)), named_(named_criteria(options)) {
    for (const NamedCriteria& named : named_) masks_.push_back(mask_file(named.options));
  }

  PictureRow compare(const std::string& name, bool in_reference, bool in_test) {
    const auto start = std::chrono::steady_clock::now();
    PictureRow row;
    row.name = name;
    for (const std::string& folder : options_.outputs) remove_stale(folder, name);
    try {
      measure(in_reference, in_test, row);
    } catch (const Error& error) {
      fail(error.what(), int(error.kind()), row);
    } catch (const std::bad_alloc&) {
      fail("there is not enough memory for it", int(ErrorKind::out_of_memory), row);
    }
    row.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return row;
  }

  /// Patterns by which no picture was compared.
  std::vector<std::string> unused() const {
    std::vector<std::string> patterns;
    for (size_t i = 0; i < named_.size(); ++i)
      if (!used_.contains(i)) patterns.push_back(named_[i].pattern);
    return patterns;
  }

 private:
  static void fail(const std::string& reason, int exit_code, PictureRow& row) {
    row.state = RowState::unreadable;
    row.reason = reason;
    row.exit_code = exit_code;
  }
  std::string reference(const PictureRow& row) const { return (fs::path(options_.reference) / row.name).string(); }
  std::string test(const PictureRow& row) const { return (fs::path(options_.test) / row.name).string(); }

  void measure(bool in_reference, bool in_test, PictureRow& row) {
    std::error_code unknown;
    if (in_reference && in_test && fs::equivalent(reference(row), test(row), unknown))
      return fail("it is the very file of the reference, by a link, and passes whatever it holds",
                  int(ErrorKind::usage), row);
    if (!in_test) {
      row.state = RowState::missing;
      row.reason = "the test has no such picture";
      if (options_.accept) row.not_accepted = "delete the reference by hand if it is to go";
      return;
    }
    if (!in_reference) {
      row.state = RowState::extra;
      row.reason = "the reference has no such picture";
      if (options_.accept) accept(read_any_picture(test(row), options_.limits.expansion), row);
      return;
    }
    if (options_.accept) {
      // A reference that is damaged is replaced too; a test picture that is damaged never replaces one.
      const PictureFile picture = read_any_picture(test(row), options_.limits.expansion);
      try {
        compare_pair(row);
      } catch (const compare::MaskError&) {
        throw;  // it says nothing of the reference
      } catch (const Error& error) {
        fail(error.what(), int(error.kind()), row);
      }
      if (!passes(row)) accept(picture, row);
      return;
    }
    compare_pair(row);
  }

  /// By the first pattern that the name fits.
  ComparedPictures compared(const PictureRow& row) {
    for (size_t i = 0; i < named_.size(); ++i) {
      if (fnmatch(named_[i].pattern.c_str(), row.name.c_str(), 0) != 0) continue;
      used_.insert(i);
      return compared_pictures(reference(row), test(row), named_[i].options, masks_[i]);
    }
    return compared_pictures(reference(row), test(row), options_, mask_);
  }

  /// The map and the page that an earlier run made of the picture in a folder of -o; no file of others, and none that a
  /// link leads to.
  void remove_stale(const std::string& folder, const std::string& name) const {
    std::error_code unknown;
    const fs::path path = fs::path(folder) / name;
    if (fs::weakly_canonical(path.parent_path(), unknown) !=
        fs::weakly_canonical(folder, unknown) / fs::path(name).parent_path())
      return;
    const std::string map = path.string() + kMapEnding, page = path.string() + kPageEnding;
    if (fs::is_regular_file(fs::symlink_status(map, unknown)) && is_difference_map(map)) fs::remove(map, unknown);
    if (pages_ && fs::is_regular_file(fs::symlink_status(page, unknown)) && is_comparison_page(page))
      fs::remove(page, unknown);
  }

  void compare_pair(PictureRow& row) {
    const ComparedPictures pictures = compared(row);
    const compare::Comparison& c = pictures.comparison;
    row.state = pictures.judged.validation && trueshade::passes(pictures) ? RowState::within : state_of(c.outcome);
    row.reason = verdict_line(pictures);
    if (!passes(row)) row.details = comparison_text(pictures);
    if (!passes(row) && options_.json) row.json = comparison_json(pictures);
    if (!passes(row) && c.worst)
      row.reason +=
          "; worst at " + std::to_string(c.worst->x) + ',' + std::to_string(c.worst->y) + values_text(*c.worst);
    row.unequal_pixels = c.differences.unequal_pixels, row.pixels = c.differences.pixels;
    row.left_out_pixels = c.differences.left_out;
    for (const compare::ChannelDifferences& channel : c.differences.channels)
      row.largest = std::max(row.largest, channel.largest);
    if (c.flip) row.flip_mean = c.flip->mean;
    for (const std::string& folder : options_.outputs) {
      const std::string path = (fs::path(folder) / row.name).string();
      if (passes(row)) continue;
      if (c.flip) write_differences(pictures, path + kMapEnding);
      if (pages_) write_text(path + kPageEnding, comparison_page(pictures, command_of(row)));
    }
  }

  /// The command that makes the picture's page.
  std::string command_of(const PictureRow& row) const {
    return "trueshade compare " + for_shell(reference(row)) + ' ' + for_shell(test(row)) + " -o page.html";
  }

  void accept(const PictureFile& picture, PictureRow& row) const {
    row.not_accepted = why_not_acceptable(picture, options_.rules.allow_not_finite);
    if (!row.not_accepted.empty()) return;
    accept_picture(test(row), reference(row), options_.reference);
    row.is_accepted = true;
  }

  const CompareOptions& options_;
  const bool pages_;
  const std::optional<PictureFile> mask_;
  const std::vector<NamedCriteria> named_;
  std::vector<std::optional<PictureFile>> masks_;  // of named_
  std::set<size_t> used_;                          // places in named_
};

}  // namespace

bool passes(const PictureRow& row) {
  return row.state == RowState::same || row.state == RowState::within || row.is_accepted;
}

size_t FolderComparison::failures() const {
  return size_t(std::count_if(rows.begin(), rows.end(), [](const PictureRow& row) { return !passes(row); }));
}

int FolderComparison::exit_code() const {
  for (const PictureRow& row : rows)
    if (!passes(row) && row.exit_code != 0) return row.exit_code;
  return failures() > 0 ? 1 : 0;
}

std::set<std::string> pictures_in(const std::string& folder, std::set<std::string>& passed_over) {
  std::set<std::string> names;
  std::error_code failed;
  std::set<fs::path> visited;  // links may lead back
  fs::recursive_directory_iterator entry(folder, fs::directory_options::follow_directory_symlink, failed);
  for (const fs::recursive_directory_iterator end; !failed && entry != end; entry.increment(failed)) {
    std::error_code unknown;
    if (entry->is_directory(unknown)) {
      if (!visited.insert(fs::canonical(entry->path(), unknown)).second) entry.disable_recursion_pending();
      continue;
    }
    if (has_picture_ending(entry->path()))
      names.insert(entry->path().lexically_relative(folder).generic_string());
    else
      passed_over.insert(entry->path().string());
  }
  if (failed)
    throw Error(ErrorKind::io, folder, "cannot list it: " + failed.message(),
                failed == std::errc::no_such_file_or_directory ? "check the name" : "check the rights");
  return names;
}

FolderComparison compared_folders(const CompareOptions& options, bool pages, const std::function<void(int, int)>& see) {
  FolderComparison folders{options.reference, options.test, {}, {}, {}};
  std::error_code unknown;
  const bool is_first = options.accept && !fs::exists(options.reference, unknown);  // it becomes a folder
  const std::set<std::string> of_reference = is_first ? std::set<std::string>()
                                                      : pictures_in(options.reference, folders.passed_over),
                              of_test = pictures_in(options.test, folders.passed_over);
  note_listed(options.reference, of_reference);
  note_listed(options.test, of_test);
  std::set<std::string> names = of_reference;
  names.insert(of_test.begin(), of_test.end());
  if (names.empty())
    throw Error(ErrorKind::bad_input, options.reference, "there is no picture in it, nor in " + options.test,
                "name folders with .exr, .png, .hdr, .tif, .dds, .npy or .jpg in them");
  FolderComparer comparer(options, pages);
  for (const std::string& name : names) {
    folders.rows.push_back(comparer.compare(name, of_reference.contains(name), of_test.contains(name)));
    see(int(folders.rows.size()), int(names.size()));
  }
  folders.unused = comparer.unused();
  std::stable_sort(folders.rows.begin(), folders.rows.end(), [](const PictureRow& a, const PictureRow& b) {
    return std::pair(a.state, a.largest) > std::pair(b.state, b.largest);
  });
  return folders;
}

}  // namespace trueshade
