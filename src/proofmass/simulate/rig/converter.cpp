#include "proofmass/simulate/rig/converter.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace proofmass::simulate {

std::optional<RigOutput> output_named(std::string_view name) {
  for (const auto& [value, word] : output_words)
    if (word == name) return value;
  return std::nullopt;
}

RigDaq with_steps(const RigDaq& daq, double supply_v) {
  if (daq.bits > 0) return daq;
  return {.bits = 16, .min_v = 0.0, .max_v = supply_v, .skew_s = daq.skew_s};
}

double daq_lsb_v(const RigDaq& daq) {
  return std::ldexp(daq.max_v - daq.min_v, -daq.bits);
}

double converted_v(double v, const RigDaq& daq) {
  if (daq.bits == 0) return v;
  const double lsb = daq_lsb_v(daq);
  const double lowest = std::round(daq.min_v / lsb);
  return std::clamp(std::round(v / lsb), lowest, lowest + std::ldexp(1.0, daq.bits) - 1.0) * lsb;
}

std::string_view unit_of(RigOutput output) {
  switch (output) {
    case RigOutput::voltage:
      return "V";
    case RigOutput::counts:
      return "counts";
    case RigOutput::acceleration:
      break;
  }
  return "m/s^2";
}

Unit unit(std::string_view symbol) {
  return parse_unit(symbol).value_or(Unit{Quantity::unknown, 1.0, 0.0, std::string(symbol)});
}

double RecordedOutput::written(double v) const {
  switch (output) {
    case RigOutput::voltage:
      return v;
    case RigOutput::counts:
      return std::round(v / daq_lsb_v(daq));
    case RigOutput::acceleration:
      break;
  }
  return (v - zero_v) / sensitivity_v_per_mps2;
}

}  // namespace proofmass::simulate
