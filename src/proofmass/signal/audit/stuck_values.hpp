#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "proofmass/core/view.hpp"
#include "proofmass/signal/resample/sample_times.hpp"

namespace proofmass::signal {

/// The runs of equal values at the lowest or highest value so far.
struct RailRuns {
  static constexpr std::size_t shortest_run = 3;

  double rail = 0.0;
  std::size_t samples = 0;                   ///< in runs of shortest_run or more
  std::size_t runs = 0;                      ///< number of these runs
  std::size_t longest = 0;                   ///< longest of all runs
  std::size_t visits = 0, brief_visits = 0;  ///< runs of any length; of one or two samples
  std::size_t all_samples = 0;               ///< in runs of any length
  /// Slope at which the rail was reached, for each run of shortest_run or more (the first
  /// most_approaches of them): the smaller of the last two steps towards it, times a quarter of the
  /// run length if that is below four. A crest sampled in quantisation steps is flat for a run of L
  /// only if the previous step is below 8 / L of them.
  std::vector<double> approaches{};
  static constexpr std::size_t most_approaches = 4096;

  void add(std::size_t run) {
    longest = std::max(longest, run);
    samples += run >= shortest_run ? run : 0;
    runs += run >= shortest_run ? 1 : 0;
    ++visits;
    brief_visits += run < shortest_run ? 1 : 0;
    all_samples += run;
  }
  /// For a run that was added: the two values before it, the later one first.
  void add_approach(std::size_t run, double before, double earlier);
  /// True if, for a quantisation step of this size, the signal runs into the rail and does not
  /// merely stay at its extreme.
  [[nodiscard]] bool is_run_into(double lsb) const;
};

/// Runs of equal values in a channel that arrives in chunks: the longest, those at either extreme,
/// and the longest elsewhere.
///
/// While the extremes change, so do the rails. Nothing is lost: a new extreme has not occurred
/// before, and the runs at the old one become runs elsewhere.
class StuckValues {
 public:
  /// Adds plausible values that follow the previous ones; `low` and `high` are the extremes of
  /// their chunk.
  void add(
      View<double> values, std::size_t first, const SampleTimes& times, double low, double high);
  /// Ends the current run.
  void end_run();

  [[nodiscard]] const RailRuns& low() const { return low_; }
  [[nodiscard]] const RailRuns& high() const { return high_; }
  /// The longest run at any value except the lowest and the highest.
  [[nodiscard]] std::size_t longest_elsewhere() const { return elsewhere_; }
  [[nodiscard]] std::size_t longest() const { return longest_; }
  [[nodiscard]] Place longest_start() const { return longest_start_; }

 private:
  void move_rails(double low, double high);
  void take_run(double value, std::size_t run, Place start);
  void take_rail_runs(View<double> values, std::size_t first, const SampleTimes& times);
  void take_long_runs(View<double> values, std::size_t first, const SampleTimes& times);

  RailRuns low_, high_;
  bool has_rails_ = false;
  std::size_t elsewhere_ = 0;
  std::size_t longest_ = 0;
  Place longest_start_;
  double value_ = 0.0;  ///< value of the current run
  std::size_t run_ = 0;
  Place start_;
};

}  // namespace proofmass::signal
