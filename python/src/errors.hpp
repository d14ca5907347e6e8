#pragma once

#include <optional>
#include <pybind11/pybind11.h>
#include <string>
#include <utility>

#include "proofmass/core/result.hpp"

// Failures of the library as exceptions of the module.
namespace proofmass::python {

/// Makes pm.Error and its subclasses, and translates what the library and the verbs throw.
void add_errors(pybind11::module_& module);

/// The value, or the exception that the error's code stands for.
template <class T>
[[nodiscard]] T need(Result<T> result) {
  return std::move(result).value();  // throws ResultError, which add_errors() translates
}

/// As an exception of pm.ArgumentError.
[[noreturn]] void refuse(const std::string& message);

}  // namespace proofmass::python
