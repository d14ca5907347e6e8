#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

namespace proofmass::characterise::test {

/// Phase of the 10-point set of W. J. Riley, NIST SP 1065 (2008), p. 107.
inline const std::vector<double> nbs14_phase{0,        103.11111, 123.22222, 157.33333, 166.44444,
                                             48.55555, -96.33333, -2.22222,  111.88889, 0};

/// Phase of the 1000-point set there, p. 108: 1001 points, from 1000 rates, the seed's first.
inline std::vector<double> nist_1000_phase() {
  std::vector<double> x{0.0};
  constexpr std::uint64_t modulus = 2'147'483'647;
  std::uint64_t n = 1'234'567'890;
  for (int i = 0; i < 1000; ++i, n = 16807 * n % modulus)
    x.push_back(x.back() + static_cast<double>(n) / static_cast<double>(modulus));
  return x;
}

/// White rates about a mean one, summed.
inline std::vector<double> random_walk(std::size_t points, double mean_rate, unsigned seed) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> normal;
  std::vector<double> x(points, 0.0);
  for (std::size_t i = 1; i < points; ++i) x[i] = x[i - 1] + mean_rate + normal(engine);
  return x;
}

/// One line of a table of Stable32, those that begin with '#' included.
struct TableRow {
  std::size_t m;
  double terms;
  int alpha;
  double sigma;
};

inline std::vector<TableRow> read_table(const std::filesystem::path& file) {
  std::vector<TableRow> rows;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    if (line.starts_with('#')) line[0] = ' ';
    std::istringstream words(line);
    TableRow row{};
    double tau_s = 0.0, lower = 0.0, upper = 0.0;
    if (words >> row.m >> tau_s >> row.terms >> row.alpha >> lower >> row.sigma >> upper)
      rows.push_back(row);
  }
  return rows;
}

/// The folder of Stable32's tables and the phase record they are of, or an empty path.
inline std::filesystem::path stable32_tables() {
  const char* given = std::getenv("PROOFMASS_DATA");
  const std::filesystem::path data =
      given ? given : std::filesystem::path(PROOFMASS_SOURCE_DIR) / "../shared/data";
  const std::filesystem::path folder = data / "allan-reference/phasedat";
  return std::filesystem::exists(folder) ? folder : std::filesystem::path{};
}

inline std::vector<double> stable32_phase() {
  std::vector<double> x;
  std::ifstream stream(stable32_tables() / "PHASE.DAT");
  for (std::string line; std::getline(stream, line);)
    if (!line.empty() && !line.starts_with('#')) x.push_back(std::stod(line));
  return x;
}

/// Half a unit of the last of the five digits that are printed, and a hair for ties.
inline double printed(double sigma) {
  return 0.51 * std::pow(10.0, std::floor(std::log10(sigma)) - 4.0);
}

}  // namespace proofmass::characterise::test
