#pragma once

#include <string>
#include <vector>

#include "proofmass/report/calibrate_report.hpp"

namespace proofmass::report {

/// "lack_of_fit: null: …": why each null of the document is one, where no note says so.
[[nodiscard]] std::vector<std::string> calibrate_null_reasons(const CalibrateReport& report);

}  // namespace proofmass::report
