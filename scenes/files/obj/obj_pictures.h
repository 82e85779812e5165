#pragma once
#include <map>
#include <string>
#include <tuple>

#include "scenes/files/obj/mtl_document.h"
#include "scenes/files/scene_files.h"
#include "scenes/scene.h"

namespace trueshade::obj {

/// Content of a file that an OBJ or MTL file names, below the OBJ file's folder; `where` stands in errors.
using FileReader = std::function<Bytes(const std::string& relative, uint64_t limit, const std::string& where)>;

/// The path that a name in `from`, itself relative to the scene's folder, stands for: below the folder of `from`. Names
/// are no URIs: '%' is itself, and a backslash separates folders, as in files of Windows programs, whose names of files
/// hold none. Error(bad_input) as relative_path_from_uri() has them.
std::string path_beside(const std::string& from, const std::string& name, const std::string& where);

/// The pictures of materials as textures of a scene, each with its smaller levels. The first row of a texture is the
/// bottom of its picture, where v = 0. Borrows all it is given.
class ObjPictures {
 public:
  ObjPictures(const FileReader& read, const ImageDecoder& decode, const SceneLimits& limits, Scene& scene)
      : read_(read), decode_(decode), limits_(limits), scene_(scene) {}

  /// Index of a texture. Errors: bad_input with the line of the statement, limit over limits.texture_bytes, io.
  int32_t colors(const MtlDocument& document, const MapSource& map);

  /// The same, its alpha from a second picture: that one's alpha, or its red where it has no alpha below 1. The second
  /// may be all there is.
  int32_t colors_with_alpha(const MtlDocument& document, const MapSource* map, const MapSource& alpha);

  /// Normals as they are; or, of a picture without colours (`bump` alone may name one), normals of the heights h in its
  /// red: the unit vector along (-b dx, -b dy, 1), dx = h(x + 1, y) - h(x - 1, y), dy alike, texels beyond an edge
  /// those of the other one, b the option -bm. `scaled` tells whether b was read.
  int32_t normals(const MtlDocument& document, const MapSource& map, bool may_be_heights, bool& scaled);

  /// Roughness in green, metalness in blue: each the red of its picture, 1 where there is none.
  int32_t metallic_roughness(const MtlDocument& document, const MapSource* roughness, const MapSource* metallic);

 private:
  Image decoded(const MtlDocument& document, const MapSource& map);
  int32_t add(Texture texture);
  template <typename Make>
  int32_t once(std::string key, const Make& make);

  const FileReader& read_;
  const ImageDecoder& decode_;
  const SceneLimits& limits_;
  Scene& scene_;
  uint64_t bytes_ = 0;  ///< of all textures, with their levels
  std::map<std::string, int32_t> known_;
};

}  // namespace trueshade::obj
