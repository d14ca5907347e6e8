// A calibration by rotating: rest detection in a recording of three axes, their means, nine
// parameters with all diagnostics. For comparison, in the same run and from the same means, a plain
// Levenberg–Marquardt descent with a Jacobian by differences: nine parameters and s² (JᵀJ)⁻¹, no
// weights, no outlier, no test.
//
//   calibrate_bench [samples, 51175 if not given] [rests, 38]
#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <random>
#include <vector>

#include "measure.hpp"
#include "proofmass/calibrate/multi_position.hpp"
#include "proofmass/calibrate/pose_means.hpp"
#include "proofmass/signal/rests.hpp"

namespace {

using namespace proofmass;

constexpr double rate_hz = 100.0, g = 9.80665;
using Nine = Eigen::Matrix<double, 9, 1>;
using Axes = std::array<std::vector<double>, 3>;

Nine true_sensor() {
  Nine p;
  p << 33120.0, 33280.0, 32360.0, 414.4, 412.0, 414.6, 3.4e-3, -9.2e-3, 21.4e-3;
  return p;
}

Eigen::Matrix3d angles(const Nine& p) {
  Eigen::Matrix3d T = Eigen::Matrix3d::Identity();
  T(0, 1) = -p(6);
  T(0, 2) = p(7);
  T(1, 2) = -p(8);
  return T;
}

// Positions in a spiral over the sphere, with a rotation by an unsteady hand between them.
Axes made_up(std::size_t n, std::size_t rests) {
  std::mt19937_64 bits(1);
  std::normal_distribution<double> normal;
  const Nine p = true_sensor();
  const Eigen::Matrix3d back = angles(p).inverse();
  const auto direction = [&](double k) {
    const double z = 1.0 - 2.0 * (k + 0.5) / static_cast<double>(rests);
    const double flat = std::sqrt(std::max(0.0, 1.0 - z * z)), angle = 2.399963 * k;
    return Eigen::Vector3d(flat * std::cos(angle), flat * std::sin(angle), z);
  };
  Axes axes;
  for (auto& axis : axes) axis.reserve(n);
  const std::size_t period = n / rests;
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t pose = std::min(k / period, rests - 1);
    const double part = static_cast<double>(k - pose * period) / static_cast<double>(period);
    const double moved = part < 0.75 ? 0.0 : std::min(1.0, (part - 0.75) / 0.25);
    Eigen::Vector3d force =
        g * direction(static_cast<double>(pose) + (pose + 1 < rests ? moved : 0.0));
    if (moved > 0.0)
      for (int a = 0; a < 3; ++a) force(a) += 0.8 * normal(bits);
    const Eigen::Vector3d u = p.segment<3>(3).cwiseProduct(back * force) + p.head<3>();
    for (std::size_t a = 0; a < 3; ++a)
      axes[a].push_back(std::round(u(static_cast<Eigen::Index>(a)) + 3.3 * normal(bits)));
  }
  return axes;
}

double residual(const Nine& p, const Eigen::Vector3d& mean) {
  return (angles(p) * (mean - p.head<3>()).cwiseQuotient(p.segment<3>(3))).norm() - g;
}

struct PlainFit {
  Nine p = Nine::Zero(), std = Nine::Zero();
  int steps = 0;
};

PlainFit plain_fit(const std::vector<Eigen::Vector3d>& means, const Nine& start) {
  const auto n = static_cast<Eigen::Index>(means.size());
  const auto residuals = [&](const Nine& p) {
    Eigen::VectorXd r(n);
    for (Eigen::Index k = 0; k < n; ++k) r(k) = residual(p, means[static_cast<std::size_t>(k)]);
    return r;
  };
  PlainFit fit{.p = start};
  Eigen::VectorXd r = residuals(fit.p);
  Eigen::Matrix<double, 9, 9> N;
  double lambda = 1e-3;
  for (bool settled = false; !settled && fit.steps < 100; ++fit.steps) {
    Eigen::MatrixXd J(n, 9);
    for (Eigen::Index k = 0; k < 9; ++k) {
      Nine moved = fit.p;
      const double h = 1e-7 * std::max(std::abs(moved(k)), 1e-3);
      moved(k) += h;
      J.col(k) = (residuals(moved) - r) / h;
    }
    N = J.transpose() * J;
    const Nine right = -(J.transpose() * r);
    for (;;) {
      Eigen::Matrix<double, 9, 9> damped = N;
      damped.diagonal() *= 1.0 + lambda;
      const Nine next = fit.p + damped.ldlt().solve(right);
      const Eigen::VectorXd after = residuals(next);
      if (after.squaredNorm() < r.squaredNorm()) {
        settled = r.squaredNorm() - after.squaredNorm() < 1e-12 * r.squaredNorm();
        fit.p = next;
        r = after;
        lambda *= 0.1;
        break;
      }
      lambda *= 10.0;
      if (lambda > 1e12) {
        settled = true;
        break;
      }
    }
  }
  fit.std = (r.squaredNorm() / static_cast<double>(n - 9) *
             N.ldlt().solve(Eigen::Matrix<double, 9, 9>::Identity()).diagonal())
                .cwiseSqrt();
  return fit;
}

