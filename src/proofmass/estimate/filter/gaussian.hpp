#pragma once

#include <Eigen/Core>

namespace proofmass::estimate {

template <int Rows, int Cols = 1>
using Mat = Eigen::Matrix<double, Rows, Cols>;

/// Mean and covariance of a state at one epoch.
template <int N>
struct Gaussian {
  Mat<N> mean = Mat<N>::Zero();
  Mat<N, N> cov = Mat<N, N>::Zero();
};

}  // namespace proofmass::estimate
