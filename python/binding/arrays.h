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

/// The columns of an array of float32 of shape (count, columns), each as a stream. Error(bad_input) for another type or
/// shape, for an array that is not C-contiguous, and for values that are not finite.
std::vector<std::vector<float>> columns_of(const py::array& array, const std::string& name, size_t columns);

/// Whole numbers of shape (count, columns), of uint32 or of int32 and int64 that are none below 0, row by row.
std::vector<uint32_t> indices_of(const py::array& array, const std::string& name, size_t columns);

/// `n` numbers of a sequence or an array, as doubles. Error(bad_input) for another count and for NaN.
std::vector<double> numbers_of(const py::handle& values, const std::string& name, size_t n);

/// An image as an array of shape (height, width, channels), or (height, width) of one channel and of packed words, that
/// shares the image's memory and keeps it alive. Not writeable.
py::array array_of(const std::shared_ptr<const Image>& image);

/// The image of an array: of uint8 rgba8, of uint16 rgba16, of float16 rgba16f or rgb16f, of float32 rgba32f, rgb32f,
/// rg32f or, without channels, d32f, of uint32 r32ui; or of `format`, where that is not empty, whose type the array
/// must have. A copy. Error(bad_input) for other shapes and types.
Image image_of(const py::array& array, const std::string& name, const std::string& format = {});

}  // namespace trueshade::python
