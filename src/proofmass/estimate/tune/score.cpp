#include "proofmass/estimate/tune/score.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include "proofmass/core/contract.hpp"

namespace proofmass::estimate {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

template <int N>
using Vec = Eigen::Matrix<double, N, 1>;
template <int N>
using Square = Eigen::Matrix<double, N, N>;

// One measurement as needed by the backward pass. Without one, and where it ended a diffuse
// direction, weight and weighted are zero; without one, the gain too.
template <int N>
struct Trace {
  Vec<N> gain;
  double weight = 0.0;    // 1/S
  double weighted = 0.0;  // y/S
};

template <int N>
struct State {
  Vec<N> x = Vec<N>::Zero();
  Square<N> P, Pinf;
  int diffuse = 0;  // number of remaining diffuse directions
};

template <int N>
class Pass {
 public:
  explicit Pass(const TuneSystem& system)
      : F_(system.F.topLeftCorner<N, N>()),
        Q_(system.Q.topLeftCorner<N, N>()),
        prior_(system.prior.topLeftCorner<N, N>()),
        R_(system.R),
        diffuse_(system.diffuse) {
    for (int i = 0; i < N; ++i) h_(i) = i < system.observed ? 1.0 : 0.0;
  }

  [[nodiscard]] State<N> start() const {
    State<N> state;
    state.P = prior_;
    state.Pinf.setZero();
    for (int i = 0; i < diffuse_; ++i) state.Pinf(i, i) = 1.0;
    state.diffuse = diffuse_;
    return state;
  }

  void predict(State<N>& state) const {
    state.x = (F_ * state.x).eval();
    state.P = symmetric(F_ * state.P * F_.transpose()) + Q_;
    if (state.diffuse > 0) state.Pinf = symmetric(F_ * state.Pinf * F_.transpose());
  }

  // Processes the measurement and records its effect; false if its variance is not positive.
  bool correct(double z, State<N>& state, Trace<N>& trace, TuneScore& score) const {
    trace = {Vec<N>::Zero(), 0.0, 0.0};
    if (std::isnan(z)) return true;
    ++score.readings;
    const Vec<N> M = state.P * h_;
    const double y = z - h_.dot(state.x), S = h_.dot(M) + R_;
    if (state.diffuse > 0) {
      const Vec<N> Minf = state.Pinf * h_;
      if (const double Sinf = h_.dot(Minf); Sinf > tiny * state.Pinf.trace()) {
        end_diffuse({y, S, M, Minf, Sinf}, state, trace, score);
        return true;
      }
    }
    if (!(S > 0.0)) return false;
    trace.gain = M / S;
    trace.weight = 1.0 / S;
    trace.weighted = y / S;
    state.x += trace.gain * y;
    state.P = symmetric(state.P - trace.gain * M.transpose());
    ++score.innovations;
    score.squares += y * trace.weighted;
    score.log_likelihood -= 0.5 * (std::log(2.0 * std::numbers::pi * S) + y * trace.weighted);
    return true;
  }

  // Of a measurement: u and its variance D.
  struct SmoothingError {
    double u, D;
  };

  // Adjoint: λ, Λ of the state after step k become those before its measurement.
  SmoothingError look_back(const Trace<N>& trace, Vec<N>& r, Square<N>& L) const {
    const Vec<N> LK = L * trace.gain;
    const double u = trace.weighted - trace.gain.dot(r);
    const double D = trace.weight + trace.gain.dot(LK);
    r += h_ * u;
    // (I − K h)ᵀ Λ (I − K h) + h hᵀ/S
    L = symmetric(L - h_ * LK.transpose() - LK * h_.transpose() + D * h_ * h_.transpose());
    return {u, D};
  }

  [[nodiscard]] const Square<N>& transition() const { return F_; }
  [[nodiscard]] double variance(const State<N>& state) const { return h_.dot(state.P * h_) + R_; }
  [[nodiscard]] double predicted(const State<N>& state) const { return h_.dot(state.x); }

  [[nodiscard]] static Square<N> symmetric(const Square<N>& A) { return 0.5 * (A + A.transpose()); }

 private:
  static constexpr double tiny = 1e-12;

  struct Diffuse {
    double y, S;
    const Vec<N>&M, &Minf;
    double Sinf;
  };

  void end_diffuse(const Diffuse& d, State<N>& state, Trace<N>& trace, TuneScore& score) const {
    const Vec<N> K = trace.gain = d.Minf / d.Sinf;
    state.x += K * d.y;
    state.P =
        symmetric(state.P + d.S * K * K.transpose() - d.M * K.transpose() - K * d.M.transpose());
    state.Pinf = symmetric(state.Pinf - K * d.Minf.transpose());
    if (--state.diffuse == 0) state.Pinf.setZero();
    score.log_likelihood -= 0.5 * std::log(d.Sinf);
  }

