#pragma once

#include <cstddef>
#include <functional>

#include "proofmass/core/progress.hpp"

namespace proofmass {

/// Calls work(k, its own progress) once for each k below `parts`, as many at once as there are
/// processors, and shows the mean of their progress. Parts share nothing, so the results do not
/// depend on how many run at once. Of exceptions, that of the lowest k comes out.
void in_parallel(std::size_t parts,
                 const Progress& shown,
                 const std::function<void(std::size_t, Progress)>& work);

}  // namespace proofmass
