#include "proofmass/calibrate/tumble/words.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "proofmass/core/number_words.hpp"
#include "proofmass/core/units.hpp"

namespace proofmass::calibrate {
namespace {

using Q = TumbleQuantity;

constexpr double rad_per_arcsec = rad_per_deg / 3600.0;

bool quarters_only(const TumbleDesign& design) {
  return std::all_of(design.phi_rad.begin(), design.phi_rad.end(), [](double phi) {
    return std::abs(std::remainder(phi, 0.5 * std::numbers::pi)) < rad_per_deg;
  });
}

std::string not_asked_words(TumbleTerm term) {
  switch (term) {
    case TumbleTerm::drift:
      return "no position was revisited late enough: return to the first one at the end";
    case TumbleTerm::temperature:
      return "the positions have no temperatures, or equal ones";
    case TumbleTerm::hysteresis:
    case TumbleTerm::backlash:
      return "the positions are not known to have been reached from both directions";
    default:
      return "the sensor was not remounted in another orientation on the table";
  }
}

std::string not_separable_words(TumbleTerm term) {
  switch (term) {
    case TumbleTerm::sine:
      return "no position has gravity along the input axis";
    case TumbleTerm::cosine:
    case TumbleTerm::square:
      return "there are not enough positions both vertical and horizontal";
    case TumbleTerm::product:
      return "at these angles sin 2φ is 0 or cannot be distinguished from the other terms: add "
             "positions "
             "between the quarters";
    case TumbleTerm::cube:
      return "at these angles sin 3φ cannot be distinguished from sin φ: add positions between the "
             "quarters";
    case TumbleTerm::third_cosine:
      return "at these angles cos 3φ cannot be distinguished from cos φ: add positions between the "
             "quarters";
    case TumbleTerm::indexing_cos2:
    case TumbleTerm::indexing_sin2:
      return "an error twice per turn is unchanged if the sensor is mounted rotated by 180°: mount "
             "it rotated by 90° as well";
    default:
      return "these positions do not separate it from the other terms";
  }
}

std::string rms_words(double rms_rad) {
  constexpr double fine = 0.01 * rad_per_deg;
  return rms_rad < fine ? fmt::format("{:.3g} arcsec", rms_rad / rad_per_arcsec)
                        : fmt::format("{:.3g}°", rms_rad / rad_per_deg);
}

// Amplitude of the harmonic with this rms, in 1e-6.
double micro(double rms_rad, double factor) {
  return 1e6 * factor * std::numbers::sqrt2 * rms_rad;
}

std::string once_words(double rms_rad) {
  return fmt::format(
      "an indexing error of {} rms once per turn would look like K2 − Kpp of up to {:.3g} µg/g² "
      "with K0 + Kpp g² of {:.3g} µg, or like Kip of up to {:.3g} µg/g²; K0 + K2 g² is free of it. "
      "Remounting the sensor rotated by 180° separates them",
      rms_words(rms_rad), micro(rms_rad, 1.0), micro(rms_rad, 1.0), micro(rms_rad, 1.0));
}

std::string twice_words(double rms_rad, bool cube) {
  const std::string third =
      cube ? fmt::format(" and K3 of up to {:.3g} µg/g³", micro(rms_rad, 2.0)) : "";
  return fmt::format(
      "an indexing error of {} rms twice per turn would look like a scale-factor error of up to "
      "{:.3g} ppm{}, or a misalignment of up to {:.3g} µrad. Remounting the sensor rotated by "
      "90° separates them",
      rms_words(rms_rad), micro(rms_rad, cube ? 2.0 : 1.0), third, micro(rms_rad, 0.5));
}

std::string found_words(const TumbleFit& fit, Q cosine, Q sine, const char* how_often) {
  const TumbleCoefficient* a = fit.find(cosine);
  const TumbleCoefficient* b = fit.find(sine);
  if (a == nullptr || b == nullptr || !a->value || !b->value) return {};
  const double rms = std::hypot(*a->value, *b->value) / std::numbers::sqrt2;
  std::string text = fmt::format("indexing error of {} a turn: {} rms", how_often, rms_words(rms));
  if (a->std && b->std)
    text += fmt::format(" (std of each part {})", rms_words(std::max(*a->std, *b->std)));
  return text;
}

// True if the input axis is vertical in all positions.
bool upright_only(const TumbleDesign& design) {
  constexpr double level = 0.05;
  return std::all_of(design.phi_rad.begin(), design.phi_rad.end(),
                     [](double phi) { return std::abs(std::cos(phi)) < level; });
}

// True if the input axis points up in one position and down in another.
bool both_ways(const TumbleDesign& design) {
  constexpr double upright = 0.95;
  const auto points = [&](double way) {
    return std::any_of(design.phi_rad.begin(), design.phi_rad.end(),
                       [&](double phi) { return way * std::sin(phi) > upright; });
  };
  return points(1.0) && points(-1.0);
}

std::string scale_words(const TumbleDesign& design) {
  if (design.find(TumbleTerm::cube)) return "scale factor K1";
  if (quarters_only(design) && both_ways(design))
    return "K1 (1 + K3 g²): the slope between +1 g and −1 g";
  return design.find(TumbleTerm::square) ? "scale factor K1, K3 taken as 0"
                                         : "scale factor K1, K3 and K2 − Kpp taken as 0";
}

std::string up_down_words(const TumbleDesign& design) {
  const std::string words = "K0 + K2 g²: half the sum of the readings at +1 g and −1 g";
  if (design.find(TumbleTerm::square) || upright_only(design)) return words;
  return design.find(TumbleTerm::cosine) ? "bias, K2 − Kpp taken as 0"
                                         : "bias, K2 − Kpp and misalignment taken as 0";
}

std::string plane_words(const char* words, int plane, const TumbleDesign& design) {
  return design.find(TumbleTerm::square, plane)
             ? words
             : fmt::format("{}, K2 − {} taken as 0", words, plane == 2 ? "Koo" : "Kpp");
}

}  // namespace

std::string why_missing(const TumbleDesign& design, TumbleTerm term, int plane) {
  switch (design.why_not(term, plane).value_or(LeftOut::not_separable)) {
    case LeftOut::not_asked_for:
      return not_asked_words(term);
    case LeftOut::none_to_spare:
      return fmt::format("{} positions are too few: no redundancy would remain",
                         design.phi_rad.size());
    case LeftOut::not_separable:
      break;
  }
  return not_separable_words(term);
}

std::string no_std_words(const TumbleDesign& design) {
  return fmt::format(
      "no standard deviation: {} positions for {} parameters leave no redundancy, and the "
      "noise of the outputs is not stated",
      design.phi_rad.size(), design.columns.size());
}

std::string unseen_scatter_words() {
  return "no standard deviation: with the stated errors of indexing the residuals do not determine "
         "the "
         "scatter of the outputs; state their noise, or repeat more positions";
}

std::string meaning_words(const TumbleCoefficient& coefficient, const TumbleDesign& design) {
  const int plane = coefficient.plane;
  switch (coefficient.quantity) {
    case Q::K1:
      return scale_words(design);
    case Q::K0:
      return "K0 + Kpp g²: bias where the input axis is level (0 g), the pendulous axis upright";
    case Q::K0_second:
      return "K0 + Koo g²: bias where the input axis is level (0 g), the output axis upright";
    case Q::K0_up_down:
      return up_down_words(design);
    case Q::misalignment:
      return plane_words("δo, the table's zero and the mounting in it", plane, design);
    case Q::misalignment_p:
      return plane_words("δp, the table's zero and the mounting in it", plane, design);
    case Q::K2_minus_Kpp:
      return "K2 − Kpp: no tumble in this plane separates them";
    case Q::K2_minus_Koo:
      return "K2 − Koo: no tumble in this plane separates them";
    case Q::Kip:
      return "cross-axis term of input and pendulous axis";
    case Q::Kio:
      return "cross-axis term of input and output axis";
    case Q::K3:
      return "third-order term of the input axis (and −Kipp, the term in aᵢ aₚ², if there is one)";
    case Q::third_cosine:
      return "cos 3φ over K1: 0 in the model; else a cubic cross-axis term or an indexing error "
             "twice a turn";
    case Q::drift:
      return design.in_time ? "change of the bias per second" : "change of the bias per position";
    case Q::temperature:
      return "change of the bias per kelvin";
    case Q::hysteresis:
      return "output where reached forwards less where reached backwards";
    case Q::backlash:
      return "true angle where reached forwards less where reached backwards";
    case Q::indexing_cos:
      return "true less indicated angle of the table: part with cos θ";
    case Q::indexing_sin:
      return "true less indicated angle of the table: part with sin θ";
    case Q::indexing_cos2:
      return "true less indicated angle of the table: part with cos 2θ";
    case Q::indexing_sin2:
      break;
  }
  return "true less indicated angle of the table: part with sin 2θ";
}

std::string unit_words(TumbleQuantity quantity, const TumbleSolution& solution) {
  const std::string& output = solution.options.output_unit;
  if (quantity == Q::K1) {
    if (output == "m/s^2") return "1";
    return output.empty() ? "1/(m/s^2)" : output + "/(m/s^2)";
  }
  if (quantity == Q::drift) return solution.design.in_time ? "m/s^3" : "m/s^2";
  if (quantity == Q::temperature) return "m/s^2/K";
  switch (acceleration_power(quantity)) {
    case 1:
      return "m/s^2";
    case -1:
      return "s^2/m";
    case -2:
      return "s^4/m^2";
    default:
      return "rad";
  }
}

TumbleIndexing indexing_words(const TumbleSolution& solution, const TumbleFit& fit) {
  const TumbleDesign& design = solution.design;
  TumbleIndexing out;
  out.std_rad = solution.regression.indexing_std_rad;
  out.assumed = !solution.options.indexing_std_rad;
  const double example = 0.1 * rad_per_deg;
  const double rms = out.assumed || out.std_rad <= 0.0 ? example : out.std_rad;
  out.once_separated =
      design.find(TumbleTerm::indexing_cos) && design.find(TumbleTerm::indexing_sin);
  out.twice_separated =
      design.find(TumbleTerm::indexing_cos2) && design.find(TumbleTerm::indexing_sin2);
  if (out.once_separated)
    out.words.push_back(found_words(fit, Q::indexing_cos, Q::indexing_sin, "once"));
  else if (design.find(TumbleTerm::square))
    out.words.push_back(once_words(rms));
  if (out.twice_separated)
    out.words.push_back(found_words(fit, Q::indexing_cos2, Q::indexing_sin2, "twice"));
  else
    out.words.push_back(twice_words(rms, design.find(TumbleTerm::cube).has_value()));
  return out;
}

void add_assumptions(const TumbleSolution& solution, TumbleFit& fit) {
  const TumbleRegression& regression = solution.regression;
  if (!regression.has_scale) return;
  const double K1 =
      std::abs(amplitude_of(solution.design, regression.beta)) / solution.options.gravity_mps2;
  fit.drift.nonlinear_std_mps2 = regression.drift_std / K1;
  fit.drift.nonlinear_assumed = !solution.options.drift_std_mps2;
  const auto by = [](double used, double assumed) {
    if (used > 1.001 * assumed) return "as the residuals require";
    return used < 0.999 * assumed ? "the most that the residuals allow" : "an assumption";
  };
  if (fit.indexing.assumed)
    fit.notes.push_back(fmt::format(
        "the error of the table's angles is not stated: a standard deviation of {} was used, {}",
        rms_words(fit.indexing.std_rad), by(fit.indexing.std_rad, assumed_indexing_std_rad)));
  if (fit.drift.nonlinear_assumed)
    fit.notes.push_back(fmt::format(
        "the bias drift about a straight line is not stated: amplitudes of {} mg (standard "
        "deviation) over the test were used, {}",
        compact(1e3 * fit.drift.nonlinear_std_mps2 / standard_gravity_mps2, 2),
        by(fit.drift.nonlinear_std_mps2, assumed_drift_std_mps2)));
}

}  // namespace proofmass::calibrate
