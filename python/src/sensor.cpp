#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <string>

#include "errors.hpp"
#include "module.hpp"
#include "proofmass/sensor/sensor_file.hpp"

namespace py = pybind11;

namespace proofmass::python {

void add_sensor(py::module_& module) {
  module.def("sensor_text_of_file", [](const std::string& path) {
    return sensor::format_sensor_file(need(sensor::read_sensor_file(path)).model);
  });
  module.def("sensor_text", [](const std::string& text, const std::string& name) {
    return sensor::format_sensor_file(need(sensor::parse_sensor_file(text, name)).model);
  });
  module.def("write_sensor", [](const std::string& text, const std::string& path) {
    const auto file = need(sensor::parse_sensor_file(text, path));
    (void)need(sensor::write_sensor_file(file.model, path));
  });
}

}  // namespace proofmass::python
