#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/report/document.hpp"

namespace proofmass::report {

struct ConvertReport {
  std::string input, output;   ///< files
  const Recording& recording;  ///< what there is besides values
  std::size_t samples = 0;
  const std::vector<Note>& notes;
};

/// Which samples went where, in one line. It refers to the report, which must outlive it.
[[nodiscard]] Document describe(const ConvertReport& report);

}  // namespace proofmass::report
