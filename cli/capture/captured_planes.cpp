#include "cli/capture/captured_planes.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <optional>

#include "cli/capture/camera_frame.h"
#include "cli/capture/plane_images.h"
#include "cli/capture/unpacking.h"
#include "core/error.h"
#include "oracle/matrices.h"

namespace trueshade {
namespace {

// What a shader's arithmetic may be off by, relative: 16 units in the last place of a float for a distance that it
// computes, a point that it transforms, a direction that it turns. Two units of 1 for a depth of the window.
constexpr double kComputed = 0x1p-20, kWindowComputed = 0x1p-22;

/// A float that is not below the number.
float rounded_up(double value) { return std::nextafter(float(value), HUGE_VALF); }

double length_of(const Real3& v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

/// The distance to the next number of a small float with so many bits of mantissa.
double float_step(double value, int mantissa) {
  const int exponent = value == 0 ? -14 : std::max(std::ilogb(value), -14);
  return std::ldexp(1.0, exponent - mantissa);
}

/// The distance from a value to the next number that the channel can store; 0 of 32-bit floats.
double step_of(const Channel& channel, double value) {
  if (channel.is_code() || channel.kind == ChannelKind::snorm) return 1.0 / channel.largest_code();
  if (channel.is_rounded) return 0x1p-23 * std::fabs(value);
  if (channel.bits >= 32) return 0;
  return float_step(value, channel.bits == 16 ? 10 : channel.bits - 5);
}

/// step_of() by the format of a plane that a file may hold as floats. Its codes stand for -1 to 1.
double step_in(Format format, double value) {
  const FormatInfo layout = info(format);
  if (layout.number_class == NumberClass::unorm) return 2.0 / layout.largest_code(0);
  return layout.small_float() ? float_step(value, 10) : 0;
}

/// Unpacks the planes of one capture.
class PlaneUnpacker {
 public:
  PlaneUnpacker(const CaptureFiles& files, const Scene& scene, const Pipeline& pipeline)
      : files_(files), pipeline_(pipeline), frame_(scene, pipeline) {
    for (const Light& light : scene.lights)
      farthest_light_ = std::max(
          farthest_light_, length_of({double(light.position.x), double(light.position.y), double(light.position.z)}));
  }

  /// captured_planes(). Called once.
  CapturedPlanes run() {
    out_.capture.driver = "capture of " + files_.name;
    out_.capture.name = files_.name;
    // Where surfaces are comes before what is packed there.
    for (const PlaneChannelList& plane : files_.planes)
      if (plane.mapped.plane == "depth" || plane.mapped.plane.starts_with("id.")) add(plane);
    find_surfaces();
    for (const PlaneChannelList& plane : files_.planes)
      if (plane.mapped.plane != "depth" && !plane.mapped.plane.starts_with("id.")) add(plane);
    if (!covered_.empty())
      for (NamedImage& plane : out_.capture.planes)
        if (plane.name != "depth" && !plane.name.starts_with("id.") && plane.name != "light.count")
          forget_clear_value(plane);
    return std::move(out_);
  }

 private:
  [[noreturn]] void fail(const PlaneChannelList& plane, const std::string& reason, const std::string& remedy) const {
    throw Error(ErrorKind::bad_input, plane.file->path, reason, remedy);
  }
  [[noreturn]] void fail_at(const PlaneChannelList& plane, int x, int y, const std::string& reason,
                            const std::string& remedy) const {
    std::string values;
    for (const Channel* channel : plane.channels) {
      char number[32];
      std::snprintf(number, sizeof number, "%s%.9g", values.empty() ? "" : ", ",
                    channel->value(file_pixel(plane, x, y)));
      values += number;
    }
    fail(plane,
         plane.mapped.plane + " at " + std::to_string(x) + ',' + std::to_string(y) + " is " + values + ", " + reason,
         remedy);
  }
  void note(const std::string& line) { out_.notes.push_back(line); }

  /// Sets a plane to 0 wherever there is no surface, if it holds one value there: the engine's clear value. Adds a
  /// note.
  void forget_clear_value(NamedImage& plane) {
    const auto bytes = size_t(info(plane.image.format).bytes_per_texel());
    std::vector<uint8_t> clear;
    for (size_t i = 0; i < covered_.size(); ++i) {
      if (covered_[i] != 0) continue;
      const uint8_t* const texel = &plane.image.texels[i * bytes];
      if (clear.empty()) clear.assign(texel, texel + bytes);
      if (std::memcmp(texel, clear.data(), bytes) != 0) return;
    }
    if (std::all_of(clear.begin(), clear.end(), [](uint8_t b) { return b == 0; })) return;
    for (size_t i = 0; i < covered_.size(); ++i)
      if (covered_[i] == 0) std::fill_n(&plane.image.texels[i * bytes], bytes, uint8_t(0));
    note(plane.name + " holds one value wherever there is no surface: it is taken for the plane's clear value");
  }

  /// Adds one plane to the capture, unpacked if its words say so. Error(bad_input) for values that the words do not
  /// allow.
  void add(const PlaneChannelList& plane) {
    const std::string& name = plane.mapped.plane;
    if (plane.file->path != files_.name) out_.capture.files.emplace_back(name, plane.file->path);
    const bool lacks_alpha = plane.channels.size() == 3 && (name == "color" || name == "albedo" || name == "emission");
    if (plane.mapped.plane == "depth" && is_linear(plane)) {
      add_linear_depth(plane);
    } else if (plane.mapped.depth == CapturedDepth::reversed && name == "depth") {
      add_reversed_depth(plane);
    } else if (name == "position" && plane.mapped.depth != CapturedDepth::none) {
      add_position_of_depth(plane);
    } else if (name == "position" && plane.mapped.space != CapturedSpace::world) {
      add_view_positions(plane);
    } else if (name == "normal" && plane.mapped.is_unpacked() && !is_stored_normal(plane)) {
      add_normals(plane);
    } else if (name == "color") {
      out_.capture.color = stored_plane_image(plane);
      out_.capture.has_alpha = !lacks_alpha;
      if (plane.file->path != files_.name) out_.capture.driver += " and " + plane.file->path;
    } else {
      check_halves(plane);
      if (name == "normal" && !is_stored_normal(plane)) check_signed(plane);
      out_.capture.planes.push_back({name, stored_plane_image(plane)});
      if (name == "metallic" || name == "roughness")  // an engine's own format
        out_.capture.decoded.push_back({name, false, {}, {float(0.504 * step_of(*plane.channels[0], 1.0))}, true});
      if (lacks_alpha && info(out_.capture.planes.back().image.format).channels == 4)
        out_.capture.decoded.push_back({name, false, {}, {}, false});
    }
  }

  /// Throws Error(bad_input) for depths and texture coordinates in halves where the pipeline stores more bits: they
  /// were rounded after they were drawn.
  void check_halves(const PlaneChannelList& plane) const {
    const std::string& name = plane.mapped.plane;
    const Format format = name == "depth" ? pipeline_.geometry.depth_format : surface_planes(pipeline_).uv.format;
    if (plane.channels[0]->kind != ChannelKind::floating || plane.channels[0]->bits >= 32) return;
    if (name == "depth" || (name == "uv" && !info(format).small_float()))
      fail(plane, name + " is stored as half, and the pipeline's as " + std::string(info(format).name),
           "write it as float: a half keeps 11 of its bits");
  }

  static bool is_linear(const PlaneChannelList& plane) { return is_length(plane.mapped.depth); }

  /// Whether a normal plane is stored as the pipeline stores it, codes of n/2 + 1/2 in the world: then it is not
  /// unpacked.
  bool is_stored_normal(const PlaneChannelList& plane) const {
    const FormatInfo layout = info(pipeline_.gbuffer.normal.format);
    return plane.mapped.packing == Packing::none && plane.mapped.space == CapturedSpace::world && !plane.mapped.unit &&
           layout.number_class == NumberClass::unorm &&
           (plane.channels[0]->is_code() ? plane.channels[0]->bits : plane.mapped.unorm_bits) == layout.bits[0];
  }

  /// Sets covered_ by id.object or, without it, by depth: covered where the depth is farther than a code from the clear
  /// depth. Leaves covered_ empty where neither plane is there.
  void find_surfaces() {
    const Image* const object = out_.capture.plane("id.object");
    const Image* const depth = out_.capture.plane("depth");
    if (object == nullptr && depth == nullptr) return;
    const FormatInfo buffer = info(pipeline_.geometry.depth_format);
    const double off = buffer.number_class == NumberClass::unorm ? 1.0 / buffer.largest_code(0) : 0;
    covered_.resize(size_t(files_.width()) * size_t(files_.height()));
    for (int y = 0; y < files_.height(); ++y)
      for (int x = 0; x < files_.width(); ++x)
        covered_[at(x, y)] = object != nullptr
                                 ? object->value(x, y, 0) != 0
                                 : std::fabs(depth->value(x, y, 0) - double(pipeline_.geometry.clear_depth)) > off;
  }
  size_t at(int x, int y) const { return size_t(y) * size_t(files_.width()) + size_t(x); }

  /// Whether a plane holds something at a pixel: where there is a surface or, where no plane tells, where any of its
  /// channels is not 0.
  bool is_packed(const PlaneChannelList& plane, int x, int y) const {
    if (!covered_.empty()) return covered_[at(x, y)] != 0;
    return std::any_of(plane.channels.begin(), plane.channels.end(),
                       [&](const Channel* c) { return c->words[file_pixel(plane, x, y)] != 0; });
  }

  /// Adds a plane of three floats, and its bounds, of what unpack(x, y) returns for each pixel where is_packed(); 0
  /// elsewhere.
  template <typename Unpack>
  void add_vectors(const PlaneChannelList& plane, bool unit_length, Unpack unpack) {
    Image image(files_.width(), files_.height(), Format::rgb32f);
    const size_t pixels = size_t(image.width) * size_t(image.height);
    oracle::DecodedPlane decoded{plane.mapped.plane, unit_length, std::vector<float>(pixels),
                                 std::vector<float>(pixels), true};
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        if (!is_packed(plane, x, y)) continue;
        const UnpackedVector v = unpack(x, y);
        for (int k = 0; k < 3; ++k) image.set_code(x, y, k, std::bit_cast<uint32_t>(float(v.value[size_t(k)])));
        decoded.reading_error[at(x, y)] = rounded_up(v.reading_error);
        decoded.packing_error[at(x, y)] = rounded_up(v.packing_error);
      }
    out_.capture.planes.push_back({plane.mapped.plane, std::move(image)});
    out_.capture.decoded.push_back(std::move(decoded));
  }

  /// The number of a channel at a pixel, times the plane's factor, with its step and what fetching it errs by.
  /// Error(bad_input) for NaN, and for a number that is no code of `unorm_bits` where the plane says these.
  PackedNumber number_at(const PlaneChannelList& plane, size_t channel, int x, int y) const {
    const Channel& of = *plane.channels[channel];
    const double value = of.value(file_pixel(plane, x, y)) * plane.mapped.times;
    if (std::isnan(value))
      fail_at(plane, x, y, "which is not a number", "find what the shader divides by, or capture another frame");
    PackedNumber number{value, step_of(of, value / plane.mapped.times) * plane.mapped.times, 0};
    if (of.is_code() || of.kind == ChannelKind::snorm) number.fetch = 2.5 * 0x1p-23 * std::fabs(value);
    if (plane.mapped.unorm_bits == 0 || of.is_code()) return number;
    const double largest = double((1u << plane.mapped.unorm_bits) - 1), code = std::nearbyint(value * largest);
    if (!(code >= 0 && code <= largest) || std::fabs(value - code / largest) > (of.bits == 16 ? 0x1p-10 : 0x1p-20))
      fail_at(plane, x, y, "which is no code of " + std::to_string(plane.mapped.unorm_bits) + " bits",
              "say unorm where floats are stored");
    return {code / largest, 1 / largest, 2.5 * 0x1p-23 * code / largest};
  }

  /// number_at(), turned from [0, 1] to [-1, 1] where the plane is unorm. Error(bad_input) outside [0, 1] then.
  PackedNumber component_at(const PlaneChannelList& plane, size_t channel, int x, int y) const {
    const PackedNumber number = number_at(plane, channel, x, y);
    if (!plane.mapped.unorm || plane.mapped.packing == Packing::spheremap) return number;
    if (!(number.value >= 0 && number.value <= 1))
      fail_at(plane, x, y, "and unorm numbers are from 0 to 1", "leave out 'unorm' where the plane holds -1 to 1");
    return signed_number(number);
  }

  /// Error(bad_input) for a normal in codes, which hold no negative numbers.
  void check_signed(const PlaneChannelList& plane) const {
    if (plane.channels[0]->is_code())
      fail(plane, "normal is stored in codes from 0 to 1, which hold no negative numbers", "say unorm");
  }

  /// Adds the plane normal, unpacked and in the world. Error(bad_input) for integers, sRGB codes, NaN at a surface,
  /// numbers that the packing does not have, and a camera without axes where the space is a view's. Adds a note where
  /// the packing is coarse.
  void add_normals(const PlaneChannelList& plane) {
    const MappedPlane& mapped = plane.mapped;
    if (plane.channels[0]->kind == ChannelKind::integer || plane.channels[0]->kind == ChannelKind::srgb)
      fail(plane, "a normal is stored as integers or sRGB", "save it as floats or unorm codes");
    if (!mapped.unorm && mapped.packing != Packing::spheremap) check_signed(plane);
    if (mapped.space != CapturedSpace::world) frame_.check_axes();
    const bool packed = mapped.packing != Packing::none;
    add_vectors(plane, packed || mapped.unit, [&](int x, int y) { return unpacked_normal(plane, x, y); });
    if (packed) note_normal_steps();
  }

  /// The normal of one pixel in the world, with its bounds.
  UnpackedVector unpacked_normal(const PlaneChannelList& plane, int x, int y) const {
    const auto component = [&](size_t k) { return component_at(plane, k, x, y); };
    const auto stored = [&](size_t k) {  // in the pipeline's format, which the file's type may not show
      PackedNumber n = component(k);
      n.step = std::max(n.step, step_in(surface_planes(pipeline_).normal.format, n.value));
      return n;
    };
    std::optional<UnpackedVector> v;
    switch (plane.mapped.packing) {
      case Packing::none:
        v = unpacked_components({stored(0), stored(1), stored(2)});
        break;
      case Packing::octahedral:
        v = unpacked_octahedral(component(0), component(1));
        if (!v) fail_at(plane, x, y, "and octahedral numbers are from -1 to 1", "say what the channels hold");
        break;
      case Packing::spheremap:
        v = unpacked_spheremap(component(0), component(1));
        if (!v) fail_at(plane, x, y, "to which no direction is packed", "say what the channels hold");
        break;
    }
    if (plane.mapped.space == CapturedSpace::world) return *v;
    const double turned = kComputed * length_of(v->value);
    return {frame_.world_direction(plane.mapped.space, v->value), std::sqrt(3.0) * v->reading_error + turned,
            std::sqrt(3.0) * v->packing_error + turned};
  }

  /// Adds a note where the normals that were just added are packed to steps of 1e-4 or more.
  void note_normal_steps() {
    const std::vector<float>& errors = out_.capture.decoded.back().packing_error;
    const float most = errors.empty() ? 0 : *std::max_element(errors.begin(), errors.end());
    if (most < 1e-4f) return;
    char text[160];
    std::snprintf(text, sizeof text,
                  "plane normal is packed: the G-buffer's stage tells no normals apart that differ by less than %.2g",
                  double(most));
    note(text);
  }

  /// Adds the plane position, turned from a view space to the world. Error(bad_input) for NaN at a surface, and for a
  /// camera without axes.
  void add_view_positions(const PlaneChannelList& plane) {
    frame_.check_axes();
    const double eye = length_of(frame_.eye());
    add_vectors(plane, false, [&](int x, int y) {
      Real3 p{};
      double step = 0;
      for (size_t k = 0; k < 3; ++k) {
        const PackedNumber number = number_at(plane, k, x, y);
        p[k] = number.value;
        step = std::max({step, number.step, step_in(surface_planes(pipeline_).position.format, number.value)});
      }
      const double computed = kComputed * (length_of(p) + 2 * eye);
      return UnpackedVector{frame_.world_position(plane.mapped.space, p), computed + kComputed * farthest_light_,
                            computed + std::sqrt(3.0) * step};
    });
  }

  /// The depth at a pixel: 1 minus the number where it is reversed. Error(bad_input) for NaN.
  double depth_at(const PlaneChannelList& plane, int x, int y) const {
    const double depth = number_at(plane, 0, x, y).value;
    return plane.mapped.depth == CapturedDepth::reversed ? 1 - depth : depth;
  }

  /// The point of a pixel's ray at a depth of this kind.
  Real3 point_at(CapturedDepth kind, int x, int y, double depth) const {
    if (kind == CapturedDepth::linear) return frame_.at_linear(x, y, depth);
    if (kind == CapturedDepth::distance) return frame_.at_distance(x, y, depth);
    return frame_.at_window(x, y, depth);
  }

  /// How far the engine's shader may have computed a depth from this one.
  double depth_error(const PlaneChannelList& plane, double depth) const {
    return is_linear(plane) ? kComputed * std::fabs(depth) : kWindowComputed;
  }

  /// Adds positions rebuilt from a depth of any kind. A position's error is the distance to the points at the ends of
  /// the depth's error, plus that of a transformation. A position is 0 where there is no surface, and where a distance
  /// is not above 0 or infinite. The G-buffer's stage leaves the plane out (its packing_error is infinite), since the
  /// depth is that of the snapped triangle. Error(bad_input) for NaN at a surface, and for a camera without axes. Adds
  /// a note.
  void add_position_of_depth(const PlaneChannelList& plane) {
    frame_.check_axes();
    const CapturedDepth kind = plane.mapped.depth;
    add_vectors(plane, false, [&](int x, int y) {
      const double depth = depth_at(plane, x, y), error = depth_error(plane, depth);
      if (is_linear(plane) && !(depth > 0 && std::isfinite(depth))) return UnpackedVector{{}, 0, HUGE_VAL};
      const Real3 p = point_at(kind, x, y, depth);
      double off = 0;
      for (const double other : {depth - error, depth + error}) {
        const Real3 q = point_at(kind, x, y, other);
        off = std::max(off, length_of({q[0] - p[0], q[1] - p[1], q[2] - p[2]}));
      }
      const double computed = kComputed * (length_of(p) + length_of(frame_.eye()));
      return UnpackedVector{p, 1.01 * off + computed, HUGE_VAL};
    });
    note(
        "plane position is rebuilt from a depth: it is the less sure the farther away, and the G-buffer's stage leaves "
        "it out (its depth is judged as plane depth)");
  }

  /// Error(bad_input) where the pipeline's depths are not d32f.
  void check_float_depth(const PlaneChannelList& plane) const {
    if (pipeline_.geometry.depth_format == Format::d32f) return;
    fail(plane,
         "a depth that was computed from the buffer's does not tell its codes of " +
             std::string(info(pipeline_.geometry.depth_format).name),
         "state depth_format d32f, or capture the buffer itself");
  }

  /// Adds the plane depth as 1 minus a reversed depth: exact for codes; for floats with the rounding of 1 - z, and with
  /// a note. Error(bad_input) for NaN, for numbers outside [0, 1], for halves where the pipeline stores more bits, and
  /// for floats where the pipeline's depths are not d32f.
  void add_reversed_depth(const PlaneChannelList& plane) {
    check_halves(plane);
    const Channel& channel = *plane.channels[0];
    Image image(files_.width(), files_.height(), Format::d32f);
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const double depth = number_at(plane, 0, x, y).value;
        if (!(depth >= 0 && depth <= 1)) fail_at(plane, x, y, "and depths are from 0 to 1", "say linear or distance");
        image.set_code(x, y, 0, std::bit_cast<uint32_t>(float(1 - depth)));
      }
    out_.capture.planes.push_back({"depth", std::move(image)});
    if (channel.is_code()) return;
    check_float_depth(plane);
    out_.capture.decoded.push_back({"depth", false, {float(kWindowComputed)}, {float(kWindowComputed)}, true});
    note(
        "plane depth is taken as 1 minus the pipeline's; where your matrix itself is reversed, state that matrix with "
        "depth_func greater and clear_depth 0, and take the depth as it is");
  }

