#pragma once

#include <ctime>
#include <sys/resource.h>

namespace proofmass {

/// Processor time of this process so far.
inline double cpu_s() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

/// Peak memory so far.
inline double peak_mib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

}  // namespace proofmass
