#pragma once

#include <memory>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <string>
#include <utility>
#include <vector>

#include "proofmass/core/recording.hpp"

namespace proofmass::python {

/// A recording shared by Python objects; arrays taken from it are views of its memory.
using SharedRecording = std::shared_ptr<const Recording>;

/// Wrapper, since a Python class cannot hold a pointer to const.
struct Handle {
  SharedRecording recording;
};

void add_recording(pybind11::module_& module);

[[nodiscard]] SharedRecording shared(Recording recording);

/// A copy; the recording itself if it is temporary and not shared.
[[nodiscard]] Recording taken(const Handle& handle, bool is_temporary);

/// The notes, each with "info", "warning" or "bad".
[[nodiscard]] std::vector<std::pair<std::string, std::string>> words_of(
    const std::vector<Note>& notes);

/// A read-only array view of memory owned by `owner`.
template <class Owner>
[[nodiscard]] pybind11::array_t<double> view_of(const double* values,
                                                std::vector<pybind11::ssize_t> shape,
                                                std::shared_ptr<Owner> owner) {
  auto* held = new std::shared_ptr<Owner>(std::move(owner));
  const pybind11::capsule base(
      held, [](void* pointer) { delete static_cast<std::shared_ptr<Owner>*>(pointer); });
  pybind11::array_t<double> array(std::move(shape), values, base);
  array.attr("flags").attr("writeable") = false;
  return array;
}

}  // namespace proofmass::python
