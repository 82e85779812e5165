#pragma once
#include <memory>
#include <span>
#include <string>

namespace trueshade::oracle {

/// Which of a machine's OpenGL drivers to open. The Mesa rasterizers are chosen by name, as GALLIUM_DRIVER does; a
/// process keeps the first one it opened, so llvmpipe and softpipe need a process each.
enum class GlDriver { any, llvmpipe, softpipe };

/// How EGL gives a display without a window.
enum class GlPlatform { surfaceless, device };
inline constexpr GlPlatform kGlPlatforms[] = {GlPlatform::surfaceless, GlPlatform::device};

/// What a driver says of itself.
struct GlInfo {
  std::string vendor, renderer, version;
  int major = 0, minor = 0;
  int subpixel_bits = 0;     ///< GL_SUBPIXEL_BITS: a lower bound of the grid, not the grid (docs/gl_rules.md section 1)
  int max_texture_size = 0;  ///< pixels a side
  GlPlatform platform = GlPlatform::surfaceless;

  std::string line() const { return vendor + ", " + renderer + ", OpenGL " + version; }
};

/// An OpenGL core context without a window: EGL's surfaceless platform, else the first EGL device that works.
/// GL 4.5 where the driver has it, lower down to 3.3. One thread uses a context at a time.
class GlContext {
 public:
  /// Throws Error(no_gl_driver) that says what was tried. LIBGL_ALWAYS_SOFTWARE is the driver's own to read.
  ///   platforms: tried in that order, each of their displays until one gives a context
  explicit GlContext(GlDriver driver = GlDriver::any, std::span<const GlPlatform> platforms = kGlPlatforms);
  ~GlContext();
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;

  void make_current() const;  ///< on the calling thread
  const GlInfo& info() const { return info_; }
  bool has(const char* extension) const;  ///< "GL_ARB_clip_control"; the context must be current

 private:
  struct Handles;
  std::unique_ptr<Handles> handles_;
  GlInfo info_;
};

}  // namespace trueshade::oracle
