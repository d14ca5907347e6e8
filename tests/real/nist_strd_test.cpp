// The certified fits of NIST's Statistical Reference Datasets, from both given starts.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "proofmass/fit/nonlinear_least_squares.hpp"
#include "published_data.hpp"

namespace proofmass::nist_strd_test {
namespace {

using fit::LeastSquaresFit;

using Predictors = View<double>;
using Parameters = View<double>;

// The models, x the predictors of one row and b the parameters from b[0].
double chwirut(Predictors x, Parameters b) {
  return std::exp(-b[0] * x[0]) / (b[1] + b[2] * x[0]);
}
double dan_wood(Predictors x, Parameters b) {
  return b[0] * std::pow(x[0], b[1]);
}
double enso(Predictors x, Parameters b) {
  const double turn = 2.0 * std::numbers::pi * x[0];
  return b[0] + b[1] * std::cos(turn / 12.0) + b[2] * std::sin(turn / 12.0) +
         b[4] * std::cos(turn / b[3]) + b[5] * std::sin(turn / b[3]) +
         b[7] * std::cos(turn / b[6]) + b[8] * std::sin(turn / b[6]);
}
double gauss(Predictors x, Parameters b) {
  const auto peak = [&](double height, double at, double width) {
    return height * std::exp(-(x[0] - at) * (x[0] - at) / (width * width));
  };
  return b[0] * std::exp(-b[1] * x[0]) + peak(b[2], b[3], b[4]) + peak(b[5], b[6], b[7]);
}
double hahn(Predictors x, Parameters b) {
  const double t = x[0];
  return (b[0] + t * (b[1] + t * (b[2] + t * b[3]))) / (1.0 + t * (b[4] + t * (b[5] + t * b[6])));
}
double kirby(Predictors x, Parameters b) {
  const double t = x[0];
  return (b[0] + t * (b[1] + t * b[2])) / (1.0 + t * (b[3] + t * b[4]));
}
double lanczos(Predictors x, Parameters b) {
  return b[0] * std::exp(-b[1] * x[0]) + b[2] * std::exp(-b[3] * x[0]) +
         b[4] * std::exp(-b[5] * x[0]);
}
double misra_a(Predictors x, Parameters b) {
  return b[0] * (1.0 - std::exp(-b[1] * x[0]));
}
double misra_b(Predictors x, Parameters b) {
  return b[0] * (1.0 - std::pow(1.0 + b[1] * x[0] / 2.0, -2.0));
}
double misra_c(Predictors x, Parameters b) {
  return b[0] * (1.0 - 1.0 / std::sqrt(1.0 + 2.0 * b[1] * x[0]));
}
double misra_d(Predictors x, Parameters b) {
  return b[0] * b[1] * x[0] / (1.0 + b[1] * x[0]);
}
double nelson(Predictors x, Parameters b) {
  return b[0] - b[1] * x[0] * std::exp(-b[2] * x[1]);
}
double rat42(Predictors x, Parameters b) {
  return b[0] / (1.0 + std::exp(b[1] - b[2] * x[0]));
}
double roszman(Predictors x, Parameters b) {
  return b[0] - b[1] * x[0] - std::atan(b[2] / (x[0] - b[3])) / std::numbers::pi;
}

struct Case {
  const char* name;
  double (*model)(Predictors, Parameters);
  double parameter_digits = 8.0;
  double std_digits = 6.0;
  double rss_digits = 8.0;
  bool log_response = false;
};

// GoogleTest requires a printer of exactly this name.
// NOLINTNEXTLINE(readability-identifier-naming)
void PrintTo(const Case& set, std::ostream* out) {
  *out << set.name;
}

struct Published {
  std::vector<double> start[2], certified, certified_std;
  double rss = 0.0;
  std::vector<double> y;
  std::vector<std::vector<double>> x;
};

std::filesystem::path file_of(const Case& set) {
  return published_data() / "nist-strd" / (std::string(set.name) + ".dat");
}

std::vector<double> numbers_of(const std::string& text) {
  std::istringstream in(text);
  std::vector<double> numbers;
  for (double number = 0.0; in >> number;) numbers.push_back(number);
  return numbers;
}

Published read(const Case& set) {
  std::ifstream in(file_of(set));
  Published published;
  for (std::string line; std::getline(in, line);) {
    const auto equals = line.find(" = ");
    const auto first = line.find_first_not_of(' ');
    const std::vector<double> row = numbers_of(line);
    if (line.starts_with("Residual Sum of Squares:")) {
      published.rss = std::stod(line.substr(24));
    } else if (equals != std::string::npos && line[first] == 'b') {
      const std::vector<double> entry = numbers_of(line.substr(equals + 3));
      if (entry.size() != 4) continue;
      for (std::size_t k : {0U, 1U}) published.start[k].push_back(entry[k]);
      published.certified.push_back(entry[2]);
      published.certified_std.push_back(entry[3]);
    } else if (published.rss > 0.0 && row.size() >= 2) {
      published.y.push_back(set.log_response ? std::log(row[0]) : row[0]);
      published.x.emplace_back(row.begin() + 1, row.end());
    }
  }
  return published;
}

// NIST's own measure of agreement.
double digits(double found, double certified) {
  return -std::log10(std::max(std::abs(found - certified) / std::abs(certified), 1e-16));
}

class NistReference : public testing::TestWithParam<Case> {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(file_of(GetParam()))) GTEST_SKIP() << absent(file_of(GetParam()));
  }
  [[nodiscard]] static LeastSquaresFit fitted(const Published& set, std::size_t start) {
    return fit::fit_least_squares({.residuals =
                                       [&](View<double> b, std::span<double> r) {
                                         for (std::size_t k = 0; k < r.size(); ++k)
                                           r[k] = GetParam().model(set.x[k], b) - set.y[k];
                                       },
                                   .residual_count = set.y.size(),
                                   .start = set.start[start]})
        .value();
  }
};

