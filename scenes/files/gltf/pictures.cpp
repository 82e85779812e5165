#include "scenes/files/gltf/pictures.h"

#include <algorithm>
#include <exception>
#include <set>

#include "core/error.h"
#include "core/memory_cap.h"
#include "core/picture_kind.h"
#include "core/threads/parallel_for.h"
#include "scenes/files/gltf/data_uri.h"

namespace trueshade::gltf {
namespace {

constexpr size_t kTogether = 8;  ///< pictures that are decoded at a time, each within its share of what may be decoded

void check_magic(std::span<const uint8_t> content, const std::string& where) {
  const std::string_view kind = picture_kind(content);
  if (kind == "PNG" || kind == "JPEG") return;
  if (kind.empty()) throw Error(ErrorKind::bad_input, where, "the picture is neither PNG nor JPEG", "one of these");
  throw Error(ErrorKind::bad_input, where, "the picture is " + std::string(kind), "PNG or JPEG");
}

bool is_media_type(std::string_view type) { return type == "image/png" || type == "image/jpeg"; }

}  // namespace

/// Bytes of a picture's file: owned ones, or those of a view.
struct Pictures::Content {
  Bytes owned;
  std::span<const uint8_t> bytes;
};

struct Pictures::Task {
  Content content;
  Image image;
  bool too_large = false;  ///< for its share: it is tried again by itself
  std::exception_ptr error;
};

uint32_t Pictures::first_with_content_of(uint32_t image) {
  const ImageSource& source = document_.images[image];
  const std::string_view uri = source.uri ? std::string_view(*source.uri) : std::string_view();
  const auto [known, is_new] = first_of_.try_emplace(image);
  if (is_new) known->second = firsts_.try_emplace({source.view, uri}, image).first->second;
  return known->second;
}

int32_t Pictures::texture(uint32_t any_image, TextureFormat format, bool has_levels) {
  const uint32_t image = first_with_content_of(any_image);
  const auto [found, is_new] = textures_.emplace(std::pair(image, format), int32_t(scene_.textures.size()));
  if (is_new) {
    const std::optional<std::string>& uri = document_.images[image].uri;
    Texture& texture = scene_.textures.emplace_back();
    texture.name = uri && !is_data_uri(*uri) ? *uri : "image " + std::to_string(image);
    texture.format = format;
    wanted_.push_back({image, false});
  }
  Wanted& wanted = wanted_[size_t(found->second)];
  wanted.has_levels = wanted.has_levels || has_levels;
  return found->second;
}

void Pictures::check() {
  std::set<std::string_view> looked_for;  // many images may name one file
  for (uint32_t i = 0; i < document_.images.size(); ++i) {
    const std::optional<std::string>& uri = document_.images[i].uri;
    if (first_of_.contains(i) || !uri || !looked_for.insert(*uri).second) continue;
    try {
      check_file(i);
    } catch (const Error& error) {
      lose(i, error);
    }
  }
  std::map<uint32_t, std::string_view> kinds;
  for (const Wanted& wanted : wanted_)
    if (const auto [kind, is_new] = kinds.try_emplace(wanted.image); is_new) try {
        kind->second = check_content(wanted.image);
      } catch (const Error& error) {
        lose(wanted.image, error);
      }
  check_media_types(kinds);
}

void Pictures::lose(uint32_t image, const Error& error) {
  faults_.pass(Fault::picture, place_of(image), error);
  lost_.insert(image);
}

std::vector<bool> Pictures::lost() const {
  std::vector<bool> lost;
  for (const Wanted& wanted : wanted_) lost.push_back(lost_.contains(wanted.image));
  return lost;
}

/// What a picture is. A decoder that may make no bytes reads the header and ends there.
std::string_view Pictures::check_content(uint32_t image) const {
  const std::string where = place_of(image);
  if (!decode_) throw Error(ErrorKind::bad_input, where, "this program reads no image files", "no textures");
  const Content read = content(image);
  check_magic(read.bytes, where);
  try {
    decode_(read.bytes, where, 0);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::limit) throw;
  }
  return picture_kind(read.bytes);
}

void Pictures::check_media_types(const std::map<uint32_t, std::string_view>& kinds) {
  std::string first;
  size_t others = 0;
  for (const auto& [image, first_image] : first_of_) {
    if (lost_.contains(first_image)) continue;
    const ImageSource& source = document_.images[image];
    if (!source.mime.empty() && !is_media_type(source.mime))
      faults_.pass(Fault::value, place_of(image) + "/mimeType", "the media type is neither image/png nor image/jpeg",
                   "one of these");
    const std::string_view kind = kinds.at(first_image), right = kind == "PNG" ? "image/png" : "image/jpeg";
    const std::string of_uri = source.uri ? std::string(media_type_of_uri(*source.uri)) : std::string();
    for (const std::string& type : {source.mime, of_uri}) {
      if (type == right || !is_media_type(type)) continue;
      if (first.empty())
        first = "the media type of " + pointer_to("images", image) + " is " + type + ", and its picture is " +
                std::string(kind) + ", which is read";
      else
        ++others;
      break;
    }
  }
  if (first.empty()) return;
  if (others > 0)
    first += "; so it is with " + std::to_string(others) + (others == 1 ? " other image" : " other images");
  scene_.notes.push_back(first);
}

