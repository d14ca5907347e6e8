#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/fleet/results.hpp"
#include "proofmass/report/document.hpp"

namespace proofmass::fleet {

struct FailedJob {
  std::string file, reason;
};

/// What a run over many recordings came to.
struct FleetReport {
  std::string manifest, analysis, folder;  ///< analysis: the verb
  std::size_t jobs = 0;                    ///< done + skipped + failed, unless interrupted
  std::size_t done = 0;
  std::size_t skipped = 0;  ///< done before, with the same bytes, flags and version
  std::size_t waiting = 0;  ///< groups whose sums other shards have still to make
  std::vector<FailedJob> failed;
  Shard shard;
  std::string dask;           ///< address of the scheduler; empty: processes of this machine
  std::size_t processes = 1;  ///< 0: as many as its workers have
  double elapsed_s = 0.0;
  double busy_s = 0.0;  ///< sum over all processes
  std::vector<Note> notes;
};

/// What was done, what failed and why, and where the results are. Bad where a recording failed.
[[nodiscard]] report::Document describe(const FleetReport& report);

}  // namespace proofmass::fleet
