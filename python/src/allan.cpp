#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <span>
#include <string>
#include <vector>

#include "cli/exit_status.hpp"
#include "computing.hpp"
#include "errors.hpp"
#include "module.hpp"
#include "noise/options.hpp"
#include "proofmass/characterise/noise_analysis.hpp"
#include "recording.hpp"
#include "words.hpp"

namespace py = pybind11;

namespace proofmass::python {
namespace {

using characterise::DeviationCurve;
using characterise::DeviationPoint;
using characterise::NoiseAnalysis;

template <class Number, class Member>
py::array_t<Number> column(const DeviationCurve& curve, Member DeviationPoint::* member) {
  py::array_t<Number> out(static_cast<py::ssize_t>(curve.points.size()));
  Number* at = out.mutable_data();
  for (const DeviationPoint& point : curve.points) *at++ = static_cast<Number>(point.*member);
  return out;
}

py::dict allan(const std::vector<std::string>& words,
               const py::array_t<double, py::array::c_style>& series,
               const py::object& progress) {
  const auto command = parsed<app::NoiseCommand>(words);
  characterise::NoiseOptions options = app::noise_options(command);
  options.rate_hz = command.input.rate_hz.value_or(0.0);
  const std::span values(series.data(), static_cast<std::size_t>(series.size()));
  NoiseAnalysis analysis;
  compute(progress, [&](const Progress& report) {
    options.progress = report;
    analysis = need(characterise::analyse_noise(values, options));
  });
  const DeviationCurve& curve = analysis.deviation;
  py::dict out;
  out["statistic"] = std::string(characterise::name_of(curve.statistic));
  out["confidence"] = curve.confidence;
  out["bias_correction"] = curve.bias_correction;
  out["notes"] = words_of(analysis.notes);
  out["m"] = column<std::int64_t>(curve, &DeviationPoint::m);
  out["terms"] = column<std::int64_t>(curve, &DeviationPoint::terms);
  out["tau_s"] = column<double>(curve, &DeviationPoint::tau_s);
  out["deviation"] = column<double>(curve, &DeviationPoint::value);
  out["uncorrected"] = column<double>(curve, &DeviationPoint::uncorrected);
  out["lower"] = column<double>(curve, &DeviationPoint::lower);
  out["upper"] = column<double>(curve, &DeviationPoint::upper);
  out["edf"] = column<double>(curve, &DeviationPoint::edf);
  out["alpha"] = column<std::int64_t>(curve, &DeviationPoint::alpha);
  return out;
}

}  // namespace

void add_allan(py::module_& module) {
  module.def("allan", allan, py::arg("words"), py::arg("series").noconvert(), py::arg("progress"));
}

}  // namespace proofmass::python
