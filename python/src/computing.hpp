#pragma once

#include <functional>
#include <pybind11/pybind11.h>

#include "proofmass/core/progress.hpp"

namespace proofmass::python {

/// Does the work on a thread of its own, without the interpreter's lock, while this thread looks
/// for signals and hands progress to `progress`, a callable of (stage, fraction) or None. Ctrl-C,
/// or an exception of the callable, ends the work where it next reports progress, and is raised
/// here; so is what the work throws.
void compute(const pybind11::object& progress, const std::function<void(const Progress&)>& work);

}  // namespace proofmass::python
