#pragma once
#include <optional>

#include "core/image_files/picture_file.h"
#include "python/binding/arrays.h"

namespace trueshade::python {

// Each adds its part of the module.
void add_errors(py::module_& module);
void add_scene(py::module_& module);
void add_pipeline(py::module_& module);
void add_frame(py::module_& module);
void add_judge(py::module_& module);
void add_compare(py::module_& module);
void add_files(py::module_& module);

/// What python/trueshade/__init__.pyi says of a name, such as `Scene.add_mesh`, with its signature before it as
/// Python's `inspect` reads it. Made at build time by python/make_docs.py, so that it is written once. Error for a name
/// without.
const char* doc_of(std::string_view name);

/// The picture that a mask is, a file or an array, whose bools become codes; nothing of None.
std::optional<PictureFile> mask_picture(const py::object& mask);

/// A text of the library with Python's arguments where it names options of the command: `strategy` for `--strategy`.
std::string in_words_of_python(std::string text);

/// A dict of JSON text, and the text of an object that JSON has.
py::object from_json(const std::string& text);
std::string to_json(const py::handle& value);

/// The path of a str, bytes or os.PathLike, as the file system has it.
std::string path_of(const py::handle& path);

}  // namespace trueshade::python
