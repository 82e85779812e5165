#include "tests/gl/gl_calls.h"

#include <algorithm>
#include <functional>
#include <map>
#include <sstream>
#include <vector>

#include "gl/driver/objects.h"
#include "tests/catch.hpp"

namespace trueshade::testing {

namespace {

using Arguments = std::vector<double>;

const std::map<std::string, GLenum>& constants() {
#define NAMED(name) \
  { #name, name }
  static const std::map<std::string, GLenum> kValues = {NAMED(GL_TRUE),
                                                        NAMED(GL_FALSE),
                                                        NAMED(GL_DITHER),
                                                        NAMED(GL_MULTISAMPLE),
                                                        NAMED(GL_SCISSOR_TEST),
                                                        NAMED(GL_STENCIL_TEST),
                                                        NAMED(GL_PRIMITIVE_RESTART),
                                                        NAMED(GL_FRAMEBUFFER_SRGB),
                                                        NAMED(GL_BLEND),
                                                        NAMED(GL_DEPTH_TEST),
                                                        NAMED(GL_DEPTH_CLAMP),
                                                        NAMED(GL_CULL_FACE),
                                                        NAMED(GL_POLYGON_OFFSET_FILL),
                                                        NAMED(GL_FRONT_AND_BACK),
                                                        NAMED(GL_FRONT),
                                                        NAMED(GL_BACK),
                                                        NAMED(GL_FILL),
                                                        NAMED(GL_CCW),
                                                        NAMED(GL_CW),
                                                        NAMED(GL_LOWER_LEFT),
                                                        NAMED(GL_UPPER_LEFT),
                                                        NAMED(GL_NEGATIVE_ONE_TO_ONE),
                                                        NAMED(GL_ZERO_TO_ONE),
                                                        NAMED(GL_FIRST_VERTEX_CONVENTION),
                                                        NAMED(GL_LAST_VERTEX_CONVENTION),
                                                        NAMED(GL_NEVER),
                                                        NAMED(GL_LESS),
                                                        NAMED(GL_EQUAL),
                                                        NAMED(GL_LEQUAL),
                                                        NAMED(GL_GREATER),
                                                        NAMED(GL_NOTEQUAL),
                                                        NAMED(GL_GEQUAL),
                                                        NAMED(GL_ALWAYS),
                                                        NAMED(GL_FUNC_ADD),
                                                        NAMED(GL_FUNC_SUBTRACT),
                                                        NAMED(GL_FUNC_REVERSE_SUBTRACT),
                                                        NAMED(GL_MIN),
                                                        NAMED(GL_MAX),
                                                        NAMED(GL_ZERO),
                                                        NAMED(GL_ONE),
                                                        NAMED(GL_SRC_COLOR),
                                                        NAMED(GL_ONE_MINUS_SRC_COLOR),
                                                        NAMED(GL_DST_COLOR),
                                                        NAMED(GL_ONE_MINUS_DST_COLOR),
                                                        NAMED(GL_SRC_ALPHA),
                                                        NAMED(GL_ONE_MINUS_SRC_ALPHA),
                                                        NAMED(GL_DST_ALPHA),
                                                        NAMED(GL_ONE_MINUS_DST_ALPHA),
                                                        NAMED(GL_CONSTANT_COLOR),
                                                        NAMED(GL_ONE_MINUS_CONSTANT_COLOR),
                                                        NAMED(GL_CONSTANT_ALPHA),
                                                        NAMED(GL_ONE_MINUS_CONSTANT_ALPHA),
                                                        NAMED(GL_SRC_ALPHA_SATURATE)};
#undef NAMED
  return kValues;
}

GLenum name_at(const Arguments& a, size_t i) { return GLenum(a[i]); }
GLboolean flag_at(const Arguments& a, size_t i) { return GLboolean(a[i]); }
GLint whole_at(const Arguments& a, size_t i) { return GLint(a[i]); }
GLfloat real_at(const Arguments& a, size_t i) { return GLfloat(a[i]); }

struct Call {
  size_t arguments;
  std::function<void(const Arguments&)> run;
};

const std::map<std::string, Call>& functions() {
  static const std::map<std::string, Call> kCalls = {
      {"glEnable", {1, [](const Arguments& a) { glEnable(name_at(a, 0)); }}},
      {"glDisable", {1, [](const Arguments& a) { glDisable(name_at(a, 0)); }}},
      {"glDisablei", {2, [](const Arguments& a) { glDisablei(name_at(a, 0), GLuint(a[1])); }}},
      {"glPolygonMode", {2, [](const Arguments& a) { glPolygonMode(name_at(a, 0), name_at(a, 1)); }}},
      {"glViewport",
       {4, [](const Arguments& a) { glViewport(whole_at(a, 0), whole_at(a, 1), whole_at(a, 2), whole_at(a, 3)); }}},
      {"glDepthRange", {2, [](const Arguments& a) { glDepthRange(a[0], a[1]); }}},
      {"glDepthMask", {1, [](const Arguments& a) { glDepthMask(flag_at(a, 0)); }}},
      {"glDepthFunc", {1, [](const Arguments& a) { glDepthFunc(name_at(a, 0)); }}},
      {"glCullFace", {1, [](const Arguments& a) { glCullFace(name_at(a, 0)); }}},
      {"glFrontFace", {1, [](const Arguments& a) { glFrontFace(name_at(a, 0)); }}},
      {"glClipControl", {2, [](const Arguments& a) { glClipControl(name_at(a, 0), name_at(a, 1)); }}},
      {"glPolygonOffset", {2, [](const Arguments& a) { glPolygonOffset(real_at(a, 0), real_at(a, 1)); }}},
      {"glProvokingVertex", {1, [](const Arguments& a) { glProvokingVertex(name_at(a, 0)); }}},
      {"glBlendEquationSeparate",
       {2, [](const Arguments& a) { glBlendEquationSeparate(name_at(a, 0), name_at(a, 1)); }}},
      {"glBlendFuncSeparate",
       {4,
        [](const Arguments& a) { glBlendFuncSeparate(name_at(a, 0), name_at(a, 1), name_at(a, 2), name_at(a, 3)); }}},
      {"glBlendColor",
       {4, [](const Arguments& a) { glBlendColor(real_at(a, 0), real_at(a, 1), real_at(a, 2), real_at(a, 3)); }}},
      {"glColorMask",
       {4, [](const Arguments& a) { glColorMask(flag_at(a, 0), flag_at(a, 1), flag_at(a, 2), flag_at(a, 3)); }}},
      {"glColorMaski", {5, [](const Arguments& a) {
                          glColorMaski(GLuint(a[0]), flag_at(a, 1), flag_at(a, 2), flag_at(a, 3), flag_at(a, 4));
                        }}}};
  return kCalls;
}

std::string trimmed(const std::string& text) {
  const size_t first = text.find_first_not_of(' '), last = text.find_last_not_of(' ');
  return first == std::string::npos ? std::string() : text.substr(first, last - first + 1);
}

std::vector<std::string> parts(const std::string& text, char separator) {
  std::vector<std::string> out;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, separator);) out.push_back(trimmed(part));
  return out;
}

double argument_of(const std::string& text) {
  if (const auto found = constants().find(text); found != constants().end()) return double(found->second);
  size_t used = 0;
  const double value = text.empty() || text[0] == 'G' ? 0 : std::stod(text, &used);
  INFO("argument '" << text << "'");
  REQUIRE(used == text.size());
  return value;
}

}  // namespace

