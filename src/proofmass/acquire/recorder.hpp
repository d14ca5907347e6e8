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

// Records a source to a file. A crash, a full disk or an unplugged cable costs at most the last
// second.
namespace proofmass::acquire {

/// Records only around the times at which a channel crosses a level.
struct LevelTrigger {
  std::string channel;  ///< name, as for Recording::find()
  double level = 0.0;   ///< in the channel's unit
  enum class Edge { rising, falling } edge = Edge::rising;
  double before_s = 1.0, after_s = 1.0;  ///< kept before and after; another crossing extends it
};

struct RecordOptions {
  std::string path;                             ///< "run.mcap"; with rotation "run.0001.mcap" …
  bool keeps_file = true;                       ///< false: samples go to watch and analysis alone
  std::optional<double> duration_s{};           ///< on the recording's clock
  std::optional<double> rotate_s{};             ///< new file after this time
  std::optional<std::uint64_t> rotate_bytes{};  ///< new file after this size
  std::optional<LevelTrigger> trigger{};
  bool reconnect = false;
  double reconnect_for_s = 3600.0;  ///< how long to retry
  double stall_s = 2.0;             ///< silence that causes an event
  double stall_end_s = 30.0;        ///< silence that ends the recording (or starts a reconnection)
  double sync_s = 0.5;              ///< maximum delay until data are synced to the disk
  /// Size of the queue between source and disk, and of that between source and analysis.
  std::size_t queue_bytes = std::size_t{64} << 20;
  double catch_up_s = 10.0;  ///< time for a lagging analysis to catch up after a stop
  std::map<std::string, std::string> metadata{};  ///< "command": "proofmass record …"
  std::vector<std::string> sensor_files{};        ///< their contents
};

/// Callbacks on the recording's own thread, between blocks. A slow callback delays writing; the
/// samples wait in the queue.
struct RecordWatch {
  std::function<bool()> stopped{};  ///< polled at least ten times a second; true: close and return
  std::function<void(const SourceHead& head)> opened{};
  std::function<void(const Block& block)> samples{};
  std::function<void(const Block& rows)> estimates{};
  std::function<void(const RecordEvent& event)> event{};
};

/// Opens a source; called again for each reconnection.
using OpenSource = std::function<Result<std::unique_ptr<Source>>()>;
/// Creates the analysis once the source's channels are known; may be empty. The analysis runs on
/// its own thread. If it is slow, samples of a source with its own pace wait for it, and are
/// skipped (reported in an event) if too many wait.
using MakeAnalysis = std::function<Result<std::unique_ptr<LiveAnalysis>>(const SourceHead& head)>;

/// Records until the source ends, the watcher requests a stop, or the duration is over. The file is
/// "<path>.part" until it is closed.
///
/// Time: the device's clock if it has one that advances; else the sample count at the granted rate;
/// else the host's clock at arrival. If the device's clock fails, or rows are known to be lost,
/// time continues by the host's clock, and an event reports it. See docs/methods/record.md.
///
/// Errors: of opening only (device, invalid_argument, a file that cannot be created). Once samples
/// arrive, failures are reported in the summary, and the data recorded so far are in the file.
[[nodiscard]] Result<RecordSummary> record(const OpenSource& open,
                                           const RecordOptions& options,
                                           const RecordWatch& watch = {},
                                           const MakeAnalysis& analysis = {});

}  // namespace proofmass::acquire
