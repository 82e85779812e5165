#pragma once
#include <cstdint>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

// What files this process reads and writes, told to the process that started it (`trueshade batch`). Whoever opens a
// file that a user or a scene names calls one of these; they do nothing until note_files_to() is called.
namespace trueshade {

/// From now on every note is a line on the descriptor: `{"read": PATH, "sha256": HASH}`, and the same with `listed` and
/// `wrote`. HASH is that of the bytes that were really read or written, or one of the words below.
void note_files_to(int descriptor);

inline constexpr std::string_view kAbsent = "absent";  ///< of a file that could not be opened
inline constexpr std::string_view kThere = "there";    ///< of a file that was opened, and not read

void note_read(const std::string& path, std::span<const uint8_t> content);
void note_read(const std::string& path, std::string_view word);  ///< kAbsent or kThere
/// Names of files that were found in a folder, whatever they are: the folder's hash_of_names().
void note_listed(const std::string& folder, const std::set<std::string>& names);
/// The same of files whose content is on disk: it is read for that, if anybody listens.
void note_read_from_disk(const std::string& path);
void note_written_to_disk(const std::string& path);
void note_written(const std::string& path, const std::vector<std::span<const uint8_t>>& pieces);

/// SHA-256 of the names, with a zero behind each.
std::string hash_of_names(const std::set<std::string>& names);

}  // namespace trueshade
