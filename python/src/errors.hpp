#pragma once

#include <optional>
#include <pybind11/pybind11.h>
#include <string>
#include <utility>

#include "proofmass/core/result.hpp"

// Errors of the library as exceptions of the module.
namespace proofmass::python {

/// Creates pm.Error and its subclasses, and translates exceptions of the library and the verbs.
void add_errors(pybind11::module_& module);

/// The value; throws the exception for the error's code otherwise.
template <class T>
[[nodiscard]] T need(Result<T> result) {
  return std::move(result).value();  // throws ResultError, translated by add_errors()
}

/// Throws pm.ArgumentError.
[[noreturn]] void refuse(const std::string& message);

}  // namespace proofmass::python
