#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/acquire/source.hpp"
#include "proofmass/core/block.hpp"
#include "proofmass/core/live_analysis.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/recording_log.hpp"
#include "proofmass/core/result.hpp"

// From a source to a file, so that a crash, a full disk or a pulled cable costs the last second at
// most.
namespace proofmass::acquire {

/// Records only around the moments at which a channel passes a level.
struct LevelTrigger {
  std::string channel;  ///< its name, as Recording::find() takes it
  double level = 0.0;   ///< in the channel's unit
  enum class Edge { rising, falling } edge = Edge::rising;
  double before_s = 1.0, after_s = 1.0;  ///< kept on both sides; a passing within extends it
};

struct RecordOptions {
  std::string path;                             ///< "run.mcap"; "run.0001.mcap" … where it rotates
  std::optional<double> duration_s{};           ///< of the recording's clock
  std::optional<double> rotate_s{};             ///< a new file after so long
  std::optional<std::uint64_t> rotate_bytes{};  ///< or after so much
  std::optional<LevelTrigger> trigger{};
  bool reconnect = false;
  double reconnect_for_s = 3600.0;  ///< how long it tries
  double stall_s = 2.0;             ///< silence that is an event
  double stall_end_s = 30.0;        ///< silence that ends the recording (or has it reconnect)
  double sync_s = 0.5;              ///< data are on the disk after so long at most
  /// Between source and disk, and once more between source and analysis.
  std::size_t queue_bytes = std::size_t{64} << 20;
  double catch_up_s = 10.0;  ///< that an analysis which is behind has when it is told to stop
  std::map<std::string, std::string> metadata{};  ///< "command": "proofmass record …"
  std::vector<std::string> sensor_files{};        ///< their texts
};

/// Called on the recording's own thread, between blocks; what takes long holds the writing up, and
/// the samples wait in the queue.
struct RecordWatch {
  std::function<bool()> stopped{};  ///< asked ten times a second at least; true: close and return
  std::function<void(const SourceHead& head)> opened{};
  std::function<void(const Block& block)> samples{};
  std::function<void(const Block& rows)> estimates{};
  std::function<void(const RecordEvent& event)> event{};
};

/// Opens a source, once more for each reconnection.
using OpenSource = std::function<Result<std::unique_ptr<Source>>()>;
/// Makes the analysis that goes along, once the source's channels are known; may be empty. It runs
/// on a thread of its own: where it is slow, samples of a source that comes at its own pace wait
/// for it, and some are left out of it (an event tells) where too many wait.
using MakeAnalysis = std::function<Result<std::unique_ptr<LiveAnalysis>>(const SourceHead& head)>;

/// Records until the source ends, the watcher says so, or the duration is over. The file is
/// "<path>.part" until it is closed.
///
/// Time: the device's clock if it has one that moves; else the samples' count by the granted rate;
/// else the host's clock at arrival. Where the device's clock fails, or rows are known to be lost,
/// time goes on as the host's clock says, and an event tells. See docs/methods/record.md.
///
/// Errors: of opening only (device, invalid_argument, a file that cannot be created); once samples
/// flow, whatever happens is in the summary, and what was recorded is in its file.
[[nodiscard]] Result<RecordSummary> record(const OpenSource& open,
                                           const RecordOptions& options,
                                           const RecordWatch& watch = {},
                                           const MakeAnalysis& analysis = {});

}  // namespace proofmass::acquire
