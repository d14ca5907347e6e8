#include "proofmass/fit/differences.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace proofmass::fit {
namespace {

constexpr std::size_t rows = 10;
constexpr double settled = 1e-12;  // relative error at which refinement stops
constexpr double doubtful = 1e-5;  // relative error above which shorter steps are tried

struct Estimate {
  Eigen::VectorXd value;
  double error = std::numeric_limits<double>::infinity();
};

// Direction of the steps from t, and their limit.
struct Room {
  double side;  // 0: both ways
  double reach;
};

Room room_around(double t, const DifferenceRange& range) {
  const double above = range.upper - t, below = t - range.lower;
  if (std::min(above, below) >= 1e-3 * range.scale) return {0.0, std::min(above, below)};
  return above >= below ? Room{1.0, above} : Room{-1.0, below};
}

// A difference quotient with the error series that its extrapolation removes.
class Quotient {
 public:
  Quotient(const Along& f, double t, double side) : f_(f), t_(t), side_(side) {
    if (side_ != 0.0) finite_ = f_(t_, here_);
  }
  bool operator()(double h, Eigen::VectorXd& slope) {
    const double up = side_ == 0.0 ? t_ + h : t_ + side_ * h;
    if (!finite_ || !f_(up, slope)) return false;
    if (side_ != 0.0) {
      slope = (slope - here_) / (up - t_);
    } else {
      const double down = t_ - h;
      if (!f_(down, here_)) return false;
      slope = (slope - here_) / (up - down);
    }
    return slope.allFinite();
  }
  [[nodiscard]] double ratio() const { return side_ == 0.0 ? 4.0 : 2.0; }

 private:
  const Along& f_;
  double t_, side_;
  Eigen::VectorXd here_;
  bool finite_ = true;
};

using Row = std::vector<Eigen::VectorXd>;

// Extrapolates row[0] with the previous row, removing one more term of the error series each time.
void extrapolate(const Row& above, double ratio, Row& row, Estimate& best) {
  double factor = 1.0;
  for (std::size_t k = 1; k < row.size(); ++k) {
    factor *= ratio;
    row[k] = row[k - 1] + (row[k - 1] - above[k - 1]) / (factor - 1.0);
    const double error = std::max((row[k] - row[k - 1]).norm(), (row[k] - above[k - 1]).norm());
    if (error <= best.error) best = {row[k], error};
  }
}

// One tableau, starting at the step h.
Estimate extrapolated(Quotient& quotient, double h) {
  Row above, row(1);
  Estimate best;
  if (!quotient(h, row[0])) return best;
  best.value = row[0];
  for (std::size_t j = 1; j < rows; ++j) {
    above.swap(row);
    row.resize(j + 1);
    h /= 2.0;
    if (!quotient(h, row[0])) break;
    extrapolate(above, quotient.ratio(), row, best);
    if (best.error <= settled * best.value.norm()) break;
    if ((row.back() - above.back()).norm() > 2.0 * best.error) break;
  }
  return best;
}

}  // namespace

Eigen::VectorXd derivative(const Along& f,
                           double t,
                           const DifferenceRange& range,
                           Eigen::Index values) {
  const Room room = room_around(t, range);
  Quotient quotient(f, t, room.side);
  double h = std::min(1e-2 * range.scale, room.reach);
  Estimate best{Eigen::VectorXd::Zero(values)};
  for (int attempt = 0; attempt < 6; ++attempt, h /= 64.0) {
    if (t + h == t) break;
    Estimate next = extrapolated(quotient, h);
    if (next.error < best.error) best = std::move(next);
    if (best.error <= doubtful * best.value.norm()) break;
  }
  return best.value;
}

}  // namespace proofmass::fit
