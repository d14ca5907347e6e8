#pragma once

#include <array>
#include <string_view>
#include <utility>

#include "proofmass/core/units.hpp"
#include "proofmass/simulate/rig.hpp"

// Conversion of a sensor's voltage to the recorded value.
namespace proofmass::simulate {

/// Quantisation step in V; bits must not be 0.
[[nodiscard]] double daq_lsb_v(const RigDaq& daq);

/// A voltage after the converter.
[[nodiscard]] double converted_v(double v, const RigDaq& daq);

/// The words for the outputs in a description.
inline constexpr std::array<std::pair<RigOutput, std::string_view>, 3> output_words{
    {{RigOutput::acceleration, "acceleration"},
     {RigOutput::voltage, "voltage"},
     {RigOutput::counts, "counts"}}};

/// "m/s^2", "V" or "counts".
[[nodiscard]] std::string_view unit_of(RigOutput output);

/// A unit by its symbol; an unknown one keeps the symbol.
[[nodiscard]] Unit unit(std::string_view symbol);

/// Conversion of a channel from volts to the recorded unit.
struct RecordedOutput {
  RigOutput output = RigOutput::acceleration;
  RigDaq daq;
  double zero_v = 0.0;                  ///< nominal
  double sensitivity_v_per_mps2 = 1.0;  ///< nominal

  /// A converted voltage in the recording's unit.
  [[nodiscard]] double written(double v) const;
  [[nodiscard]] double recorded(double v) const { return written(converted_v(v, daq)); }
};

}  // namespace proofmass::simulate
