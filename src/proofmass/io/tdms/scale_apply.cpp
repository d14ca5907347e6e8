#include <algorithm>
#include <cmath>
#include <limits>

#include "proofmass/core/contract.hpp"
#include "proofmass/io/tdms/scale.hpp"
#include "proofmass/io/tdms/thermocouple.hpp"

namespace proofmass::io::tdms {
namespace {

double scaled(const Polynomial& polynomial, double x) {
  double y = 0.0;
  for (std::size_t i = polynomial.coefficients.size(); i-- > 0;)
    y = y * x + polynomial.coefficients[i];
  return y;
}

double scaled(const Lookup& table, double x) {
  if (std::isnan(x)) return x;
  const auto above = std::ranges::upper_bound(table.x, x);
  if (above == table.x.begin()) return table.y.front();
  if (above == table.x.end()) return table.y.back();
  const auto i = static_cast<std::size_t>(above - table.x.begin());
  const double part = (x - table.x[i - 1]) / (table.x[i] - table.x[i - 1]);
  return table.y[i - 1] + part * (table.y[i] - table.y[i - 1]);
}

/// The quadratic above 0 °C; below, Newton steps on the quartic starting at its root.
double scaled(const Rtd& rtd, double volts) {
  const double ratio = (volts / rtd.current_amp - rtd.lead_ohm) / rtd.r0_ohm;
  const double root = std::sqrt(rtd.a * rtd.a - 4.0 * rtd.b * (1.0 - ratio));
  // This form preserves digits for small B.
  double t = 2.0 * (ratio - 1.0) / (rtd.a + root);
  if (!(ratio < 1.0)) return t;
  constexpr int enough = 20;
  for (int i = 0; i < enough; ++i) {
    const double value = 1.0 + t * (rtd.a + t * (rtd.b + t * rtd.c * (t - 100.0))) - ratio;
    const double slope = rtd.a + t * (2.0 * rtd.b + t * rtd.c * (4.0 * t - 300.0));
    const double step = value / slope;
    t -= step;
    if (!(std::abs(step) > 1e-12 * std::abs(t))) break;
  }
  constexpr double absolute_zero_degc = -273.15;
  return t > absolute_zero_degc ? t : std::numeric_limits<double>::quiet_NaN();
}

double scaled(const Strain& strain, double volts) {
  using Bridge = Strain::Bridge;
  const double v = (volts - strain.unstrained_volt) / strain.excitation_volt;
  const double nu = strain.poisson;
  const double k = -strain.gain / strain.gage_factor;
  switch (strain.bridge) {
    case Bridge::full_1:
      return k * v;
    case Bridge::full_2:
      return k * 2.0 * v / (1.0 + nu);
    case Bridge::full_3:
      return k * 2.0 * v / ((nu + 1.0) - v * (nu - 1.0));
    case Bridge::half_1:
      return k * 4.0 * v / ((1.0 + nu) - 2.0 * v * (nu - 1.0));
    case Bridge::half_2:
      return k * 2.0 * v;
    case Bridge::quarter:
      return k * 4.0 * v / (1.0 + 2.0 * v);
  }
  return std::numeric_limits<double>::quiet_NaN();
}

double scaled(const Thermistor& thermistor, double volts) {
  const double whole_ohm = thermistor.is_divider
                               ? thermistor.r1_ohm / (thermistor.excitation / volts - 1.0)
                               : volts / thermistor.excitation;
  const double r = std::log(whole_ohm - thermistor.lead_ohm);
  return 1.0 / (thermistor.a + r * (thermistor.b + r * r * thermistor.c)) -
         thermistor.offset_kelvin;
}

double scaled(const Thermocouple& couple, double x) {
  return couple.to_voltage ? 1e3 * thermocouple_mv(couple.type, x)
                           : thermocouple_degc(couple.type, 1e-3 * x);
}

}  // namespace

void apply_scale(const Scale& scale, View<double> left, View<double> right, std::span<double> out) {
  PM_EXPECTS(left.size() == out.size() && right.size() == out.size());
  std::visit(
      [&](const auto& of) {
        using Kind = std::decay_t<decltype(of)>;
        for (std::size_t i = 0; i < out.size(); ++i) {
          if constexpr (std::is_same_v<Kind, Linear>)
            out[i] = of.slope * left[i] + of.intercept;
          else if constexpr (std::is_same_v<Kind, Sum>)
            out[i] = right[i] + of.sign_of_left * left[i];
          else if constexpr (std::is_same_v<Kind, Identity>)
            out[i] = left[i];
          else
            out[i] = scaled(of, left[i]);
        }
      },
      scale);
}

}  // namespace proofmass::io::tdms
