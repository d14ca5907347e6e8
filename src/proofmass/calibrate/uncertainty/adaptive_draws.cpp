#include "proofmass/calibrate/uncertainty/adaptive_draws.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <thread>

#include "proofmass/calibrate/uncertainty/monte_carlo.hpp"
#include "proofmass/core/contract.hpp"
#include "proofmass/core/in_parallel.hpp"
#include "proofmass/core/statistics.hpp"

namespace proofmass::calibrate {
namespace {

// Results of one batch for one output: mean, standard deviation, ends of the 95 % interval.
using BatchResult = std::array<double, 4>;

// JCGM 101, 7.9.4, steps e to i, for one output.
class Stability {
 public:
  void add(const std::vector<double>& draws) {
    const Result<Propagation> found = summary_of(draws);
    if (!found) {
      without_result_ = true;
      return;
    }
    const BatchResult result{found->mean, found->std, found->symmetric_95.lower,
                             found->symmetric_95.upper};
    for (std::size_t k = 0; k < result.size(); ++k) batches_[k].push_back(result[k]);
    for (const double draw : draws) all_.add(draw);
  }

  [[nodiscard]] bool reached(int digits) const {
    if (without_result_ || batches_[0].size() < 2) return false;
    const double tolerance = numerical_tolerance(all_.std(), digits);
    return std::ranges::all_of(batches_, [&](const std::vector<double>& values) {
      const double error = moments(values).std() / std::sqrt(static_cast<double>(values.size()));
      return 2.0 * error <= tolerance;
    });
  }

 private:
  std::array<std::vector<double>, 4> batches_;
  Moments all_;
  bool without_result_ = false;
};

}  // namespace

AdaptiveDraws draw_until_stable(std::size_t outputs,
                                const FillBatch& fill,
                                const AdaptiveOptions& options) {
  PM_EXPECTS(outputs > 0 && options.batch >= 100 && options.most >= 2 * options.batch);
  const std::size_t batches = options.most / options.batch;
  const std::size_t at_once = std::max(1U, std::thread::hardware_concurrency());
  AdaptiveDraws out{std::vector<std::vector<double>>(outputs), false};
  std::vector<Stability> stability(outputs);
  for (std::size_t first = 0; first < batches && !out.stable; first += at_once) {
    const std::size_t count = std::min(at_once, batches - first);
    std::vector<std::vector<std::vector<double>>> drawn(count,
                                                        std::vector<std::vector<double>>(outputs));
    in_parallel(count, {}, [&](std::size_t k, const Progress&) { fill(first + k, drawn[k]); });
    for (std::size_t k = 0; k < count && !out.stable; ++k) {
      for (std::size_t j = 0; j < outputs; ++j) {
        stability[j].add(drawn[k][j]);
        out.columns[j].insert(out.columns[j].end(), drawn[k][j].begin(), drawn[k][j].end());
      }
      out.stable = std::ranges::all_of(
          stability, [&](const Stability& one) { return one.reached(options.digits); });
    }
    if (options.progress)
      options.progress("Monte Carlo",
                       static_cast<double>(first + count) / static_cast<double>(batches));
  }
  return out;
}

}  // namespace proofmass::calibrate
