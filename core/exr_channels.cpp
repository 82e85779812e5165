#include "core/exr_channels.h"

namespace trueshade {

std::vector<std::string> exr_channels_of(std::string_view plane, int components) {
  const std::string name(plane);
  if (name == "color") return exr_channels_of("", components);
  if (name == "depth") return {"depth.Z"};
  if (name == "position") return {"P.X", "P.Y", "P.Z"};
  if (name == "normal") return {"N.X", "N.Y", "N.Z"};
  if (name == "uv") return {"uv.X", "uv.Y"};
  if (components == 1) return {name};
  std::vector<std::string> names;
  for (int channel = 0; channel < components; ++channel)
    names.push_back((name.empty() ? name : name + '.') + "RGBA"[channel]);
  return names;
}

}  // namespace trueshade
