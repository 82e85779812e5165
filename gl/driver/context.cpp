#include "gl/driver/context.h"

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <array>
#include <cstdlib>
#include <optional>
#include <vector>

#include "core/error.h"
#include "core/threads/startable_threads.h"

namespace trueshade::oracle {

struct GlContext::Handles {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;
};

namespace {

/// An environment variable for the length of a scope: Mesa reads which rasterizer to load from there alone.
class ScopedVariable {
 public:
  ScopedVariable(const char* name, const char* value) : name_(name) {
    if (value == nullptr) return;
    if (const char* before = std::getenv(name)) before_ = before;
    setenv(name, value, 1);
    set_ = true;
  }
  ~ScopedVariable() {
    if (!set_) return;
    if (before_)
      setenv(name_, before_->c_str(), 1);
    else
      unsetenv(name_);
  }
  ScopedVariable(const ScopedVariable&) = delete;
  ScopedVariable& operator=(const ScopedVariable&) = delete;

 private:
  const char* name_;
  std::optional<std::string> before_;
  bool set_ = false;
};

const char* gallium_name(GlDriver driver) {
  switch (driver) {
    case GlDriver::llvmpipe:
      return "llvmpipe";
    case GlDriver::softpipe:
      return "softpipe";
    case GlDriver::any:
      break;
  }
  return nullptr;
}

/// No window system at all.
std::vector<EGLDisplay> surfaceless_displays() {
  if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless")) return {};
  return {eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr)};
}

/// Each device that EGL lists.
std::vector<EGLDisplay> device_displays() {
  std::vector<EGLDisplay> found;
  if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_device") ||
      !epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration"))
    return found;
  std::array<EGLDeviceEXT, 16> devices{};
  EGLint count = 0;
  if (eglQueryDevicesEXT(EGLint(devices.size()), devices.data(), &count))
    for (size_t i = 0; i < size_t(count); ++i)
      found.push_back(eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr));
  return found;
}

EGLContext core_context(EGLDisplay display) {
  constexpr std::array<std::array<EGLint, 2>, 4> kVersions{{{4, 5}, {4, 3}, {4, 1}, {3, 3}}};
  constexpr EGLint kConfig[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, 0, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint configs = 0;
  eglChooseConfig(display, kConfig, &config, 1, &configs);
  if (configs == 0) config = EGL_NO_CONFIG_KHR;  // EGL_KHR_no_config_context
  for (const auto& version : kVersions) {
    const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                 version[0],
                                 EGL_CONTEXT_MINOR_VERSION,
                                 version[1],
                                 EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                 EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                 EGL_NONE};
    const EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, attributes);
    if (context != EGL_NO_CONTEXT) return context;
  }
  return EGL_NO_CONTEXT;
}

std::string gl_text(GLenum name) {
  const GLubyte* text = glGetString(name);
  return text == nullptr ? std::string("?") : reinterpret_cast<const char*>(text);
}

int gl_integer(GLenum name) {
  GLint value = 0;
  glGetIntegerv(name, &value);
  return value;
}

Error no_driver(const std::string& reason) {
  return {ErrorKind::no_gl_driver, "OpenGL", reason,
          "install libegl1, libopengl0 and libgl1-mesa-dri, or a GPU's driver"};
}

/// epoxy ends the process where it cannot load a library of entry points, so they are tried first.
void require_libraries() {
  if (!epoxy_has_egl()) throw no_driver("there is no libEGL.so.1");
  for (const char* name : {"libOpenGL.so.0", "libGL.so.1"})
    if (void* library = dlopen(name, RTLD_LAZY | RTLD_LOCAL)) {
      dlclose(library);
      return;
    }
  throw no_driver("there is neither libOpenGL.so.0 nor libGL.so.1");
}

}  // namespace

GlContext::GlContext(GlDriver driver, std::span<const GlPlatform> platforms) : handles_(std::make_unique<Handles>()) {
  const ScopedVariable gallium("GALLIUM_DRIVER", gallium_name(driver));
  const ScopedVariable software("LIBGL_ALWAYS_SOFTWARE", driver == GlDriver::any ? nullptr : "1");
  require_libraries();
  if (driver != GlDriver::softpipe) require_threads_of_library("a driver of OpenGL");
  std::string tried = "no EGL display";
  GlPlatform opened = GlPlatform::surfaceless;
  for (const GlPlatform platform : platforms) {
    if (handles_->context != EGL_NO_CONTEXT) break;
    opened = platform;
    for (const EGLDisplay display : platform == GlPlatform::device ? device_displays() : surfaceless_displays()) {
      if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr)) continue;
      tried = "a display without desktop OpenGL 3.3";
      if (!eglBindAPI(EGL_OPENGL_API)) continue;
      handles_->display = display;
      handles_->context = core_context(display);
      if (handles_->context != EGL_NO_CONTEXT) break;
    }
  }
  if (handles_->context == EGL_NO_CONTEXT) throw no_driver("no driver gives a context: " + tried);
  make_current();
  info_ = {gl_text(GL_VENDOR),
           gl_text(GL_RENDERER),
           gl_text(GL_VERSION),
           gl_integer(GL_MAJOR_VERSION),
           gl_integer(GL_MINOR_VERSION),
           gl_integer(GL_SUBPIXEL_BITS),
           gl_integer(GL_MAX_TEXTURE_SIZE),
           opened};
  const char* wanted = gallium_name(driver);
  if (wanted != nullptr && info_.renderer.find(wanted) == std::string::npos)
    throw no_driver(std::string("this Mesa has no ") + wanted + ", it gives " + info_.renderer);
}

GlContext::~GlContext() {
  if (handles_->context == EGL_NO_CONTEXT) return;
  // Displays are the process's: another context may live on this one, so it is not terminated.
  eglMakeCurrent(handles_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(handles_->display, handles_->context);
}

void GlContext::make_current() const {
  eglBindAPI(EGL_OPENGL_API);
  if (!eglMakeCurrent(handles_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, handles_->context))
    throw no_driver("the driver cannot draw without a surface (EGL_KHR_surfaceless_context)");
}

bool GlContext::has(const char* extension) const { return epoxy_has_gl_extension(extension); }

}  // namespace trueshade::oracle
