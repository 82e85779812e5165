#include "python/binding/arrays.h"

#include <cmath>
#include <cstring>

namespace trueshade::python {
namespace {

std::string shape_text(const py::array& array) {
  std::string text = "(";
  for (py::ssize_t i = 0; i < array.ndim(); ++i) text += (i == 0 ? "" : ", ") + std::to_string(array.shape(i));
  return text + ")";
}

std::string type_text(const py::array& array) { return py::str(array.dtype()); }

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

Format format_of(const py::array& array, const std::string& name, const std::string& format) {
  if (!format.empty()) {
    if (const auto known = format_from_name(format)) return *known;
    throw bad_argument(name, "there is no format '" + format + "'", "one that `trueshade list` names");
  }
  const py::ssize_t channels = array.ndim() == 2 ? 1 : array.ndim() == 3 ? array.shape(2) : 0;
  for (const Format known : {Format::rgba8, Format::rgba16, Format::rgba16f, Format::rgb16f, Format::rgba32f,
                             Format::rgb32f, Format::rg32f, Format::d32f, Format::r32ui})
    if (array.dtype().is(type_of(info(known))) || py::bool_(array.dtype().attr("__eq__")(type_of(info(known)))))
      if (channels == channels_of_array(info(known))) return known;
  throw bad_argument(name, "an array of " + type_text(array) + " with the shape " + shape_text(array) + " is no image",
                     "pass (height, width, 4) of uint8, uint16, float16 or float32, or name its format");
}

}  // namespace

Error bad_argument(const std::string& name, const std::string& reason, const std::string& remedy) {
  return {ErrorKind::bad_input, name, reason, remedy};
}

std::vector<std::vector<float>> columns_of(const py::array& array, const std::string& name, size_t columns) {
  if (!has_type<float>(array))
    throw bad_argument(name, "the array holds " + type_text(array), "pass array.astype(numpy.float32)");
  check_columns(array, name, columns);
  check_contiguous(array, name);
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

std::vector<uint32_t> indices_of(const py::array& array, const std::string& name, size_t columns) {
  check_columns(array, name, columns);
  check_contiguous(array, name);
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

Image image_of(const py::array& array, const std::string& name, const std::string& format) {
  const Format wanted = format_of(array, name, format);
  const FormatInfo layout = info(wanted);
  const py::ssize_t channels = array.ndim() == 2 ? 1 : array.ndim() == 3 ? array.shape(2) : 0;
  const bool same_type = py::bool_(array.dtype().attr("__eq__")(type_of(layout)));
  if (!same_type || channels != channels_of_array(layout))
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