void Pictures::decode_all(const std::function<void()>& meanwhile) {
  decode_some(0, std::min(kTogether, wanted_.size()), meanwhile);
  for (size_t first = kTogether; first < wanted_.size(); first += kTogether)
    decode_some(first, std::min(kTogether, wanted_.size() - first), [] {});
  parallel_for(int(wanted_.size()), 0, [&](int i) {
    const Wanted& wanted = wanted_[size_t(i)];
    if (wanted.has_levels && !lost_.contains(wanted.image)) build_mip_chain(scene_.textures[size_t(i)]);
  });
}

void Pictures::decode_some(size_t first, size_t count, const std::function<void()>& meanwhile) {
  std::vector<Task> tasks(count);
  for (size_t i = 0; i < count; ++i)
    if (const uint32_t image = wanted_[first + i].image; !lost_.contains(image)) tasks[i].content = content(image);
  // A chain of levels adds a third at most.
  const auto left = [this] { return (limits_.texture_bytes - std::min(limits_.texture_bytes, bytes_)) / 4 * 3; };
  const uint64_t share = left() / kTogether;
  parallel_for(int(count) + 1, 0, [&](int i) {
    if (i == 0) return meanwhile();  // what it throws ends the loop
    const size_t at = size_t(i) - 1;
    Task& task = tasks[at];
    if (lost_.contains(wanted_[first + at].image)) return;
    try {
      task.image = decode_(task.content.bytes, place_of(wanted_[first + at].image), share);
    } catch (const Error& error) {
      task.too_large = error.kind() == ErrorKind::limit;
      task.error = std::current_exception();
    } catch (...) {
      task.error = std::current_exception();
    }
  });
  for (size_t i = 0; i < count; ++i) {
    Task& task = tasks[i];
    const uint32_t image = wanted_[first + i].image;
    if (lost_.contains(image)) continue;
    try {
      if (task.too_large)
        task.image = decode_(task.content.bytes, place_of(image), left());
      else if (task.error)
        std::rethrow_exception(task.error);
    } catch (const Error& error) {
      lose(image, error);
      continue;
    }
    take(std::move(task.image), first + i);
  }
}

/// Makes a decoded picture the first level of a texture. Rows run from the top, where glTF has v = 0.
void Pictures::take(Image image, size_t index) {
  Texture& texture = scene_.textures[index];
  const Wanted& wanted = wanted_[index];
  const bool wide = image.format == Format::rgba16;  // 16 bits a channel, which only floats keep
  const CodeEncoding encoding = texture.format == TextureFormat::srgb8_a8 ? CodeEncoding::srgb : CodeEncoding::linear;
  if (wide) texture.format = TextureFormat::rgba32f;
  const uint64_t bytes =
      texture_bytes(image.width, image.height, texture.format, wanted.has_levels ? MipChain::whole : MipChain::none);
  bytes_ += bytes;
  if (bytes_ > limits_.texture_bytes)
    throw Error(ErrorKind::limit, place_of(wanted.image),
                "with this picture and its smaller levels the pictures are over the limit",
                within_limit(limits_.texture_bytes, "bytes in all", "--max-texture-memory"));
  require_memory(bytes, place_of(wanted.image), "the texture");
  if (wide) image.texels = float_texels_of_16_bits(image.texels, encoding);
  texture.levels = {{image.width, image.height, std::move(image.texels)}};
}

std::string Pictures::place_of(uint32_t image) const { return document_.file + ": " + pointer_to("images", image); }

/// The errors of content() for a picture that nothing reads. Of a file only the size is asked for.
void Pictures::check_file(uint32_t image) const {
  const std::string& uri = *document_.images[image].uri;
  const std::string where = place_of(image) + "/uri";
  if (is_data_uri(uri))
    data_of_uri(uri, where, limits_.file_bytes);
  else
    folder_.check(path_from_uri(uri, where, limits_.named_paths), limits_.file_bytes, where);
}

Pictures::Content Pictures::content(uint32_t image) const {
  const ImageSource& source = document_.images[image];
  const std::string where = place_of(image);
  Content out;
  if (source.view != kNone) {
    if (document_.views[source.view].stride != 0)
      faults_.pass(Fault::stride, where, "the view of a picture has a stride", "a view without one");
    out.bytes = buffers_.view(source.view);
    return out;
  }
  out.owned = is_data_uri(*source.uri) ? data_of_uri(*source.uri, where + "/uri", limits_.file_bytes).bytes
                                       : folder_.read(path_from_uri(*source.uri, where + "/uri", limits_.named_paths),
                                                      limits_.file_bytes, where + "/uri");
  out.bytes = out.owned;  // moving a vector leaves its elements where they are
  return out;
}

}  // namespace trueshade::gltf