  /// Adds the plane depth of distances, along the camera's axis or from the eye. Where one is not above 0, infinite, or
  /// at or beyond the clear depth, nothing was drawn, and the depth is the clear depth. Error(bad_input) for NaN, for a
  /// pipeline whose depths are not d32f, and for a camera without axes. Adds a note.
  void add_linear_depth(const PlaneChannelList& plane) {
    check_float_depth(plane);
    frame_.check_axes();
    const float clear = pipeline_.geometry.clear_depth;
    Image image(files_.width(), files_.height(), Format::d32f);
    const size_t pixels = size_t(image.width) * size_t(image.height);
    oracle::DecodedPlane decoded{"depth", false, std::vector<float>(pixels), std::vector<float>(pixels), true};
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const PackedNumber number = number_at(plane, 0, x, y);
        const double error = depth_error(plane, number.value);
        const auto window = [&](double d) { return frame_.window_depth(point_at(plane.mapped.depth, x, y, d)); };
        float& reading = decoded.reading_error[at(x, y)];
        double depth = double(clear);
        if (number.value > 0 && std::isfinite(number.value)) {
          depth = window(number.value);
          const double off = std::max(std::fabs(window(number.value + error) - depth),
                                      std::fabs(window(std::max(number.value - error, 1e-30)) - depth));
          const double step = std::fabs(window(number.value + number.step) - depth);
          reading = rounded_up(1.01 * off + 0x1p-24);
          decoded.packing_error[at(x, y)] = rounded_up(1.01 * (off + step) + kWindowComputed);
          if (clear > 0.5f ? depth >= double(clear) : depth <= double(clear)) depth = double(clear);
        }
        image.set_code(x, y, 0, std::bit_cast<uint32_t>(float(depth)));
      }
    out_.capture.planes.push_back({"depth", std::move(image)});
    out_.capture.decoded.push_back(std::move(decoded));
    note(
        "a distance does not tell which of two surfaces is in front that are nearer to each other than a millionth of "
        "it");
  }

  const CaptureFiles& files_;
  const Pipeline& pipeline_;
  const CameraFrame frame_;
  double farthest_light_ = 0;
  std::vector<uint8_t> covered_;  ///< empty where no plane tells
  CapturedPlanes out_;
};

}  // namespace

CapturedPlanes captured_planes(const CaptureFiles& files, const Scene& scene, const Pipeline& pipeline) {
  return PlaneUnpacker(files, scene, pipeline).run();
}

}  // namespace trueshade
