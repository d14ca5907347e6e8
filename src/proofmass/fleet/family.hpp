#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <vector>

// Sensors that do not belong to their family.
namespace proofmass::fleet {

/// A sensor's mean of a figure, and how uncertain the scatter within makes it.
struct SensorMean {
  double value = 0.0;
  double within_variance = 0.0;  ///< σ²/n
};

/// How far a sensor is from its family.
struct Distance {
  double z = 0.0;  ///< in robust standard deviations of the family
  double p = 1.0;  ///< that one of a normal family is as far or farther
};

inline constexpr std::size_t least_family = 6;

/// Distances from Tukey's biweight location in biweight scales of the means, each mean first
/// weighed by its own variance where they differ. The p-value is that of this statistic for so many
/// normal means, by simulation with a fixed seed; beyond what it resolves the tail goes on as a
/// power of z. At most two in five may be outliers. Source: F. Mosteller, J. W. Tukey, Data
/// Analysis and Regression (1977), chapter 10.
class FamilyTest {
 public:
  FamilyTest();
  FamilyTest(const FamilyTest&) = delete;
  FamilyTest& operator=(const FamilyTest&) = delete;
  ~FamilyTest();

  /// Empty for families smaller than least_family, or without scatter. Cost: of the first family of
  /// a size 0.2 s, of the others linear.
  [[nodiscard]] std::vector<Distance> distances(const std::vector<SensorMean>& means);

 private:
  class NullScores;
  std::map<std::size_t, std::unique_ptr<NullScores>> known_;  ///< by the family's size
};

/// For each p-value the smallest q with which it is significant, where at most a share q of the
/// significant ones is expected to be so by chance. Source: Y. Benjamini, Y. Hochberg, J. R. Stat.
/// Soc. B 57 (1995) 289.
[[nodiscard]] std::vector<double> adjusted_p(const std::vector<double>& p);

}  // namespace proofmass::fleet
