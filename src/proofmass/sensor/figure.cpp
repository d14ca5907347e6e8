#include "proofmass/sensor/figure.hpp"

#include <initializer_list>

#include "proofmass/core/contract.hpp"
#include "proofmass/core/units.hpp"

namespace proofmass::sensor {
namespace {

std::string_view si_symbol_of(Quantity quantity) {
  switch (quantity) {
    case Quantity::acceleration:
      return "m/s^2";
    case Quantity::voltage:
      return "V";
    case Quantity::counts:
      return "counts";
    case Quantity::time:
      return "s";
    case Quantity::angle:
      return "rad";
    case Quantity::temperature:
      return "K";
    case Quantity::speed:
      return "m/s";
    case Quantity::angular_rate:
      return "rad/s";
    default:
      return {};
  }
}

/// Factor to SI of a unit of the given quantity; nullopt for any other unit.
std::optional<double> factor(std::string_view text, Quantity quantity) {
  const auto unit = parse_unit(text);
  return unit && unit->quantity == quantity ? std::optional(unit->to_si) : std::nullopt;
}

/// The part before one of the endings: "ug" of "ug/rtHz".
std::optional<std::string_view> before(std::string_view text,
                                       std::initializer_list<std::string_view> endings) {
  for (const std::string_view ending : endings)
    if (text.ends_with(ending)) return text.substr(0, text.size() - ending.size());
  return std::nullopt;
}

std::optional<FigureUnit> plain_unit(std::string_view text) {
  if (text.empty() || text == "1") return FigureUnit{};
  if (text == "%") return FigureUnit{"%", "1", 1e-2};
  if (text == "ppm") return FigureUnit{"ppm", "1", 1e-6};
  if (text == "Hz") return FigureUnit{"Hz", "Hz", 1.0};
  if (text == "kHz") return FigureUnit{"kHz", "Hz", 1e3};
  const auto unit = parse_unit(text);
  if (!unit || si_symbol_of(unit->quantity).empty()) return std::nullopt;
  return FigureUnit{std::string(text), std::string(si_symbol_of(unit->quantity)), unit->to_si,
                    unit->offset_si};
}

constexpr double s_per_h = 3600.0, root_s_per_root_h = 60.0;

/// An angular rate as makers of gyroscopes write its noise: per square root of hertz or second, or
/// of an hour: "deg/sqrt(h)" (angle random walk), "deg/h" (bias instability), "deg/h/sqrt(h)".
std::optional<FigureUnit> gyroscope_unit(std::string_view text) {
  const std::string symbol(text);
  if (text == "deg/h" || text == "°/h") return FigureUnit{symbol, "rad/s", rad_per_deg / s_per_h};
  if (text == "deg/sqrt(h)" || text == "°/√h")
    return FigureUnit{symbol, "rad/s/sqrt(Hz)", rad_per_deg / root_s_per_root_h};
  if (text == "deg/h/sqrt(h)" || text == "°/h/√h")
    return FigureUnit{symbol, "rad/s/sqrt(s)", rad_per_deg / (s_per_h * root_s_per_root_h)};
  if (const auto rate = before(text, {"/sqrt(Hz)", "/rtHz", "/√Hz"})) {
    if (*rate == "rad/s^2") return FigureUnit{symbol, "rad/s/sqrt(s)", 1.0};
    if (const auto to_si = factor(*rate, Quantity::angular_rate))
      return FigureUnit{symbol, "rad/s/sqrt(Hz)", *to_si};
  }
  if (const auto rate = before(text, {"/sqrt(s)", "/rts", "/√s"}))
    if (const auto to_si = factor(*rate, Quantity::angular_rate))
      return FigureUnit{symbol, "rad/s/sqrt(s)", *to_si};
  return std::nullopt;
}

/// "counts/(rad/s)", "mV/(deg/s)", and an angular rate per acceleration: "deg/s/g".
std::optional<FigureUnit> gyroscope_sensitivity(std::string_view text) {
  const std::string symbol(text);
  for (const std::string_view per : {"/(rad/s)", "/(deg/s)", "/rad/s", "/deg/s"}) {
    const auto output = before(text, {per});
    if (!output) continue;
    const double to_si = per.find("deg") == std::string_view::npos ? 1.0 : deg_per_rad;
    if (const auto volts = factor(*output, Quantity::voltage))
      return FigureUnit{symbol, "V/(rad/s)", *volts * to_si};
    if (const auto counts = factor(*output, Quantity::counts))
      return FigureUnit{symbol, "counts/(rad/s)", *counts * to_si};
  }
  for (const std::string_view per : {"/(m/s^2)", "/g"}) {
    const auto rate = before(text, {per});
    if (!rate) continue;
    if (const auto to_si = factor(*rate, Quantity::angular_rate))
      return FigureUnit{symbol, "rad/s/(m/s^2)",
                        per == "/g" ? *to_si / standard_gravity_mps2 : *to_si};
  }
  return std::nullopt;
}

/// An acceleration per square root of hertz, per square root of a second, or per time.
std::optional<FigureUnit> noise_unit(std::string_view text) {
  const std::string symbol(text);
  if (const auto accel = before(text, {"/sqrt(Hz)", "/rtHz", "/√Hz"})) {
    if (*accel == "m/s^3") return FigureUnit{symbol, "m/s^2/sqrt(s)", 1.0};
    if (const auto to_si = factor(*accel, Quantity::acceleration))
      return FigureUnit{symbol, "m/s^2/sqrt(Hz)", *to_si};
  }
  if (const auto accel = before(text, {"/sqrt(s)", "/rts", "/√s"}))
    if (const auto to_si = factor(*accel, Quantity::acceleration))
      return FigureUnit{symbol, "m/s^2/sqrt(s)", *to_si};
  if (text == "m/s^3") return FigureUnit{symbol, "m/s^3", 1.0};
  const auto slash = text.rfind('/');
  if (slash == std::string_view::npos) return std::nullopt;
  const auto accel = factor(text.substr(0, slash), Quantity::acceleration);
  const auto time = factor(text.substr(slash + 1), Quantity::time);
  if (!accel || !time) return std::nullopt;
  return FigureUnit{symbol, "m/s^3", *accel / *time};
}

/// Volts or counts per acceleration.
std::optional<FigureUnit> sensitivity_unit(std::string_view text) {
  const auto slash = text.find('/');
  if (slash == std::string_view::npos) return std::nullopt;
  const auto accel = factor(text.substr(slash + 1), Quantity::acceleration);
  if (!accel) return std::nullopt;
  const std::string_view output = text.substr(0, slash);
  if (const auto volts = factor(output, Quantity::voltage))
    return FigureUnit{std::string(text), "V/(m/s^2)", *volts / *accel};
  if (const auto counts = factor(output, Quantity::counts))
    return FigureUnit{std::string(text), "counts/(m/s^2)", *counts / *accel};
  return std::nullopt;
}

}  // namespace

std::optional<FigureUnit> parse_figure_unit(std::string_view text) {
  while (text.starts_with(' ')) text.remove_prefix(1);
  while (text.ends_with(' ')) text.remove_suffix(1);
  if (auto unit = plain_unit(text)) return unit;
  if (auto unit = noise_unit(text)) return unit;
  if (auto unit = gyroscope_unit(text)) return unit;
  if (auto unit = gyroscope_sensitivity(text)) return unit;
  return sensitivity_unit(text);
}

Figure make_figure(double value, std::string_view unit, std::string_view origin) {
  const auto parsed = parse_figure_unit(unit);
  PM_EXPECTS(parsed.has_value());
  return {value, std::nullopt, *parsed, std::string(origin)};
}

AxisFigures make_axis_figures(const std::array<double, 3>& values,
                              std::string_view unit,
                              std::string_view origin) {
  AxisFigures figures;
  for (std::size_t axis = 0; axis < 3; ++axis)
    figures[axis] = make_figure(values[axis], unit, origin);
  return figures;
}

}  // namespace proofmass::sensor
