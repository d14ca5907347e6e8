#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/report/document.hpp"

namespace proofmass::report {

struct ConvertReport {
  std::string input, output;   ///< files
  const Recording& recording;  ///< everything but the values
  std::size_t samples = 0;
  const std::vector<Note>& notes;
};

/// Number of samples, source and destination, in one line. Holds a reference to the report, which
/// must outlive it.
[[nodiscard]] Document describe(const ConvertReport& report);

}  // namespace proofmass::report
