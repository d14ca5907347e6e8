#pragma once

#include <array>
#include <string>
#include <vector>

#include "proofmass/report/tumble_report.hpp"

// Why figures of a tumble's document are null.
namespace proofmass::report {

/// The keys that stand in every document, whether the test has them or not.
inline constexpr std::array tumble_keys{
    calibrate::TumbleQuantity::K1,           calibrate::TumbleQuantity::K0,
    calibrate::TumbleQuantity::K2_minus_Kpp, calibrate::TumbleQuantity::misalignment,
    calibrate::TumbleQuantity::K3,           calibrate::TumbleQuantity::Kip,
    calibrate::TumbleQuantity::K0_up_down};

/// The notes from Severity::warning on, and a sentence for every null.
[[nodiscard]] std::vector<std::string> tumble_warnings(const TumbleReport& report);

}  // namespace proofmass::report
