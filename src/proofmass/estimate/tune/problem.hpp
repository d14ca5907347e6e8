#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "proofmass/core/view.hpp"
#include "proofmass/estimate/tune.hpp"
#include "proofmass/estimate/tune/score.hpp"

// The likelihood of some channels as a function of the logarithms of the unknowns.
namespace proofmass::estimate {

/// One unknown: a parameter of one channel, or of several that share it.
struct TuneUnknown {
  std::size_t parameter = 0;
  std::vector<std::size_t> series;
};

/// Finite values of a channel.
[[nodiscard]] std::size_t count_readings(const TuneSeries& series);

class TuneProblem {
 public:
  TuneProblem(TuneModel model, std::vector<const TuneSeries*> series);

  std::vector<TuneUnknown> unknowns;
  /// Every parameter of each series; unknowns are overwritten by set().
  std::vector<std::vector<double>> values;

  [[nodiscard]] TuneModel model() const { return model_; }
  [[nodiscard]] const std::vector<const TuneSeries*>& series() const { return series_; }
  [[nodiscard]] const TuneParameter& parameter(std::size_t unknown) const {
    return parameters_of(model_)[unknowns[unknown].parameter];
  }
  [[nodiscard]] std::vector<double> logs() const;
  void set(View<double> logs);
  void set(std::size_t unknown, double value);
  [[nodiscard]] double value(std::size_t unknown) const;

  [[nodiscard]] TuneSystem system(std::size_t series) const;
  [[nodiscard]] double log_likelihood() const;
  /// Over the first `most` samples of each segment.
  [[nodiscard]] TuneScore forward_score(std::size_t most) const;

  struct Slope {
    double log_likelihood = 0.0;
    std::vector<double> gradient;                    ///< by the logarithm of each unknown
    std::vector<std::size_t> readings, transitions;  ///< that depend on each unknown
  };
  [[nodiscard]] Slope slope() const;
  [[nodiscard]] std::size_t readings() const { return readings_; }

 private:
  TuneModel model_;
  std::vector<const TuneSeries*> series_;
  std::size_t readings_ = 0;
};

/// One step of expectation–maximisation for the white noises; a Markov bias is unchanged. As E[w
/// wᵀ] follows from the score, it is θ ← θ (1 + 2/(n rank) ∂L/∂ln θ) for each variance θ of n
/// vectors. Never lowers the likelihood. Returns that before the step.
double em_step(TuneProblem& problem);

struct TuneMaximum {
  double log_likelihood = 0.0;
  int iterations = 0;
  bool converged = false;
};

/// Maximises locally; with `polished`, to machine precision by Newton steps.
TuneMaximum maximise(TuneProblem& problem, bool polished = true);

/// −∂²L/∂ln θ², by central differences of the gradient.
[[nodiscard]] Eigen::MatrixXd information(const TuneProblem& problem);

}  // namespace proofmass::estimate
