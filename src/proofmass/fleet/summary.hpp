#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/fleet/random_effects.hpp"
#include "proofmass/fleet/results.hpp"
#include "proofmass/fleet/trend.hpp"
#include "proofmass/report/document.hpp"

// What only many recordings show.
namespace proofmass::fleet {

/// A figure has to lie below, or above, a bound.
struct Limit {
  std::string text;    ///< as it was given
  std::string figure;  ///< the name of a column
  bool is_upper = true;
  double bound = 0.0;
};

/// Reads "white<2e-3", "time_constant_s>=10". Errors: invalid_argument.
[[nodiscard]] Result<Limit> parse_limit(const std::string& text);

/// One recording's value of a figure.
struct FigureValue {
  std::size_t sensor = 0;  ///< index in Summary::sensors
  double value = 0.0;
  std::optional<double> std, day, temperature_c;
  std::string file, page;  ///< the recording; its report, or document, in the results' folder
};

struct Quantiles {
  double min = 0.0, p05 = 0.0, p25 = 0.0, median = 0.0, p75 = 0.0, p95 = 0.0, max = 0.0;
};

/// A sensor that does not belong to its family.
struct Outlier {
  std::size_t sensor = 0;
  double mean = 0.0;  ///< mean of its values
  double z = 0.0;     ///< robust standard deviations from the family
  double p = 1.0, adjusted_p = 1.0;
};

/// How many sensors are within a limit, by the mean of their values.
struct Yield {
  Limit limit;
  std::size_t within = 0, sensors = 0;
  Bounds share_95;                   ///< Source: E. B. Wilson, J. Am. Stat. Assoc. 22 (1927) 209.
  std::vector<std::size_t> failing;  ///< sensors
};

/// One figure of one channel over the fleet.
struct FigureSummary {
  std::string name, channel, unit;
  std::vector<FigureValue> values;
  Quantiles quantiles;
  bool is_tested = false;  ///< against a family of sensors
  std::vector<Outlier> outliers;
  std::optional<RandomEffects> type;  ///< the sensors in the family
  std::optional<Trend> per_day, per_kelvin;
  double per_day_adjusted_p = 1.0, per_kelvin_adjusted_p = 1.0;
  std::vector<Yield> yields;
  std::size_t not_identified = 0;  ///< recordings whose verdict was another
};

struct SummaryOptions {
  double false_share = 0.05;  ///< expected share of false alarms, at most
  std::vector<Limit> limits;
};

struct Summary {
  std::string folder;
  std::vector<std::string> sensors;  ///< by the column sensor, serial, or the recording's own name
  std::size_t recordings = 0, failures = 0;
  std::size_t family_tests = 0, trend_tests = 0;
  double false_share = 0.05;
  std::vector<FigureSummary> figures;
};

/// Summarises all figures with a standard deviation, those with a verdict only where it is
/// identified, and mean and std of inspect. Out of family: FamilyTest on each figure and channel,
/// Benjamini and Hochberg over all of them together; trends likewise. Errors: unreadable;
/// invalid_argument (a limit of a figure that is not there).
[[nodiscard]] Result<Summary> summarise(const std::string& folder, const SummaryOptions& options);

/// Outliers, the type, trends, yield, and each figure's distribution. `links` leads from the page's
/// folder to the results' folder. It refers to the summary, which must outlive it.
[[nodiscard]] report::Document describe(const Summary& summary, const std::string& links);

}  // namespace proofmass::fleet