void run_gl_calls(const std::string& calls) {
  for (const std::string& call : parts(calls, ';')) {
    INFO("call '" << call << "'");
    const size_t open = call.find('(');
    REQUIRE(open != std::string::npos);
    REQUIRE(call.back() == ')');
    const auto found = functions().find(call.substr(0, open));
    REQUIRE(found != functions().end());
    Arguments arguments;
    for (const std::string& part : parts(call.substr(open + 1, call.size() - open - 2), ','))
      arguments.push_back(argument_of(part));
    REQUIRE(arguments.size() == found->second.arguments);
    found->second.run(arguments);
  }
}

void spoil_gl_state() {
  run_gl_calls(
      "glEnable(GL_DITHER); glEnable(GL_SCISSOR_TEST); glEnable(GL_STENCIL_TEST); glEnable(GL_PRIMITIVE_RESTART); "
      "glDisable(GL_FRAMEBUFFER_SRGB); glEnable(GL_BLEND); glEnable(GL_DEPTH_TEST); glEnable(GL_DEPTH_CLAMP); "
      "glEnable(GL_CULL_FACE); "
      "glEnable(GL_POLYGON_OFFSET_FILL); glPolygonOffset(7.0, 1000.0); glCullFace(GL_FRONT_AND_BACK); "
      "glFrontFace(GL_CW); "
      "glDepthFunc(GL_NEVER); glDepthMask(GL_TRUE); glDepthRange(0.75, 0.25); glViewport(3, 5, 7, 11); "
      "glClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE); glProvokingVertex(GL_FIRST_VERTEX_CONVENTION); "
      "glBlendEquationSeparate(GL_FUNC_REVERSE_SUBTRACT, GL_MIN); glBlendFuncSeparate(GL_DST_COLOR, GL_ONE, GL_ZERO, "
      "GL_ZERO); "
      "glBlendColor(0.125, 0.25, 0.375, 0.5); glColorMask(GL_FALSE, GL_TRUE, GL_FALSE, GL_FALSE)");
  glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
  glScissor(1, 1, 2, 2);
  glStencilFunc(GL_NEVER, 0, 0);
  glPrimitiveRestartIndex(1);
}

Format format_of_gl_name(const std::string& name) {
  static const std::map<std::string, Format> kFormats = {{"GL_RGBA8", Format::rgba8},
                                                         {"GL_SRGB8_ALPHA8", Format::srgb8_a8},
                                                         {"GL_RGB10_A2", Format::rgb10_a2},
                                                         {"GL_RGBA16", Format::rgba16},
                                                         {"GL_R11F_G11F_B10F", Format::r11g11b10f},
                                                         {"GL_RGB16F", Format::rgb16f},
                                                         {"GL_RGBA16F", Format::rgba16f},
                                                         {"GL_RGBA32F", Format::rgba32f},
                                                         {"GL_RGB32F", Format::rgb32f},
                                                         {"GL_RG32F", Format::rg32f},
                                                         {"GL_R32UI", Format::r32ui},
                                                         {"GL_DEPTH_COMPONENT32F", Format::d32f},
                                                         {"GL_DEPTH_COMPONENT24", Format::d24},
                                                         {"GL_DEPTH_COMPONENT16", Format::d16}};
  const auto found = kFormats.find(name);
  INFO("format " << name);
  REQUIRE(found != kFormats.end());
  return found->second;
}

}  // namespace trueshade::testing
