#include "python/binding/arrays.h"

#include <cmath>
#include <cstring>
#include <optional>

namespace trueshade::python {
namespace {

std::string shape_text(const py::array& array) {
  std::string text = "(";
  for (py::ssize_t i = 0; i < array.ndim(); ++i) text += (i == 0 ? "" : ", ") + std::to_string(array.shape(i));
  return text + ")";
}

std::string type_text(const py::array& array) {
  const py::str text(array.dtype());
  return bool(py::bool_(array.dtype().attr("isnative"))) ? std::string(text) : std::string(text) + " of swapped bytes";
}

constexpr uint64_t kMostBytes = uint64_t(4) << 30;  // as SceneLimits has it for what is read from files

void check_bytes(const py::array& array, const std::string& name) {
  if (uint64_t(array.size()) * uint64_t(array.itemsize()) > kMostBytes)
    throw Error(ErrorKind::limit, name, "the array of shape " + shape_text(array) + " is over 4 GiB", "less of it");
}

template <class T>
bool has_type(const py::array& array) {
  return py::isinstance<py::array_t<T>>(array);
}

void check_contiguous(const py::array& array, const std::string& name) {
  if ((array.flags() & py::array::c_style) == 0)
    throw bad_argument(name, "the array is not C-contiguous", "pass numpy.ascontiguousarray(array)");
}

void check_columns(const py::array& array, const std::string& name, size_t columns) {
  if (array.ndim() != 2 || size_t(array.shape(1)) != columns)
    throw bad_argument(name, "the array has the shape " + shape_text(array),
                       "pass one of shape (count, " + std::to_string(columns) + ")");
}

template <class T>
std::vector<uint32_t> whole_numbers(const py::array& array, const std::string& name) {
  const T* const values = static_cast<const T*>(array.data());
  std::vector<uint32_t> out(size_t(array.size()));
  for (size_t i = 0; i < out.size(); ++i) {
    if (values[i] < T(0) || uint64_t(values[i]) > UINT32_MAX)
      throw bad_argument(name, "element " + std::to_string(i) + " is " + std::to_string(values[i]),
                         "whole numbers from 0 to 4294967295");
    out[i] = uint32_t(values[i]);
  }
  return out;
}

/// NumPy's name of a half.
py::dtype half_type() { return py::dtype("float16"); }

py::dtype type_of(const FormatInfo& layout) {
  if (layout.packed()) return py::dtype::of<uint32_t>();
  if (layout.number_class == NumberClass::integer) return py::dtype::of<uint32_t>();
  if (layout.number_class == NumberClass::floating)
    return layout.bytes_per_channel == 4 ? py::dtype::of<float>() : half_type();
  return layout.bytes_per_channel == 1   ? py::dtype::of<uint8_t>()
         : layout.bytes_per_channel == 2 ? py::dtype::of<uint16_t>()
                                         : py::dtype::of<uint32_t>();
}

int channels_of_array(const FormatInfo& layout) { return layout.packed() ? 1 : layout.channels; }

bool has_type_of(const py::array& array, const FormatInfo& layout) {
  return py::bool_(array.dtype().attr("__eq__")(type_of(layout)));
}

/// What to do about an array of that type, which no image has.
std::string image_remedy(const py::array& array) {
  const std::string kind = py::str(array.dtype().attr("kind"));
  if (kind == "f" && array.itemsize() != 8 && array.itemsize() != 16)
    return bool(py::bool_(array.dtype().attr("isnative"))) ? "pass (height, width, 3 or 4)"
                                                           : "pass array.astype(array.dtype.newbyteorder('='))";
  if (kind == "f") return "pass array.astype(numpy.float32)";
  if (kind == "b") return "pass array.astype(numpy.uint8) * 255";
  return "pass (height, width, 4) of uint8, uint16, float16 or float32, or name its format";
}

Format format_of(const py::array& array, const std::string& name, const std::string& format) {
  if (!format.empty()) {
    if (const auto known = format_from_name(format)) return *known;
    throw bad_argument(name, "there is no format '" + format + "'", "one that `trueshade list` names");
  }
  for (const Format known : {Format::rgba8, Format::rgba16, Format::rgba16f, Format::rgb16f, Format::rgba32f,
                             Format::rgb32f, Format::rg32f, Format::d32f, Format::r32ui})
    if (has_type_of(array, info(known)) && channels_of(array) == channels_of_array(info(known))) return known;
  throw bad_argument(name, "an array of " + type_text(array) + " with the shape " + shape_text(array) + " is no image",
                     image_remedy(array));
}

/// A picture of codes with one or three channels as one of four. Nothing of other arrays.
std::optional<py::array> with_all_channels(const py::array& array) {
  const int channels = channels_of(array);
  const std::string kind = py::str(array.dtype().attr("kind"));
  if ((channels != 1 && channels != 3) || kind != "u" || array.itemsize() > 2) return std::nullopt;
  const py::module_ numpy = py::module_::import("numpy");
  const py::object planes =
      array.ndim() == 3 ? py::object(array) : py::object(array.attr("reshape")(array.shape(0), array.shape(1), 1));
  const py::object grey = channels == 3 ? planes : numpy.attr("repeat")(planes, 3, 2);
  const py::object alpha = numpy.attr("full")(py::make_tuple(array.shape(0), array.shape(1), 1),
                                              array.itemsize() == 1 ? 255 : 65535, array.dtype());
  return py::array(numpy.attr("concatenate")(py::make_tuple(grey, alpha), 2));
}

}  // namespace

Error bad_argument(const std::string& name, const std::string& reason, const std::string& remedy) {
  return {ErrorKind::bad_input, name, reason, remedy};
}

std::string type_name(const py::handle& value) { return py::str(py::type::handle_of(value).attr("__name__")); }

py::array array_from(const py::handle& value, const std::string& name) {
  if (!py::isinstance<py::array>(value))
    throw bad_argument(
        name, "it is no NumPy array but of the type " + std::string(py::str(py::type::of(value).attr("__name__"))),
        "pass numpy.asarray(values, numpy.float32), or another type that it has");
  if (py::hasattr(value, "mask")) throw bad_argument(name, "the array is masked", "pass array.filled(value)");
  return py::reinterpret_borrow<py::array>(value);
}

int channels_of(const py::array& array) {
  return array.ndim() == 2 ? 1 : array.ndim() == 3 && array.shape(2) < 5 ? int(array.shape(2)) : 0;
}

std::vector<std::vector<float>> columns_of(const py::handle& value, const std::string& name, size_t columns) {
  const py::array array = array_from(value, name);
  if (!has_type<float>(array))
    throw bad_argument(name, "the array holds " + type_text(array), "pass array.astype(numpy.float32)");
  check_columns(array, name, columns);
  check_contiguous(array, name);
  check_bytes(array, name);
  const float* const values = static_cast<const float*>(array.data());
  const size_t count = size_t(array.shape(0));
  std::vector<std::vector<float>> out(columns, std::vector<float>(count));
  for (size_t i = 0; i < count; ++i)
    for (size_t c = 0; c < columns; ++c) {
      const float value = values[i * columns + c];
      if (!std::isfinite(value))
        throw bad_argument(name, "element [" + std::to_string(i) + ", " + std::to_string(c) + "] is not finite",
                           "finite numbers");
      out[c][i] = value;
    }
  return out;
}

std::vector<uint32_t> indices_of(const py::handle& value, const std::string& name, size_t columns) {
  const py::array array = array_from(value, name);
  check_columns(array, name, columns);
  check_contiguous(array, name);
  check_bytes(array, name);
  if (has_type<uint32_t>(array)) return whole_numbers<uint32_t>(array, name);
  if (has_type<int32_t>(array)) return whole_numbers<int32_t>(array, name);
  if (has_type<int64_t>(array)) return whole_numbers<int64_t>(array, name);
  if (has_type<uint64_t>(array)) return whole_numbers<uint64_t>(array, name);
  throw bad_argument(name, "the array holds " + type_text(array), "pass array.astype(numpy.uint32)");
}

std::vector<double> numbers_of(const py::handle& values, const std::string& name, size_t n) {
  std::vector<double> out;
  try {
    for (const py::handle& value : py::iter(values)) out.push_back(value.cast<double>());
  } catch (const py::cast_error&) {
    throw bad_argument(name, "it holds what is no number", "pass " + std::to_string(n) + " numbers");
  } catch (py::error_already_set& error) {
    if (!error.matches(PyExc_TypeError)) throw;
    throw bad_argument(name, "it is no sequence", "pass " + std::to_string(n) + " numbers");
  }
  if (out.size() != n)
    throw bad_argument(name, "it has " + std::to_string(out.size()) + " numbers", "pass " + std::to_string(n));
  for (const double value : out)
    if (std::isnan(value)) throw bad_argument(name, "a number is NaN", "pass numbers");
  return out;
}

double number_within(double value, const std::string& name, double low, double high) {
  if (value >= low && value <= high) return value;
  const auto text = [](double number) { return std::string(py::str(py::float_(number))); };
  throw bad_argument(name, "it is " + text(value), "a number from " + text(low) + " to " + text(high));
}

Matrices matrices_of(const py::handle& value, const std::string& name, int dimensions) {
  const std::string wanted = dimensions == 3 ? "(count, 4, 4) or (count, 3, 4)" : "(4, 4) or (3, 4)";
  py::array array;
  try {
    array = py::isinstance<py::array>(value) ? array_from(value, name)
                                             : py::array(py::module_::import("numpy").attr("asarray")(value));
  } catch (py::error_already_set& error) {
    if (!error.matches(PyExc_ValueError)) throw;  // rows of different lengths
    throw bad_argument(name, "it is no matrix", "pass one of shape " + wanted);
  }
  const py::ssize_t n = array.ndim();
  if (n != dimensions || array.shape(n - 1) != 4 || (array.shape(n - 2) != 4 && array.shape(n - 2) != 3))
    throw bad_argument(name, "it has the shape " + shape_text(array), "pass " + wanted);
  if (std::string(py::str(array.dtype().attr("kind"))).find_first_of("fiu") == std::string::npos)
    throw bad_argument(name, "it holds " + type_text(array), "pass numbers");
  check_bytes(array, name);
  const py::array_t<double, py::array::c_style | py::array::forcecast> numbers(array);
  Matrices out{size_t(n == 3 ? array.shape(0) : 1), size_t(array.shape(n - 2)), {}};
  out.elements.assign(numbers.data(), numbers.data() + numbers.size());
  for (const double element : out.elements)
    if (!std::isfinite(element)) throw bad_argument(name, "an element is not finite", "finite numbers");
  return out;
}

py::array array_of(const std::shared_ptr<const Image>& image) {
  const FormatInfo layout = info(image->format);
  const int channels = channels_of_array(layout);
  std::vector<py::ssize_t> shape = {image->height, image->width};
  if (channels > 1) shape.push_back(channels);
  auto* const owner = new std::shared_ptr<const Image>(image);
  const py::capsule keeps(owner, [](void* p) { delete static_cast<std::shared_ptr<const Image>*>(p); });
  py::array array(type_of(layout), shape, image->texels.data(), keeps);
  array.attr("flags").attr("writeable") = false;
  return array;
}

Image image_of(const py::handle& value, const std::string& name, const std::string& format, ImageUse use) {
  py::array array = array_from(value, name);
  if (use == ImageUse::picture && format.empty())
    if (std::optional<py::array> whole = with_all_channels(array)) array = std::move(*whole);
  const Format wanted = format_of(array, name, format);
  const FormatInfo layout = info(wanted);
  if (!has_type_of(array, layout) || channels_of(array) != channels_of_array(layout))
    throw bad_argument(name,
                       "an array of " + type_text(array) + " with the shape " + shape_text(array) + " is no " +
                           std::string(layout.name),
                       "pass " + std::string(py::str(type_of(layout))) + " with " +
                           std::to_string(channels_of_array(layout)) + " channels");
  if (array.shape(0) < 1 || array.shape(1) < 1 || array.shape(0) > 65536 || array.shape(1) > 65536)
    throw bad_argument(name, "the array has the shape " + shape_text(array), "1 to 65536 pixels a side");
  check_contiguous(array, name);
  Image image(int(array.shape(1)), int(array.shape(0)), wanted);
  std::memcpy(image.texels.data(), array.data(), image.texels.size());
  return image;
}

}  // namespace trueshade::python
