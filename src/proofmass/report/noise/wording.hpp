#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/report/noise/report.hpp"

// Units, figures and sentences of a noise analysis.
namespace proofmass::report {

/// What a figure of noise is to the unit u of its series.
enum class NoiseScale {
  level,     ///< u
  density,   ///< u/√Hz
  walk,      ///< u/√s
  integral,  ///< u·s
  slope,     ///< u/s
};

/// "m/s^2/sqrt(Hz)": as documents name the unit.
[[nodiscard]] std::string noise_unit(const Unit& unit, NoiseScale scale);

/// "m^2/s^3": of a two-sided density of power, scale as for its root: density u²/Hz, walk u²/s
/// (per Hz of its derivative), level u².
[[nodiscard]] std::string squared_unit(const Unit& unit, NoiseScale scale);

/// A unit in which people read figures of about some size.
struct ShownUnit {
  double per_si = 1.0;  ///< shown = SI · per_si
  std::string symbol;   ///< "µg/√Hz"
};

/// Accelerations in ng, µg, mg or g; volts and the like with a prefix; counts as they are.
[[nodiscard]] ShownUnit shown_unit(const Unit& unit, NoiseScale scale, double size);

/// "75.2 ± 0.3 µg/√Hz"
[[nodiscard]] std::string noise_words(const Uncertain& figure, const Unit& unit, NoiseScale scale);

/// "75.2 µg/√Hz", to two or three digits.
[[nodiscard]] std::string noise_words(double value, const Unit& unit, NoiseScale scale);

/// One of the five coefficients, as documents and people call it.
struct NamedCoefficient {
  const char* key;   ///< "random_walk"
  const char* name;  ///< "Random walk K"
  NoiseScale scale;
  characterise::Coefficient characterise::NoiseModelFit::* figure;
};
extern const std::array<NamedCoefficient, 5> named_coefficients;

[[nodiscard]] inline bool is_identified(const characterise::Coefficient& coefficient) {
  return coefficient.verdict == characterise::Verdict::identified;
}

/// Whether there are coefficients: not for a refused channel or a record too short for them.
[[nodiscard]] bool has_coefficients(const ChannelNoise& channel);

/// The same of a spectrum.
[[nodiscard]] bool has_spectrum(const ChannelNoise& channel);

/// "75.2 ± 0.3 µg/√Hz" or "0, below 1.2 µg/√s (95 %)"
[[nodiscard]] std::string coefficient_words(const characterise::Coefficient& coefficient,
                                            const Unit& unit,
                                            NoiseScale scale);

/// "identified", or the length of recording that would identify it where that is longer than this
/// one, of duration_s.
[[nodiscard]] std::string verdict_words(const characterise::Coefficient& coefficient,
                                        double duration_s);

/// Whether the statistic is comparable with the fitted Allan variance.
[[nodiscard]] bool estimates_allan(characterise::Statistic statistic);

/// Scale of the curve's values: u·s for tdev and ttotdev, u for all others.
[[nodiscard]] NoiseScale curve_scale(characterise::Statistic statistic);

/// Averaging time about which flicker noise shows: the minimum of the fitted variance, or where it
/// falls to the end the middle, on a log scale, of where white noise meets flicker and the end.
/// nullopt if flicker is not identified.
[[nodiscard]] std::optional<double> flicker_tau_s(const characterise::NoiseAnalysis& analysis);

/// By how much a line raises the deviation above the fitted model, as a fraction, at most, and
/// where. Within the times of the curve.
struct LineEffect {
  double tau_s = 0.0;
  double raise = 0.0;
};
[[nodiscard]] LineEffect line_effect(const characterise::NoiseAnalysis& analysis,
                                     const signal::SpectralLine& line);

/// A point of the curve that is quoted by itself.
struct CurveReading {
  characterise::DeviationPoint point;
  bool is_minimum = false;
};

/// The points at 1, 10 and 100 s, the nearest within 3 %, where the curve has them, and its minimum
/// where it lies within the curve and not at an end.
[[nodiscard]] std::vector<CurveReading> curve_readings(const characterise::DeviationCurve& curve);

/// Doubts about all figures, at the beginning of those of noise_findings(): the sensor was not at
/// rest, its noise was not stationary. Those of all channels, each once with their names.
[[nodiscard]] std::vector<std::string> common_doubts(const NoiseReport& report);

/// The result in sentences, the most important first; for a refused channel the reason.
[[nodiscard]] std::vector<std::string> noise_findings(const ChannelNoise& channel);

/// "12.40 … 12.63 s", "12.40 s": with the resolution of a sample.
[[nodiscard]] std::string event_time_words(const signal::Event& event, double rate_hz);

}  // namespace proofmass::report
