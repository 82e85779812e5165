#include "cli/misread_capture.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "cli/capture/captured_planes.h"
#include "cli/capture/stored_planes.h"
#include "cli/capture_options.h"
#include "core/error.h"

namespace trueshade {
namespace {

using oracle::Finding;
using Planes = std::vector<PlaneChannelList>;

constexpr uint64_t kLeastShare = 50;  // a plane that is read otherwise has more than one wrong pixel in so many
constexpr double kMostLeft = 0.1;     // of the pixels that are wrong

bool tells_surface(std::string_view plane) { return plane == "depth" || plane == "id.object"; }

/// Whether a plane is judged by the stage of the lights: a position that is rebuilt from a depth, which the G-buffer's
/// stage leaves out.
bool is_told_by_light(const MappedPlane& plane) {
  return plane.plane == "position" && plane.depth != CapturedDepth::none;
}

/// Leaves out all of a large picture but squares that make up a seventh of it; of a small picture nothing.
void leave_out_most(PixelMask& mask, int width, int height) {
  constexpr int kSide = 16, kOf = 7, kSmall = 1 << 16;
  if (width * height <= kSmall) return;
  if (mask.empty()) mask = {width, height, std::vector<uint8_t>(size_t(width) * size_t(height))};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      if ((x / kSide + 3 * (y / kSide)) % kOf != 0) mask.left_out[size_t(y) * size_t(width) + size_t(x)] = 1;
}

/// The files of a capture, read again in other ways.
class Rereader {
 public:
  Rereader(const ValidationOptions& options, const Scene& scene, const Validation& v,
           const std::function<PixelMask(const oracle::Capture&)>& left_out)
      : options_(options),
        scene_(scene),
        v_(v),
        left_out_(left_out),
        files_(capture_files_of(options.capture, options.limits)),
        planes_(files_.planes) {}

  std::vector<Finding> findings() {
    if (const auto turned = upside_down()) return {*turned};
    std::vector<Finding> out;
    // Depths first: what is packed elsewhere is looked at where they say that there is a surface.
    for (const bool of_depth : {true, false})
      for (PlaneChannelList& plane : planes_)
        if ((plane.mapped.plane == "depth") == of_depth)
          if (const auto words = other_words(plane)) out.push_back(*words);
    return out;
  }

 private:
  /// Pixels in no legal set, and the worst of them.
  struct Wrong {
    uint64_t pixels = 0, judged = 0;
    oracle::WorstPixel worst;

    bool is_better_than(const Wrong& other) const {
      return double(pixels) * double(other.judged) <= kMostLeft * double(other.pixels) * double(judged);
    }
    bool is_much() const { return pixels * kLeastShare > judged; }
    double left_of(const Wrong& other) const {
      return double(pixels) * double(other.judged) / (double(other.pixels) * double(judged));
    }
  };

  /// Counts what is wrong if the planes are read as they are mapped. Nothing where they cannot be read so, say as
  /// distances that no surface has, or where no pixel is judged.
  std::optional<Wrong> wrong(Planes planes, bool by_light) {
    oracle::Capture capture;
    try {
      files_.planes = std::move(planes);
      capture = captured_planes(files_, scene_, v_.pipeline).capture;
      store_as(v_.pipeline, capture);
      capture.mask = left_out_(capture);
    } catch (const Error&) {
      return std::nullopt;
    }
    leave_out_most(capture.mask, v_.pipeline.width, v_.pipeline.height);
    oracle::ValidateOptions judged{v_.profile};
    judged.surfaces = !by_light;
    Wrong out;
    for (const oracle::StageVerdict& stage : oracle::validate_capture(scene_, v_.pipeline, capture, judged).stages) {
      if ((stage.stage == "gbuffer") == by_light) continue;
      out.pixels += stage.count(oracle::PixelClass::violation), out.judged += stage.judged();
      if (!stage.worst.empty()) out.worst = stage.worst[0];
    }
    if (out.judged == 0) return std::nullopt;
    return out;
  }

  Finding finding(std::string name, std::string text, const Wrong& as_read, const Wrong& otherwise) const {
    Finding f;
    f.name = std::move(name), f.plane = "capture", f.text = std::move(text);
    f.changed = as_read.pixels * v_.verdict.stages.front().judged() / as_read.judged;
    f.explained = f.alone = 1 - otherwise.left_of(as_read);
    const oracle::WorstPixel& worst = as_read.worst;
    f.proof = {worst.x, worst.y, worst.plane, worst.given, worst.nominal, worst.given};
    return f;
  }

