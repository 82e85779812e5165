#pragma once
#include <map>
#include <string>

#include "scenes/baked_uv.h"
#include "scenes/builtin/texture_pattern.h"
#include "scenes/files/content/faults.h"
#include "scenes/files/content/scene_files.h"
#include "scenes/json/json_value.h"
#include "scenes/material_fields.h"
#include "scenes/scene.h"

namespace trueshade {

/// The keys of the objects that texture and material texts are made of.
inline constexpr std::string_view kTextureKeys[] = {"name", "file", "levels", "encoding", "origin", "pattern"};
inline constexpr std::string_view kPatternKeys[] = {"type", "size", "format", "colors", "cells", "seed"};
inline constexpr std::string_view kMapKeys[] = {"texture", "wrap",     "mag",       "min",
                                                "mip",     "lod_bias", "lod_min",   "lod_max",
                                                "border",  "uv_set",   "uv_offset", "uv_rotation_deg",
                                                "uv_scale"};
inline constexpr auto kMaterialKeys = [] {
  std::array<std::string_view, 1 + std::size(kMaterialFields) + kMaterialMaps> keys{"name"};
  auto key = keys.begin();
  for (const MaterialField& field : kMaterialFields) *++key = field.key;
  for (const std::string_view map : kMaterialMapKeys) *++key = map;
  return keys;
}();

/// Reads a scene text's textures and materials into a scene. Borrows all it is given.
class MaterialReader {
 public:
  MaterialReader(Scene& scene, const std::string& path, const SceneFolder& folder, const SceneLimits& limits,
                 const ImageDecoder& decode)
      : scene_(scene), path_(path), folder_(folder), limits_(limits), decode_(decode), faults_(limits.leniency) {}

  void read_textures(const json::Node& list);
  /// `uv`: receives what the maps read, which is left to bake_uv().
  Material read_material(const json::Node& node, UvSources& uv) const;

  /// Builds the levels that lookups between levels need and no file gave. After the last material.
  void complete_mip_chains(const json::Node& materials);
  /// Computes the texels of patterns: not before the bytes of all that is read have been counted, as they may take
  /// long.
  void make_patterns();

  /// Takes out what could not be read, where this is passed over, and says so. Last.
  void lose_pictures();

  /// Counts bytes of textures. Error(limit) naming `node` before memory for them is taken. `when`: whether it is taken
  /// now.
  enum class When : uint8_t { now, later };
  void take(uint64_t bytes, const json::Node& node, When when = When::now);
  void count(uint64_t bytes) { bytes_ += bytes; }  ///< of textures that others have read within what was left
  uint64_t bytes() const { return bytes_; }

 private:
  Texture read_texture(const json::Node& node);
  void read_or_lose_file(const json::Node& file, bool upper_left, const std::string& encoding, Texture& texture);
  TextureLevel read_level(const json::Node& file, bool upper_left, TextureFormat& format, bool& has_format,
                          const std::string& encoding);
  TextureSlot read_map(const json::Node& node, UvSource& uv) const;

  Scene& scene_;
  const std::string& path_;
  const SceneFolder& folder_;
  const SceneLimits& limits_;
  const ImageDecoder& decode_;
  Faults faults_;
  std::vector<bool> lost_;                                   ///< of the scene's textures
  uint64_t bytes_ = 0;                                       ///< of all levels
  uint64_t awaited_ = 0;                                     ///< of those that are not made yet
  std::vector<std::pair<size_t, TexturePattern>> patterns_;  ///< of textures of the scene; not made yet
  std::map<std::string, int32_t, std::less<>> named_;
};

}  // namespace trueshade
