#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/sensor/sensor_model.hpp"
#include "proofmass/simulate/rig.hpp"

namespace proofmass::simulate {

/// The rig in real time: the numbers of simulate_rig(), in blocks of any size. After the end of its
/// speed profile it keeps the last speed.
class RunningRig {
 public:
  /// Channels in the recording's order. Rows are appended; the vectors keep their capacity.
  using Columns = std::vector<std::vector<double>>;

  /// Errors: invalid_argument (the message names the option).
  [[nodiscard]] static Result<RunningRig> start(const RigOptions& options);
  RunningRig(RunningRig&&) noexcept;
  RunningRig& operator=(RunningRig&&) noexcept;
  ~RunningRig();

  /// As in RigResult, the channels without values.
  [[nodiscard]] const Recording& recording() const;
  [[nodiscard]] const Recording& truth() const;
  [[nodiscard]] const std::vector<sensor::SensorModel>& sensors() const;

  /// Number of the next scan.
  [[nodiscard]] std::uint64_t scan() const;
  /// Number of scans up to the end of the speed profile.
  [[nodiscard]] std::uint64_t profile_scans() const;

  /// Appends the next `scans` rows, and the truth if requested.
  /// Cost: if the card has no skew, the motion is computed once for all channels of a scan.
  void run(std::size_t scans, Columns& recorded, Columns* truth = nullptr);

 private:
  class Scans;
  explicit RunningRig(const RigOptions& options);
  std::unique_ptr<Scans> scans_;
};

}  // namespace proofmass::simulate
