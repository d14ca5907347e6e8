#include "proofmass/estimate/tune_choice.hpp"

#include <utility>

namespace proofmass::estimate {
namespace {

bool is_rest(TuneModel model) {
  return model == TuneModel::rest || model == TuneModel::rest_markov;
}

double share_of(const std::vector<signal::Rest>& rests, std::size_t samples) {
  std::size_t inside = 0;
  for (const signal::Rest& rest : rests) inside += rest.last - rest.first + 1;
  return samples == 0 ? 0.0 : static_cast<double>(inside) / static_cast<double>(samples);
}

}  // namespace

TuneChoice choose_tune_model(View<View<double>> axes, const TuneChoiceOptions& options) {
  constexpr double nearly_all = 0.9;
  const std::optional<TuneModel>& given = options.given;
  TuneChoice choice;
  if (given) {
    choice.model = *given;
    if (!is_rest(*given)) return choice;
  } else if (!options.measures_acceleration) {
    return {TuneModel::local_level, TuneBasis::no_acceleration, {}, {}};
  }
  std::vector<signal::Rest> rests;
  if (!axes.empty()) rests = signal::find_rests(axes, {.rate_hz = options.rate_hz}).rests;
  const double share = axes.empty() ? 0.0 : share_of(rests, axes.front().size());
  choice.rest_share = share;
  if (!given && share < nearly_all) {
    choice.model = TuneModel::pva;
    choice.basis = TuneBasis::in_motion;
    return choice;
  }
  if (!given) choice.basis = TuneBasis::at_rest;
  if (share < 1.0) choice.rests = std::move(rests);
  return choice;
}

TuneSeries tune_series(std::string name,
                       double rate_hz,
                       View<double> values,
                       const TuneChoice& choice) {
  TuneSeries series{.name = std::move(name), .rate_hz = rate_hz, .segments = {}};
  if (choice.rests.empty()) series.segments.push_back(values);
  for (const signal::Rest& rest : choice.rests) {
    series.segments.push_back(values.subspan(rest.first, rest.last - rest.first + 1));
    series.starts_s.push_back(static_cast<double>(rest.first) / rate_hz);
  }
  return series;
}

}  // namespace proofmass::estimate
