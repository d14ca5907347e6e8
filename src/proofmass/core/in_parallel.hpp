#pragma once

#include <cstddef>
#include <functional>
#include <initializer_list>
#include <span>

#include "proofmass/core/progress.hpp"

namespace proofmass {

/// Calls work(k, its own progress) once for each k below `parts`, with one thread per processor,
/// and reports the mean progress. Parts share no data, so the results do not depend on the number
/// of threads. If several parts throw, the exception with the lowest k is rethrown.
void in_parallel(std::size_t parts,
                 const Progress& shown,
                 const std::function<void(std::size_t, Progress)>& work);

/// Calls independent tasks, which together process `samples`: in parallel if these are enough to
/// pay for the threads.
void run_tasks(std::size_t samples, std::span<const std::function<void()>> tasks);
void run_tasks(std::size_t samples, std::initializer_list<std::function<void()>> tasks);

}  // namespace proofmass
