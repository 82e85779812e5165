#include "scenes/files/obj/obj_pictures.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>

#include "core/error.h"
#include "core/fp_env.h"
#include "core/memory_cap.h"
#include "core/threads/parallel_for.h"
#include "scenes/trig.h"

namespace trueshade::obj {
namespace {

constexpr uint8_t kWhite = 255;
constexpr uint8_t kHalfAsSrgb = 188;  ///< the sRGB code next to light of 0.5, as lose_map() leaves of a colour
constexpr size_t kTogether = 8;  ///< pictures that are decoded at a time, each within its share of what may be decoded

/// What may be decoded of so many bytes of textures: a chain of levels adds a third at most.
uint64_t without_levels(uint64_t bytes) { return bytes / 4 * 3; }

std::string place_of(const MtlDocument& document, const MapSource& map) {
  return document.file + ": line " + std::to_string(map.line);
}

/// What fails here is left undone: decoded() tries it again when its turn comes, and says so.
template <typename Job>
void attempt(const Job& job) {
  try {
    job();
  } catch (const std::exception&) {
  }
}

void turn_upside_down(Image& image) {
  const size_t row = image.row_bytes();
  for (size_t y = 0; y < size_t(image.height) / 2; ++y)
    std::swap_ranges(image.texels.begin() + ptrdiff_t(y * row), image.texels.begin() + ptrdiff_t((y + 1) * row),
                     image.texels.begin() + ptrdiff_t((size_t(image.height) - 1 - y) * row));
}

Texture texture_of(Image image, TextureFormat codes) {
  Texture texture;
  texture.format = image.format == Format::rgba32f   ? TextureFormat::rgba32f
                   : image.format == Format::rgba16f ? TextureFormat::rgba16f
                                                     : codes;
  texture.levels.push_back({image.width, image.height, std::move(image.texels)});
  return texture;
}

/// Whether channels differ by so little that the picture shows no colours: a map of normals has blue far above red
/// where it is flat.
bool is_grey(const Image& image) {
  constexpr int kSpread = 16;  // codes; JPEG colours grey a little
  for (size_t i = 0; i < image.texels.size(); i += 4) {
    const auto [least, most] = std::minmax({image.texels[i], image.texels[i + 1], image.texels[i + 2]});
    if (most - least > kSpread) return false;
  }
  return true;
}

void heights_to_normals(Image& image, float bump) {
  const FpScope fp;
  const Image heights = image;
  const auto height = [&](int x, int y) {
    return double(*heights.texel((x + image.width) % image.width, (y + image.height) % image.height)) / 255.0;
  };
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const double b = bump;
      const glm::dvec3 n =
          unit({-b * (height(x + 1, y) - height(x - 1, y)), -b * (height(x, y + 1) - height(x, y - 1)), 1.0});
      for (int k = 0; k < 3; ++k) image.texel(x, y)[k] = uint8_t(std::nearbyint(255.0 * (0.5 * n[k] + 0.5)));
      image.texel(x, y)[3] = 255;
    }
}

/// A channel of another picture at the place of a texel of one of this size, without a filter.
uint8_t code_at(const Image& image, int channel, int x, int y, int width, int height) {
  const int64_t column = int64_t(x) * image.width / width, row = int64_t(y) * image.height / height;
  return image.texel(int(column), int(row))[channel];
}

}  // namespace

std::string path_beside(const std::string& from, const std::string& name, const std::string& where, NamedPaths paths) {
  std::string uri;
  for (const char c : name) {
    if (c == '%')
      uri += "%25";
    else
      uri += c == '\\' ? '/' : c;
  }
  const std::string first_step = uri.substr(0, uri.find('/'));
  if (first_step != "..") path_from_uri(first_step.empty() ? uri : first_step, where, paths);
  if (uri.starts_with('/')) return path_from_uri(uri, where, paths);
  const size_t slash = from.rfind('/');
  std::string folder = slash == std::string::npos ? "" : from.substr(0, slash + 1);
  for (size_t at = folder.find('%'); at != std::string::npos; at = folder.find('%', at + 3))
    folder.insert(at + 1, "25");
  return path_from_uri(folder + uri, where, paths);
}

