// The extension module: its parts, and what errors are in Python.
#include <new>
#include <string_view>
#include <utility>

#include "cli/version.h"
#include "python/binding/bindings.h"

namespace trueshade::python {

namespace {

/// What errors name by an option of the command and Python by an argument.
constexpr std::pair<std::string_view, std::string_view> kArgumentOfOption[] = {
    {"--strategy", "strategy"},
    {"--light-parameter NAME=VALUE", "light_parameters={'NAME': VALUE}"},
    {"--light-parameter", "light_parameters"},
    {"--light-shader FILE", "light_shader=FILE"},
    {"--view", "values['view']"},
    {"--pixel", "x, y"},
    {"--allow-nonfinite", "allow_nonfinite=True"},
    {"--lenient", "lenient=True"},
    {"--trust-paths", "trust_paths=True"}};

}  // namespace

std::string in_words_of_python(std::string text) {
  for (const auto& [option, argument] : kArgumentOfOption)
    for (size_t at = 0; (at = text.find(option, at)) != std::string::npos; at += argument.size())
      text.replace(at, option.size(), argument);
  return text;
}

py::object from_json(const std::string& text) { return py::module_::import("json").attr("loads")(text); }

std::string to_json(const py::handle& value) {
  try {
    return py::str(py::module_::import("json").attr("dumps")(value));
  } catch (py::error_already_set& error) {
    if (!error.matches(PyExc_TypeError) && !error.matches(PyExc_ValueError)) throw;
    throw bad_argument("values", "it is nothing that JSON has", "pass a dict of numbers, strings, lists and dicts");
  }
}

void add_errors(py::module_& module) {
  static py::object error_type = py::reinterpret_steal<py::object>(
      PyErr_NewExceptionWithDoc("trueshade.Error", doc_of("Error"), PyExc_ValueError, nullptr));
  error_type.attr("exit_code") = int(ErrorKind::bad_input);  // of each error its own
  module.attr("Error") = error_type;
  py::register_exception_translator([](std::exception_ptr pointer) {
    try {
      if (pointer) std::rethrow_exception(pointer);
    } catch (const Error& error) {
      if (error.kind() == ErrorKind::out_of_memory) return PyErr_SetString(PyExc_MemoryError, error.what());
      py::object instance = error_type(in_words_of_python(error.what()));
      instance.attr("exit_code") = int(error.kind());
      PyErr_SetObject(error_type.ptr(), instance.ptr());
    } catch (const std::bad_alloc&) {
      PyErr_SetString(PyExc_MemoryError, "out of memory");
    }
  });
}

}  // namespace trueshade::python

PYBIND11_MODULE(_trueshade, module) {
  using namespace trueshade::python;
  module.doc() = "Bindings of Trueshade; import `trueshade` instead.";
  py::options options;
  options.disable_function_signatures();  // doc_of() begins with them, as `inspect` reads them
  const py::object name = module.attr("__name__");
  module.attr("__name__") = "trueshade";  // what classes and functions say they are from
  add_errors(module);
  add_scene(module);
  add_pipeline(module);
  add_frame(module);
  add_judge(module);
  add_compare(module);
  add_files(module);
  module.attr("__name__") = name;
  module.attr("__version__") = trueshade::kVersion;
}
