#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"

namespace proofmass::report {

struct ConvertReport {
  std::string input, output;   ///< files
  const Recording& recording;  ///< what there is besides values
  std::size_t samples = 0;
  const std::vector<Note>& notes;
};

/// The document of `convert`: docs/schema/convert.schema.json.
[[nodiscard]] std::string convert_json(const ConvertReport& report);

/// One line: what went where.
[[nodiscard]] std::string convert_text(const ConvertReport& report);

}  // namespace proofmass::report
