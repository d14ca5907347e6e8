#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "proofmass/acquire/daqmx/library.hpp"
#include "proofmass/core/result.hpp"

namespace proofmass::acquire {

/// Requested configuration of a card.
struct DaqmxRequest {
  std::vector<std::string> channels{};  ///< "Dev1/ai0", …
  double rate_hz = 1000.0;
  double lowest_v = -10.0, highest_v = 10.0;
  std::string terminals = "default";  ///< rse, nrse, diff, pseudodiff
};

/// Result of one read.
struct DaqmxReading {
  enum class State { fine, overrun, failed } state = State::fine;
  std::size_t rows = 0;
  std::string words{};  ///< the driver's message on an overrun, a failure or a new warning
};

/// A driver task that samples voltages continuously.
class DaqmxTask {
 public:
  /// Configures the channels and the clock, and starts the task. Errors: device, with the driver's
  /// message.
  [[nodiscard]] static Result<std::unique_ptr<DaqmxTask>> start(
      std::shared_ptr<const DaqmxCalls> calls, const DaqmxRequest& request);
  DaqmxTask(const DaqmxTask&) = delete;
  DaqmxTask& operator=(const DaqmxTask&) = delete;
  ~DaqmxTask();

  /// Actual rate, which usually differs slightly from the request.
  [[nodiscard]] double rate_hz() const { return rate_hz_; }
  /// Requested and granted settings as text.
  [[nodiscard]] std::vector<std::pair<std::string, std::string>> settings(
      const DaqmxRequest& request) const;

  /// Waits at most a tenth of a second for `rows` rows, one value per channel, row by row; `into`
  /// then holds the rows that have arrived.
  [[nodiscard]] DaqmxReading read(std::size_t rows, std::vector<double>& into);
  /// Rows acquired since the start and not read; nullopt: not reported.
  [[nodiscard]] std::optional<std::uint64_t> unread() const;
  /// Errors: device.
  [[nodiscard]] Status start_anew();

 private:
  explicit DaqmxTask(std::shared_ptr<const DaqmxCalls> calls) : calls_(std::move(calls)) {}
  [[nodiscard]] Status add_channels(const DaqmxRequest& request);
  [[nodiscard]] Status set_clock(const DaqmxRequest& request);

  std::shared_ptr<const DaqmxCalls> calls_;
  DaqmxTaskHandle task_ = nullptr;
  std::vector<std::string> channels_;
  double rate_hz_ = 0.0;
  std::uint64_t rows_read_ = 0;  ///< since the start
  std::int32_t warning_ = 0;     ///< the last one
};

}  // namespace proofmass::acquire
