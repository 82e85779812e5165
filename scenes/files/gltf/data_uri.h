#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "scenes/files/content/scene_files.h"

namespace trueshade::gltf {

struct DataUri {
  std::string media_type;  ///< without parameters, such as `image/png`
  Bytes bytes;
};

bool is_data_uri(std::string_view uri);

/// DataUri::media_type; empty of what is no data URI.
std::string_view media_type_of_uri(std::string_view uri);

/// Content of a `data:` URI (RFC 2397): in base64 (RFC 4648, with padding and nothing else), or percent-encoded.
/// Error(bad_input) behind `where`; Error(limit) over `limit` bytes.
DataUri data_of_uri(std::string_view uri, const std::string& where, uint64_t limit);

}  // namespace trueshade::gltf
