#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

// What the tests of this module share: the published data set of SP 1065 and Stable32's results.
namespace proofmass::characterise::test {

/// 1001 phases of the generator n' = 16807 n mod 2³¹ − 1 from 1234567890, rates n/(2³¹ − 1).
/// Source: W. J. Riley, NIST SP 1065 (2008), section 12.4.
inline std::vector<double> nbs14_phase() {
  std::vector<double> phase = {0.0};
  for (long long n = 1234567890; phase.size() < 1001; n = 16807 * n % 2147483647)
    phase.push_back(phase.back() + static_cast<double>(n) / 2147483647.0);
  return phase;
}

/// Empty where the folder is not there.
inline std::filesystem::path stable32_folder() {
  std::filesystem::path data = std::filesystem::path(PROOFMASS_SOURCE_DIR) / ".." / "shared/data";
  if (const char* given = std::getenv("PROOFMASS_DATA")) data = given;
  data /= "allan-reference/phasedat";
  return std::filesystem::is_directory(data) ? data : std::filesystem::path();
}

struct Stable32Row {
  std::size_t m = 0;
  int alpha = 0;
  double lower = 0.0, deviation = 0.0, upper = 0.0;  ///< limits 0 where none were asked for
  bool doubtful = false;  ///< commented out by those who published the table
};

inline std::vector<Stable32Row> read_stable32_table(const std::filesystem::path& file) {
  std::vector<Stable32Row> rows;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    Stable32Row row;
    row.doubtful = line.starts_with('#');
    std::ranges::replace(line, '#', ' ');
    double tau = 0.0;
    double terms = 0.0;
    std::istringstream fields(line);
    if (fields >> row.m >> tau >> terms >> row.alpha >> row.lower >> row.deviation >> row.upper)
      rows.push_back(row);
  }
  return rows;
}

}  // namespace proofmass::characterise::test
