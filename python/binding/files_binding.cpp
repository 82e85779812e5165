// Pictures as files.
#include "core/image_files/image_io.h"
#include "python/binding/bindings.h"

namespace trueshade::python {
namespace {

void write(const py::object& path, const py::object& image, const std::string& format, const py::dict& planes) {
  const std::string to = path_of(path);
  const Image color = image_of(image, "image", format, ImageUse::picture);
  std::vector<NamedImage> named;
  for (const auto& [name, array] : planes) {
    const std::string key = py::str(name);
    named.push_back({key, image_of(array, key)});
    if (named.back().image.width != color.width || named.back().image.height != color.height)
      throw bad_argument(key, "it has another size than the image", "planes of the image's size");
  }
  const py::gil_scoped_release release;
  write_image(to, color, named, {}, {});
}

py::dict read(const py::object& path) {
  const std::string from = path_of(path);
  std::vector<NamedImage> planes;
  {
    const py::gil_scoped_release release;
    planes = read_planes(from);
  }
  py::dict out;
  for (NamedImage& plane : planes)
    out[py::str(plane.name)] = array_of(std::make_shared<const Image>(std::move(plane.image)));
  return out;
}

}  // namespace

std::string path_of(const py::handle& path) { return py::bytes(py::module_::import("os").attr("fsencode")(path)); }

void add_files(py::module_& module) {
  using namespace py::literals;
  module.def("write_image", &write, doc_of("write_image"), "path"_a, "image"_a, "format"_a = "", py::kw_only(),
             "planes"_a = py::dict());
  module.def("read_planes", &read, doc_of("read_planes"), "path"_a);
}

}  // namespace trueshade::python
