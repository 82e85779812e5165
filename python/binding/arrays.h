#pragma once
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/image.h"

namespace trueshade::python {

namespace py = pybind11;

/// Error(bad_input) of an argument, in the house's form.
Error bad_argument(const std::string& name, const std::string& reason, const std::string& remedy);

/// The name of an object's type, as Python has it.
std::string type_name(const py::handle& value);

/// A NumPy array. Error(bad_input) for what is none, such as a list, and for masked arrays, whose mask would be lost.
py::array array_from(const py::handle& value, const std::string& name);

/// The columns of an array of float32 of shape (count, columns), each as a stream. Error(bad_input) for another type or
/// shape, for an array that is not C-contiguous, for values that are not finite; Error(limit) for more than 4 GiB.
std::vector<std::vector<float>> columns_of(const py::handle& array, const std::string& name, size_t columns);

/// Whole numbers of shape (count, columns), of uint32 or of int32, int64 and uint64 within its range, row by row.
std::vector<uint32_t> indices_of(const py::handle& array, const std::string& name, size_t columns);

/// `n` numbers of a sequence or an array, as doubles. Error(bad_input) for another count and for NaN.
std::vector<double> numbers_of(const py::handle& values, const std::string& name, size_t n);

/// The number, if it is in [low, high]. Error(bad_input) for others and for NaN.
double number_within(double value, const std::string& name, double low, double high);

/// Matrices of shape (rows, 4), or (count, rows, 4): float32 or float64, finite, in the order of rows.
struct Matrices {
  size_t count, rows;
  std::vector<double> elements;
  double at(size_t matrix, size_t row, size_t column) const { return elements[(matrix * rows + row) * 4 + column]; }
};
Matrices matrices_of(const py::handle& value, const std::string& name, int dimensions);

/// An image as an array of shape (height, width, channels), or (height, width) of one channel and of packed words, that
/// shares the image's memory and keeps it alive. Not writeable.
py::array array_of(const std::shared_ptr<const Image>& image);

/// How an array becomes an image: as it is, or as a picture, which may also be grey or without alpha, of uint8 or
/// uint16. Such a picture has R = G = B, and the alpha 1.
enum class ImageUse { stored, picture };

/// The image of an array: of uint8 rgba8, of uint16 rgba16, of float16 rgba16f or rgb16f, of float32 rgba32f, rgb32f,
/// rg32f or, without channels, d32f, of uint32 r32ui; or of `format`, where that is not empty, whose type the array
/// must have. A copy. Error(bad_input) for other shapes and types.
Image image_of(const py::handle& array, const std::string& name, const std::string& format = {},
               ImageUse use = ImageUse::stored);

/// How many channels the last axis has; 1 without one, 0 for arrays that are no image.
int channels_of(const py::array& array);

}  // namespace trueshade::python
