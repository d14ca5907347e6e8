#include "proofmass/estimate/tune_choice.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace proofmass::estimate {
namespace {

// A sample counts where every axis is measured, so that a gap is neither rest nor motion.
double share_of(const std::vector<signal::Rest>& rests, View<View<double>> axes) {
  const auto measured = [&](std::size_t from, std::size_t end) {
    std::size_t count = 0;
    for (std::size_t k = from; k < end; ++k) {
      if (std::ranges::all_of(axes, [k](View<double> axis) { return std::isfinite(axis[k]); }))
        ++count;
    }
    return static_cast<double>(count);
  };
  const double all = axes.empty() ? 0.0 : measured(0, axes.front().size());
  double inside = 0.0;
  for (const signal::Rest& rest : rests) inside += measured(rest.first, rest.last + 1);
  return all == 0.0 ? 0.0 : inside / all;
}

}  // namespace

TuneChoice choose_tune_model(View<View<double>> axes, const TuneChoiceOptions& options) {
  constexpr double nearly_all = 0.9;
  const std::optional<TuneModel>& given = options.given;
  TuneChoice choice;
  if (given) {
    choice.model = *given;
    if (!is_of_rest(*given)) return choice;
  } else if (!options.measures_acceleration) {
    return {TuneModel::local_level, TuneBasis::no_acceleration, {}, {}};
  }
  std::vector<signal::Rest> rests;
  if (!axes.empty()) rests = signal::find_rests(axes, {.rate_hz = options.rate_hz}).rests;
  const double share = share_of(rests, axes);
  choice.rest_share = share;
  if (!given && share < nearly_all) {
    choice.model = TuneModel::pva;
    choice.basis = TuneBasis::in_motion;
    return choice;
  }
  if (!given) choice.basis = TuneBasis::at_rest;
  if (share < 1.0 || rests.size() > 1) choice.rests = std::move(rests);
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
