#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/quantity.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/view.hpp"

// Dependence of a sensor's bias and scale on its supply.
namespace proofmass::calibrate {

/// One calibration, at one supply. The standard deviations exclude errors common to all
/// calibrations, such as gravity.
struct SupplyPoint {
  Uncertain supply_v;
  std::array<std::optional<Uncertain>, 3> bias;   ///< V or counts
  std::array<std::optional<Uncertain>, 3> scale;  ///< V or counts per m/s^2
};

struct SupplyOptions {
  std::optional<double> reference_v = {};  ///< absent: the mean of the supplies
  std::string reading_unit = "V";          ///< "V" or "counts", for the words
};

/// A straight line level + slope · (x − x0), x0 chosen so that level and slope are uncorrelated.
struct SupplyLine {
  double x0 = 0.0;
  Uncertain level, slope;
  bool std_known = true;           ///< false: two points without uncertainties, and std is 0
  double dof = 0.0;                ///< of the stds; 0: infinite
  std::optional<double> misfit_p;  ///< p-value of the residuals; absent if unknown
};

/// One axis: scale = scale_ref (V/V_ref)^p, zero = fraction · V + constant.
struct SupplyAxis {
  double sign = 1.0;               ///< sign of the scale
  SupplyLine log_scale, zero;      ///< ln |scale| against ln V; bias against V
  Uncertain scale_ref;             ///< at the reference supply
  Uncertain exponent;              ///< p
  Uncertain zero_ref;              ///< at the reference supply
  Uncertain fraction;              ///< of the supply, reading's unit per V
  Uncertain constant;              ///< part independent of the supply
  double expected_fraction = 0.0;  ///< zero_ref / V_ref: the value for constant = 0
  /// p-values of the hypotheses p = 1 and constant = 0; absent if not determined.
  std::optional<double> scale_p, zero_p;
  std::optional<bool> ratiometric;  ///< both, at 5 % together
  std::string words;                ///< "x follows its supply: scale as V^0.998 ± 0.004, …"
};

struct SupplyDependence {
  double reference_v = 0.0, lowest_v = 0.0, highest_v = 0.0;
  std::array<std::optional<SupplyAxis>, 3> axes;  ///< absent: not calibrated at two supplies
  std::vector<std::string> notes;                 ///< sentences for the user
};

/// Fits each axis by weighted least squares, including the supply's own uncertainty in the
/// variance: u² = u²(bias) + fraction² u²(V). If the residuals are larger than the given
/// uncertainties explain (p < 0.05), or none are given, the uncertainty comes from the residuals.
///
/// Source: effective variance: J. Orear, Am. J. Phys. 50 (1982) 912. Errors: too_few_samples (fewer
/// than two calibrations), invalid_argument (a supply that is not above 0, a scale of 0 or of
/// changing sign), not_observable (the supplies do not differ enough), not_finite.
[[nodiscard]] Result<SupplyDependence> fit_supply(View<SupplyPoint> points,
                                                  const SupplyOptions& options = {});

/// Bias and scale of one axis at a supply, with one standard deviation; absent, with `reason`,
/// outside the calibrated range of supplies.
struct AtSupply {
  std::optional<Uncertain> bias, scale;
  std::string reason;
};
[[nodiscard]] AtSupply at_supply(const SupplyDependence& found, std::size_t axis, double supply_v);

}  // namespace proofmass::calibrate
