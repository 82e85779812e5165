// The extension module: its parts, and what errors are in Python.
#include <new>

#include "python/binding/bindings.h"

namespace trueshade::python {

py::object from_json(const std::string& text) { return py::module_::import("json").attr("loads")(text); }

void add_errors(py::module_& module) {
  static py::object error_type = py::reinterpret_steal<py::object>(
      PyErr_NewExceptionWithDoc("trueshade.Error",
                                "What is wrong with an input, in one line: WHERE: REASON (REMEDY). `exit_code` is the "
                                "one that the command ends with for the same fault.",
                                PyExc_ValueError, nullptr));
  module.attr("Error") = error_type;
  py::register_exception_translator([](std::exception_ptr pointer) {
    try {
      if (pointer) std::rethrow_exception(pointer);
    } catch (const Error& error) {
      if (error.kind() == ErrorKind::out_of_memory) return PyErr_SetString(PyExc_MemoryError, error.what());
      py::object instance = error_type(error.what());
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
  add_errors(module);
  add_scene(module);
  add_pipeline(module);
  add_frame(module);
  add_judge(module);
  add_compare(module);
}
