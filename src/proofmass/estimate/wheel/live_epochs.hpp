#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "proofmass/core/block.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/estimate/filter/gaussian.hpp"
#include "proofmass/estimate/wheel/live_late_rows.hpp"

// From blocks of samples to the epochs of an online filter.
namespace proofmass::estimate {

/// Three channels of one vector, and their kind.
struct LiveVector {
  Triad channels;
  bool is_rate = false;  ///< a gyroscope's; else an accelerometer's
};

inline constexpr std::size_t most_live_vectors = 4;

struct LiveEpoch {
  double time_s = 0.0;
  bool anew = false;  ///< the clock was set back: earlier epochs are on another time line
  /// m/s² and rad/s, an axis without channel is 0; NaN without a plausible measurement.
  std::array<Mat<3>, most_live_vectors> vectors{};

  [[nodiscard]] bool has(std::size_t vector) const { return !std::isnan(vectors[vector](0)); }
};

struct LiveClock {
  double rate_hz = 0.0;         ///< of the samples; 0: estimated from the first of them
  double most_rate_hz = 500.0;  ///< faster samples are averaged down to this
};

/// Screens samples, and averages them so that there are at most `most_rate_hz` epochs a second: at
/// that rate and below every sample is an epoch, available immediately. A mean ends where samples
/// are missing. Rows that a busy computer stamped late wait until one is on time again
/// (LiveLateRows). The result does not depend on the block size.
class LiveEpochs {
 public:
  LiveEpochs(std::vector<LiveVector> vectors, const LiveClock& clock);

  /// Calls visit(const LiveEpoch&) for each complete epoch. Errors: invalid_argument (channels
  /// that the block lacks, neither time stamps nor a known rate).
  template <class Visit>
  [[nodiscard]] Status add(const Block& samples, Visit&& visit) {
    if (auto status = check(samples); !status) return status;
    for (std::size_t row = 0; row < samples.rows(); ++row) {
      if (late_.holds(samples, row, last_time_s_, clock_.rate_hz)) continue;
      take_late(visit);
      if (take(samples, row)) visit(static_cast<const LiveEpoch&>(epoch_));
    }
    return Done{};
  }
  /// The last mean, with fewer samples than the others.
  template <class Visit>
  void finish(Visit&& visit) {
    take_late(visit);
    if (close()) visit(static_cast<const LiveEpoch&>(epoch_));
  }

  /// Notes on measurements dropped since the last call.
  [[nodiscard]] std::vector<Note> take_notes();

 private:
  struct Sum {
    Mat<3> total = Mat<3>::Zero();
    double count = 0.0;
  };
  /// Whether an axis is at the end of its range: three equal measurements and more, none larger so
  /// far, reached more steeply than a crest in quantisation steps would be.
  class Range {
   public:
    bool ends_at(double value);
    /// Smaller magnitudes are not at the end.
    void set_least(double magnitude) { most_ = magnitude; }

   private:
    double most_ = 0.0;
    double last_ = std::numeric_limits<double>::quiet_NaN(), before_ = last_;
    double slope_ = 0.0;  ///< at which the last value was reached
    double step_ = std::numeric_limits<double>::infinity();  ///< the smallest
    std::size_t equal_ = 1;
  };
  /// Whether a measurement repeats the one before, as from a logger that is stuck, although the
  /// noise of an axis exceeds its quantisation step. The noise is that of the quietest 32
  /// measurements, from fourth differences, which contain hardly any motion. A sensor may still
  /// come to rest without noise: repetitions count again after 3 s.
  class Repeats {
   public:
    bool is_repeated(const std::array<double, 3>& value, double time_s);

   private:
    static constexpr double unknown = std::numeric_limits<double>::infinity();
    struct AxisNoise {
      std::array<double, 4> before{};  ///< newest first
      double sum2 = 0.0;               ///< of the fourth differences since the last 32
      double noise2 = unknown, step = unknown;
    };
    void add(double value, AxisNoise& axis) const;
    [[nodiscard]] bool has_noise() const;

    std::array<AxisNoise, 3> axes_{};
    std::size_t added_ = 0;  ///< measurements without repetitions
    double last_change_s_ = 0.0;
  };
  struct Rejected {
    std::size_t count = 0;
    double last_s = 0.0;
    const char* why = nullptr;
  };

  [[nodiscard]] Status check(const Block& samples) const;
  template <class Visit>
  void take_late(Visit&& visit) {
    if (late_.empty()) return;
    const Block late = late_.take();
    for (std::size_t row = 0; row < late.rows(); ++row)
      if (take(late, row)) visit(static_cast<const LiveEpoch&>(epoch_));
  }
  [[nodiscard]] bool take(const Block& samples, std::size_t row);
  [[nodiscard]] bool follows(double time_s);
  void learn_rate(double time_s);
  void sum_up(const Block& samples, std::size_t row, double time_s);
  [[nodiscard]] const char* why_not(std::size_t vector,
                                    const std::array<double, 3>& value,
                                    double time_s);
  [[nodiscard]] bool close();

  std::vector<LiveVector> vectors_;
  LiveClock clock_;
  LiveLateRows late_;
  std::size_t each_ = 1;       ///< samples in a mean
  std::size_t rows_seen_ = 0;  ///< while the rate is being estimated
  double first_time_s_ = 0.0;

  std::array<Sum, most_live_vectors> sums_{};
  double time_sum_s_ = 0.0;  ///< minus first_in_mean_s_ each
  double first_in_mean_s_ = 0.0;
  std::size_t in_mean_ = 0;
  double last_time_s_ = -std::numeric_limits<double>::infinity();
  double last_behind_s_ = 0.0;  ///< of the stamps earlier than the last
  std::size_t behind_ = 0;      ///< number of those that ascend
  bool anew_ = false, mean_is_anew_ = false;
  LiveEpoch epoch_;

  std::array<std::array<Range, 3>, most_live_vectors> ranges_{};
  std::array<Repeats, most_live_vectors> repeats_{};
  std::array<Rejected, most_live_vectors> rejected_{};
  Rejected backwards_;
  std::vector<Note> notes_;
};

/// "12.34" of seconds, for sentences.
[[nodiscard]] std::string at_second(double time_s);

}  // namespace proofmass::estimate
