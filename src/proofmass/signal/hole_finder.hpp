#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/core/view.hpp"
#include "proofmass/signal/even_grid.hpp"
#include "proofmass/signal/stamp_band.hpp"

namespace proofmass::signal {

/// Decides where samples are missing from their stamps as these come: the one place where
/// even_grid() and RunningEvenGrid have it from.
class HoleFinder {
 public:
  /// band_s: of the TimeBase.
  explicit HoleFinder(double rate_hz, double band_s = 0.0) : rate_hz_(rate_hz) {
    if (band_s > 0.0) band_.emplace(1.0 / rate_hz, band_s);
  }
  /// Rows behind a sample that may be needed to decide on it.
  static constexpr std::size_t most_undecided = StampBand::ahead;

  /// Appends the holes that can be told by now.
  void add(View<double> stamps_s, std::vector<Hole>& holes);
  /// Appends the holes among the last samples; when all stamps are added.
  void finish(std::vector<Hole>& holes);
  /// Samples without stamps: none of them is missing.
  void add_even(std::size_t samples) { decided_ = samples_ += samples; }

  /// Samples of which it is known what is missing before them.
  [[nodiscard]] std::size_t decided() const { return decided_; }
  [[nodiscard]] std::size_t samples() const { return samples_; }
  [[nodiscard]] double missing() const { return missing_; }
  [[nodiscard]] std::size_t hole_count() const { return hole_count_; }

  /// Errors: corrupt, where more than 3 × `samples` + `spare` are missing.
  [[nodiscard]] Status check(std::size_t samples, double spare) const;
  /// Rate, samples, missing and jitter of what was added; no list of holes.
  [[nodiscard]] EvenGrid grid() const;

 private:
  void decide(bool is_end, std::vector<Hole>& holes);
  void decide_by_band(bool is_end, std::vector<Hole>& holes);
  void count(double missing, std::vector<Hole>& holes);
  [[nodiscard]] double missing_before(std::size_t at) const;

  double rate_hz_;
  std::optional<StampBand> band_;
  std::vector<double> recent_;  ///< stamps from some before the first undecided sample on
  std::size_t samples_ = 0, decided_ = 0;
  double first_s_ = 0.0, last_s_ = 0.0;
  double missing_ = 0.0;
  std::size_t hole_count_ = 0;
  double squares_ = 0.0;  ///< of (step · rate − 1) over the steps that are not long
  std::size_t regular_ = 0;
  bool ascending_ = true;
};

}  // namespace proofmass::signal
