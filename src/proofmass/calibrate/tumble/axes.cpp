#include "proofmass/calibrate/tumble/axes.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "proofmass/core/contract.hpp"
#include "proofmass/core/number_words.hpp"

namespace proofmass::calibrate {
namespace {

constexpr double quarter = 0.5 * std::numbers::pi;
constexpr double least_amplitude = 0.2;  // relative to the largest
constexpr double least_seen = 0.05;      // rms of a sine or cosine over the positions from which it
                                         // counts as excited

// output ≈ mean + S sin ψ + C cos ψ over the positions of one plane.
struct FirstHarmonic {
  double S = 0.0, C = 0.0;
  bool sees_sine = false, sees_cosine = false;
  [[nodiscard]] double amplitude() const { return std::hypot(S, C); }
};

struct Sums {
  double n = 0.0, s = 0.0, c = 0.0, e = 0.0;
  double ss = 0.0, cc = 0.0, sc = 0.0, se = 0.0, ce = 0.0;
};

FirstHarmonic harmonic(View<TumblePosition> positions, View<double> output, int plane) {
  Sums sum;
  const auto each = [&](const auto& add) {
    for (std::size_t k = 0; k < positions.size(); ++k) {
      if (positions[k].plane != plane) continue;
      const double psi = positions[k].angle_rad + positions[k].mount_rad;
      add(std::sin(psi), std::cos(psi), output[k]);
    }
  };
  each([&](double s, double c, double e) {
    sum.n += 1.0;
    sum.s += s;
    sum.c += c;
    sum.e += e;
  });
  FirstHarmonic out;
  if (sum.n < 2.0) return out;
  const double sm = sum.s / sum.n, cm = sum.c / sum.n, em = sum.e / sum.n;
  each([&](double s, double c, double e) {
    sum.ss += (s - sm) * (s - sm);
    sum.cc += (c - cm) * (c - cm);
    sum.sc += (s - sm) * (c - cm);
    sum.se += (s - sm) * (e - em);
    sum.ce += (c - cm) * (e - em);
  });
  const double least = least_seen * least_seen * sum.n;
  out.sees_sine = sum.ss > least;
  out.sees_cosine = sum.cc > least;
  const double determinant = sum.ss * sum.cc - sum.sc * sum.sc;
  if (out.sees_sine && out.sees_cosine && determinant > least * least) {
    out.S = (sum.se * sum.cc - sum.ce * sum.sc) / determinant;
    out.C = (sum.ce * sum.ss - sum.se * sum.sc) / determinant;
  } else if (out.sees_sine) {
    out.S = sum.se / sum.ss;
  } else if (out.sees_cosine) {
    out.C = sum.ce / sum.cc;
  }
  return out;
}

double nearest_quarter(const FirstHarmonic& h) {
  double turns = std::round(std::atan2(h.C, h.S) / quarter);
  if (turns < 0.0) turns += 4.0;
  return turns * quarter;
}

const char* follows(double phase_rad) {
  switch (static_cast<int>(std::lround(phase_rad / quarter)) % 4) {
    case 1:
      return "cos(angle)";
    case 2:
      return "−sin(angle)";
    case 3:
      return "−cos(angle)";
    default:
      return "sin(angle)";
  }
}

std::string phase_words(const TumbleAxis& axis, const std::array<FirstHarmonic, 2>& found) {
  std::string text;
  for (std::size_t p = 0; p < 2; ++p) {
    if (!axis.phase_rad[p]) continue;
    const double phase = *axis.phase_rad[p];
    text += fmt::format("{}{}follows {}", text.empty() ? "" : "; ",
                        p == 1 ? "in the second plane it " : "", follows(phase));
    if (phase > 0.0)
      text += fmt::format(": {:.0f}° were added to its angles", phase / quarter * 90.0);
    const double off = std::remainder(std::atan2(found[p].C, found[p].S) - phase, 4.0 * quarter);
    constexpr double much = 10.0 / 90.0 * quarter;
    if (found[p].sees_sine && found[p].sees_cosine && std::abs(off) > much)
      text += fmt::format(", with a deviation of {}°", fixed(off / quarter * 90.0, 0));
  }
  return text.empty() ? "does not follow the angle: its axis is parallel to the table's" : text;
}

bool along_sine(const TumbleAxis& axis) {
  return axis.phase_rad[0] && std::lround(*axis.phase_rad[0] / quarter) % 2 == 0;
}

TumbleAxis place_axis(const std::array<FirstHarmonic, 2>& found, double largest, bool is_input) {
  TumbleAxis axis;
  for (std::size_t p = 0; p < 2; ++p) {
    const FirstHarmonic& h = found[p];
    axis.amplitude = std::max(axis.amplitude, h.amplitude());
    if (!h.sees_sine && !h.sees_cosine) continue;
    const bool oscillates = h.amplitude() > least_amplitude * largest;
    if (is_input || oscillates) axis.phase_rad[p] = is_input ? 0.0 : nearest_quarter(h);
  }
  // A second plane with only 0° and 180° does not excite the input axis.
  const FirstHarmonic& second = found[1];
  if (!axis.phase_rad[1] && along_sine(axis) && second.sees_cosine && !second.sees_sine)
    axis.phase_rad[1] = axis.phase_rad[0];
  axis.words = phase_words(axis, found);
  return axis;
}

}  // namespace

std::vector<TumbleAxis> tumble_axes(View<TumblePosition> positions,
                                    View<std::vector<double>> outputs,
                                    std::optional<std::size_t> input) {
  std::vector<std::array<FirstHarmonic, 2>> found;
  double largest = 0.0;
  for (const std::vector<double>& output : outputs) {
    PM_EXPECTS(output.size() == positions.size());
    found.push_back({harmonic(positions, output, 1), harmonic(positions, output, 2)});
    for (const FirstHarmonic& h : found.back()) largest = std::max(largest, h.amplitude());
  }
  std::vector<TumbleAxis> axes(outputs.size());
  for (std::size_t k = 0; k < axes.size(); ++k) axes[k] = place_axis(found[k], largest, k == input);
  return axes;
}

}  // namespace proofmass::calibrate
