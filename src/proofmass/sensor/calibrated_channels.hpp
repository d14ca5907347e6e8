#pragma once

#include <array>
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

  /// Makes three channels, as they come out, the gyroscope of accelerometer `at`, calibrated if its
  /// model has a gyroscope's figures. Channels of an unknown unit are in that of the calibration
  /// or, without one, in `unit_if_unknown`. Errors: invalid_argument (a calibration of volts or
  /// counts for channels in a unit of angular rate, and those of apply()).
  [[nodiscard]] Status add_gyroscope(std::size_t at,
                                     const std::array<std::size_t, 3>& channels,
                                     const Unit& unit_if_unknown);

  [[nodiscard]] const std::vector<Accelerometer>& accelerometers() const { return found_; }
  [[nodiscard]] const std::vector<SensorModel>& models() const { return models_; }
  /// The channels as they come out, without values.
  [[nodiscard]] const Recording& head() const { return head_; }
  /// `raw` has all channels of the head that it was made of. The result is valid until the next
  /// call. Errors: those of apply().
  [[nodiscard]] Result<Block> apply(const Block& raw);

 private:
  struct Gyroscope {
    std::size_t accelerometer = 0;
    std::array<std::size_t, 3> channels{};
  };

  CalibratedBlocks() = default;
  [[nodiscard]] const SensorModel* model_of(std::size_t accelerometer) const;
  [[nodiscard]] Status to_si();
  [[nodiscard]] Status calibrate(const Gyroscope& gyroscope);

  std::vector<SensorModel> models_;
  std::vector<std::size_t> channels_;
  std::vector<Unit> units_;        ///< in which they come
  std::vector<Recording> pieces_;  ///< one: the current block
  std::vector<Accelerometer> found_;
  std::vector<Gyroscope> calibrated_gyroscopes_;
  Recording head_;
};

}  // namespace proofmass::sensor
