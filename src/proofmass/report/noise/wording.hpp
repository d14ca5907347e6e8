#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/report/noise/report.hpp"

// Units, figures and sentences of a noise analysis.
namespace proofmass::report {

/// Unit of a noise figure, relative to the unit u of its series.
enum class NoiseScale {
  level,     ///< u
  density,   ///< u/√Hz
  walk,      ///< u/√s
  integral,  ///< u·s
  slope,     ///< u/s
};

/// "m/s^2/sqrt(Hz)": unit in the notation of the documents.
[[nodiscard]] std::string noise_unit(const Unit& unit, NoiseScale scale);

/// "m^2/s^3": unit of a two-sided power density. `scale` is that of its root: density u²/Hz, walk
/// u²/s (per Hz of its derivative), level u².
[[nodiscard]] std::string squared_unit(const Unit& unit, NoiseScale scale);

/// Display unit for figures of about a given size.
struct ShownUnit {
  double per_si = 1.0;  ///< shown = SI · per_si
  std::string symbol;   ///< "µg/√Hz"
};

/// Accelerations in ng, µg, mg or g; volts and the like with an SI prefix; counts unchanged.
[[nodiscard]] ShownUnit shown_unit(const Unit& unit, NoiseScale scale, double size);

/// "75.2 ± 0.3 µg/√Hz"
[[nodiscard]] std::string noise_words(const Uncertain& figure, const Unit& unit, NoiseScale scale);

/// "75.2 µg/√Hz", to two or three digits.
[[nodiscard]] std::string noise_words(double value, const Unit& unit, NoiseScale scale);

/// One of the five coefficients, with its key in documents and its printed name.
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

/// True if there are coefficients; false for a refused channel or a record too short for them.
[[nodiscard]] bool has_coefficients(const ChannelNoise& channel);

/// True if there is a spectrum.
[[nodiscard]] bool has_spectrum(const ChannelNoise& channel);

/// "75.2 ± 0.3 µg/√Hz" or "0, below 1.2 µg/√s (95 %)"
[[nodiscard]] std::string coefficient_words(const characterise::Coefficient& coefficient,
                                            const Unit& unit,
                                            NoiseScale scale);

/// "identified", or the length of recording that would identify it if that exceeds duration_s, the
/// length of this one.
[[nodiscard]] std::string verdict_words(const characterise::Coefficient& coefficient,
                                        double duration_s);

/// True if the statistic is comparable with the fitted Allan variance.
[[nodiscard]] bool estimates_allan(characterise::Statistic statistic);

/// Scale of the curve's values: u·s for tdev and ttotdev, u for all others.
[[nodiscard]] NoiseScale curve_scale(characterise::Statistic statistic);

/// Averaging time at which flicker noise dominates: the minimum of the fitted variance or, if the
/// variance decreases up to the last τ, the geometric mean of that τ and the τ at which white noise
/// equals flicker. nullopt if flicker is not identified.
[[nodiscard]] std::optional<double> flicker_tau_s(const characterise::NoiseAnalysis& analysis);

/// Largest relative increase of the deviation over the fitted model due to a spectral line, and its
/// τ; within the range of the curve.
struct LineEffect {
  double tau_s = 0.0;
  double raise = 0.0;
};
[[nodiscard]] LineEffect line_effect(const characterise::NoiseAnalysis& analysis,
                                     const signal::SpectralLine& line);

/// A point of the curve that is quoted individually.
struct CurveReading {
  characterise::DeviationPoint point;
  bool is_minimum = false;
};

/// The points nearest to 1, 10 and 100 s (within 3 %) if the curve has them, and its minimum if
/// that is not at an end of the curve.
[[nodiscard]] std::vector<CurveReading> curve_readings(const characterise::DeviationCurve& curve);

/// Caveats for all figures, which come first in noise_findings(): the sensor was not at rest, its
/// noise was not stationary. Collected over all channels, each once with the channels' names.
[[nodiscard]] std::vector<std::string> common_doubts(const NoiseReport& report);

/// The result in sentences, the most important first; for a refused channel the reason.
[[nodiscard]] std::vector<std::string> noise_findings(const ChannelNoise& channel);

/// "12.40 … 12.63 s", "12.40 s": with the resolution of a sample.
[[nodiscard]] std::string event_time_words(const signal::Event& event, double rate_hz);

}  // namespace proofmass::report
