#include "proofmass/calibrate/rotating/encoder_zero.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "proofmass/core/units.hpp"

namespace proofmass::calibrate {
namespace {

constexpr double largest_misalignment_rad = 0.05;
constexpr double largest_delay_rad = 0.3;  // between two speeds

/// ψ of the first axis's output, A sin(θ + ψ), over a recording's steady turns.
std::optional<double> phase_of(const RotationRecording& recording,
                               std::size_t number,
                               const std::vector<SteadyTurns>& sections) {
  double sine = 0.0, cosine = 0.0;
  for (const SteadyTurns& section : sections) {
    if (section.recording != number) continue;
    for (std::size_t k = section.first; k <= section.last; ++k) {
      const double theta = recording.angle_rad[k], output = recording.axes.front()[k];
      if (!std::isfinite(theta) || !std::isfinite(output)) continue;
      sine += output * std::sin(theta);
      cosine += output * std::cos(theta);
    }
  }
  if (sine == 0.0 && cosine == 0.0) return std::nullopt;
  return std::atan2(cosine, sine);
}

void shift(double by_rad, RotationRecording& recording) {
  for (double& angle : recording.angle_rad) angle += by_rad;
}

}  // namespace

EncoderZero relate_zero(std::vector<RotationRecording>& recordings,
                        const std::vector<SteadyTurns>& sections) {
  std::vector<std::optional<double>> phases;
  for (std::size_t k = 0; k < recordings.size(); ++k)
    phases.push_back(phase_of(recordings[k], k, sections));
  const auto first = std::ranges::find_if(phases, [](const auto& one) { return one.has_value(); });
  if (first == phases.end()) return EncoderZero::sensor;
  const double common = **first;
  const bool agree = std::ranges::all_of(phases, [common](const auto& one) {
    return !one || std::abs(std::remainder(*one - common, rad_per_turn)) < largest_delay_rad;
  });
  const bool is_aligned = std::ranges::any_of(phases, [](const auto& one) {
    return one && std::abs(std::remainder(*one, std::numbers::pi / 2.0)) < largest_misalignment_rad;
  });
  if (agree && is_aligned) return EncoderZero::sensor;
  for (std::size_t k = 0; k < recordings.size(); ++k)
    shift(agree ? common : phases[k].value_or(0.0), recordings[k]);
  return agree ? EncoderZero::wheel : EncoderZero::none;
}

}  // namespace proofmass::calibrate