template <class Work>
double timed(int times, const Work& work) {
  const double from = cpu_s();
  for (int k = 0; k < times; ++k) work();
  return (cpu_s() - from) / times;
}

void line(const char* what, double seconds) {
  std::printf("  %-52s %9.3f ms\n", what, 1e3 * seconds);
}

}  // namespace

int main(int argc, char** argv) {
  const auto n = static_cast<std::size_t>(argc > 1 ? std::atof(argv[1]) : 51175);
  const auto rests = static_cast<std::size_t>(argc > 2 ? std::atof(argv[2]) : 38);
  const Axes axes = made_up(n, rests);
  const std::array<View<double>, 3> views{axes[0], axes[1], axes[2]};

  signal::RestSearch search;
  const double finding =
      timed(20, [&] { search = signal::find_rests(views, {.rate_hz = rate_hz}); });
  std::vector<calibrate::Dwell> dwells;
  for (const signal::Rest& rest : search.rests) dwells.push_back({rest.first, rest.last});
  std::printf("%zu samples of 3 axes, %zu rests made, %zu found\n", n, rests, dwells.size());
  if (dwells.size() < 12) return 1;

  calibrate::PoseMeans means;
  const double averaging =
      timed(20, [&] { means = calibrate::pose_means(views, dwells, {1.0, 1.0, 1.0}).value(); });
  calibrate::MultiPosition fit;
  const calibrate::MultiPositionOptions options{.gravity_mps2 = g, .noise_dof = means.noise_dof};
  const double fitting =
      timed(100, [&] { fit = calibrate::calibrate_positions(means.poses, options).value(); });

  std::vector<Eigen::Vector3d> plain_means;
  Nine start;
  start << 32768.0, 32768.0, 32768.0, 400.0, 400.0, 400.0, 0.0, 0.0, 0.0;
  const double plain_averaging = timed(20, [&] {
    plain_means.assign(dwells.size(), Eigen::Vector3d::Zero());
    for (std::size_t k = 0; k < dwells.size(); ++k) {
      for (std::size_t a = 0; a < 3; ++a) {
        double sum = 0.0;
        for (std::size_t i = dwells[k].first; i <= dwells[k].last; ++i) sum += axes[a][i];
        plain_means[k](static_cast<Eigen::Index>(a)) =
            sum / static_cast<double>(dwells[k].last - dwells[k].first + 1);
      }
    }
  });
  PlainFit plain;
  const double plain_fitting = timed(100, [&] { plain = plain_fit(plain_means, start); });

  line("rests found", finding);
  line("their means, with uncertainties", averaging);
  line("nine parameters and what judges them", fitting);
  line("all", finding + averaging + fitting);
  line("plain: means alone", plain_averaging);
  line("plain: nine parameters, Jacobian by differences", plain_fitting);
  const Nine truth = true_sensor();
  for (std::size_t k = 0; k < 9; ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    const double unit = k < 6 ? 1.0 : 1e3;  // angles in mrad
    std::printf("  %c%zu true %10.3f   plain %10.3f +- %.3f   here %10.3f +- %.3f\n", "bsa"[k / 3],
                k % 3, unit * truth(row), unit * plain.p(row), unit * plain.std(row),
                unit * fit.estimate[k], unit * std::sqrt(fit.covariance(row, row)));
  }
}
