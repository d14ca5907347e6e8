#include <algorithm>
#include <cmath>

#include "proofmass/report/noise/fields.hpp"
#include "proofmass/report/noise/wording.hpp"

namespace proofmass::report {
namespace {

using characterise::NoiseAnalysis;

// Means over intervals that are even on a log scale. An interval contains either only line bins or
// none, which preserves the position and power of the lines.
struct ThinnedSpectrum {
  std::vector<double> frequency_hz, one_sided_psd;
};

ThinnedSpectrum thinned_spectrum(const NoiseAnalysis& analysis) {
  constexpr double most_points = 500.0;
  const signal::Spectrum& spectrum = analysis.spectrum;
  const std::vector<bool>& in_line = analysis.lines.in_line;
  // The first and last bins are half as wide, so their densities are not comparable.
  const std::size_t bins = spectrum.frequency_hz.size() - 1;
  const auto marked = [&](std::size_t k) { return k < in_line.size() && in_line[k]; };
  const double ratio =
      std::pow(static_cast<double>(std::max<std::size_t>(bins, 2)), 1.0 / most_points);
  ThinnedSpectrum out;
  for (std::size_t k = 1; k < bins;) {
    const double limit = spectrum.frequency_hz[k] * ratio;
    double f = 0.0, psd = 0.0;
    std::size_t end = k;
    do {
      f += spectrum.frequency_hz[end];
      psd += spectrum.one_sided_psd[end];
      ++end;
    } while (end < bins && spectrum.frequency_hz[end] < limit && marked(end) == marked(k));
    const auto n = static_cast<double>(end - k);
    out.frequency_hz.push_back(f / n);
    out.one_sided_psd.push_back(psd / n);
    k = end;
  }
  return out;
}

std::optional<Fields> spectrum_of(const ChannelNoise& channel) {
  if (!has_spectrum(channel)) return std::nullopt;
  const signal::Spectrum& found = channel.analysis->spectrum;
  const ThinnedSpectrum thin = thinned_spectrum(*channel.analysis);
  const auto segment = static_cast<double>(std::max<std::size_t>(found.segment, 1));
  return Fields{field::choice("window", "hann", {"hann"}),
                field::count("segment", found.segment, {.meaning = "samples"}),
                field::count("averaged", found.averaged, {.meaning = "segments"}),
                field::magnitude("resolution_hz", found.rate_hz / segment),
                field::magnitude("noise_bandwidth_hz", found.window_bandwidth_hz),
                field::magnitude("edf_per_bin", found.edf_per_bin),
                field::text("unit", squared_unit(channel.unit, NoiseScale::density)),
                field::numbers("frequency_hz", thin.frequency_hz),
                field::numbers("one_sided_psd", thin.one_sided_psd)};
}

Fields spectrum_fields(const ChannelNoise& channel) {
  std::optional<Uncertain> floor;
  if (channel.analysis && channel.analysis->lines.floor.one_sided_density > 0.0)
    floor = Uncertain{channel.analysis->lines.floor.one_sided_density,
                      channel.analysis->lines.floor.std};
  const auto why = [&](const char* reason) {
    return channel.analysis ? reason : why_not_analysed(channel);
  };
  const std::string density = noise_unit(channel.unit, NoiseScale::density);
  const std::string why_no_floor = why("no part of the spectrum is flat");
  return {
      field::measured("spectrum_floor", floor, density,
                      {.meaning = "lowest level that the spectrum keeps for an octave; one-sided, "
                                  "as densities in data sheets",
                       .why_null = why_no_floor}),
      field::measured("spectrum_floor_two_sided", scaled(floor, 1.0 / std::numbers::sqrt2), density,
                      {.meaning = "comparable with white and with the deviation at 1 s",
                       .why_null = why_no_floor}),
      field::object_or_null("spectrum", spectrum_of(channel),
                            {.meaning = "by Welch's method; means over intervals even in log f",
                             .why_null = why("the recording is too short for one")})};
}

Field lines(const ChannelNoise& channel) {
  const auto fields_of = [&](const signal::SpectralLine& line) -> Fields {
    const LineEffect effect = line_effect(*channel.analysis, line);
    return {field::magnitude("frequency_hz", line.frequency_hz),
            field::magnitude("amplitude", line.amplitude, {.meaning = "of a sine of equal power"}),
            field::magnitude("amplitude_std", line.amplitude_std),
            field::text("unit", noise_unit(channel.unit, NoiseScale::level)),
            field::magnitude("low_hz", line.low_hz),
            field::magnitude("high_hz", line.high_hz),
            field::number("excess_db", line.excess_db),
            field::object("raises_deviation",
                          {field::magnitude("tau_s", effect.tau_s),
                           field::magnitude("fraction", effect.raise)},
                          {.meaning = "largest increase of the deviation, and where"})};
  };
  return field::records(
      "lines",
      channel.analysis ? channel.analysis->lines.lines : std::vector<signal::SpectralLine>{},
      fields_of);
}

Field events(const ChannelNoise& channel) {
  const auto fields_of = [&](const signal::Event& event) -> Fields {
    const double rate_hz = channel.analysis->rate_hz;
    return {field::choice("kind", event.kind == signal::EventKind::outlier ? "knock" : "step",
                          {"knock", "step"}),
            field::number("start_s", static_cast<double>(event.first) / rate_hz),
            field::number("end_s", static_cast<double>(event.last) / rate_hz),
            field::number("size", event.size),
            field::text("unit", noise_unit(channel.unit, NoiseScale::level)),
            field::magnitude("significance", event.significance,
                             {.meaning = "in standard deviations of the noise"})};
  };
  return field::records("events",
                        channel.analysis ? channel.analysis->events : std::vector<signal::Event>{},
                        fields_of);
}

}  // namespace

Fields noise_spectrum_fields(const ChannelNoise& channel) {
  Fields fields = spectrum_fields(channel);
  append(fields, {lines(channel), events(channel)});
  return fields;
}

}  // namespace proofmass::report
