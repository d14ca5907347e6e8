#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/calibrate/tumble/model.hpp"
#include "proofmass/core/view.hpp"

// The columns that a set of positions determines.
namespace proofmass::calibrate {

/// A column of the regression; the letters are those of fit_tumble().
enum class TumbleTerm {
  up_down,        ///< U: 1
  sine,           ///< S: sin φ
  cosine,         ///< D: cos φ in one mounting
  square,         ///< Q: 1 + cos 2φ in one plane
  product,        ///< P: sin 2φ in one plane
  cube,           ///< T: sin 3φ
  third_cosine,   ///< C3: cos 3φ in one plane
  drift,          ///< R: (t − t̄)/span
  temperature,    ///< (T − T̄)/span
  hysteresis,     ///< H: ± ½
  backlash,       ///< L: ± ½ cos φ
  indexing_cos,   ///< a₁: cos φ cos θ
  indexing_sin,   ///< b₁: cos φ sin θ
  indexing_cos2,  ///< a₂: cos φ cos 2θ
  indexing_sin2,  ///< b₂: cos φ sin 2θ
};

struct TumbleColumn {
  TumbleTerm term = TumbleTerm::up_down;
  int plane = 0;             ///< 0: all planes
  std::size_t mounting = 0;  ///< for a cosine
};

/// The sensor's mounting on the table.
struct TumbleMounting {
  int plane = 1;
  double mount_rad = 0.0;  ///< in [0, 2π)
};

/// Why a column is not in the fit.
enum class LeftOut {
  not_asked_for,  ///< the positions were not designed for it
  not_separable,  ///< the angles do not determine it from what is fitted
  none_to_spare,  ///< no redundancy would remain
};

struct TumbleMissing {
  TumbleColumn column;
  LeftOut why = LeftOut::not_separable;
};

struct TumbleDesign {
  std::vector<TumbleMounting> mountings;
  std::vector<TumbleColumn> columns;   ///< fitted
  std::vector<TumbleMissing> missing;  ///< not fitted
  Eigen::MatrixXd A;                   ///< positions × columns
  std::vector<double> phi_rad;         ///< of each position
  std::vector<std::size_t> setting;    ///< setting number of each position; equal angles of the
                                       ///< table have equal numbers
  std::vector<double> when;            ///< time of each position, in seconds or as its index,
                                       ///< from 0
  double span = 0.0;                   ///< range of `when`
  bool in_time = false;                ///< `when` is in seconds
  bool closed = false;                 ///< a position was revisited late enough
  double kelvin_span = 0.0;            ///< range of the temperatures; 0 if unknown

  [[nodiscard]] std::optional<std::size_t> find(TumbleTerm term,
                                                int plane = 0,
                                                std::size_t mounting = 0) const;
  [[nodiscard]] std::optional<LeftOut> why_not(TumbleTerm term, int plane = 0) const;
};

/// Shapes of a nonlinear drift: cos 2πt/span and sin 2πt/span of amplitude 1, which in one turn of
/// the table are harmonics of its angle, and their multiples up to the sixth with amplitude
/// `higher`/n, as in a step, a random walk or an exponential. If no position was revisited, also a
/// straight line from −1 to 1.
[[nodiscard]] Eigen::MatrixXd drift_shapes(const TumbleDesign& design, double higher);

/// Chooses the columns in the order of fit_tumble(). A position counts as revisited late enough if
/// two visits within half a degree are at least half of their mounting's time apart.
[[nodiscard]] TumbleDesign design_tumble(View<TumblePosition> positions,
                                         const std::array<double, 2>& phase_rad,
                                         bool noise_known);

}  // namespace proofmass::calibrate
