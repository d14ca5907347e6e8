#pragma once

#include <cstddef>

#include "proofmass/core/progress.hpp"
#include "proofmass/simulate/procedure.hpp"

namespace proofmass::simulate {

/// Fills the recording, the truth series, and the truth's sensor, strokes and line.
void record_slide(const ProcedureOptions& options,
                  std::size_t samples,
                  ProcedureResult& result,
                  const Progress& progress);

}  // namespace proofmass::simulate
