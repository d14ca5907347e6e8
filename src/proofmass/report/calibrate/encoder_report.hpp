#pragma once

#include <string>
#include <vector>

#include "proofmass/calibrate/encoder.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/report/document.hpp"

namespace proofmass::report {

struct EncoderReport {
  std::vector<std::string> inputs;
  std::vector<Note> notes;
  std::string channel;  ///< of the encoder
  calibrate::EncoderOptions options;
  calibrate::EncoderCalibration fit;
  std::vector<signal::CountSlip> index_slips;  ///< between two index pulses
};

/// Errors, missed counts and budget of an encoder. Holds a reference to the report, which must
/// outlive it.
[[nodiscard]] Document describe(const EncoderReport& report);

/// Difference of encoder and gravity against time and angle, for --output.
[[nodiscard]] Recording encoder_series(const EncoderReport& report);

}  // namespace proofmass::report
