#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "proofmass/characterise/noise_stream.hpp"
#include "proofmass/core/block.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/rows.hpp"
#include "proofmass/signal/running_audit.hpp"

namespace proofmass::serve {

/// Audits the samples of a live source, and characterises their noise, on a thread of its own.
/// Lines (see LiveLines):
///
///     audit   of each five seconds: jitter, and for each channel how many samples were clipped
///     noise   of one channel, in turn: the page of `noise` for all samples so far, with spectrum
///             and Allan deviation; the pause between two is at least nine times their cost
///
/// The noise is that of the accelerometers, or of the first channels if there are none, six at
/// most. Missing samples are counted as missing; it starts anew after more than a thousand in a
/// row, and after most_noise_samples: 46 minutes at 48 kHz, a day and a half at 1 kHz. Memory: 10
/// MB per channel for NoiseStream, that of RunningAudit, and `queue_rows` rows.
class LiveMonitor {
 public:
  static constexpr std::size_t default_noise_samples = std::size_t{1} << 27;
  explicit LiveMonitor(const Recording& head,
                       std::size_t most_noise_samples = default_noise_samples);
  LiveMonitor(const LiveMonitor&) = delete;
  LiveMonitor& operator=(const LiveMonitor&) = delete;
  ~LiveMonitor();

  /// Takes samples with stamps without waiting; those for which there is no room are missing.
  void add(const Block& block);
  /// The lines made since the last call.
  [[nodiscard]] std::vector<std::string> take();

 private:
  struct Noise {
    std::size_t channel = 0;
    std::optional<characterise::NoiseStream> stream{};
  };
  void run();
  void work(const Rows& rows);
  void audit(const Rows& rows);
  void write_audit();
  void find_rate(const Rows& rows);
  void restart();
  void go_on_to(double first_s);
  void add_noise(const Rows& rows);
  void characterise_next();
  void hand_out(std::string line);

  const Recording head_;
  const double most_noise_samples_;
  // Used by the thread alone:
  double rate_hz_;  ///< 0 until it is known
  std::optional<signal::RunningAudit> audit_;
  double audited_since_s_ = 0.0;
  std::size_t audited_rows_ = 0;
  std::vector<std::size_t> clipped_;  ///< of each channel, all audits so far
  std::vector<Noise> noise_;
  std::size_t next_noise_ = 0;
  std::optional<double> last_s_;  ///< stamp of the last sample of the noise
  double since_s_ = 0.0;          ///< stamp of its first sample

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Rows> queue_;
  std::size_t queued_rows_ = 0;
  std::vector<std::string> lines_;
  bool ends_ = false;
  std::thread thread_;
};

}  // namespace proofmass::serve
