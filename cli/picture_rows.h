#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "cli/compared_pictures.h"

namespace trueshade {

/// What became of one name in two folders. The worst come last.
enum class RowState : uint8_t { same, within, different, mismatched, missing, extra, unreadable };

/// A name in two folders, compared.
struct PictureRow {
  std::string name;  ///< relative to both folders
  RowState state = RowState::same;
  std::string reason;   ///< verdict_line(), or why there is none
  std::string details;  ///< comparison_text() of pictures that do not pass: first and worst pixel, what it looks like
  std::string json;     ///< comparison_json() of the same, where JSON is asked for
  uint64_t unequal_pixels = 0, pixels = 0, left_out_pixels = 0;
  double largest = 0.0;  ///< difference in any channel
  std::optional<double> flip_mean;
  int exit_code = 0;     ///< of a picture that cannot be read
  double seconds = 0.0;  ///< wall time
  bool is_accepted = false;
  std::string not_accepted;  ///< why --accept left the reference as it is
};

bool passes(const PictureRow& row);

/// Two folders, compared.
struct FolderComparison {
  std::string reference, test;
  std::vector<PictureRow> rows;  ///< the worst first, then by name
  std::set<std::string> passed_over;  ///< paths of files of both whose names do not end as a picture's
  std::vector<std::string> unused;    ///< patterns of --criteria by which no picture was compared

  size_t failures() const;
  int exit_code() const;  ///< 0, 1, or that of the first picture that cannot be read
};

/// Relative names of the pictures in a folder and in those within; links to folders are not followed. Adds the paths
/// of files whose names do not end as a picture's to `passed_over`. Error(io): a folder that cannot be listed.
std::set<std::string> pictures_in(const std::string& folder, std::set<std::string>& passed_over);

/// A line of the file of --criteria.
struct NamedCriteria {
  std::string pattern;     ///< as a shell has them; * is any text, slashes too
  CompareOptions options;  ///< the command's, with the line's criteria, and its mask if it has one, in their place
};

/// The lines of the command's --criteria; none without it. Error(bad_input) naming the line that means nothing.
std::vector<NamedCriteria> named_criteria(const CompareOptions& options);

/// Compares pictures of equal relative names, folders within folders too. Accepts, and writes maps of differences, and
/// with `pages` comparison_page()s, into the folders of -o, as the options say. `see` is told how many of how many are
/// done. Error(bad_input): no picture in either. Error(io): a folder that cannot be listed, a file that cannot be
/// written.
FolderComparison compared_folders(const CompareOptions& options, bool pages, const std::function<void(int, int)>& see);

/// A line that says how it went, and a table.
std::string rows_text(const FolderComparison& folders);
std::string rows_json(const FolderComparison& folders);
/// `2 of 3 pictures do not pass, 1 accepted`.
std::string verdict_of_rows(const FolderComparison& folders);

/// A page of HTML that needs no other file: a gallery, the worst first. It reads the pictures again.
///   gallery: the page's own name, from whose folder links to what stands in the folders of -o begin
std::string gallery_page(const FolderComparison& folders, const CompareOptions& options, const std::string& gallery);

/// `DIFFERENT`, ...; `different`, ...
std::string_view name_of(RowState state);

}  // namespace trueshade