  Square<N> F_, Q_, prior_;
  double R_;
  int diffuse_;
  Vec<N> h_;
};

// The first measurement of a diffuse level: earlier data contain no information.
std::size_t first_reading(View<double> series) {
  std::size_t k = 0;
  while (k < series.size() && std::isnan(series[k])) ++k;
  return k;
}

TuneScore impossible() {
  TuneScore score;
  score.log_likelihood = -std::numeric_limits<double>::infinity();
  return score;
}

template <int N, class Visit>
TuneScore forward(const TuneSystem& system, View<double> series, Visit&& visit) {
  const Pass<N> pass(system);
  TuneScore score;
  State<N> state = pass.start();
  Trace<N> trace;
  for (std::size_t k = first_reading(series); k < series.size(); ++k) {
    if (score.readings > 0) pass.predict(state);
    visit.before(k, pass, state);
    if (!pass.correct(series[k], state, trace, score)) return impossible();
    visit.after(k, state, trace);
  }
  return score;
}

template <int N>
struct Nothing {
  void before(std::size_t, const Pass<N>&, const State<N>&) {}
  void after(std::size_t, const State<N>&, const Trace<N>&) {}
};

template <int N>
struct KeepTrace {
  std::vector<Trace<N>> traces;
  std::vector<Vec<N>> x;  // filtered, if requested
  std::vector<Square<N>> P;
  bool states = false;
  void before(std::size_t, const Pass<N>&, const State<N>&) {}
  void after(std::size_t, const State<N>& state, const Trace<N>& trace) {
    traces.push_back(trace);
    if (!states) return;
    x.push_back(state.x);
    P.push_back(state.P);
  }
};

template <int N>
struct KeepInnovations {
  View<double> series;
  TuneInnovations& out;
  void before(std::size_t k, const Pass<N>& pass, const State<N>& state) {
    if (std::isnan(series[k]) || state.diffuse > 0) return;
    out.innovation[k] = series[k] - pass.predicted(state);
    out.variance[k] = pass.variance(state);
  }
  void after(std::size_t, const State<N>&, const Trace<N>&) {}
};

template <int N>
TuneScore score_of(const TuneSystem& system, View<double> series) {
  KeepTrace<N> kept;
  kept.states = system.moves_transition;
  kept.traces.reserve(series.size());
  TuneScore score = forward<N>(system, series, kept);
  score.by_log.assign(system.by_log.size(), 0.0);
  if (!std::isfinite(score.log_likelihood)) return score;
  const Pass<N> pass(system);
  Vec<N> r = Vec<N>::Zero();
  Square<N> L = Square<N>::Zero(), by_Q = Square<N>::Zero(), by_F = Square<N>::Zero();
  double by_R = 0.0;
  for (std::size_t k = kept.traces.size(); k-- > 0;) {
    if (k + 1 < kept.traces.size()) {
      by_Q += r * r.transpose() - L;
      const Vec<N> Fr = pass.transition().transpose() * r;
      if (kept.states) {
        const Vec<N> smoothed = kept.x[k] + kept.P[k] * Fr;
        by_F += r * smoothed.transpose() - L * pass.transition() * kept.P[k];
      }
      r = Fr;
      L = Pass<N>::symmetric(pass.transition().transpose() * L * pass.transition());
    }
    const auto [u, D] = pass.look_back(kept.traces[k], r, L);
    by_R += u * u - D;
  }
  const Square<N> by_prior = r * r.transpose() - L;
  score.transitions = kept.traces.empty() ? 0 : kept.traces.size() - 1;
  for (std::size_t j = 0; j < system.by_log.size(); ++j) {
    const TuneDerivative& d = system.by_log[j];
    const Square<N> dQ = d.Q.topLeftCorner<N, N>(), dF = d.F.topLeftCorner<N, N>(),
                    dP = d.prior.topLeftCorner<N, N>();
    score.by_log[j] =
        0.5 * (dQ.cwiseProduct(by_Q).sum() + dP.cwiseProduct(by_prior).sum() + d.R * by_R) +
        dF.cwiseProduct(by_F).sum();
  }
  return score;
}

template <int N>
TuneInnovations innovations(const TuneSystem& system, View<double> series) {
  TuneInnovations out{std::vector<double>(series.size(), none),
                      std::vector<double>(series.size(), none)};
  forward<N>(system, series, KeepInnovations<N>{series, out});
  return out;
}

template <int N>
TuneResiduals residuals(const TuneSystem& system, View<double> series) {
  TuneResiduals out{std::vector<double>(series.size(), none),
                    std::vector<double>(series.size(), none)};
  KeepTrace<N> kept;
  kept.traces.reserve(series.size());
  if (!std::isfinite(forward<N>(system, series, kept).log_likelihood)) return out;
  const Pass<N> pass(system);
  Vec<N> r = Vec<N>::Zero();
  Square<N> L = Square<N>::Zero();
  const std::size_t first = series.size() - kept.traces.size();
  for (std::size_t k = kept.traces.size(); k-- > 0;) {
    const auto [u, D] = pass.look_back(kept.traces[k], r, L);
    if (!std::isnan(series[first + k]) && D > 0.0) {
      out.residual[first + k] = u / D;
      out.variance[first + k] = 1.0 / D;
    }
    r = (pass.transition().transpose() * r).eval();
    L = Pass<N>::symmetric(pass.transition().transpose() * L * pass.transition());
  }
  return out;
}

// Calls with the number of states as a constant.
template <class Work>
auto with_states(const TuneSystem& system, Work&& work) {
  PM_EXPECTS(system.states >= 1 && system.states <= tune_states);
  if (system.states == 1) return work.template operator()<1>();
  if (system.states == 2) return work.template operator()<2>();
  return work.template operator()<3>();
}

}  // namespace

TuneScore log_likelihood(const TuneSystem& system, View<double> series) {
  return with_states(system, [&]<int N>() { return forward<N>(system, series, Nothing<N>{}); });
}

TuneScore likelihood_score(const TuneSystem& system, View<double> series) {
  return with_states(system, [&]<int N>() { return score_of<N>(system, series); });
}

TuneInnovations innovations_of(const TuneSystem& system, View<double> series) {
  return with_states(system, [&]<int N>() { return innovations<N>(system, series); });
}

TuneResiduals deletion_residuals(const TuneSystem& system, View<double> series) {
  return with_states(system, [&]<int N>() { return residuals<N>(system, series); });
}

}  // namespace proofmass::estimate
