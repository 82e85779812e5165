#include "core/image_files/exr_channels.h"

#include <algorithm>

namespace trueshade {

std::vector<std::string> exr_channels_of(std::string_view plane, int components) {
  const std::string name(plane);
  if (name == "color") return exr_channels_of("", components);
  if (name == "depth") return {"depth.Z"};
  if (name == "position") return {"P.X", "P.Y", "P.Z"};
  if (name == "normal") return {"N.X", "N.Y", "N.Z"};
  if (name == "uv") return {"uv.X", "uv.Y"};
  if (components == 1) return {name};
  constexpr size_t kDigits = 4;
  if (const std::string light = name.starts_with("light.") ? name.substr(6) : "";
      !light.empty() && light.size() < kDigits &&
      std::all_of(light.begin(), light.end(), [](char c) { return c >= '0' && c <= '9'; }))
    return exr_channels_of("light." + std::string(kDigits - light.size(), '0') + light, components);
  std::vector<std::string> names;
  for (int channel = 0; channel < components; ++channel)
    names.push_back((name.empty() ? name : name + '.') + "RGBA"[channel]);
  return names;
}

}  // namespace trueshade
