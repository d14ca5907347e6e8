#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "proofmass/calibrate/rotating/results.hpp"
#include "proofmass/core/units.hpp"

namespace proofmass::calibrate {

void fold_turns(const RotationState& state, RotationFit& fit) {
  constexpr std::size_t bins = 72;
  constexpr double per_rad = bins / rad_per_turn;
  struct Bin {
    double reading = 0.0, residual = 0.0, squares = 0.0, count = 0.0;
  };
  std::vector<std::array<Bin, bins>> folds(state.axes);
  std::array<double, 2> squares{}, count{};
  for_each_sample(state, [&](const RotationRecording& recording, const RotationSample& sample) {
    for (std::size_t axis = 0; axis < state.axes; ++axis) {
      const double reading = recording.axes[axis][sample.k];
      const AxisAt at = axis_at(state, axis, sample, reading);
      if (!std::isfinite(at.residual)) continue;
      double phase =
          std::remainder(state.offset[axis] + state.direction * sample.theta, rad_per_turn);
      if (phase < 0.0) phase += rad_per_turn;
      Bin& bin = folds[axis][std::min(static_cast<std::size_t>(phase * per_rad), bins - 1)];
      bin.reading += reading;
      bin.residual += at.residual;
      bin.squares += at.residual * at.residual;
      bin.count += 1.0;
      squares[axis] += at.residual * at.residual;
      count[axis] += 1.0;
    }
  });
  for (std::size_t axis = 0; axis < state.axes; ++axis) {
    fit.axes[axis].residual_rms = count[axis] > 0.0 ? std::sqrt(squares[axis] / count[axis]) : 0.0;
    fit.samples = std::max(fit.samples, static_cast<std::size_t>(count[axis]));
    RotationFold& fold = fit.axes[axis].fold;
    for (std::size_t b = 0; b < bins; ++b) {
      const Bin& bin = folds[axis][b];
      if (bin.count < 2.0) continue;
      fold.angle_rad.push_back((static_cast<double>(b) + 0.5) / per_rad);
      fold.mean.push_back(bin.reading / bin.count);
      const double mean = bin.residual / bin.count;
      fold.residual.push_back(mean);
      fold.residual_std.push_back(
          std::sqrt(std::max(bin.squares / bin.count - mean * mean, 0.0) / (bin.count - 1.0)));
    }
  }
}

}  // namespace proofmass::calibrate
