#include "errors.hpp"

#include "cli/exit_status.hpp"
#include "proofmass/report/wording.hpp"

namespace py = pybind11;

namespace proofmass::python {
namespace {

// Exceptions of the module, created once and kept for the lifetime of the interpreter.
struct Exceptions {
  PyObject *error = nullptr, *argument = nullptr, *file = nullptr, *data = nullptr;
};
Exceptions exceptions;

PyObject* made(py::module_& module, const char* name, const char* doc, const py::tuple& bases) {
  const std::string full = std::string("proofmass.") + name;
  PyObject* type = PyErr_NewExceptionWithDoc(full.c_str(), doc, bases.ptr(), nullptr);
  if (type == nullptr) throw py::error_already_set();
  module.add_object(name, py::reinterpret_borrow<py::object>(type));
  return type;
}

PyObject* type_of(Errc code) {
  switch (code) {
    case Errc::invalid_argument:
      return exceptions.argument;
    case Errc::unwritable:
    case Errc::unreadable:
    case Errc::corrupt:
    case Errc::unsupported:
    case Errc::device:
      return exceptions.file;
    case Errc::too_few_samples:
    case Errc::not_finite:
    case Errc::not_positive_definite:
    case Errc::not_observable:
      break;
  }
  return exceptions.data;
}

PyObject* type_of(const app::Failure& failure) {
  if (failure.code()) return type_of(*failure.code());
  if (failure.status() == app::usage) return exceptions.argument;
  if (failure.status() == app::bad_input || failure.status() == app::bad_data)
    return exceptions.data;
  return failure.status() == app::bad_device ? exceptions.file : exceptions.error;
}

// The signature is pybind11's.
void translate(std::exception_ptr thrown) {  // NOLINT(performance-unnecessary-value-param)
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const app::Failure& failure) {
    PyErr_SetString(type_of(failure), failure.what());
  } catch (const ResultError& thrown_error) {
    const Error& error = thrown_error.error();
    PyErr_SetString(type_of(error.code), report::with_flags(error).c_str());
  }
}

}  // namespace

void add_errors(py::module_& module) {
  const py::handle plain = PyExc_Exception;
  exceptions.error =
      made(module, "Error", "What Proofmass cannot do, and why.", py::make_tuple(plain));
  const py::handle error = exceptions.error;
  exceptions.argument =
      made(module, "ArgumentError", "What was asked for makes no sense; a ValueError too.",
           py::make_tuple(error, py::handle(PyExc_ValueError)));
  exceptions.file =
      made(module, "FileError", "A file that cannot be read or written; an OSError too.",
           py::make_tuple(error, py::handle(PyExc_OSError)));
  exceptions.data = made(module, "DataError", "Data that cannot be analysed so; a ValueError too.",
                         py::make_tuple(error, py::handle(PyExc_ValueError)));
  py::register_exception_translator(translate);
}

void refuse(const std::string& message) {
  throw ResultError(Error{Errc::invalid_argument, message});
}

}  // namespace proofmass::python
