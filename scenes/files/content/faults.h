#pragma once
#include <array>
#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "scenes/scene.h"

// Faults of a file that harm its looks alone: an error, unless the user asks to see the file all the same.
namespace trueshade {

enum class Fault : uint8_t {
  picture,      ///< missing, or broken
  library,      ///< of materials: the same
  extension,    ///< required, and not implemented: what it changes is drawn as without it
  alignment,    ///< of numbers that lie where glTF has none
  stride,       ///< of a view, that glTF does not allow
  root,         ///< a node of a scene that has a parent, or is named twice
  coordinates,  ///< a material's maps have none in the mesh
  statement,    ///< of OBJ or MTL: unknown, or of wrong words
  value,        ///< of another kind than the format has
};
inline constexpr size_t kFaults = 9;

/// What is passed over of a file.
class Faults {
 public:
  explicit Faults(Leniency leniency) : leniency_(leniency) {}

  /// Whether faults are passed over.
  bool passed() const { return leniency_ == Leniency::asked; }

  /// The remedy of an error that is passed over if the user asks, with the option where there is one.
  std::string remedy(std::string_view remedy) const;

  /// Throws Error(bad_input), or notes that it is passed over.
  void pass(Fault fault, const std::string& where, std::string_view reason, std::string_view remedy);

  /// The same of an error that another function has thrown, which is passed over where a file's content or absence is
  /// the reason: a limit never is. Faults of one `key` count once.
  void pass(Fault fault, const std::string& key, const Error& error);

  /// Adds to Scene::passed_over, and to its notes.
  void tell(Scene& scene) const;

 private:
  struct Found {
    std::set<std::string> keys;
    std::vector<std::string> first;  ///< where a few of them are, and why, in their order
    bool any_untrusted = false;      ///< whether kTrustRemedy is the remedy of one
  };
  void add(Fault fault, const std::string& key, std::string_view text);

  Leniency leniency_;
  std::array<Found, kFaults> found_{};
};

/// Adds what was passed over of a file to the scene that names the file, and to the scene's notes.
void tell_passed_over(const std::vector<std::string>& lines, Scene& scene);

/// What a picture's file says of faults of its scene's file that --lenient has passed over: it is no reference.
inline constexpr const char* kLenientKey = "trueshade:lenient";
/// Of a scene, what stands there; empty where nothing was passed over.
std::string lenient_text(const Scene& scene);

/// Makes of a material what is drawn where a map of it cannot be read: half of its colour, of its specular colour, of
/// its roughness and its metalness; no light of its own; and as without a normal or an occlusion map.
void lose_map(Material& material, TextureSlot Material::*map);

/// Takes textures out of a scene, by lose_map() of all that read them. `lost`: one a texture.
void lose_textures(Scene& scene, const std::vector<bool>& lost);

}  // namespace trueshade
