#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "proofmass/core/block.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/sensor/sensor_model.hpp"

// The accelerometers of recordings, calibrated and in m/s^2: of whole recordings and of samples
// that come a block at a time.
namespace proofmass::sensor {

/// One accelerometer: its channels of one of several recordings.
struct Accelerometer {
  std::size_t recording = 0;
  Triad triad;
  std::string name;  ///< the file's, with the triad's where the file has several
};

/// The accelerometers of all recordings, in their order; a lone acceleration whose name ends in no
/// axis is the x of one. Errors: invalid_argument (a recording without one; the message names it).
[[nodiscard]] Result<std::vector<Accelerometer>> accelerometers(
    const std::vector<Recording>& recordings);

/// Applies the models, one for all accelerometers or one for each, or none; then brings every
/// accelerometer channel to m/s^2. Errors: invalid_argument (those of the one for one sensor, a
/// wrong number of models, a channel that is not an acceleration by then; the message names it).
[[nodiscard]] Status apply(const std::vector<SensorModel>& models,
                           const std::vector<Accelerometer>& found,
                           std::vector<Recording>& recordings);

/// Some channels of samples that come a block at a time: accelerometers calibrated and in m/s^2,
/// angular rates in rad/s, the others as they are.
class CalibratedBlocks {
 public:
  /// Blocks of these channels of `head`, a recording that may be without values.
  /// Errors: those of accelerometers() and apply().
  [[nodiscard]] static Result<CalibratedBlocks> make(const Recording& head,
                                                     std::vector<std::size_t> channels,
                                                     std::vector<SensorModel> models);

  [[nodiscard]] const std::vector<Accelerometer>& accelerometers() const { return found_; }
  [[nodiscard]] const std::vector<SensorModel>& models() const { return models_; }
  /// The channels as they come out, without values.
  [[nodiscard]] const Recording& head() const { return head_; }
  /// `raw` has all channels of the head that it was made of. The result is valid until the next
  /// call. Errors: those of apply().
  [[nodiscard]] Result<Block> apply(const Block& raw);

 private:
  CalibratedBlocks() = default;
  [[nodiscard]] Status to_si();

  std::vector<SensorModel> models_;
  std::vector<std::size_t> channels_;
  std::vector<Unit> units_;        ///< in which they come
  std::vector<Recording> pieces_;  ///< one: the current block
  std::vector<Accelerometer> found_;
  Recording head_;
};

}  // namespace proofmass::sensor
