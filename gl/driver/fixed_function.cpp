#include "gl/driver/fixed_function.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <cmath>

namespace trueshade::oracle {

namespace {

constexpr int kColumns = 64;  // pixels a row of points

/// A compatibility context beside another, current while it lives.
class CompatibilityScope {
 public:
  explicit CompatibilityScope(const GlContext& context) : core_(context) {
    context.make_current();
    display_ = eglGetCurrentDisplay();
    constexpr EGLint kConfig[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, 0, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint configs = 0;
    eglChooseConfig(display_, kConfig, &config, 1, &configs);
    constexpr EGLint kAttributes[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 0, EGL_NONE};
    context_ = eglCreateContext(display_, configs > 0 ? config : EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, kAttributes);
    if (context_ != EGL_NO_CONTEXT && !eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_))
      context_ = EGL_NO_CONTEXT;
  }
  ~CompatibilityScope() {
    core_.make_current();
    if (context_ != EGL_NO_CONTEXT) eglDestroyContext(display_, context_);
  }
  CompatibilityScope(const CompatibilityScope&) = delete;
  CompatibilityScope& operator=(const CompatibilityScope&) = delete;

  /// Whether glLight is there: a 3.0 context is of either kind.
  bool open() const {
    return context_ != EGL_NO_CONTEXT && (epoxy_gl_version() < 31 || epoxy_has_gl_extension("GL_ARB_compatibility"));
  }

 private:
  const GlContext& core_;
  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
};

void set_light(GLenum name, const Light& light) {
  const bool directional = is_directional(light.type);
  const glm::vec3 place = directional ? -light.direction : light.position;
  const float position[] = {place.x, place.y, place.z, directional ? 0.0f : 1.0f};
  const float color[] = {light.color.r, light.color.g, light.color.b, 1};
  const float ambient[] = {light.ambient.r, light.ambient.g, light.ambient.b, 1};
  const float direction[] = {light.direction.x, light.direction.y, light.direction.z};
  glEnable(name);
  glLightfv(name, GL_POSITION, position);
  glLightfv(name, GL_DIFFUSE, color);
  glLightfv(name, GL_SPECULAR, color);
  glLightfv(name, GL_AMBIENT, ambient);
  glLightf(name, GL_CONSTANT_ATTENUATION, light.attenuation.x);
  glLightf(name, GL_LINEAR_ATTENUATION, light.attenuation.y);
  glLightf(name, GL_QUADRATIC_ATTENUATION, light.attenuation.z);
  if (!is_spot(light.type)) return;
  const double degrees = (double(light.cone_rad) + double(light.penumbra_rad)) * 180 / 3.14159265358979323846;
  glLightfv(name, GL_SPOT_DIRECTION, direction);
  glLightf(name, GL_SPOT_EXPONENT, light.spot_exponent);
  glLightf(name, GL_SPOT_CUTOFF, float(degrees > 90.001 ? 180 : degrees));
}

/// Draws a point whose lighting is its own and whose pixel is (x, y) of a width x height image.
void draw_point(const LitPoint& p, int x, int y, int width, int height) {
  const float to_pixel[16] = {0,
                              0,
                              0,
                              0,
                              0,
                              0,
                              0,
                              0,
                              0,
                              0,
                              0,
                              0,
                              (2.0f * float(x) + 1.0f) / float(width) - 1.0f,
                              (2.0f * float(y) + 1.0f) / float(height) - 1.0f,
                              0,
                              1};
  glMatrixMode(GL_PROJECTION);
  glLoadMatrixf(to_pixel);
  const float albedo[] = {p.albedo.r, p.albedo.g, p.albedo.b, p.albedo.a};
  const glm::vec3 &s = p.material.specular_color, &e = p.material.emission;
  const float specular[] = {s.r, s.g, s.b, 1}, emission[] = {e.r, e.g, e.b, 1};
  glMaterialfv(GL_FRONT_AND_BACK, GL_AMBIENT_AND_DIFFUSE, albedo);
  glMaterialfv(GL_FRONT_AND_BACK, GL_SPECULAR, specular);
  glMaterialfv(GL_FRONT_AND_BACK, GL_EMISSION, emission);
  glMaterialf(GL_FRONT_AND_BACK, GL_SHININESS, p.material.shininess);
  glBegin(GL_POINTS);
  glNormal3f(p.normal.x, p.normal.y, p.normal.z);
  glVertex3f(p.position.x, p.position.y, p.position.z);
  glEnd();
}

}  // namespace

std::optional<std::vector<std::array<float, 4>>> fixed_function_colors(const GlContext& context,
                                                                       std::span<const LitPoint> points,
                                                                       std::span<const Light> lights) {
  const CompatibilityScope scope(context);
  if (!scope.open()) return std::nullopt;
  const int width = kColumns, height = int(points.size() + kColumns - 1) / kColumns;
  GLuint texture = 0, framebuffer = 0;
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, width, height, 0, GL_RGBA, GL_FLOAT, nullptr);
  glGenFramebuffers(1, &framebuffer);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
  glViewport(0, 0, width, height);
  glClear(GL_COLOR_BUFFER_BIT);
  glEnable(GL_LIGHTING);
  glEnable(GL_NORMALIZE);
  glMatrixMode(GL_MODELVIEW);
  glLoadIdentity();
  for (size_t i = 0; i < lights.size(); ++i) set_light(GLenum(GL_LIGHT0 + i), lights[i]);
  for (size_t i = 0; i < points.size(); ++i) draw_point(points[i], int(i) % kColumns, int(i) / kColumns, width, height);
  std::vector<std::array<float, 4>> colors(size_t(width) * size_t(height));
  glReadPixels(0, 0, width, height, GL_RGBA, GL_FLOAT, colors.data());
  colors.resize(points.size());
  const bool drawn = glGetError() == GL_NO_ERROR;
  glDeleteFramebuffers(1, &framebuffer);
  glDeleteTextures(1, &texture);
  if (!drawn) return std::nullopt;
  return colors;
}

}  // namespace trueshade::oracle
