#include "proofmass/report/record_report.hpp"

#include <fmt/format.h>

#include "proofmass/report/json.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {}  // namespace proofmass::report
