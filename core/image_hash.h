#pragma once
#include <span>
#include <string>
#include <string_view>

#include "core/image.h"
#include "core/sha256.h"

namespace trueshade {

/// image_hash() of a picture whose rows come some at a time, from the top.
class ImageHash {
 public:
  void add(const Image& rows) { add(rows.format, rows.texels); }  ///< of one format
  void add(Format format, std::span<const uint8_t> texels);
  std::string hex();  ///< call once, last
  std::string progress() const { return hash_.progress(); }
  bool resume(std::string_view progress) { return hash_.resume(progress); }

 private:
  Sha256 hash_;
};

}  // namespace trueshade
