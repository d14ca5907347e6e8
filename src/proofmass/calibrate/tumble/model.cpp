#include "proofmass/calibrate/tumble/model.hpp"

#include "proofmass/core/contract.hpp"

namespace proofmass::calibrate {

std::string_view name_of(TumbleQuantity quantity) {
  switch (quantity) {
    case TumbleQuantity::K1:
      return "K1";
    case TumbleQuantity::K0:
      return "K0";
    case TumbleQuantity::K0_up_down:
      return "K0_up_down";
    case TumbleQuantity::misalignment:
      return "misalignment_rad";
    case TumbleQuantity::K2_minus_Kpp:
      return "K2_minus_Kpp";
    case TumbleQuantity::Kip:
      return "Kip";
    case TumbleQuantity::K3:
      return "K3";
    case TumbleQuantity::third_cosine:
      return "third_cosine";
    case TumbleQuantity::K0_second:
      return "K0_second_plane";
    case TumbleQuantity::misalignment_p:
      return "misalignment_p_rad";
    case TumbleQuantity::K2_minus_Koo:
      return "K2_minus_Koo";
    case TumbleQuantity::Kio:
      return "Kio";
    case TumbleQuantity::drift:
      return "drift";
    case TumbleQuantity::temperature:
      return "bias_per_kelvin";
    case TumbleQuantity::hysteresis:
      return "hysteresis";
    case TumbleQuantity::backlash:
      return "backlash_rad";
    case TumbleQuantity::indexing_cos:
      return "indexing_cos_rad";
    case TumbleQuantity::indexing_sin:
      return "indexing_sin_rad";
    case TumbleQuantity::indexing_cos2:
      return "indexing_cos2_rad";
    case TumbleQuantity::indexing_sin2:
      break;
  }
  return "indexing_sin2_rad";
}

int acceleration_power(TumbleQuantity quantity) {
  switch (quantity) {
    case TumbleQuantity::K0:
    case TumbleQuantity::K0_up_down:
    case TumbleQuantity::K0_second:
    case TumbleQuantity::third_cosine:
    case TumbleQuantity::drift:
    case TumbleQuantity::temperature:
    case TumbleQuantity::hysteresis:
      return 1;
    case TumbleQuantity::K1:
    case TumbleQuantity::K2_minus_Kpp:
    case TumbleQuantity::K2_minus_Koo:
    case TumbleQuantity::Kip:
    case TumbleQuantity::Kio:
      return -1;
    case TumbleQuantity::K3:
      return -2;
    default:
      return 0;
  }
}

FourPointResult four_point(const FourPoint& readings, double gravity_mps2) {
  PM_EXPECTS(readings.E90 != readings.E270 && gravity_mps2 > 0.0);
  const double amplitude = 0.5 * (readings.E90 - readings.E270);  // K1 g
  FourPointResult out;
  out.K1 = amplitude / gravity_mps2;
  out.bias_0g_mps2 = 0.5 * (readings.E0 + readings.E180) / out.K1;
  out.bias_up_down_mps2 = 0.5 * (readings.E90 + readings.E270) / out.K1;
  out.misalignment_rad = 0.5 * (readings.E0 - readings.E180) / amplitude;
  const double square = 0.5 * (readings.E90 + readings.E270 - readings.E0 - readings.E180);
  out.K2_minus_Kpp_s2pm = square / amplitude / gravity_mps2;
  return out;
}

CorrectionFactors correction_factors(const FourPoint& readings,
                                     double gravity_mps2,
                                     double nominal_scale) {
  PM_EXPECTS(nominal_scale != 0.0);
  const FourPointResult found = four_point(readings, gravity_mps2);
  return {.offset = 0.5 * (readings.E0 + readings.E180),
          .scale = nominal_scale / found.K1,
          .scale_factor_error = found.K1 / nominal_scale - 1.0};
}

}  // namespace proofmass::calibrate
