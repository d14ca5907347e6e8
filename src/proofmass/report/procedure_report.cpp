#include "proofmass/report/procedure_report.hpp"

#include <fmt/format.h>

#include "proofmass/report/json.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using simulate::TruePose;

Array numbers(const auto& values) {
  Array array;
  for (const double v : values) array.push_back(v);
  return array;
}

Array positions(const ProcedureReport& report) {
  Array array;
  for (const TruePose& pose : report.result.truth.poses) {
    Object position{{"number", static_cast<std::uint64_t>(pose.number)},
                    {"start_s", pose.start_s},
                    {"end_s", pose.end_s},
                    {"force_mps2", numbers(pose.force_mps2)}};
    if (pose.plane > 0) {
      position.push_back({"plane", pose.plane});
      position.push_back({"mount_rad", pose.mount_rad});
      position.push_back({"commanded_rad", pose.commanded_rad});
      position.push_back({"angle_rad", pose.angle_rad});
    }
    array.push_back(std::move(position));
  }
  return array;
}

Array strokes(const simulate::ProcedureTruth& truth) {
  Array array;
  for (const simulate::TrueStroke& stroke : truth.strokes)
    array.push_back(Object{{"number", stroke.number},
                           {"set", stroke.set},
                           {"start_s", stroke.start_s},
                           {"end_s", stroke.end_s},
                           {"from_m", stroke.from_m},
                           {"to_m", stroke.to_m}});
  return array;
}

// The coefficients of each axis by name, K1 in the recording's unit per m/s^2, all else in SI.
Array axes(const ProcedureReport& report) {
  Array array;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Channel& channel = report.result.recording.channels[axis];
    Object one{{"name", channel.name}, {"unit", channel.unit.symbol}};
    for (const sensor::CoefficientInfo& info : sensor::coefficients())
      one.push_back({std::string(info.name), report.result.truth.equations[axis].*info.member});
    array.push_back(std::move(one));
  }
  return array;
}

Array figures(const sensor::AxisFigures& three) {
  Array array;
  for (const auto& figure : three) array.push_back(figure ? Value(figure->si()) : Value());
  return array;
}

std::string three(const sensor::AxisFigures& values, double to_shown, int decimals) {
  std::string text;
  for (const auto& figure : values)
    if (figure) text += (text.empty() ? "" : ", ") + fixed(figure->si() * to_shown, decimals);
  return text;
}

}  // namespace

std::string procedure_json(const ProcedureReport& report) {
  const Recording& recording = report.result.recording;
  const simulate::ProcedureTruth& truth = report.result.truth;
  const sensor::Calibration& calibration = truth.sensor.calibration;
  Array channels;
  for (const Channel& channel : recording.channels)
    channels.push_back(Object{{"name", channel.name}, {"unit", channel.unit.symbol}});
  Object told{{"positions", positions(report)},
              {"axes", axes(report)},
              {"bias", figures(calibration.bias)},
              {"scale", figures(calibration.scale)},
              {"misalignment_rad", figures(calibration.misalignment)},
              {"mean_drift_mps2", numbers(truth.mean_drift_mps2)}};
  if (!truth.strokes.empty()) {
    told.push_back({"strokes", strokes(truth)});
    told.push_back({"line", numbers(truth.line)});
  }
  return to_json({"simulate", report.inputs, texts(recording.notes, Severity::warning)},
                 {{"procedure", simulate::name_of(report.options.procedure)},
                  {"file", report.output},
                  {"truth_file", report.truth},
                  {"sensor_file", report.sensor},
                  {"seed", report.options.seed},
                  {"session", report.options.session},
                  {"samples", recording.samples()},
                  {"rate_hz", report.options.rate_hz},
                  {"duration_s", recording.duration_s()},
                  {"gravity_mps2", report.options.gravity_mps2},
                  {"channels", std::move(channels)},
                  {"truth", std::move(told)}});
}

std::string procedure_text(const ProcedureReport& report) {
  const Recording& recording = report.result.recording;
  const simulate::ProcedureTruth& truth = report.result.truth;
  const sensor::Calibration& calibration = truth.sensor.calibration;
  return fmt::format("Simulated {}, {} at {} Hz, seed {}: {}.\n",
                     simulate::name_of(report.options.procedure),
                     duration_words(recording.duration_s()), compact(report.options.rate_hz, 6),
                     report.options.seed,
                     truth.strokes.empty() ? count_words(truth.poses.size(), "position")
                                           : count_words(truth.strokes.size(), "stroke")) +
         aligned({{"recording", report.output,
                   fmt::format("{} of {}", count_words(recording.channels.size(), "channel"),
                               count_words(recording.samples(), "sample"))},
                  {"truth", report.truth,
                   truth.strokes.empty() ? "force, drift, rests"
                                         : "force, drift, displacement, rests, strokes"},
                  {"sensor", report.sensor, "what a perfect calibration would find:"},
                  {"", "bias", three(calibration.bias, 1.0, 5) + " m/s^2"},
                  {"", "scale", three(calibration.scale, 1.0, 6)},
                  {"", "misalignment", three(calibration.misalignment, 1e3, 3) + " mrad"}});
}

}  // namespace proofmass::report
