#include <algorithm>
#include <bit>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/characterise/noise_accumulator.hpp"
#include "proofmass/fleet/noise_sums.hpp"
#include "proofmass/signal/recording_sequence.hpp"

namespace proofmass::fleet {
namespace {

Error does_not_fit(const std::string& file, const std::string& why) {
  return {Errc::invalid_argument, file + ": --as-one: " + why};
}

Result<std::vector<double>> starts_of(const std::vector<RecordingSums>& parts,
                                      const std::vector<double>& given_s) {
  std::vector<double> starts_s;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const std::optional<double>& own_s = parts[k].clock_s;
    if (given_s.empty() && !own_s)
      return does_not_fit(parts[k].file,
                          "it has no clock from which its start is known: give --starts S,S…");
    starts_s.push_back(given_s.empty()
                           ? *own_s
                           : start_near(given_s[k], given_s.front(), own_s, parts[0].clock_s));
  }
  return starts_s;
}

// First valid sample on the grid, for each channel of the first recording.
Result<std::vector<std::size_t>> origins_of(const std::vector<RecordingSums>& parts,
                                            const std::vector<std::size_t>& firsts) {
  std::vector<std::size_t> origins;
  for (std::size_t channel = 0; channel < parts.front().channels.size(); ++channel) {
    std::optional<std::size_t> origin;
    for (std::size_t k = 0; k < parts.size(); ++k) {
      const auto place = matching_channel(parts[k], parts.front(), channel);
      if (!place) return place.error();
      const auto& valid = parts[k].channels[*place].first_valid;
      if (!origin && valid) origin = firsts[k] + *valid;
    }
    origins.push_back(origin.value_or(0));
  }
  return origins;
}

}  // namespace

double start_near(double given_s,
                  double first_given_s,
                  const std::optional<double>& own_s,
                  const std::optional<double>& first_own_s) {
  constexpr double coarse_s = 1.0;
  if (!own_s || !first_own_s) return given_s;
  const double by_clock_s = first_given_s + *own_s - *first_own_s;
  return std::abs(by_clock_s - given_s) <= coarse_s ? by_clock_s : given_s;
}

Result<std::size_t> matching_channel(const RecordingSums& part,
                                     const RecordingSums& first,
                                     std::size_t channel) {
  constexpr double most_apart = 1e-3;
  const SummedChannel& wanted = first.channels[channel];
  const auto found = std::ranges::find(part.channels, wanted.name, &SummedChannel::name);
  if (found == part.channels.end())
    return does_not_fit(part.file,
                        fmt::format("it has no channel {}, which {} has", wanted.name, first.file));
  if (found->unit != wanted.unit)
    return does_not_fit(part.file, fmt::format("{} is in {}, in {} in {}", wanted.name,
                                               found->unit.symbol, first.file, wanted.unit.symbol));
  if (std::abs(part.rate_hz - first.rate_hz) > most_apart * first.rate_hz)
    return does_not_fit(part.file, fmt::format("it has {:.6g} Hz, {} has {:.6g} Hz", part.rate_hz,
                                               first.file, first.rate_hz));
  return static_cast<std::size_t>(found - part.channels.begin());
}

Result<std::vector<SumsPlace>> places_of(const std::vector<RecordingSums>& parts,
                                         const std::vector<double>& starts_s) {
  const auto starts = starts_of(parts, starts_s);
  if (!starts) return starts.error();
  // No term of a deviation reaches over a gap as long as all recordings together.
  std::size_t all = 0;
  for (const RecordingSums& part : parts) all += part.samples;
  signal::RecordingSequence sequence(parts.front().rate_hz, all);
  std::vector<std::size_t> firsts;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const auto missing = sequence.append((*starts)[k], parts[k].samples);
    if (!missing) return does_not_fit(parts[k].file, missing.error().message);
    firsts.push_back(sequence.samples() - parts[k].samples);
  }
  const auto origins = origins_of(parts, firsts);
  if (!origins) return origins.error();
  std::vector<SumsPlace> places;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    SumsPlace& place = places.emplace_back();
    place.first = firsts[k];
    place.as_samples = sequence.samples() <= characterise::decimate_above;
    if (place.as_samples) continue;
    place.digits = static_cast<std::size_t>(std::bit_width(sequence.samples()));
    place.origins.resize(parts[k].channels.size(), 0);
    for (std::size_t channel = 0; channel < origins->size(); ++channel)
      place.origins[matching_channel(parts[k], parts.front(), channel).value()] =
          (*origins)[channel];
  }
  return places;
}

}  // namespace proofmass::fleet
