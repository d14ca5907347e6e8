#pragma once

#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/units.hpp"
#include "proofmass/report/page/figure.hpp"
#include "proofmass/thesis/item.hpp"
#include "proofmass/thesis/wheel/study.hpp"

// Words, values and curves shared by the wheel's items.
namespace proofmass::thesis {

/// A quantity in its SI unit and its display unit.
struct Kind {
  const char* si_unit;
  const char* symbol;
  double to_si;
};
namespace kind {
inline constexpr Kind metres{"m", "m", 1.0};
inline constexpr Kind millimetres{"m", "mm", 1e-3};
inline constexpr Kind degrees{"rad", "°", rad_per_deg};
inline constexpr Kind accel{"m/s^2", "m/s²", 1.0};
inline constexpr Kind milli_g{"m/s^2", "mg", 1e-3 * standard_gravity_mps2};
inline constexpr Kind angular_accel{"rad/s^2", "rad/s²", 1.0};
inline constexpr Kind rpm{"rad/s", "rpm", radps_per_rpm};
inline constexpr Kind speed{"m/s", "m/s", 1.0};
inline constexpr Kind seconds{"s", "s", 1.0};
inline constexpr Kind percent{"", "%", 0.01};
inline constexpr Kind plain{"", "", 1.0};
}  // namespace kind

/// Findings of one item; an absent `ours` gets the last reason given by why().
class Findings {
 public:
  /// Reason for absent values from now on.
  void why(std::string reason) { reason_ = std::move(reason); }
  /// The thesis's value, in the display unit, and ours in SI.
  void add(std::string key,
           std::string label,
           const Kind& kind,
           std::optional<double> printed,
           std::optional<Uncertain> ours);
  [[nodiscard]] std::vector<Finding> all() && { return std::move(findings_); }

 private:
  std::string reason_;
  std::vector<Finding> findings_;
};

/// "0.24 ± 0.03 m", in the display unit; "not known" without a value.
[[nodiscard]] std::string said(const std::optional<Uncertain>& figure, const Kind& kind);

/// The speed of some runs, as it was set: "11".
[[nodiscard]] std::string rpm_words(const SpeedStudy& speed);

/// "rms over 50 simulated runs", or for a recording the reference of its errors.
[[nodiscard]] std::string how_counted(const WheelStudy& study);

/// Why a pair's, or a path's, values are absent; empty if none is.
[[nodiscard]] std::string why_absent(const FirstTurn& turn);

/// Assumptions and limitations, as sentences after an item's note.
[[nodiscard]] std::string caveats(const WheelStudy& study);

/// Reference of the errors.
[[nodiscard]] const char* reference_name(const FirstTurn& turn);

/// With nothing in it yet.
[[nodiscard]] report::Figure over_time(std::string title, std::string description, std::string y);

[[nodiscard]] report::Curve curve(const FirstTurn& turn,
                                  std::string label,
                                  std::vector<double> y,
                                  report::Ink ink,
                                  report::Mark mark = report::Mark::line);

/// ± 1.96 std about a curve.
[[nodiscard]] report::Band band95(const FirstTurn& turn,
                                  std::string label,
                                  const std::vector<double>& y,
                                  const std::vector<double>& std,
                                  report::Ink ink);

[[nodiscard]] std::vector<double> times(std::vector<double> values, double factor);
/// a − b
[[nodiscard]] std::vector<double> less(std::vector<double> a, const std::vector<double>& b);
/// Root mean square of the finite values.
[[nodiscard]] double rms(const std::vector<double>& values);
[[nodiscard]] Uncertain rms_off(const std::vector<double>& estimate,
                                const std::vector<double>& truth);

}  // namespace proofmass::thesis
