#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

// Shared by the tests of this module: the published data set of SP 1065 and Stable32's results.
namespace proofmass::characterise::test {

/// 1001 phases of the generator n' = 16807 n mod 2³¹ − 1 from 1234567890, rates n/(2³¹ − 1).
/// Source: W. J. Riley, NIST SP 1065 (2008), section 12.4.
inline std::vector<double> nbs14_phase() {
  std::vector<double> phase = {0.0};
  for (long long n = 1234567890; phase.size() < 1001; n = 16807 * n % 2147483647)
    phase.push_back(phase.back() + static_cast<double>(n) / 2147483647.0);
  return phase;
}

/// Phase of the 10-point set of the same source, p. 107.
inline const std::vector<double> ten_point_phase{
    0, 103.11111, 123.22222, 157.33333, 166.44444, 48.55555, -96.33333, -2.22222, 111.88889, 0};

/// Cumulative sum of white rates with mean one.
inline std::vector<double> phase_of_white_rates(std::size_t points,
                                                double mean_rate,
                                                unsigned seed) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> normal;
  std::vector<double> x(points, 0.0);
  for (std::size_t i = 1; i < points; ++i) x[i] = x[i - 1] + mean_rate + normal(engine);
  return x;
}

/// Empty if the folder does not exist.
inline std::filesystem::path stable32_folder() {
  std::filesystem::path data = std::filesystem::path(PROOFMASS_SOURCE_DIR) / ".." / "shared/data";
  if (const char* given = std::getenv("PROOFMASS_DATA")) data = given;
  data /= "allan-reference/phasedat";
  return std::filesystem::is_directory(data) ? data : std::filesystem::path();
}

struct Stable32Row {
  std::size_t m = 0;
  int alpha = 0;
  double lower = 0.0, deviation = 0.0, upper = 0.0;  ///< limits 0 if not requested
  bool doubtful = false;                             ///< commented out by the table's publishers
  double terms = 0.0;
};

inline std::vector<Stable32Row> read_stable32_table(const std::filesystem::path& file) {
  std::vector<Stable32Row> rows;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    Stable32Row row;
    row.doubtful = line.starts_with('#');
    std::ranges::replace(line, '#', ' ');
    double tau = 0.0;
    std::istringstream fields(line);
    if (fields >> row.m >> tau >> row.terms >> row.alpha >> row.lower >> row.deviation >> row.upper)
      rows.push_back(row);
  }
  return rows;
}

/// The phase record to which the tables belong.
inline std::vector<double> stable32_phase() {
  std::vector<double> x;
  std::ifstream in(stable32_folder() / "PHASE.DAT");
  for (std::string line; std::getline(in, line);)
    if (!line.empty() && !line.starts_with('#')) x.push_back(std::stod(line));
  return x;
}

/// Half a unit of the last of the five digits of the tables, plus a small allowance for ties.
inline double printed(double deviation) {
  return 0.51 * std::pow(10.0, std::floor(std::log10(deviation)) - 4.0);
}

}  // namespace proofmass::characterise::test
