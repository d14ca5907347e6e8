#include "proofmass/estimate/track/pva_pass.hpp"

#include <algorithm>
#include <cmath>

namespace proofmass::estimate {
namespace {

double root(double variance) {
  return std::sqrt(std::max(variance, 0.0));
}

void push(const Mat<2>& mean, const Mat<2>& variance, std::size_t k, PvaSeries& out) {
  out.position_m[k] = mean(0);
  out.velocity_mps[k] = mean(1);
  out.position_std_m[k] = root(variance(0));
  out.velocity_std_mps[k] = root(variance(1));
}

PvaSeries of_size(std::size_t size) {
  const std::vector<double> zeros(size, 0.0);
  return {zeros, zeros, zeros, zeros};
}

// Innovation statistics of the forward filter.
template <int S>
class Judge {
 public:
  Judge(const PvaAxis<S>& axis, const PvaPassOptions& options)
      : axis_(axis), check_({channels(options.names), options.rate_hz}) {}

  void take(std::size_t k, const StepOf<PvaAxis<S>>& step) {
    const std::size_t sensors = axis_.sensors();
    for (int i = 0; i < step.count; ++i) {
      const auto& update = step.updates[static_cast<std::size_t>(i)];
      const int channel = axis_.channel_of(k, i);
      if (channel == PvaAxis<S>::velocity_channel) {
        if (velocity_seen_) {
          check_.add(sensors, update.innovation, update.expected);
          if (axis_.sample(k).arrives) close(k, update.innovation, update.expected);
        }
        velocity_seen_ = true;
      } else if (channel == PvaAxis<S>::position_channel) {
        check_.add(sensors + 1, update.innovation, update.expected);
      } else if (k >= start_samples) {
        check_.add(static_cast<std::size_t>(channel), update.innovation, update.expected);
      }
    }
    fastest_mps_ = std::max(fastest_mps_, std::abs(step.filtered.mean(pva::velocity_mps)));
    if (axis_.sample(k).resting || k == 0) {
      left_s_ = axis_.time_s(k) - axis_.time_s(0);
      fastest_mps_ = 0.0;
    }
  }

  void report(PvaPass& out) {
    out.closures = std::move(closures_);
    out.consistency = check_.judge();
  }

 private:
  // The first measurements only determine the initial bias and acceleration.
  static constexpr std::size_t start_samples = 2;

  static std::vector<std::string> channels(std::vector<std::string> names) {
    names.emplace_back("velocity at stops");
    names.emplace_back("position");
    return names;
  }

  void close(std::size_t k, double innovation, double variance) {
    closures_.push_back({.start_s = left_s_,
                         .end_s = axis_.time_s(k) - axis_.time_s(0),
                         .velocity_mps = -innovation,
                         .expected_std_mps = std::sqrt(variance),
                         .fastest_mps = fastest_mps_});
  }

  const PvaAxis<S>& axis_;
  ConsistencyCheck check_;
  std::vector<Closure> closures_;
  double left_s_ = 0.0, fastest_mps_ = 0.0;
  bool velocity_seen_ = false;
};

template <int S>
std::vector<Uncertain> biases(const PvaAxis<S>& axis, const Gaussian<PvaAxis<S>::states>& x) {
  std::vector<Uncertain> all;
  for (int i = 0; i < static_cast<int>(axis.sensors()); ++i) {
    Mat<PvaAxis<S>::states> h = Mat<PvaAxis<S>::states>::Zero();
    h(PvaAxis<S>::common) = h(PvaAxis<S>::first_bias + i) = 1.0;
    all.push_back({h.dot(x.mean), root(h.dot(x.cov * h))});
  }
  return all;
}

template <int S>
PvaPass pass(const PvaAxis<S>& axis, const PvaPassOptions& options) {
  constexpr int N = PvaAxis<S>::states;
  PvaPass out;
  out.filtered = out.smoothed = of_size(axis.size());
  Judge<S> judge(axis, options);
  Gaussian<N> last;
  smooth(
      axis, axis.start(options.speed_std_mps), Gate{},
      [&](std::size_t k, const StepOf<PvaAxis<S>>& step) {
        push(step.filtered.mean.template head<2>(), step.filtered.cov.diagonal().template head<2>(),
             k, out.filtered);
        judge.take(k, step);
        last = step.filtered;
      },
      [&](std::size_t k, const StepOf<PvaAxis<S>>& step, const BackwardInformation<N>& later) {
        const Mat<N> mean = later.mean(step.filtered);
        push(mean.template head<2>(), later.template cov<2>(step.filtered).diagonal(), k,
             out.smoothed);
      });
  judge.report(out);
  out.bias_mps2 = biases<S>(axis, last);
  return out;
}

}  // namespace

PvaPass pass_over(const PvaAxis<1>& axis, const PvaPassOptions& options) {
  return pass<1>(axis, options);
}

PvaPass pass_over(const PvaAxis<static_cast<int>(most_fused_sensors)>& axis,
                  const PvaPassOptions& options) {
  return pass<static_cast<int>(most_fused_sensors)>(axis, options);
}

}  // namespace proofmass::estimate