  /// The finding that the rows run the other way, if depth or identifiers fit better so. The files are read again for
  /// it: planes that are computed from others and the pixel's place cannot be turned over.
  std::optional<Finding> upside_down() {
    Planes surfaces = planes_;
    std::erase_if(surfaces, [](const PlaneChannelList& plane) { return !tells_surface(plane.mapped.plane); });
    if (surfaces.empty()) return std::nullopt;
    const auto as_read = wrong(surfaces, false);
    if (!as_read || !as_read->is_much()) return std::nullopt;
    for (PlaneChannelList& plane : surfaces) plane.mapped.bottom_up = !plane.mapped.bottom_up;
    const auto otherwise = wrong(surfaces, false);
    if (!otherwise || !otherwise->is_better_than(*as_read)) return std::nullopt;
    const bool is_turned = options_.capture.map && capture_map_from_option(*options_.capture.map).bottom_up;
    const std::string rows = is_turned ? "rows=top_down" : "rows=bottom_up";
    Finding f = finding(rows,
                        "the rows of its files run the other way" +
                            std::string(is_turned ? "" : ", as glReadPixels gives them") + ": read it with " + rows +
                            " in --map",
                        *as_read, *otherwise);
    if (!options_.capture.map) f.command = "trueshade" + options_.command_line + " --map " + rows;
    return f;
  }

  /// The finding that a plane fits better with other words, of which the fewest kinds are changed. From then on the
  /// plane is read by these words.
  std::optional<Finding> other_words(PlaneChannelList& plane) {
    // A depth may be a part of the far distance, and lengths in other units: centimetres, millimetres, hundreds.
    const double factors[] = {double(scene_.camera.far), 0.01, 0.001, 100, 1000, 1};
    const std::vector<std::vector<MappedPlane>> others = other_readings(plane.mapped, plane.channels.size(), factors);
    if (others.empty()) return std::nullopt;
    const bool by_light = is_told_by_light(plane.mapped);
    const auto read_as = [&](const MappedPlane& mapped) {
      Planes planes = planes_;
      const bool has_ids = std::any_of(planes.begin(), planes.end(),
                                       [](const PlaneChannelList& p) { return p.mapped.plane == "id.object"; });
      std::erase_if(planes, [&](const PlaneChannelList& p) {
        const std::string& name = p.mapped.plane;
        return !by_light && name != mapped.plane && name != (has_ids ? "id.object" : "depth");
      });
      for (PlaneChannelList& p : planes)
        if (p.mapped.plane == mapped.plane) p.mapped = mapped;
      return wrong(std::move(planes), by_light);
    };
    const auto as_read = read_as(plane.mapped);
    if (!as_read || !as_read->is_much()) return std::nullopt;
    for (const std::vector<MappedPlane>& as_far : others) {
      std::optional<Wrong> best;
      const MappedPlane* best_plane = nullptr;
      for (const MappedPlane& other : as_far)
        if (const auto otherwise = read_as(other);
            otherwise && (!best || otherwise->left_of(*as_read) < best->left_of(*as_read)))
          best = otherwise, best_plane = &other;
      if (!best || !best->is_better_than(*as_read)) continue;
      const std::string words = words_of(*best_plane), now = words_of(plane.mapped), name = plane.mapped.plane;
      const Finding f = finding(name + "=..." + (words.empty() ? "" : ":" + words),
                                "plane " + name + " fits when --map reads it " +
                                    (words.empty() ? "without words" : "with :" + words) + ", and not " +
                                    (now.empty() ? "as it is" : "with :" + now),
                                *as_read, *best);
      plane.mapped = *best_plane;
      return f;
    }
    return std::nullopt;
  }

  const ValidationOptions& options_;
  const Scene& scene_;
  const Validation& v_;
  const std::function<PixelMask(const oracle::Capture&)>& left_out_;
  CaptureFiles files_;
  Planes planes_;  ///< all
};

}  // namespace

std::vector<Finding> misread_findings(const ValidationOptions& options, const Scene& scene, const Validation& v,
                                      const std::function<PixelMask(const oracle::Capture&)>& left_out) {
  try {
    return Rereader(options, scene, v, left_out).findings();
  } catch (const Error&) {
    return {};  // files that can be read but once
  }
}

}  // namespace trueshade
