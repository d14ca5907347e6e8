#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/estimate/tune/problem.hpp"

// Measurements that no noise of the model explains.
namespace proofmass::estimate {

/// The measurements of some channels, less those found to be outliers. The series of the caller
/// must outlive it.
class TuneReadings {
 public:
  explicit TuneReadings(std::vector<TuneSeries> series);
  TuneReadings(const TuneReadings&) = delete;  // segments refer to `cleaned_`
  TuneReadings(TuneReadings&&) = default;
  TuneReadings& operator=(const TuneReadings&) = delete;
  TuneReadings& operator=(TuneReadings&&) = default;
  ~TuneReadings() = default;

  [[nodiscard]] const std::vector<TuneSeries>& series() const { return series_; }
  [[nodiscard]] const std::vector<TuneOutliers>& outliers() const { return outliers_; }

  /// The share of a channel's measurements that were outliers, of the channel with most.
  [[nodiscard]] double largest_share() const;

  /// Sets the outliers among the measurements to NaN and returns their number. With the parameters
  /// of the problem, an outlier is further from what all others predict than noise of n
  /// measurements is once in a thousand records, √(2 ln 1000 n) standard deviations, and more than
  /// one step of a coarse converter. At most five such measurements follow one another, and it is
  /// beyond those beside them: a step or a motion is not. The problem has the series() of this
  /// object.
  std::size_t drop_outliers(const TuneProblem& problem);

 private:
  void drop(std::size_t series, std::size_t segment, std::size_t k, double residual);

  std::vector<TuneSeries> series_;
  std::vector<std::vector<std::vector<double>>> cleaned_;  // segments with outliers
  std::vector<double> resolution_;                         // least distance of two values
  std::vector<std::size_t> count_;                         // of measurements, outliers included
  std::vector<TuneOutliers> outliers_;
};

}  // namespace proofmass::estimate
