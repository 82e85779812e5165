#pragma once
#include <functional>
#include <map>
#include <span>
#include <string>
#include <tuple>

#include "scenes/files/content/faults.h"
#include "scenes/files/content/scene_files.h"
#include "scenes/files/obj/mtl_document.h"
#include "scenes/scene.h"

namespace trueshade::obj {

/// Content of a file that an OBJ or MTL file names, below the OBJ file's folder; `where` stands in errors.
using FileReader = std::function<Bytes(const std::string& relative, uint64_t limit, const std::string& where)>;

/// The path that a name in `from`, itself a path from the scene's folder, stands for: from the folder of `from`. Names
/// are no URIs: '%' is itself, and a backslash separates folders, as in files of Windows programs, whose names of files
/// hold none. Error(bad_input) as path_from_uri() has them.
std::string path_beside(const std::string& from, const std::string& name, const std::string& where, NamedPaths paths);

/// A picture that a material will ask for.
struct WantedPicture {
  const MtlDocument* document;
  const MapSource* map;
};

/// The pictures of materials as textures of a scene, each with its smaller levels. The first row of a texture is the
/// bottom of its picture, where v = 0. Borrows all it is given.
class ObjPictures {
 public:
  ObjPictures(const FileReader& read, const ImageDecoder& decode, const SceneLimits& limits, Faults& faults,
              Scene& scene)
      : read_(read), decode_(decode), limits_(limits), faults_(faults), scene_(scene) {}

  /// The texture that one of the functions below makes, called by `make`; below 0 where the picture that `map` names,
  /// or one beside it, cannot be read, and this is passed over.
  template <class Make>
  int32_t unless_lost(const MapSource& map, const Make& make) {
    try {
      return make();
    } catch (const Error& error) {
      faults_.pass(Fault::picture, map.file, error);
      return -1;
    }
  }

  /// Reads pictures and decodes them by all cores, of which one does `meanwhile`, for the functions below. What fails
  /// is left to them to try again, so that the error is that of the first picture in the order of use, however many
  /// cores there are. Throws what `meanwhile` throws; no picture is begun after that.
  void decode_ahead(std::span<const WantedPicture> wanted, const std::function<void()>& meanwhile);

  /// Index of a texture, which has its first level alone before build_levels(). Errors: bad_input with the line of the
  /// statement, limit over limits.texture_bytes, io.
  int32_t colors(const MtlDocument& document, const MapSource& map);

  /// The same, its alpha from a second picture: that one's alpha, or its red where it has no alpha below 1. The second
  /// may be all there is. Where the first is lost and this is passed over, its colours are grey.
  int32_t colors_with_alpha(const MtlDocument& document, const MapSource* map, const MapSource& alpha);

  /// Normals as they are; or, of a picture without colours (`bump` alone may name one), normals of the heights h in its
  /// red: the unit vector along (-b dx, -b dy, 1), dx = h(x + 1, y) - h(x - 1, y), dy alike, texels beyond an edge
  /// those of the other one, b the option -bm. `scaled` tells whether b was read.
  int32_t normals(const MtlDocument& document, const MapSource& map, bool may_be_heights, bool& scaled);

  /// Roughness in green, metalness in blue: each the red of its picture, 1 where there is none.
  int32_t metallic_roughness(const MtlDocument& document, const MapSource* roughness, const MapSource* metallic);

  /// The smaller levels of all textures, by all cores. Once, last.
  void build_levels();

 private:
  struct Task;

  std::string key_of(const MtlDocument& document, const MapSource& map) const;
  void decode_some(std::span<Task> tasks, uint64_t share, const std::function<void()>& meanwhile) const;
  Image decoded(const MtlDocument& document, const MapSource& map);
  int32_t add(Texture texture, const std::string& where);
  template <typename Make>
  int32_t once(const std::string& where, std::string key, const Make& make);

  const FileReader& read_;
  const ImageDecoder& decode_;
  const SceneLimits& limits_;
  Faults& faults_;
  Scene& scene_;
  uint64_t bytes_ = 0;  ///< of all textures, with their levels
  std::map<std::string, int32_t> known_;
  std::map<std::string, Image> ahead_;  ///< decoded before they are asked for, by path
};

}  // namespace trueshade::obj
