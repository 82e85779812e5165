#pragma once
#include <memory>
#include <span>
#include <string>

namespace trueshade::oracle {

/// Which of a machine's OpenGL drivers to open. The Mesa rasterizers are chosen by name, as GALLIUM_DRIVER does. A
/// process keeps the first one that it opened, so llvmpipe and softpipe need a process each.
enum class GlDriver { any, llvmpipe, softpipe };

/// How EGL opens a display that has no window.
enum class GlPlatform { surfaceless, device };
inline constexpr GlPlatform kGlPlatforms[] = {GlPlatform::surfaceless, GlPlatform::device};

/// How a driver describes itself.
struct GlInfo {
  std::string vendor, renderer, version;
  int major = 0, minor = 0;
  int subpixel_bits = 0;     ///< GL_SUBPIXEL_BITS: a lower bound of the grid, not the grid (docs/gl_rules.md section 1)
  int max_texture_size = 0;  ///< pixels a side
  GlPlatform platform = GlPlatform::surfaceless;

  std::string line() const { return vendor + ", " + renderer + ", OpenGL " + version; }
};

/// An OpenGL core context without a window, of EGL's surfaceless platform or else of the first EGL device that works:
/// of GL 4.5 where the driver has it, otherwise of a version down to 3.3. Only one thread at a time may use it.
class GlContext {
 public:
  /// Opens the context. Error(no_gl_driver), which says what was tried, where there is none. The driver itself reads
  /// LIBGL_ALWAYS_SOFTWARE.
  ///   platforms: tried in this order, each of their displays until one gives a context
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
