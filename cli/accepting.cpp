#include "cli/accepting.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>
#include <vector>

#include "core/error.h"
#include "core/image_files/image_io.h"

namespace trueshade {

void accept_picture(const std::string& test, const std::string& reference) {
  std::ifstream file(test, std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (!file) throw Error(ErrorKind::io, test, "cannot read it again", "try again");
  const std::filesystem::path folder = std::filesystem::path(reference).parent_path();
  std::error_code failed;
  if (!folder.empty()) std::filesystem::create_directories(folder, failed);
  if (failed) throw Error(ErrorKind::io, folder.string(), "cannot make it: " + failed.message(), "check the rights");
  write_file(reference, std::span(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()));
}

std::string why_not_acceptable(const PictureFile& picture, bool allow_not_finite) {
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
