#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "common_flags.hpp"
#include "input.hpp"
#include "proofmass/core/block.hpp"

namespace proofmass::app {

/// The channels of live samples that --channel leaves: their accelerometers calibrated by --sensor
/// and in m/s^2, their gyroscopes in rad/s.
class CalibratedSamples {
 public:
  /// The sensor files' notes are added to `notes`. Throws Failure: no accelerometer, a unit that
  /// nobody knows, a sensor file for another unit.
  CalibratedSamples(const InputFlags& flags, const Recording& head, std::vector<Note>& notes);

  [[nodiscard]] const std::vector<Accelerometer>& accelerometers() const { return found_; }
  [[nodiscard]] const std::vector<sensor::SensorModel>& models() const { return models_; }
  /// The channels as they come out, without values.
  [[nodiscard]] const Recording& head() const { return head_; }
  /// Of a block of the source's channels; valid until the next one.
  [[nodiscard]] Block apply(const Block& raw);

 private:
  void to_si();
  void choose(const std::vector<std::string>& names, const Recording& head);

  std::vector<sensor::SensorModel> models_;
  std::vector<std::size_t> chosen_;  ///< of the source's channels
  std::vector<Unit> units_;          ///< in which they come
  std::vector<Recording> pieces_;    ///< one: the block that is worked on
  std::vector<Accelerometer> found_;
  Recording head_;
};

}  // namespace proofmass::app
