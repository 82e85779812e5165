#include "scenes/files/light_buffers.h"

#include <algorithm>
#include <charconv>

#include "core/error.h"
#include "scenes/scene_limits.h"

namespace trueshade {
namespace {

constexpr std::string_view kSeparators = ",;\t ";

void check_count(uint64_t count, const std::string& where, uint64_t most) {
  if (count > most)
    throw Error(ErrorKind::limit, where, "the lights are over the limit", within_limit(most, "more", "--max-lights"));
}

/// The fields of a line: empty ones only between separators that are no blanks.
std::vector<std::string_view> fields_of(std::string_view line) {
  std::vector<std::string_view> fields;
  const auto blank = [](char c) { return c == ' ' || c == '\t'; };
  size_t at = 0;
  while (true) {
    while (at < line.size() && blank(line[at])) ++at;
    const size_t end = std::min(line.find_first_of(kSeparators, at), line.size());
    if (at == line.size() && (fields.empty() || line.find_last_of(",;") == std::string_view::npos)) return fields;
    fields.push_back(line.substr(at, end - at));
    at = end;
    while (at < line.size() && blank(line[at])) ++at;
    if (at == line.size()) return fields;
    if (line[at] == ',' || line[at] == ';') ++at;
  }
}

bool is_number(std::string_view text, float& value) {
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  return code == std::errc() && end == text.data() + text.size() && value - value == 0.0f;  // finite
}

/// What a field is, for an error: short, and on one line.
std::string shown(std::string_view field) {
  std::string text = "'" + std::string(field.substr(0, 40)) + "'";
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  return text;
}

}  // namespace

std::vector<glm::vec3> samples_from_csv(std::string_view text, const std::string& where, uint64_t most) {
  std::vector<glm::vec3> samples;
  size_t number = 0;
  for (size_t at = 0; at < text.size();) {
    const size_t end = std::min(text.find('\n', at), text.size());
    std::string_view line = text.substr(at, end - at);
    at = end + 1;
    ++number;
    if (line.ends_with('\r')) line.remove_suffix(1);
    const std::vector<std::string_view> fields = fields_of(line);
    if (fields.empty()) continue;
    const auto fail = [&](const std::string& reason) {
      throw Error(ErrorKind::bad_input, where + ": line " + std::to_string(number), reason, "three numbers a line");
    };
    glm::vec3 sample(0.0f);
    float ignored;
    if (samples.empty() && number == 1 &&
        std::none_of(fields.begin(), fields.end(), [&](std::string_view f) { return is_number(f, ignored); }))
      continue;  // the columns' names
    if (fields.size() != 3) fail("found " + std::to_string(fields.size()) + " values");
    for (int k = 0; k < 3; ++k)
      if (!is_number(fields[size_t(k)], sample[k])) fail("found " + shown(fields[size_t(k)]));
    samples.push_back(sample);
    check_count(samples.size(), where, most);
  }
  return samples;
}

std::vector<glm::vec3> samples_from_image(const Image& image, const std::string& where, uint64_t most) {
  if (image.format == Format::rgba8)
    throw Error(ErrorKind::bad_input, where, "a buffer of lights needs more than 8 bits a channel", "an EXR");
  check_count(uint64_t(image.width) * uint64_t(image.height), where, most);
  std::vector<glm::vec3> samples;
  samples.reserve(size_t(image.width) * size_t(image.height));
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      samples.emplace_back(float(image.value(x, y, 0)), float(image.value(x, y, 1)), float(image.value(x, y, 2)));
  return samples;
}

}  // namespace trueshade
