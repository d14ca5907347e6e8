#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "proofmass/acquire/daqmx_library.hpp"
#include "proofmass/core/result.hpp"

namespace proofmass::acquire {

/// What is asked of a card.
struct DaqmxRequest {
  std::vector<std::string> channels{};  ///< "Dev1/ai0", …
  double rate_hz = 1000.0;
  double lowest_v = -10.0, highest_v = 10.0;
  std::string terminals = "default";  ///< rse, nrse, diff, pseudodiff
};

/// What a reading brought.
struct DaqmxReading {
  enum class State { fine, overrun, failed } state = State::fine;
  std::size_t rows = 0;
  std::string words{};  ///< of the driver, on an overrun, a failure or a new warning
};

/// A task of the driver that samples voltages for as long as it runs.
class DaqmxTask {
 public:
  /// Sets the channels and the clock, and starts it. Errors: device, in the driver's words.
  [[nodiscard]] static Result<std::unique_ptr<DaqmxTask>> start(
      std::shared_ptr<const DaqmxCalls> calls, const DaqmxRequest& request);
  DaqmxTask(const DaqmxTask&) = delete;
  DaqmxTask& operator=(const DaqmxTask&) = delete;
  ~DaqmxTask();

  /// Really given, which is seldom just what was asked for.
  [[nodiscard]] double rate_hz() const { return rate_hz_; }
  /// What was asked for and what was granted, in words.
  [[nodiscard]] std::vector<std::pair<std::string, std::string>> settings(
      const DaqmxRequest& request) const;

  /// Waits a tenth of a second at most for so many rows, a value a channel, one row behind the
  /// other; what has come by then is in `into`.
  [[nodiscard]] DaqmxReading read(std::size_t rows, std::vector<double>& into);
  /// Rows that the card took since it was started and that were not read; nullopt: it does not say.
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
  std::uint64_t rows_read_ = 0;  ///< since it was started
  std::int32_t warning_ = 0;     ///< the last
};

}  // namespace proofmass::acquire
