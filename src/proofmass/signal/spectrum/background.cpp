#include "proofmass/signal/spectrum/background.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "proofmass/core/chi_square.hpp"
#include "proofmass/core/statistics.hpp"

namespace proofmass::signal {
namespace {

constexpr double cell_octaves = 0.125;
constexpr double reach = 1.5 * 0.6931471805599453;  ///< half width of the local fit, in ln f
constexpr std::size_t fewest_cells = 9;

/// A group of adjacent bins.
struct Cell {
  double log_frequency;  ///< ln of the mean bin number
  double log_level;      ///< ln of its PSD, unbiased for the median
  double weight;         ///< √ of the number of bins; 0 if all are excluded
};

std::vector<Cell> cells_of(const Spectrum& spectrum, const std::vector<bool>& left_out) {
  const double edf = spectrum.edf_per_bin;
  const double median_bias = std::log(chi_square_quantile(0.5, edf) / edf);
  std::vector<Cell> cells;
  const std::size_t end = end_of_judged_bins(spectrum);
  for (std::size_t first = first_judged_bin; first < end;) {
    const double width = static_cast<double>(first) * (std::exp2(cell_octaves) - 1.0);
    std::size_t last =
        std::min(end, first + std::max<std::size_t>(3, static_cast<std::size_t>(width + 0.5)));
    if (end - last < 3) last = end;
    std::vector<double> logs;
    for (std::size_t k = first; k < last; ++k)
      if (!left_out[k])
        logs.push_back(
            std::log(std::max(spectrum.one_sided_psd[k], std::numeric_limits<double>::min())));
    const double middle = 0.5 * static_cast<double>(first + last - 1);
    cells.push_back({std::log(middle), median(logs).value_or(0.0) - median_bias,
                     std::sqrt(static_cast<double>(logs.size()))});
    first = last;
  }
  return cells;
}

using Vector3 = std::array<double, 3>;

/// Solves A c = b of a symmetric positive definite A, given by its lower triangle, by Cholesky.
Vector3 solve(std::array<Vector3, 3> A, Vector3 b) {
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      for (std::size_t k = 0; k < j; ++k) A[i][j] -= A[i][k] * A[j][k];
      A[i][j] = i == j ? std::sqrt(std::max(A[i][i], 1e-300)) : A[i][j] / A[j][j];
    }
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < i; ++k) b[i] -= A[i][k] * b[k];
    b[i] /= A[i][i];
  }
  for (std::size_t i = 3; i-- > 0;) {
    for (std::size_t k = i + 1; k < 3; ++k) b[i] -= A[k][i] * b[k];
    b[i] /= A[i][i];
  }
  return b;
}

/// The parabola c₀ + c₁ u + c₂ u², u = ln f − ln f₀, that minimises Σ weight |log_level −
/// parabola|, at u = 0; by least squares with weights 1/|residual|.
double local_level(View<Cell> cells, double at) {
  Vector3 c{};
  for (int pass = 0; pass < 15; ++pass) {
    std::array<Vector3, 3> A{};
    Vector3 b{};
    for (const Cell& cell : cells) {
      const double u = cell.log_frequency - at;
      const Vector3 powers{1.0, u, u * u};
      const double residual = cell.log_level - (c[0] + c[1] * u + c[2] * u * u);
      const double weight =
          pass == 0 ? cell.weight : cell.weight / std::max(std::abs(residual), 1e-3);
      for (std::size_t i = 0; i < 3; ++i) {
        b[i] += weight * powers[i] * cell.log_level;
        for (std::size_t j = 0; j <= i; ++j) A[i][j] += weight * powers[i] * powers[j];
      }
    }
    // Slight damping, so that too few cells with weight do not make it singular.
    A[2][2] += 1e-9 * (A[0][0] + A[2][2]);
    c = solve(A, b);
  }
  return c[0];
}

/// The cells within reach of the one at `index`, and at least fewest_cells with nonzero weight.
View<Cell> neighbourhood(const std::vector<Cell>& cells, std::size_t index) {
  const double at = cells[index].log_frequency;
  std::size_t first = index, last = index + 1, counting = cells[index].weight > 0.0 ? 1 : 0;
  const auto distance = [&](std::size_t i) { return std::abs(cells[i].log_frequency - at); };
  while (first > 0 || last < cells.size()) {
    const bool down = last == cells.size() || (first > 0 && distance(first - 1) < distance(last));
    const std::size_t next = down ? first - 1 : last;
    if (distance(next) > reach && counting >= fewest_cells) break;
    if (cells[next].weight > 0.0) ++counting;
    if (down)
      --first;
    else
      ++last;
  }
  return View<Cell>(cells).subspan(first, last - first);
}

}  // namespace

std::vector<double> spectral_background(const Spectrum& spectrum,
                                        const std::vector<bool>& left_out) {
  const std::vector<Cell> cells = cells_of(spectrum, left_out);
  std::vector<double> levels(cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i)
    levels[i] = local_level(neighbourhood(cells, i), cells[i].log_frequency);

  std::vector<double> background(spectrum.one_sided_psd.size());
  std::size_t i = 0;
  for (std::size_t k = 0; k < background.size(); ++k) {
    const double u = std::log(std::max(static_cast<double>(k), 1.0));
    while (i + 2 < cells.size() && cells[i + 1].log_frequency < u) ++i;
    const double t =
        (u - cells[i].log_frequency) / (cells[i + 1].log_frequency - cells[i].log_frequency);
    background[k] = std::exp(std::lerp(levels[i], levels[i + 1], t));
  }
  return background;
}

}  // namespace proofmass::signal
