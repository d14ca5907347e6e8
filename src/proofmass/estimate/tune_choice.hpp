#pragma once

#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/view.hpp"
#include "proofmass/estimate/tune.hpp"
#include "proofmass/estimate/tune/model.hpp"
#include "proofmass/signal/rests.hpp"

// Which model suits a recording, and which of its samples to tune it on.
namespace proofmass::estimate {

enum class TuneBasis {
  given,            ///< by the caller
  no_acceleration,  ///< the channels do not measure acceleration
  at_rest,          ///< at least 90 % of the samples are in static intervals
  in_motion,
};

struct TuneChoice {
  TuneModel model = TuneModel::rest;
  TuneBasis basis = TuneBasis::given;
  std::optional<double>
      rest_share;                   ///< of the measured samples; absent where rests were not sought
  std::vector<signal::Rest> rests;  ///< to tune on; empty: the whole recording
};

struct TuneChoiceOptions {
  double rate_hz = 0.0;
  bool measures_acceleration = true;              ///< or volts or counts that stand for one
  std::optional<TuneModel> given = std::nullopt;  ///< the samples are still chosen
};

/// Chooses the model of a recording with these axes (up to three, of one rate and length), and the
/// samples to tune it on: rest if at least 90 % of the samples are at rest, else pva; local_level
/// if the axes do not measure acceleration. A model of rest is tuned on the static intervals alone
/// if there are any, every other on the whole recording. Cost: that of signal::find_rests().
[[nodiscard]] TuneChoice choose_tune_model(View<View<double>> axes,
                                           const TuneChoiceOptions& options);

/// A channel as tune() takes it, restricted to the samples of the choice. `values` must outlive it.
[[nodiscard]] TuneSeries tune_series(std::string name,
                                     double rate_hz,
                                     View<double> values,
                                     const TuneChoice& choice);

}  // namespace proofmass::estimate
