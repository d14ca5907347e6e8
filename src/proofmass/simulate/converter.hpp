#pragma once

#include <array>
#include <string_view>
#include <utility>

#include "proofmass/core/units.hpp"
#include "proofmass/simulate/rig.hpp"

// From a sensor's voltage to what stands in the recording.
namespace proofmass::simulate {

/// A step of the converter in V; bits must not be 0.
[[nodiscard]] double daq_lsb_v(const RigDaq& daq);

/// What the converter makes of a voltage.
[[nodiscard]] double converted_v(double v, const RigDaq& daq);

/// The words that stand for them in a description.
inline constexpr std::array<std::pair<RigOutput, std::string_view>, 3> output_words{
    {{RigOutput::acceleration, "acceleration"},
     {RigOutput::voltage, "voltage"},
     {RigOutput::counts, "counts"}}};

/// "m/s^2", "V" or "counts".
[[nodiscard]] std::string_view unit_of(RigOutput output);

/// A unit by its symbol; an unknown one keeps the symbol.
[[nodiscard]] Unit unit(std::string_view symbol);

/// A channel's way from volts to the recording.
struct RecordedOutput {
  RigOutput output = RigOutput::acceleration;
  RigDaq daq;
  double zero_v = 0.0;                  ///< nominally
  double sensitivity_v_per_mps2 = 1.0;  ///< nominally

  /// A converted voltage in the recording's unit.
  [[nodiscard]] double written(double v) const;
  [[nodiscard]] double recorded(double v) const { return written(converted_v(v, daq)); }
};

}  // namespace proofmass::simulate
