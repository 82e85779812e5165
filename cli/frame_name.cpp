#include "cli/frame_name.h"

#include <algorithm>

namespace trueshade {
namespace {

struct Place {
  size_t begin, end;  ///< of the text to replace
  size_t digits;
};

std::string padded(int frame, size_t digits) {
  const std::string number = std::to_string(frame);
  return std::string(digits - std::min(digits, number.size()), '0') + number;
}

/// Of `%d` or `%0Nd`; nothing there: begin is npos.
Place percent_place(const std::string& path, size_t from) {
  for (size_t begin = path.find('%', from); begin != std::string::npos; begin = path.find('%', begin + 1)) {
    const std::string_view rest = std::string_view(path).substr(begin + 1);
    if (rest.starts_with("d")) return {begin, begin + 2, 1};
    if (rest.size() >= 3 && rest[0] == '0' && rest[1] >= '1' && rest[1] <= '9' && rest[2] == 'd')
      return {begin, begin + 4, size_t(rest[1] - '0')};
  }
  return {std::string::npos, 0, 0};
}

}  // namespace

std::string frame_name(const std::string& path, int frame) {
  const size_t name = path.rfind('/') + 1;  // npos + 1 is 0
  Place place = percent_place(path, name);
  if (const size_t hash = path.find('#', name); place.begin == std::string::npos && hash != std::string::npos) {
    const size_t end = std::min(path.find_first_not_of('#', hash), path.size());
    place = {hash, end, end - hash};
  }
  if (place.begin != std::string::npos)
    return path.substr(0, place.begin) + padded(frame, place.digits) + path.substr(place.end);
  const size_t dot = path.rfind('.');
  return path.substr(0, dot) + '.' + padded(frame, 4) + path.substr(dot);
}

}  // namespace trueshade