/// Of what is made of a picture.
std::string ObjPictures::key_of(const MtlDocument& document, const MapSource& map) const {
  return path_beside(document.file, map.file, place_of(document, map), limits_.named_paths);
}

struct ObjPictures::Task {
  std::string path, where;
  Bytes content;
  Image image;
};

void ObjPictures::decode_ahead(std::span<const WantedPicture> wanted, const std::function<void()>& meanwhile) {
  std::vector<Task> tasks;
  std::set<std::string> paths;
  for (const WantedPicture& picture : decode_ ? wanted : std::span<const WantedPicture>())
    attempt([&] {
      const MtlDocument& document = *picture.document;
      Task task{key_of(document, *picture.map), place_of(document, *picture.map), {}, {}};
      if (paths.insert(task.path).second) tasks.push_back(std::move(task));
    });
  uint64_t left = limits_.texture_bytes;
  for (size_t first = 0; first == 0 || first < tasks.size(); first += kTogether) {
    const std::span<Task> together = std::span(tasks).subspan(first, std::min(kTogether, tasks.size() - first));
    decode_some(
        together, without_levels(left) / kTogether, first == 0 ? meanwhile : [] {});
    for (Task& task : together) {
      if (task.image.texels.empty()) continue;
      left -= std::min<uint64_t>(left, task.image.texels.size());
      ahead_.emplace(std::move(task.path), std::move(task.image));
    }
  }
}

void ObjPictures::decode_some(std::span<Task> tasks, uint64_t share, const std::function<void()>& meanwhile) const {
  for (Task& task : tasks) attempt([&] { task.content = read_(task.path, limits_.file_bytes, task.where); });
  parallel_for(int(tasks.size()) + 1, 0, [&](int i) {
    if (i == 0) return meanwhile();  // what it throws ends the loop
    Task& task = tasks[size_t(i) - 1];
    if (task.content.empty()) return;
    attempt([&] { task.image = decode_(task.content, task.where + ": " + task.path, share); });
    task.content = Bytes();
  });
}

Image ObjPictures::decoded(const MtlDocument& document, const MapSource& map) {
  const std::string where = place_of(document, map), path = key_of(document, map);
  if (!decode_) throw Error(ErrorKind::bad_input, where, "this program reads no image files", "no pictures");
  Image image;
  if (const auto found = ahead_.find(path); found != ahead_.end()) {
    image = std::move(found->second);
    ahead_.erase(found);
  } else {
    const Bytes content = read_(path, limits_.file_bytes, where);
    image = decode_(content, where + ": " + path, without_levels(limits_.texture_bytes - bytes_));
  }
  if (image.format != Format::rgba8 && image.format != Format::rgba16f && image.format != Format::rgba32f)
    throw Error(ErrorKind::bad_input, where + ": " + path, "its texels are neither 8 bits nor half or float with RGBA",
                "PNG, JPEG, or an EXR with R, G, B, A");
  turn_upside_down(image);
  return image;
}

int32_t ObjPictures::add(Texture texture, const std::string& where) {
  const TextureLevel& level = texture.levels[0];
  const uint64_t bytes = texture_bytes(level.width, level.height, texture.format, MipChain::whole);
  if (bytes > limits_.texture_bytes - bytes_)
    throw Error(ErrorKind::limit, where + ": " + texture.name,
                "with this picture and its smaller levels the pictures are over the limit",
                within_limit(limits_.texture_bytes, "bytes in all", "--max-texture-memory"));
  require_memory(bytes - level.bytes.size(), where + ": " + texture.name, "the texture");
  bytes_ += bytes;
  scene_.textures.push_back(std::move(texture));
  return int32_t(scene_.textures.size() - 1);
}

void ObjPictures::build_levels() {
  parallel_for(int(scene_.textures.size()), 0, [&](int i) { build_mip_chain(scene_.textures[size_t(i)]); });
}

