#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/core/view.hpp"
#include "proofmass/signal/even_grid.hpp"
#include "proofmass/signal/resample/stamp_band.hpp"

namespace proofmass::signal {

/// Decides from the stamps, as they arrive, where samples are missing. Shared by even_grid() and
/// RunningEvenGrid.
class HoleFinder {
 public:
  /// band_s: that of the TimeBase.
  explicit HoleFinder(double rate_hz, double band_s = 0.0) : rate_hz_(rate_hz) {
    if (band_s > 0.0) band_.emplace(1.0 / rate_hz, band_s);
  }
  /// Maximum number of later rows needed to decide on a sample.
  static constexpr std::size_t most_undecided = 4096;

  /// Appends the holes that are determined by now.
  void add(View<double> stamps_s, std::vector<Hole>& holes);
  /// Appends the holes among the last samples; call after all stamps are added.
  void finish(std::vector<Hole>& holes);
  /// Adds samples without stamps: none is missing.
  void add_even(std::size_t samples) { decided_ = samples_ += samples; }

  /// Number of samples for which the number missing before them is determined.
  [[nodiscard]] std::size_t decided() const { return decided_; }
  [[nodiscard]] std::size_t samples() const { return samples_; }
  [[nodiscard]] double missing() const { return missing_; }
  [[nodiscard]] std::size_t hole_count() const { return hole_count_; }
  /// Standard deviation of missing(), due to intervals that do not show the number clearly.
  [[nodiscard]] double missing_std() const { return std::sqrt(doubt_); }
  /// StampBand::unfilled(); 0 without a band.
  [[nodiscard]] double unfilled_s() const { return band_ ? band_->unfilled() : 0.0; }

  /// Errors: corrupt, if more than 3 × `samples` + `spare` are missing.
  [[nodiscard]] Status check(std::size_t samples, double spare) const;
  /// Rate, samples, missing and jitter so far, without the list of holes.
  [[nodiscard]] EvenGrid grid() const;

 private:
  void decide(bool is_end, std::vector<Hole>& holes);
  [[nodiscard]] bool may_be_two(double steps) const;
  [[nodiscard]] bool is_long(std::size_t at) const;
  [[nodiscard]] std::size_t needed_after(std::size_t at) const;
  void decide_by_band(bool is_end, std::vector<Hole>& holes);
  void count(double missing, std::vector<Hole>& holes);
  [[nodiscard]] double number_of(std::size_t at) const;
  [[nodiscard]] double lateness(std::size_t at, std::size_t than) const;
  [[nodiscard]] double median_lateness(std::size_t from, std::size_t end, std::size_t than) const;
  [[nodiscard]] double missing_before(std::size_t at);
  void add_doubt(double off);
  [[nodiscard]] double missing_after_stall(std::size_t at, double missing) const;

  double rate_hz_;
  std::optional<StampBand> band_;
  std::vector<double> recent_;  ///< stamps, from a few before the first undecided sample
  std::vector<Hole> near_;      ///< the last ones found, with which the next may be compared
  std::size_t samples_ = 0, decided_ = 0;
  double first_s_ = 0.0, last_s_ = 0.0;
  double missing_ = 0.0, doubt_ = 0.0;  ///< doubt: variance
  std::size_t hole_count_ = 0;
  double squares_ = 0.0;  ///< sum of (interval · rate − 1)² over the intervals that are not long
  std::size_t regular_ = 0;
  bool ascending_ = true;
};

}  // namespace proofmass::signal
