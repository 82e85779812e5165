#include "cli/accepting.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>
#include <vector>

#include "cli/notes.h"
#include "core/error.h"
#include "core/image_files/image_io.h"

namespace trueshade {

namespace {

namespace fs = std::filesystem;

void check_leads_nowhere_else(const std::string& reference, const std::string& within) {
  std::error_code unknown;
  const fs::path parent = fs::path(reference).parent_path(),
                 way = within.empty() ? fs::path()
                                      : fs::weakly_canonical(parent, unknown)
                                            .lexically_relative(fs::weakly_canonical(within, unknown));
  const bool leads_out = !within.empty() && (way.empty() || *way.begin() == "..");
  if (leads_out || fs::is_symlink(fs::symlink_status(reference, unknown)))
    throw Error(ErrorKind::bad_input, reference, "a link leads elsewhere, and no picture is accepted through a link",
                "replace the link by a file or a folder");
}

}  // namespace

void accept_picture(const std::string& test, const std::string& reference, const std::string& within) {
  check_leads_nowhere_else(reference, within);
  std::ifstream file(test, std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (!file) throw Error(ErrorKind::io, test, "cannot read it again", "try again");
  const fs::path folder = fs::path(reference).parent_path();
  std::error_code failed;
  if (!folder.empty()) fs::create_directories(folder, failed);
  if (failed) throw Error(ErrorKind::io, folder.string(), "cannot make it: " + failed.message(), "check the rights");
  write_file(reference, std::span(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()));
}

std::string why_not_acceptable(const PictureFile& picture, bool allow_not_finite) {
  if (is_lenient(picture.metadata)) return "it was drawn with --lenient of a file with faults, so it is no reference";
  if (allow_not_finite) return {};
  for (const ChannelFile& part : picture.parts)
    for (const Channel& channel : part.channels) {
      if (channel.kind != ChannelKind::floating) continue;
      for (size_t i = 0; i < channel.words.size(); ++i)
        if (!std::isfinite(channel.value(i)))
          return "channel " + channel.name + " is not finite at " + std::to_string(i % size_t(part.width)) + ',' +
                 std::to_string(i / size_t(part.width)) + ", and a reference has to be";
    }
  return {};
}

}  // namespace trueshade
