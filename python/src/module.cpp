#include "module.hpp"

#include "errors.hpp"
#include "proofmass/core/version.hpp"
#include "recording.hpp"

PYBIND11_MODULE(_core, module) {
  using namespace proofmass;
  module.doc() = "The library as proofmass/*.py use it.";
  module.attr("version") = version();
  python::add_errors(module);
  python::add_recording(module);
  python::add_verbs(module);
  python::add_allan(module);
  python::add_kalman(module);
  python::add_live(module);
  python::add_sensor(module);
}
