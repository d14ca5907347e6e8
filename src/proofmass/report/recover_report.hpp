#pragma once

#include <string>

#include "proofmass/core/recording_log.hpp"
#include "proofmass/report/document.hpp"

namespace proofmass::report {

struct RecoverReport {
  std::string input;  ///< the damaged file
  Recovery recovery{};
};

[[nodiscard]] Document describe(const RecoverReport& report);

}  // namespace proofmass::report
