#pragma once

#include <functional>
#include <pybind11/pybind11.h>

#include "proofmass/core/progress.hpp"

namespace proofmass::python {

/// Runs the computation on a separate thread without the interpreter's lock, while this thread
/// checks for signals and passes progress to `progress`, a callable of (stage, fraction) or None.
/// Ctrl-C or an exception of the callable cancels the computation at its next progress report and
/// is raised here, as are exceptions of the computation.
void compute(const pybind11::object& progress, const std::function<void(const Progress&)>& work);

}  // namespace proofmass::python
