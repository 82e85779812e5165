#pragma once
#include <string_view>

#include "core/format.h"

namespace trueshade::oracle {

/// What OpenGL and Vulkan call a format. gl/lists/api_numbers.cpp has the numbers of these names.
struct FormatWords {
  std::string_view gl;              ///< GL_RGBA8
  std::string_view channels, type;  ///< of texels that glTexImage2D and glReadPixels take: GL_RGBA, GL_UNSIGNED_BYTE
  std::string_view vulkan;          ///< VK_FORMAT_R8G8B8A8_UNORM
};

/// The row of a format.
constexpr FormatWords words_of(Format format) {
  switch (format) {
    case Format::rgba8:
      return {"GL_RGBA8", "GL_RGBA", "GL_UNSIGNED_BYTE", "VK_FORMAT_R8G8B8A8_UNORM"};
    case Format::srgb8_a8:
      return {"GL_SRGB8_ALPHA8", "GL_RGBA", "GL_UNSIGNED_BYTE", "VK_FORMAT_R8G8B8A8_SRGB"};
    case Format::rgb10_a2:
      return {"GL_RGB10_A2", "GL_RGBA", "GL_UNSIGNED_INT_2_10_10_10_REV", "VK_FORMAT_A2B10G10R10_UNORM_PACK32"};
    case Format::rgba16:
      return {"GL_RGBA16", "GL_RGBA", "GL_UNSIGNED_SHORT", "VK_FORMAT_R16G16B16A16_UNORM"};
    case Format::r11g11b10f:  // floats, which every program has; gl_format() of gl/driver reads the stored bits
      return {"GL_R11F_G11F_B10F", "GL_RGB", "GL_FLOAT", "VK_FORMAT_B10G11R11_UFLOAT_PACK32"};
    case Format::rgb16f:
      return {"GL_RGB16F", "GL_RGB", "GL_HALF_FLOAT", "VK_FORMAT_R16G16B16_SFLOAT"};
    case Format::rgba16f:
      return {"GL_RGBA16F", "GL_RGBA", "GL_HALF_FLOAT", "VK_FORMAT_R16G16B16A16_SFLOAT"};
    case Format::rgba32f:
      return {"GL_RGBA32F", "GL_RGBA", "GL_FLOAT", "VK_FORMAT_R32G32B32A32_SFLOAT"};
    case Format::rgb32f:
      return {"GL_RGB32F", "GL_RGB", "GL_FLOAT", "VK_FORMAT_R32G32B32_SFLOAT"};
    case Format::rg32f:
      return {"GL_RG32F", "GL_RG", "GL_FLOAT", "VK_FORMAT_R32G32_SFLOAT"};
    case Format::r32ui:
      return {"GL_R32UI", "GL_RED_INTEGER", "GL_UNSIGNED_INT", "VK_FORMAT_R32_UINT"};
    case Format::d32f:
      return {"GL_DEPTH_COMPONENT32F", "GL_DEPTH_COMPONENT", "GL_FLOAT", "VK_FORMAT_D32_SFLOAT"};
    case Format::d24:
      return {"GL_DEPTH_COMPONENT24", "GL_DEPTH_COMPONENT", "GL_UNSIGNED_INT", "VK_FORMAT_X8_D24_UNORM_PACK32"};
    case Format::d16:
      return {"GL_DEPTH_COMPONENT16", "GL_DEPTH_COMPONENT", "GL_UNSIGNED_SHORT", "VK_FORMAT_D16_UNORM"};
  }
  return {};  // unreachable: every enumerator returns above, and -Wswitch keeps it so
}

}  // namespace trueshade::oracle
