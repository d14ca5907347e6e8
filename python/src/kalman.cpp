#include <cstdint>
#include <memory>
#include <optional>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <span>
#include <string>
#include <vector>

#include "computing.hpp"
#include "errors.hpp"
#include "module.hpp"
#include "proofmass/estimate/fast/matrix_series.hpp"

namespace py = pybind11;

namespace proofmass::python {
namespace {

using Doubles = py::array_t<double, py::array::c_style>;
using Places = py::array_t<std::int64_t, py::array::c_style>;
using estimate::MatrixPass;
using estimate::MatrixSequence;
using estimate::MatrixSeries;
using estimate::MatrixSummary;

std::span<const double> span_of(const Doubles& array) {
  return {array.data(), static_cast<std::size_t>(array.size())};
}
std::span<double> span_of(Doubles& array) {
  return {array.mutable_data(), static_cast<std::size_t>(array.size())};
}

/// Distinct matrices and the index of each epoch's; the index, or both, may be None.
struct Sequence {
  Doubles values;
  Places which;

  [[nodiscard]] MatrixSequence view() const {
    return {span_of(values), {which.data(), static_cast<std::size_t>(which.size())}};
  }
};

Sequence sequence_of(const py::dict& model, const char* name) {
  const auto pair = model[name].cast<py::tuple>();
  return {pair[0].cast<Doubles>(), pair[1].cast<Places>()};
}

MatrixPass pass_named(const std::string& name) {
  if (name == "smooth") return MatrixPass::smooth;
  return name == "fixed_lag" ? MatrixPass::fixed_lag : MatrixPass::filter;
}

py::dict run(const py::dict& model,
             const std::string& pass,
             std::size_t lag,
             const py::object& progress) {
  const Sequence F = sequence_of(model, "F"), Q = sequence_of(model, "Q"),
                 H = sequence_of(model, "H"), R = sequence_of(model, "R"),
                 B = sequence_of(model, "B");
  const auto x = model["x"].cast<Doubles>(), P = model["P"].cast<Doubles>(),
             z = model["z"].cast<Doubles>(), u = model["u"].cast<Doubles>();
  const MatrixSeries series{.states = model["states"].cast<int>(),
                            .channels = model["channels"].cast<int>(),
                            .inputs = model["inputs"].cast<int>(),
                            .F = F.view(),
                            .Q = Q.view(),
                            .H = H.view(),
                            .R = R.view(),
                            .B = B.view(),
                            .prior_mean = span_of(x),
                            .prior_cov = span_of(P),
                            .z = span_of(z),
                            .u = span_of(u)};
  const auto n = static_cast<py::ssize_t>(series.size());
  const py::ssize_t N = series.states, M = series.channels;
  Doubles mean({n, N}), cov({n, N, N}), innovation({n, M}), innovation_cov({n, M, M});
  const estimate::MatrixOutput output{span_of(mean), span_of(cov), span_of(innovation),
                                      span_of(innovation_cov)};
  std::optional<MatrixSummary> summary;
  const MatrixPass asked = pass_named(pass);
  const bool fast = asked != MatrixPass::fixed_lag && estimate::is_uniform(series);
  compute(progress, [&](const Progress& report) {
    summary = need(fast ? estimate::run_uniform_matrices(series, asked, output)
                        : estimate::run_matrices(series, asked, lag, output, report));
  });
  py::dict out;
  out["mean"] = mean;
  out["cov"] = cov;
  out["innovation"] = innovation;
  out["innovation_cov"] = innovation_cov;
  out["log_likelihood"] = summary->log_likelihood;
  out["nis"] = summary->nis;
  out["readings"] = summary->readings;
  return out;
}

}  // namespace

void add_kalman(py::module_& module) {
  module.def("kalman", run);
  module.attr("most_states") = estimate::most_matrix_states;
}

}  // namespace proofmass::python