TEST_P(NistReference, FromBothStartsItsCertifiedFitIsFound) {
  const Published set = read(GetParam());
  ASSERT_FALSE(set.certified.empty());
  for (std::size_t start : {0U, 1U}) {
    const LeastSquaresFit found = fitted(set, start);
    EXPECT_TRUE(found.converged);
    EXPECT_EQ(found.dof, set.y.size() - set.certified.size());
    double worst = 16.0, worst_std = 16.0;
    for (std::size_t j = 0; j < set.certified.size(); ++j) {
      worst = std::min(worst, digits(found.parameters[j], set.certified[j]));
      worst_std = std::min(worst_std, digits(found.std[j], set.certified_std[j]));
    }
    EXPECT_GE(worst, GetParam().parameter_digits) << "start " << start + 1;
    EXPECT_GE(worst_std, GetParam().std_digits) << "start " << start + 1;
    EXPECT_GE(digits(found.rss, set.rss), GetParam().rss_digits) << "start " << start + 1;
    RecordProperty("start" + std::to_string(start + 1),
                   std::to_string(worst) + " " + std::to_string(worst_std) + " " +
                       std::to_string(digits(found.rss, set.rss)) + " " +
                       std::to_string(found.iterations) + " " + std::to_string(found.condition));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Sets,
    NistReference,
    testing::Values(Case{"Misra1a", misra_a},
                    Case{"Misra1b", misra_b},
                    Case{"Misra1c", misra_c},
                    Case{"Misra1d", misra_d},
                    Case{"Chwirut1", chwirut},
                    Case{"Chwirut2", chwirut},
                    Case{"DanWood", dan_wood},
                    Case{"ENSO", enso},
                    Case{"Gauss1", gauss},
                    Case{"Gauss2", gauss},
                    Case{"Gauss3", gauss},
                    Case{"Hahn1", hahn},
                    Case{"Kirby2", kirby},
                    Case{"Lanczos2", lanczos},
                    Case{"Lanczos3", lanczos},
                    Case{.name = "Nelson", .model = nelson, .log_response = true},
                    Case{"Rat42", rat42},
                    Case{"Roszman1", roszman}));

}  // namespace
}  // namespace proofmass::nist_strd_test
