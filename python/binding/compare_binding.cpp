// Comparing: pictures from files or arrays, by criteria.
#include <bit>
#include <cmath>

#include "cli/compared_pictures.h"
#include "core/expansion.h"
#include "core/file_ending.h"
#include "core/half.h"
#include "core/image_files/picture_file.h"
#include "python/binding/bindings.h"

namespace trueshade::python {
namespace {

using compare::Criterion;
using compare::Measure;

constexpr std::string_view kArray = "numpy.ndarray";  ///< the kind of a picture that is no file

/// The channels of an image as a file of them would be read: R, G, B, A, or Y of one channel.
PictureFile picture_of(const Image& image, const std::string& name) {
  const FormatInfo layout = info(image.format);
  PictureFile picture;
  picture.path = name, picture.kind = kArray;
  const bool codes = layout.number_class == NumberClass::unorm;
  picture.color_space = codes ? ColorSpace::srgb : ColorSpace::linear;
  picture.color_source = codes ? "codes are taken for sRGB" : "floats are taken for linear light";
  ChannelFile& part = picture.parts.emplace_back();
  part.path = name, part.width = image.width, part.height = image.height;
  for (int c = 0; c < layout.channels; ++c) {
    Channel& channel = part.channels.emplace_back();
    channel.name = layout.channels == 1 ? "Y" : std::string(1, "RGBA"[c]);
    channel.kind = codes                                         ? ChannelKind::unorm
                   : layout.number_class == NumberClass::integer ? ChannelKind::integer
                                                                 : ChannelKind::floating;
    channel.bits = layout.bits[size_t(c)];
    channel.words.reserve(size_t(image.width) * size_t(image.height));
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const uint32_t code = image.code(x, y, c);
        const bool half = channel.kind == ChannelKind::floating && channel.bits == 16;
        channel.words.push_back(half ? std::bit_cast<uint32_t>(float_from_half(uint16_t(code))) : code);
      }
  }
  return picture;
}

struct Source {
  PictureFile picture;
  bool is_array;
  int channels;  ///< of an array
};

Source picture_from(const py::object& source, const std::string& name) {
  if (py::isinstance<py::array>(source)) {
    const py::array array = array_from(source, name);
    return {picture_of(image_of(array, name, {}, ImageUse::picture), "array"), true, channels_of(array)};
  }
  const std::string path = path_of(source);
  const py::gil_scoped_release release;
  return {read_any_picture(path, kMostExpansion), false, 0};
}

/// A window of so many pixels a side, and the share of them that may differ.
void ask_window(const std::optional<std::pair<int, double>>& window, double delta, compare::CompareRules& rules) {
  if (!window) return;
  const auto [side, share] = *window;
  if (side < kLeastWindowSide || side > kMostWindowSide || !std::has_single_bit(unsigned(side)) || !(share >= 0) ||
      !(share <= 1))
    throw bad_argument("window", "it is no side and share", "a side of 8, 16, 32, 64 or 128 and a share from 0 to 1");
  rules.criteria.push_back({Measure::window_share, share, delta, side});
}

/// Takes from an array's picture what the array does not have and the other picture neither: alpha, or colours of a
/// grey one.
void fit_channels(Source& array, const PictureFile& other) {
  if (!array.is_array || array.channels == 4 || other.parts.empty()) return;
  std::vector<Channel>& channels = array.picture.parts.front().channels;
  const size_t there = other.parts.front().channels.size();
  if (channels.size() != 4 || there == 4 || (there != 3 && there != 1)) return;
  channels.resize(there);
  if (there == 1) channels.front().name = other.parts.front().channels.front().name;
}

/// Greys become colours where a file has them; of two arrays each says itself which it is.
void check_both_have_colors(const Source& reference, const Source& test) {
  if (!reference.is_array || !test.is_array || (reference.channels == 1) == (test.channels == 1)) return;
  const auto told = [](int channels) {
    return channels == 1 ? std::string("no colours") : std::to_string(channels) + " channels";
  };
  throw bad_argument("test", "the array has " + told(test.channels) + ", and reference has " + told(reference.channels),
                     "two of shape (height, width), or two of (height, width, 3 or 4)");
}

py::dict values_of(const compare::PixelValues& pixel) {
  py::dict out, values;
  out["x"] = pixel.x, out["y"] = pixel.y;
  if (!pixel.part.empty()) out["part"] = pixel.part;
  for (const auto& value : pixel.values) values[py::str(value.channel)] = py::make_tuple(value.reference, value.test);
  out["values"] = values;
  return out;
}

py::dict dict_of(const compare::Comparison& c) {
  constexpr const char* kOutcomes[] = {"same", "within", "different", "mismatched"};
  py::dict out;
  out["pass"] = c.passes();
  out["outcome"] = kOutcomes[size_t(c.outcome)];
  py::list failures;
  for (const std::string& failure : c.failures) failures.append(in_words_of_python(failure));
  out["failures"] = failures, out["notes"] = c.notes, out["colors"] = c.colors;
  out["unequal_pixels"] = c.differences.unequal_pixels;
  out["left_out_pixels"] = c.differences.left_out;
  py::list windows;
  for (const compare::WorstWindow& worst : c.differences.windows) {
    py::dict row;
    row["side"] = worst.window.side, row["x"] = worst.window.x, row["y"] = worst.window.y;
    row["pixels_beyond"] = worst.window.found, row["share"] = worst.share;
    row["mean"] = worst.window.mean(), row["largest"] = worst.window.largest;
    windows.append(row);
  }
  out["windows"] = windows;
  out["not_finite_pixels"] = c.differences.not_finite_pixels;
  py::list channels, criteria;
  for (const auto& channel : c.differences.channels) {
    py::dict row;
    row["name"] = channel.name, row["unequal"] = channel.unequal, row["mean"] = channel.mean();
    row["rms"] = channel.rms(), row["largest"] = channel.largest, row["largest_ulp"] = channel.largest_ulp;
    row["psnr"] = channel.psnr();
    channels.append(row);
  }
  for (const compare::Judged& judged : c.criteria) {
    py::dict row;
    row["name"] = std::string(compare::name_of(judged.criterion.measure)), row["measured"] = judged.measured;
    row["bound"] = judged.criterion.bound, row["holds"] = judged.holds;
    criteria.append(row);
  }
  out["channels"] = channels, out["criteria"] = criteria;
  if (c.flip) out["flip_mean"] = c.flip->mean, out["flip_weighted_median"] = c.flip->weighted_median;
  if (c.first) out["first"] = values_of(*c.first);
  if (c.worst) out["worst"] = values_of(*c.worst);
  if (c.first_not_finite) out["first_not_finite"] = values_of(*c.first_not_finite);
  return out;
}

std::string quoted(const std::string& word) { return py::str(py::module_::import("shlex").attr("quote")(word)); }

/// The command that makes the same page of the same files; empty where there are none.
std::string command_of(const ComparedPictures& pictures, const std::optional<PictureFile>& mask,
                       const std::string& page) {
  const bool is_array = mask && mask->kind == kArray;
  if (is_array || pictures.reference.kind == kArray || pictures.test.kind == kArray) return {};
  return "trueshade compare " + quoted(pictures.reference.path) + ' ' + quoted(pictures.test.path) +
         (mask ? " --mask " + quoted(mask->path) : "") + " -o " + quoted(page);
}

py::dict compare_pictures(const py::object& reference, const py::object& test,
                          const std::optional<double>& max_difference, const std::optional<double>& max_ulp,
                          const std::optional<double>& pixels, const std::optional<double>& delta,
                          const std::optional<double>& psnr, const std::optional<double>& flip, bool allow_nonfinite,
                          const py::object& page, const std::optional<std::pair<int, double>>& window,
                          const py::object& mask, bool allow_mask) {
  compare::CompareRules rules;
  rules.allow_not_finite = allow_nonfinite;
  const auto ask = [&](Measure measure, const std::optional<double>& bound, double delta_of = 0.0) {
    if (!bound) return;
    if (!(*bound >= 0.0)) throw bad_argument("compare", "a bound is below 0 or NaN", "0 or more");
    rules.criteria.push_back({measure, *bound, delta_of});
  };
  if (pixels.has_value() && !delta.has_value())
    throw bad_argument("pixels", "pixels and delta go together", "give both, or neither");
  if (delta.has_value() && !pixels.has_value() && !window.has_value())
    throw bad_argument("delta", "it is what pixels and window let pass", "give one of them, too");
  ask(Measure::largest_difference, max_difference);
  ask(Measure::largest_ulp, max_ulp);
  ask(Measure::pixels_beyond, pixels, delta.value_or(0.0));
  ask_window(window, delta.value_or(0.0), rules);
  ask(Measure::psnr, psnr);
  ask(Measure::flip_mean, flip);
  Source a = picture_from(reference, "reference"), b = picture_from(test, "test");
  check_both_have_colors(a, b);
  fit_channels(a, b.picture), fit_channels(b, a.picture);
  const std::string page_path = page.is_none() ? std::string() : path_of(page);
  if (!page_path.empty() && !has_ending(page_path, ".html"))
    throw bad_argument("page", "'" + page_path + "' does not end like a page", "end the name in .html");
  if (!page_path.empty()) check_writable(page_path);
  ComparedPictures pictures;
  pictures.reference = std::move(a.picture), pictures.test = std::move(b.picture);
  const std::optional<PictureFile> mask_file = mask_picture(mask);
  const std::string command = command_of(pictures, mask_file, page_path);
  if (mask_file) {
    const compare::MaskRules left_out{mask_file->path, {}, "pass allow_mask=True", allow_mask};
    rules.mask = compare::mask_of_pair(left_out, &*mask_file, pictures.reference, pictures.test);
    pictures.mask = rules.mask, pictures.left_out_by = left_out.text();
  }
  {
    const py::gil_scoped_release release;
    pictures.comparison = compare::compared(pictures.reference, pictures.test, rules);
    if (!page_path.empty()) {
      const std::string html = comparison_page(pictures, command);
      write_file(page_path, {reinterpret_cast<const uint8_t*>(html.data()), html.size()});
    }
  }
  py::dict out = dict_of(pictures.comparison);
  out["verdict"] = verdict_line(pictures);
  return out;
}

}  // namespace

std::optional<PictureFile> mask_picture(const py::object& mask) {
  if (mask.is_none()) return std::nullopt;
  if (py::isinstance<py::str>(mask) || py::isinstance<py::bytes>(mask) || py::hasattr(mask, "__fspath__"))
    return picture_from(mask, "mask").picture;
  const py::array array = array_from(mask, "mask");
  PictureFile picture =
      picture_from(array.dtype().kind() == 'b' ? py::object(array.attr("view")("uint8")) : py::object(array), "mask")
          .picture;
  picture.path = "mask";
  return picture;
}

void add_compare(py::module_& module) {
  using namespace py::literals;
  module.def("compare", &compare_pictures, doc_of("compare"), "reference"_a, "test"_a, py::kw_only(),
             "max_difference"_a = py::none(), "max_ulp"_a = py::none(), "pixels"_a = py::none(), "delta"_a = py::none(),
             "psnr"_a = py::none(), "flip"_a = py::none(), "allow_nonfinite"_a = false, "page"_a = py::none(),
             "window"_a = py::none(), "mask"_a = py::none(), "allow_mask"_a = false);
}

}  // namespace trueshade::python
