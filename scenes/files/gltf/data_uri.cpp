#include "scenes/files/gltf/data_uri.h"

#include <algorithm>

#include "core/error.h"
#include "scenes/scene_limits.h"

namespace trueshade::gltf {
namespace {

constexpr std::string_view kScheme = "data:", kBase64 = ";base64";

/// Words of URIs are the same in capitals.
bool is_word(std::string_view text, std::string_view small_letters) {
  return std::equal(text.begin(), text.end(), small_letters.begin(), small_letters.end(),
                    [](char c, char small) { return (c >= 'A' && c <= 'Z' ? char(c + 32) : c) == small; });
}

int digit_of(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '+' ? 62 : c == '/' ? 63 : -1;
}

[[noreturn]] void refuse(const std::string& where, const std::string& reason) {
  throw Error(ErrorKind::bad_input, where, reason, "data:TYPE;base64, and base64 with its padding");
}

Bytes decoded(std::string_view text, const std::string& where, uint64_t limit) {
  if (text.size() % 4 != 0) refuse(where, "the length of the base64 is no multiple of 4");
  if (text.size() / 4 * 3 > limit)
    throw Error(ErrorKind::limit, where, "the data are over the limit",
                within_limit(limit, "bytes", "--max-file or --max-buffer-memory"));
  const size_t padding = text.ends_with("==") ? 2 : text.ends_with('=') ? 1 : 0;
  Bytes bytes;
  bytes.reserve(text.size() / 4 * 3);
  for (size_t i = 0; i < text.size(); i += 4) {
    const bool last = i + 4 == text.size();
    uint32_t group = 0;
    for (size_t k = 0; k < 4; ++k) {
      const bool padded = last && k >= 4 - padding;
      const int digit = padded ? 0 : digit_of(text[i + k]);
      if (digit < 0) refuse(where, "the base64 has a wrong character at " + std::to_string(i + k));
      group = group << 6 | uint32_t(digit);
    }
    const size_t count = last ? 3 - padding : 3;
    for (size_t k = 0; k < count; ++k) bytes.push_back(uint8_t(group >> (16 - 8 * k)));
  }
  return bytes;
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

Bytes percent_decoded(std::string_view text, const std::string& where, uint64_t limit) {
  if (text.size() > limit)
    throw Error(ErrorKind::limit, where, "the data are over the limit",
                within_limit(limit, "bytes", "--max-file or --max-buffer-memory"));
  Bytes bytes;
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      if (text[i] <= ' ' || text[i] > '~') refuse(where, "the data URI has a character that no URI has");
      bytes.push_back(uint8_t(text[i]));
      continue;
    }
    const int high = i + 2 < text.size() ? hex_digit(text[i + 1]) : -1,
              low = i + 2 < text.size() ? hex_digit(text[i + 2]) : -1;
    if (high < 0 || low < 0) refuse(where, "the data URI has a % without two hexadecimal digits");
    bytes.push_back(uint8_t(high * 16 + low));
    i += 2;
  }
  return bytes;
}

}  // namespace

bool is_data_uri(std::string_view uri) { return is_word(uri.substr(0, kScheme.size()), kScheme); }

std::string_view media_type_of_uri(std::string_view uri) {
  if (!is_data_uri(uri)) return {};
  const std::string_view rest = uri.substr(kScheme.size());
  return rest.substr(0, rest.find_first_of(";,"));
}

DataUri data_of_uri(std::string_view uri, const std::string& where, uint64_t limit) {
  const size_t comma = uri.find(',');
  if (comma == std::string_view::npos) refuse(where, "the data URI has no comma");
  std::string_view head = uri.substr(kScheme.size(), comma - kScheme.size());
  const std::string type(head.substr(0, head.find(';')));
  const std::string_view text = uri.substr(comma + 1);
  const bool base64 = head.size() >= kBase64.size() && is_word(head.substr(head.size() - kBase64.size()), kBase64);
  return {type, base64 ? decoded(text, where, limit) : percent_decoded(text, where, limit)};
}

}  // namespace trueshade::gltf
