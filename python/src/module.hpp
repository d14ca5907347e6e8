#pragma once

#include <pybind11/pybind11.h>

// Parts of the module, each in its own source.
namespace proofmass::python {

void add_allan(pybind11::module_& module);
void add_kalman(pybind11::module_& module);
void add_live(pybind11::module_& module);
void add_sensor(pybind11::module_& module);
void add_verbs(pybind11::module_& module);

}  // namespace proofmass::python