template <typename Make>
int32_t ObjPictures::once(const std::string& where, std::string key, const Make& make) {
  const auto found = known_.find(key);
  if (found != known_.end()) return found->second;
  Texture texture = make();
  texture.name = key.substr(0, key.find('\n'));
  return known_[std::move(key)] = add(std::move(texture), where);
}

int32_t ObjPictures::colors(const MtlDocument& document, const MapSource& map) {
  return once(place_of(document, map), key_of(document, map) + "\ncolors",
              [&] { return texture_of(decoded(document, map), TextureFormat::srgb8_a8); });
}

/// The second picture's codes; both have 8 bits a channel.
int32_t ObjPictures::colors_with_alpha(const MtlDocument& document, const MapSource* map, const MapSource& alpha) {
  const std::string colors = map ? key_of(document, *map) : "";
  return once(place_of(document, alpha), colors + "\nalpha of " + key_of(document, alpha), [&] {
    const auto codes = [&](const MapSource& source) {
      Image image = decoded(document, source);
      if (image.format != Format::rgba8)
        throw Error(ErrorKind::bad_input, place_of(document, source), "a picture beside map_d is of floats",
                    "8 bits a channel");
      return image;
    };
    const Image opacity = codes(alpha);
    Image image = opacity;
    const bool is_other = map && colors != key_of(document, alpha);
    const bool is_lost = is_other && unless_lost(*map, [&] { return image = codes(*map), 0; }) < 0;
    if (!map || is_lost) std::fill(image.texels.begin(), image.texels.end(), map ? kHalfAsSrgb : kWhite);
    int channel = 0;
    for (size_t i = 3; i < opacity.texels.size(); i += 4)
      if (opacity.texels[i] < 255) channel = 3;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x)
        image.texel(x, y)[3] = code_at(opacity, channel, x, y, image.width, image.height);
    return texture_of(std::move(image), TextureFormat::srgb8_a8);
  });
}

int32_t ObjPictures::normals(const MtlDocument& document, const MapSource& map, bool may_be_heights, bool& scaled) {
  const std::string path = key_of(document, map), as_heights = path + "\nheights " + std::to_string(map.bump);
  if (may_be_heights && known_.contains(as_heights)) return scaled = true, known_[as_heights];
  if (const auto found = known_.find(path + "\nnormals"); found != known_.end()) return scaled = false, found->second;
  Image image = decoded(document, map);
  scaled = may_be_heights && image.format == Format::rgba8 && is_grey(image);
  if (scaled) heights_to_normals(image, map.bump);
  return once(place_of(document, map), scaled ? as_heights : path + "\nnormals",
              [&] { return texture_of(std::move(image), TextureFormat::rgba8); });
}

int32_t ObjPictures::metallic_roughness(const MtlDocument& document, const MapSource* roughness,
                                        const MapSource* metallic) {
  const auto key = [&](const MapSource* map) { return map ? key_of(document, *map) : std::string(); };
  return once(place_of(document, roughness ? *roughness : *metallic),
              key(roughness) + "\nroughness, metalness of " + key(metallic), [&] {
                Image images[2];
                const MapSource* const maps[] = {roughness, metallic};
                for (int i = 0; i < 2; ++i) {
                  if (maps[i]) images[i] = decoded(document, *maps[i]);
                  if (maps[i] && images[i].format != Format::rgba8)
                    throw Error(ErrorKind::bad_input, place_of(document, *maps[i]), "the picture is of floats",
                                "8 bits a channel");
                }
                const Image& larger = images[roughness ? 0 : 1];
                Image out(larger.width, larger.height, Format::rgba8);
                std::fill(out.texels.begin(), out.texels.end(), uint8_t(255));
                for (int i = 0; i < 2; ++i)
                  for (int y = 0; maps[i] && y < out.height; ++y)
                    for (int x = 0; x < out.width; ++x)
                      out.texel(x, y)[1 + i] = code_at(images[i], 0, x, y, out.width, out.height);
                return texture_of(std::move(out), TextureFormat::rgba8);
              });
}

}  // namespace trueshade::obj
